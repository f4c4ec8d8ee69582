//! Samples held against the density and the values that are claimed for them, for lobes of any width.
//!
//! Two kinds of directions are compared: those that the shader samples, of the unknown density p, and those of a density q
//! that was made from earlier samples ([`Partition`]) and so is known and near p. With the claimed density c, for any set of directions,
//!
//! ```text
//! E_p[2 q/(c + q)] − E_q[2 c/(c + q)] = 2 ∫ q (p − c)/(c + q)
//! ```
//!
//! which is 0 for every set just if c = p wherever q is; both summands lie within 0 … 2, so that no tail spoils the variance
//! (the bridge of Meng & Wong 1996). Over all directions it tells whether c integrates to the share of samples, over cells whether it has their shape.

use bidir_kernel::Vec3;

use super::{
    dice::Dice,
    partition::Partition,
    significance::{Moments, Significance, sigmas_of_chi_square},
};

/// What is asked about.
pub(super) trait Scatterer {
    /// What is too little to judge: absolute, of what samples bring.
    const NOTHING: f64;

    /// A sample.
    fn draw(&self, dice: &mut Dice) -> Drawn;
    /// What is claimed of a direction.
    fn look(&self, w: Vec3) -> Claim;
}

/// A sample, as far as it matters here.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Drawn {
    /// `None` for a delta lobe, or no sample.
    pub(super) direction: Option<Vec3>,
    /// What it brings.
    pub(super) weight: [f64; 3],
    /// The energy of that: without what refraction does to radiance.
    pub(super) energy: [f64; 3],
}

/// What is claimed of a direction.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Claim {
    pub(super) pdf: f64,
    pub(super) value: [f64; 3],
}

/// A number that should be 0, and how far chance may take it from there.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Deviation {
    pub(super) found: f64,
    /// For a verdict.
    pub(super) bound: f64,
    /// For a second look.
    pub(super) suspicious: f64,
}

/// What was found.
#[derive(Clone, Debug)]
pub(super) struct Found {
    /// Samples drawn, and as many directions of the known density.
    pub(super) samples: usize,
    /// The share of samples with a direction.
    pub(super) share: f64,
    /// About what the claimed density integrates to.
    pub(super) mass: f64,
    pub(super) mass_off: Deviation,
    /// χ² of the shapes in standard deviations, and the cells it was pooled to.
    pub(super) shape: Option<Shape>,
    /// The most energy in any band: its mean above 1.
    pub(super) energy: f64,
    pub(super) energy_off: Deviation,
    /// What the samples bring, and what the claimed values integrate to, in the band where they differ most.
    pub(super) brought: f64,
    pub(super) claimed: f64,
    pub(super) claimed_off: Deviation,
}

/// Where samples fall, against where the density says.
#[derive(Clone, Copy, Debug)]
pub(super) struct Shape {
    pub(super) sigmas: f64,
    /// A direction in the worst cell, and how many times as many samples fall there as should.
    pub(super) worst: Vec3,
    pub(super) ratio: f64,
}

/// Cells at most that shapes are compared in, and what both sums of each come to at least: a direction adds 2 at most.
const POOLED: f64 = 64.0;
const POOL: f64 = 128.0;

/// In standard deviations: a right shape shows this in one of fifty cases.
const ODD_SHAPE: f64 = 2.0;

/// More than this is not told.
const MANY_TIMES: f64 = 1e6;

/// What rounding may do to a mass or a mean, relative to it.
const ROUNDING: f64 = 1e-3;

/// A weight that samples may bring at most, so that those seldom drawn are not missed by chance: where values are more than this many
/// times the density, samples as good as never go.
const SELDOM: f64 = 100.0;

/// A weight that few samples of a shader have.
const HEAVY: f64 = 4.0;

/// What tables and fits inside a shader may add to its energy.
const ENERGY_SLACK: f64 = 2e-3;

