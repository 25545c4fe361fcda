//! Levenberg-Marquardt over the eight left spheres; the right ones are their mirror images.

use glam::Vec3;

use super::{CAPSULES, CARRIERS, Placed, clothed, nearest, vertex_areas};
use crate::body::{Body, Region};
use crate::limits::MAX_SPHERES;
use crate::skeleton::Joint;

/// Unknowns: centre and radius of each left sphere.
const SPHERES: usize = MAX_SPHERES / 2;
const UNKNOWNS: usize = SPHERES * 4;
type Vector = [f64; UNKNOWNS];

/// Steps of the fit; it settles within these.
const STEPS: usize = 40;
/// One vertex in this many is a sample of the fit; the report takes them all.
const STRIDE: usize = 5;
/// Distance at which the quartic part of the cost equals the quadratic one (m). Beyond it a few bad places cost more than
/// many fair ones: skin that shows through cloth, or cloth that floats, is seen where it is worst.
const FAIR: f64 = 8e-3;

/// Weight of standing out of the body against staying below its surface: what stands out most does so in hollows (between
/// the breasts, along the spine) that cloth spans anyway, while skin that stands out pierces the cloth.
const OUTSIDE: f64 = 0.4;

/// A point of the surface and its share of the area.
struct Sample {
    point: Vec3,
    weight: f64,
}

/// The spheres that fit the body best, in the rest pose.
pub(super) fn spheres(body: &Body) -> Placed {
    let samples = samples(body);
    let start = first_guess(body);
    let stiffness = stiffness();
    let mut x = start;
    let mut cost = assemble(&x, &samples, &start, &stiffness, None);
    let mut damping = 1e-3;
    for _ in 0..STEPS {
        let mut system = System::default();
        assemble(&x, &samples, &start, &stiffness, Some(&mut system));
        let Some(step) = system.solve(damping) else { break };
        let tried: Vector = std::array::from_fn(|i| (x[i] + step[i]).max(if i % 4 == 3 { 5e-3 } else { -9.0 }));
        let reached = assemble(&tried, &samples, &start, &stiffness, None);
        if reached < cost {
            let settled = cost - reached < 1e-5 * cost;
            (x, cost) = (tried, reached);
            damping = (damping * 0.3).max(1e-7);
            if settled {
                break;
            }
        } else {
            damping *= 6.0;
        }
    }
    placed(&x)
}

/// The left half of what garments cover; the body is symmetric.
fn samples(body: &Body) -> Vec<Sample> {
    let areas = vertex_areas(body);
    let left = (0..areas.len()).filter(|&v| body.mesh.positions[v].x >= 0.0 && clothed(body, v)).step_by(STRIDE);
    let mut samples: Vec<Sample> =
        left.map(|v| Sample { point: body.mesh.positions[v], weight: f64::from(areas[v]) * matter(body, v) }).collect();
    let total: f64 = samples.iter().map(|s| s.weight).sum();
    samples.iter_mut().for_each(|s| s.weight /= total);
    samples
}

/// How much a place matters: garments hang from the tops of the shoulders, lie tight on the bust and the seat, close on
/// the rest of the trunk, and keep away from the limbs.
fn matter(body: &Body, vertex: usize) -> f64 {
    let hangs = body.mesh.positions[vertex].y > body.levels.chest && body.normals[vertex].y > 0.5;
    let near = |height: f32| (body.mesh.positions[vertex].y - height).abs() < 0.03 * body.measures.stature;
    let proud = body.normals[vertex].z;
    let close = (proud < -0.6 && near(body.levels.hip)) || (proud > 0.6 && near(body.levels.chest));
    match body.regions[vertex] {
        Region::Torso if hangs => 6.0,
        Region::Torso if close => 6.0,
        Region::Torso => 2.5,
        _ => 1.0,
    }
}

/// Spheres at the joints, and within the trunk at its levels.
fn first_guess(body: &Body) -> Vector {
    let (levels, skeleton) = (&body.levels, &body.skeleton);
    let trunk = |height: f32, girth: f32| {
        // A section twice as broad as it is deep, rounded by two circles.
        let radius = girth / 9.0;
        (Vec3::new(0.62 * radius, height, -0.02 * girth), radius)
    };
    let joint = |j: Joint, radius: f32| (skeleton.at(j), radius * body.measures.stature);
    let mut x = [0.0; UNKNOWNS];
    let guess = [
        trunk(levels.hip, body.measures.hip_girth),
        trunk(levels.waist, body.measures.waist_girth),
        trunk(levels.chest, body.measures.chest_girth),
        joint(Joint::LeftShoulder, 0.03),
        joint(Joint::LeftElbow, 0.022),
        joint(Joint::LeftWrist, 0.014),
        joint(Joint::LeftKnee, 0.031),
        joint(Joint::LeftAnkle, 0.02),
    ];
    for (k, (centre, radius)) in guess.into_iter().enumerate() {
        x[4 * k..4 * k + 4].copy_from_slice(&[centre.x, centre.y, centre.z, radius].map(f64::from));
    }
    x
}

