//! Meshes made by formulas, and the rays that a renderer would cast at them.

use std::f32::consts::{PI, TAU};

use bidir_kernel::{Ray, Segment, Vec3};

/// A list of triangles.
#[derive(Default)]
pub struct Mesh {
    /// Corners.
    pub vertices: Vec<Vec3>,
    /// Three of them each.
    pub triangles: Vec<[u32; 3]>,
}

/// Numbers for meshes and rays: a linear congruential generator (Knuth, MMIX).
pub struct Random(pub u64);

impl Random {
    /// In [0, 1).
    pub fn unit(&mut self) -> f32 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 40) as f32 * 2.0_f32.powi(-24)
    }

    /// In the cube [−1, 1)³.
    pub fn cube(&mut self) -> Vec3 {
        Vec3::new(self.unit(), self.unit(), self.unit()) * 2.0 - Vec3::ONE
    }

    /// A unit vector.
    pub fn direction(&mut self) -> Vec3 {
        let (z, angle) = (2.0 * self.unit() - 1.0, TAU * self.unit());
        let r = (1.0 - z * z).sqrt();
        Vec3::new(r * angle.cos(), r * angle.sin(), z)
    }
}

impl Mesh {
    /// A grid of quadrilaterals, two triangles each, over [0, 1]².
    pub fn grid(&mut self, columns: usize, rows: usize, at: impl Fn(f32, f32) -> Vec3) {
        let first = self.vertices.len() as u32;
        for j in 0..=rows {
            for i in 0..=columns {
                self.vertices.push(at(i as f32 / columns as f32, j as f32 / rows as f32));
            }
        }
        for j in 0..rows as u32 {
            for i in 0..columns as u32 {
                let a = first + j * (columns as u32 + 1) + i;
                let (b, c, d) = (a + 1, a + columns as u32 + 2, a + columns as u32 + 1);
                self.triangles.extend([[a, b, c], [a, c, d]]);
            }
        }
    }

    /// A box, two triangles a side.
    pub fn block(&mut self, centre: Vec3, half: Vec3) {
        for axis in 0..3 {
            for sign in [-1.0, 1.0] {
                self.grid(1, 1, |u, v| {
                    let mut corner = [0.0; 3];
                    corner[axis] = sign;
                    corner[(axis + 1) % 3] = 2.0 * u - 1.0;
                    corner[(axis + 2) % 3] = 2.0 * v - 1.0;
                    centre + half * Vec3::from_array(corner)
                });
            }
        }
    }

    /// A surface of revolution about y with a profile of radii.
    pub fn lathe(&mut self, foot: Vec3, height: f32, (sectors, rings): (usize, usize), radius: impl Fn(f32, f32) -> f32) {
        self.grid(sectors, rings, |u, v| {
            let (angle, r) = (TAU * u, radius(u, v));
            foot + Vec3::new(r * angle.cos(), height * v, r * angle.sin())
        });
    }
}

/// A furnished room, 57 k triangles: large walls, boxes, and small turned things.
pub fn kitchen() -> Mesh {
    let (mut mesh, mut random) = (Mesh::default(), Random(7));
    mesh.block(Vec3::new(0.0, 1.5, 0.0), Vec3::new(3.0, 1.5, 2.0));
    for _ in 0..600 {
        let half = Vec3::new(0.03 + 0.2 * random.unit(), 0.02 + 0.2 * random.unit(), 0.03 + 0.2 * random.unit());
        let at = random.cube() * Vec3::new(2.6, 1.2, 1.6) + Vec3::new(0.0, 1.4, 0.0);
        mesh.block(at, half * 0.6);
    }
    for i in 0..50 {
        let foot = random.cube() * Vec3::new(2.5, 1.1, 1.5) + Vec3::new(0.0, 1.3, 0.0);
        let waves = 3.0 + (i % 7) as f32;
        mesh.lathe(foot, 0.3, (25, 20), |_, v| 0.02 + 0.1 * (waves * v).sin().abs());
    }
    mesh
}

/// Leaves over ground, 263 k triangles, most of them small and none a neighbour of another.
pub fn thicket() -> Mesh {
    let (mut mesh, mut random) = (Mesh::default(), Random(3));
    mesh.grid(250, 250, |u, v| Vec3::new(6.0 * u - 3.0, 0.1 * (17.0 * u).sin() * (13.0 * v).cos(), 6.0 * v - 3.0));
    for _ in 0..138_000 {
        let centre = random.cube() * Vec3::new(2.5, 0.9, 2.5) + Vec3::new(0.0, 1.1, 0.0);
        let first = mesh.vertices.len() as u32;
        mesh.vertices.extend([(); 3].map(|()| centre + random.cube() * 0.03));
        mesh.triangles.push([first, first + 1, first + 2]);
    }
    mesh
}