/// Compares with `samples` of each kind; a quarter as many go before, to make the known density from.
pub(super) fn compare(subject: &impl Scatterer, samples: usize, dice: &mut Dice) -> Found {
    let partition = learn(subject, samples / 2, dice);
    let mut cells = vec![(0.0, 0.0); partition.cells()];
    let mut sums = Sums::default();
    for _ in 0..samples {
        let drawn = subject.draw(dice);
        let (mut bridged, mut left) = (0.0, [0.0; 3]);
        if let Some(w) = drawn.direction {
            let (claim, (cell, q)) = (subject.look(w), partition.look(w));
            bridged = 2.0 * q / (claim.pdf + q);
            cells[cell].0 += bridged;
            left = core::array::from_fn(|band| drawn.weight[band] - claim.value[band] / (claim.pdf + q));
        }
        sums.bridged.add(bridged);
        sums.smooth.add(f64::from(u8::from(drawn.direction.is_some())));
        let smooth = if drawn.direction.is_some() { drawn.weight } else { [0.0; 3] };
        add(&mut sums.brought, smooth);
        add(&mut sums.left, left);
        add(&mut sums.energy, drawn.energy);
    }
    for _ in 0..samples {
        let w = partition.pick(dice);
        let (claim, (cell, q)) = (subject.look(w), partition.look(w));
        let bridged = 2.0 * claim.pdf / (claim.pdf + q);
        cells[cell].1 += bridged;
        sums.known.add(bridged);
        sums.direct.add(claim.pdf / q);
        for (band, value) in claim.value.into_iter().enumerate() {
            let weight = value / claim.pdf;
            let class = if weight <= HEAVY { 0 } else { 1 };
            if weight <= SELDOM {
                sums.heaviest[class][band] = sums.heaviest[class][band].max(weight);
            }
            sums.heavy[band] += if class == 1 { value / (claim.pdf + q) } else { 0.0 };
        }
        add(&mut sums.claimed, claim.value.map(|value| value / (claim.pdf + q)));
    }
    sums.found(samples, shape(&partition, &cells, &sums), nothing(subject))
}

fn add(moments: &mut [Moments; 3], bands: [f64; 3]) {
    moments.iter_mut().zip(bands).for_each(|(moments, band)| moments.add(band));
}

fn nothing<S: Scatterer>(_: &S) -> f64 {
    S::NOTHING
}

/// The known density, about the densest of so many samples.
pub(super) fn learn(subject: &impl Scatterer, samples: usize, dice: &mut Dice) -> Partition {
    let found: Vec<_> = (0..samples).filter_map(|_| subject.draw(dice).direction).collect();
    let density = |w: &Vec3| subject.look(*w).pdf;
    let some = found.iter().take(256);
    let centre = some.max_by(|a, b| density(a).total_cmp(&density(b))).copied().unwrap_or(Vec3::Z);
    Partition::new(centre, &found)
}

#[derive(Default)]
struct Sums {
    /// 1 for a sample with a direction.
    smooth: Moments,
    /// Claimed over known density, which integrates the claimed one whatever its shape is, if slowly.
    direct: Moments,
    bridged: Moments,
    known: Moments,
    brought: [Moments; 3],
    left: [Moments; 3],
    claimed: [Moments; 3],
    energy: [Moments; 3],
    /// What a sample can bring, as far as claims tell, whether one did or not: up to [`HEAVY`], and more.
    heaviest: [[f64; 3]; 2],
    /// What the heavy ones bring together.
    heavy: [f64; 3],
}

/// A deviation of two means of independent values.
fn deviation(found: f64, parts: &[(&Moments, f64)], slack: f64) -> Deviation {
    let bound = |level: Significance| parts.iter().map(|(values, extent)| level.bound(values, *extent).powi(2)).sum::<f64>().sqrt() + slack;
    Deviation { found, bound: bound(Significance::verdict()), suspicious: bound(Significance::suspicion()) }
}

