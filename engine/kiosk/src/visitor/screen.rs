//! Screen: everything that the display shows at a moment, as data. The window paints it, a test reads it; the painter decides neither
//! the words nor their order.

use std::fmt::{self, Debug, Formatter};
use std::sync::Arc;

use toile_assets::catalogue::{Picture, ShopTheme};

use super::body_turn::SIDES;

/// Pages of the kiosk.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Page {
    /// No person is in view: what the mirror can do, in turn.
    Attract,
    /// A person has stepped in: where and how to stand.
    Guide,
    /// Measures are being taken.
    Measuring,
    /// A person could not be measured, or not all of them: what is missing, and what can be done.
    Unmeasured,
    /// The fitted body, dressed.
    Fitting,
    /// The garments to choose from, in the order of dressing.
    Garments,
    /// Fit by zone.
    Zones,
    /// Why one zone fits as it does.
    Zone,
    /// Two sizes beside each other.
    Compare,
    /// A picture that was asked for, as a code to scan.
    Picture,
    /// The shopper's own face on the mannequin: what happens, and whether it is on.
    Face,
    /// Measures that the shopper took by tape.
    OwnMeasures,
    /// One of them, being typed.
    MeasureEntry,
    /// Language, type size, seated mode, what is stored.
    Settings,
    /// Another person has stepped in.
    Second,
    /// No person is in view: everything is wiped soon.
    Leaving,
}

/// How a garment that is worn was judged.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct JudgedGarment {
    /// Its place among those that are worn, inner first.
    pub place: usize,
    /// Tightness at chest, waist and hip, -1 (loose) .. 1 (tight), where it is known.
    pub tightness: [Option<f32>; 3],
}

/// What the three-dimensional part of the display shows.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum BodyView {
    /// The mannequin, turning slowly.
    Mannequin,
    /// The shopper's body in what they wear.
    Shopper {
        /// Turn of the view around the body (rad), 0 from before, as a mirror shows.
        yaw: f32,
        /// Whether garments are painted as a fit map, with its legend.
        fit: bool,
        /// Zones whose fit is not known, in the order of `Girth::ALL`: the fit map has no colour there.
        unknown: [bool; 3],
        /// The garment in hand as it was judged, so that its colours say what its words do.
        judged: Option<JudgedGarment>,
        /// Whether they see the camera's own picture of themselves with the clothes on it, and not the mannequin.
        own_picture: bool,
    },
    /// The same body in two sizes, left and right, under one yaw (rad).
    Two {
        /// Turn of both views (rad).
        yaw: f32,
    },
}

/// What pressing a control asks for. Indices are those of the lists that the screen was made from.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Action {
    /// Begin, where a visitor starts the session by touch.
    Begin,
    /// Measure, or measure again.
    Measure,
    /// Open a page.
    Open(Page),
    /// Back to the page before.
    Back,
    /// Wear a garment of the wardrobe, or take it off.
    Garment(usize),
    /// The garments before or after those that are shown (-1, 1).
    Shelf(i8),
    /// The size before or after (-1, 1).
    Size(i8),
    /// A colour of the garment in hand.
    Colour(usize),
    /// A zone of the garment in hand.
    Zone(usize),
    /// Turn the view by so many eighths of a circle.
    Turn(i8),
    /// Show or hide the fit map.
    FitMap,
    /// See oneself in the camera's picture, or the mannequin.
    OwnPicture,
    /// Take the shopper's face, and put it on the mannequin.
    TakeFace,
    /// Take it away.
    RemoveFace,
    /// Take a picture of the dressed body.
    TakePicture,
    /// Show the other code of the picture.
    OtherCode,
    /// Delete the picture now.
    DeletePicture,
    /// I am still here.
    Stay,
    /// I am done: forget me now.
    Leave,
    /// A language of the list.
    Language(usize),
    /// Larger or ordinary type.
    LargeType,
    /// Measure me seated, or standing.
    Seated,
    /// Wear the other one of the two sizes that are compared.
    Wear,
    /// Type a measure that was taken by tape.
    OwnMeasure(usize),
    /// A digit of it.
    Digit(u8),
    /// Its decimal mark.
    Point,
    /// Take the last character back.
    DeleteDigit,
    /// Centimetres or inches.
    Unit,
    /// Accept what was typed.
    Accept,
    /// Remove what was accepted before.
    RemoveMeasure,
}

/// A picture that is shown, shared by all screens that show it; two are the same where they are one.
#[derive(Clone)]
pub struct ScreenPicture(pub Arc<Picture>);

impl PartialEq for ScreenPicture {
    fn eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.0, &other.0)
    }
}

