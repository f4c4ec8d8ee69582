//! A cluster of lights as the tree keeps it, and how much of it may reach a receiver.

use bidir_kernel::{Point, Vec3};
use glam::DVec3;

use super::cluster::Cluster;

/// A cluster in half a cache line. Its box and its cone are rounded outwards.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Node {
    /// Of a box that holds the lights.
    center: Vec3,
    /// Half that box's edges; all 0 only for lights without extent in one place.
    half: [Short; 3],
    /// Of all the lights' intensity; above 0, but for a node that stands for none.
    share: Short,
    /// The unit axis of the cone times [`SCALE`].
    axis: [i16; 3],
    /// The cosine of the cone's angle times [`SCALE`].
    cos: i16,
    /// A light, or the pair of nodes below, and what kind of node this is.
    link: u32,
}

/// The upper half of an f32 that is not negative.
#[derive(Clone, Copy, Debug, Default)]
struct Short(u16);

impl Short {
    /// Not less than `x`, and less than 1 % more.
    fn above(x: f64) -> Self {
        let near = x as f32;
        let above = if f64::from(near) < x { near.next_up() } else { near };
        Self((above.to_bits().saturating_add(0xffff) >> 16) as u16)
    }

    #[inline]
    fn value(self) -> f64 {
        f32::from_bits(u32::from(self.0) << 16).into()
    }
}

const SCALE: f64 = 32767.0;

/// How much wider a cone is kept, in radians: more than rounding its axis can turn it.
const SPARE: f64 = 1e-3;

const LEAF: u32 = 1 << 31;
const EVERYWHERE: u32 = 1 << 30;
const FALLS_OFF: u32 = 1 << 29;
const CERTAIN: u32 = 1 << 28;

/// What a node's number has to be below.
pub(super) const MOST: usize = 1 << 28;

/// What is taken to be sent where samples of a profile say that nothing is, as a share of where it is brightest.
const FAINT: f64 = 1.0 / 1024.0;

/// How near the nearest of a cluster is taken to be, at least: so many times half the box's diagonal. It stands for how far apart
/// lights in a cluster are.
const NEAREST: f64 = 1.0 / 16.0;

/// The same of a single light, which fills at most the hemisphere.
const NEAREST_OF_ONE: f64 = 1.0 / 2.0;

/// What is taken to be received at grazing angles, as a share of what is upright: shading normals and rough surfaces see to that.
const GRAZING: f64 = 0.1;

/// What a node leads to.
pub(super) enum Link {
    /// This light.
    Light(u32),
    /// This pair of nodes.
    Pair(u32),
}

/// What a tree wants to know of a receiver.
#[derive(Clone, Copy, Debug)]
pub(super) struct Receiver {
    position: DVec3,
    /// Zero in empty space.
    normal: DVec3,
    is_surface: bool,
}

impl Receiver {
    #[inline]
    pub fn new(lit: &Point) -> Self {
        Self { position: lit.position.as_dvec3(), normal: lit.normal.as_dvec3(), is_surface: lit.is_surface() }
    }
}

impl Node {
    /// A cluster with its share of all the intensity.
    pub fn new(cluster: &Cluster, share: f64, link: Link) -> Self {
        let (low, high) = (cluster.low.as_dvec3(), cluster.high.as_dvec3());
        let center = (0.5 * (low + high)).as_vec3();
        let half = (high - center.as_dvec3()).max(center.as_dvec3() - low);
        let angle = cluster.cone.angle + SPARE;
        let everywhere = angle >= std::f64::consts::PI;
        let flag = |is: bool, flag: u32| if is { flag } else { 0 };
        let (number, leaf) = match link {
            Link::Light(light) => (light, LEAF),
            Link::Pair(pair) => (pair, 0),
        };
        Self {
            center,
            half: half.to_array().map(Short::above),
            share: Short::above(share.max(f32::MIN_POSITIVE.into())),
            axis: (cluster.cone.axis * SCALE).to_array().map(|x| x.round() as i16),
            cos: (libm::cos(angle.min(std::f64::consts::PI)) * SCALE).floor() as i16,
            link: number | leaf | flag(everywhere, EVERYWHERE) | flag(cluster.falls_off, FALLS_OFF) | flag(cluster.certain, CERTAIN),
        }
    }