impl Sums {
    /// Claimed over sampled density, on average.
    fn ratio(&self) -> f64 {
        if self.bridged.mean() > 0.0 { self.known.mean() / self.bridged.mean() } else { 1.0 }
    }

    fn found(&self, samples: usize, shape: Option<Shape>, nothing: f64) -> Found {
        let share = self.smooth.mean();
        let (mass, mass_off) = if shape.is_some_and(|shape| shape.sigmas > Significance::verdict().sigmas()) {
            // The bridge tells a wrong mass from a wrong shape only where the shape is right.
            let direct =
                deviation(self.direct.mean() - share, &[(&self.direct, self.direct.largest), (&self.smooth, 1.0)], 2.0 * ROUNDING * share);
            (self.direct.mean(), direct)
        } else {
            let off = self.known.mean() - self.bridged.mean();
            let slack = ROUNDING * (self.known.mean() + self.bridged.mean());
            let mass = if share > 0.0 { share * self.ratio() } else { self.known.mean() };
            (mass, deviation(off, &[(&self.known, 2.0), (&self.bridged, 2.0)], slack))
        };
        let strongest = self.energy.iter().max_by(|a, b| a.mean().total_cmp(&b.mean())).copied().unwrap_or_default();
        let energy_off = deviation(strongest.mean() - 1.0, &[(&strongest, strongest.largest)], ENERGY_SLACK);
        let worst = (0..3).map(|band| self.claim(band, nothing)).max_by(|a, b| {
            let share = |d: &Deviation| d.found.abs() / d.bound.max(f64::MIN_POSITIVE);
            share(&a.2).total_cmp(&share(&b.2))
        });
        let (brought, claimed, claimed_off) = worst.unwrap_or_default();
        Found { samples, share, mass, mass_off, shape, energy: strongest.mean(), energy_off, brought, claimed, claimed_off }
    }

    /// What samples bring in a band, and what the claimed values integrate to: found with both kinds of directions, each
    /// weighed by the balance heuristic as a renderer does.
    fn claim(&self, band: usize, nothing: f64) -> (f64, f64, Deviation) {
        let (brought, left, known) = (&self.brought[band], &self.left[band], &self.claimed[band]);
        let off = left.mean() - known.mean();
        let slack = 2.0 * ROUNDING * brought.mean() + nothing;
        // A faint tail of heavy weights is no excuse for the rest.
        let matters = self.heavy[band] / known.count.max(1.0) > slack;
        let heaviest = self.heaviest[usize::from(matters)][band];
        (brought.mean(), brought.mean() - off, deviation(off, &[(left, (2.0 * left.largest).max(heaviest)), (known, known.largest)], slack))
    }
}

/// Cells side by side pooled until each holds enough; scaled, so that shapes alone are compared.
///
/// Where c = p, both sums of a cell are 2n ∫ p q/(p + q), and the variance of their difference is 4n ∫ p q/(p + q): the sum of the two.
/// So a cell that one kind of direction hardly meets is not taken for certain by it.
fn shape(partition: &Partition, cells: &[(f64, f64)], sums: &Sums) -> Option<Shape> {
    let ratio = sums.ratio();
    let all: f64 = cells.iter().map(|(made, known)| ratio * made + known).sum();
    let enough = POOL.max(all / POOLED);
    let (mut chi_square, mut pooled, mut worst) = (0.0, 0, (0.0, 0, 1.0));
    let (mut first, mut made, mut known) = (0, 0.0, 0.0);
    for (at, cell) in cells.iter().enumerate() {
        (made, known) = (made + ratio * cell.0, known + cell.1);
        if made + known < enough && at + 1 < cells.len() {
            continue;
        }
        if made + known >= POOL {
            let variance = (made + known) * ratio.max(1.0) + (ROUNDING * (made + known)).powi(2);
            let square = (made - known).powi(2) / variance;
            chi_square += square;
            pooled += 1;
            if square > worst.0 {
                worst = (square, (first + at) / 2, (made / known).min(MANY_TIMES));
            }
        }
        (first, made, known) = (at + 1, 0.0, 0.0);
    }
    let sigmas = sigmas_of_chi_square(chi_square, f64::from(pooled - 1));
    (pooled > 2).then(|| Shape { sigmas, worst: partition.middle(worst.1), ratio: worst.2 })
}

