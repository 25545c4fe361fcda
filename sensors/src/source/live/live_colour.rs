//! A camera of colour alone, as the loop wants it: pictures with stamps of the loop's clock, and how the camera stands. One that is gone is
//! opened again.

use std::time::Duration;

use super::error::CameraError;
use super::frame_check::{CameraCounts, CameraState, FrameCheck, FrameVerdict};
use super::live_camera::{Arrival, CameraFrame, CameraInfo, ColourImage, LiveCamera};
use super::live_depth::{CameraOpener, RETRY_NS, SILENT_NS};

/// Places of a picture that are compared from one to the next, across and down: a camera's noise is seen in any of them.
const PLACES: [usize; 2] = [64, 48];

/// Brightness below which a place is black: a covered lens has nothing above it (of 255).
const BLACK: u16 = 24;

/// Result of a look at the camera.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct ColourUpdate {
    /// How the camera stands.
    pub state: CameraState,
    /// When the new picture was taken, on the loop's clock (ns); none where there is no new one.
    pub taken_ns: Option<u64>,
    /// When a picture arrived, good or not (ns).
    pub arrived_ns: Option<u64>,
    /// Whether there is no camera to wait for, so that the caller should wait.
    pub is_closed: bool,
}

/// A camera of colour, checked.
pub struct LiveColour {
    opener: CameraOpener,
    camera: Option<Box<dyn LiveCamera>>,
    info: CameraInfo,
    check: FrameCheck,
    raw: CameraFrame,
    /// The compared picture, in the place of depth.
    sampled: CameraFrame,
    /// When it was last tried to open, and when something last came (ns).
    tried_ns: u64,
    heard_ns: u64,
}

impl LiveColour {
    /// Opens the camera for the first time. Called at load: it allocates.
    ///
    /// # Errors
    /// Those of the opener.
    pub fn open(mut opener: CameraOpener, now_ns: u64) -> Result<Self, CameraError> {
        let camera = opener()?;
        let info = camera.info().clone();
        Ok(Self {
            opener,
            camera: Some(camera),
            check: FrameCheck::new(PLACES[0] * PLACES[1], info.rate_hz),
            info,
            raw: CameraFrame::default(),
            sampled: CameraFrame::default(),
            tried_ns: now_ns,
            heard_ns: now_ns,
        })
    }

    /// Properties of the camera.
    pub fn info(&self) -> &CameraInfo {
        &self.info
    }

    /// Counts of its frames.
    pub fn counts(&self) -> CameraCounts {
        self.check.counts
    }

    /// The picture that came last.
    pub fn picture(&self) -> &ColourImage {
        &self.raw.colour
    }

    /// Blackens the last picture after the person in it has left.
    pub fn wipe(&mut self) {
        self.raw.colour.rgb.fill(0);
        self.sampled.depth.fill(0);
    }

    /// Waits for the next picture, for about so long; `now_ns` is the loop's clock.
    pub fn poll(&mut self, now_ns: &dyn Fn() -> u64, patience: Duration) -> ColourUpdate {
        self.reopen(now_ns());
        let arrival = match &mut self.camera {
            Some(camera) => camera.read(&mut self.raw, patience),
            None => Ok(Arrival::Nothing),
        };
        let now = now_ns();
        let (mut taken_ns, mut arrived_ns) = (None, None);
        match arrival {
            Ok(Arrival::Frame) => {
                (self.heard_ns, arrived_ns) = (now, Some(now));
                taken_ns = self.judge(now);
            }
            Ok(Arrival::Nothing) if now.saturating_sub(self.heard_ns) < SILENT_NS => {}
            Ok(Arrival::Nothing | Arrival::Ended) | Err(_) => {
                if self.camera.take().is_some() {
                    self.tried_ns = now;
                }
            }
        }
        ColourUpdate { state: self.check.look(now), taken_ns, arrived_ns, is_closed: self.camera.is_none() }
    }

    /// Opens a camera that is gone, every so often. It may come back with another size.
    fn reopen(&mut self, now: u64) {
        if self.camera.is_some() || now.saturating_sub(self.tried_ns) < RETRY_NS {
            return;
        }
        (self.tried_ns, self.heard_ns) = (now, now);
        let Ok(camera) = (self.opener)() else { return };
        self.info = camera.info().clone();
        self.camera = Some(camera);
        self.check.reopened();
    }

