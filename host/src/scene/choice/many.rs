//! The choice among many lights: those infinitely far away, which reach all receivers alike, beside a tree of the others.

use bidir_kernel::{Chance, Point, Real};

use super::{
    draw::{Draw, STEP},
    node::{self, Receiver},
    tree::Tree,
};
use crate::scene::lights::{LightId, LightSource};

/// Many lights.
#[derive(Clone, Debug)]
pub(super) struct Many {
    far: Far,
    tree: Option<Tree>,
}

/// What the lights infinitely far away have at least, and the others too, where there are both and both reach the receiver: what stands
/// in the way of a light counts for neither, and a roof keeps the sun from all receivers under it.
const LEAST: f64 = 1.0 / 8.0;

impl Many {
    /// There must be fewer lights than this.
    pub const MOST: usize = node::MOST;

    pub fn new(sources: &[LightSource]) -> Self {
        Self { far: Far::new(sources), tree: Tree::new(sources) }
    }

    /// Chooses a light.
    pub fn pick(&self, lit: &Point, u: Real) -> Option<(LightId, Chance)> {
        let receiver = Receiver::new(lit);
        let mut draw = Draw::new(u, lit);
        let far = self.far_chance(&receiver);
        let (light, chance) = if draw.is_below(far) {
            let (light, share) = self.far.pick(draw.left());
            (light, far * share)
        } else {
            self.tree.as_ref()?.pick(&receiver, &mut draw, 1.0 - far)?
        };
        let chance = chance as Real;
        (chance > 0.0).then_some((LightId(light), Chance(chance)))
    }

    /// The chance that [`Many::pick`] chooses `id`.
    pub fn chance(&self, LightId(light): LightId, lit: &Point) -> Chance {
        let receiver = Receiver::new(lit);
        let far = self.far_chance(&receiver);
        let chance = match (self.far.share(light), &self.tree) {
            (Some(share), _) => far * share,
            (None, Some(tree)) => tree.chance(light, &receiver, 1.0 - far),
            (None, None) => 0.0,
        };
        Chance(chance as Real)
    }

    /// The chance of those infinitely far away.
    fn far_chance(&self, receiver: &Receiver) -> f64 {
        if self.far.lights.is_empty() {
            return 0.0;
        }
        let arriving = self.tree.as_ref().map_or(0.0, |tree| tree.arriving(receiver));
        if arriving > 0.0 { (self.far.irradiance / (self.far.irradiance + arriving)).clamp(LEAST, 1.0 - LEAST) } else { 1.0 }
    }
}

/// Lights infinitely far away.
#[derive(Clone, Debug, Default)]
struct Far {
    /// Their numbers among all, ascending.
    lights: Vec<u32>,
    /// Of each, the chances up to its own and with it: in proportion to what it brings, and some for being one.
    cumulative: Vec<f64>,
    /// What they bring together, W/m².
    irradiance: f64,
}

impl Far {
    fn new(sources: &[LightSource]) -> Self {
        let reaching = || sources.iter().zip(0..).filter_map(|(source, light)| Some((light, source.reaching_all()?)));
        let irradiance: f64 = reaching().map(|(_, reaching)| reaching).sum();
        let even = STEP / reaching().count() as f64;
        let mut far = Self { irradiance, ..Self::default() };
        let mut sum = 0.0;
        for (light, reaching) in reaching() {
            sum += (1.0 - STEP) * (reaching / irradiance) + even;
            far.lights.push(light);
            far.cumulative.push(sum);
        }
        far
    }

    /// The one that `u` in [0, 1) chooses, and its share. There must be one.
    fn pick(&self, u: f64) -> (u32, f64) {
        let index = self.cumulative.partition_point(|&sum| sum <= u).min(self.lights.len() - 1);
        (self.lights[index], self.at(index))
    }

    /// The share of a light among these; `None` if it is not one of them.
    fn share(&self, light: u32) -> Option<f64> {
        Some(self.at(self.lights.binary_search(&light).ok()?))
    }

    fn at(&self, index: usize) -> f64 {
        self.cumulative[index] - if index == 0 { 0.0 } else { self.cumulative[index - 1] }
    }
}
