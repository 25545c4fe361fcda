//! The last pass: shadows smoothed over like neighbours, light and shadow joined, tone, bytes.

use crate::{
    expose::{Guide, Shot, Texel},
    sample::mix,
    tone,
};

/// Distance of a neighbour from a pixel's plane at which it no longer counts, in pixels.
const OFF_PLANE: f32 = 3.0;

/// Shares of light that arrive: key, rim, ambient.
type Shares = [f32; 3];

/// Develops one row of RGB bytes.
pub fn develop(y: u32, shot: &Shot<'_>, guides: &[Guide], texels: &[Texel], row: &mut [u8]) {
    let start = y as usize * shot.size.width as usize;
    for (x, pixel) in (0..).zip(row.chunks_exact_mut(3)) {
        let texel = &texels[start + x as usize];
        let [key, rim, open] = match (texel.clear, texel.edge) {
            (true, _) => [1.0; 3],
            (false, true) => share(texel.arrived, texel.open, 1.0),
            (false, false) => smoothed(x, y, shot, guides, texels),
        };
        let light = texel.lamps[0] * key + texel.lamps[1] * rim + texel.ambient[1].lerp(texel.ambient[0], open);
        // Half a byte of noise hides the steps of the backdrop's gradient.
        let dither = (mix(x ^ mix(y)) >> 8) as f32 / (1 << 24) as f32 - 0.5;
        pixel.copy_from_slice(&tone::bytes(tone::compress(light), dither));
    }
}

/// Shares of light from sums over samples.
fn share(arrived: [[f32; 2]; 2], open: f32, weight: f32) -> Shares {
    let ratio = |[some, all]: [f32; 2]| if all > 0.0 { some / all } else { 1.0 };
    [ratio(arrived[0]), ratio(arrived[1]), open / weight]
}

/// Shares of light averaged over the neighbours that lie on the same smooth stretch of the same surface.
fn smoothed(x: u32, y: u32, shot: &Shot<'_>, guides: &[Guide], texels: &[Texel]) -> Shares {
    let (width, height) = (shot.size.width as i32, shot.size.height as i32);
    let (x, y, reach) = (x as i32, y as i32, shot.plan.reach);
    let here = &guides[(y * width + x) as usize];
    let tolerance = 1.0 / (OFF_PLANE * shot.grain(here.position));
    let falloff = 1.0 / ((reach + 1) * (reach + 1)) as f32;
    let (mut arrived, mut open, mut total) = ([[0.0; 2]; 2], 0.0, 0.0);
    for v in (y - reach).max(0)..(y + reach + 1).min(height) {
        for u in (x - reach).max(0)..(x + reach + 1).min(width) {
            let at = (v * width + u) as usize;
            let (guide, texel) = (&guides[at], &texels[at]);
            if guide.owner != here.owner || texel.edge {
                continue;
            }
            let near = 1.0 - ((u - x) * (u - x) + (v - y) * (v - y)) as f32 * falloff;
            let weight = near * likeness(here, guide, tolerance);
            if weight > 0.0 {
                for (sum, texel) in arrived.iter_mut().zip(texel.arrived) {
                    *sum = [sum[0] + weight * texel[0], sum[1] + weight * texel[1]];
                }
                open += weight * texel.open;
                total += weight;
            }
        }
    }
    share(arrived, open, total)
}

/// How much a neighbour lies on the same smooth stretch: 1 in the same plane, 0 beyond the tolerance or a crease.
fn likeness(here: &Guide, other: &Guide, tolerance: f32) -> f32 {
    let alike = here.normal.dot(other.normal).max(0.0);
    let alike = alike * alike;
    let alike = alike * alike;
    let alike = alike * alike;
    let off = here.normal.dot(other.position - here.position).abs() * tolerance;
    alike * alike * alike * (1.0 - off).max(0.0)
}

#[cfg(test)]
mod tests {
    use glam::Vec3;

    use super::*;

    #[test]
    fn likeness_is_whole_in_the_plane_and_none_off_it() {
        let here = Guide { owner: 0, position: Vec3::ZERO, normal: Vec3::Y };
        let beside = Guide { position: Vec3::X, ..here };
        let above = Guide { position: Vec3::new(0.1, 0.02, 0.0), ..here };
        let turned = Guide { normal: Vec3::X, ..beside };
        assert_eq!(likeness(&here, &beside, 100.0), 1.0);
        assert_eq!(likeness(&here, &above, 100.0), 0.0);
        assert_eq!(likeness(&here, &turned, 100.0), 0.0);
    }
}
