//! The jacket: open in front along its whole length, long sleeves, worn over a T-shirt.

use super::style::{Cut, Style};
use super::upper_body::{self, UpperBodyCut};
use toile_bake::Shape;
use toile_base::body::Body;

/// Room for a T-shirt under it, on the shoulders and where a shopper is larger than the garment (m).
const ROOM_M: f32 = 0.006;

/// Drafts the jacket for the body of its size and lays it on the shopper.
pub fn draft(style: &Style, cut: &Body, shopper: &Body) -> Shape {
    let Cut::Jacket { below_waist_mm, sleeve_mm, sleeve_ease_mm, neck_mm, front_neck_mm, opening_mm } = style.cut
    else {
        unreachable!("the wardrobe drafts each style by its own cut")
    };
    let own = UpperBodyCut {
        below_waist: below_waist_mm * 1e-3,
        sleeve: sleeve_mm * 1e-3,
        sleeve_ease: sleeve_ease_mm * 1e-3,
        neck: neck_mm * 1e-3,
        front_neck: front_neck_mm * 1e-3,
        neck_round: 1.6,
        opening: Some(opening_mm * 1e-3),
        // Lower than the T-shirt's, whose sleeve goes through its armhole.
        underarm: 0.22,
        // As far from the shoulder as a short sleeve does.
        sleeve_turn: 0.4,
        // Evenly down to the wrist.
        sleeve_narrows: 1.0,
        room: ROOM_M,
    };
    upper_body::draft(style, own, cut, shopper)
}
