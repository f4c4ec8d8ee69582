//! The choice among lights: for a light walk by power; for a receiver by what reaches it, or, among many lights, by power.

use bidir_kernel::{
    Chance, Point, Profile, Real, Vec2, Vec3, math,
    point::Place,
    real::{INV_PI, PI},
};

use crate::{
    plugin::Sandbox,
    scene::{
        extent::{Ellipse, Flat, LightExtent, Parallelogram},
        lights::{LightId, LightSource, SceneLight, Seat},
    },
};

/// Up to this many lights, next event looks at each one from where it stands.
const MOST_LOOKED_AT: usize = 16;

/// How many numbers a sampler can give: multiples of 2^−24.
const STEPS: u64 = 1 << 24;

/// The lights and the choice among them: for a light walk by power; for a receiver by what reaches it, or, among many lights, by power.
#[derive(Clone, Debug, Default)]
pub struct Lights {
    sources: Vec<LightSource>,
    /// Each one's share of the power.
    shares: Vec<Real>,
    /// Those shares, added up.
    cumulative: Vec<Real>,
    environment: Option<LightId>,
}

impl Lights {
    /// Those of `sources` that shine at all; the others are dropped. The second value maps an index in `sources` to its light.
    pub fn new(sources: Vec<LightSource>) -> (Self, Vec<Option<LightId>>) {
        let powers: Vec<f64> = sources.iter().map(LightSource::power).collect();
        let shines = |power: f64| power > 0.0 && power.is_finite();
        let total: f64 = powers.iter().filter(|&&power| shines(power)).sum();
        let count = powers.iter().filter(|&&power| shines(power)).count();
        let mut lights = Self::default();
        let mut ids = Vec::with_capacity(sources.len());
        let (mut sum, mut before) = (0.0, 0);
        for (source, power) in sources.into_iter().zip(powers) {
            ids.push(shines(power).then_some(LightId(lights.sources.len() as u32)));
            if !shines(power) {
                continue;
            }
            if matches!(source.seat, Seat::Environment { .. }) {
                lights.environment = Some(LightId(lights.sources.len() as u32));
            }
            lights.sources.push(source);
            // Random numbers come in steps. A light owns a whole number of them, at least one, however weak it is: so what is
            // picked and what is asked afterwards agree exactly.
            sum += power / total;
            let end = lights.sources.len() as u64 + (sum.min(1.0) * (STEPS.saturating_sub(count as u64)) as f64).round() as u64;
            lights.shares.push((end - before) as Real / STEPS as Real);
            lights.cumulative.push(end as Real / STEPS as Real);
            before = end;
        }
        (lights, ids)
    }

    /// All of them.
    pub fn sources(&self) -> &[LightSource] {
        &self.sources
    }

    /// The one that escaping rays land on.
    #[inline]
    pub fn environment(&self) -> Option<LightId> {
        self.environment
    }

    /// The light `id`.
    #[inline]
    pub fn get<'a>(&'a self, id: LightId, sandbox: &'a Sandbox) -> SceneLight<'a> {
        self.sources[id.0 as usize].asked(sandbox)
    }

    /// Chooses a light for `lit`, or, without one, to start a light walk from.
    #[inline]
    pub fn pick(&self, lit: Option<&Point>, u: Real, sandbox: &Sandbox) -> Option<(LightId, Chance)> {
        match lit {
            Some(lit) if self.looks(lit) => self.pick_reaching(lit, u, sandbox),
            _ => {
                let index = self.cumulative.partition_point(|&sum| sum <= u).min(self.sources.len().checked_sub(1)?);
                Some((LightId(index as u32), Chance(self.shares[index])))
            }
        }
    }

    /// The chance that [`Lights::pick`] chooses `id`.
    #[inline]
    pub fn chance(&self, id: LightId, lit: Option<&Point>, sandbox: &Sandbox) -> Chance {
        match lit {
            Some(lit) if self.looks(lit) => {
                if self.sources.len() == 1 {
                    return Chance(1.0);
                }
                let total: Real = self.sources.iter().map(|source| source.reaching(lit, sandbox)).sum();
                Chance(if total > 0.0 { self.sources[id.0 as usize].reaching(lit, sandbox) / total } else { 0.0 })
            }
            _ => Chance(self.shares[id.0 as usize]),
        }
    }

    fn looks(&self, lit: &Point) -> bool {
        self.sources.len() <= MOST_LOOKED_AT && lit.place != Place::Distant
    }

    fn pick_reaching(&self, lit: &Point, u: Real, sandbox: &Sandbox) -> Option<(LightId, Chance)> {
        if self.sources.len() == 1 {
            return Some((LightId(0), Chance(1.0)));
        }
        let mut reaching = [0.0; MOST_LOOKED_AT];
        let mut total = 0.0;
        for (slot, source) in reaching.iter_mut().zip(&self.sources) {
            *slot = source.reaching(lit, sandbox);
            total += *slot;
        }
        let mut rest = u * total;
        let mut last = None;
        for (index, &reaching) in reaching[..self.sources.len()].iter().enumerate() {
            if reaching > 0.0 {
                last = Some((LightId(index as u32), Chance(reaching / total)));
                if rest < reaching {
                    return last;
                }
                rest -= reaching;
            }
        }
        last
    }
}