    /// Where the node leads.
    #[inline]
    pub fn link(&self) -> Link {
        let number = self.link & (MOST as u32 - 1);
        if self.link & LEAF != 0 { Link::Light(number) } else { Link::Pair(number) }
    }

    /// Its share of all the intensity.
    #[inline]
    pub fn share(&self) -> f64 {
        self.share.value()
    }

    /// About what of a unit of all lights' intensity reaches the receiver, 1/m²; 0 only where nothing does.
    ///
    /// In the manner of Conty Estevez and Kulla 2018: the most that a cosine on either side can be over a sphere that holds the lights.
    /// The receiver's counts on both of its sides, since light may pass through it. But for 1/d², with d to the cluster's middle, stands
    /// the product of 1/d to its nearest and to its farthest point, so that of two clusters the one about the receiver counts for more.
    #[inline]
    pub fn importance(&self, receiver: &Receiver) -> f64 {
        let away = receiver.position - self.center.as_dvec3();
        let squared = away.dot(away);
        let half = DVec3::from_array(self.half.map(Short::value));
        let held = half.dot(half);
        if squared == 0.0 && held == 0.0 {
            // In one place with lights that have no extent nothing is lit.
            return 0.0;
        }
        let near = (away.abs() - half).max(DVec3::ZERO);
        let far = away.abs() + half;
        let nearest = if self.link & LEAF != 0 { NEAREST_OF_ONE } else { NEAREST };
        let falloff = 1.0 / (near.dot(near).max(held * (nearest * nearest)) * far.dot(far)).sqrt();
        if squared <= held {
            return self.share() * falloff;
        }
        let scale = 1.0 / squared.sqrt();
        let sin_held = held.sqrt() * scale;
        let received = if receiver.is_surface {
            // Not less than the cosine of the angle that the sphere leaves.
            (receiver.normal.dot(away).abs() * scale + sin_held).clamp(GRAZING, 1.0)
        } else {
            1.0
        };
        self.share() * self.sent(away * scale, sin_held) * received * falloff
    }

    /// The most that is sent into a cone of directions about `toward`, as a share of where the cluster is brightest.
    #[inline]
    fn sent(&self, toward: DVec3, sin_held: f64) -> f64 {
        if self.link & EVERYWHERE != 0 {
            return 1.0;
        }
        let [x, y, z] = self.axis.map(f64::from);
        let cos = ((x * toward.x + y * toward.y + z * toward.z) * (1.0 / SCALE)).clamp(-1.0, 1.0);
        let (cos_cone, cos_held) = (f64::from(self.cos) * (1.0 / SCALE), sine(sin_held));
        let beyond = less((cos, sine(cos)), (cos_cone, sine(cos_cone)));
        let (cos, _) = less(beyond, (cos_held, sin_held));
        let sent = if self.link & FALLS_OFF != 0 {
            cos
        } else if cos >= 1.0 {
            1.0
        } else {
            0.0
        };
        sent.max(if self.link & CERTAIN != 0 { 0.0 } else { FAINT })
    }
}

/// From the cosine of an angle in 0 … π; or the other way round, up to ½ π.
#[inline]
fn sine(cos: f64) -> f64 {
    (1.0 - cos * cos).max(0.0).sqrt()
}

/// max(0, a − b) for angles in 0 … π, all as their cosines and sines.
#[inline]
fn less((cos, sin): (f64, f64), (by_cos, by_sin): (f64, f64)) -> (f64, f64) {
    if cos >= by_cos { (1.0, 0.0) } else { (cos * by_cos + sin * by_sin, (sin * by_cos - cos * by_sin).max(0.0)) }
}
