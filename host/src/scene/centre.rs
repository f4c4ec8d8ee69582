//! Where a tree's coordinates begin: at the middle of what is in it, so that f32 is finest there.

use glam::{DAffine3, DVec3};

use super::{
    description::{Geometry, Instance, Shape},
    group::Group,
};
use crate::rays::Bounds;

/// The middle of everything that has a place; `None` where nothing has.
pub(super) fn centre(shapes: &[Shape], instances: &[Instance], groups: &[Group]) -> Option<DVec3> {
    let mut reach = Reach { low: DVec3::INFINITY, high: DVec3::NEG_INFINITY };
    shapes.iter().for_each(|shape| reach.add(&shape.geometry));
    for instance in instances {
        if let Some(group) = groups.get(instance.group.0 as usize) {
            reach.add_instance(&(instance.to_world * DAffine3::from_translation(group.origin)), group.bounds());
        }
    }
    let Reach { low, high } = reach;
    (low.is_finite() && high.is_finite()).then(|| 0.5 * (low + high))
}

struct Reach {
    low: DVec3,
    high: DVec3,
}

impl Reach {
    fn extend(&mut self, p: DVec3) {
        (self.low, self.high) = (self.low.min(p), self.high.max(p));
    }

    fn add(&mut self, geometry: &Geometry) {
        match geometry {
            Geometry::Mesh { mesh, to_world, .. } => {
                let place = |&[x, y, z]: &[f32; 3]| to_world.transform_point3(DVec3::new(x.into(), y.into(), z.into()));
                mesh.positions.iter().map(place).for_each(|p| self.extend(p));
            }
            Geometry::Rectangle { to_world, .. } | Geometry::Disk { to_world, .. } => {
                for (x, y) in [(-1.0, -1.0), (-1.0, 1.0), (1.0, -1.0), (1.0, 1.0)] {
                    self.extend(to_world.transform_point3(DVec3::new(x, y, 0.0)));
                }
            }
            Geometry::Sphere { center, radius, to_world, .. } => {
                let r = DVec3::splat(radius * to_world.matrix3.x_axis.length());
                let c = to_world.transform_point3(*center);
                self.extend(c - r);
                self.extend(c + r);
            }
            Geometry::Cylinder { p0, p1, radius, to_world, .. } => {
                let r = DVec3::splat(radius * to_world.matrix3.x_axis.length());
                for p in [p0, p1].map(|p| to_world.transform_point3(*p)) {
                    self.extend(p - r);
                    self.extend(p + r);
                }
            }
        }
    }

    fn add_instance(&mut self, to_world: &DAffine3, Bounds { min, max }: Bounds) {
        if min.x > max.x {
            return;
        }
        for corner in 0..8 {
            let side = |axis: usize| if corner >> axis & 1 == 0 { min[axis] } else { max[axis] };
            self.extend(to_world.transform_point3(DVec3::new(side(0).into(), side(1).into(), side(2).into())));
        }
    }
}
