//! A module's exports: the one place of all plugins that touches raw memory. Only the macros call it.
//!
//! Every function takes addresses as the host gives them. The ABI promises: they lie in the region that [`scratch`] handed out,
//! which is the host's alone, at multiples of 4, with the whole record or parameter block inside.
#![allow(unsafe_code, reason = "the ABI hands over addresses")]
#![doc(hidden)]

use core::{cell::UnsafeCell, slice};

use crate::{
    Bsdf, Parameters, Profile,
    abi::{EmitOut, EvalOut, EvalRecord, ProfileOut, SampleOut, VertexOut, limit::SCRATCH_ALIGNMENT},
    answer,
};

/// Room for the largest parameter block and as many bytes of records.
const REGION_BYTES: usize = 8192;

#[repr(C, align(16))]
struct Region(UnsafeCell<[u8; REGION_BYTES]>);

const _: () = assert!(align_of::<Region>() == SCRATCH_ALIGNMENT);

// SAFETY: nothing here reads or writes it but through the addresses of the host, whose calls into a module follow one another.
unsafe impl Sync for Region {}

static REGION: Region = Region(UnsafeCell::new([0; REGION_BYTES]));

/// `bidir_scratch`: where the region is; new pages at the memory's end if it is too small, 0 if there are none.
#[inline(always)]
pub fn scratch(bytes: u32) -> usize {
    if bytes as usize <= REGION_BYTES { REGION.0.get() as usize } else { grown(bytes) }
}

#[cfg(target_arch = "wasm32")]
fn grown(bytes: u32) -> usize {
    const PAGE: usize = 1 << 16;
    match core::arch::wasm32::memory_grow::<0>((bytes as usize).div_ceil(PAGE)) {
        usize::MAX => 0,
        first => first * PAGE,
    }
}

#[cfg(not(target_arch = "wasm32"))]
fn grown(_: u32) -> usize {
    0
}

/// # Safety
/// `params` is the address of a block of `P::BYTES` bytes.
#[inline(always)]
unsafe fn parameters<P: Parameters>(params: *const u8) -> P {
    if P::BYTES == 0 {
        return P::from_block(&[]);
    }
    // SAFETY: the caller's promise.
    P::from_block(unsafe { slice::from_raw_parts(params, P::BYTES) })
}

/// # Safety
/// As the ABI promises.
#[inline(always)]
pub unsafe fn eval<P: Parameters, B: Bsdf>(
    shader: impl Fn(&P) -> B,
    out: *mut EvalOut,
    params: *const u8,
    carried: i32,
    wo: [f32; 3],
    wi: [f32; 3],
) {
    // SAFETY: the caller's promise.
    let shader = shader(&unsafe { parameters(params) });
    // SAFETY: the caller's promise.
    unsafe { out.write(answer::eval(&shader, carried, wo, wi)) }
}

/// # Safety
/// As the ABI promises.
#[inline(always)]
pub unsafe fn sample<P: Parameters, B: Bsdf>(
    shader: impl Fn(&P) -> B,
    out: *mut SampleOut,
    params: *const u8,
    carried: i32,
    wo: [f32; 3],
    u: [f32; 3],
) {
    // SAFETY: the caller's promise.
    let shader = shader(&unsafe { parameters(params) });
    // SAFETY: the caller's promise.
    unsafe { out.write(answer::sample(&shader, carried, wo, u)) }
}

/// # Safety
/// As the ABI promises, for `n` records in a row.
#[inline(always)]
pub unsafe fn eval_n<P: Parameters, B: Bsdf>(shader: impl Fn(&P) -> B, records: *mut EvalRecord, n: i32, params: *const u8, carried: i32) {
    if n <= 0 {
        return;
    }
    // SAFETY: the caller's promise.
    let shader = shader(&unsafe { parameters(params) });
    // SAFETY: the caller's promise.
    for record in unsafe { slice::from_raw_parts_mut(records, n as usize) } {
        record.out = answer::eval(&shader, carried, record.wo, record.wi);
    }
}

/// # Safety
/// As the ABI promises.
#[inline(always)]
pub unsafe fn vertex<P: Parameters, B: Bsdf>(
    shader: impl Fn(&P) -> B,
    out: *mut VertexOut,
    params: *const u8,
    carried: i32,
    wo: [f32; 3],
    wi: [f32; 3],
    u: [f32; 3],
) {
    // SAFETY: the caller's promise.
    let shader = shader(&unsafe { parameters(params) });
    let answer = VertexOut { eval: answer::eval(&shader, carried, wo, wi), sample: answer::sample(&shader, carried, wo, u) };
    // SAFETY: the caller's promise.
    unsafe { out.write(answer) }
}

