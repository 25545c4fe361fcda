//! Tone mapping: from scene light to bytes by the tone curve, the sRGB curve and dither.

use glam::Vec3;

/// Linear level from which highlights are compressed. Below it a colour comes out as it went in but for the offset,
/// so a garment keeps its own colour (Khronos 2024, "PBR Neutral tone mapper", made for true-to-life product colour).
const SHOULDER: f32 = 0.8 - FRESNEL;

/// The reflection of a dielectric at normal incidence, which the curve takes off again.
const FRESNEL: f32 = 0.04;

/// How fast compressed highlights lose their colour.
pub const DESATURATION: f32 = 0.15;

/// Scene light to display light, both linear RGB: the Khronos PBR Neutral curve.
pub fn compress(light: Vec3) -> Vec3 {
    let low = light.min_element();
    let offset = if low < 2.0 * FRESNEL { low - low * low / (4.0 * FRESNEL) } else { FRESNEL };
    let light = light - offset;
    let peak = light.max_element();
    if peak < SHOULDER {
        return light;
    }
    let rest = 1.0 - SHOULDER;
    let pressed = 1.0 - rest * rest / (peak + rest - SHOULDER);
    let grey = 1.0 - 1.0 / (DESATURATION * (peak - pressed) + 1.0);
    (light * (pressed / peak)).lerp(Vec3::splat(pressed), grey)
}

/// Linear to sRGB (IEC 61966-2-1), both 0..1.
pub fn encode(linear: f32) -> f32 {
    if linear <= 0.003_130_8 { 12.92 * linear } else { 1.055 * linear.powf(1.0 / 2.4) - 0.055 }
}

/// sRGB to linear, both 0..1.
pub fn decode(srgb: f32) -> f32 {
    if srgb <= 0.040_45 { srgb / 12.92 } else { ((srgb + 0.055) / 1.055).powf(2.4) }
}

/// Linear RGB to sRGB bytes, rounded after adding `dither` (in bytes, -0.5..0.5).
pub fn bytes(linear: Vec3, dither: f32) -> [u8; 3] {
    linear.to_array().map(|c| (encode(c.clamp(0.0, 1.0)) * 255.0 + 0.5 + dither) as u8)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn srgb_curve_and_its_inverse_agree() {
        for i in 0..=1000 {
            let x = i as f32 / 1000.0;
            assert!((decode(encode(x)) - x).abs() < 1e-5, "{x}");
        }
    }

    #[test]
    fn the_curve_is_continuous_rises_and_stays_below_one() {
        let mut last = compress(Vec3::ZERO).x;
        for i in 1..4000 {
            let x = i as f32 / 400.0;
            let y = compress(Vec3::splat(x)).x;
            assert!(y >= last && y - last < 0.004 && y < 1.0, "{x}: {last} to {y}");
            last = y;
        }
    }

    #[test]
    fn a_garments_colour_keeps_its_differences_below_the_shoulder() {
        let cloth = Vec3::new(0.5, 0.2, 0.15);
        assert!((compress(cloth) - (cloth - FRESNEL)).length() < 1e-6);
    }
}
