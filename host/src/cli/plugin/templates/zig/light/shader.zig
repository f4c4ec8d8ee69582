//! {{Name}}: a cone of light that falls off from its axis to its edge. No imports.
//!
//!     L(w) = radiance (1 - h),   h = (1 - w.z) / (1 - cos spread),   for h below 1
//!
//! and directions are made in proportion: pdf = (1 - h) / (pi (1 - cos spread)).

const pi: f32 = 3.1415926535897932;

/// The parameter block; manifest.json tells the host its offsets.
const Params = extern struct { radiance: [3]f32, spread: f32 };

const EvalOut = extern struct { radiance: [3]f32, pdf: f32 };

const EmitOut = extern struct { direction: [3]f32, out: EvalOut };

const nothing: EvalOut = .{ .radiance = .{ 0, 0, 0 }, .pdf = 0 };

// The manifest becomes a custom section of the module.
comptime {
    asm (".section .custom_section.bidir.manifest,\"\",@\n.incbin \"manifest.json\"\n");
}

export fn bidir_abi() i32 {
    return 1 << 16;
}

var region: [8192]u8 align(16) = undefined;

export fn bidir_scratch(bytes: u32) usize {
    if (bytes <= region.len) return @intFromPtr(&region);
    const page = 65536;
    const old = @wasmMemoryGrow(0, bytes / page + @intFromBool(bytes % page != 0));
    return if (old < 0) 0 else @as(usize, @intCast(old)) * page;
}

export fn light_eval(out: *EvalOut, p: *const Params, _: f32, _: f32, x: f32, y: f32, z: f32) void {
    out.* = eval(p, x, y, z);
}

export fn light_emit(out: *EmitOut, p: *const Params, _: f32, _: f32, ua: f32, ub: f32) void {
    // 1 - h has density 2 (1 - h): the square root.
    const below = (1 - @sqrt(1 - ua)) * opening(p);
    const r = @sqrt(below * (2 - below));
    const phi = 2 * pi * ub;
    out.direction = .{ r * @cos(phi), r * @sin(phi), 1 - below };
    out.out = eval(p, out.direction[0], out.direction[1], out.direction[2]);
}

fn eval(p: *const Params, x: f32, y: f32, z: f32) EvalOut {
    if (!(z > 0)) return nothing;
    const open = opening(p);
    // (x² + y²) / (1 + z) is 1 - z without cancellation.
    const left = 1 - (x * x + y * y) / (1 + z) / open;
    if (!(left > 0)) return nothing;
    return .{
        .radiance = .{ p.radiance[0] * left, p.radiance[1] * left, p.radiance[2] * left },
        .pdf = left / (pi * open),
    };
}

/// 1 - cos spread, in a form that keeps its digits when the cone is narrow.
fn opening(p: *const Params) f32 {
    const s = @sin(p.spread * (pi / 360.0));
    return 2 * s * s;
}
