//! Garments' photographs fitted to a body's picture and painted on it.

use thiserror::Error;
use toile_assets::body::Body;
use toile_assets::catalogue::{CollageGarment, CollagePictures, WearingLayer};

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
    /// What is said of it.
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
    let placed: Vec<[Layer; 2]> = order.iter().map(|(g, p)| placed(body, layers, g, p)).collect();
    let mut picture = layers.picture.clone();
    placed.iter().for_each(|[beside, _]| lay(&mut picture, beside));
    let bare = layers.picture.bytes();
    for ((to, own), cover) in picture.pixels_mut().zip(bare.as_chunks::<3>().0).zip(&layers.arms) {
        for (t, o) in to.iter_mut().zip(own) {
            *t = (f32::from(*t) * (1.0 - cover) + f32::from(*o) * cover).round() as u8;
        }
    }
    placed.iter().for_each(|[_, on_arms]| lay(&mut picture, on_arms));
    Ok(picture)
}

fn lay(picture: &mut Image, layer: &Layer) {
    for (to, p) in picture.pixels_mut().zip(&layer.pixels).filter(|(_, p)| p[3] > 0.0) {
        for (t, c) in to.iter_mut().zip(p) {
            *t = (f32::from(*t) * (1.0 - p[3]) + 255.0 * c).round().clamp(0.0, 255.0) as u8;
        }
    }
}

/// A garment at its place on the body's picture: the part beside the arms, and the part on them.
fn placed(body: &Body, layers: &BodyLayers, garment: &CollageGarment, pictures: &CollagePictures) -> [Layer; 2] {
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
    let beside = Layer::of(&pictures.picture, |i| 1.0 - arm(i));
    let on_arms = Layer::of(&pictures.picture, arm);
    let width = beside.width as f32;
    let factors = stretches(layers, garment, &beside, (top, scale), [anchor[0], middle]);
    let spans: Vec<RowSpan> = factors
        .iter()
        .map(|[l, r]| RowSpan {
            ends: [middle - anchor[0] * scale * l, middle, middle + (width - anchor[0]) * scale * r],
        })
        .collect();
    [beside, on_arms].map(|layer| scaled(&layer, [columns, rows], (top, scale), anchor[0], &spans))
}

/// How much each row is stretched left and right of the middle, so that cloth that is meant to covers the body, within its limits.
fn stretches(
    layers: &BodyLayers,
    garment: &CollageGarment,
    beside: &Layer,
    (top, scale): (f32, f32),
    [anchor, middle]: [f32; 2],
) -> Vec<[f32; 2]> {
    let rows = layers.trunk.len();
    let tight = !matches!(garment.layer, WearingLayer::Belts | WearingLayer::Scarves | WearingLayer::Shoes);
    let most = garment.stretches.most().unwrap_or(STRETCH).max(1.0);
    let ease = EASE * layers.per_metre;
    let wanted = |y: usize| -> Option<[f32; 2]> {
        let from = (y as f32 + 0.5 - top) / scale;
        if from < 0.0 || from >= beside.height as f32 {
            return None;
        }
        let from = from as usize;
        let row = &beside.pixels[from * beside.width..][..beside.width];
        let first = row.iter().position(|p| p[3] >= OPAQUE)? as f32;
        let last = row.iter().rposition(|p| p[3] >= OPAQUE)? as f32 + 1.0;
        let [left, right] = layers.trunk[y]?;
        let half = [(anchor - first) * scale, (last - anchor) * scale];
        let need = [middle - left + ease, right - middle + ease];
        Some([0, 1].map(|k| {
            let covers = half[k] > COVERS * need[k] && need[k] > 0.0;
            if tight && covers { (need[k] / half[k]).clamp(1.0, most) } else { 1.0 }
        }))
    };
    let raw: Vec<[f32; 2]> = (0..rows).map(|y| wanted(y).unwrap_or([1.0; 2])).collect();
    let reach = ((SMOOTH * rows as f32) as usize).max(1);
    let around = |y: usize, k: usize| y.saturating_sub(k)..(y + k + 1).min(rows);
    // The most of the neighbours, then their mean: a row that needs more has it, and none jumps.
    let wide: Vec<[f32; 2]> = (0..rows)
        .map(|y| raw[around(y, reach)].iter().fold([1.0f32; 2], |m, r| [m[0].max(r[0]), m[1].max(r[1])]))
        .collect();
    (0..rows)
        .map(|y| {
            let part = &wide[around(y, reach)];
            [0, 1].map(|k| part.iter().map(|r| r[k]).sum::<f32>() / part.len() as f32)
        })
        .collect()
}