/// # Safety
/// As the ABI promises.
#[inline(always)]
pub unsafe fn profile<P: Parameters, L: Profile>(
    light: impl Fn(&P) -> L,
    out: *mut ProfileOut,
    params: *const u8,
    uv: [f32; 2],
    w: [f32; 3],
) {
    // SAFETY: the caller's promise.
    let light = light(&unsafe { parameters(params) });
    // SAFETY: the caller's promise.
    unsafe { out.write(answer::profile(&light, uv, w)) }
}

/// # Safety
/// As the ABI promises.
#[inline(always)]
pub unsafe fn emit<P: Parameters, L: Profile>(light: impl Fn(&P) -> L, out: *mut EmitOut, params: *const u8, uv: [f32; 2], u: [f32; 2]) {
    // SAFETY: the caller's promise.
    let light = light(&unsafe { parameters(params) });
    // SAFETY: the caller's promise.
    unsafe { out.write(answer::emit(&light, uv, u)) }
}

/// What BSDFs and lights both export.
#[doc(hidden)]
#[macro_export]
macro_rules! __export_plugin {
    () => {
        // Not `used`: that would put a second copy into the module's memory.
        #[unsafe(link_section = "bidir.manifest")]
        static SECTION: [u8; MANIFEST.len()] = $crate::json::array(MANIFEST);

        #[unsafe(no_mangle)]
        extern "C" fn bidir_abi() -> i32 {
            $crate::abi::VERSION.pack()
        }

        #[unsafe(no_mangle)]
        extern "C" fn bidir_scratch(bytes: u32) -> usize {
            $crate::export::scratch(bytes)
        }
    };
}

#[doc(hidden)]
#[macro_export]
macro_rules! __export_bsdf {
    ($parameters:ty => $shader:expr) => {
        #[cfg(target_arch = "wasm32")]
        const _: () = {
            use $crate::abi::{EvalOut, EvalRecord, SampleOut, VertexOut};

            $crate::__export_plugin!();

            #[unsafe(no_mangle)]
            unsafe extern "C" fn bsdf_eval(
                out: *mut EvalOut,
                params: *const u8,
                carried: i32,
                ox: f32,
                oy: f32,
                oz: f32,
                ix: f32,
                iy: f32,
                iz: f32,
            ) {
                // SAFETY: the host keeps the ABI.
                unsafe { $crate::export::eval::<$parameters, _>($shader, out, params, carried, [ox, oy, oz], [ix, iy, iz]) }
            }

            #[unsafe(no_mangle)]
            unsafe extern "C" fn bsdf_sample(
                out: *mut SampleOut,
                params: *const u8,
                carried: i32,
                ox: f32,
                oy: f32,
                oz: f32,
                ux: f32,
                uy: f32,
                uz: f32,
            ) {
                // SAFETY: the host keeps the ABI.
                unsafe { $crate::export::sample::<$parameters, _>($shader, out, params, carried, [ox, oy, oz], [ux, uy, uz]) }
            }

            #[unsafe(no_mangle)]
            unsafe extern "C" fn bsdf_eval_n(records: *mut EvalRecord, n: i32, params: *const u8, carried: i32) {
                // SAFETY: the host keeps the ABI.
                unsafe { $crate::export::eval_n::<$parameters, _>($shader, records, n, params, carried) }
            }

            #[unsafe(no_mangle)]
            unsafe extern "C" fn bsdf_vertex(
                out: *mut VertexOut,
                params: *const u8,
                carried: i32,
                ox: f32,
                oy: f32,
                oz: f32,
                ix: f32,
                iy: f32,
                iz: f32,
                ux: f32,
                uy: f32,
                uz: f32,
            ) {
                let (wo, wi, u) = ([ox, oy, oz], [ix, iy, iz], [ux, uy, uz]);
                // SAFETY: the host keeps the ABI.
                unsafe { $crate::export::vertex::<$parameters, _>($shader, out, params, carried, wo, wi, u) }
            }
        };
    };
}

#[doc(hidden)]
#[macro_export]
macro_rules! __export_light {
    ($parameters:ty => $light:expr) => {
        #[cfg(target_arch = "wasm32")]
        const _: () = {
            use $crate::abi::{EmitOut, ProfileOut};

            $crate::__export_plugin!();

            #[unsafe(no_mangle)]
            unsafe extern "C" fn light_emit(out: *mut EmitOut, params: *const u8, u: f32, v: f32, ux: f32, uy: f32) {
                // SAFETY: the host keeps the ABI.
                unsafe { $crate::export::emit::<$parameters, _>($light, out, params, [u, v], [ux, uy]) }
            }

            #[unsafe(no_mangle)]
            unsafe extern "C" fn light_eval(out: *mut ProfileOut, params: *const u8, u: f32, v: f32, wx: f32, wy: f32, wz: f32) {
                // SAFETY: the host keeps the ABI.
                unsafe { $crate::export::profile::<$parameters, _>($light, out, params, [u, v], [wx, wy, wz]) }
            }
        };
    };
}
