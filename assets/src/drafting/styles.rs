//! The garments that are drafted: who they are for, what they are made of, how they are cut.

use super::block::DraftBlock;
use super::bodice::BodiceStyle;
use super::dress::{DressStyle, dress};
use super::garment::DraftGarment;
use super::skirt::{self, SkirtStyle};
use super::sleeve::SleeveStyle;
use super::trousers::{TrouserStyle, trousers};
use super::{poncho, scarf, tops};
use crate::sizes::GarmentKind;

/// A garment that is drafted.
#[derive(Debug, Clone, Copy)]
pub struct DraftStyle {
    /// Its name.
    pub name: &'static str,
    /// The table of its sizes.
    pub table: &'static str,
    /// The smallest, a middle and the largest size: those that are drafted; sizes between are graded.
    pub sizes: [&'static str; 3],
    /// What it is.
    pub kind: GarmentKind,
    /// A fabric that is built in.
    pub fabric: &'static str,
    /// Distance between particles (mm).
    pub spacing_mm: f64,
    /// The layer that it is worn in: 1 underwear, 2 skirts and trousers, 3 tops and dresses, 4 jackets, 5 coats, 6
    /// scarves.
    pub layer: u8,
    /// Draws it.
    pub draw: fn(&DraftBlock) -> DraftGarment,
}

/// Whose sizes a garment is made in.
const WOMEN: (&str, [&str; 3]) = ("women", ["32", "44", "54"]);
const MEN: (&str, [&str; 3]) = ("men", ["XXS", "M", "3XL"]);
const UNISEX: (&str, [&str; 3]) = ("unisex", ["XXS", "M", "3XL"]);
const MEN_TROUSERS: (&str, [&str; 3]) = ("men-trousers", ["60", "92", "132"]);

const fn style(
    name: &'static str,
    (table, sizes): (&'static str, [&'static str; 3]),
    kind: GarmentKind,
    (fabric, spacing_mm, layer): (&'static str, f64, u8),
    draw: fn(&DraftBlock) -> DraftGarment,
) -> DraftStyle {
    DraftStyle { name, table, sizes, kind, fabric, spacing_mm, layer, draw }
}

const JERSEY: &str = "cotton-jersey";
const LAWN: &str = "cotton-lawn";
const LINEN: &str = "linen-twill";
const WOOL: &str = "wool-suiting";
const STRIPE: &str = "linen-stripe";
const GINGHAM: &str = "lawn-gingham";
const SHIRTING: &str = "shirting-stripe";
const BRETON: &str = "jersey-breton";
const FLOWERS: &str = "lawn-flowers";
const HOUNDSTOOTH: &str = "wool-houndstooth";
const HERRINGBONE: &str = "wool-herringbone";
const WINDOWPANE: &str = "wool-windowpane";
const SCARF: &str = "scarf-wool";

/// All of them, by layer from the inside out.
pub const STYLES: [DraftStyle; 24] = [
    style("straight-skirt", WOMEN, GarmentKind::Skirt, (LINEN, 17.0, 2), |b| skirt::straight(b, &STRAIGHT_SKIRT)),
    style("pencil-skirt", WOMEN, GarmentKind::Skirt, (WOOL, 17.0, 2), |b| skirt::straight(b, &PENCIL_SKIRT)),
    style("circle-skirt", WOMEN, GarmentKind::Skirt, (GINGHAM, 20.0, 2), skirt::circle),
    style("slim-trousers", WOMEN, GarmentKind::Trousers, (LINEN, 18.0, 2), |b| trousers(b, &SLIM)),
    style("straight-trousers", WOMEN, GarmentKind::Trousers, (WOOL, 18.0, 2), |b| trousers(b, &STRAIGHT)),
    style("wide-leg-trousers", WOMEN, GarmentKind::Trousers, (STRIPE, 19.0, 2), |b| trousers(b, &WIDE)),
    style("mens-trousers", MEN_TROUSERS, GarmentKind::Trousers, (WOOL, 19.0, 2), |b| trousers(b, &MENS_STRAIGHT)),
    style("shorts", WOMEN, GarmentKind::Trousers, (LINEN, 16.0, 2), |b| trousers(b, &SHORTS)),
    style("mens-shorts", MEN_TROUSERS, GarmentKind::Trousers, (LINEN, 16.0, 2), |b| trousers(b, &SHORTS)),
    style("tee", WOMEN, GarmentKind::Tshirt, (JERSEY, 16.0, 3), |b| tops::pullover(b, &TEE, &SHORT_SLEEVE.of(b))),
    style("mens-tee", MEN, GarmentKind::Tshirt, (JERSEY, 16.0, 3), |b| tops::pullover(b, &TEE, &SHORT_SLEEVE.of(b))),
    style("blouse", WOMEN, GarmentKind::Tshirt, (LAWN, 16.0, 3), |b| tops::blouse(b, &BLOUSE, &PUFF_SLEEVE.of(b))),
    style("shirt", WOMEN, GarmentKind::Tshirt, (SHIRTING, 18.0, 3), |b| tops::shirt(b, &SHIRT, &SHIRT_SLEEVE.of(b))),
    style("mens-shirt", MEN, GarmentKind::Tshirt, (SHIRTING, 18.0, 3), |b| tops::shirt(b, &SHIRT, &SHIRT_SLEEVE.of(b))),
    style("jumper", WOMEN, GarmentKind::Tshirt, (JERSEY, 17.0, 3), |b| {
        tops::pullover(b, &JUMPER, &JUMPER_SLEEVE.of(b))
    }),
    style("mens-jumper", MEN, GarmentKind::Tshirt, (BRETON, 18.0, 3), |b| {
        tops::pullover(b, &JUMPER, &JUMPER_SLEEVE.of(b))
    }),
    style("shift-dress", WOMEN, GarmentKind::Dress, (LINEN, 18.0, 3), |b| {
        tops::zipped(b, &to_the_knee(SHIFT, b, 0.97))
    }),
    style("strap-dress", WOMEN, GarmentKind::Dress, (FLOWERS, 18.0, 3), |b| dress(b, &SUN_DRESS)),
    style("blazer", WOMEN, GarmentKind::Jacket, (HOUNDSTOOTH, 18.0, 4), |b| {
        tops::jacket(b, &BLAZER, &BLAZER_SLEEVE.of(b), 2)
    }),
    style("mens-blazer", MEN, GarmentKind::Jacket, (WINDOWPANE, 18.0, 4), |b| {
        tops::jacket(b, &BLAZER, &BLAZER_SLEEVE.of(b), 2)
    }),
    style("coat", WOMEN, GarmentKind::Jacket, (HERRINGBONE, 20.0, 5), |b| {
        tops::jacket(b, &to_the_knee(COAT, b, 0.95), &COAT_SLEEVE.of(b), 3)
    }),
    style("mens-coat", MEN, GarmentKind::Jacket, (WOOL, 21.0, 5), |b| {
        tops::jacket(b, &to_the_knee(COAT, b, 0.95), &COAT_SLEEVE.of(b), 3)
    }),
    style("poncho", WOMEN, GarmentKind::Jacket, (WINDOWPANE, 20.0, 5), poncho::poncho),
    style("scarf", UNISEX, GarmentKind::Jacket, (SCARF, 16.0, 6), scarf::scarf),
];

/// A style with a hem at a part of the way from the waist to the knee.
fn to_the_knee(style: BodiceStyle, block: &DraftBlock, part: f64) -> BodiceStyle {
    BodiceStyle { below_waist: part * block.to_knee, ..style }
}

const STRAIGHT_SKIRT: SkirtStyle = SkirtStyle { hip_ease: 0.05, length: 0.95, flare: 0.012 };
const PENCIL_SKIRT: SkirtStyle = SkirtStyle { hip_ease: 0.035, length: 1.0, flare: -0.02 };

const SLIM: TrouserStyle = TrouserStyle { hip_ease: 0.05, rise_ease: 0.055, knee: 0.47, hem: 0.4, length: 0.92 };
const STRAIGHT: TrouserStyle = TrouserStyle { hip_ease: 0.07, rise_ease: 0.04, knee: 0.47, hem: 0.45, length: 0.94 };
const WIDE: TrouserStyle = TrouserStyle { hip_ease: 0.08, rise_ease: 0.04, knee: 0.62, hem: 0.74, length: 0.95 };
const MENS_STRAIGHT: TrouserStyle = TrouserStyle { length: 0.9, ..STRAIGHT };
const SHORTS: TrouserStyle = TrouserStyle { hip_ease: 0.075, rise_ease: 0.06, knee: 0.6, hem: 0.64, length: 0.42 };

const TEE: BodiceStyle = BodiceStyle {
    chest_ease: 0.09,
    hip_ease: 0.06,
    waist_in: 0.0,
    below_waist: 0.21,
    flare: 0.0,
    neck_wider: 0.028,
    front_neck: 0.1,
    back_neck: 0.025,
    shoulder_out: 0.0,
    armhole_drop: 0.015,
    neck_square: 0.8,
    hollow: [0.022, 0.012],
};
const BLOUSE: BodiceStyle =
    BodiceStyle { chest_ease: 0.08, waist_in: 0.02, front_neck: 0.12, shoulder_out: -0.01, ..TEE };
const SHIRT: BodiceStyle = BodiceStyle {
    chest_ease: 0.12,
    hip_ease: 0.08,
    below_waist: 0.24,
    neck_wider: 0.006,
    front_neck: 0.085,
    back_neck: 0.018,
    ..TEE
};
const JUMPER: BodiceStyle =
    BodiceStyle { chest_ease: 0.17, hip_ease: 0.07, armhole_drop: 0.03, below_waist: 0.21, shoulder_out: 0.012, ..TEE };
const SHIFT: BodiceStyle = BodiceStyle {
    chest_ease: 0.07,
    waist_in: 0.02,
    flare: 0.015,
    front_neck: 0.1,
    shoulder_out: -0.015,
    armhole_drop: 0.0,
    ..TEE
};
const STRAPS: BodiceStyle = BodiceStyle {
    chest_ease: 0.075,
    below_waist: 0.0,
    neck_wider: 0.04,
    front_neck: 0.17,
    back_neck: 0.14,
    shoulder_out: -0.036,
    armhole_drop: 0.0,
    hollow: [0.006, 0.006],
    ..TEE
};
const SUN_DRESS: DressStyle = DressStyle { bodice: STRAPS, waist_ease: 0.04, length: 1.04, quarter: 0.5 };
const BLAZER: BodiceStyle = BodiceStyle {
    chest_ease: 0.17,
    hip_ease: 0.14,
    waist_in: 0.015,
    below_waist: 0.25,
    neck_wider: 0.02,
    front_neck: 0.3,
    shoulder_out: 0.014,
    armhole_drop: 0.03,
    neck_square: 0.15,
    ..TEE
};
const COAT: BodiceStyle = BodiceStyle {
    chest_ease: 0.23,
    hip_ease: 0.22,
    flare: 0.03,
    front_neck: 0.2,
    shoulder_out: 0.02,
    armhole_drop: 0.045,
    ..BLAZER
};

/// A sleeve in proportion to a body.
#[derive(Debug, Clone, Copy)]
struct SleeveRule {
    /// As [`SleeveStyle`].
    cap: f64,
    cap_ease: f64,
    /// Part of the arm.
    length: f64,
    /// Part of the chest's girth.
    hem: f64,
}

impl SleeveRule {
    fn of(self, block: &DraftBlock) -> SleeveStyle {
        let Self { cap, cap_ease, length, hem } = self;
        SleeveStyle { cap, cap_ease, length: length * block.arm, hem: 0.1 + hem * block.chest }
    }
}

const SHORT_SLEEVE: SleeveRule = SleeveRule { cap: 0.22, cap_ease: 0.0, length: 0.4, hem: 0.27 };
const PUFF_SLEEVE: SleeveRule = SleeveRule { cap: 0.26, cap_ease: 0.15, length: 0.42, hem: 0.26 };
const SHIRT_SLEEVE: SleeveRule = SleeveRule { cap: 0.22, cap_ease: 0.01, length: 0.99, hem: 0.15 };
const JUMPER_SLEEVE: SleeveRule = SleeveRule { cap: 0.2, cap_ease: 0.0, length: 0.97, hem: 0.16 };
const BLAZER_SLEEVE: SleeveRule = SleeveRule { cap: 0.28, cap_ease: 0.02, length: 0.98, hem: 0.2 };
const COAT_SLEEVE: SleeveRule = SleeveRule { cap: 0.27, cap_ease: 0.02, length: 1.0, hem: 0.23 };
