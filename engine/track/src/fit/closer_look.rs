//! A closer look at a person who was followed: shape and poses once more from all sides, then the surface that was seen.
//!
//! Following finds the shape little by little, so that its first frames were compared with another body than its last. Here
//! some views from every side are fitted again from their found poses, with the pose that the shopper kept. Then the
//! surface itself is moved to the seen points ([`SeenSurface`]), and each view is posed again with it, in turn.

use std::f32::consts::TAU;

use glam::{Quat, Vec3, Vec4};
use toile_assets::body::shape::BodyShape;
use toile_base::body::Body;
use toile_base::frame::DepthFrame;
use toile_base::skeleton::{JOINTS, Joint};

use super::body_fit::{BodyFit, ROBUST};
use super::depth_cells::DepthCells;
use super::normal_equations::ShapeQuadratic;
use super::path::PathState;
use super::posed_body::FitState;
use super::residuals::{self, Observation};
use super::seen_surface::SeenSurface;
use super::shape_filter::ShapeFilter;

/// Sides from which a person can be seen: 30 degrees each.
const SIDES: usize = 12;

/// Most views of one side, and fewest of all: a single side is looked at ten times, a whole turn 24 times.
const VIEWS_EACH: usize = 2;
const FEWEST_VIEWS: usize = 10;

/// Largest distance of a correspondence (m): all views have been found.
const GATE: f32 = 0.06;

/// Standard deviations of the angles of trunk and legs, and of the arms, about the pose that is kept through a turn (rad).
const KEPT: [f32; 2] = [0.02, 0.30];

/// Rounds of moving the surface and posing it again.
const ROUNDS: usize = 3;

/// Cells that one stretch of the rim counts as.
const RIM_WORTH: f32 = 3.0;

/// Largest angle between neighbouring views around a person who was seen from all sides (rad): front, sides and back will do.
pub const CLOSED: f32 = 1.75;

/// A body with the surface that was seen.
pub(super) struct SeenBody {
    /// The nearest shape of the model.
    pub shape: BodyShape,
    /// The surface at rest (m) `[vertices]`.
    pub rest: Vec<Vec3>,
    /// The same with legs and feet as they stood, on the floor (m) `[vertices]`.
    pub standing: Vec<Vec3>,
}

/// One view of the closer look.
struct CloserView {
    cells: DepthCells,
    state: FitState,
}

impl BodyFit {
    /// Whether the shopper was seen from all sides.
    pub(super) fn seen_from_all_sides(&self) -> bool {
        let mut all: Vec<f32> = self.path.iter().map(|p| p.facing).collect();
        all.sort_unstable_by(f32::total_cmp);
        let round = all.first().map(|first| first + TAU);
        let next = all.iter().skip(1).copied().chain(round);
        !all.is_empty() && all.iter().zip(next).all(|(a, b)| b - a < CLOSED)
    }

    /// Looks at the frames that were pushed once more; `None` if no body was found in them.
    pub(super) fn look_closer(&mut self, frames: &[DepthFrame]) -> Option<SeenBody> {
        let kept = self.mean_pose()?;
        let mut views = self.views(frames);
        // Nothing of what was followed since stays: the same views give the same bits.
        self.shaped = None;
        let mut again = ShapeFilter::new(self.model.shapes);
        for view in &mut views {
            let from = FitState { shape: self.shape_filter.estimate().0, ..view.state };
            self.update_rest_normals(&from.shape);
            std::mem::swap(&mut self.view, &mut view.cells);
            view.state = self.kept_steps(&from, &kept, self.options.steps, false);
            std::mem::swap(&mut self.view, &mut view.cells);
            again.add(&self.equations.shape(), &view.state.shape);
        }
        self.shape_filter = again;
        let shape = self.shape_filter.estimate().0;
        let body = self.model.shapes.body(&shape).body;
        // What is seen of a person in clothes is no skin.
        let clothed = self.options.clothed;
        let rest = if clothed { body.mesh.positions } else { self.surface(&shape, &body, &kept, &mut views) };
        self.last = self.last_pose_again(frames, &kept, &shape);
        let standing = self.on_its_legs(&shape, &kept, &rest);
        Some(SeenBody { shape, rest, standing })
    }

    /// The mean of the poses on the way: what the shopper kept while they turned.
    fn mean_pose(&self) -> Option<FitState> {
        let first = self.path.first()?.state;
        let local = std::array::from_fn(|j| {
            let one = Vec4::from(first.local[j]);
            let all = self.path.iter().map(|p| Vec4::from(p.state.local[j]));
            let sum: Vec4 = all.map(|q| if q.dot(one) < 0.0 { -q } else { q }).sum();
            Quat::from_vec4(sum.normalize_or(one))
        });
        Some(FitState { local, ..first })
    }

    /// Some views of every side that was seen.
    fn views(&self, frames: &[DepthFrame]) -> Vec<CloserView> {
        let side = |p: &&PathState| ((p.facing / TAU * SIDES as f32) as usize).min(SIDES - 1);
        let sides: Vec<Vec<&PathState>> =
            (0..SIDES).map(|s| self.path.iter().filter(|p| side(p) == s).collect()).collect();
        let seen = sides.iter().filter(|s| !s.is_empty()).count();
        let each = VIEWS_EACH.max(FEWEST_VIEWS.div_ceil(seen.max(1)));
        let chosen = sides.iter().flat_map(|s| {
            let count = s.len().min(each);
            (0..count).map(move |i| s[(2 * i + 1) * s.len() / (2 * count)])
        });
        chosen.map(|p| CloserView { cells: self.cells(&frames[p.frame]), state: p.state }).collect()
    }

