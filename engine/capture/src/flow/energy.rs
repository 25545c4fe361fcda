//! Energy that holds the surface together where pictures do not: springs along edges, folds, inertia.
//!
//! In units of one standard deviation, with the strain `e = (d - d0) / d0` of an edge:
//!
//! ```text
//! linear  E = e^2 / 2 s^2            force e / s^2
//! cubic   E = e^4 / 4 s^2 T^2        force e^3 / s^2 T^2                      (equation 5.16)
//! fold    E = |k - k0|^2 / 2 f^2     k = sum c_i x_i, k0 where the motion would carry it
//! inertia E = |x - x0|^2 / 2 i^2     x0 where the motion would carry it
//! ```
//!
//! Springs, folds and inertia are the terms of one implicit step of cloth in its variational form (Martin et al. 2011,
//! "Example-Based Elastic Materials", section 3): parts that no picture places move as cloth would.

use glam::{DMat3, DVec3};

use super::settings::{FlowSettings, Springs};
use crate::sparse::BlockSystem;
use crate::surface::CapturedSurface;

/// Least stiffness of a cubic spring at its rest length, as a part of the linear one's: keeps the system regular.
const AT_REST: f64 = 1e-3;

/// The terms of one surface, with the places of their blocks.
#[derive(Debug, Clone)]
pub(super) struct Energy {
    springs: Vec<([u32; 2], f64, [usize; 4])>,
    folds: Vec<([u32; 4], [f64; 4], [usize; 16])>,
    diagonal: Vec<usize>,
}

impl Energy {
    pub fn new(surface: &CapturedSurface, system: &BlockSystem) -> Self {
        let spring = |e: &[u32; 2]| {
            let [a, b] = *e;
            let length = surface.rest[a as usize].distance(surface.rest[b as usize]);
            (*e, length, [[a, a], [a, b], [b, a], [b, b]].map(|[i, j]| system.place(i, j)))
        };
        let folds = surface.folds.iter().map(|f| {
            let places = std::array::from_fn(|k| system.place(f.corners[k / 4], f.corners[k % 4]));
            (f.corners, f.coefficients, places)
        });
        Self {
            springs: surface.edges.iter().map(spring).collect(),
            folds: folds.collect(),
            diagonal: (0..surface.rest.len() as u32).map(|i| system.place(i, i)).collect(),
        }
    }

    /// Adds all terms at `x`; `carried` is where the motion would carry each vertex.
    pub fn add(&self, system: &mut BlockSystem, x: &[DVec3], carried: &[DVec3], settings: &FlowSettings) -> f64 {
        let mut energy = 0.0;
        if settings.springs != Springs::Off {
            energy += self.add_springs(system, x, settings);
        }
        let stiff = settings.folding.powi(-2);
        for (corners, coefficients, places) in &self.folds {
            let off: DVec3 =
                corners.iter().zip(coefficients).map(|(v, c)| (x[*v as usize] - carried[*v as usize]) * *c).sum();
            energy += 0.5 * stiff * off.length_squared();
            for (k, place) in places.iter().enumerate() {
                let block = coefficients[k / 4] * coefficients[k % 4] * stiff;
                system.blocks[*place] += DMat3::from_diagonal(DVec3::splat(block));
            }
            for (v, c) in corners.iter().zip(coefficients) {
                system.right[*v as usize] -= off * (c * stiff);
            }
        }
        let heavy = settings.inertia.powi(-2);
        for (i, place) in self.diagonal.iter().enumerate() {
            let off = x[i] - carried[i];
            energy += 0.5 * heavy * off.length_squared();
            system.blocks[*place] += DMat3::from_diagonal(DVec3::splat(heavy));
            system.right[i] -= off * heavy;
        }
        energy
    }

