//! The measures of the scene, taken outside of the timed part from what the cloth publishes: nothing here asks the
//! solver how well it did.

use glam::{DVec3, Vec3, Vec3A, Vec4, Vec4Swizzles};
use toile_assets::scene::skirt::{self, CAPSULES};
use toile_engine::cone::RoundCone;

use super::options::SkirtMesh;
use super::scene::{SkirtScene, Spheres};
use super::winding;

/// Depth from which a vertex counts as inside (m): a hundred times the last bit of f32 where the skirt is.
const INSIDE_M: f32 = 1e-5;

/// Acceleration of gravity (m/s2).
const G: f64 = 9.81;

/// Spheres of hip, knee and ankle on either side.
const LEGS: [[usize; 3]; 2] = [[5, 7, 9], [6, 8, 10]];

/// What one frame of one skirt shows.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct FrameErrors {
    /// Mean of |l/l0 - 1| over warp and weft edges.
    pub strain_mean: f64,
    /// 99th percentile of the strain (1).
    pub strain_p99: f64,
    /// The longest edge's l/l0 - 1.
    pub stretch_max: f64,
    /// The shortest edge's 1 - l/l0.
    pub compression_max: f64,
    /// Worst |l/l0 - 1| beyond what the weight that hangs on the edge stretches its thread by.
    pub beyond_max: f64,
    /// Mean of the same over the edges.
    pub beyond_mean: f64,
    /// Deepest vertex inside the body (m).
    pub deepest: f32,
    /// Vertices inside the body.
    pub inside: usize,
    /// Legs that the hem does not go around exactly once.
    pub wrong_legs: usize,
    /// Vertices that are not finite.
    pub nonfinite: usize,
}

/// An edge that strain is measured on; kept small, so that measuring does not sweep the cloth out of the caches.
#[derive(Debug, Clone, Copy)]
struct Edge {
    ends: [u32; 2],
    rest: f64,
    /// Strain by the weight below it.
    elastic: f64,
}

/// Measures frames; everything that can be worked out once is.
#[derive(Debug, Clone)]
pub struct Gauge {
    edges: Vec<Edge>,
    free: Vec<bool>,
    hem: Vec<usize>,
    scratch: Vec<f64>,
    loop_points: Vec<DVec3>,
}

impl Gauge {
    /// A gauge for the skirts of a stage.
    pub fn new(scene: &SkirtScene) -> Self {
        let particle_of = scene.particle_of();
        let elastic = elastic_strains(scene, &particle_of);
        let mut row_of = vec![0; particle_of.len()];
        particle_of.iter().enumerate().for_each(|(v, &p)| row_of[p as usize] = v / scene.side);
        let free: Vec<bool> = scene.garment.inverse_mass.iter().map(|w| *w > 0.0).collect();
        let edge = |([a, b], rest): &([u32; 2], f32)| {
            let [one, other] = [row_of[*a as usize], row_of[*b as usize]];
            let elastic = if one == other { 0.0 } else { elastic[one.min(other)] };
            Edge { ends: [*a, *b], rest: f64::from(*rest), elastic }
        };
        // Edges of the pinned ring cannot stretch: counting them would flatter the solver.
        let edges: Vec<Edge> =
            scene.garment.strain_edges.iter().map(edge).filter(|e| e.ends.iter().any(|i| free[*i as usize])).collect();
        let hem: Vec<usize> = skirt::hem(scene.side).map(|v| particle_of[v] as usize).collect();
        Self { scratch: vec![0.0; edges.len()], loop_points: Vec::with_capacity(hem.len()), edges, free, hem }
    }

    /// Edges that strain is measured on.
    pub fn edges(&self) -> usize {
        self.edges.len()
    }