/// How strongly each sphere is held to its first guess (1/m^2 against a mean squared distance): those of the limbs' joints
/// stay where the limb bends.
fn stiffness() -> Vector {
    let mut held = [0.0; UNKNOWNS];
    for (k, joint) in CARRIERS.iter().enumerate() {
        let hold = match joint {
            Joint::Pelvis | Joint::Spine | Joint::Chest => 2e-4,
            Joint::LeftClavicle => 2e-3,
            _ => 2e-2,
        };
        held[4 * k..4 * k + 3].fill(hold);
    }
    held
}

fn placed(x: &Vector) -> Placed {
    std::array::from_fn(|i| {
        let [cx, cy, cz, r] = [0, 1, 2, 3].map(|k| x[i / 2 * 4 + k] as f32);
        (Vec3::new(if i % 2 == 0 { cx } else { -cx }, cy, cz), r)
    })
}

/// The cost at `x`, and if asked for, its normal equations. Where a point of the axis moves by dc and its radius by dr,
/// the distance changes by -n . dc - dr (the envelope theorem: the place on the axis is already the best one).
fn assemble(
    x: &Vector,
    samples: &[Sample],
    start: &Vector,
    stiffness: &Vector,
    mut system: Option<&mut System>,
) -> f64 {
    let spheres = placed(x);
    let mut cost = 0.0;
    for sample in samples {
        let (distance, capsule, t) = nearest(&spheres, sample.point);
        let d = f64::from(distance);
        let square = d * d / (FAIR * FAIR);
        let weight = sample.weight * if distance < 0.0 { OUTSIDE } else { 1.0 };
        cost += weight * d * d * (1.0 + square);
        let Some(system) = system.as_deref_mut() else { continue };
        let ends = CAPSULES[capsule].map(usize::from);
        let centre = spheres[ends[0]].0.lerp(spheres[ends[1]].0, t);
        let normal = (sample.point - centre).normalize_or_zero();
        let mut row = Row::default();
        for (end, share) in [(ends[0], 1.0 - t), (ends[1], t)] {
            let mirror = if end % 2 == 0 { 1.0 } else { -1.0 };
            let slope = [-normal.x * mirror, -normal.y, -normal.z, -1.0].map(|g| f64::from(g * share));
            row.add(end / 2, slope);
        }
        system.add(&row, d, weight * (1.0 + 2.0 * square));
    }
    for i in 0..UNKNOWNS {
        let away = x[i] - start[i];
        cost += stiffness[i] * away * away;
        if let Some(system) = system.as_deref_mut() {
            system.matrix[i][i] += stiffness[i];
            system.right[i] -= stiffness[i] * away;
        }
    }
    cost
}

/// One residual's gradient: at most two spheres, or one where a capsule joins a sphere to its own mirror image.
#[derive(Default)]
struct Row {
    spheres: [usize; 2],
    slopes: [[f64; 4]; 2],
    used: usize,
}

impl Row {
    fn add(&mut self, sphere: usize, slope: [f64; 4]) {
        if self.used == 1 && self.spheres[0] == sphere {
            for (sum, s) in self.slopes[0].iter_mut().zip(slope) {
                *sum += s;
            }
        } else {
            self.spheres[self.used] = sphere;
            self.slopes[self.used] = slope;
            self.used += 1;
        }
    }

    fn entries(&self) -> impl Iterator<Item = (usize, f64)> {
        (0..self.used * 4).map(|i| (4 * self.spheres[i / 4] + i % 4, self.slopes[i / 4][i % 4]))
    }
}

/// Normal equations of the least squares.
struct System {
    matrix: [Vector; UNKNOWNS],
    right: Vector,
}

impl Default for System {
    fn default() -> Self {
        Self { matrix: [[0.0; UNKNOWNS]; UNKNOWNS], right: [0.0; UNKNOWNS] }
    }
}

impl System {
    fn add(&mut self, row: &Row, residual: f64, weight: f64) {
        for (i, a) in row.entries() {
            self.right[i] -= weight * a * residual;
            for (j, b) in row.entries() {
                self.matrix[i][j] += weight * a * b;
            }
        }
    }

    /// The damped step, by Cholesky; `None` where the matrix is not positive definite.
    fn solve(mut self, damping: f64) -> Option<Vector> {
        for i in 0..UNKNOWNS {
            self.matrix[i][i] += damping * self.matrix[i][i] + 1e-9;
            for j in 0..=i {
                let dot: f64 = (0..j).map(|k| self.matrix[i][k] * self.matrix[j][k]).sum();
                let rest = self.matrix[i][j] - dot;
                self.matrix[i][j] = match i == j {
                    true if rest > 0.0 => rest.sqrt(),
                    true => return None,
                    false => rest / self.matrix[j][j],
                };
            }
        }
        for i in 0..UNKNOWNS {
            let dot: f64 = (0..i).map(|k| self.matrix[i][k] * self.right[k]).sum();
            self.right[i] = (self.right[i] - dot) / self.matrix[i][i];
        }
        for i in (0..UNKNOWNS).rev() {
            let dot: f64 = (i + 1..UNKNOWNS).map(|k| self.matrix[k][i] * self.right[k]).sum();
            self.right[i] = (self.right[i] - dot) / self.matrix[i][i];
        }
        Some(self.right)
    }
}