/// A statue, 871 k triangles of even size: a sphere with bumps upon bumps.
pub fn statue() -> Mesh {
    let mut mesh = Mesh::default();
    mesh.grid(933, 467, |u, v| {
        let (theta, phi) = (PI * v, TAU * u);
        let d = Vec3::new(theta.sin() * phi.cos(), theta.cos(), theta.sin() * phi.sin());
        let bump = |f: f32| (d.x * f + 1.0).sin() * (d.y * f * 1.1 + 2.0).sin() * (d.z * f * 0.9 + 3.0).sin() / f;
        d * (1.0 + 1.2 * bump(4.0) + 1.1 * bump(11.0) + 0.9 * bump(37.0) + 0.6 * bump(113.0))
    });
    mesh
}

/// A hall of columns, 3.2 M triangles, seen from within.
pub fn hall() -> Mesh {
    let mut mesh = Mesh::default();
    for y in [0.0, 6.0] {
        mesh.grid(300, 300, |u, v| Vec3::new(20.0 * u - 10.0, y + 0.01 * ((u * 300.0).sin() + (v * 300.0).cos()), 20.0 * v - 10.0));
    }
    mesh.block(Vec3::new(0.0, 3.0, 0.0), Vec3::new(10.0, 3.2, 10.0));
    for i in 0..8 {
        for j in 0..8 {
            let foot = Vec3::new(2.4 * i as f32 - 8.4, 0.0, 2.4 * j as f32 - 8.4);
            mesh.lathe(foot, 6.0, (192, 116), |u, v| {
                0.35 + 0.03 * (TAU * 16.0 * u).cos() + 0.1 * ((2.0 * v - 1.0).powi(8)) + 0.004 * (TAU * 40.0 * v).sin()
            });
        }
    }
    mesh
}

/// A kind of rays, and whether only their occlusion is asked.
pub struct Rays {
    /// What they are.
    pub name: &'static str,
    /// The rays.
    pub rays: Vec<Ray>,
    /// Whether any hit will do.
    pub any: bool,
}

/// Where a ray hit: a point a little off the surface, and the surface's normal on that side.
pub type Bounce = (Vec3, Vec3);

/// The rays of a renderer, from `eye` to `target`; `hit` casts one.
pub fn rays(eye: Vec3, target: Vec3, size: f32, side: usize, hit: impl Fn(&Ray) -> Option<Bounce>) -> Vec<Rays> {
    let mut random = Random(11);
    let towards = (target - eye).normalize();
    let across = towards.cross(Vec3::Y).normalize();
    let up = across.cross(towards);
    let ray = |origin, direction, t_max| Ray { origin, direction, t_max, segment: Segment::Inner };
    let primary: Vec<Ray> = (0..side * side)
        .map(|i| {
            let (x, y) = ((i % side) as f32 / side as f32 - 0.5, 0.5 - (i / side) as f32 / side as f32);
            ray(eye, (towards + across * (1.2 * x) + up * (1.2 * y)).normalize(), f32::INFINITY)
        })
        .collect();
    let mut bounced = |from: &[Ray]| -> (Vec<Bounce>, Vec<Ray>) {
        let hits: Vec<Bounce> = from.iter().filter_map(&hit).collect();
        let rays = hits.iter().map(|(point, normal)| ray(*point, (*normal + random.direction() * 0.999).normalize(), f32::INFINITY));
        let rays = rays.collect();
        (hits, rays)
    };
    let (seen, first) = bounced(&primary);
    let (lit, second) = bounced(&first);
    let mut random = Random(12);
    let connections = seen.iter().map(|(from, _)| {
        let (to, _) = lit[(random.unit() * lit.len() as f32) as usize % lit.len()];
        let distance = (to - *from).length().max(1e-6);
        ray(*from, (to - *from) / distance, 0.999 * distance)
    });
    let connections = connections.collect();
    let short = seen.iter().map(|(from, normal)| ray(*from, (*normal + random.direction() * 0.999).normalize(), 0.01 * size)).collect();
    vec![
        Rays { name: "primary", rays: primary, any: false },
        Rays { name: "first bounce", rays: first, any: false },
        Rays { name: "second bounce", rays: second, any: false },
        Rays { name: "connections", rays: connections, any: true },
        Rays { name: "short segments", rays: short, any: true },
    ]
}
