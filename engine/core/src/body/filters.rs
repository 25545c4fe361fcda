//! The pose as a filter of joints, so that it can be compared with the others: joints in, those of the posed body out.

use toile_base::clock::seconds_between;
use toile_base::filter::Filter;
use toile_base::frame::{Joints, TrackedJoint};
use toile_base::skeleton::{JOINTS, Joint, Pose, Skeleton};

use super::Poser;
use super::body_input::BodyInput;
use super::ground::Ground;
use super::kinematics::JointFrames;
use super::reliable_joints::ReliableJoints;
use super::retarget::Retarget;

/// Joint limits alone: each degree of freedom is brought into its range, nothing is smoothed or remembered.
#[derive(Debug, Clone)]
pub struct LimitFilter {
    skeleton: Skeleton,
    retarget: Retarget,
    ground: Ground,
}

impl LimitFilter {
    /// Limits of a body of these bones.
    pub fn new(skeleton: &Skeleton) -> Self {
        Self { skeleton: skeleton.clone(), retarget: Retarget::new(skeleton), ground: Ground::new(skeleton) }
    }
}

impl Filter for LimitFilter {
    fn push(&mut self, frame: &Joints) -> Joints {
        let seen = ReliableJoints::new(frame);
        let Some(hips) = seen.hips() else { return Joints::absent(frame.time_ns) };
        self.ground.observe(&seen, 0.0, true);
        self.retarget.update(BodyInput { seen: &seen, ground: &self.ground, dt: 0.0, first: true });
        let pose = Pose { local: self.retarget.local, ..Pose::rest(&self.skeleton) };
        let frames = JointFrames::new(&self.skeleton, &pose);
        let middle = (frames.at(Joint::LeftHip) + frames.at(Joint::RightHip)) * 0.5;
        shown(frame, &JointFrames { position: frames.position.map(|p| p + hips - middle), ..frames })
    }

    fn reset(&mut self) {
        *self = Self::new(&self.skeleton);
    }
}

/// The whole pose: joint limits, asymptotic angles, the floor, planted feet.
#[derive(Debug, Clone)]
pub struct PoseFilter {
    poser: Poser,
    last_ns: Option<u64>,
}

impl PoseFilter {
    /// Poses of a body.
    pub fn new(poser: Poser) -> Self {
        Self { poser, last_ns: None }
    }
}

impl Filter for PoseFilter {
    fn push(&mut self, frame: &Joints) -> Joints {
        let dt = self.last_ns.map_or(0.0, |last| seconds_between(last, frame.time_ns));
        self.last_ns = Some(frame.time_ns);
        let pose = self.poser.pose(frame, dt);
        shown(frame, &JointFrames::new(self.poser.skeleton(), &pose))
    }

    fn reset(&mut self) {
        self.poser.reset();
        self.last_ns = None;
    }
}

/// The body's joints, believed as those of the frame: what is absent there is absent.
fn shown(frame: &Joints, frames: &JointFrames) -> Joints {
    let mut out = Joints::absent(frame.time_ns);
    for i in 0..JOINTS {
        let confidence = frame.joints[i].confidence;
        if confidence > 0.0 && frame.joints[i].position.is_finite() {
            out.joints[i] = TrackedJoint { position: frames.position[i], confidence: confidence.min(1.0) };
        }
    }
    out
}
