//! Handle of a live camera for other threads: figures, frames gathered of the measured person, the last colour image.

use std::sync::atomic::Ordering::Relaxed;
use std::sync::atomic::{AtomicBool, AtomicU8, AtomicU64};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use toile_base::body::Sex;
use toile_base::frame::{DepthFrame, Joints};
use toile_sensors::source::Session;
use toile_sensors::source::live::{CameraCounts, CameraState, ColourImage};
use toile_track::fit::measuring::FRAMES;

use crate::dress::depth::{APART_NS, TURN_NS};
use crate::dress::session;

/// Most frames that are kept of a turn: one in each [`APART_NS`] of the longest that is looked at.
const TURN_FRAMES: usize = (TURN_NS / APART_NS) as usize;

/// Depth images that a measurement holds at most: the first second at full rate, and a turn.
pub const GATHERED: usize = FRAMES + TURN_FRAMES;

/// Figures of the camera and of who is seen through it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct CameraFigures {
    /// How the camera stands.
    pub state: CameraState,
    /// What was counted of its frames.
    pub counts: CameraCounts,
    /// Frames in which a person was looked for, and in which a person was found.
    pub tracked: [u64; 2],
    /// Colour images that came.
    pub colours: u64,
}

/// Numbers that the threads count up, to be looked at by others.
///
/// Relaxed throughout: each stands by itself and orders nothing.
#[derive(Debug, Default)]
struct SharedFigures {
    state: AtomicU8,
    counts: [AtomicU64; 8],
    tracked: [AtomicU64; 2],
    colours: AtomicU64,
    /// The body model that is asked for: 0 female, 1 male.
    sex: AtomicU8,
    /// Whether images that no thread holds are to be wiped.
    wipe: AtomicBool,
    stop: AtomicBool,
}

/// What is gathered for measuring.
#[derive(Debug)]
struct Gathered {
    /// Whether a person is measured.
    wanted: bool,
    frames: Vec<Arc<DepthFrame>>,
    /// Joints, of a camera without depth.
    joints: Vec<Joints>,
    next_ns: u64,
}

/// What others know of the camera, and ask of it.
#[derive(Debug, Clone)]
pub struct CameraHandle {
    figures: Arc<SharedFigures>,
    gathered: Arc<Mutex<Gathered>>,
    /// The last colour image, where colour is asked for.
    colour: Arc<Mutex<ColourImage>>,
    /// What was assumed of the camera.
    notes: Arc<Mutex<Vec<String>>>,
}

impl CameraHandle {
    /// With nothing counted yet.
    pub(super) fn new() -> Self {
        let (frames, joints) = (Vec::with_capacity(GATHERED), Vec::with_capacity(FRAMES));
        let gathered = Gathered { wanted: false, frames, joints, next_ns: 0 };
        Self {
            figures: Arc::default(),
            gathered: Arc::new(Mutex::new(gathered)),
            colour: Arc::default(),
            notes: Arc::default(),
        }
    }

    /// How the camera stands, and what was counted.
    pub fn figures(&self) -> CameraFigures {
        let shared = &self.figures;
        let [frames, missing, half, repeated, empty, clock_jumps, lost, reopened] =
            shared.counts.each_ref().map(|n| n.load(Relaxed));
        let counts = CameraCounts { frames, missing, half, repeated, empty, clock_jumps, lost, reopened };
        let state = CameraState::ALL[usize::from(shared.state.load(Relaxed)).min(CameraState::ALL.len() - 1)];
        CameraFigures {
            state,
            counts,
            tracked: shared.tracked.each_ref().map(|n| n.load(Relaxed)),
            colours: shared.colours.load(Relaxed),
        }
    }

    /// Begins to measure a person: from now on a second is gathered at full rate, and then a turn.
    pub fn gather_anew(&self) {
        let mut gathered = self.lock();
        gathered.frames.clear();
        gathered.joints.clear();
        (gathered.wanted, gathered.next_ns) = (true, 0);
    }

    /// The shopper has left: what was gathered is thrown away, and the camera's images are wiped. A body of this sex is fitted to the
    /// next person.
    pub fn forget(&self, sex: Sex) {
        let mut gathered = self.lock();
        gathered.frames.clear();
        gathered.joints.clear();
        gathered.wanted = false;
        drop(gathered);
        self.figures.wipe.store(true, Relaxed);
        self.follow(sex);
    }

