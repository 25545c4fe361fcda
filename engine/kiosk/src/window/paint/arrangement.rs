//! Places the panel so that the clothes are shown large. Wherever clothes are shown, the mannequin takes at least three fifths of the
//! display's height, unless the visitor asked for large type or a code has to be read off the display.

use egui::{Pos2, Rect, pos2};

use super::qr_code;
use super::theme::ScreenStyle;
use crate::visitor::screen::{Block, BodyView, Screen};

/// Most of a standing display's height that a panel below the body covers.
pub const MOST_PANEL: f32 = 0.72;

/// The same where it stands before a person who looks at themselves, if it can.
const BELOW_BODY: f32 = 0.48;

/// Most of the display's height that a panel below two bodies covers: what is left holds them at three fifths of it.
const BELOW_TWO: f32 = 0.29;

/// Share of a lying display's width that the panel takes.
const SIDE: f32 = 0.42;

/// The same of a standing one: a body with its arms at rest is half as wide as it is high.
const STANDING_SIDE: f32 = 0.47;

/// Share of a wide panel that its words take.
const WORDS: f32 = 0.4;

/// Narrowest module of a code that is read from a column (pixels).
const LEAST_MODULE: f32 = 4.0;

/// Where the panel stands.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Arrangement {
    /// Right of the body, where a right hand is.
    Beside,
    /// Below the body, as wide as the display.
    Below,
    /// The same with the words on the left and what can be pressed on the right, so that it is low.
    Wide,
}

impl Arrangement {
    /// What is tried first, if anything is, and what is taken otherwise.
    pub fn of(screen: &Screen, look: ScreenStyle) -> (Option<Self>, Self) {
        if look.landscape {
            return (None, Self::Beside);
        }
        let preferred = match screen.body_view {
            BodyView::Shopper { .. } if Self::holds_codes(screen, look) => Some(Self::Beside),
            BodyView::Two { .. } => Some(Self::Wide),
            _ => None,
        };
        // Who asked for large type is served first.
        (preferred.filter(|_| screen.type_scale <= 1.0), Self::Below)
    }

    /// Whether a code, where there is one, can be read from a column of a standing display.
    fn holds_codes(screen: &Screen, look: ScreenStyle) -> bool {
        let column = look.display[0] * STANDING_SIDE - 2.0 * look.margin();
        screen.blocks.iter().all(|block| match block {
            Block::Code { side, .. } => column >= LEAST_MODULE * qr_code::modules(*side),
            _ => true,
        })
    }

    /// Whether the panel is a column of a standing display.
    pub fn is_narrow(self, look: ScreenStyle) -> bool {
        self == Self::Beside && !look.landscape
    }

    /// Width of the panel (pixels).
    pub fn column(self, look: ScreenStyle) -> f32 {
        let [w, _] = look.display;
        match self {
            Self::Beside if look.landscape => (w * SIDE).round(),
            Self::Beside => (w * STANDING_SIDE).round(),
            Self::Below | Self::Wide => w - 2.0 * look.air(),
        }
    }

    /// Widths of what is read and of what can be pressed, within the panel (pixels).
    pub fn shares(self, inner: f32, look: ScreenStyle) -> [f32; 2] {
        match self {
            Self::Beside | Self::Below => [inner; 2],
            Self::Wide => {
                let words = (inner * WORDS).round();
                [words, inner - words - look.margin()]
            }
        }
    }

    /// Most that the panel should be high (pixels).
    pub fn most_panel(self, look: ScreenStyle) -> f32 {
        let [_, h] = look.display;
        match self {
            Self::Beside => h,
            Self::Below => h * BELOW_BODY,
            Self::Wide => h * BELOW_TWO,
        }
    }

    /// What a panel leaves of the display.
    pub fn free(self, panel: Rect, look: ScreenStyle) -> Rect {
        let [w, h] = look.display;
        match self {
            Self::Beside => Rect::from_min_max(Pos2::ZERO, pos2(panel.left(), h)),
            Self::Below | Self::Wide => Rect::from_min_max(Pos2::ZERO, pos2(w, panel.top())),
        }
    }
}
