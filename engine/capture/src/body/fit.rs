//! The fit of one sex's body to silhouettes: Gauss-Newton over pose and shape on the distances of its rim from the planes that touch it.
//!
//! With the plane of a stretch of outline in a camera at `c` with normal `n`, and the place `x` of the rim that belongs to it, the
//! residual is `n . (x - c)`: how far the body reaches out of the silhouette there, from inside and outside alike. The prior of the
//! shape is the population (ANSUR II), that of the pose is a standing person.

use std::sync::Arc;

use glam::{DVec3, Vec3};
use toile_assets::body::shape::{BodyShape, Shapes};
use toile_base::body::Sex;
use toile_base::skeleton::{JOINTS, Joint};
use toile_track::fit::{
    BodyModel, FitState, NormalEquations, PosePrior, PosedBody, SeenSurface, ShapeFilter, ShapeQuadratic, Stance,
    add_priors, limit_step,
};

use super::joint_point::JointPoint;
use super::rim::{DrawnSurface, RimMatch, matches, overlap, rim};
use super::view::CameraSilhouette;
use toile_pose::depth_buffer::DepthBuffer;

/// Stages of the fit, coarse to fine: largest distance of a match (m), distance at which it has a quarter of its weight (m), steps.
pub(super) const COARSE: [(f64, f64, usize); 2] = [(0.30, 0.20, 6), (0.15, 0.08, 6)];
pub(super) const FINE: [(f64, f64, usize); 2] = [(0.10, 0.05, 8), (0.06, 0.03, 8)];

/// Standard deviation of an outline's place (m). Errors of a body that the model cannot have go together over a hand's breadth, which
/// is ten stretches: 4 mm times the root of ten.
const OUTLINE_SIGMA: f32 = 0.012;

/// Standard deviation of a joint that was found in pictures (m): networks and bodies disagree on where a joint is.
const JOINT_SIGMA: f32 = 0.04;

/// Levenberg-Marquardt damping, a fraction of each diagonal.
const DAMPING: f64 = 1e-3;

/// Change of any shape parameter at which the rest normals are computed again.
const RESHAPED: f64 = 0.01;

/// Rounds of moving the surface to its outlines and posing it again, and as how many cells of depth one match counts there.
const ROUNDS: usize = 3;
const RIM_CELLS: f32 = 3.0;

/// What a match counts against the smoothness of the surface: a rim is a line, and where it counted once, as a cell of depth does, the
/// surface came half of the way to it.
const RIM_WORTH: f64 = 16.0;

/// Farthest that an outline lies from the fitted body and is its skin's (m).
const SKIN: f64 = 0.03;

/// Views and joints, and one sex's body between them.
pub(super) struct BodyFitter {
    pub views: Arc<[CameraSilhouette]>,
    pub joints: Vec<JointPoint>,
    /// The state of the frame before, where a person is followed.
    pub before: Option<FitState>,
    pub model: BodyModel,
    pub filter: ShapeFilter,
    posed: PosedBody,
    equations: NormalEquations,
    buffers: Vec<DepthBuffer>,
    faces: Vec<[u32; 4]>,
    triangles: Vec<[u32; 3]>,
    rest_normals: Vec<Vec3>,
    /// Vertices at rest: those of the shape, displaced where the surface was moved (m).
    rest: Vec<Vec3>,
    displacement: Option<Vec<Vec3>>,
    shaped: Option<BodyShape>,
}