impl Found {
    /// Whether anything is unlikely enough for a second look.
    pub(super) fn suspicious(&self) -> bool {
        let odd = |d: &Deviation| d.found.abs() > d.suspicious;
        let shape = self.shape.is_some_and(|shape| shape.sigmas > ODD_SHAPE);
        odd(&self.mass_off) || odd(&self.claimed_off) || shape || self.energy_off.found > self.energy_off.suspicious
    }
}

#[cfg(test)]
mod tests {
    use bidir_kernel::{
        PerSolidAngle, Real,
        warp::{cone, cone_pdf},
    };

    use super::*;

    /// Uniform in a cone about z, of which the claims are off by factors.
    struct Cone {
        opening: Real,
        pdf: f64,
        value: f64,
        /// Samples fall towards the axis.
        crowd: Real,
    }

    impl Scatterer for Cone {
        const NOTHING: f64 = 0.0;

        fn draw(&self, dice: &mut Dice) -> Drawn {
            let [u, v] = dice.pair();
            let u = if self.crowd > 0.0 { u * (1.0 - self.crowd + self.crowd * u) } else { u };
            Drawn { direction: Some(cone([u, v], self.opening)), weight: [0.5; 3], energy: [0.5; 3] }
        }

        fn look(&self, w: Vec3) -> Claim {
            let sin = f64::from(w.x).hypot(f64::from(w.y));
            let opening = f64::from(self.opening);
            let PerSolidAngle(pdf) =
                PerSolidAngle(if w.z > 0.0 && sin * sin < opening * (2.0 - opening) { cone_pdf(self.opening) } else { 0.0 });
            let pdf = f64::from(pdf);
            Claim { pdf: pdf * self.pdf, value: [0.5 * pdf * self.value; 3] }
        }
    }

    const OPENINGS: [Real; 3] = [1e-7, 1e-3, 0.5];

    fn found(cone: &Cone, samples: usize) -> Found {
        compare(cone, samples, &mut Dice::new(5))
    }

    #[test]
    fn what_is_right_is_found_to_be() {
        for opening in OPENINGS {
            let found = found(&Cone { opening, pdf: 1.0, value: 1.0, crowd: 0.0 }, 1 << 15);
            assert!(found.mass_off.found.abs() < found.mass_off.bound && (found.mass - 1.0).abs() < 0.02, "{opening}: {found:?}");
            assert!(found.claimed_off.found.abs() < found.claimed_off.bound, "{opening}: {found:?}");
            assert!(found.shape.expect("cells").sigmas < 4.0, "{opening}: {found:?}");
        }
    }

    #[test]
    fn three_percent_are_found_in_lobes_of_any_width() {
        for opening in OPENINGS {
            let off = found(&Cone { opening, pdf: 1.03, value: 1.0, crowd: 0.0 }, 1 << 17);
            assert!(off.mass_off.found.abs() > 1.5 * off.mass_off.bound && (off.mass - 1.03).abs() < 5e-3, "{opening}: {off:?}");
            let off = found(&Cone { opening, pdf: 1.0, value: 1.03, crowd: 0.0 }, 1 << 17);
            assert!(off.claimed_off.found.abs() > 1.5 * off.claimed_off.bound, "{opening}: {off:?}");
            let crowded = found(&Cone { opening, pdf: 1.0, value: 1.0, crowd: 0.2 }, 1 << 17);
            assert!(crowded.shape.expect("cells").sigmas > 12.0, "{opening}: {crowded:?}");
        }
    }
}
