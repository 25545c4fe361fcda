//! The oracle against closed forms, finite differences and itself.

mod derivatives;
mod exact;
mod link_curves;
mod sliding;

use glam::DVec3;
use toile_base::numeric::random::SplitMix64;

use super::*;

/// Standard gravity as the engine has it.
const GRAVITY: DVec3 = DVec3::new(0.0, -9.81, 0.0);

/// Numbers in -1..1 from a seed.
struct Random(SplitMix64);

impl Random {
    fn new(seed: u64) -> Self {
        Self(SplitMix64::new(seed))
    }

    fn unit(&mut self) -> f64 {
        2.0 * self.0.uniform_f64() - 1.0
    }

    fn vector(&mut self) -> DVec3 {
        DVec3::new(self.unit(), self.unit(), self.unit())
    }
}

/// A chain along `along` from a pin at the origin, `links` of `rest` m and masses of `mass` kg.
fn chain(links: usize, rest: f64, mass: f64, compliance: f64, along: DVec3) -> Problem {
    let mut masses = vec![mass; links + 1];
    masses[0] = 0.0;
    Problem {
        mass: masses,
        start: (0..=links).map(|i| along * (i as f64 * rest)).collect(),
        links: (0..links).map(|i| Link { ends: [i as u32, i as u32 + 1], rest, compliance }).collect(),
        gravity: GRAVITY,
        ..Problem::default()
    }
}

/// A square of cloth of `n` x `n` particles 2 cm apart, level at height 0, pinned at two corners a little nearer than the
/// cloth is wide: threads that do not
/// stretch, diagonals that shear, bending along rows and columns.
fn square(n: usize) -> Problem {
    let h = 0.02;
    let at = |i: usize, j: usize| (i * n + j) as u32;
    let mut links = Vec::new();
    let mut bends = Vec::new();
    for i in 0..n {
        for j in 0..n {
            let mut link = |a: u32, b: u32, rest: f64, compliance: f64| {
                links.push(Link { ends: [a, b], rest, compliance });
            };
            if j + 1 < n {
                link(at(i, j), at(i, j + 1), h, 0.0);
            }
            if i + 1 < n {
                link(at(i, j), at(i + 1, j), h, 0.0);
            }
            if i + 1 < n && j + 1 < n {
                link(at(i, j), at(i + 1, j + 1), h * 2f64.sqrt(), 0.02);
                link(at(i, j + 1), at(i + 1, j), h * 2f64.sqrt(), 0.02);
            }
            let c = 1e-5f64.sqrt() / h;
            let mut bend = |p: [u32; 3]| {
                bends.push(Bend { particles: p.into(), coefficients: vec![-2.0 * c, c, c] });
            };
            if j > 0 && j + 1 < n {
                bend([at(i, j), at(i, j - 1), at(i, j + 1)]);
            }
            if i > 0 && i + 1 < n {
                bend([at(i, j), at(i - 1, j), at(i + 1, j)]);
            }
        }
    }
    let mut mass = vec![0.1 * h * h; n * n];
    (mass[0], mass[n - 1]) = (0.0, 0.0);
    let start = (0..n * n).map(|k| DVec3::new((k % n) as f64 * h * 0.95, 0.0, (k / n) as f64 * h)).collect();
    Problem { mass, start, links, bends, gravity: GRAVITY, offset_m: 1e-3, ..Problem::default() }
}

/// A ball and a slanted cone under the square, and a floor.
fn furniture() -> Solids {
    let ball = |x: f64, y: f64, z: f64, radius: f64| Ball { centre: DVec3::new(x, y, z), radius };
    Solids {
        cones: vec![
            [ball(0.05, -0.08, 0.06, 0.03); 2],
            [ball(0.02, -0.14, 0.02, 0.03), ball(0.14, -0.12, 0.10, 0.015)],
        ],
        planes: vec![Plane { normal: DVec3::Y, offset_m: -0.2 }],
    }
}
