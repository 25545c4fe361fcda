//! Joints made believable, frame by frame: gate, smooth, hold what is lost.
//!
//! Runs on the sensor thread in less than 50 µs a frame, with a fixed state and no allocation.

pub mod gate;
pub mod hold;
pub mod holt;
pub mod one_euro;

use glam::Vec3;
use toile_base::skeleton::{JOINTS, Joint};

use hold::Hold;
use holt::{Holt, HoltSettings};
use toile_base::clock::seconds_between;
use toile_base::filter::Filter;
use toile_base::frame::{Joints, TrackedJoint};

pub use hold::HELD_CONFIDENCE;

/// Longest gap across which joints are smoothed (s): after it another person may stand there.
const LONGEST_SILENCE: f32 = 1.0;

/// Shortest step between two frames (s); a frame that comes no later than the one before counts as this much later.
const SHORTEST_STEP: f32 = 1e-3;

/// State of one joint.
#[derive(Debug, Clone, Copy)]
struct JointTrack {
    smooth: Holt,
    hold: Hold,
    /// The measurement last believed (m), and when (ns).
    believed: Vec3,
    believed_ns: u64,
    /// Whether it was believed in the frame before.
    following: bool,
    /// Its position in the frame before (m).
    place: Vec3,
    /// How far the smoothed place moved in this frame (m); zero unless followed.
    moved: Vec3,
}

/// The filter of one shopper's joints. Its state has a fixed size; [`push`](Self::push) allocates nothing.
#[derive(Debug, Clone, Default)]
pub struct JointFilter {
    settings: HoltSettings,
    last_ns: Option<u64>,
    /// `None` for joints never seen.
    tracks: [Option<JointTrack>; JOINTS],
}

impl JointFilter {
    /// Forgets the shopper.
    pub fn reset(&mut self) {
        *self = Self::default();
    }

    /// Takes a frame and gives the believable one of the same time. Confidence is 1 for a joint that is seen,
    /// [`HELD_CONFIDENCE`] for one that is held, in between while it changes, and 0 for one never seen.
    ///
    /// After a silence of more than a second every joint comes back as from a dropout, its motion forgotten.
    pub fn push(&mut self, frame: &Joints) -> Joints {
        let frame = gate::in_the_room(frame);
        let dt = self.step(frame.time_ns);
        let seen = self.smooth(&frame, dt);
        let places = self.place(&frame, &seen, dt);
        self.joints(&frame, &places)
    }

    /// Seconds since the last frame; after a long silence the motion is forgotten.
    fn step(&mut self, time_ns: u64) -> f32 {
        let dt = self.last_ns.map_or(0.0, |last| seconds_between(last, time_ns));
        self.last_ns = Some(time_ns);
        if dt.abs() > LONGEST_SILENCE {
            self.tracks.iter_mut().flatten().for_each(|t| t.following = false);
        }
        dt.max(SHORTEST_STEP)
    }

    /// Gates each joint and smooths the believed ones; says which those are.
    fn smooth(&mut self, frame: &Joints, dt: f32) -> [bool; JOINTS] {
        let mut seen = [false; JOINTS];
        let mut trust = [0.0; JOINTS];
        for (i, tracked) in frame.joints.iter().enumerate() {
            seen[i] = tracked.is_believed() && self.tracks[i].is_none_or(|t| t.can_reach(tracked, frame.time_ns));
            if let Some(track) = &self.tracks[i]
                && seen[i]
                && track.following
            {
                trust[i] = track.smooth.trust(tracked.position, dt, &self.settings);
            }
        }
        let trust = shared(&trust);
        for (i, tracked) in frame.joints.iter().enumerate() {
            match &mut self.tracks[i] {
                Some(track) if seen[i] => track.follow(tracked.position, dt, trust[i], &self.settings),
                Some(track) => track.moved = Vec3::ZERO,
                empty if seen[i] => *empty = Some(JointTrack::first_seen(tracked.position)),
                _ => {}
            }
            if let Some(track) = &mut self.tracks[i]
                && seen[i]
            {
                (track.believed, track.believed_ns) = (tracked.position, frame.time_ns);
            }
        }
        seen
    }

