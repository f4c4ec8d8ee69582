//! The tests of lights, cut into pieces.

use bidir_kernel::{Emitted, Profile, Real, Vec2, Vec3, profile::Profiled};

use super::{
    bridge::{Claim, Drawn, Found, Scatterer, compare},
    case::Case,
    dice::{Dice, stream},
    ledger::{Inputs, Ledger},
    significance::Significance,
    subject::{Lamps, Set},
    surface::{answered, at, corners, directions},
    tally::Tally,
    test::Test,
};

/// A piece of a check: one set of parameters.
#[derive(Clone, Copy, Debug)]
pub(super) struct Piece {
    pub(super) set: usize,
    pub(super) stream: u64,
}

/// Places on a surface that one set is asked about.
const PLACES: u64 = 4;

pub(super) fn pieces(sets: usize, seed: u64, on_surfaces: bool) -> Vec<Piece> {
    let places = if on_surfaces { PLACES } else { 1 };
    let piece = |set| move |place| Piece { set, stream: stream(seed, set as u64 * PLACES + place) };
    (0..sets).flat_map(|set| (0..places).map(piece(set))).collect()
}

/// So many samples more are a second look.
const AGAIN: usize = 8;

/// A profile at one place.
struct Spot<'a> {
    profile: &'a dyn Profile,
    set: &'a Set,
    uv: Vec2,
}

/// Does a piece with 2 to the power of `effort` samples.
pub(super) fn run(lamps: &dyn Lamps, piece: &Piece, effort: u32) -> Ledger {
    let (mut ledger, mut dice) = (Ledger::default(), Dice::new(piece.stream));
    let (lamp, set) = (lamps.open(), &lamps.sets()[piece.set]);
    let profile = lamp.profile(piece.set);
    let uv = if lamps.on_surfaces() { Vec2::from_array(dice.pair()) } else { Vec2::ZERO };
    let spot = Spot { profile: &*profile, set, uv };
    let samples = 1 << effort;
    spot.edges();
    spot.identities(samples / 8, &mut ledger, &mut dice);
    let first = compare(&spot, samples, &mut dice);
    let found = if first.suspicious() { compare(&spot, AGAIN * samples, &mut dice) } else { first };
    spot.statistics(&found, &mut ledger);
    purity(lamps, piece.set, uv, &mut ledger, &mut dice);
    answered(&*lamp, &set.words, &mut ledger);
    ledger.signed(|test| Case { test, stream: piece.stream, effort, view: None, parameters: set.name.clone() })
}

impl Scatterer for Spot<'_> {
    const NOTHING: f64 = 0.0;

    fn draw(&self, dice: &mut Dice) -> Drawn {
        let Some(Emitted { direction, profiled }) = self.profile.emit(self.uv, dice.pair()) else { return Drawn::default() };
        let weight = profiled.radiance.0.map(|radiance| f64::from(radiance) / f64::from(profiled.pdf.0));
        // A light has no bound on its energy.
        Drawn { direction: Some(direction), weight, energy: [0.0; 3] }
    }

    fn look(&self, w: Vec3) -> Claim {
        let Profiled { radiance, pdf } = self.profile.eval(self.uv, w);
        Claim { pdf: f64::from(pdf.0), value: radiance.0.map(f64::from) }
    }
}

