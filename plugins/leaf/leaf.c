// A thin sheet that scatters light back and lets light through: README.md defines it, ../README.md is the ABI.
// Freestanding C: no library, no imports.

#define EXPORT(name) __attribute__((export_name(name)))

static const float PI_4 = 0.785398163f, PI_2 = 1.57079633f, INV_PI = 0.318309886f;

enum { NO_LOBE = 0, DIFFUSE_REFLECTION = 1, DIFFUSE_TRANSMISSION = 8 };

typedef struct { float r, g, b; } Rgb;

typedef struct { Rgb front, back, transmittance; } Params;

typedef struct { Rgb value; float pdf, pdf_rev; } EvalOut;

typedef struct { float wo[3], wi[3]; EvalOut out; } EvalRecord;

typedef struct { float wi[3]; Rgb weight; float pdf, pdf_rev; unsigned lobe; float eta; } SampleOut;

_Static_assert(sizeof(EvalOut) == 20 && sizeof(EvalRecord) == 44 && sizeof(SampleOut) == 40, "records of ABI 1.0");

// The manifest becomes a custom section of the module; wasm-ld keeps it.
__asm__(".section .custom_section.bidir.manifest,\"\",@\n"
        ".incbin \"leaf.json\"\n");

EXPORT("bidir_abi") int bidir_abi(void) { return 1 << 16; }

EXPORT("bidir_scratch") void *bidir_scratch(unsigned bytes) {
    static _Alignas(16) unsigned char region[8192];
    if (bytes <= sizeof region) return region;
    const unsigned page = 65536, old = __builtin_wasm_memory_grow(0, bytes / page + (bytes % page != 0));
    return old == ~0u ? 0 : (void *)(old * page);
}

static float min(float a, float b) { return a < b ? a : b; }
static float max(float a, float b) { return a > b ? a : b; }
static Rgb scaled(Rgb c, float s) { return (Rgb){c.r * s, c.g * s, c.b * s}; }
static float mean(Rgb c) { return (c.r + c.g + c.b) / 3.0f; }

// A surface direction's side: z is neither 0 nor NaN.
static int has_side(float z) { return z > 0.0f || z < 0.0f; }

static Rgb reflectance(const Params *p, float z) { return z > 0.0f ? p->front : p->back; }

// What passes, so that no side gives more than it gets.
static Rgb transmittance(const Params *p) {
    const Rgb t = p->transmittance, f = p->front, b = p->back;
    return (Rgb){min(t.r, 1.0f - max(f.r, b.r)), min(t.g, 1.0f - max(f.g, b.g)), min(t.b, 1.0f - max(f.b, b.b))};
}

// The chance that light from the side of `z` goes on through the sheet, or on that side; a black side absorbs.
static float chance(const Params *p, float z, int through) {
    const float r = mean(reflectance(p, z)), t = mean(transmittance(p));
    if (!(r + t > 0.0f)) return 0.0f;
    const float pass = t / (r + t);
    return through ? pass : 1.0f - pass;
}

static void densities(const Params *p, float wo_z, float wi_z, float *pdf, float *pdf_rev) {
    const int through = (wo_z > 0.0f) != (wi_z > 0.0f);
    *pdf = chance(p, wo_z, through) * (__builtin_fabsf(wi_z) * INV_PI);
    *pdf_rev = chance(p, wi_z, through) * (__builtin_fabsf(wo_z) * INV_PI);
}

static EvalOut eval(const Params *p, float wo_z, float wi_z) {
    EvalOut out = {{0.0f, 0.0f, 0.0f}, 0.0f, 0.0f};
    if (!has_side(wo_z) || !has_side(wi_z)) return out;
    const Rgb albedo = (wo_z > 0.0f) != (wi_z > 0.0f) ? transmittance(p) : reflectance(p, wo_z);
    out.value = scaled(albedo, __builtin_fabsf(wi_z) * INV_PI);
    densities(p, wo_z, wi_z, &out.pdf, &out.pdf_rev);
    return out;
}

EXPORT("bsdf_eval")
void bsdf_eval(EvalOut *out, const Params *p, int carried, float ox, float oy, float oz, float ix, float iy, float iz) {
    *out = eval(p, oz, iz);
}

EXPORT("bsdf_eval_n") void bsdf_eval_n(EvalRecord *records, int n, const Params *p, int carried) {
    for (int i = 0; i < n; i++) records[i].out = eval(p, records[i].wo[2], records[i].wi[2]);
}

// Sine and cosine of x in [-π/4, π/4]: Taylor series in f64, good to the last digit of an f32.
static double small_sin(double x) {
    const double s = x * x;
    return x * (1.0 + s * (-1.0 / 6 + s * (1.0 / 120 + s * (-1.0 / 5040 + s * (1.0 / 362880 + s * (-1.0 / 39916800))))));
}

static double small_cos(double x) {
    const double s = x * x;
    return 1.0 + s * (-1.0 / 2 + s * (1.0 / 24 + s * (-1.0 / 720 + s * (1.0 / 40320 + s * (-1.0 / 3628800 + s * (1.0 / 479001600))))));
}

// Cosine-weighted on the hemisphere about z (Shirley & Chiu 1997).
static void cosine_hemisphere(float u0, float u1, float w[3]) {
    const float a = 2.0f * u0 - 1.0f, b = 2.0f * u1 - 1.0f;
    float x = 0.0f, y = 0.0f;
    if (a != 0.0f || b != 0.0f) {
        const int wide = __builtin_fabsf(a) > __builtin_fabsf(b);
        const float r = wide ? a : b, phi = wide ? PI_4 * (b / a) : PI_2 - PI_4 * (a / b);
        // The second kind of angle is up to 3π/4, and as far from π/2 as the first is from 0.
        const double from = wide ? phi : 1.5707963267948966 - phi;
        const float sine = small_sin(from), cosine = small_cos(from);
        x = r * (wide ? cosine : sine);
        y = r * (wide ? sine : cosine);
    }
    w[0] = x;
    w[1] = y;
    w[2] = max(__builtin_sqrtf(max(1.0f - x * x - y * y, 0.0f)), 1e-7f);
}

EXPORT("bsdf_sample")
void bsdf_sample(SampleOut *out, const Params *p, int carried, float ox, float oy, float oz, float u0, float u1, float u2) {
    *out = (SampleOut){.lobe = NO_LOBE};
    if (!has_side(oz)) return;
    const float pass = chance(p, oz, 1), stay = chance(p, oz, 0);
    if (!(pass + stay > 0.0f)) return;
    const int through = u2 < pass;
    cosine_hemisphere(u0, u1, out->wi);
    if (through == (oz > 0.0f)) out->wi[2] = -out->wi[2];
    const Rgb albedo = through ? transmittance(p) : reflectance(p, oz);
    const float made = through ? pass : stay;
    out->weight = (Rgb){albedo.r / made, albedo.g / made, albedo.b / made};
    densities(p, oz, out->wi[2], &out->pdf, &out->pdf_rev);
    out->lobe = through ? DIFFUSE_TRANSMISSION : DIFFUSE_REFLECTION;
    out->eta = 1.0f;
}
