//! Checks a frame: whole or half, new or repeated, of a running clock or of one that jumped, of a room or of a hand on the
//! lens; and follows the state of the camera from frame to frame.

use super::device_clock::DeviceClock;
use super::live_camera::CameraFrame;
use toile_base::clock::SECOND_NS;

/// Nothing good for so long is a lost camera (ns): two frames of 15 Hz and one that was lost among them.
pub const LOST_NS: u64 = 150_000_000;

/// Share of an image's pixels that measure something; fewer are those of a covered lens. A person at 4 m before nothing at all has 4 %.
const SEES: f32 = 0.005;

/// Frames in a row with fewer from which on the lens counts as covered: one may be a hiccup.
const COVERED_FRAMES: u32 = 3;

/// Frames that come so much later than the rate has them come after one that was lost (1).
const LATE: f64 = 1.5;

toile_base::named! {
    /// How a camera stands.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
    #[repr(u8)]
    pub enum CameraState {
        /// No frame has come yet.
        Starting = "starting",
        /// It sees.
        Seeing = "seeing",
        /// Something covers its lens: frames come, and hold nothing.
        Covered = "covered",
        /// The same frame comes again and again.
        Frozen = "frozen",
        /// Nothing comes.
        Lost = "lost",
    }
}

/// Verdict on one frame.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FrameVerdict {
    /// Good, and taken at this time on the loop's clock (ns).
    Good(u64),
    /// Cut short, or of another size.
    Half,
    /// The same image as before, to the bit. A camera's noise never is.
    Repeated,
    /// Good, but of a lens that is covered; taken at this time (ns).
    Empty(u64),
}

/// Counts of a camera's frames.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct CameraCounts {
    /// Frames that came.
    pub frames: u64,
    /// Frames that did not come, by the stamps of those that did.
    pub missing: u64,
    /// Cut short.
    pub half: u64,
    /// The same again.
    pub repeated: u64,
    /// Of a covered lens.
    pub empty: u64,
    /// Jumps of the device's clock.
    pub clock_jumps: u64,
    /// Times that the camera was lost, frozen or covered.
    pub lost: u64,
    /// Times that it was opened anew.
    pub reopened: u64,
}

/// Judges one camera's frames.
#[derive(Debug)]
pub struct FrameCheck {
    pixels: usize,
    period_ns: u64,
    clock: DeviceClock,
    /// The last whole image `[pixels]`.
    last: Vec<u16>,
    last_stamp: Option<u64>,
    /// When a good frame last arrived, and when any did (ns).
    good_ns: Option<u64>,
    repeated_ns: Option<u64>,
    covered: u32,
    state: CameraState,
    /// The counts.
    pub counts: CameraCounts,
}

impl FrameCheck {
    /// For images of so many pixels at so many a second (Hz). Called at load: it allocates.
    pub fn new(pixels: usize, rate_hz: f32) -> Self {
        Self {
            pixels,
            period_ns: (SECOND_NS as f32 / rate_hz.clamp(1.0, 1_000.0)) as u64,
            clock: DeviceClock::default(),
            last: Vec::with_capacity(pixels),
            last_stamp: None,
            good_ns: None,
            repeated_ns: None,
            covered: 0,
            state: CameraState::Starting,
            counts: CameraCounts::default(),
        }
    }

    /// How the camera stands.
    pub fn state(&self) -> CameraState {
        self.state
    }

    /// The camera was opened anew: its clock may have begun anew, and its last image says nothing.
    pub fn reopened(&mut self) {
        self.counts.reopened += 1;
        self.clock.restart();
        self.last.clear();
        self.last_stamp = None;
    }

    /// Judges a frame that arrived at this time on the loop's clock (ns).
    pub fn judge(&mut self, frame: &CameraFrame, arrived_ns: u64) -> FrameVerdict {
        self.counts.frames += 1;
        if frame.depth.len() != self.pixels {
            self.counts.half += 1;
            return FrameVerdict::Half;
        }
        let measured = frame.depth.iter().filter(|d| **d != 0).count();
        let empty = (measured as f32) < SEES * self.pixels as f32;
        // Two images of nothing are the same, and no sign of a frozen camera.
        if !empty && self.last == frame.depth {
            self.counts.repeated += 1;
            self.repeated_ns = Some(arrived_ns);
            return FrameVerdict::Repeated;
        }
        self.last.clone_from(&frame.depth);
        let stamp = self.clock.stamp(frame.device_ns, arrived_ns);
        self.counts.clock_jumps = self.clock.jumps;
        self.count_missing(stamp);
        if empty {
            self.counts.empty += 1;
            self.covered += 1;
            self.good_ns = self.good_ns.or(Some(arrived_ns));
            self.turn(if self.covered >= COVERED_FRAMES { CameraState::Covered } else { self.state });
            return FrameVerdict::Empty(stamp);
        }
        (self.covered, self.good_ns) = (0, Some(arrived_ns));
        self.turn(CameraState::Seeing);
        FrameVerdict::Good(stamp)
    }