    fn cells(&self, frame: &DepthFrame) -> DepthCells {
        let mut cells = DepthCells::new();
        cells.read(frame);
        if self.options.has_rim() {
            cells.read_rim(frame);
        }
        cells
    }

    /// The pose of the last frame with the shape that was found, from the pose that was kept: an arm that was lost while the trunk
    /// hid it may be anywhere.
    fn last_pose_again(&mut self, frames: &[DepthFrame], kept: &FitState, shape: &BodyShape) -> Option<FitState> {
        let last = self.path.last()?;
        let mut from = FitState { root: last.state.root, shape: *shape, ..*kept };
        from.local[Joint::Pelvis.index()] = last.state.local[Joint::Pelvis.index()];
        self.view = self.cells(&frames[last.frame]);
        self.update_rest_normals(shape);
        Some(self.kept_steps(&from, kept, self.options.steps, true))
    }

    /// Steps from a state with the pose that was kept; the shape may be kept, too.
    fn kept_steps(&mut self, from: &FitState, kept: &FitState, steps: usize, shape: bool) -> FitState {
        let held = Some((kept, KEPT));
        let mut state = *from;
        for _ in 0..steps {
            let known = if shape { ShapeQuadratic::KEPT } else { self.shape_filter.about(&state.shape) };
            let Some(next) = self.step(&state, &known, Some(from), held, (GATE, ROBUST)) else { break };
            state = next;
        }
        state
    }

    /// The surface at rest that all views show (m) `[vertices]`.
    fn surface(&mut self, shape: &BodyShape, body: &Body, kept: &FitState, views: &mut [CloserView]) -> Vec<Vec3> {
        let mut out = vec![0.0; body.mesh.positions.len()];
        let mut rest = body.mesh.positions.clone();
        self.shaped = None;
        self.update_rest_normals(shape);
        for round in 0..ROUNDS {
            let mut seen = SeenSurface::new(self.model.samples.len());
            for view in views.iter_mut() {
                std::mem::swap(&mut self.view, &mut view.cells);
                let from = FitState { shape: *shape, ..view.state };
                view.state = self.kept_steps(&from, kept, usize::from(round > 0), true);
                self.posed.pose(&self.model, &view.state, &self.rest_normals);
                self.matches.find(&self.view, &self.posed, GATE);
                self.gather(&mut seen);
                std::mem::swap(&mut self.view, &mut view.cells);
            }
            out = seen.displacements(&self.model, &out);
            let moved = body.mesh.positions.iter().zip(&body.normals).zip(&out);
            rest = moved.map(|((p, normal), by)| *p + *normal * *by).collect();
            self.displace(&body.mesh.positions, &rest);
        }
        self.posed.displaced.fill(Vec3::ZERO);
        self.shaped = None;
        rest
    }

    /// Adds what the view at hand shows of the posed body.
    fn gather(&self, seen: &mut SeenSurface) {
        let Self { model, posed, view, matches, .. } = self;
        let scene = Observation { model, posed, view, matches };
        seen.add(scene);
        for (sample, beyond) in view.rim.iter().filter_map(|cell| residuals::beyond_outline(scene, cell)) {
            seen.add_rim(sample, -beyond, RIM_WORTH);
        }
    }

    /// Moves the samples with a surface that has left the shape's.
    fn displace(&mut self, shaped: &[Vec3], rest: &[Vec3]) {
        for (i, sample) in self.model.samples.iter().enumerate() {
            let [now, before] = [rest, shaped].map(|p| sample.corners.map(|v| p[v as usize]));
            self.posed.displaced[i] = (now.iter().sum::<Vec3>() - before.iter().sum::<Vec3>()) / 4.0;
            self.rest_normals[i] = (now[2] - now[0]).cross(now[3] - now[1]).normalize_or_zero();
        }
    }

    /// A surface at rest with legs and feet as they stood, feet on the floor (m) `[vertices]`.
    fn on_its_legs(&mut self, shape: &BodyShape, kept: &FitState, rest: &[Vec3]) -> Vec<Vec3> {
        use Joint::{LeftAnkle, LeftHip, LeftKnee, RightAnkle, RightHip, RightKnee};
        let root = self.model.shapes.skeleton(shape).at(Joint::Pelvis);
        let mut state = FitState { root, local: [Quat::IDENTITY; JOINTS], shape: *shape };
        for joint in [LeftHip, LeftKnee, LeftAnkle, RightHip, RightKnee, RightAnkle] {
            state.local[joint.index()] = kept.local[joint.index()];
        }
        let mut posed = self.posed.skinned(&self.model, &state, rest);
        let lowest = posed.iter().map(|p| p.y).fold(f32::MAX, f32::min);
        posed.iter_mut().for_each(|p| p.y -= lowest);
        posed
    }
}
