//! Presence: finds from the sensor's joints whether the person in view is the same or another, seated or standing, and their height
//! and distance from the mark.
//!
//! One skeleton a frame arrives, that of the person whom the sensor follows. Two people are told apart by the lengths of their bones. These
//! are measured anew whenever no person was in view or the skeleton leapt. People of nearly the same size are not told apart: only the
//! presence of the first, or the countdown when they have left, separates them.

use glam::Vec3;
use toile_base::frame::Joints;
use toile_base::numeric::statistics::quantile;
use toile_base::skeleton::Joint;
use toile_fitting::dress::session;

use super::body_turn;

/// What is seen at a moment.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Presence {
    /// People in view.
    pub people: u8,
    /// Who the nearest of them is, by a number that stays theirs; none where that is not decided yet.
    pub who: Option<u32>,
    /// Whether a person stands nearer to the mirror than the shopper does.
    pub nearer: bool,
    /// Whether they sit.
    pub seated: bool,
    /// Height of the head's joint over the floor (mm).
    pub head_mm: Option<f32>,
    /// Where they stand, from the mark (m): to the shopper's own left, and towards the mirror.
    pub off_mark_m: Option<[f32; 2]>,
    /// Where they face, about the vertical (rad): 0 towards the mirror, positive to their own left.
    pub facing: Option<f32>,
    /// Whether depth of them is seen beside their joints.
    pub depth: bool,
}

/// After so long without a person (ns), or a leap, the bones are measured anew.
const GAP_NS: u64 = 400_000_000;

/// The hips move farther than this between two frames only where the sensor follows another person (m): 15 m/s at 30 Hz.
const LEAP_M: f32 = 0.5;

/// Frames from which a person's bones are known.
const FRAMES: usize = 12;

/// Bones differ by more than this share between two people, taken together. A sensor's own scatter over a dozen frames is a
/// third of it; women and men differ by five percent among themselves.
const DIFFERENT: f32 = 0.06;

/// Frames over which seated or standing is decided: most of them must agree.
const SITTING: usize = 16;

/// A thigh that falls less than this share of its length from hip to knee is that of a person who sits: 30 degrees from level.
const LEVEL: f32 = 0.5;

/// Bones by whose lengths people are told apart.
const BONES: [&[Joint]; 5] = {
    use Joint::*;
    [
        &[Pelvis, Spine, Chest, Neck],
        &[LeftShoulder, RightShoulder],
        &[LeftShoulder, LeftElbow, LeftWrist],
        &[RightShoulder, RightElbow, RightWrist],
        &[LeftHip, LeftKnee, LeftAnkle],
    ]
};

type BoneLengths = [Option<f32>; BONES.len()];

/// Takes frames as they come.
#[derive(Debug, Clone, Default)]
pub struct PresenceTracker {
    /// Where the mark is on the floor (m), if that is known.
    mark: Option<[f32; 2]>,
    /// Who is there, with the bones by which they are known, as long as it is decided.
    who: Option<u32>,
    known: Option<(u32, BoneLengths)>,
    last: Option<(u64, Vec3)>,
    /// Bones of the frames since the person came.
    frames: Vec<BoneLengths>,
    /// Frames in which they sat, of the last ones: positive is seated.
    sitting: i32,
    seated: bool,
    count: u32,
}

impl PresenceTracker {
    /// With the mark's place on the floor (x, z in the sensor's world, m), if that is known.
    pub fn new(mark: Option<[f32; 2]>) -> Self {
        Self { mark, ..Self::default() }
    }

    /// Forgets the known bones; the next person is new.
    pub fn forget(&mut self) {
        *self = Self { mark: self.mark, count: self.count, ..Self::default() };
    }

    /// Takes a frame.
    pub fn push(&mut self, frame: &Joints) -> Presence {
        let Some(hips) = frame.believed(Joint::Pelvis).filter(|_| session::is_present(frame)) else {
            return Presence::default();
        };
        let leapt = self
            .last
            .is_none_or(|(then, at)| frame.time_ns.saturating_sub(then) > GAP_NS || at.distance(hips) > LEAP_M);
        if leapt {
            (self.who, self.sitting) = (None, 0);
            self.frames.clear();
        }
        self.last = Some((frame.time_ns, hips));
        self.identify(frame);
        self.sit(frame);
        Presence {
            people: 1,
            who: self.who,
            nearer: false,
            seated: self.seated,
            head_mm: frame.believed(Joint::Head).map(|p| p.y * 1e3),
            off_mark_m: self.mark.map(|[x, z]| [hips.x - x, hips.z - z]),
            facing: body_turn::facing(frame),
            depth: false,
        }
    }

    /// Decides who it is, once enough frames were seen since they came.
    fn identify(&mut self, frame: &Joints) {
        if self.who.is_some() {
            return;
        }
        self.frames.push(lengths(frame));
        if self.frames.len() < FRAMES {
            return;
        }
        let bones: BoneLengths = std::array::from_fn(|b| self.middle_length(b));
        let same = self.known.as_ref().filter(|known| differ(&known.1, &bones) <= DIFFERENT);
        if same.is_none() {
            self.count += 1;
            self.known = Some((self.count, bones));
        }
        self.who = self.known.as_ref().map(|known| known.0);
        self.frames.clear();
    }

