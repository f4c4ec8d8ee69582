//! The kernel inside another program, which brings geometry (a ball), one BSDF, one light (a sky), a film and storage.
use bidir_kernel::{camera::*, light::EnvironmentLight, profile::Profiled, sampler::Independent, *};
struct Clay; // Lambert: f = ρ/π with ρ = 1/2, sampled by the cosine.
impl Bsdf for Clay {
    fn eval(&self, wo: Vec3, wi: Vec3, _: Carried) -> Scatter {
        let (pdf, pdf_rev) = (warp::cosine_hemisphere_pdf(wi.z), warp::cosine_hemisphere_pdf(wo.z));
        Scatter { value: Spectrum::splat(0.5 * pdf), pdf: PerSolidAngle(pdf), pdf_rev: PerSolidAngle(pdf_rev) }
    }
    fn sample(&self, wo: Vec3, u: [Real; 3], carried: Carried) -> Option<Scattered> {
        let wi = warp::cosine_hemisphere([u[0], u[1]]);
        let Scatter { pdf, pdf_rev, .. } = self.eval(wo, wi, carried);
        Some(Scattered { wi, weight: Spectrum::splat(0.5), made: Made::Smooth { pdf, pdf_rev }, eta: 1.0, lobe: self.lobes() })
    }
    fn lobes(&self) -> Lobe {
        Lobe::DIFFUSE_REFLECTION
    }
}
struct Sky; // Brighter towards one side. Directions travel from the sky into the scene.
impl Profile for Sky {
    fn eval(&self, _: Vec2, d: Vec3) -> Profiled {
        Profiled { radiance: Spectrum([0.5, 0.6, 0.8]) * (1.0 - 0.9 * d.x), pdf: PerSolidAngle(warp::SPHERE_PDF) }
    }
    fn emit(&self, uv: Vec2, u: [Real; 2]) -> Option<Emitted> {
        let direction = warp::sphere(u);
        Some(Emitted { direction, profiled: self.eval(uv, direction) })
    }
}
struct World(Perspective);
impl Scene for World {
    type Hit = ();
    type LightId = ();
    type Camera = Perspective;
    type Bsdf<'a> = Clay;
    type Light<'a> = EnvironmentLight<Sky>;
    fn camera(&self) -> &Perspective {
        &self.0
    }
    fn intersect(&self, ray: &Ray) -> Option<(Point, ())> {
        let (o, d) = (ray.origin, ray.direction); // the unit ball, from outside
        let (a, b) = (d.dot(d), o.dot(d));
        let t = (-b - (b * b - a * (o.dot(o) - 1.0)).sqrt()) / a;
        let at = (o + d * t).normalize();
        (t > 0.0 && t < ray.t_max).then(|| (Point::surface(at, at, Frame::from_z(at), Vec2::ZERO, 1e-5), ()))
    }
    fn bsdf(&self, _: &Point, (): ()) -> Clay {
        Clay
    }
    fn light(&self, (): ()) -> EnvironmentLight<Sky> {
        EnvironmentLight { center: Vec3::ZERO, radius: 9.0, frame: Frame::from_z(Vec3::Y), profile: Sky }
    }
    fn environment(&self) -> Option<()> {
        Some(())
    }
    fn lights(&self) -> &[()] {
        &[()]
    }
}
const SIZE: usize = 128;
struct Picture(Vec<Spectrum>, usize);
impl Film for Picture {
    type Rivals = Together;
    fn add(&mut self, c: Contribution) {
        self.0[self.1] += c.value * c.weight;
    }
    fn splat(&mut self, at: Vec2, c: Contribution) {
        self.0[at.y as usize * SIZE + at.x as usize] += c.value * c.weight;
    }
}
fn main() -> image::ImageResult<()> {
    let film = FilmPlane::centred(Vec2::splat(SIZE as Real), 0.4);
    let world = World(Perspective::pinhole(Vec3::new(0.0, 0.0, 5.0), [Vec3::X, Vec3::Y, Vec3::NEG_Z], film));
    let strategy = Strategy::new(Techniques::BIDIRECTIONAL, 8);
    let (mut camera_path, mut light_path) = ([const { None }; 7], [const { None }; 7]);
    let mut picture = Picture(vec![Spectrum::BLACK; SIZE * SIZE], 0);
    for i in 0..64 * SIZE * SIZE {
        picture.1 = i / 64;
        let raster = Vec2::new((picture.1 % SIZE) as Real + 0.5, (picture.1 / SIZE) as Real + 0.5);
        sample(&world, &strategy, &mut Independent::new(1, 0, i as u64), raster, &mut camera_path, &mut light_path, &mut picture);
    }
    let bytes: Vec<_> = picture.0.iter().flat_map(|p| p.0.map(|v| ((v / 64.0).sqrt().min(1.0) * 255.0) as u8)).collect();
    image::save_buffer("embed.png", &bytes, SIZE as u32, SIZE as u32, image::ColorType::Rgb8)
}