    fn add_springs(&self, system: &mut BlockSystem, x: &[DVec3], settings: &FlowSettings) -> f64 {
        let mut energy = 0.0;
        let k = settings.strain.powi(-2);
        for ([a, b], rest, places) in &self.springs {
            let along = x[*b as usize] - x[*a as usize];
            let length = along.length().max(1e-9);
            let (n, e) = (along / length, (length - rest) / rest);
            let (own, force, stiff) = match settings.springs {
                Springs::Cubic => {
                    let over = k / settings.threshold.powi(2);
                    (0.25 * over * e.powi(4), over * e.powi(3), (3.0 * over * e * e).max(AT_REST * k))
                }
                _ => (0.5 * k * e * e, k * e, k),
            };
            energy += own;
            let block = DMat3::from_cols(n * n.x, n * n.y, n * n.z) * (stiff / (rest * rest));
            for (place, sign) in places.iter().zip([1.0, -1.0, -1.0, 1.0]) {
                system.blocks[*place] += block * sign;
            }
            system.right[*a as usize] += n * (force / rest);
            system.right[*b as usize] -= n * (force / rest);
        }
        energy
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn forces_are_the_change_of_the_energy() {
        let rest = vec![DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::new(1.0, 1.0, 0.2)];
        let surface = CapturedSurface::new("m", rest.clone(), Vec::new(), vec![[0, 1, 3], [0, 3, 2]]).unwrap();
        let groups = surface.folds.iter().map(|f| &f.corners[..]).chain(surface.edges.iter().map(|e| &e[..]));
        let mut system = BlockSystem::new(4, groups);
        let energy = Energy::new(&surface, &system);
        let carried: Vec<DVec3> = rest.iter().map(|p| *p * 1.02).collect();
        let x: Vec<DVec3> = rest.iter().enumerate().map(|(i, p)| *p * 1.05 + DVec3::Z * 0.03 * i as f64).collect();
        for springs in [Springs::Linear, Springs::Cubic, Springs::Off] {
            let settings = FlowSettings {
                springs,
                inertia: 0.1,
                folding: 0.1,
                strain: 0.05,
                threshold: 0.05,
                ..FlowSettings::default()
            };
            let mut at = |x: &[DVec3]| {
                system.clear();
                let e = energy.add(&mut system, x, &carried, &settings);
                (e, system.right.clone())
            };
            let (_, force) = at(&x);
            for (i, force) in force.iter().enumerate() {
                for axis in [DVec3::X, DVec3::Y, DVec3::Z] {
                    let mut moved = |by: f64| {
                        let mut x = x.clone();
                        x[i] += axis * by;
                        at(&x).0
                    };
                    let change = (moved(1e-6) - moved(-1e-6)) / 2e-6;
                    assert!((change + force.dot(axis)).abs() < 1e-4 * (1.0 + change.abs()), "{springs:?} {i} {axis}");
                }
            }
        }
    }

    #[test]
    fn a_cubic_spring_is_softer_below_its_threshold_and_stiffer_above() {
        let rest = vec![DVec3::ZERO, DVec3::X, DVec3::Y];
        let surface = CapturedSurface::new("m", rest.clone(), Vec::new(), vec![[0, 1, 2]]).unwrap();
        let mut system = BlockSystem::new(3, surface.edges.iter().map(|e| &e[..]));
        let energy = Energy::new(&surface, &system);
        let mut pull = |springs: Springs, strain: f64| {
            let x: Vec<DVec3> = rest.iter().map(|p| *p * (1.0 + strain)).collect();
            let settings =
                FlowSettings { springs, threshold: 0.1, inertia: 1e6, folding: 1e6, ..FlowSettings::default() };
            system.clear();
            energy.add(&mut system, &x, &x, &settings);
            system.right[1].length()
        };
        for (strain, softer) in [(0.05, true), (0.2, false)] {
            let (cubic, linear) = (pull(Springs::Cubic, strain), pull(Springs::Linear, strain));
            assert_eq!(cubic < linear, softer, "{strain}: {cubic} {linear}");
        }
        assert!((pull(Springs::Cubic, 0.1) / pull(Springs::Linear, 0.1) - 1.0).abs() < 1e-9);
    }
}
