//! The head's picture from the photographs, by inverse mapping: each texel of the body's atlas takes its colour from the place where it was seen.
//!
//! A texel of the head is seen by a photograph where nothing hides it and the head goes on around it; photographs count by the square of
//! the cosine between the surface and the line of sight and less towards the rim, so that seams between them are feathered. Where none
//! looks square on, and towards the neck, the skin's own colour fades in: the upper quartile of the well-seen texels. All of the atlas that is not
//! the head has that colour, which carries it to the body.

use std::hint::black_box;
use std::io::Cursor;

use glam::{DVec2, DVec3};
use image::{ImageFormat, Rgb, RgbImage};
use toile_assets::body::shape::Shapes;
use toile_base::numeric::statistics::quantile_of;

use super::adapt::AdaptedHead;
use super::head_mesh::{HeadMesh, normals};
use super::view::FaceView;
use crate::depth_buffer::DepthBuffer;

/// Pixels along a side of the atlas.
pub const ATLAS: usize = 2_048;

/// Weight at which the skin's colour and what was seen count alike: a cosine of .35.
const SKIN: f64 = 0.12;

/// How much deeper than the nearest surface a point may lie and be seen (m).
const HIDDEN: f64 = 0.004;

/// How near to the place where the head ends in a photograph nothing is taken from it (m), since what lies beyond may show there, and
/// over how many times that it comes to count in full; the head goes on where it is at most so much deeper (m).
const RIM: f64 = 0.0025;
const FEATHER: usize = 6;
const DEEPER: f64 = 0.02;

/// Which of the colours that are seen well is the skin's, the darkest first (share): one that is in the light, since half of a face lies in the
/// shade of a lamp beside it, and the body is lit anew.
const LIT: f64 = 0.75;

/// Weight from which a texel tells the skin's colour.
const WELL: f64 = 0.5;

/// The picture of a head in the body's atlas.
#[derive(Debug, Clone)]
pub struct HeadTexture {
    /// The atlas, rows from the top.
    pub picture: RgbImage,
    /// Colour of the skin, sRGB.
    pub skin: [u8; 3],
    /// Share of the head's texels that a photograph shows well.
    pub seen: f64,
}

/// A texel of the head: its place and normal before the cameras, and how far the head is its own there and not the neck's, 0 to 1.
struct Texel {
    at: usize,
    place: DVec3,
    normal: DVec3,
    own: f64,
}

/// Takes the head's picture from the photographs, one a view.
pub fn texture(head: &AdaptedHead, views: &[FaceView], photographs: &[RgbImage]) -> HeadTexture {
    let texels = texels(head);
    let mut sums = vec![([0.0; 3], 0.0); texels.len()];
    for (view, photograph) in views.iter().zip(photographs) {
        let straight = view.camera.straightened();
        let mut buffer = DepthBuffer::new(view.camera.size, 1.0);
        buffer.draw(&straight, &head.placed, &head.triangles);
        let from = straight.position();
        for (texel, sum) in texels.iter().zip(&mut sums) {
            let cosine = texel.normal.dot((from - texel.place).normalize_or_zero());
            if cosine <= 0.0 {
                continue;
            }
            let in_buffer = buffer.project(&straight, texel.place);
            let (at, depth) = (in_buffer.truncate(), in_buffer.z);
            let reach = RIM * straight.focal().x / depth;
            let goes_on = |k: &usize| buffer.goes_on(at, reach * *k as f64, depth + DEEPER);
            let within = (1..=FEATHER).take_while(goes_on).count() as f64 / FEATHER as f64;
            if within == 0.0 || f64::from(buffer.nearest_around(at)) < depth - HIDDEN {
                continue;
            }
            let Some(pixel) = view.camera.pixel(texel.place) else { continue };
            let Some(colour) = sample(photograph, pixel) else { continue };
            let weight = cosine * cosine * within * within;
            sum.0.iter_mut().zip(colour).for_each(|(s, c)| *s += weight * c);
            sum.1 += weight;
        }
    }
    let well = |k: usize| sums.iter().filter(|s| s.1 > WELL).map(move |s| (s.0[k] / s.1) as f32);
    let skin: [f64; 3] = std::array::from_fn(|k| quantile_of(well(k), LIT).map_or(190.0, f64::from));
    let shown = skin.map(|c| c.round() as u8);
    let mut picture = RgbImage::from_pixel(ATLAS as u32, ATLAS as u32, Rgb(shown));
    let mut filled = vec![false; ATLAS * ATLAS];
    for (texel, (sum, weight)) in texels.iter().zip(&sums) {
        let faded = SKIN * SKIN / (SKIN + weight);
        // Towards the border with the body all of it becomes the skin's colour, which the body has.
        let own = texel.own * texel.own * (3.0 - 2.0 * texel.own);
        let seen = |k: usize| (sum[k] + faded * skin[k]) / (weight + faded);
        let colour = std::array::from_fn(|k| (skin[k] + own * (seen(k) - skin[k])).round() as u8);
        picture.put_pixel((texel.at % ATLAS) as u32, (texel.at / ATLAS) as u32, Rgb(colour));
        filled[texel.at] = true;
    }
    spread(&mut picture, &mut filled);
    let seen = sums.iter().filter(|s| s.1 > WELL).count() as f64 / sums.len().max(1) as f64;
    // A person could be identified by what was summed.
    sums.fill(([0.0; 3], 0.0));
    black_box(&sums);
    HeadTexture { picture, skin: shown, seen }
}

