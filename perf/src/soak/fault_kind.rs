//! Kinds of faults of a soak, and the sign by which each is over.

use toile_base::numeric::random::SplitMix64;
use toile_sensors::source::live::fault_injection::CameraFault;

use super::options::SoakCamera;

/// Length of a fault (s), where it has one and is not a stall.
const FAULT_S: [f32; 2] = [0.5, 3.0];

/// Length of a stall (s).
const STALL_S: f32 = 2.0;

toile_base::named! {
    /// What goes wrong. `until` is the end of the fault: from then on the time to its recovery counts.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
    pub enum FaultKind {
        /// No frames come.
        CameraLost = "camera lost",
        /// The joints of the first frame again and again, with new stamps.
        Frozen = "frames frozen",
        /// Each frame four times, stamp and all.
        Repeated = "frames repeated",
        /// Every two frames change places.
        OutOfOrder = "frames out of order",
        /// Half of the joints are NaN, and sure of it.
        NanJoints = "NaN joints",
        /// Half of the joints are infinite or beyond all measure.
        Infinite = "infinite joints",
        /// The skeleton of another person, who stands beside.
        Swapped = "another's skeleton",
        /// Stamps from the next day.
        StampsAhead = "stamps a day ahead",
        /// Stamps from the day before.
        StampsBehind = "stamps a day behind",
        /// Particles of every garment that are NaN, infinite, beyond all measure or violent, from one step to the next.
        ClothSpoilt = "cloth spoilt",
        /// The loop's clock jumps ahead, as after a suspended machine.
        ClockJump = "clock jump",
        /// The sensor's thread does nothing for two seconds.
        SensorStall = "sensor stall",
        /// The physics thread does nothing for two seconds.
        PhysicsStall = "physics stall",
        /// The render thread does nothing for two seconds.
        RenderStall = "render stall",
        /// The thread that records does nothing for two seconds.
        RecorderStall = "recorder stall",
        /// The thread that makes scenes does nothing for two seconds.
        SceneStall = "scene thread stall",
        /// The recording's disk is full.
        DiskFull = "disk full",
        /// Garment files that are broken in several ways are to be worn.
        BrokenGarment = "broken garment file",
        /// The render thread panics.
        RenderPanic = "render thread dies",
        /// 64 MiB are taken and written to.
        MemoryPressure = "memory pressure",
        /// The depth camera is unplugged: every call fails, and it cannot be opened.
        Unplugged = "camera unplugged",
        /// Nothing comes of the depth camera, and nothing is said.
        Silent = "camera silent",
        /// The same depth image again and again, with new stamps.
        DepthFrozen = "depth images frozen",
        /// The depth camera's clock is an hour behind, then right again.
        ClockBehind = "camera's clock an hour behind",
        /// The depth camera's clock is a day ahead, then right again.
        ClockAhead = "camera's clock a day ahead",
        /// Only the upper half of each depth image comes.
        HalfImages = "half depth images",
        /// Every second depth image comes: 15 a second.
        HalfRate = "every second image",
        /// One depth image in twenty does not come.
        ImagesLost = "one image in twenty lost",
        /// A hand on the lens: depth images come, and measure nothing.
        Covered = "hand on the lens",
    }
}

impl FaultKind {
    /// What can go wrong with such a camera before the loop.
    pub fn of(camera: SoakCamera) -> Vec<Self> {
        let is_depth = camera == SoakCamera::Depth;
        Self::ALL.into_iter().filter(|kind| kind.camera_fault().is_some() == is_depth).collect()
    }

    /// What is wrong with the depth camera, if it is that.
    pub fn camera_fault(self) -> Option<CameraFault> {
        Some(match self {
            Self::Unplugged => CameraFault::Unplugged,
            Self::Silent => CameraFault::Silent,
            Self::DepthFrozen => CameraFault::Frozen,
            Self::ClockBehind => CameraFault::ClockBack,
            Self::ClockAhead => CameraFault::ClockAhead,
            Self::HalfImages => CameraFault::Half,
            Self::HalfRate => CameraFault::Slow,
            Self::ImagesLost => CameraFault::Lossy,
            Self::Covered => CameraFault::Covered,
            _ => return None,
        })
    }

    /// By what it is seen to be over.
    pub fn recovered_by(self) -> RecoverySign {
        match self {
            Self::RenderStall | Self::RenderPanic => RecoverySign::Picture,
            Self::RecorderStall | Self::DiskFull => RecoverySign::Recording,
            Self::SceneStall => RecoverySign::SceneMaker,
            Self::BrokenGarment => RecoverySign::Refusal,
            Self::PhysicsStall | Self::MemoryPressure => RecoverySign::Step,
            Self::ClothSpoilt => RecoverySign::Calm,
            _ => RecoverySign::Following,
        }
    }

    /// Length of one (s).
    pub(super) fn length(self, rng: &mut SplitMix64) -> f32 {
        match self {
            Self::SensorStall | Self::PhysicsStall | Self::RenderStall | Self::RecorderStall | Self::SceneStall => {
                STALL_S
            }
            Self::BrokenGarment | Self::RenderPanic | Self::ClothSpoilt => 0.0,
            _ => rng.between(FAULT_S[0], FAULT_S[1]),
        }
    }
}

/// What shows that a fault is over.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum RecoverySign {
    /// A step in time that knows a frame of after the fault, whose joints are within 80 mm of where the shopper is on average.
    Following,
    /// A step published in time that was due after it.
    Step,
    /// A step in time in which every particle is finite and none is faster than cloth that a person moves.
    Calm,
    /// A picture of a snapshot of after it.
    Picture,
    /// The recorder wrote all that it had.
    Recording,
    /// The thread that makes scenes takes its turn.
    SceneMaker,
    /// All the broken files were refused, with a word, and the next step was in time.
    Refusal,
}

impl RecoverySign {
    /// In words, for the page.
    pub fn words(self) -> &'static str {
        match self {
            Self::Following => "the shopper is followed again",
            Self::Step => "a step is published in time",
            Self::Calm => "no particle is out of measure or violent",
            Self::Picture => "a picture of a newer snapshot is taken",
            Self::Recording => "all that waited is written",
            Self::SceneMaker => "the scene thread takes its turn",
            Self::Refusal => "all are refused, the next step is in time",
        }
    }
}
