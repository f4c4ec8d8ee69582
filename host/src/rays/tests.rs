//! Geometry against what it ought to be: an f64 oracle that knows no tree, closed surfaces, and rays nobody means to cast.

mod distances;
mod edges;
mod generator;
mod instances;
mod machines;
mod oracle;
mod random;
mod self_hits;
mod watertight;
