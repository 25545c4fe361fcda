//! Visit: all that is known of one shopper. Forgetting them is dropping it.

use toile_track::tape_readings::TapeReadings;

use super::body_turn::BodyTurn;
use super::measure_entry::{LengthUnit, MeasureEntry};
use super::message::VisitDefaults;
use super::own_face::FaceTrouble;
use super::picture_store::PictureStore;
use super::screen::Page;
use super::size_fit::{SizeFit, VisitorMeasures};
use super::texts::Language;
use super::wardrobe::Outfit;

/// Pages that are gone back through, at most.
pub(super) const HISTORY: usize = 6;

/// How far measuring has got.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(super) enum MeasureProgress {
    /// Not asked for.
    #[default]
    No,
    /// They are shown how to stand; measuring begins when they do, and not before a time (ns).
    Guide {
        /// Since when they stand as they should (ns).
        ready_ns: Option<u64>,
        /// Not before (ns): who has pressed something walks back first.
        not_before_ns: u64,
    },
    /// Under way since (ns).
    Measuring(u64),
    /// The front was measured, and they turn.
    Turning,
    /// Measured; the clothes are put on since (ns).
    Dressing(u64),
    /// Nothing could be measured.
    Failed,
}

/// Where the view is turned to.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct ViewTurn {
    /// Eighths of a circle, without end.
    pub eighths: i32,
    /// Where it was, in eighths, when it was turned last, and when that was (ns).
    pub from: f32,
    pub since_ns: u64,
}

/// A job that the dressing worker was given: its number, until its reply has come.
pub(super) type PendingJob = Option<u32>;

/// Two sizes beside each other.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct ComparedSizes {
    /// How the other size fits.
    pub other: SizeFit,
    /// Whether both are draped yet, or cannot be.
    pub asked: PendingJob,
    pub refused: bool,
}

/// A shopper's own face on the mannequin, as far as the pages know of it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(super) struct OwnFace {
    /// Whether they have put it on.
    pub on: bool,
    /// The picture that is being taken, until it is a head.
    pub asked: PendingJob,
    /// Why the last one was not put on.
    pub trouble: Option<FaceTrouble>,
}

impl OwnFace {
    /// Whether none was taken, and none went wrong.
    pub const fn is_untried(&self) -> bool {
        !self.on && self.trouble.is_none()
    }
}

/// All that is known of one shopper.
#[derive(Debug, Clone)]
pub(super) struct Visit {
    /// Who they are to the sensor, once they have stepped in.
    pub shopper: Option<u32>,
    /// When they asked to begin without being seen (ns).
    pub begun_ns: Option<u64>,
    /// When they last touched anything (ns).
    pub touched_ns: Option<u64>,
    /// How tall their head stands (mm): what the controls follow.
    pub head_mm: Option<f32>,
    /// Whether they are measured seated: as is seen, or as they said.
    pub seated: bool,
    pub seated_said: bool,
    pub progress: MeasureProgress,
    pub known: Option<VisitorMeasures>,
    /// Their turn, as long as it is offered or goes on, and what was measured of the front meanwhile.
    pub turn: Option<BodyTurn>,
    pub front: Option<VisitorMeasures>,
    /// Measures that they took by tape and that were accepted, the one that is being typed, and the unit of all of them.
    pub tape: TapeReadings,
    pub entry: Option<MeasureEntry>,
    pub unit: LengthUnit,
    /// What they wear, what they wore when it was last put on, and which of it is in hand (its place in the wardrobe).
    pub outfit: Outfit,
    pub worn: Outfit,
    pub in_hand: usize,
    /// Which garments are shown: the place of their shelf.
    pub shelf: usize,
    /// How the garment in hand fits.
    pub fit: Option<SizeFit>,
    /// Whether a body of theirs stands dressed, what it is asked to wear, whether that failed, and whether it is hidden.
    pub dressed: bool,
    pub dressing: PendingJob,
    pub refused: bool,
    pub hidden: bool,
    /// The page that is open, and those before it.
    pub open: Page,
    pub history: heapless::Vec<Page, HISTORY>,
    /// The zone that is asked about, by its place.
    pub zone: usize,
    pub pair: Option<ComparedSizes>,
    pub view: ViewTurn,
    /// Until when swipes turn the view on (ns).
    pub turning_ns: u64,
    pub fit_map: bool,
    /// Whether they want to see themselves, and not the mannequin.
    pub own_picture: bool,
    pub picture: PictureStore,
    pub snapping: PendingJob,
    pub snap_failed: bool,
    /// Their own face.
    pub face: OwnFace,
    /// Since when another person stands there (ns), and since when they are asked (ns).
    pub stranger_ns: Option<u64>,
    pub asked_ns: Option<u64>,
    pub language: Language,
    pub large: bool,
}

impl Visit {
    /// A visit as it begins: without a shopper.
    pub fn new(defaults: &VisitDefaults) -> Self {
        Self {
            shopper: None,
            begun_ns: None,
            touched_ns: None,
            head_mm: None,
            seated: false,
            seated_said: false,
            progress: MeasureProgress::No,
            known: None,
            turn: None,
            front: None,
            tape: defaults.tape,
            entry: None,
            unit: LengthUnit::default(),
            outfit: Outfit::new(),
            worn: Outfit::new(),
            in_hand: 0,
            shelf: 0,
            fit: None,
            dressed: false,
            dressing: None,
            refused: false,
            hidden: false,
            open: Page::Fitting,
            history: heapless::Vec::new(),
            zone: 0,
            pair: None,
            view: ViewTurn::default(),
            turning_ns: 0,
            fit_map: true,
            own_picture: defaults.own_picture,
            picture: PictureStore::default(),
            snapping: None,
            snap_failed: false,
            face: OwnFace::default(),
            stranger_ns: None,
            asked_ns: None,
            language: defaults.language,
            large: defaults.large,
        }
    }
}
