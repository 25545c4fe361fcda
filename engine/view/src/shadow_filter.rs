//! The last pass: shadows filtered across each smooth surface (a joint bilateral filter), light and shadow multiplied,
//! tone mapping, bytes.

use crate::{
    ray_tracer::{PixelLight, PrimaryHit, RayTracer},
    sampling::mix,
    tone_mapping,
};

/// Distance of a neighbour from a pixel's plane at which it no longer counts, in pixels.
const OFF_PLANE: f32 = 3.0;

/// Fractions of light that arrive: key, rim, ambient.
type Visibility = [f32; 3];

/// Writes one row of RGB bytes.
pub fn filter_and_tone_map(y: u32, tracer: &RayTracer<'_>, hits: &[PrimaryHit], lights: &[PixelLight], row: &mut [u8]) {
    let start = y as usize * tracer.size.width as usize;
    for (x, pixel) in (0..).zip(row.chunks_exact_mut(3)) {
        let light_here = &lights[start + x as usize];
        let [key, rim, open] = match (light_here.clear, light_here.edge) {
            (true, _) => [1.0; 3],
            (false, true) => visibility(light_here.arrived, light_here.open, 1.0),
            (false, false) => filtered(x, y, tracer, hits, lights),
        };
        let light = light_here.lamps[0] * key
            + light_here.lamps[1] * rim
            + light_here.ambient[1].lerp(light_here.ambient[0], open);
        // Half a byte of noise hides the steps of the backdrop's gradient.
        let dither = (mix(x ^ mix(y)) >> 8) as f32 / (1 << 24) as f32 - 0.5;
        pixel.copy_from_slice(&tone_mapping::bytes(tone_mapping::compress(light), dither));
    }
}

/// Visibility from sums over samples.
fn visibility(arrived: [[f32; 2]; 2], open: f32, weight: f32) -> Visibility {
    let ratio = |[some, all]: [f32; 2]| if all > 0.0 { some / all } else { 1.0 };
    [ratio(arrived[0]), ratio(arrived[1]), open / weight]
}

/// Visibility averaged over the neighbours on the same smooth part of the same surface.
fn filtered(x: u32, y: u32, tracer: &RayTracer<'_>, hits: &[PrimaryHit], lights: &[PixelLight]) -> Visibility {
    let (width, height) = (tracer.size.width as i32, tracer.size.height as i32);
    let (x, y, reach) = (x as i32, y as i32, tracer.samples.reach);
    let here = &hits[(y * width + x) as usize];
    let tolerance = 1.0 / (OFF_PLANE * tracer.grain(here.position));
    let falloff = 1.0 / ((reach + 1) * (reach + 1)) as f32;
    let (mut arrived, mut open, mut total) = ([[0.0; 2]; 2], 0.0, 0.0);
    for v in (y - reach).max(0)..(y + reach + 1).min(height) {
        for u in (x - reach).max(0)..(x + reach + 1).min(width) {
            let at = (v * width + u) as usize;
            let (hit_here, light_here) = (&hits[at], &lights[at]);
            if hit_here.owner != here.owner || light_here.edge {
                continue;
            }
            let near = 1.0 - ((u - x) * (u - x) + (v - y) * (v - y)) as f32 * falloff;
            let weight = near * likeness(here, hit_here, tolerance);
            if weight > 0.0 {
                for (sum, light_here) in arrived.iter_mut().zip(light_here.arrived) {
                    *sum = [sum[0] + weight * light_here[0], sum[1] + weight * light_here[1]];
                }
                open += weight * light_here.open;
                total += weight;
            }
        }
    }
    visibility(arrived, open, total)
}

/// Weight of a neighbour: 1 in the same plane, 0 beyond the tolerance or a crease.
fn likeness(here: &PrimaryHit, other: &PrimaryHit, tolerance: f32) -> f32 {
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
        let here = PrimaryHit { owner: 0, position: Vec3::ZERO, normal: Vec3::Y };
        let beside = PrimaryHit { position: Vec3::X, ..here };
        let above = PrimaryHit { position: Vec3::new(0.1, 0.02, 0.0), ..here };
        let turned = PrimaryHit { normal: Vec3::X, ..beside };
        assert_eq!(likeness(&here, &beside, 100.0), 1.0);
        assert_eq!(likeness(&here, &above, 100.0), 0.0);
        assert_eq!(likeness(&here, &turned, 100.0), 0.0);
    }
}
