//! Garments' photographs fitted to a body's picture and painted on it.

use thiserror::Error;
use toile_assets::catalogue::{CollageGarment, CollagePictures, WearingLayer};
use toile_base::body::Body;

use super::body_layers::{BodyLayers, CollageSide};
use super::scaling::{Layer, RowSpan, scaled};
use crate::image::Image;

/// How far beyond the body's outline cloth reaches (m).
const EASE: f32 = 0.004;

/// How much a row is stretched at most where a garment states no limits.
const STRETCH: f32 = 1.12;

/// Share of the body's half breadth from which on a row is meant to cover it.
const COVERS: f32 = 0.7;

/// Rows over which stretches are smoothed, as a share of the picture's height.
const SMOOTH: f32 = 0.02;

/// Opacity from which a pixel is the garment's outline.
const OPAQUE: f32 = 0.5;

/// How far around a sleeve cloth lies before the arm too (m): a photograph's armhole is never quite where the body's is.
const AROUND_SLEEVE: f32 = 0.06;

/// How far a garment may reach out of the one over it, beside the body, and is pressed in (m): more hangs out.
const PRESSED: f32 = 0.08;

/// Widest slit between two garments that belong together (px).
const SLIT: usize = 5;

/// How far below its beginning a sleeve has an armhole (m): farther down there are hands.
const ARMHOLE: f32 = 0.24;

/// Rows over which the widest counts, as a share of those over which they are smoothed.
const WIDEST: f32 = 0.35;

/// Why garments cannot be shown on a body.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum CollageError {
    /// A body that a garment does not stretch to.
    #[error("{garment} cannot be worn: {why}; choose another size")]
    Unworn {
        /// The garment.
        garment: String,
        /// The girth that is outside of its limits.
        why: String,
    },
    /// No garment has a picture of this side.
    #[error("no garment has a picture from the {}; give one, or leave this side out", .0.name())]
    Unseen(CollageSide),
}

/// A garment with its pictures, from the front, the side and behind.
#[derive(Debug, Clone, Copy)]
pub struct WornPhotographs<'a> {
    /// The garment's entry.
    pub garment: &'a CollageGarment,
    /// Its pictures.
    pub pictures: &'a [Option<CollagePictures>; 3],
}

/// The picture of a body with garments on it: layer by layer, within a layer in the order in which they are given. A garment without a
/// picture of this side is left out.
///
/// # Errors
/// A girth that a garment does not stretch to, or no picture of this side at all.
pub fn collage(
    body: &Body,
    layers: &BodyLayers,
    side: CollageSide,
    worn: &[WornPhotographs],
) -> Result<Image, CollageError> {
    for w in worn {
        let unworn = |why| CollageError::Unworn { garment: w.garment.name.clone(), why };
        w.garment.stretches.hold(&body.measures).map_err(unworn)?;
    }
    let mut order: Vec<(&CollageGarment, &CollagePictures)> =
        worn.iter().filter_map(|w| Some((w.garment, w.pictures[side as usize].as_ref()?))).collect();
    if order.is_empty() {
        return Err(CollageError::Unseen(side));
    }
    // Stable: within one layer the order of wearing stays.
    order.sort_by_key(|(garment, _)| garment.layer);
    let mut placed: Vec<PlacedGarment> = order.iter().map(|(g, p)| PlacedGarment::of(body, layers, g, p)).collect();
    press_in(layers, &mut placed);
    let mut picture = layers.picture.clone();
    let all = |_: usize| 1.0;
    placed.iter().for_each(|garment| lay(&mut picture, &garment.whole, all));
    let bare = layers.picture.bytes();
    for ((to, own), cover) in picture.pixels_mut().zip(bare.as_chunks::<3>().0).zip(&layers.arms) {
        for (t, o) in to.iter_mut().zip(own) {
            *t = (f32::from(*t) * (1.0 - cover) + f32::from(*o) * cover).round() as u8;
        }
    }
    for (i, garment) in placed.iter().enumerate() {
        // What is worn over a sleeve hides it where it has sleeves itself, and hides the trunk's cloth anyhow.
        let free = |at: usize, sleeved: bool| -> f32 {
            let over = placed[i + 1..].iter().filter(|g| g.has_sleeves || !sleeved);
            over.map(|g| 1.0 - g.whole.pixels[at][3]).product()
        };
        lay(&mut picture, &garment.around, |at| free(at, false));
        lay(&mut picture, &garment.sleeves, |at| free(at, true));
    }
    Ok(picture)
}

/// Lays a layer on a picture, as much of each pixel as `share` says.
fn lay(picture: &mut Image, layer: &Layer, share: impl Fn(usize) -> f32) {
    for (at, (to, p)) in picture.pixels_mut().zip(&layer.pixels).enumerate().filter(|(_, (_, p))| p[3] > 0.0) {
        let part = share(at);
        for (t, c) in to.iter_mut().zip(p) {
            *t = (f32::from(*t) * (1.0 - part * p[3]) + 255.0 * part * c).round().clamp(0.0, 255.0) as u8;
        }
    }
}