    /// Looks at the clock (ns): a camera that has not given anything good for 150 ms is lost, or frozen where the same frame comes.
    pub fn look(&mut self, now_ns: u64) -> CameraState {
        let silent = |since: Option<u64>| since.is_none_or(|then| now_ns.saturating_sub(then) > LOST_NS);
        let covered = self.state == CameraState::Covered && self.last_stamp.is_some_and(|then| !silent(Some(then)));
        if self.good_ns.is_some() && silent(self.good_ns) && !covered {
            let frozen = !silent(self.repeated_ns);
            self.turn(if frozen { CameraState::Frozen } else { CameraState::Lost });
        }
        self.state
    }

    /// Frames that did not come between the last stamp and this one.
    fn count_missing(&mut self, stamp: u64) {
        let gap = self.last_stamp.map_or(0, |then| stamp.saturating_sub(then));
        // What is missing while the camera is lost is that one loss.
        if gap as f64 > LATE * self.period_ns as f64 && gap < LOST_NS.max(4 * self.period_ns) {
            self.counts.missing += (gap + self.period_ns / 2) / self.period_ns - 1;
        }
        self.last_stamp = Some(stamp);
    }

    fn turn(&mut self, to: CameraState) {
        let was_well = self.state <= CameraState::Seeing;
        self.counts.lost += u64::from(was_well && to > CameraState::Seeing);
        self.state = to;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const MS: u64 = 1_000_000;
    const FRAME_MS: u64 = 33;

    fn frame(i: u64) -> CameraFrame {
        let depth = (0..400).map(|p| 1_000 + (p * 7 + i as u16 * 13) % 251).collect();
        CameraFrame { device_ns: i * FRAME_MS * MS, depth, ..CameraFrame::default() }
    }

    /// Shows frames one after the other, each of its kind: g good, h half, r repeated, e empty, - none; gives the state after each.
    fn states(kinds: &str) -> (Vec<CameraState>, CameraCounts) {
        let mut check = FrameCheck::new(400, 30.0);
        let mut last = frame(0);
        let mut states = Vec::new();
        for (i, kind) in (0..).zip(kinds.chars()) {
            let now = i * FRAME_MS * MS;
            let next = match kind {
                'g' => Some(frame(i)),
                'h' => Some(CameraFrame { depth: vec![7; 200], ..frame(i) }),
                'r' => Some(CameraFrame { device_ns: now, ..last.clone() }),
                'e' => Some(CameraFrame { depth: vec![0; 400], ..frame(i) }),
                _ => None,
            };
            if let Some(next) = next {
                check.judge(&next, now);
                last = next;
            }
            states.push(check.look(now));
        }
        (states, check.counts)
    }

    use CameraState::{Covered, Frozen, Lost, Seeing, Starting};

    #[test]
    fn a_camera_is_lost_within_a_fifth_of_a_second_and_back_with_its_first_frame() {
        let (found, counts) = states("-gg------g");
        assert_eq!(found, [Starting, Seeing, Seeing, Seeing, Seeing, Seeing, Seeing, Lost, Lost, Seeing]);
        assert_eq!((counts.lost, counts.frames), (1, 3));
    }

    #[test]
    fn the_same_frame_again_is_a_frozen_camera_and_no_news() {
        let (found, counts) = states("grrrrrrg");
        assert_eq!(&found[5..], [Frozen, Frozen, Seeing]);
        assert_eq!((counts.repeated, counts.lost), (6, 1));
        assert_eq!(states("grgrgrgrg").0[8], Seeing, "15 Hz, each frame twice");
    }

    #[test]
    fn a_hand_on_the_lens_is_told_from_a_lost_camera() {
        let (found, counts) = states("geeeeeeeeg");
        assert_eq!(found, [Seeing, Seeing, Seeing, Covered, Covered, Covered, Covered, Covered, Covered, Seeing]);
        assert_eq!((counts.empty, counts.lost), (8, 1));
        assert_eq!(*states("geee------").0.last().unwrap(), Lost);
    }

    #[test]
    fn half_frames_are_nothing_and_frames_that_do_not_come_are_counted() {
        let (found, counts) = states("ghhhhhhg");
        assert_eq!((found[4], found[5], found[7], counts.half), (Seeing, Lost, Seeing, 6));
        let (found, counts) = states("ggg-gg-ggg");
        assert!(found.iter().all(|s| *s == Seeing));
        assert_eq!((counts.missing, counts.lost), (2, 0));
    }

    #[test]
    fn a_camera_of_fifteen_frames_a_second_that_loses_some_is_not_lost() {
        assert!(states("g-g-g---g-g-g").0.iter().all(|s| *s == Seeing));
    }
}
