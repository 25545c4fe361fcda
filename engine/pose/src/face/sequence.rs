//! A sequence of one camera without any other photograph: the head is adapted to all frames together while it is followed.
//!
//! One frame says little about the depth of a face; the same face turned shows it. So the head of the first frame is followed, the frames that
//! show it most differently turned become observations of one field, each by its own pose and expressions, and pose and field are found
//! in turn as with photographs.

use std::slice::from_ref;

use toile_base::body::Sex;

use super::adapt::{AdaptedHead, adapt};
use super::head_mesh::HeadMesh;
use super::prior::{Observation, OffsetField};
use super::sighting::observations;
use super::track::{FEWEST, HeadTracker, TrackedFrame, TrackedState};
use super::unfit::UnfitFace;
use super::view::FaceView;

/// Frames of which one has to show the head well enough to begin with.
const FIRST: usize = 30;

/// Most frames that the head is adapted to, and the least turn between them (rad).
const KEPT: usize = 7;
const APART: f64 = 0.08;

/// Rounds of poses and field in turn.
const ROUNDS: usize = 16;

/// A sequence with its head.
#[derive(Debug, Clone)]
pub struct TrackedSequence {
    /// The head, where it stands in the first frame that shows it.
    pub head: AdaptedHead,
    /// Number of that frame, from 0.
    pub first: usize,
    /// Frames that the head was adapted to.
    pub kept: usize,
    /// What was found in each frame.
    pub frames: Vec<TrackedFrame>,
}

/// Adapts the head of a sex to a sequence, which should begin with a face at rest, and follows it through all frames.
///
/// # Errors
/// One sentence where none of the first frames shows a head.
pub fn follow(frames: &[FaceView], sex: Sex) -> Result<TrackedSequence, UnfitFace> {
    let (first, head) = first_head(frames, sex)?;
    let mut tracker = HeadTracker::new(sex, head.marks.clone());
    let before = tracker.run(head.pose, &frames[first..]);
    let mut kept = most_different(&before);
    let field = (kept.len() > 1).then(|| refined(&mut tracker, &frames[first..], &mut kept));
    let pose = kept.first().map_or(head.pose, |(_, state)| state.pose);
    let first = first + kept.first().map_or(0, |(k, _)| *k);
    let mut head = field.map_or(head, |field| AdaptedHead::of(sex, &HeadMesh::of(sex), &field, pose));
    let frames: Vec<TrackedFrame> = tracker.run(pose, frames).into_iter().map(|(frame, _)| frame).collect();
    (head.residual_px, head.points) = (frames[first].residual_px, frames[first].points);
    Ok(TrackedSequence { head, first, kept: kept.len(), frames })
}

/// The first frame that shows a head, and that head.
fn first_head(frames: &[FaceView], sex: Sex) -> Result<(usize, AdaptedHead), UnfitFace> {
    let mut refused = None;
    let enough = |f: &&FaceView| f.points.iter().flatten().count() >= FEWEST;
    for (first, frame) in frames.iter().enumerate().take(FIRST).filter(|(_, f)| enough(f)) {
        match adapt(from_ref(frame), sex) {
            Ok(head) => return Ok((first, head)),
            Err(error) => refused = refused.or(Some(error)),
        }
    }
    Err(refused.unwrap_or_else(|| {
        let problem = format!("none of the first {} has {FEWEST} points", frames.len().min(FIRST));
        UnfitFace::new("the frames", problem, "begin where the face is seen")
    }))
}

/// The frames whose heads are turned most differently, the first one first.
fn most_different(found: &[(TrackedFrame, TrackedState)]) -> Vec<(usize, TrackedState)> {
    let all: Vec<(usize, TrackedState)> =
        found.iter().enumerate().filter(|(_, (f, _))| f.found.is_some()).map(|(k, (_, state))| (k, *state)).collect();
    let mut kept: Vec<(usize, TrackedState)> = all.first().copied().into_iter().collect();
    while kept.len() < KEPT {
        let apart = |s: &TrackedState| {
            kept.iter().map(|(_, k)| k.pose.turn.angle_between(s.pose.turn)).fold(f64::MAX, f64::min)
        };
        let next = all.iter().map(|s| (apart(&s.1), s)).max_by(|a, b| a.0.total_cmp(&b.0));
        let Some((_, next)) = next.filter(|(apart, _)| *apart > APART) else { break };
        kept.push(*next);
    }
    kept
}

/// Poses of the kept frames and the field of all of them, in turn; the tracker has the points of that field.
fn refined(tracker: &mut HeadTracker, frames: &[FaceView], kept: &mut [(usize, TrackedState)]) -> OffsetField {
    let mut field = OffsetField::default();
    for _ in 0..ROUNDS {
        let mut all: Vec<Observation> = Vec::new();
        for (k, state) in kept.iter_mut() {
            *state = tracker.fitted(&frames[*k], *state);
            let (_, sightings) = tracker.sightings(&frames[*k], *state);
            all.extend(observations(from_ref(&frames[*k]), &sightings, state.pose));
        }
        field = OffsetField::of(&all);
        tracker.marks = tracker.drawn.iter().map(|p| *p + field.at(*p)).collect();
    }
    field
}
