//! The T-shirt: closed all around, short sleeves.

use super::style::{Cut, Style};
use super::upper_body::{self, UpperBodyCut};
use toile_bake::Shape;
use toile_base::body::Body;

/// Drafts the T-shirt for the body of its size and lays it on the shopper.
pub fn draft(style: &Style, cut: &Body, shopper: &Body) -> Shape {
    let Cut::TShirt { below_waist_mm, sleeve_mm, sleeve_ease_mm, neck_mm, front_neck_mm } = style.cut else {
        unreachable!("the wardrobe drafts each style by its own cut")
    };
    let own = UpperBodyCut {
        below_waist: below_waist_mm * 1e-3,
        sleeve: sleeve_mm * 1e-3,
        sleeve_ease: sleeve_ease_mm * 1e-3,
        neck: neck_mm * 1e-3,
        front_neck: front_neck_mm * 1e-3,
        neck_round: 2.5,
        opening: None,
        // Just below the armpit.
        underarm: 0.34,
        // All but the hem.
        sleeve_turn: 0.9,
        sleeve_narrows: 0.6,
        room: 0.0,
    };
    upper_body::draft(style, own, cut, shopper)
}