    /// The gathered frames as a session: depth, or, of a camera without depth, joints of unknown scale.
    pub fn session(&self) -> Session {
        let joints = self.lock().joints.clone();
        if joints.is_empty() { session::of_depth(self.gathered()) } else { session::of_directions(joints) }
    }

    /// Copies of the frames that were gathered.
    pub fn gathered(&self) -> Vec<DepthFrame> {
        // The images themselves are copied without the lock.
        let frames: Vec<Arc<DepthFrame>> = self.lock().frames.clone();
        frames.iter().map(|frame| (**frame).clone()).collect()
    }

    /// The last colour image; of no size where none came.
    pub fn colour(&self) -> ColourImage {
        self.colour.lock().unwrap_or_else(PoisonError::into_inner).clone()
    }

    /// Keeps the last colour image.
    pub(super) fn set_colour(&self, image: &ColourImage) {
        if image.width > 0 {
            self.figures.colours.fetch_add(1, Relaxed);
            self.colour.lock().unwrap_or_else(PoisonError::into_inner).clone_from(image);
        }
    }

    /// What was assumed of the camera so far, one sentence each.
    pub fn notes(&self) -> Vec<String> {
        self.notes.lock().unwrap_or_else(PoisonError::into_inner).clone()
    }

    /// Keeps what was assumed.
    pub(super) fn set_notes(&self, notes: &[String]) {
        let mut known = self.notes.lock().unwrap_or_else(PoisonError::into_inner);
        if *known != notes {
            known.clone_from(&notes.to_vec());
        }
    }

    /// From now on a body of this sex is fitted.
    pub fn follow(&self, sex: Sex) {
        self.figures.sex.store(u8::from(sex == Sex::Male), Relaxed);
    }

    fn lock(&self) -> MutexGuard<'_, Gathered> {
        self.gathered.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Keeps how the camera stands, and what was counted.
    pub(super) fn publish(&self, state: CameraState, counts: CameraCounts) {
        let CameraCounts { frames, missing, half, repeated, empty, clock_jumps, lost, reopened } = counts;
        let numbers = [frames, missing, half, repeated, empty, clock_jumps, lost, reopened];
        self.figures.counts.iter().zip(numbers).for_each(|(to, n)| to.store(n, Relaxed));
        self.figures.state.store(state as u8, Relaxed);
    }

    /// Takes a frame of the measured person: the first second whole, then what a turn needs.
    pub(super) fn gather(&self, frame: &Arc<DepthFrame>) {
        let mut gathered = self.lock();
        let (count, time_ns) = (gathered.frames.len(), frame.time_ns);
        if !gathered.wanted || count >= GATHERED || time_ns < gathered.next_ns {
            return;
        }
        gathered.frames.push(frame.clone());
        if count + 1 >= FRAMES {
            gathered.next_ns = time_ns + APART_NS;
        }
    }

    /// Takes joints of the measured person: a second of them.
    pub(super) fn gather_joints(&self, joints: &Joints) {
        let mut gathered = self.lock();
        if gathered.wanted && gathered.joints.len() < FRAMES {
            gathered.joints.push(*joints);
        }
    }

    /// Counts a frame that was looked at, and whether a person was found in it.
    pub(super) fn count_tracked(&self, found: bool) {
        let [looked, some] = &self.figures.tracked;
        looked.fetch_add(1, Relaxed);
        some.fetch_add(u64::from(found), Relaxed);
    }

    /// Whether what was kept of a shopper is to be wiped, once.
    pub(super) fn takes_wipe(&self) -> bool {
        let wipes = self.figures.wipe.swap(false, Relaxed);
        if wipes {
            self.colour.lock().unwrap_or_else(PoisonError::into_inner).rgb.fill(0);
        }
        wipes
    }

    /// The body model that is asked for.
    pub(super) fn sex(&self) -> Sex {
        if self.figures.sex.load(Relaxed) == 1 { Sex::Male } else { Sex::Female }
    }

    /// Asks the threads to end.
    pub(super) fn stop(&self) {
        self.figures.stop.store(true, Relaxed);
    }

    /// Whether they are to end.
    pub(super) fn is_over(&self) -> bool {
        self.figures.stop.load(Relaxed)
    }
}
