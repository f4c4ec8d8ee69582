//! Where two tapes of one sample part.

use std::fmt;

use crate::{
    setting::Setting,
    tape::{Event, Given, Tape},
};

/// The first thing that two runs of a sample did differently, on one of its walks.
#[derive(Clone, Copy, Debug)]
pub struct Parting {
    /// Whose tape: 0 is the camera's.
    pub walk: usize,
    /// Which event.
    pub at: usize,
    /// What the first run did there; `None`: its walk had ended.
    pub single: Option<Event>,
    /// What the second run did.
    pub double: Option<Event>,
}

/// The vertex of an event: a walk's start is vertex 0 and in no event, and each vertex is met and then left.
fn vertex(at: usize) -> usize {
    at / 2 + 1
}

/// The first difference on each walk.
pub fn partings(single: &Tape, double: &Tape) -> [Option<Parting>; 2] {
    [0, 1].map(|walk| {
        let (a, b) = (&single.walks[walk], &double.walks[walk]);
        let same = a.iter().zip(b).take_while(|(a, b)| a.agrees(b)).count();
        (same < a.len() || same < b.len()).then(|| Parting { walk, at: same, single: a.get(same).copied(), double: b.get(same).copied() })
    })
}

/// Whether all that this contribution is made of lies before the walks part.
pub fn before(given: &Given, partings: &[Option<Parting>; 2]) -> bool {
    // n vertices of a walk, its start among them, are n − 1 events of being met and n − 2 of being left.
    // Where a light walk lands on the lens, the last of its vertices is no thing that it meets.
    let met = |vertices: u32| (2 * vertices as usize).saturating_sub(3);
    let camera = met(given.t);
    let light = if given.t == 0 { met(given.s).saturating_sub(1) } else { met(given.s) };
    let needs = [camera, light];
    partings.iter().flatten().all(|parting| needs[parting.walk] <= parting.at)
}

/// A parting in a reader's words.
pub struct Said<'a>(pub &'a Parting, pub &'a Setting);

impl fmt::Display for Said<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self(parting, setting) = self;
        let walk = ["camera walk", "light walk"][parting.walk];
        let said = |event: Option<Event>| match event {
            None => "nothing more".to_owned(),
            Some(Event::Met { thing: None, .. }) => "escaped".to_owned(),
            Some(Event::Met { thing: Some(thing), .. }) => format!("the {}", setting.things[thing].name),
            Some(Event::Left { lobe }) => lobe_said(lobe).to_owned(),
        };
        write!(f, "{walk}, vertex {}: {} in f32, {} in f64", vertex(parting.at), said(parting.single), said(parting.double))?;
        let edge = [parting.single, parting.double].into_iter().flatten().filter_map(|event| match event {
            Event::Met { edge, .. } => Some(edge),
            Event::Left { .. } => None,
        });
        match edge.reduce(f64::min) {
            Some(edge) => write!(f, ", {edge:.1e} from the nearer edge"),
            None => Ok(()),
        }
    }
}

fn lobe_said(lobe: u32) -> &'static str {
    match lobe {
        0 => "absorbed",
        1 | 2 => "scattered back",
        4 => "mirrored",
        _ => "let through",
    }
}
