//! Tucking in: finds what of a garment is worn inside of the one under it, from where both start. At load.

use std::collections::BTreeMap;

use toile_base::garment::tuck::SLIPS_M;
use toile_base::garment::{Garment, Part, Tuck};

use super::order::wearing_order;

/// What a garment is tucked into ends at least this far below its own upper end (m): a shirt comes out of trousers.
const COMES_OUT_M: f32 = 0.1;

/// Nothing of what has a waistband rises higher above it (m).
const ABOVE_BAND_M: f32 = 0.03;

/// Farthest below a waistband that cloth can be tucked in (m): a long shirt. A dress has no room in trousers.
pub const DEEPEST_TUCK_M: f32 = 0.4;

/// Why a garment cannot be tucked in.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum TuckError {
    /// Nothing to tuck it into.
    #[error(
        "{garment} cannot be tucked in: it is worn over nothing that ends below it at a waistband; wear trousers under it, \
         or do not tuck it in"
    )]
    NoWaistband {
        /// The garment to be tucked in.
        garment: String,
    },
    /// A garment that does not reach the waistband.
    #[error("{garment} ends above the waistband of {into}; take a longer one, or do not tuck it in")]
    Short {
        /// The garment to be tucked in.
        garment: String,
        /// What is worn under it.
        into: String,
    },
    /// A garment that reaches too far below the waistband.
    #[error(
        "{garment} reaches {reaches_mm:.0} mm below the waistband of {into}, and at most {:.0} mm can be tucked in; take a \
         shorter one, or do not tuck it in", DEEPEST_TUCK_M * 1e3
    )]
    Long {
        /// The garment to be tucked in.
        garment: String,
        /// What is worn under it.
        into: String,
        /// How far below the waistband it reaches (mm).
        reaches_mm: f32,
    },
}

/// Tucks a garment of an outfit into the next one under it that has a waistband: what starts below the waistband, but for
/// sleeves, belongs inside of that one from then on.
///
/// # Errors
/// Where there is none, or the garment is too short or too long for it.
pub fn tuck_in(garments: &mut [Garment], tucked: usize) -> Result<(), TuckError> {
    let order = wearing_order(garments);
    let place = order.iter().position(|&g| g == tucked).unwrap_or(0);
    let own = &garments[tucked];
    let garment = || own.name.clone();
    let under = order[..place].iter().rev();
    let found =
        under.filter_map(|&g| Some((g, waistband(&garments[g])?))).find(|(_, band)| top(own) > band + COMES_OUT_M);
    let Some((into, band)) = found else { return Err(TuckError::NoWaistband { garment: garment() }) };
    let is_sleeve = |i: usize| matches!(own.parts[i], Part::LeftArm | Part::RightArm);
    let below = |i: usize| if is_sleeve(i) { f32::NEG_INFINITY } else { band - own.start[i].y };
    let deepest = (0..own.particles()).map(below).fold(f32::NEG_INFINITY, f32::max);
    let name = garments[into].name.clone();
    if deepest <= 0.0 {
        return Err(TuckError::Short { garment: garment(), into: name });
    }
    if deepest > DEEPEST_TUCK_M {
        return Err(TuckError::Long { garment: garment(), into: name, reaches_mm: deepest * 1e3 });
    }
    let particles = (0..own.particles()).map(|i| below(i) > -SLIPS_M).collect();
    let tuck = Tuck { into, band, particles };
    garments[tucked].set_tuck(Some(tuck)).expect("it speaks of each particle of its garment");
    Ok(())
}

/// Height of a garment's upper end (m).
fn top(garment: &Garment) -> f32 {
    garment.start.iter().map(|p| p.y).fold(f32::NEG_INFINITY, f32::max)
}

/// Height of a garment's waistband (m): its highest border, where nothing of the garment rises above it. A T-shirt's neckline is
/// none, because its shoulders do.
fn waistband(garment: &Garment) -> Option<f32> {
    let borders = borders(garment);
    let mean =
        |border: &Vec<u32>| border.iter().map(|&v| garment.start[v as usize].y).sum::<f32>() / border.len() as f32;
    let band = borders.iter().map(mean).max_by(f32::total_cmp)?;
    (top(garment) < band + ABOVE_BAND_M).then_some(band)
}

/// The vertices of each border of a garment.
fn borders(garment: &Garment) -> Vec<Vec<u32>> {
    let mut faces: BTreeMap<[u32; 2], usize> = BTreeMap::new();
    for t in &garment.triangles {
        let edges = [[t[0], t[1]], [t[1], t[2]], [t[2], t[0]]];
        edges.iter().for_each(|[a, b]| *faces.entry([*a.min(b), *a.max(b)]).or_default() += 1);
    }
    let mut beside: BTreeMap<u32, Vec<u32>> = BTreeMap::new();
    for ([a, b], _) in faces.into_iter().filter(|(_, count)| *count == 1) {
        beside.entry(a).or_default().push(b);
        beside.entry(b).or_default().push(a);
    }
    let mut borders = Vec::new();
    while let Some((&first, _)) = beside.first_key_value() {
        let (mut open, mut border) = (vec![first], Vec::new());
        while let Some(v) = open.pop() {
            if let Some(next) = beside.remove(&v) {
                border.push(v);
                open.extend(next);
            }
        }
        borders.push(border);
    }
    borders
}