    /// Measures one skirt on the body as it was asked for.
    pub fn read(&mut self, positions: &[Vec3A], spheres: &Spheres) -> FrameErrors {
        let mut frame =
            FrameErrors { nonfinite: positions.iter().filter(|p| !p.is_finite()).count(), ..FrameErrors::default() };
        self.strain(positions, &mut frame);
        self.penetration(positions, spheres, &mut frame);
        self.loop_points.clear();
        self.loop_points.extend(self.hem.iter().map(|&i| Vec3::from(positions[i]).as_dvec3()));
        let joint = |s: usize| spheres[s].xyz().as_dvec3();
        let around = |[hip, knee, ankle]: &[usize; 3]| {
            winding::around(&self.loop_points, joint(*hip), joint(*knee), joint(*ankle))
        };
        frame.wrong_legs = LEGS.iter().filter(|leg| around(leg) != 1).count();
        frame
    }

    fn strain(&mut self, positions: &[Vec3A], frame: &mut FrameErrors) {
        let (mut sum, mut beyond_sum) = (0.0, 0.0);
        for (edge, strain) in self.edges.iter().zip(&mut self.scratch) {
            let [a, b] = edge.ends.map(|i| Vec3::from(positions[i as usize]).as_dvec3());
            let stretch = a.distance(b) / edge.rest - 1.0;
            *strain = stretch.abs();
            sum += *strain;
            frame.stretch_max = frame.stretch_max.max(stretch);
            frame.compression_max = frame.compression_max.max(-stretch);
            let beyond = (stretch - edge.elastic).abs();
            beyond_sum += beyond;
            frame.beyond_max = frame.beyond_max.max(beyond);
        }
        let count = self.scratch.len();
        frame.strain_mean = sum / count as f64;
        frame.beyond_mean = beyond_sum / count as f64;
        frame.strain_p99 = *self.scratch.select_nth_unstable_by((count - 1) * 99 / 100, f64::total_cmp).1;
    }

    fn penetration(&self, positions: &[Vec3A], spheres: &Spheres, frame: &mut FrameErrors) {
        let body = CAPSULES.map(|ends| Capsule::new(ends.map(|s| spheres[usize::from(s)])));
        let free = positions.iter().zip(&self.free).filter(|(_, free)| **free);
        for (&p, _) in free {
            let depth = body.iter().map(|c| c.depth(p)).fold(0.0, f32::max);
            frame.deepest = frame.deepest.max(depth);
            frame.inside += usize::from(depth > INSIDE_M);
        }
    }
}

/// A capsule of the body with the box around it.
struct Capsule {
    cone: RoundCone,
    low: Vec3A,
    high: Vec3A,
}

impl Capsule {
    fn new([a, b]: [Vec4; 2]) -> Self {
        let [ca, cb] = [a, b].map(Vec3A::from_vec4);
        Self {
            cone: RoundCone::new(a.xyz(), a.w, b.xyz(), b.w),
            low: (ca - a.w).min(cb - b.w),
            high: (ca + a.w).max(cb + b.w),
        }
    }

    /// How deep a point is inside (m), 0 outside.
    fn depth(&self, p: Vec3A) -> f32 {
        let may = (p.cmpge(self.low) & p.cmple(self.high)).all();
        if may { (-self.cone.distance(p.into()).0).max(0.0) } else { 0.0 }
    }
}

/// Strain of the warp edge below each row of the hanging grid by the weight of what is below it: T / (E w), with E the
/// fabric's stiffness and w the width of cloth that the edge carries. 0 where threads do not stretch, and for an
/// irregular mesh, whose threads run across rows.
fn elastic_strains(scene: &SkirtScene, particle_of: &[u32]) -> Vec<f64> {
    let n = scene.side;
    let stiffness = f64::from(scene.garment.fabric.stretch_warp_n_m);
    if scene.options.mesh == SkirtMesh::Irregular || !stiffness.is_finite() {
        return vec![0.0; n];
    }
    let masses = scene.masses();
    let row_mass = |i: usize| (i * n..(i + 1) * n).map(|v| masses[particle_of[v] as usize]).sum::<f64>();
    let spacing = |i: usize| f64::from(scene.shape.cut[i * n].distance(scene.shape.cut[i * n + 1]));
    let below = |i: usize| (i + 1..n).map(row_mass).sum::<f64>() / n as f64;
    let strain =
        |i: usize| if i + 1 < n { G * below(i) / (stiffness * 0.5 * (spacing(i) + spacing(i + 1))) } else { 0.0 };
    (0..n).map(strain).collect()
}

