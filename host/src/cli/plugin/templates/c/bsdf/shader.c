// {{Name}}: matt paint that sends part of the light back to where it came from. Freestanding C, no imports.
//
//     f(wo, wi) = tint ((1 - retro) / pi + retro * 17 / (2 pi) * max(0, wo . wi)^15),   on the front only
//
// 17 / (2 pi) keeps the lobe from sending back more than it gets at any angle.

#define EXPORT(name) __attribute__((export_name(name)))

static const float PI = 3.14159265f;

enum { NO_LOBE = 0, DIFFUSE_REFLECTION = 1, GLOSSY_REFLECTION = 2 };

typedef struct { float x, y, z; } Vec3;

// The parameter block; manifest.json tells the host its offsets.
typedef struct { float tint[3], retro; } Params;

typedef struct { float value[3], pdf, pdf_rev; } EvalOut;

typedef struct { Vec3 wi; float weight[3], pdf, pdf_rev; unsigned lobe; float eta; } SampleOut;

_Static_assert(sizeof(EvalOut) == 20 && sizeof(SampleOut) == 40, "records of ABI 1.0");

// The manifest becomes a custom section of the module.
__asm__(".section .custom_section.bidir.manifest,\"\",@\n"
        ".incbin \"manifest.json\"\n");

EXPORT("bidir_abi") int bidir_abi(void) { return 1 << 16; }

EXPORT("bidir_scratch") void *bidir_scratch(unsigned bytes) {
    static _Alignas(16) unsigned char region[8192];
    if (bytes <= sizeof region) return region;
    const unsigned page = 65536, old = __builtin_wasm_memory_grow(0, bytes / page + (bytes % page != 0));
    return old == ~0u ? 0 : (void *)(old * page);
}

static float max(float a, float b) { return a > b ? a : b; }
static float dot(Vec3 a, Vec3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }

// d^15 for d from 0 to 1.
static float power_15(float d) {
    const float d2 = d * d, d4 = d2 * d2;
    return d4 * d4 * d4 * d2 * d;
}

// How densely both lobes together make a direction of cosine `cos` that encloses an angle of cosine `d` with the other one.
static float density(const Params *p, float cos, float d) {
    return (1.0f - p->retro) * (cos / PI) + p->retro * (16.0f / (2.0f * PI) * power_15(d));
}

static EvalOut eval(const Params *p, Vec3 wo, Vec3 wi) {
    EvalOut out = { {0.0f, 0.0f, 0.0f}, 0.0f, 0.0f};
    if (!(wo.z > 0.0f && wi.z > 0.0f)) return out;
    const float d = max(0.0f, dot(wo, wi));
    const float f = (1.0f - p->retro) / PI + p->retro * (17.0f / (2.0f * PI) * power_15(d));
    for (int band = 0; band < 3; band++) out.value[band] = p->tint[band] * (f * wi.z);
    out.pdf = density(p, wi.z, d);
    out.pdf_rev = density(p, wo.z, d);
    return out;
}

EXPORT("bsdf_eval")
void bsdf_eval(EvalOut *out, const Params *p, int carried, float ox, float oy, float oz, float ix, float iy, float iz) {
    *out = eval(p, (Vec3){ox, oy, oz}, (Vec3){ix, iy, iz});
}

// Cosine and sine of the angle u turns round: Taylor series about the middle of the nearest quarter.
static void circle(float u, float *cosine, float *sine) {
    const int quarter = (int)(4.0f * u + 0.5f);
    const double x = 2.0 * 3.14159265358979324 * (u - 0.25 * quarter), s = x * x;
    const float c = 1.0 + s * (-1.0 / 2 + s * (1.0 / 24 + s * (-1.0 / 720 + s * (1.0 / 40320 + s * (-1.0 / 3628800)))));
    const float n = x * (1.0 + s * (-1.0 / 6 + s * (1.0 / 120 + s * (-1.0 / 5040 + s * (1.0 / 362880 + s * (-1.0 / 39916800))))));
    *cosine = quarter & 1 ? (quarter & 2 ? n : -n) : (quarter & 2 ? -c : c);
    *sine = quarter & 1 ? (quarter & 2 ? -c : c) : (quarter & 2 ? -n : n);
}

// A direction of cosine `cos` to z.
static Vec3 about_z(float cos, float u) {
    const float r = __builtin_sqrtf(max(0.0f, 1.0f - cos * cos));
    float x, y;
    circle(u, &x, &y);
    return (Vec3){r * x, r * y, cos};
}

// `v`, with z turned to the unit vector `z` (Duff et al. 2017).
static Vec3 turned(Vec3 v, Vec3 z) {
    const float sign = z.z >= 0.0f ? 1.0f : -1.0f, a = -1.0f / (sign + z.z), b = z.x * z.y * a;
    return (Vec3){
        v.x * (1.0f + sign * z.x * z.x * a) + v.y * b + v.z * z.x,
        v.x * sign * b + v.y * (sign + z.y * z.y * a) + v.z * z.y,
        v.x * -sign * z.x + v.y * -z.y + v.z * z.z,
    };
}

EXPORT("bsdf_sample")
void bsdf_sample(SampleOut *out, const Params *p, int carried, float ox, float oy, float oz, float u0, float u1, float u2) {
    const Vec3 wo = {ox, oy, oz};
    const int back = u2 < p->retro;
    *out = (SampleOut){.lobe = NO_LOBE};
    if (!(wo.z > 0.0f)) return;
    // The cosine has density 16 d^15 about wo: the sixteenth root; about the normal 2 cos: the square root.
    const float root = __builtin_sqrtf(u0);
    const float root_16 = __builtin_sqrtf(__builtin_sqrtf(__builtin_sqrtf(root)));
    const Vec3 wi = back ? turned(about_z(root_16, u1), wo) : about_z(root, u1);
    // Below the surface, where eval knows nothing, there is no sample.
    const EvalOut both = eval(p, wo, wi);
    if (!(both.pdf > 0.0f)) return;
    out->wi = wi;
    for (int band = 0; band < 3; band++) out->weight[band] = both.value[band] / both.pdf;
    out->pdf = both.pdf;
    out->pdf_rev = both.pdf_rev;
    out->lobe = back ? GLOSSY_REFLECTION : DIFFUSE_REFLECTION;
    out->eta = 1.0f;
}