impl BodyFitter {
    pub(super) fn new(sex: Sex, views: Arc<[CameraSilhouette]>, joints: Vec<JointPoint>) -> Self {
        let shapes = Shapes::of(sex);
        let model = BodyModel::new(shapes, 0.0);
        let faces: Vec<[u32; 4]> = model.samples.iter().map(|s| s.corners).collect();
        Self {
            posed: PosedBody::new(&model),
            equations: NormalEquations::new(),
            filter: ShapeFilter::new(shapes),
            buffers: views.iter().map(|v| DepthBuffer::new(v.camera.size, v.scale)).collect(),
            triangles: faces.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]).collect(),
            rest_normals: vec![Vec3::ZERO; faces.len()],
            rest: Vec::new(),
            displacement: None,
            shaped: None,
            faces,
            model,
            views,
            joints,
            before: None,
        }
    }

    /// Poses the body and gives its vertices (m, world).
    fn pose(&mut self, state: &FitState) -> Vec<DVec3> {
        self.reshape(&state.shape);
        self.posed.pose(&self.model, state, &self.rest_normals);
        self.posed.skinned(&self.model, state, &self.rest).iter().map(|p| p.as_dvec3()).collect()
    }

    fn reshape(&mut self, shape: &BodyShape) {
        let shapes = self.model.shapes;
        if self.shaped.as_ref() == Some(shape) {
            return;
        }
        let turn = self.shaped.is_none_or(|s| s.iter().zip(shape).any(|(a, b)| (a - b).abs() >= RESHAPED));
        self.rest = (0..shapes.base().positions.len()).map(|v| shapes.place(v, shape)).collect();
        if let Some(by) = &self.displacement {
            self.rest.iter_mut().zip(by).for_each(|(p, d)| *p += *d);
        }
        if turn || self.displacement.is_some() {
            self.turn_normals();
            self.shaped = Some(*shape);
        }
    }

    fn turn_normals(&mut self) {
        for (normal, corners) in self.rest_normals.iter_mut().zip(&self.faces) {
            let [a, b, c, d] = corners.map(|v| self.rest[v as usize]);
            *normal = (c - a).cross(d - b).normalize_or_zero();
        }
    }

    /// How well the drawing of a state covers the silhouettes: what both have over what either has, all views together, 0 to 1.
    pub(super) fn agreement(&mut self, state: &FitState) -> f64 {
        let positions = self.pose(state);
        let mut sum = [0, 0];
        for (view, buffer) in self.views.iter().zip(&mut self.buffers) {
            buffer.draw(&view.camera, &positions, &self.triangles);
            let [both, either] = overlap(view, buffer);
            sum = [sum[0] + both, sum[1] + either];
        }
        sum[0] as f64 / sum[1].max(1) as f64
    }

    /// All matches of a posed body, view by view.
    fn matches(&mut self, positions: &[DVec3], gate: f64) -> Vec<RimMatch> {
        let normals = vertex_normals(positions, &self.triangles);
        let surface = DrawnSurface { positions, normals: &normals, faces: &self.faces, triangles: &self.triangles };
        let mut all = Vec::new();
        for (view, buffer) in self.views.iter().zip(&mut self.buffers) {
            let around = rim(view, &surface, buffer);
            all.extend(matches(view, &around, gate));
        }
        all
    }

    /// Steps of some stages, with the shape free or kept.
    pub(super) fn steps(&mut self, from: &FitState, stages: &[(f64, f64, usize)], kept: bool) -> FitState {
        let mut state = *from;
        for &(gate, robust, steps) in stages {
            for _ in 0..steps {
                let shape = if kept { ShapeQuadratic::KEPT } else { self.filter.about(&state.shape) };
                self.sum(&state, gate, robust);
                let by = limit_step(self.equations.step(&shape, DAMPING));
                let next = state.stepped(&self.model, &by);
                if !next.root.is_finite() {
                    return state;
                }
                state = next;
            }
        }
        state
    }

    /// Steps towards the joints alone.
    pub(super) fn towards_joints(&mut self, from: &FitState, steps: usize) -> FitState {
        let mut state = *from;
        for _ in 0..steps {
            self.pose(&state);
            self.equations.clear();
            self.add_joints();
            self.add_pose_prior(&state);
            let by = limit_step(self.equations.step(&self.filter.about(&state.shape), DAMPING));
            state = state.stepped(&self.model, &by);
        }
        state
    }

    /// Sums the normal equations at a state.
    pub(super) fn sum(&mut self, state: &FitState, gate: f64, robust: f64) {
        let positions = self.pose(state);
        let found = self.matches(&positions, gate);
        self.equations.clear();
        for m in &found {
            let share = m.outside / robust;
            let weight = (1.0 + share * share).powi(-2) as f32 / (OUTLINE_SIGMA * OUTLINE_SIGMA);
            let row = self.posed.row(&self.model, m.face, m.normal.as_vec3());
            self.equations.add(&row, m.outside as f32, weight);
        }
        self.add_joints();
        self.add_pose_prior(state);
    }

    fn add_joints(&mut self) {
        for point in &self.joints {
            let off = self.posed.place[point.joint.index()] - point.place.as_vec3();
            let weight = (point.confidence / JOINT_SIGMA).powi(2);
            for axis in [Vec3::X, Vec3::Y, Vec3::Z] {
                let row = self.posed.joint_row(&self.model, point.joint, axis);
                self.equations.add(&row, off.dot(axis), weight);
            }
        }
    }

    fn add_pose_prior(&mut self, state: &FitState) {
        // With joints seen, or where they have moved, people may stand as they like.
        let held = self.joints.is_empty() && self.before.is_none();
        let stance = if held { Stance::Held } else { Stance::Moving };
        let prior = PosePrior { stance, before: self.before.as_ref(), held: None };
        add_priors(&mut self.equations, &self.model, state, &prior);
    }

    /// Takes what the silhouettes say of the shape at a state into the estimate; gives the deviance of the fit: twice the negative
    /// logarithm of the model's evidence.
    pub(super) fn conclude(&mut self, state: &FitState) -> f64 {
        let (gate, robust, _) = FINE[FINE.len() - 1];
        self.sum(state, gate, robust);
        self.filter.add(&self.equations.shape(), &state.shape);
        self.equations.cost + self.filter.deviance()
    }

    /// Root mean square distance of the rim from its outlines (m), and how many there are.
    pub(super) fn distance(&mut self, state: &FitState) -> (f64, usize) {
        let positions = self.pose(state);
        let found = self.matches(&positions, FINE[FINE.len() - 1].0);
        let squares: f64 = found.iter().map(|m| m.outside * m.outside).sum();
        ((squares / found.len().max(1) as f64).sqrt(), found.len())
    }

    /// Moves the surface to its outlines, smoothly, and poses it again in turn; gives the surface at rest (m) and the pose.
    pub(super) fn surface(&mut self, state: &FitState) -> (Vec<Vec3>, FitState) {
        let body = self.model.shapes.body(&state.shape).body;
        let mut state = *state;
        let mut out = vec![0.0; body.mesh.positions.len()];
        for _ in 0..ROUNDS {
            let positions = self.pose(&state);
            let mut seen = SeenSurface::counting(self.model.samples.len(), RIM_WORTH);
            for m in self.matches(&positions, FINE[FINE.len() - 1].0) {
                // What points sideways tells little of how far the surface lies out, and what lies far off is another part.
                let along = self.posed.normals[m.face].dot(m.normal.as_vec3()) > 0.8;
                if m.by_outline && along && m.outside.abs() < SKIN {
                    seen.add_rim(m.face, -m.outside as f32, RIM_CELLS);
                }
            }
            out = seen.displacements(&self.model, &out);
            self.displace(&body.mesh.positions, body.normals.iter().zip(&out).map(|(n, by)| *n * *by).collect());
            state = self.steps(&state, &[(FINE[1].0, FINE[1].1, 3)], true);
        }
        (self.rest.clone(), state)
    }

    /// Other silhouettes of the same body: those of the next frame.
    pub(super) fn look(&mut self, views: Arc<[CameraSilhouette]>, joints: Vec<JointPoint>) {
        self.buffers = views.iter().map(|v| DepthBuffer::new(v.camera.size, v.scale)).collect();
        (self.views, self.joints) = (views, joints);
    }

    /// Gives the body of a shape a surface that was moved (m, at rest) `[vertices]`.
    pub(super) fn wear(&mut self, shape: &BodyShape, surface: &[Vec3]) {
        let shaped = self.model.shapes.body(shape).body.mesh.positions;
        let by = surface.iter().zip(&shaped).map(|(p, s)| *p - *s).collect();
        self.displace(&shaped, by);
        self.shaped = Some(*shape);
    }

    /// Where the joints are in a state, world (m).
    pub(super) fn joint_places(&mut self, state: &FitState) -> [Vec3; JOINTS] {
        self.pose(state);
        self.posed.place
    }

    fn displace(&mut self, shaped: &[Vec3], by: Vec<Vec3>) {
        self.rest = shaped.iter().zip(&by).map(|(p, d)| *p + *d).collect();
        for (moved, corners) in self.posed.displaced.iter_mut().zip(&self.faces) {
            *moved = corners.iter().map(|v| by[*v as usize]).sum::<Vec3>() / 4.0;
        }
        self.displacement = Some(by);
        self.turn_normals();
    }

    /// The surface as it stands in a state, world (m) `[vertices]`.
    pub(super) fn standing(&mut self, state: &FitState) -> Vec<Vec3> {
        self.posed.skinned(&self.model, state, &self.rest)
    }

    /// A surface at rest with legs and feet as they stand in a state, on the floor (m) `[vertices]`.
    pub(super) fn on_its_legs(&mut self, state: &FitState, rest: &[Vec3]) -> Vec<Vec3> {
        use Joint::{LeftAnkle, LeftHip, LeftKnee, RightAnkle, RightHip, RightKnee};
        let root = self.model.shapes.skeleton(&state.shape).at(Joint::Pelvis);
        let mut legs = FitState { root, local: [glam::Quat::IDENTITY; _], shape: state.shape };
        for joint in [LeftHip, LeftKnee, LeftAnkle, RightHip, RightKnee, RightAnkle] {
            legs.local[joint.index()] = state.local[joint.index()];
        }
        let mut posed = self.posed.skinned(&self.model, &legs, rest);
        let lowest = posed.iter().map(|p| p.y).fold(f32::MAX, f32::min);
        posed.iter_mut().for_each(|p| p.y -= lowest);
        posed
    }
}

/// The normals of vertices, of the length of their triangles' area.
fn vertex_normals(positions: &[DVec3], triangles: &[[u32; 3]]) -> Vec<DVec3> {
    let mut normals = vec![DVec3::ZERO; positions.len()];
    for corners in triangles {
        let [a, b, c] = corners.map(|v| positions[v as usize]);
        let normal = (b - a).cross(c - a);
        corners.iter().for_each(|v| normals[*v as usize] += normal);
    }
    normals.iter_mut().for_each(|n| *n = n.normalize_or_zero());
    normals
}