impl Debug for ScreenPicture {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        Debug::fmt(&self.0, f)
    }
}

/// The theme of a shop; none is the kiosk's own. Two are the same where they are one.
#[derive(Debug, Clone, Default)]
pub struct ScreenTheme(pub Option<Arc<ShopTheme>>);

impl PartialEq for ScreenTheme {
    fn eq(&self, other: &Self) -> bool {
        match (&self.0, &other.0) {
            (Some(one), Some(other)) => Arc::ptr_eq(one, other),
            (None, None) => true,
            _ => false,
        }
    }
}

/// How much a control stands out.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum ControlStyle {
    /// What most will want next; one a page at most.
    Primary,
    /// Any control that is neither.
    Plain,
    /// A way out or a setting.
    Quiet,
    /// A key of a keypad: three stand beside each other.
    Key,
    /// A colour, linear RGB.
    Swatch([f32; 3]),
    /// A garment with its photograph above its words; while there is none, its colour, linear RGB.
    Tile([f32; 3]),
}

/// Something that can be pressed, by finger, mouse, key or gesture.
#[derive(Debug, Clone, PartialEq)]
pub struct Control {
    /// Action of the control.
    pub action: Action,
    /// The words on it.
    pub label: String,
    /// A second, smaller line.
    pub detail: Option<String>,
    /// Whether the second line may be left out where there is little room.
    pub is_detail_spare: bool,
    /// How much it stands out.
    pub style: ControlStyle,
    /// Whether it is what is chosen.
    pub chosen: bool,
    /// Its picture, once it is read.
    pub picture: Option<ScreenPicture>,
}

/// What stands between the heading and the controls.
#[derive(Debug, Clone, PartialEq)]
pub enum Block {
    /// A paragraph of text.
    Text(String),
    /// A figure that shows how to stand; its phase goes round from 0 to 1.
    PoseGuide {
        /// Where in its movement the figure is, 0 .. 1.
        phase: f32,
        /// Whether the figure sits.
        seated: bool,
    },
    /// The shopper from above in a ring of the sides that were seen of them.
    TurnGuide {
        /// Whether each side was seen, from where they faced first, to their left.
        seen: [bool; SIDES],
        /// How far they are turned to their left (rad).
        turned: f32,
        /// Where the arrow that shows the way is on its way round, 0 .. 1; none once they turn.
        arrow: Option<f32>,
    },
    /// What is being typed, in large type.
    Entry {
        /// The length with its unit.
        text: String,
    },
    /// How far something has got.
    Progress {
        /// Share that is done, 0 .. 1.
        share: f32,
        /// What is being done.
        label: String,
    },
    /// The fit at one zone.
    Fit {
        /// The zone and its verdict in words, with the ease and its uncertainty.
        text: String,
        /// -1 (loose) .. 1 (tight), for the mark's colour; none where the fit is not known.
        tightness: Option<f32>,
    },
    /// The legend of the fit map, loose and tight.
    Legend {
        /// The word at the loose end and at the tight end.
        ends: [String; 2],
    },
    /// A code to scan: `side` modules a side, row by row, dark is true.
    Code {
        /// Modules (squares) along a side.
        side: usize,
        /// Whether each module is dark, row by row `[side * side]`.
        dark: Vec<bool>,
    },
    /// Seconds that are left.
    Countdown {
        /// Whole seconds that are left.
        seconds: u32,
    },
}

/// Everything that the display shows.
#[derive(Debug, Clone, PartialEq)]
pub struct Screen {
    /// The page that is shown.
    pub page: Page,
    /// The line that is read first.
    pub heading: String,
    /// What stands below it, in order.
    pub blocks: Vec<Block>,
    /// What can be pressed, in the order of the Tab key.
    pub controls: Vec<Control>,
    /// Which control has the focus of keys and gestures.
    pub focus: usize,
    /// Behind all of it.
    pub body_view: BodyView,
    /// Scale of the type: 1 is ordinary.
    pub type_scale: f32,
    /// Upper edge of the controls over the display's lower edge, as a share of its height: within reach of the floor.
    pub reach: f32,
    /// Lower edge of the controls over the display's lower edge, as a share of its height, so that no visitor has to stoop.
    pub reach_low: f32,
    /// Colours of the garments that are worn, linear RGB, inner first: the order of the snapshot's garments.
    pub colours: Vec<[f32; 3]>,
    /// Language, as BCP 47 (`en`, `de`, `fr`, `es`, `tr`, `ja`).
    pub language: &'static str,
    /// Colours and font of a shop.
    pub theme: ScreenTheme,
    /// A shop's logo, on the pages that show it.
    pub logo: Option<ScreenPicture>,
}
