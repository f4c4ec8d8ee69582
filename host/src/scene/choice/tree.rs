//! A binary tree over lights, and the way down it that next event takes.

use super::{
    cluster::Cluster,
    draw::{Draw, STEP},
    node::{Link, Node, Receiver},
    split::{Item, split},
};
use crate::scene::lights::LightSource;

/// Two clusters that are one.
type Pair = [Node; 2];

/// Lights in clusters of clusters: at each node, one of two is chosen by what of it may reach the receiver (Conty Estevez and Kulla 2018,
/// without their splitting: one light is what is asked for).
#[derive(Clone, Debug)]
pub(super) struct Tree {
    /// The first is the root's; each stands before those below it.
    pairs: Vec<Pair>,
    /// Of each light: the turns that lead to it, the first in the lowest bit.
    trails: Vec<u64>,
    /// Of all lights, about W/sr.
    intensity: f64,
}

/// No way is longer, so that a trail holds it.
const LONGEST: u32 = 64;

impl Tree {
    /// Over these lights, fewer than a node can number, those left out that are infinitely far away; `None` where none is left.
    pub fn new(sources: &[LightSource]) -> Option<Self> {
        let near: Vec<(u32, Cluster)> = (0..).zip(sources).filter_map(|(light, source)| Some((light, Cluster::of(source)?))).collect();
        let mut items: Vec<Item> = near.iter().zip(0..).map(|((_, cluster), index)| Item::new(cluster, index)).collect();
        let intensity = near.iter().map(|(_, cluster)| cluster.intensity).sum();
        let tree = Self { pairs: Vec::with_capacity(near.len()), trails: vec![0; sources.len()], intensity };
        let mut builder = Builder { near: &near, tree };
        match &near[..] {
            [] => return None,
            // Of two, the other is none.
            [(light, cluster)] => builder.tree.pairs.push([builder.node(cluster, Link::Light(*light)), Node::default()]),
            _ => _ = builder.pair(&mut items, 0, 0),
        }
        Some(builder.tree)
    }

    /// Chooses a light for the receiver; its chance is `chance` times what the way to it has. `None` where nothing reaches the receiver.
    #[inline]
    pub fn pick(&self, receiver: &Receiver, draw: &mut Draw, mut chance: f64) -> Option<(u32, f64)> {
        let mut at = 0;
        loop {
            let pair = &self.pairs[at as usize];
            let first = first_chance(pair, receiver, at == 0)?;
            let turn = usize::from(!draw.is_below(first));
            chance *= [first, 1.0 - first][turn];
            match pair[turn].link() {
                Link::Light(light) => return Some((light, chance)),
                Link::Pair(below) => at = below,
            }
        }
    }

    /// The chance that [`Tree::pick`] comes to this light, which must be one of the tree's: the same numbers, multiplied in the same order.
    #[inline]
    pub fn chance(&self, light: u32, receiver: &Receiver, mut chance: f64) -> f64 {
        let (mut at, mut trail) = (0, self.trails[light as usize]);
        loop {
            let pair = &self.pairs[at as usize];
            let Some(first) = first_chance(pair, receiver, at == 0) else { return 0.0 };
            let turn = (trail & 1) as usize;
            chance *= [first, 1.0 - first][turn];
            match pair[turn].link() {
                Link::Pair(below) if chance > 0.0 => at = below,
                _ => return chance,
            }
            trail >>= 1;
        }
    }

    /// About what of all lights reaches the receiver, W/m²: the most important node's children stand for it, theirs for that of these, and
    /// so on, since a cluster about the receiver says little as a whole.
    pub fn arriving(&self, receiver: &Receiver) -> f64 {
        let (mut at, mut sum) = (0, 0.0);
        loop {
            let pair = &self.pairs[at as usize];
            let [first, second] = [0, 1].map(|i| pair[i].importance(receiver));
            let (more, node) = if first >= second { (first, &pair[0]) } else { (second, &pair[1]) };
            sum += first.min(second);
            match node.link() {
                Link::Pair(below) if more > 0.0 => at = below,
                _ => return (sum + more) * self.intensity,
            }
        }
    }
}

/// The chance of the first of two. Each has 2^−24 at least, unless nothing of it reaches the receiver. Where nothing of either does
/// although it seemed so of both together, they are chosen by intensity; `None` at the root.
#[inline]
fn first_chance(pair: &Pair, receiver: &Receiver, is_root: bool) -> Option<f64> {
    let [first, second] = [0, 1].map(|i| pair[i].importance(receiver));
    if first > 0.0 && second > 0.0 {
        return Some((first / (first + second)).clamp(STEP, 1.0 - STEP));
    }
    if first > 0.0 || second > 0.0 {
        return Some(if first > 0.0 { 1.0 } else { 0.0 });
    }
    let [first, second] = [0, 1].map(|i| pair[i].share());
    (!is_root).then(|| (first / (first + second)).clamp(STEP, 1.0 - STEP))
}

struct Builder<'a> {
    /// The lights' numbers and what they are.
    near: &'a [(u32, Cluster)],
    tree: Tree,
}

impl Builder<'_> {
    /// Builds the pair over two lights or more, to which `trail` leads in `depth` turns.
    fn pair(&mut self, items: &mut [Item], depth: u32, trail: u64) -> (Cluster, u32) {
        // From here on, halves would just do.
        let tight = depth + (items.len() - 1).ilog2() + 2 >= LONGEST;
        let count = if tight { items.len() / 2 } else { split(items) };
        let (first, second) = items.split_at_mut(count);
        let at = self.tree.pairs.len();
        self.tree.pairs.push(Pair::default());
        let sides = [(first, trail), (second, trail | 1 << depth)];
        let [(a, first), (b, second)] = sides.map(|(items, trail)| self.side(items, depth + 1, trail));
        self.tree.pairs[at] = [self.node(&a, first), self.node(&b, second)];
        (a.union(&b), at as u32)
    }

    fn side(&mut self, items: &mut [Item], depth: u32, trail: u64) -> (Cluster, Link) {
        if let [item] = items {
            let (light, cluster) = self.near[item.index as usize];
            self.tree.trails[light as usize] = trail;
            return (cluster, Link::Light(light));
        }
        let (cluster, pair) = self.pair(items, depth, trail);
        (cluster, Link::Pair(pair))
    }

    fn node(&self, cluster: &Cluster, link: Link) -> Node {
        Node::new(cluster, cluster.intensity / self.tree.intensity, link)
    }
}