/// The atlas as a PNG file.
///
/// # Errors
/// What the encoder says.
pub fn png(texture: &HeadTexture) -> Result<Vec<u8>, image::ImageError> {
    let mut bytes = Cursor::new(Vec::new());
    texture.picture.write_to(&mut bytes, ImageFormat::Png)?;
    Ok(bytes.into_inner())
}

/// The texels of the head's triangles.
fn texels(head: &AdaptedHead) -> Vec<Texel> {
    let base = Shapes::of(head.sex).base();
    let normals = normals(&head.placed, &head.triangles);
    let share = HeadMesh::of(head.sex).share;
    let is_head: std::collections::BTreeSet<[u32; 3]> = head.triangles.iter().copied().collect();
    let mut found = Vec::new();
    let mut taken = vec![false; ATLAS * ATLAS];
    for (t, corners) in base.triangles.iter().zip(base.triangle_corners()).filter(|(t, _)| is_head.contains(*t)) {
        let side = ATLAS as f64;
        let [a, b, c] = corners.map(|k| {
            let uv = base.uvs[k as usize].as_dvec2();
            DVec2::new(uv.x * side, (1.0 - uv.y) * side) - 0.5
        });
        let area = (b - a).perp_dot(c - a);
        let low = a.min(b).min(c).max(DVec2::ZERO).floor();
        let high = a.max(b).max(c).min(DVec2::splat(side - 1.0)).ceil();
        if area.abs() < 1e-9 || !(low.x <= high.x && low.y <= high.y) {
            continue;
        }
        for y in low.y as usize..=high.y as usize {
            for x in low.x as usize..=high.x as usize {
                let p = DVec2::new(x as f64, y as f64);
                let (wb, wc) = ((p - a).perp_dot(c - a) / area, (b - a).perp_dot(p - a) / area);
                let weights = [1.0 - wb - wc, wb, wc];
                let at = y * ATLAS + x;
                if at >= taken.len() || taken[at] || weights.iter().any(|w| *w < -1e-6) {
                    continue;
                }
                taken[at] = true;
                let of = |v: &[DVec3]| t.iter().zip(weights).map(|(i, w)| v[*i as usize] * w).sum::<DVec3>();
                let own = t.iter().zip(weights).map(|(i, w)| share[*i as usize] * w).sum::<f64>().clamp(0.0, 1.0);
                found.push(Texel { at, place: of(&head.placed), normal: of(&normals).normalize_or_zero(), own });
            }
        }
    }
    found
}

/// A photograph's colour at a place, between its pixels.
fn sample(photograph: &RgbImage, at: DVec2) -> Option<[f64; 3]> {
    let (x, y) = (at.x.floor(), at.y.floor());
    if x < 0.0 || y < 0.0 || x + 1.0 >= f64::from(photograph.width()) || y + 1.0 >= f64::from(photograph.height()) {
        return None;
    }
    let (fx, fy) = (at.x - x, at.y - y);
    let of = |dx: u32, dy: u32| photograph.get_pixel(x as u32 + dx, y as u32 + dy).0;
    let parts = [(0, 0, (1.0 - fx) * (1.0 - fy)), (1, 0, fx * (1.0 - fy)), (0, 1, (1.0 - fx) * fy), (1, 1, fx * fy)];
    let mut colour = [0.0; 3];
    for (dx, dy, w) in parts {
        colour.iter_mut().zip(of(dx, dy)).for_each(|(c, p)| *c += w * f64::from(p));
    }
    Some(colour)
}

/// Texels beside the head's charts take their neighbours' colour, so that the charts' borders do not show.
fn spread(picture: &mut RgbImage, filled: &mut [bool]) {
    for _ in 0..4 {
        let before = filled.to_vec();
        for at in 0..ATLAS * ATLAS {
            let (x, y) = (at % ATLAS, at / ATLAS);
            if before[at] || x == 0 || y == 0 || x + 1 == ATLAS || y + 1 == ATLAS {
                continue;
            }
            let near = [at - 1, at + 1, at - ATLAS, at + ATLAS].into_iter().find(|n| before[*n]);
            if let Some(near) = near {
                let colour = *picture.get_pixel((near % ATLAS) as u32, (near / ATLAS) as u32);
                picture.put_pixel(x as u32, y as u32, colour);
                filled[at] = true;
            }
        }
    }
}
