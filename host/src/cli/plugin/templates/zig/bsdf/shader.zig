//! {{Name}}: matt paint that sends part of the light back to where it came from. No imports.
//!
//!     f(wo, wi) = tint ((1 - retro) / pi + retro * 17 / (2 pi) * max(0, wo . wi)^15),   on the front only
//!
//! 17 / (2 pi) keeps the lobe from sending back more than it gets at any angle.

const pi: f32 = 3.1415926535897932;

const Lobe = enum(u32) { none = 0, diffuse_reflection = 1, glossy_reflection = 2 };

/// The parameter block; manifest.json tells the host its offsets.
const Params = extern struct { tint: [3]f32, retro: f32 };

const EvalOut = extern struct { value: [3]f32, pdf: f32, pdf_rev: f32 };

const SampleOut = extern struct { wi: [3]f32, weight: [3]f32, pdf: f32, pdf_rev: f32, lobe: Lobe, eta: f32 };

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

export fn bsdf_eval(out: *EvalOut, p: *const Params, _: i32, ox: f32, oy: f32, oz: f32, ix: f32, iy: f32, iz: f32) void {
    out.* = eval(p, .{ ox, oy, oz }, .{ ix, iy, iz });
}

export fn bsdf_sample(out: *SampleOut, p: *const Params, _: i32, ox: f32, oy: f32, oz: f32, ua: f32, ub: f32, uc: f32) void {
    out.* = .{ .wi = @splat(0), .weight = @splat(0), .pdf = 0, .pdf_rev = 0, .lobe = .none, .eta = 0 };
    if (!(oz > 0)) return;
    const wo = [3]f32{ ox, oy, oz };
    const back = uc < p.retro;
    // The cosine has density 16 d^15 about wo: the sixteenth root; about the normal 2 cos: the square root.
    const root = @sqrt(ua);
    const wi = if (back) turned(aboutZ(@sqrt(@sqrt(@sqrt(root))), ub), wo) else aboutZ(root, ub);
    const both = eval(p, wo, wi);
    // Below the surface, where eval knows nothing, there is no sample.
    if (!(both.pdf > 0)) return;
    out.* = .{
        .wi = wi,
        .weight = .{ both.value[0] / both.pdf, both.value[1] / both.pdf, both.value[2] / both.pdf },
        .pdf = both.pdf,
        .pdf_rev = both.pdf_rev,
        .lobe = if (back) .glossy_reflection else .diffuse_reflection,
        .eta = 1,
    };
}

fn eval(p: *const Params, wo: [3]f32, wi: [3]f32) EvalOut {
    if (!(wo[2] > 0 and wi[2] > 0)) return .{ .value = @splat(0), .pdf = 0, .pdf_rev = 0 };
    const d = @max(0, wo[0] * wi[0] + wo[1] * wi[1] + wo[2] * wi[2]);
    const f = (1 - p.retro) / pi + p.retro * (17.0 / (2.0 * pi) * power15(d));
    return .{
        .value = .{ p.tint[0] * (f * wi[2]), p.tint[1] * (f * wi[2]), p.tint[2] * (f * wi[2]) },
        .pdf = density(p, wi[2], d),
        .pdf_rev = density(p, wo[2], d),
    };
}

/// How densely both lobes together make a direction of cosine `cos` that encloses an angle of cosine `d` with the other one.
fn density(p: *const Params, cos: f32, d: f32) f32 {
    return (1 - p.retro) * (cos / pi) + p.retro * (16.0 / (2.0 * pi) * power15(d));
}

/// d^15 for d from 0 to 1.
fn power15(d: f32) f32 {
    const d2 = d * d;
    const d4 = d2 * d2;
    return d4 * d4 * d4 * d2 * d;
}

/// A direction of cosine `cos` to z.
fn aboutZ(cos: f32, u: f32) [3]f32 {
    const r = @sqrt(@max(0, 1 - cos * cos));
    const phi = 2 * pi * u;
    return .{ r * @cos(phi), r * @sin(phi), cos };
}

/// `v`, with z turned to the unit vector `z`, which is above the surface (Duff et al. 2017).
fn turned(v: [3]f32, z: [3]f32) [3]f32 {
    const a = -1 / (1 + z[2]);
    const b = z[0] * z[1] * a;
    return .{
        v[0] * (1 + z[0] * z[0] * a) + v[1] * b + v[2] * z[0],
        v[0] * b + v[1] * (1 + z[1] * z[1] * a) + v[2] * z[1],
        v[2] * z[2] - v[0] * z[0] - v[1] * z[1],
    };
}