/// A garment at its place on the body's picture.
struct PlacedGarment {
    /// All of it.
    whole: Layer,
    /// Its sleeves, which lie before the arms.
    sleeves: Layer,
    /// What lies around them and before the arms too.
    around: Layer,
    /// Whether it has sleeves in this picture.
    has_sleeves: bool,
    /// Whether what is worn beneath stays within it.
    holds: bool,
}

impl PlacedGarment {
    fn of(body: &Body, layers: &BodyLayers, garment: &CollageGarment, pictures: &CollagePictures) -> Self {
        let [a, b] = pictures.points;
        let apart = (a[0] - b[0]).hypot(a[1] - b[1]).max(1.0);
        let scale = layers.per_metre * pictures.distance / apart;
        let anchor = [0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1])];
        let row = layers.row(garment.level.height(&body.levels));
        let middle = layers.middle(row);
        let top = row - anchor[1] * scale;
        let size = layers.picture.size();
        let (columns, rows) = (size.width as usize, size.height as usize);
        let arm = |i: usize| pictures.arms.get(i).map_or(0.0, |m| f32::from(*m) / 255.0);
        let trunk = Layer::of(&pictures.picture, |i| 1.0 - arm(i));
        let outlines = outlines(&trunk, rows, (top, scale), anchor[0]);
        let factors = stretches(layers, garment, &outlines, scale, middle);
        let span =
            |(stretch, edges): (&[f32; 2], &[f32; 2])| RowSpan { middle, scale, stretch: *stretch, edges: *edges };
        let spans: Vec<RowSpan> = factors.iter().zip(&outlines).map(span).collect();
        let per_metre = apart / pictures.distance;
        let near = around_sleeves(&trunk, arm, [AROUND_SLEEVE, ARMHOLE].map(|m| (m * per_metre) as usize));
        let at = |layer: Layer| scaled(&layer, [columns, rows], (top, scale), anchor[0], &spans);
        Self {
            whole: at(Layer::of(&pictures.picture, |_| 1.0)),
            sleeves: at(Layer::of(&pictures.picture, arm)),
            around: at(Layer::of(&pictures.picture, |i| (near[i] - arm(i)).max(0.0))),
            has_sleeves: pictures.arms.iter().any(|m| *m > 0),
            holds: is_tight(garment),
        }
    }
}

/// Belts, scarves and shoes hold nothing beneath them and are not stretched.
fn is_tight(garment: &CollageGarment) -> bool {
    !matches!(garment.layer, WearingLayer::Belts | WearingLayer::Scarves | WearingLayer::Shoes)
}

/// Takes away what reaches a little out of an outer garment beside the body: photographs are each stretched by themselves, and what is worn
/// beneath stays within.
fn press_in(layers: &BodyLayers, placed: &mut [PlacedGarment]) {
    let size = layers.picture.size();
    let (columns, rows) = (size.width as usize, size.height as usize);
    let most = (PRESSED * layers.per_metre) as usize;
    for i in 0..placed.len() {
        let (inner, outer) = placed.split_at_mut(i + 1);
        let inner = &mut inner[i];
        for y in 0..rows {
            let row = y * columns;
            let covers = |x: usize| outer.iter().any(|g| g.holds && g.whole.pixels[row + x][3] >= OPAQUE);
            let on_body = |x: usize| {
                let within = layers.trunk[y].is_some_and(|[left, right]| (left..right).contains(&(x as f32 + 0.5)));
                within || layers.arms[row + x] >= OPAQUE
            };
            let sticks_out = |x: usize| inner.whole.pixels[row + x][3] > 0.0 && !covers(x) && !on_body(x);
            let mut out = Vec::new();
            let mut x = 0;
            while x < columns {
                let end = (x..columns).find(|x| !sticks_out(*x)).unwrap_or(columns);
                let beside = (x.saturating_sub(SLIT)..x).chain(end..(end + SLIT).min(columns)).any(covers);
                if end > x && end - x <= most && beside {
                    out.push(x..end);
                }
                x = end.max(x + 1);
            }
            for at in out.into_iter().flatten() {
                for layer in [&mut inner.whole, &mut inner.sleeves, &mut inner.around] {
                    layer.pixels[row + at] = [0.0; 4];
                }
            }
        }
    }
}