#[cfg(test)]
mod tests {
    use toile_assets::scene::skirt::Stretch;

    use super::super::options::SkirtOptions;
    use super::*;
    use toile_fitting::heap::HeapProbe;

    fn scene(mesh: SkirtMesh, stretch: Stretch) -> SkirtScene {
        let options = SkirtOptions { verts: 1_024, mesh, stretch, ..SkirtOptions::default() };
        SkirtScene::new(&options, &HeapProbe::none()).unwrap()
    }

    fn at_rest(scene: &SkirtScene) -> Vec<Vec3A> {
        let mut at = vec![Vec3A::ZERO; scene.shape.cut.len()];
        scene.particle_of().iter().zip(&scene.shape.cut).for_each(|(&p, &x)| at[p as usize] = x.into());
        at
    }

    #[test]
    fn at_rest_nothing_is_strained_or_inside_and_the_hem_is_around_both_legs() {
        for mesh in [SkirtMesh::Grid, SkirtMesh::Irregular] {
            let scene = scene(mesh, Stretch::Inextensible);
            let mut gauge = Gauge::new(&scene);
            let frame = gauge.read(&at_rest(&scene), &scene.spheres);
            assert!(frame.strain_mean < 1e-5 && frame.stretch_max < 1e-4, "{frame:?}");
            assert_eq!((frame.deepest, frame.inside, frame.wrong_legs, frame.nonfinite), (0.0, 0, 0, 0));
        }
    }

    #[test]
    fn strain_is_over_the_warp_and_weft_of_the_grid_and_nothing_else() {
        let scene = scene(SkirtMesh::Grid, Stretch::Inextensible);
        let gauge = Gauge::new(&scene);
        // 31 rows of 32 warp edges, 31 free rows of 32 weft edges.
        assert_eq!(gauge.edges(), 2 * 31 * 32);
        let mut positions = at_rest(&scene);
        positions.iter_mut().for_each(|p| *p *= 1.1);
        let frame = gauge.clone().read(&positions, &scene.spheres);
        assert!((frame.strain_mean - 0.1).abs() < 1e-5 && (frame.strain_p99 - 0.1).abs() < 1e-4, "{frame:?}");
        assert!((frame.stretch_max - 0.1).abs() < 1e-4 && frame.compression_max == 0.0);
    }

    #[test]
    fn one_vertex_in_the_body_is_found_at_its_depth() {
        let scene = scene(SkirtMesh::Grid, Stretch::Inextensible);
        let mut gauge = Gauge::new(&scene);
        let mut positions = at_rest(&scene);
        // 10 mm inside the left ankle, 0.05 m of radius, from in front.
        positions[scene.particle_of()[500] as usize] = Vec3A::new(0.11, 0.1, 0.04);
        let frame = gauge.read(&positions, &scene.spheres);
        assert_eq!(frame.inside, 1);
        assert!((frame.deepest - 0.0101).abs() < 2e-4, "{}", frame.deepest);
        positions[3] = Vec3A::NAN;
        assert_eq!(gauge.read(&positions, &scene.spheres).nonfinite, 1);
    }

    #[test]
    fn the_elastic_strain_is_that_of_the_weight_below() {
        let scene = scene(SkirtMesh::Grid, Stretch::Physical);
        let strains = elastic_strains(&scene, &scene.particle_of());
        // The ring's edge carries all but the ring and half a row: about 0.308 kg of 0.31 on 1.13 m.
        let expected = 9.81 * 0.307 / (2_000.0 * 1.15);
        assert!((strains[0] / expected - 1.0).abs() < 0.03, "{} {expected}", strains[0]);
        assert!(strains.windows(2).all(|s| s[1] < s[0]));
        let mut gauge = Gauge::new(&scene);
        let frame = gauge.read(&at_rest(&scene), &scene.spheres);
        assert!((frame.beyond_max - strains[0]).abs() < 1e-5, "unstretched, the ring's edges lack their strain");
    }
}