    /// When the picture was taken, where it is good.
    fn judge(&mut self, now: u64) -> Option<u64> {
        let Self { raw, sampled, .. } = self;
        sampled.device_ns = raw.device_ns;
        sample(&raw.colour, &mut sampled.depth);
        match self.check.judge(&self.sampled, now) {
            FrameVerdict::Good(time_ns) => Some(time_ns),
            FrameVerdict::Half | FrameVerdict::Repeated | FrameVerdict::Empty(_) => None,
        }
    }
}

/// Brightness of some places of a picture, 0 where it is black; empty of a picture of no size.
fn sample(picture: &ColourImage, out: &mut Vec<u16>) {
    out.clear();
    let (width, height) = (picture.width as usize, picture.height as usize);
    if width == 0 || height == 0 || picture.rgb.len() != 3 * width * height {
        return;
    }
    let [across, down] = PLACES;
    for y in 0..down {
        let row = (2 * y + 1) * height / (2 * down) * width;
        out.extend((0..across).map(|x| {
            let at = 3 * (row + (2 * x + 1) * width / (2 * across));
            let light: u16 = picture.rgb[at..at + 3].iter().map(|c| u16::from(*c)).sum();
            if light < 3 * BLACK { 0 } else { light }
        }));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::Arc;
    use std::sync::atomic::{AtomicU64, Ordering::Relaxed};

    const MS: u64 = 1_000_000;

    /// Pictures of these sizes and brightness, one every 33 ms; 0 wide is a broken one; at the end the camera is gone.
    struct Played(Vec<(u32, u8)>, usize, CameraInfo);

    impl LiveCamera for Played {
        fn info(&self) -> &CameraInfo {
            &self.2
        }

        fn read(&mut self, frame: &mut CameraFrame, _: Duration) -> Result<Arrival, CameraError> {
            frame.clear();
            let Some(&(width, light)) = self.0.get(self.1) else { return Ok(Arrival::Ended) };
            self.1 += 1;
            frame.device_ns = self.1 as u64 * 33 * MS;
            let rgb = vec![light; 3 * (width * width) as usize];
            frame.colour = ColourImage { width, height: width, rgb };
            Ok(Arrival::Frame)
        }
    }

    fn looked(pictures: &[(u32, u8)], looks: usize) -> (Vec<(bool, u32, CameraState)>, CameraCounts) {
        let pictures = pictures.to_vec();
        let info = CameraInfo::webcam("played".to_owned(), [64, 64], 30.0);
        let opener = Box::new(move || Ok(Box::new(Played(pictures.clone(), 0, info.clone())) as Box<dyn LiveCamera>));
        let mut colour = LiveColour::open(opener, 0).unwrap();
        let clock = Arc::new(AtomicU64::new(0));
        let shared = clock.clone();
        let now = move || shared.load(Relaxed);
        let mut all = Vec::new();
        for _ in 0..looks {
            clock.fetch_add(33 * MS, Relaxed);
            let update = colour.poll(&now, Duration::ZERO);
            all.push((update.taken_ns.is_some(), colour.picture().width, update.state));
        }
        (all, colour.counts())
    }

    #[test]
    fn broken_repeated_and_black_pictures_are_not_looked_at_and_another_size_is() {
        let pictures = [(64, 100), (64, 101), (64, 101), (0, 0), (96, 120), (64, 0), (64, 1), (64, 2), (64, 3)];
        let (all, counts) = looked(&pictures, 9);
        let good: Vec<bool> = all.iter().map(|(good, ..)| *good).collect();
        assert_eq!(good, [true, true, false, false, true, false, false, false, false]);
        assert_eq!((counts.half, counts.repeated, counts.empty), (1, 1, 4));
        assert_eq!((all[4].1, all[4].2, all[8].2), (96, CameraState::Seeing, CameraState::Covered));
    }

    #[test]
    fn a_camera_that_is_gone_is_lost_and_opened_again() {
        let pictures: Vec<(u32, u8)> = (0..5).map(|i| (64, 100 + i)).collect();
        let (all, counts) = looked(&pictures, 20);
        assert!(all.iter().any(|(.., state)| *state == CameraState::Lost), "{all:?}");
        assert!(counts.reopened >= 1 && counts.frames > 5, "{counts:?}");
    }
}
