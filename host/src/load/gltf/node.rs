//! The tree of nodes: what stands where.

use ::gltf::json::{Index, Node, scene::UnitQuaternion};
use glam::{DAffine3, DMat3, DQuat, DVec3, DVec4};

use serde::Deserialize;

use super::asset::{Asset, DAMAGED, label};
use crate::error::Result;

/// Numbers beyond this are no places.
const FAR: f64 = 1e30;

/// `KHR_node_visibility`
#[derive(Deserialize)]
struct Visibility {
    #[serde(default = "seen")]
    visible: bool,
}

fn seen() -> bool {
    true
}

/// A node of the scene.
#[derive(Clone, Copy, Debug)]
pub(super) struct Placed<'a> {
    pub(super) node: &'a Node,
    pub(super) index: usize,
    /// Its own coordinates → the world.
    pub(super) to_world: DAffine3,
}

impl Placed<'_> {
    /// What messages call it.
    pub(super) fn label(&self) -> String {
        label("node", self.index, self.node.name.as_ref())
    }

    /// Its axes turned so that what looks along −z here looks along z with x to the left, as cameras and spots do elsewhere. Scales are
    /// left out, as glTF says of both. `None` where axes fall together.
    pub(super) fn looking(&self) -> Option<DAffine3> {
        let [x, y, z] = [self.to_world.matrix3.x_axis, self.to_world.matrix3.y_axis, self.to_world.matrix3.z_axis];
        let ahead = -z.try_normalize()?;
        let up = y.try_normalize()?;
        let up = (up - ahead * ahead.dot(up)).try_normalize()?;
        let left = up.cross(ahead);
        let left = if left.dot(x) > 0.0 { -left } else { left };
        Some(DAffine3 { matrix3: DMat3::from_cols(left, up, ahead), translation: self.to_world.translation })
    }
}

impl Asset {
    /// Every node of the scene that is to be seen, parents before their children.
    pub(super) fn nodes(&self) -> Result<Vec<Placed<'_>>> {
        let mut waiting: Vec<(usize, DAffine3)> = self.roots()?.into_iter().rev().map(|node| (node, DAffine3::IDENTITY)).collect();
        let mut seen = vec![false; self.root.nodes.len()];
        let mut all = Vec::new();
        while let Some((index, parent)) = waiting.pop() {
            let Some(node) = self.root.nodes.get(index) else { return Err(self.missing(&format!("node {index}"))) };
            let name = || label("node", index, node.name.as_ref());
            if std::mem::replace(&mut seen[index], true) {
                return Err(self.error(format!("{} has two parents, or is its own", name()), DAMAGED));
            }
            let others = node.extensions.as_ref().map(|all| &all.others);
            let hidden = self.extension::<Visibility>(others, "KHR_node_visibility", &name())?.is_some_and(|said| !said.visible);
            if hidden {
                continue;
            }
            let to_world = parent * self.local(node, &name())?;
            if !to_world.to_cols_array().iter().all(|v| v.abs() <= FAR) {
                return Err(self.error(format!("the transform of {} is not finite or beyond 1e30", name()), DAMAGED));
            }
            all.push(Placed { node, index, to_world });
            waiting.extend(node.children.iter().flatten().rev().map(|child| (child.value(), to_world)));
        }
        Ok(all)
    }

    /// The nodes that the scene begins with; without a scene, those that are nobody's children.
    fn roots(&self) -> Result<Vec<usize>> {
        let scene = match self.root.scene {
            Some(index) => Some(self.root.get(index).ok_or_else(|| self.missing(&format!("scene {}", index.value())))?),
            None => self.root.scenes.first(),
        };
        Ok(match scene {
            Some(scene) => scene.nodes.iter().map(Index::value).collect(),
            None => {
                let mut roots = vec![true; self.root.nodes.len()];
                for child in self.root.nodes.iter().flat_map(|node| node.children.iter().flatten()) {
                    if let Some(root) = roots.get_mut(child.value()) {
                        *root = false;
                    }
                }
                (0..roots.len()).filter(|&node| roots[node]).collect()
            }
        })
    }

    /// A node's own coordinates → its parent's.
    fn local(&self, node: &Node, name: &str) -> Result<DAffine3> {
        if let Some(matrix) = node.matrix {
            let [x, y, z, t] = [0, 4, 8, 12].map(|at| DVec4::from_array([0, 1, 2, 3].map(|row| f64::from(matrix[at + row]))));
            if [x.w, y.w, z.w, t.w] != [0.0, 0.0, 0.0, 1.0] {
                return Err(self.error(format!("the last row of the matrix of {name} is not 0 0 0 1"), DAMAGED));
            }
            let matrix3 = DMat3::from_cols(x.truncate(), y.truncate(), z.truncate());
            return Ok(DAffine3 { matrix3, translation: t.truncate() });
        }
        let vector = |v: Option<[f32; 3]>, otherwise| v.map_or(otherwise, |v| DVec3::from_array(v.map(f64::from)));
        let UnitQuaternion(rotation) = node.rotation.unwrap_or_default();
        let rotation = turn(rotation).ok_or_else(|| self.error(format!("the rotation of {name} is none: {rotation:?}"), DAMAGED))?;
        Ok(placed(vector(node.translation, DVec3::ZERO), rotation, vector(node.scale, DVec3::ONE)))
    }
}

/// A rotation whose quaternion need not be of length 1.
pub(super) fn turn(quaternion: [f32; 4]) -> Option<DMat3> {
    let quaternion = DVec4::from_array(quaternion.map(f64::from)).try_normalize()?;
    Some(DMat3::from_quat(DQuat::from_vec4(quaternion)))
}

/// Scaled, then turned, then moved.
pub(super) fn placed(translation: DVec3, rotation: DMat3, scale: DVec3) -> DAffine3 {
    DAffine3 { matrix3: rotation * DMat3::from_diagonal(scale), translation }
}
