//! A projector with a pattern before its lens: README.md defines it, ../README.md is the ABI.
//! No imports; of the standard library only functions of numbers.

const Pattern = enum(i32) { window, stripes, slats, dots, _ };

const Params = extern struct {
    intensity: [3]f32,
    half_width: f32,
    half_height: f32,
    pattern: Pattern,
    count: i32,
    opening: f32,
    softness: f32,
};

const EvalOut = extern struct { radiance: [3]f32, pdf: f32 };

const EmitOut = extern struct { direction: [3]f32, out: EvalOut };

const nothing: EvalOut = .{ .radiance = .{ 0, 0, 0 }, .pdf = 0 };

const radians: f32 = 0.017453292519943295;

// The manifest becomes a custom section of the module.
comptime {
    asm (".section .custom_section.bidir.manifest,\"\",@\n.incbin \"gobo.json\"\n");
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

export fn light_eval(out: *EvalOut, params: *const Params, _: f32, _: f32, x: f32, y: f32, z: f32) void {
    out.* = eval(params, x, y, z);
}

export fn light_emit(out: *EmitOut, params: *const Params, _: f32, _: f32, s: f32, t: f32) void {
    const px = tangent(params.half_width) * (2 * s - 1);
    const py = tangent(params.half_height) * (2 * t - 1);
    const l = @sqrt((px * px + py * py) + 1);
    out.direction = .{ px / l, py / l, 1 / l };
    out.out = eval(params, px / l, py / l, 1 / l);
}

fn eval(params: *const Params, x: f32, y: f32, z: f32) EvalOut {
    if (!(z > 0)) return nothing;
    const a = tangent(params.half_width);
    const b = tangent(params.half_height);
    const px = x / z;
    const py = y / z;
    if (!(@abs(px) <= a and @abs(py) <= b)) return nothing;
    const open = transmitted(params, px / a, py / b);
    return .{
        .radiance = .{ params.intensity[0] * open, params.intensity[1] * open, params.intensity[2] * open },
        .pdf = 1 / (((4 * a) * b) * ((z * z) * z)),
    };
}

/// The share of light that passes at a place of the picture, from -1 to 1 across and up.
fn transmitted(params: *const Params, p: f32, q: f32) f32 {
    const n: f32 = @floatFromInt(params.count);
    const across = 0.5 * (p + 1) * n;
    const down = 0.5 * (q + 1) * n;
    const e = @abs(across - @floor(across) - 0.5);
    const f = @abs(down - @floor(down) - 0.5);
    const o = 0.5 * params.opening;
    const s = params.softness;
    const shape = switch (params.pattern) {
        .window => step(o - e, s) * step(o - f, s),
        .stripes => step(o - e, s),
        .slats => step(o - f, s),
        else => step(o - @sqrt(e * e + f * f), s),
    };
    return shape * (fade(0.5 * n * (1 - @abs(p)), s) * fade(0.5 * n * (1 - @abs(q)), s));
}

/// An edge at x = 0, blurred on both sides.
fn step(x: f32, softness: f32) f32 {
    if (softness == 0) return if (x > 0) 1 else 0;
    return smooth(x / softness + 0.5);
}

/// An edge at x = 0, blurred inwards.
fn fade(x: f32, softness: f32) f32 {
    if (softness == 0) return if (x > 0) 1 else 0;
    return smooth(x / softness);
}

fn smooth(x: f32) f32 {
    const t = @min(@max(x, 0), 1);
    return t * t * (3 - 2 * t);
}

fn tangent(degrees: f32) f32 {
    return @tan(degrees * radians);
}