/// Sleeves with what lies around them, by so many pixels, for so many rows from the highest of them: share of each pixel.
fn around_sleeves(picture: &Layer, arm: impl Fn(usize) -> f32, [around, armhole]: [usize; 2]) -> Vec<f32> {
    let (width, height) = (picture.width, picture.height);
    let own: Vec<f32> = (0..width * height).map(arm).collect();
    let begins = (0..height).find(|y| own[y * width..][..width].iter().any(|m| *m >= OPAQUE));
    let Some(begins) = begins else { return own };
    let rows = begins.saturating_sub(around)..(begins + armhole).min(height);
    // A square of the greatest: across, then down.
    let span = |at: usize, end: usize| at.saturating_sub(around)..(at + around + 1).min(end);
    let mut across = own.clone();
    for y in 0..height {
        let row = &own[y * width..][..width];
        for x in (0..width).filter(|_| row.iter().any(|m| *m > 0.0)) {
            across[y * width + x] = row[span(x, width)].iter().fold(0.0, |most, m| most.max(*m));
        }
    }
    let mut all = own;
    for y in rows {
        for x in 0..width {
            all[y * width + x] = span(y, height).fold(0.0, |most: f32, y| most.max(across[y * width + x]));
        }
    }
    all
}

/// How far each row's outline reaches left and right of the anchor (px of the garment's picture): the widest of its neighbours, so that a
/// hem that ends aslant is as wide as what hangs above it `[rows]`.
fn outlines(trunk: &Layer, rows: usize, (top, scale): (f32, f32), anchor: f32) -> Vec<[f32; 2]> {
    let outline = |y: usize| -> Option<[f32; 2]> {
        let from = (y as f32 + 0.5 - top) / scale;
        if from < 0.0 || from >= trunk.height as f32 {
            return None;
        }
        let row = &trunk.pixels[from as usize * trunk.width..][..trunk.width];
        let first = row.iter().position(|p| p[3] >= OPAQUE)? as f32;
        let last = row.iter().rposition(|p| p[3] >= OPAQUE)? as f32 + 1.0;
        Some([(anchor - first).max(0.0), (last - anchor).max(0.0)])
    };
    let own: Vec<Option<[f32; 2]>> = (0..rows).map(outline).collect();
    let (first, last) = (own.iter().position(Option::is_some), own.iter().rposition(Option::is_some));
    let (Some(first), Some(last)) = (first, last) else { return vec![[0.0; 2]; rows] };
    // Above and below it goes on as it ends; a hem that ends aslant is as wide as what hangs just above it.
    let hem = last.saturating_sub((SMOOTH * rows as f32) as usize).max(first);
    let mut whole = vec![own[first].unwrap_or_default(); rows];
    for y in first + 1..rows {
        let now = own[y.min(last)].unwrap_or(whole[y - 1]);
        whole[y] = if y > hem { [0, 1].map(|k| now[k].max(whole[hem][k])) } else { now };
    }
    smooth(&whole)
}

/// The most of a row's nearest neighbours, then the mean of more of them: a row that needs more has it, and none jumps.
fn smooth(own: &[[f32; 2]]) -> Vec<[f32; 2]> {
    let rows = own.len();
    let reach = ((SMOOTH * rows as f32) as usize).max(1);
    let around = |y: usize, reach: usize| y.saturating_sub(reach)..(y + reach + 1).min(rows);
    let nearest = (reach as f32 * WIDEST) as usize;
    let most = |y: usize| own[around(y, nearest)].iter().fold([0.0f32; 2], |m, r| [m[0].max(r[0]), m[1].max(r[1])]);
    let wide: Vec<[f32; 2]> = (0..rows).map(most).collect();
    let mean = |y: usize| {
        let part = &wide[around(y, reach)];
        [0, 1].map(|k| part.iter().map(|r| r[k]).sum::<f32>() / part.len() as f32)
    };
    (0..rows).map(mean).collect()
}

/// How much each row is stretched left and right of the middle, so that cloth that is meant to covers the body, within its limits.
fn stretches(
    layers: &BodyLayers,
    garment: &CollageGarment,
    outlines: &[[f32; 2]],
    scale: f32,
    middle: f32,
) -> Vec<[f32; 2]> {
    let tight = is_tight(garment);
    let most = garment.stretches.most().unwrap_or(STRETCH).max(1.0);
    let ease = EASE * layers.per_metre;
    let wanted = |(half, trunk): (&[f32; 2], &Option<[f32; 2]>)| -> Option<[f32; 2]> {
        let [left, right] = (*trunk)?;
        let need = [middle - left + ease, right - middle + ease];
        Some([0, 1].map(|k| {
            let half = half[k] * scale;
            let covers = half > COVERS * need[k] && need[k] > 0.0;
            if tight && covers { (need[k] / half).clamp(1.0, most) } else { 1.0 }
        }))
    };
    let own: Vec<[f32; 2]> = outlines.iter().zip(&layers.trunk).map(|row| wanted(row).unwrap_or([1.0; 2])).collect();
    smooth(&own)
}
