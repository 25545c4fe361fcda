//! Joints between two frames, for a consumer that runs faster (120 Hz) than the sensor (30 Hz).
//!
//! Works on FILTERED joints: interpolating raw ones would draw every outlier out over two frames.

use glam::Vec3;
use toile_base::skeleton::JOINTS;

use toile_base::clock::seconds_between;
use toile_base::frame::{Joints, TrackedJoint};

/// Joints of a filtered track at a time: cubic Hermite with the limited tangents of neighbouring frames (after
/// Catmull and Rom 1974, non-uniform in time), so that velocity is continuous and a gap of several frames is crossed
/// smoothly; clamped at both ends. `None` for an empty track. Frames must be in order of time.
pub fn sample(frames: &[Joints], time_ns: u64) -> Option<Joints> {
    let after = frames.partition_point(|f| f.time_ns <= time_ns);
    if after == 0 || after == frames.len() {
        return frames.get(after.saturating_sub(1)).copied();
    }
    let (a, b) = (&frames[after - 1], &frames[after]);
    let before = if after >= 2 { &frames[after - 2] } else { a };
    let next = frames.get(after + 1).unwrap_or(b);
    Some(hermite([before, a, b, next], time_ns))
}

fn hermite([before, a, b, next]: [&Joints; 4], time_ns: u64) -> Joints {
    let t = fraction(a, b, time_ns);
    let span = seconds_between(a.time_ns, b.time_ns);
    let mut out = Joints { hands: a.hands, ..Joints::absent(time_ns) };
    for i in 0..JOINTS {
        let [o, p, q, r] = [before, a, b, next].map(|f| &f.joints[i]);
        let chord = (q.position - p.position) / span;
        let from = tangent(o, p, seconds_between(before.time_ns, a.time_ns), chord) * span;
        let to = tangent(q, r, seconds_between(b.time_ns, next.time_ns), chord) * span;
        let (t2, t3) = (t * t, t * t * t);
        let position = p.position * (2.0 * t3 - 3.0 * t2 + 1.0)
            + from * (t3 - 2.0 * t2 + t)
            + q.position * (3.0 * t2 - 2.0 * t3)
            + to * (t3 - t2);
        out.joints[i] = mix(p, q, t, position);
    }
    out
}

/// Velocity where two chords meet: their mean, no faster than three times the slower one (a monotone limit after
/// Fritsch and Carlson 1980), so that a rest beside a fast move does not overshoot.
fn tangent(p: &TrackedJoint, q: &TrackedJoint, span: f32, chord: Vec3) -> Vec3 {
    if span <= 0.0 || p.confidence == 0.0 || q.confidence == 0.0 {
        return chord;
    }
    let other = (q.position - p.position) / span;
    let mean = (other + chord) * 0.5;
    mean.clamp_length_max(3.0 * other.length().min(chord.length()))
}

fn fraction(a: &Joints, b: &Joints, time_ns: u64) -> f32 {
    let span = seconds_between(a.time_ns, b.time_ns);
    if span <= 0.0 { 1.0 } else { (seconds_between(a.time_ns, time_ns) / span).clamp(0.0, 1.0) }
}

fn mix(p: &TrackedJoint, q: &TrackedJoint, t: f32, position: Vec3) -> TrackedJoint {
    let position = match (p.confidence > 0.0, q.confidence > 0.0) {
        (true, true) => position,
        (true, false) => p.position,
        (false, true) => q.position,
        (false, false) => return TrackedJoint::default(),
    };
    TrackedJoint { position, confidence: p.confidence + (q.confidence - p.confidence) * t }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn frame(ms: u64, x: f32) -> Joints {
        let mut f = Joints::absent(ms * 1_000_000);
        for j in &mut f.joints {
            *j = TrackedJoint { position: Vec3::new(x, 1.0, 0.0), confidence: 1.0 };
        }
        f
    }

    #[test]
    fn frames_are_reproduced_and_ends_are_clamped() {
        let track = [frame(0, 0.0), frame(33, 0.1), frame(200, 0.9), frame(233, 1.0)];
        for f in &track {
            assert_eq!(sample(&track, f.time_ns).unwrap().joints, f.joints);
        }
        assert_eq!(sample(&track, u64::MAX).unwrap().joints, track[3].joints);
        assert!(sample(&[], 0).is_none());
    }

    #[test]
    fn a_gap_of_167_ms_is_crossed_without_a_jump_or_a_turn_back() {
        let track = [frame(0, 0.0), frame(33, 0.1), frame(200, 0.5), frame(233, 0.6), frame(266, 0.6)];
        let mut last = 0.0;
        for tick in 0..32 {
            let x = sample(&track, toile_base::clock::ticks_to_ns(tick)).unwrap().joints[0].position.x;
            assert!(x >= last - 1e-6 && x - last < 0.04, "tick {tick}: {last} -> {x}");
            last = x;
        }
    }

    #[test]
    fn a_joint_absent_at_one_end_keeps_the_others_place() {
        let mut b = frame(40, 1.0);
        b.joints[0] = TrackedJoint::default();
        let f = sample(&[frame(0, 0.25), b], 10_000_000).unwrap();
        assert_eq!(f.joints[0].position.x, 0.25);
        assert_eq!(f.joints[0].confidence, 0.75);
    }
}