    /// The middle one of the lengths that the frames so far have of a bone.
    fn middle_length(&self, bone: usize) -> Option<f32> {
        let mut lengths = [0.0; FRAMES];
        let known = self.frames.iter().filter_map(|f| f[bone]);
        let count = lengths.iter_mut().zip(known).map(|(to, length)| *to = length).count();
        quantile(&mut lengths[..count], 0.5)
    }

    fn sit(&mut self, frame: &Joints) {
        use Joint::*;
        let level = |hip, knee| {
            let (hip, knee) = (frame.believed(hip)?, frame.believed(knee)?);
            Some(hip.y - knee.y < LEVEL * hip.distance(knee))
        };
        let legs = [level(LeftHip, LeftKnee), level(RightHip, RightKnee)];
        // One thigh that is level may be a raised knee.
        let Some(sits) = legs[0].zip(legs[1]).map(|(l, r)| l && r) else { return };
        let most = SITTING as i32 / 2;
        self.sitting = (self.sitting + if sits { 1 } else { -1 }).clamp(-most, most);
        if self.sitting.abs() == most {
            self.seated = self.sitting > 0;
        }
    }
}

fn lengths(frame: &Joints) -> BoneLengths {
    BONES.map(|path| {
        let length = |pair: &[Joint]| Some(frame.believed(pair[0])?.distance(frame.believed(pair[1])?));
        path.windows(2).map(length).sum()
    })
}

/// The root mean square of the shares by which bones differ; nothing where none is known of both.
fn differ(a: &BoneLengths, b: &BoneLengths) -> f32 {
    let shares =
        a.iter().zip(b).filter_map(|(a, b)| Some(2.0 * (a.as_ref()? - b.as_ref()?) / (a.as_ref()? + b.as_ref()?)));
    let (sum, count) = shares.fold((0.0, 0), |(sum, count), s| (sum + s * s, count + 1));
    if count == 0 { 0.0 } else { (sum / count as f32).sqrt() }
}

#[cfg(test)]
mod tests {
    use super::*;

    const FRAME_NS: u64 = 33_333_333;

    /// A person of the embedded session, so much larger, moved aside, at a time.
    fn frames(scale: f32, aside: f32, from_ns: u64) -> Vec<Joints> {
        let track = session::filtered(&session::open(None, None).unwrap());
        let begin = session::first_standing(&track);
        let moved = |(i, f): (u64, &Joints)| {
            let mut frame = Joints { time_ns: from_ns + i * FRAME_NS, ..*f };
            frame.joints.iter_mut().for_each(|j| j.position = j.position * scale + Vec3::X * aside);
            frame
        };
        (0..).zip(&track[begin..begin + 60]).map(moved).collect()
    }

    fn last(watcher: &mut PresenceTracker, frames: &[Joints]) -> Presence {
        frames.iter().map(|f| watcher.push(f)).last().unwrap()
    }

    #[test]
    fn who_comes_back_is_the_same_and_who_is_of_another_size_is_not() {
        let mut watcher = PresenceTracker::new(None);
        let first = last(&mut watcher, &frames(1.0, 0.0, 0)).who;
        assert!(first.is_some());
        let away = 10_000_000_000;
        assert_eq!(watcher.push(&frames(1.0, 0.0, away)[0]).who, None, "not at the first look");
        assert_eq!(last(&mut watcher, &frames(1.0, 0.1, away)).who, first);
        let other = last(&mut watcher, &frames(1.12, 0.0, 2 * away)).who;
        assert!(other.is_some() && other != first);
        // A leap without a gap: the sensor follows another person.
        let third = last(&mut watcher, &frames(0.9, 1.5, 2 * away + 60 * FRAME_NS)).who;
        assert!(third.is_some() && third != other && third != first);
    }

    #[test]
    fn after_forgetting_every_person_is_new() {
        let mut watcher = PresenceTracker::new(None);
        let first = last(&mut watcher, &frames(1.0, 0.0, 0)).who;
        watcher.forget();
        assert_ne!(last(&mut watcher, &frames(1.0, 0.0, 10_000_000_000)).who, first);
        assert!(!format!("{watcher:?}").contains("NaN"));
    }

    #[test]
    fn who_sits_is_told_from_who_stands_and_the_head_is_as_high_as_it_is() {
        let mut watcher = PresenceTracker::new(Some([0.0, 0.0]));
        let standing = last(&mut watcher, &frames(1.0, 0.0, 0));
        assert!(!standing.seated && (1_300.0..1_750.0).contains(&standing.head_mm.unwrap()), "{standing:?}");
        let mut sitting = frames(1.0, 0.0, 2_100_000_000);
        for frame in &mut sitting {
            for (hip, knee) in [(Joint::LeftHip, Joint::LeftKnee), (Joint::RightHip, Joint::RightKnee)] {
                let at = frame.at(hip).position;
                let thigh = at.distance(frame.at(knee).position);
                frame.at_mut(knee).position = at + Vec3::Z * thigh;
            }
        }
        let seated = last(&mut watcher, &sitting);
        assert!(seated.seated && seated.off_mark_m.is_some());
        assert_eq!(watcher.push(&Joints::absent(99_000_000_000)), Presence::default());
    }
}
