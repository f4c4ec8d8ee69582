//! What both walks leave behind: vertices to be connected.

use crate::{
    scene::Scene,
    spectrum::Spectrum,
    vertex::Vertex,
    weight::{Side, Together},
};

/// A vertex of a camera or light walk, kept for connections.
pub struct WalkVertex<'s, S: Scene + 's, R = Together> {
    pub(crate) vertex: Vertex<'s, S>,
    /// What the walk carries as it arrives.
    pub(crate) throughput: Spectrum,
    pub(crate) side: Side<R>,
    /// Segments from the walk's beginning to here.
    pub(crate) length: u32,
}
