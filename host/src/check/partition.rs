//! A density made from samples: cells of equal shares, however narrow the lobes are.

use bidir_kernel::Vec3;

use super::{
    chart::{Chart, STERADIANS},
    dice::Dice,
};

/// Cells at most, and samples in each at least.
const CELLS: usize = 256;
const LEAST: usize = 16;

/// How often a direction is one from anywhere.
const ANYWHERE: f64 = 0.1;

/// How often it is one about the centre, at any order of magnitude away from it: where a narrow lobe has a part that no sample reaches.
const ABOUT: f64 = 0.2;

/// Directions about the centre begin between these heights: f32 tells nearer ones apart no more.
const NEAREST: f64 = 1e-10;
const FARTHEST: f64 = 0.5;

/// From here on, a cell's outer height over its inner one, directions crowd towards its inner edge.
const LONG: f64 = 4.0;

/// The sphere cut into cells at the medians of some samples, and the density that gives each cell its share of them,
/// mixed with the uniform one.
#[derive(Debug)]
pub(super) struct Partition {
    chart: Chart,
    nodes: Vec<Node>,
    cells: Vec<Cell>,
    /// The least height of directions about the centre.
    nearest: f64,
}

#[derive(Clone, Copy, Debug)]
enum Node {
    /// Below `at` along `axis` to the next node, else to `above`.
    Split {
        axis: usize,
        at: f64,
        above: usize,
    },
    Leaf(usize),
}

#[derive(Clone, Copy, Debug)]
struct Cell {
    low: [f64; 2],
    high: [f64; 2],
    share: f64,
    /// The shares of all cells before.
    before: f64,
}

impl Cell {
    fn long(&self) -> bool {
        self.low[0] > 0.0 && self.high[0] > LONG * self.low[0]
    }

    /// Per area of the chart.
    fn density(&self, height: f64) -> f64 {
        let turns = self.high[1] - self.low[1];
        let along = if self.long() { height * (self.high[0] / self.low[0]).ln() } else { self.high[0] - self.low[0] };
        self.share / (turns * along)
    }

    fn place(&self, u: f64, v: f64) -> [f64; 2] {
        let between = |axis: usize, u: f64| self.low[axis] + u * (self.high[axis] - self.low[axis]);
        let height = if self.long() { self.low[0] * (self.high[0] / self.low[0]).powf(u) } else { between(0, u) };
        [height, between(1, v)]
    }
}

impl Partition {
    /// Laid out about `centre`, where lobes are narrowest.
    pub(super) fn new(centre: Vec3, samples: &[Vec3]) -> Self {
        let chart = Chart::about(centre);
        let mut places: Vec<_> = samples.iter().map(|w| chart.place(*w)).collect();
        let mut partition = Self { chart, nodes: Vec::new(), cells: Vec::new(), nearest: FARTHEST };
        let all = places.len();
        partition.cut(&mut places, [0.0; 2], [1.0; 2], 0, (all / CELLS).max(LEAST));
        let mut before = 0.0;
        for cell in &mut partition.cells {
            partition.nearest = partition.nearest.min(cell.high[0]).max(NEAREST);
            cell.share /= all.max(1) as f64;
            cell.before = before;
            before += cell.share;
        }
        partition
    }

    fn cut(&mut self, places: &mut [[f64; 2]], low: [f64; 2], high: [f64; 2], depth: usize, least: usize) {
        let middle = places.len() / 2;
        if middle >= least {
            for axis in [depth % 2, 1 - depth % 2] {
                places.sort_unstable_by(|a, b| a[axis].total_cmp(&b[axis]));
                let at = 0.5 * (places[middle - 1][axis] + places[middle][axis]);
                // Samples in one place cannot be told apart.
                if at > low[axis] && at < high[axis] && at > places[middle - 1][axis] {
                    let node = self.nodes.len();
                    self.nodes.push(Node::Leaf(0));
                    let (below, beyond) = places.split_at_mut(middle);
                    let (mut top, mut bottom) = (high, low);
                    (top[axis], bottom[axis]) = (at, at);
                    self.cut(below, low, top, depth + 1, least);
                    self.nodes[node] = Node::Split { axis, at, above: self.nodes.len() };
                    self.cut(beyond, bottom, high, depth + 1, least);
                    return;
                }
            }
        }
        self.nodes.push(Node::Leaf(self.cells.len()));
        self.cells.push(Cell { low, high, share: places.len() as f64, before: 0.0 });
    }

    pub(super) fn cells(&self) -> usize {
        self.cells.len()
    }

    /// The cell a direction lies in, and how densely [`Partition::pick`] makes it, per steradian.
    pub(super) fn look(&self, w: Vec3) -> (usize, f64) {
        let place = self.chart.place(w);
        let mut node = 0;
        loop {
            match self.nodes[node] {
                Node::Split { axis, at, above } => node = if place[axis] < at { node + 1 } else { above },
                Node::Leaf(cell) => {
                    let own = self.cells[cell].density(place[0].max(f64::MIN_POSITIVE));
                    // Without samples there is but one cell, and it has no share.
                    if self.cells[cell].share == 0.0 && self.cells.len() == 1 {
                        return (cell, 1.0 / STERADIANS);
                    }
                    let about = if place[0] < self.nearest { 0.0 } else { 1.0 / (place[0] * -self.nearest.ln()) };
                    return (cell, ((1.0 - ANYWHERE - ABOUT) * own + ABOUT * about + ANYWHERE) / STERADIANS);
                }
            }
        }
    }

    pub(super) fn pick(&self, dice: &mut Dice) -> Vec3 {
        let (choice, u, v) = (dice.exact(), dice.exact(), dice.exact());
        let empty = self.cells.len() == 1 && self.cells[0].share == 0.0;
        if choice < ANYWHERE || empty {
            return self.chart.direction([u, v]);
        }
        if choice < ANYWHERE + ABOUT {
            return self.chart.direction([self.nearest.powf(1.0 - u), v]);
        }
        let at = (choice - ANYWHERE - ABOUT) / (1.0 - ANYWHERE - ABOUT);
        let cell = self.cells.partition_point(|cell| cell.before <= at).max(1) - 1;
        self.chart.direction(self.cells[cell].place(u, v))
    }

    /// A direction in the middle of a cell.
    pub(super) fn middle(&self, cell: usize) -> Vec3 {
        self.chart.direction(self.cells[cell].place(0.5, 0.5))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::check::significance::Moments;

    /// Directions about `centre`, most within `width` of it, with a long tail.
    fn lobe(centre: Vec3, width: f64, dice: &mut Dice) -> Vec3 {
        let u = dice.exact();
        let height = (width * width * u / (1.0 - u)).min(1.0);
        Chart::about(centre).direction([height, dice.exact()])
    }

    #[test]
    fn the_density_is_that_of_the_directions_picked() {
        let mut dice = Dice::new(7);
        for width in [1.0, 0.1, 1e-3] {
            let centre = dice.direction();
            let samples: Vec<_> = (0..8192).map(|_| lobe(centre, width, &mut dice)).collect();
            let partition = Partition::new(centre, &samples);
            assert!(partition.cells() > 100);
            let mut inverse = Moments::default();
            for _ in 0..20_000 {
                inverse.add(1.0 / partition.look(partition.pick(&mut dice)).1);
            }
            let error = (inverse.variance() / inverse.count).sqrt();
            assert!((inverse.mean() - STERADIANS).abs() < 5.0 * error + 1e-3, "{width}: {} ± {error}", inverse.mean());
        }
    }
}