impl LightSource {
    /// About how much reaches `lit`, W/m², mean of the bands; 0 only where nothing does. What next event chooses by.
    fn reaching(&self, lit: &Point, sandbox: &Sandbox) -> Real {
        match &self.seat {
            Seat::Shape(extent) => self.outflow.exitance as Real * INV_PI * solid_angle(extent, lit),
            Seat::Point { position, frame } => {
                let away = lit.position - *position;
                let Some(direction) = math::normalize(away) else { return 0.0 };
                let intensity = self.profile.asked(sandbox).eval(Vec2::ZERO, frame.to_local(direction)).radiance.mean();
                intensity / math::dot(away, away).max(Real::MIN_POSITIVE)
            }
            // Surroundings are brighter on one side than on the other.
            Seat::Environment { .. } => 0.5 * self.outflow.total as Real,
            Seat::Directional(light) => light.irradiance.mean(),
        }
    }
}

fn distance_squared(position: Vec3, lit: &Point) -> Real {
    let d = position - lit.position;
    math::dot(d, d).max(Real::MIN_POSITIVE)
}

/// About the solid angle under which `lit` sees a light's front; 0 only behind a flat one.
fn solid_angle(extent: &LightExtent, lit: &Point) -> Real {
    let flat = |shape: &Flat| {
        let area = shape.area;
        let d = lit.position - shape.center;
        let height = math::dot(d, shape.frame.z);
        let height = if shape.both_sides() { height.abs() } else { height };
        if height <= 0.0 && !shape.both_sides() {
            return 0.0;
        }
        let squared = math::dot(d, d);
        // Near by, a flat light fills at most the hemisphere, and its edges stand higher than its middle.
        let cos = (height / math::sqrt(squared)).max(0.05);
        2.0 * PI * (area * cos) / (area * cos + 2.0 * PI * squared)
    };
    let round = |center: Vec3, area: Real| 4.0 * PI * area / (area + 16.0 * PI * distance_squared(center, lit));
    match extent {
        LightExtent::Parallelogram(Parallelogram(shape)) | LightExtent::Ellipse(Ellipse(shape)) => flat(shape),
        LightExtent::Ball(ball) => round(ball.center, extent.area()),
        LightExtent::Tube(tube) => round(tube.base + tube.axis * 0.5, extent.area()),
        LightExtent::Surface(surface) => round(surface.center, extent.area()),
    }
}

#[cfg(test)]
mod tests {
    use bidir_kernel::{Frame, Spectrum};
    use bidir_standard::Isotropic;

    use super::*;
    use crate::scene::lights::ProfileSource;

    fn point(intensity: Real, sandbox: &Sandbox) -> LightSource {
        let profile = ProfileSource::Isotropic(Isotropic { intensity: Spectrum::splat(intensity) });
        LightSource::new(Seat::Point { position: Vec3::ZERO, frame: Frame::from_z(Vec3::Z) }, profile, sandbox)
    }

    fn sandbox() -> Sandbox {
        Sandbox::new(Default::default(), Default::default())
    }

    #[test]
    fn what_is_picked_and_what_is_asked_agree_whatever_lights_are_black() {
        let intensities = [0.0, 1.0, 0.0, 1e-12, 3.0, 0.0];
        let sandbox = sandbox();
        let (lights, ids) = Lights::new(intensities.map(|intensity| point(intensity, &sandbox)).to_vec());
        assert_eq!(ids, [None, Some(LightId(0)), None, Some(LightId(1)), Some(LightId(2)), None]);
        let mut total = 0.0;
        for id in 0..3 {
            let Chance(chance) = lights.chance(LightId(id), None, &sandbox);
            // The first and the last number of the light's own.
            let first = f64::from(total);
            total += chance;
            for u in [first, f64::from(total) - 1.0 / STEPS as f64] {
                assert_eq!(lights.pick(None, u as Real, &sandbox), Some((LightId(id), Chance(chance))), "{u}");
            }
            assert!(chance > 0.0);
        }
        assert_eq!(total, 1.0);
    }

    #[test]
    fn many_lights_share_all_the_chance_there_is() {
        let sandbox = sandbox();
        let (lights, _) = Lights::new((0..1000).map(|i| point(if i == 500 { 1e6 } else { 1e-6 }, &sandbox)).collect());
        let sum: f64 = (0..1000).map(|id| f64::from(lights.chance(LightId(id), None, &sandbox).0)).sum();
        assert_eq!(sum, 1.0);
    }
}
