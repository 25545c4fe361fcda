//! Levenberg-Marquardt over the left spheres and those of the middle; the right ones are mirror images.

use glam::Vec3;

use super::plan::{CAPSULES, MIDDLE, PAIRS, PLAN, SpherePlace};
use super::skin::{SkinByHeight, vertex_areas};
use super::system::{NormalEquations, SphereGradient, SphereVector, UNKNOWNS};
use super::union::{RestSpheres, nearest};
use super::zones::{self, Zone};
use toile_base::body::Body;
use toile_base::rig::SPHERES;

/// Steps of the fit; it settles within these.
const STEPS: usize = 40;
/// Dampings tried in a step before it counts as settled.
const TRIES: usize = 6;
/// One vertex in this many is a sample of the fit; the report takes them all.
const STRIDE: usize = 5;
/// Distance at which the quartic part of the cost equals the quadratic one (m). Beyond it a few bad places cost more than
/// many fair ones: skin that shows through cloth, or cloth that floats, is seen where it is worst.
const FAIR: f64 = 8e-3;
/// One vertex in this many has a sample above it, which no capsule may come near: the skin alone says nothing of what
/// stands out beside it, such as a ball around a hand whose skin is nowhere far from the ball's surface.
const STRIDE_ABOVE: usize = 10;
/// How far above the skin those samples are (m).
const ABOVE: f32 = 0.025;
/// Their weight against those of the skin.
const SHARE_ABOVE: f64 = 0.7;
/// Weight of standing out of the body against staying below its surface: what stands out most does so in hollows (between
/// the breasts, along the spine) that cloth spans anyway, while skin that stands out pierces the cloth.
const OUTSIDE: f64 = 0.7;
/// How strongly a sphere is held to where it began (1/m^2 against a mean squared distance), its radius a tenth of that.
pub(super) const HOLD: f64 = 1e-4;
/// Farthest that a coordinate or radius moves in a step (m).
const STRIDE_M: f64 = 0.03;
/// Smallest radius (m).
const LEAST_RADIUS: f64 = 5e-3;

/// A point on the skin or above it.
struct SurfaceSample {
    point: Vec3,
    /// Weight in the cost.
    weight: f64,
    /// How far above the skin it is (m); 0 on the skin.
    above: f64,
}

/// Input of a fit.
struct FitProblem {
    samples: Vec<SurfaceSample>,
    start: SphereVector,
}

/// The spheres that fit the body best, in the rest pose.
pub(super) fn spheres(body: &Body) -> RestSpheres {
    let problem = FitProblem { samples: samples(body), start: start(body) };
    let mut x = problem.start;
    let mut cost = problem.cost(&x, None);
    let (mut damping, mut settled) = (1e-2, 0);
    for _ in 0..STEPS {
        let Some((tried, reached)) = problem.step(&x, cost, &mut damping) else { break };
        settled = if cost - reached < 1e-3 * cost { settled + 1 } else { 0 };
        (x, cost) = (tried, reached);
        if settled > 2 {
            break;
        }
    }
    placed(&x)
}

impl FitProblem {
    /// One step to a lower cost, and that cost; `None` where no damping leads to one.
    fn step(&self, x: &SphereVector, cost: f64, damping: &mut f64) -> Option<(SphereVector, f64)> {
        let mut system = NormalEquations::default();
        self.cost(x, Some(&mut system));
        for _ in 0..TRIES {
            if let Some(step) = system.solve(*damping) {
                let tried: SphereVector = std::array::from_fn(|i| {
                    let to = x[i] + step[i].clamp(-STRIDE_M, STRIDE_M);
                    if i % 4 == 3 { to.max(LEAST_RADIUS) } else { to }
                });
                let reached = self.cost(&tried, None);
                if reached < cost {
                    *damping = (*damping * 0.3).max(1e-7);
                    return Some((tried, reached));
                }
            }
            *damping *= 4.0;
        }
        None
    }

    /// The cost at `x`, and if asked for, its normal equations. Where a point of the axis moves by dc and its radius by
    /// dr, the distance changes by -n . dc - dr (the envelope theorem: the place on the axis is already the best one).
    fn cost(&self, x: &SphereVector, mut system: Option<&mut NormalEquations>) -> f64 {
        let spheres = placed(x);
        let mut cost = 0.0;
        for sample in &self.samples {
            let (distance, capsule, t) = nearest(&spheres, sample.point);
            let d = f64::from(distance) - sample.above;
            if d > 0.0 && sample.above > 0.0 {
                continue;
            }
            let square = d * d / (FAIR * FAIR);
            let weight = sample.weight * if d < 0.0 { OUTSIDE } else { 1.0 };
            cost += weight * d * d * (1.0 + square);
            if let Some(system) = system.as_deref_mut() {
                system.add(&slopes(&spheres, capsule, t, sample.point), d, weight * (1.0 + 2.0 * square));
            }
        }
        for i in 0..UNKNOWNS {
            let away = x[i] - self.start[i];
            let hold = HOLD * if i % 4 == 3 { 0.1 } else { PLAN[i / 4].held };
            cost += hold * away * away;
            if let Some(system) = system.as_deref_mut() {
                system.hold(i, hold, away);
            }
        }
        cost
    }
}

/// How the distance of a point from a capsule changes with the unknowns of its two spheres.
fn slopes(spheres: &RestSpheres, capsule: usize, t: f32, point: Vec3) -> SphereGradient {
    let ends = CAPSULES[capsule].map(usize::from);
    let centre = spheres[ends[0]].0.lerp(spheres[ends[1]].0, t);
    let normal = (point - centre).normalize_or_zero();
    let mut row = SphereGradient::default();
    for (k, (end, share)) in [(ends[0], 1.0 - t), (ends[1], t)].into_iter().enumerate() {
        // Those of the middle stay there.
        let (planned, across) = match end.checked_sub(2 * PAIRS) {
            Some(middle) => (PAIRS + middle, 0.0),
            None => (end / 2, if end % 2 == 0 { 1.0 } else { -1.0 }),
        };
        row.0[k] = (4 * planned, [-normal.x * across, -normal.y, -normal.z, -1.0].map(|g| f64::from(g * share)));
    }
    row
}

