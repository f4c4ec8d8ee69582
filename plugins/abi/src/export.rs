//! What a module exports.

/// The module's one memory.
pub const MEMORY: &str = "memory";

/// `() -> i32`: the ABI's version, packed.
pub const ABI: &str = "bidir_abi";

/// `(bytes i32) -> i32`: the address, a multiple of [`SCRATCH_ALIGNMENT`](crate::limit::SCRATCH_ALIGNMENT), of a region of that many bytes which the
/// host owns from then on, or 0. Asked once, right after instantiating.
pub const SCRATCH: &str = "bidir_scratch";

/// `(out i32, params i32, carried i32, wo.xyz f32, wi.xyz f32) -> ()`: writes an [`EvalOut`](crate::EvalOut).
pub const BSDF_EVAL: &str = "bsdf_eval";

/// `(out i32, params i32, carried i32, wo.xyz f32, u.xyz f32) -> ()`: writes a [`SampleOut`](crate::SampleOut).
pub const BSDF_SAMPLE: &str = "bsdf_sample";

/// `(records i32, n i32, params i32, carried i32) -> ()`, optional: fills in the answers of `n` [`EvalRecord`](crate::EvalRecord)s.
pub const BSDF_EVAL_N: &str = "bsdf_eval_n";

/// `(out i32, params i32, carried i32, wo.xyz f32, wi.xyz f32, u.xyz f32) -> ()`, optional: [`BSDF_EVAL`] and [`BSDF_SAMPLE`] in one call;
/// writes a [`VertexOut`](crate::VertexOut).
pub const BSDF_VERTEX: &str = "bsdf_vertex";

/// `(out i32, params i32, uv.xy f32, u.xy f32) -> ()`: writes an [`EmitOut`](crate::EmitOut).
pub const LIGHT_EMIT: &str = "light_emit";

/// `(out i32, params i32, uv.xy f32, w.xyz f32) -> ()`: writes a [`ProfileOut`](crate::ProfileOut).
pub const LIGHT_EVAL: &str = "light_eval";