impl Spot<'_> {
    fn place(&self) -> String {
        at(&[&self.set.words])
    }

    fn inputs(&self, direction: Option<Vec3>, u: Option<[Real; 2]>) -> Inputs {
        let (direction, u) = (direction.map(|w| w.to_array()), u.map(|[a, b]| [a, b, 0.0]));
        Inputs { uv: Some(self.uv.to_array()), direction, u, ..Inputs::default() }
    }

    /// Asks from where arithmetic ends; the answers are judged where they are taken in.
    fn edges(&self) {
        for [a, b, _] in corners() {
            self.profile.emit(self.uv, [a, b]);
        }
        let axes = [Vec3::X, Vec3::Y, Vec3::Z, -Vec3::X, -Vec3::Y, -Vec3::Z];
        for w in directions().into_iter().chain(axes) {
            self.profile.eval(self.uv, w);
        }
    }

    /// `emit` says of its direction what `eval` says of it.
    fn identities(&self, count: usize, ledger: &mut Ledger, dice: &mut Dice) {
        let (mut agreement, mut emission) = (Tally::new(Test::Agreement), Tally::new(Test::Emission));
        for _ in 0..count {
            let u = dice.pair();
            let Some(Emitted { direction, profiled }) = self.profile.emit(self.uv, u) else { continue };
            let Profiled { radiance, pdf } = self.profile.eval(self.uv, direction);
            let spread = || self.spread(direction, dice);
            let say = |subject: &'static str| {
                move |ratio: f64| {
                    (self.inputs(Some(direction), Some(u)), format!("a sample's {subject} is {ratio:.3} × that of eval{}", self.place()))
                }
            };
            agreement.take(f64::from(profiled.pdf.0), f64::from(pdf.0), spread, say("pdf"));
            for band in 0..3 {
                emission.take(f64::from(profiled.radiance[band]), f64::from(radiance[band]), spread, say("radiance"));
            }
        }
        agreement.settle(ledger);
        emission.settle(ledger);
    }

    /// How far rounding of the direction may move the answer, relatively.
    fn spread(&self, direction: Vec3, dice: &Dice) -> f64 {
        let mut dice = dice.clone();
        let numbers = |w| {
            let Profiled { radiance, pdf } = self.profile.eval(self.uv, w);
            [radiance[0], radiance[1], radiance[2], pdf.0].map(f64::from)
        };
        let here = numbers(direction);
        let mut spread: f64 = 0.0;
        for _ in 0..4 {
            for (a, b) in here.into_iter().zip(numbers(dice.nudged(direction))) {
                let largest = a.abs().max(b.abs());
                spread = spread.max(if largest > 0.0 { (a - b).abs() / largest } else { 0.0 });
            }
        }
        spread
    }

    fn statistics(&self, found: &Found, ledger: &mut Ledger) {
        let (place, samples) = (self.place(), found.samples as u64);
        let Found { share, mass, mass_off, brought, claimed, claimed_off, .. } = *found;
        let inputs = || self.inputs(None, None);
        ledger.judge(Test::Mass, mass_off.found.abs(), mass_off.bound, samples, || {
            (inputs(), format!("the pdf integrates to {mass:.4}, and {share:.4} of the samples have a direction{place}"))
        });
        if let Some(shape) = found.shape {
            ledger.judge(Test::Sampling, shape.sigmas.max(0.0), Significance::verdict().sigmas(), samples, || {
                let words =
                    format!("{:.2} times as many samples as the pdf says fall about {:?}{place}", shape.ratio, shape.worst.to_array());
                (self.inputs(Some(shape.worst), None), words)
            });
        }
        ledger.judge(Test::Power, claimed_off.found.abs(), claimed_off.bound, samples, || {
            (inputs(), format!("samples bring {brought:.4e} in all, and the radiance of eval integrates to {claimed:.4e}{place}"))
        });
    }
}

/// Questions.
const QUESTIONS: usize = 128;

/// The same question, asked again in another order.
fn purity(lamps: &dyn Lamps, set: usize, uv: Vec2, ledger: &mut Ledger, dice: &mut Dice) {
    let asker = lamps.open();
    let sampled = asker.profile(set);
    // Where samples go, so that narrow beams are met.
    let direction = |dice: &mut Dice| sampled.emit(uv, dice.pair()).map_or_else(|| dice.direction(), |emitted| emitted.direction);
    let questions: Vec<_> = (0..QUESTIONS).map(|_| (direction(dice), dice.pair())).collect();
    // In words, which are those of the bits.
    let answer = |profile: &dyn Profile, at: usize| {
        let (w, u) = questions[at];
        if at.is_multiple_of(2) { format!("{:?}", profile.eval(uv, w)) } else { format!("{:?}", profile.emit(uv, u)) }
    };
    let first = lamps.open();
    let answers: Vec<_> = (0..QUESTIONS).map(|at| answer(&*first.profile(set), at)).collect();
    let second = lamps.open();
    let (profile, other) = (second.profile(set), second.profile((set + 1) % lamps.sets().len()));
    let mut order: Vec<_> = (0..QUESTIONS).collect();
    for at in (1..QUESTIONS).rev() {
        order.swap(at, dice.below(at + 1));
    }
    for asked in order {
        for how in ["asked in another order", "asked twice"] {
            let again = answer(&*profile, asked);
            ledger.demand(Test::Purity, again == answers[asked], || {
                let name = if asked.is_multiple_of(2) { "eval" } else { "emit" };
                let place = at(&[&lamps.sets()[set].words]);
                (
                    Inputs { uv: Some(uv.to_array()), ..Inputs::default() },
                    format!("{name} answers {}, and {how} {again}{place}", answers[asked]),
                )
            });
        }
        answer(&*other, dice.below(QUESTIONS));
    }
}