/// How much each zone matters: the trunk before the limbs, on which garments are wide; head, hands and feet not at all.
fn matter(zone: Zone) -> f64 {
    match zone {
        Zone::Chest => 1.5,
        Zone::Waist => 1.0,
        Zone::Hips => 2.0,
        Zone::Shoulder | Zone::Thigh => 0.9,
        Zone::Shin => 0.3,
        Zone::UpperArm => 0.25,
        Zone::Forearm | Zone::Neck => 0.2,
        Zone::Head => 0.1,
        Zone::Hand | Zone::Foot => 0.05,
    }
}

/// The left half of the skin, each zone with its own share of the whole, and places above it; the body is symmetric.
fn samples(body: &Body) -> Vec<SurfaceSample> {
    let areas = vertex_areas(body);
    let zones: Vec<Zone> = (0..areas.len()).map(|v| Zone::of(body, v)).collect();
    let left: Vec<usize> = (0..areas.len()).filter(|v| body.mesh.positions[*v].x >= 0.0).collect();
    let share = |stride: usize| {
        let area = |zone: Zone| -> f64 {
            left.iter().step_by(stride).filter(|v| zones[**v] == zone).map(|v| f64::from(areas[*v])).sum()
        };
        Zone::ALL.map(|zone| matter(zone) / area(zone).max(1e-9))
    };
    let on = share(STRIDE);
    let skin = left.iter().step_by(STRIDE).map(|&v| SurfaceSample {
        point: body.mesh.positions[v],
        weight: f64::from(areas[v]) * on[zones::place(zones[v])],
        above: 0.0,
    });
    let (above, look) = (share(STRIDE_ABOVE), SkinByHeight::new(body));
    let over = left.iter().step_by(STRIDE_ABOVE).filter_map(|&v| {
        let point = body.mesh.positions[v] + body.normals[v] * ABOVE;
        let (nearest, distance) = look.nearest(point)?;
        // In a fold the place above one side is in or near the other: there it says nothing.
        let clear = (point - body.mesh.positions[nearest]).dot(body.normals[nearest]) > 0.5 * ABOVE;
        let weight = SHARE_ABOVE * f64::from(areas[v]) * above[zones::place(zones[v])];
        clear.then_some(SurfaceSample { point, weight, above: f64::from(distance) })
    });
    skin.chain(over).collect()
}

/// Places of the plan's spheres on this body.
fn start(body: &Body) -> SphereVector {
    let mut x = [0.0; UNKNOWNS];
    for (k, planned) in PLAN.iter().enumerate() {
        let (centre, radius) = match planned.start {
            SpherePlace::Trunk { level, across, ahead, radius } => {
                let section = TrunkSection::at(body, height(body, level));
                let z = section.middle + ahead * section.half_depth;
                (Vec3::new(across * section.half_breadth, section.height, z), radius * section.half_depth)
            }
            SpherePlace::Limb { from, to, along, beside, radius } => {
                let way = body.skeleton.at(from).lerp(body.skeleton.at(to), along);
                (way + Vec3::from(beside) * body.measures.stature, radius * body.measures.stature)
            }
        };
        let across = if k < PAIRS { centre.x } else { 0.0 };
        x[4 * k..4 * k + 4].copy_from_slice(&[across, centre.y, centre.z, radius].map(f64::from));
    }
    x
}

/// The height of a place between the levels (m).
fn height(body: &Body, level: f32) -> f32 {
    let l = &body.levels;
    let levels = [l.crotch, l.hip, l.waist, l.underbust, l.chest, l.shoulder];
    let below = (level as usize).min(levels.len() - 2);
    levels[below] + (levels[below + 1] - levels[below]) * (level - below as f32)
}

/// How far the trunk reaches at a height (m).
struct TrunkSection {
    height: f32,
    half_breadth: f32,
    middle: f32,
    half_depth: f32,
}

impl TrunkSection {
    fn at(body: &Body, height: f32) -> Self {
        let (mut breadth, mut back, mut front) = (0.0f32, f32::MAX, f32::MIN);
        for (v, p) in body.mesh.positions.iter().enumerate() {
            if (p.y - height).abs() < 0.012 && zones::is_trunk_or_thigh(Zone::of(body, v)) {
                breadth = breadth.max(p.x);
                back = back.min(p.z);
                front = front.max(p.z);
            }
        }
        // At the shoulders the arms begin.
        let half_breadth = breadth.min(0.13 * body.measures.stature);
        Self { height, half_breadth, middle: 0.5 * (back + front), half_depth: 0.5 * (front - back) }
    }
}

fn placed(x: &SphereVector) -> RestSpheres {
    let sphere = |k: usize, mirror: f32| {
        let [cx, cy, cz, r] = [0, 1, 2, 3].map(|i| x[4 * k + i] as f32);
        (Vec3::new(mirror * cx, cy, cz), r)
    };
    std::array::from_fn(|i: usize| match i.checked_sub(2 * PAIRS) {
        Some(middle) => sphere(PAIRS + middle, 0.0),
        None => sphere(i / 2, if i.is_multiple_of(2) { 1.0 } else { -1.0 }),
    })
}

const _: () = assert!(2 * PAIRS + MIDDLE == SPHERES && UNKNOWNS == 4 * PLAN.len());
