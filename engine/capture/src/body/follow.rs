//! A measured person in one frame, followed through the next: the same body, moved to each frame's silhouettes.
//!
//! A frame starts from where the frame before ended, and from where its motion leads, whichever covers the silhouettes better. Where the fit
//! ends in less than the frames before, an arm was lost: those that people hold their arms in are tried, and each forearm elsewhere, as at
//! the start.

use std::sync::Arc;

use glam::{DVec3, Quat};
use toile_base::skeleton::JOINTS;
use toile_track::fit::FitState;

use super::fit::BodyFitter;
use super::joint_point::JointPoint;
use super::measured::{FEWEST, LEAST_AGREEMENT, SilhouetteBody, SilhouetteView};
use super::start::{ARM_JOINTS, other_forearm, with_arms};
use super::view::CameraSilhouette;

/// Stages of a frame: largest distance of a match (m), distance at which it has a quarter of its weight (m), steps.
const STAGES: [(f64, f64, usize); 3] = [(0.20, 0.12, 4), (0.10, 0.05, 4), (0.06, 0.03, 4)];

/// By how much less than in the frames before body and silhouettes agree where an arm is looked for.
const LOST: f64 = 0.015;

/// What a frame's agreement counts in what is expected of the next, where it is more and where it is less: an arm that was lost for
/// half a second is not given up.
const NEWEST: [f64; 2] = [0.2, 0.02];

/// A frame in which a person was followed.
#[derive(Debug, Clone)]
pub struct FollowedFrame {
    /// Where the joints are, in the cameras' world (m).
    pub joints: [DVec3; JOINTS],
    /// The surface, in the cameras' world (m) `[vertices]`.
    pub standing: Vec<DVec3>,
    /// What drawing and silhouettes have in common over what either has, 0 to 1.
    pub agreement: f64,
    /// Root mean square distance of the rim from the outlines (m).
    pub off: f64,
    /// Whether the body is where the silhouettes are; else it stands where it was last.
    pub found: bool,
}

/// Follows one body.
pub struct BodyFollower {
    fitter: BodyFitter,
    state: FitState,
    before: Option<FitState>,
    upright: glam::DMat3,
    /// Agreement that is expected.
    expected: f64,
}

impl BodyFollower {
    /// Begins with a measured person.
    pub fn new(first: &SilhouetteBody) -> Self {
        let mut fitter = BodyFitter::new(first.sex, Arc::new([]), Vec::new());
        fitter.wear(&first.state.shape, &first.body.body.mesh.positions);
        Self { fitter, state: first.state, before: None, upright: first.upright, expected: first.agreement }
    }

    /// Follows into the next frame: what cameras see the person, two of them at least, and joints in the cameras' world if there are any.
    pub fn next(&mut self, seen: &[SilhouetteView], joints: &[JointPoint]) -> FollowedFrame {
        let views: Arc<[CameraSilhouette]> =
            seen.iter().map(|s| CameraSilhouette::new(s.mask, s.camera, self.upright)).collect();
        let joints = joints.iter().map(|p| JointPoint { place: self.upright * p.place, ..*p }).collect();
        self.fitter.look(views, joints);
        if seen.len() < FEWEST {
            self.before = None;
            return self.frame(0.0, false);
        }
        let (agreement, state) = self.search();
        if agreement < LEAST_AGREEMENT.min(self.expected - 2.0 * LOST) {
            // Another person, or none: what comes next starts from where the person was.
            self.before = None;
            return self.frame(agreement, false);
        }
        self.before = Some(std::mem::replace(&mut self.state, state));
        self.expected += NEWEST[usize::from(agreement < self.expected)] * (agreement - self.expected);
        self.frame(agreement, true)
    }

    /// The state that agrees best, from where the body was and from where it was going.
    fn search(&mut self) -> (f64, FitState) {
        self.fitter.before = Some(self.state);
        let going = self.before.map(|before| going_on(&before, &self.state));
        let starts = [Some(self.state), going].into_iter().flatten();
        let tried: Vec<(f64, FitState)> = starts.map(|s| (self.fitter.agreement(&s), s)).collect();
        let start = tried.into_iter().max_by(|a, b| a.0.total_cmp(&b.0)).map_or(self.state, |t| t.1);
        let mut best = self.settled(&start);
        if best.0 < self.expected - LOST {
            self.fitter.before = None;
            let arms = with_arms(&mut self.fitter, best.1);
            best = self.better(best, &arms);
            for arm in ARM_JOINTS {
                if let Some(other) = other_forearm(&mut self.fitter, &best.1, arm) {
                    best = self.better(best, &other);
                }
            }
        }
        best
    }

    /// What was found, or what is found from somewhere else, if that agrees better.
    fn better(&mut self, found: (f64, FitState), from: &FitState) -> (f64, FitState) {
        self.fitter.before = Some(*from);
        let again = self.settled(from);
        self.fitter.before = None;
        if again.0 > found.0 { again } else { found }
    }

    fn settled(&mut self, from: &FitState) -> (f64, FitState) {
        let state = self.fitter.steps(from, &STAGES, true);
        (self.fitter.agreement(&state), state)
    }

    fn frame(&mut self, agreement: f64, found: bool) -> FollowedFrame {
        let back = self.upright.transpose();
        let state = self.state;
        let joints = self.fitter.joint_places(&state).map(|p| back * p.as_dvec3());
        let (off, _) = self.fitter.distance(&state);
        let standing = self.fitter.standing(&state).iter().map(|p| back * p.as_dvec3()).collect();
        FollowedFrame { joints, standing, agreement, off, found }
    }
}

/// The state that follows two others, if motion goes on as it did.
fn going_on(before: &FitState, now: &FitState) -> FitState {
    let turned = |(a, b): (&Quat, &Quat)| ((*b * a.inverse()) * *b).normalize();
    let mut local = now.local;
    local.iter_mut().zip(before.local.iter().zip(&now.local)).for_each(|(to, pair)| *to = turned(pair));
    FitState { root: now.root + (now.root - before.root), local, shape: now.shape }
}