    /// Places every joint ever seen: the seen ones where they are smoothed to, the others held, parents first.
    fn place(&mut self, frame: &Joints, seen: &[bool; JOINTS], dt: f32) -> [Vec3; JOINTS] {
        let mut places = [Vec3::ZERO; JOINTS];
        for joint in Joint::ALL {
            let i = joint.index();
            let Some(mut track) = self.tracks[i] else { continue };
            let parent = self.anchor(joint);
            let at = parent.map_or(Vec3::ZERO, |p| places[p.index()]);
            let bone = parent.and_then(|p| self.anchor(p)).map_or(Vec3::ZERO, |g| at - places[g.index()]);
            let held = match parent {
                Some(parent) => {
                    // A joint that claims to be seen and is not believed jumped: no hint.
                    let hint = inferred(frame, parent, joint).filter(|_| !frame.joints[i].is_believed());
                    track.hold.held(at, bone, hint, dt)
                }
                None => track.place + self.drift(joint),
            };
            places[i] = if seen[i] {
                let smoothed = track.smooth.output(&self.settings);
                if !track.following {
                    track.hold.resume(held, smoothed);
                }
                smoothed + track.hold.correction()
            } else {
                held
            };
            track.following = seen[i];
            track.place = places[i];
            track.hold.remember(places[i] - at, bone, seen[i], dt);
            self.tracks[i] = Some(track);
        }
        places
    }

    /// How a joint without a parent moves while it is lost: as the first of its own neighbours that is seen.
    fn drift(&self, joint: Joint) -> Vec3 {
        let children = Joint::ALL.into_iter().filter(|j| self.anchor(*j) == Some(joint));
        let moved = |j: Joint| self.tracks[j.index()].map(|t| t.moved);
        children.filter_map(moved).find(|m| *m != Vec3::ZERO).unwrap_or(Vec3::ZERO)
    }

    /// The nearest ancestor ever seen.
    fn anchor(&self, joint: Joint) -> Option<Joint> {
        gate::anchor(joint, |j| self.tracks[j.index()].is_some())
    }

    /// The frame that is handed out: each joint from the nearest ancestor that was ever seen.
    fn joints(&self, frame: &Joints, places: &[Vec3; JOINTS]) -> Joints {
        let mut out = Joints { hands: frame.hands, ..Joints::absent(frame.time_ns) };
        for joint in Joint::ALL {
            let i = joint.index();
            let Some(track) = &self.tracks[i] else { continue };
            // Summed along the chain, not taken from `places`: the last bits differ, and state hashes rest on them.
            let position = match self.anchor(joint) {
                Some(from) => out.at(from).position + (places[i] - places[from.index()]),
                None => places[i],
            };
            out.joints[i] = TrackedJoint { position, confidence: track.hold.trust() };
        }
        out
    }
}

/// The bone between two joints that are both at least inferred (m).
fn inferred(frame: &Joints, from: Joint, to: Joint) -> Option<Vec3> {
    let [a, b] = [from, to].map(|j| frame.at(j));
    let bone = b.position - a.position;
    (a.confidence > 0.0 && b.confidence > 0.0 && bone.is_finite()).then_some(bone)
}

impl Filter for JointFilter {
    fn push(&mut self, frame: &Joints) -> Joints {
        Self::push(self, frame)
    }

    fn reset(&mut self) {
        Self::reset(self);
    }
}

impl JointTrack {
    fn first_seen(at: Vec3) -> Self {
        Self {
            smooth: Holt::start(at),
            hold: Hold::first_seen(),
            believed: at,
            believed_ns: 0,
            following: true,
            place: at,
            moved: Vec3::ZERO,
        }
    }

    fn can_reach(&self, tracked: &TrackedJoint, time_ns: u64) -> bool {
        let seconds = seconds_between(self.believed_ns, time_ns).abs();
        gate::is_plausible_move(self.believed, tracked.position, seconds)
    }

    fn follow(&mut self, measured: Vec3, dt: f32, trust: f32, settings: &HoltSettings) {
        let before = self.smooth.level;
        if self.following {
            self.smooth.update(measured, dt, trust, settings);
            self.moved = self.smooth.level - before;
        } else {
            self.smooth = Holt::start(measured);
            self.moved = Vec3::ZERO;
        }
    }
}

/// The trust of each joint raised to that of its parent and children: were a wrist followed and its hand smoothed, the
/// hand would fall behind the wrist and the short bone between them turn round.
fn shared(trust: &[f32; JOINTS]) -> [f32; JOINTS] {
    let mut out = *trust;
    for joint in Joint::ALL {
        if let Some(parent) = joint.parent() {
            let (i, p) = (joint.index(), parent.index());
            out[i] = out[i].max(trust[p]);
            out[p] = out[p].max(trust[i]);
        }
    }
    out
}
