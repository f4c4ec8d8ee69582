//! From a binary tree to a wide one, at the least expected cost.
//!
//! Dynamic programming over the binary tree (Ylitie, Karras and Laine 2017, §3.1): for every subtree, the least cost
//! of standing in a wide node as at most 1, 2, … children.

use obvhs::bvh2::{Bvh2, node::Bvh2Node};

use super::{node::WIDTH, triangle::PACKET};

/// What visiting a node, a packet and any other primitive cost, relative to each other.
const NODE_COST: f32 = 1.0;
const PACKET_COST: f32 = 0.7;
const OTHER_COST: f32 = 1.0;

/// How a subtree is best cut.
#[derive(Clone, Copy, Debug, Default)]
struct Cut {
    /// The least cost of being at most i + 1 children, times the area.
    cost: [f32; WIDTH - 1],
    /// For more than one child: how many of them the left half gets; 0 if one fewer is as good.
    left: [u8; WIDTH - 1],
    /// The same for being a node's [`WIDTH`] children.
    left_of_all: u8,
    /// How many triangles the subtree is, if it is at most a packet of them and nothing else; else 0.
    triangles: u8,
    /// Whether a single child is a leaf.
    is_leaf: bool,
}

/// The plan of a wide tree.
pub(super) struct Collapse<'a> {
    binary: &'a Bvh2,
    cuts: Vec<Cut>,
}

impl<'a> Collapse<'a> {
    /// `is_triangle` tells what may share a leaf. The binary tree has one primitive per leaf.
    pub fn new(binary: &'a Bvh2, is_triangle: impl Fn(usize) -> bool) -> Self {
        let mut collapse = Self { binary, cuts: vec![Cut::default(); binary.nodes.len()] };
        let scale = binary.nodes.first().map_or(1.0, |root| 1.0 / area(root));
        let scale = if scale.is_finite() { scale } else { 1.0 };
        for index in preorder(binary).into_iter().rev() {
            let node = &binary.nodes[index];
            collapse.cuts[index] = if node.is_leaf() {
                let triangle = is_triangle(binary.primitive_indices[node.first_index as usize] as usize);
                let cost = area(node) * scale * if triangle { PACKET_COST } else { OTHER_COST };
                Cut { cost: [cost; WIDTH - 1], triangles: u8::from(triangle), is_leaf: true, ..Cut::default() }
            } else {
                let left = node.first_index as usize;
                Cut::best(&collapse.cuts[left], &collapse.cuts[left + 1], area(node) * scale)
            };
        }
        collapse
    }

    /// Whether the subtree becomes a leaf when it becomes one child.
    pub fn is_leaf(&self, index: usize) -> bool {
        self.cuts[index].is_leaf
    }

    /// The subtrees that become the children of an inner node.
    pub fn children(&self, index: usize) -> Vec<usize> {
        let mut children = Vec::with_capacity(WIDTH);
        let left = self.binary.nodes[index].first_index as usize;
        let share = self.cuts[index].left_of_all as usize;
        self.gather(left, share, &mut children);
        self.gather(left + 1, WIDTH - share, &mut children);
        children
    }

    /// The primitives of a subtree, as the binary tree was given them.
    pub fn primitives(&self, index: usize) -> Vec<usize> {
        let mut primitives = Vec::with_capacity(PACKET);
        let mut stack = vec![index];
        while let Some(index) = stack.pop() {
            let node = &self.binary.nodes[index];
            if node.is_leaf() {
                primitives.push(self.binary.primitive_indices[node.first_index as usize] as usize);
            } else {
                stack.extend([node.first_index as usize + 1, node.first_index as usize]);
            }
        }
        primitives
    }

    fn gather(&self, index: usize, mut most: usize, children: &mut Vec<usize>) {
        let node = &self.binary.nodes[index];
        if node.is_leaf() {
            return children.push(index);
        }
        while most > 1 && self.cuts[index].left[most - 1] == 0 {
            most -= 1;
        }
        if most == 1 {
            return children.push(index);
        }
        let share = self.cuts[index].left[most - 1] as usize;
        self.gather(node.first_index as usize, share, children);
        self.gather(node.first_index as usize + 1, most - share, children);
    }
}

impl Cut {
    /// The best way to cut the tree that has these two halves.
    fn best(left: &Cut, right: &Cut, area: f32) -> Self {
        let mut cut = Self::default();
        let together = |total: usize| {
            let mut best = (f32::INFINITY, 1);
            for share in total.saturating_sub(WIDTH - 1).max(1)..total.min(WIDTH) {
                let cost = left.cost[share - 1] + right.cost[total - share - 1];
                if cost < best.0 {
                    best = (cost, share as u8);
                }
            }
            best
        };

        let (cost_of_all, left_of_all) = together(WIDTH);
        let as_node = cost_of_all + area * NODE_COST;
        let triangles = left.triangles + right.triangles;
        let packet = left.triangles > 0 && right.triangles > 0 && triangles as usize <= PACKET;
        let as_leaf = if packet { area * PACKET_COST } else { f32::INFINITY };
        cut.left_of_all = left_of_all;
        cut.triangles = if packet { triangles } else { 0 };
        cut.is_leaf = as_leaf <= as_node;
        cut.cost[0] = as_leaf.min(as_node);
        for total in 2..WIDTH {
            let (cost, share) = together(total);
            let fewer = cut.cost[total - 2];
            (cut.cost[total - 1], cut.left[total - 1]) = if cost < fewer { (cost, share) } else { (fewer, 0) };
        }
        cut
    }
}

/// Half the surface of a node's box.
fn area(node: &Bvh2Node) -> f32 {
    node.aabb().half_area()
}

/// All nodes, each before its children.
fn preorder(binary: &Bvh2) -> Vec<usize> {
    let mut order = Vec::with_capacity(binary.nodes.len());
    let mut stack = if binary.nodes.is_empty() { vec![] } else { vec![0] };
    while let Some(index) = stack.pop() {
        order.push(index);
        let node = &binary.nodes[index];
        if !node.is_leaf() {
            stack.extend([node.first_index as usize, node.first_index as usize + 1]);
        }
    }
    order
}
