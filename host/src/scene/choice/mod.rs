//! The choice among lights: for a light walk by power; for a receiver by what reaches it.

mod cluster;
mod cone;
mod draw;
mod many;
mod node;
mod reach;
mod shares;
mod split;
#[cfg(test)]
mod tests;
mod tree;

use bidir_kernel::{Chance, Point, Real, point::Place};

use self::{many::Many, shares::Shares};
use crate::{
    plugin::Sandbox,
    scene::lights::{LightId, LightSource, SceneLight, Seat},
};

/// Up to this many lights, next event looks at each one from where it stands.
const MOST_LOOKED_AT: usize = 16;

/// The lights and the choice among them: for a light walk by power; for a receiver by what reaches it, of each light where they are few,
/// and of whole clusters of them, down a tree, where they are many.
#[derive(Clone, Debug, Default)]
pub struct Lights {
    sources: Vec<LightSource>,
    powers: Shares,
    next_event: NextEvent,
    environment: Option<LightId>,
}

/// What next event chooses by.
#[derive(Clone, Debug, Default)]
enum NextEvent {
    /// Nothing: there is but one light.
    Only,
    /// What reaches the receiver from each light.
    #[default]
    Each,
    /// What reaches it from clusters of lights.
    Clusters(Box<Many>),
    /// Power, whoever the receiver is.
    Power,
}

impl Lights {
    /// Those of `sources` that shine at all; the others are dropped. The second value maps an index in `sources` to its light.
    pub fn new(sources: Vec<LightSource>) -> (Self, Vec<Option<LightId>>) {
        let shines = |power: f64| power > 0.0 && power.is_finite();
        let (mut powers, mut ids) = (Vec::new(), Vec::with_capacity(sources.len()));
        let mut lights = Self::default();
        for source in sources {
            let (power, id) = (source.power(), LightId(lights.sources.len() as u32));
            ids.push(shines(power).then_some(id));
            if shines(power) {
                if matches!(source.seat, Seat::Environment { .. }) {
                    lights.environment = Some(id);
                }
                powers.push(power);
                lights.sources.push(source);
            }
        }
        lights.powers = Shares::new(&powers);
        lights.next_event = if lights.sources.len() == 1 {
            NextEvent::Only
        } else if lights.sources.len() <= MOST_LOOKED_AT {
            NextEvent::Each
        } else if lights.sources.len() < Many::MOST {
            NextEvent::Clusters(Box::new(Many::new(&lights.sources)))
        } else {
            NextEvent::Power
        };
        (lights, ids)
    }

    /// The same lights, chosen by power for receivers too. Images differ in noise alone: this is here to be measured against.
    pub fn by_power(self) -> Self {
        Self { next_event: NextEvent::Power, ..self }
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

    /// What [`Lights::pick`] answers a receiver that is not infinitely far away where there is but one light: whatever the number is.
    #[inline(always)]
    pub fn only(&self, lit: Option<&Point>) -> Option<(LightId, Chance)> {
        let near = lit.is_some_and(|lit| lit.place != Place::Distant);
        (near && matches!(self.next_event, NextEvent::Only)).then_some((LightId(0), Chance(1.0)))
    }

    /// Chooses a light for `lit`, or, without one, to start a light walk from. A receiver that is infinitely far away looks at none.
    #[inline]
    pub fn pick(&self, lit: Option<&Point>, u: Real, sandbox: &Sandbox) -> Option<(LightId, Chance)> {
        if let Some(only) = self.only(lit) {
            return Some(only);
        }
        match (&self.next_event, lit) {
            (NextEvent::Each, Some(lit)) if lit.place != Place::Distant => self.pick_reaching(lit, u, sandbox),
            (NextEvent::Clusters(many), Some(lit)) if lit.place != Place::Distant => many.pick(lit, u),
            _ => self.powers.pick(u).map(|(index, share)| (LightId(index as u32), Chance(share))),
        }
    }

    /// The chance that [`Lights::pick`] chooses `id`.
    #[inline]
    pub fn chance(&self, id: LightId, lit: Option<&Point>, sandbox: &Sandbox) -> Chance {
        match (&self.next_event, lit) {
            (NextEvent::Only, Some(lit)) if lit.place != Place::Distant => Chance(1.0),
            (NextEvent::Each, Some(lit)) if lit.place != Place::Distant => {
                let total: Real = self.sources.iter().map(|source| source.reaching(lit, sandbox)).sum();
                Chance(if total > 0.0 { self.sources[id.0 as usize].reaching(lit, sandbox) / total } else { 0.0 })
            }
            (NextEvent::Clusters(many), Some(lit)) if lit.place != Place::Distant => many.chance(id, lit),
            _ => Chance(self.powers.of(id.0 as usize)),
        }
    }

    fn pick_reaching(&self, lit: &Point, u: Real, sandbox: &Sandbox) -> Option<(LightId, Chance)> {
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
