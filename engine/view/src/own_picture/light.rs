//! Light as the picture shows it: how bright, of which colour, and from where.
//!
//! A matte surface reflects light as a function of its normal alone; the first spherical harmonics hold 87 % and more of it (Basri and
//! Jacobs 2003; Ramamoorthi and Hanrahan 2001): L(n) = e (1 + d . n). The shopper's body is fitted, so normals are known where it is seen; each
//! part of it has a reflectance of its own, and I = A (1 + d . n) is fitted to each. Colour is that of the whole picture by shades of grey
//! (Finlayson and Trezzi 2004, p = 6), and e makes the brightest twentieth of the picture as bright as a light wall that faces the light.

use glam::{Mat4, Vec3, Vec4};

/// Exponent of the mean by which the light's colour is found.
const SHADES: i32 = 6;

/// Reflectance of what the brightest twentieth of a picture shows: light walls and cloth.
const BRIGHT: f32 = 0.8;

/// Share of the picture that is brighter than its light places.
const BRIGHTEST: f32 = 0.05;

/// Light that comes from one direction, against what comes from all around, at most.
const MOST_DIRECTED: f32 = 0.85;

/// Fewest places of a part of the body that say where light comes from.
const FEWEST: f32 = 40.0;

/// Share of a new estimate: light changes slowly, and a picture's noise must not flicker on the cloth.
const SHARE: f32 = 0.12;

/// Steps of brightness that are counted.
const STEPS: usize = 256;

/// Light in a picture.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LightEstimate {
    /// Light on a surface from all around, linear RGB: what a white one that faces nowhere shows.
    pub level: Vec3,
    /// Where more comes from, and how much more against that (1).
    pub directed: Vec3,
}

impl Default for LightEstimate {
    fn default() -> Self {
        Self { level: Vec3::splat(0.7), directed: Vec3::new(0.0, 0.3, 0.2) }
    }
}

impl LightEstimate {
    /// Light on a surface of this unit normal that sees `open` (0..1) of what comes from one direction, linear RGB.
    pub fn on(&self, normal: Vec3, open: f32) -> Vec3 {
        let strength = self.directed.length();
        let facing = self.directed.dot(normal);
        // What is in shadow has lost what comes from there, and keeps what comes from all around.
        let lost = (1.0 - open) * (0.5 * strength + 0.5 * facing).max(0.0);
        self.level * (1.0 + facing - lost).max(0.15)
    }

    /// How much of the light a shadow takes from what faces it (0..1).
    pub fn shadow_strength(&self) -> f32 {
        let strength = self.directed.length();
        (strength / (1.0 + strength)).clamp(0.12, 0.6)
    }

    /// Direction that most light comes from.
    pub fn toward(&self) -> Vec3 {
        let up = Vec3::new(0.0, 1.0, 0.25);
        (self.directed + up * 0.12).normalize_or(Vec3::Y)
    }
}

/// Sums of one part of the body: 1, normal and brightness.
#[derive(Debug, Clone, Copy, Default)]
struct PartSums {
    square: Mat4Sum,
    seen: Vec4,
}

#[derive(Debug, Clone, Copy, Default)]
struct Mat4Sum([Vec4; 4]);

/// Gathers what a picture says, and follows it.
#[derive(Debug, Clone)]
pub struct LightMeter {
    parts: [PartSums; 4],
    powers: Vec3,
    bright: [u32; STEPS],
    count: u32,
    /// The accepted light.
    now: Option<LightEstimate>,
}

impl Default for LightMeter {
    fn default() -> Self {
        Self { parts: Default::default(), powers: Vec3::ZERO, bright: [0; STEPS], count: 0, now: None }
    }
}

impl LightMeter {
    /// Before a picture.
    pub fn begin(&mut self) {
        (self.parts, self.powers, self.bright, self.count) = (Default::default(), Vec3::ZERO, [0; STEPS], 0);
    }

    /// A pixel of the picture, linear RGB.
    pub fn pixel(&mut self, rgb: Vec3) {
        self.powers += rgb.powi(SHADES);
        let luminance = luminance(rgb);
        self.bright[((luminance * STEPS as f32) as usize).min(STEPS - 1)] += 1;
        self.count += 1;
    }

    /// A pixel that shows a part of the body with this normal.
    pub fn body(&mut self, part: usize, normal: Vec3, rgb: Vec3) {
        let brightness = luminance(rgb);
        // What is burnt out or black says nothing.
        if !(0.004..0.96).contains(&brightness) {
            return;
        }
        let row = Vec4::new(1.0, normal.x, normal.y, normal.z);
        let sums = &mut self.parts[part.min(3)];
        sums.square.0.iter_mut().zip(row.to_array()).for_each(|(column, x)| *column += row * x);
        sums.seen += row * brightness;
    }

    /// After a picture: what is believed from now on.
    pub fn end(&mut self) -> LightEstimate {
        let Some(seen) = self.estimate() else { return self.now.unwrap_or_default() };
        let was = self.now.unwrap_or(seen);
        let now = LightEstimate {
            level: was.level.lerp(seen.level, SHARE),
            directed: was.directed.lerp(seen.directed, SHARE),
        };
        self.now = Some(now);
        now
    }

    /// Forgets the light, because another person may stand there.
    pub fn reset(&mut self) {
        self.now = None;
    }

    fn estimate(&self) -> Option<LightEstimate> {
        if self.count == 0 {
            return None;
        }
        let mut left = (self.count as f32 * BRIGHTEST) as u32;
        let step = (0..STEPS).rev().find(|step| {
            let enough = self.bright[*step] > left;
            left = left.saturating_sub(self.bright[*step]);
            enough
        })?;
        let bright = (step as f32 + 0.5) / STEPS as f32;
        let colour = (self.powers / self.count as f32).powf(1.0 / SHADES as f32);
        let tint = colour / luminance(colour).max(1e-6);
        let directed = self.directed();
        let level =
            tint.clamp(Vec3::splat(0.6), Vec3::splat(1.6)) * (bright / BRIGHT / (1.0 + 0.7 * directed.length()));
        let level = level.clamp(Vec3::splat(0.02), Vec3::splat(1.4));
        (level.is_finite() && directed.is_finite()).then_some(LightEstimate { level, directed })
    }

    /// The direction that most light comes from, by all parts of the body that show enough of themselves.
    fn directed(&self) -> Vec3 {
        let (mut sum, mut weight) = (Vec3::ZERO, 0.0);
        for part in &self.parts {
            let count = part.square.0[0].x;
            if count < FEWEST {
                continue;
            }
            // A little of what a single direction would lack: shoppers do not show their backs.
            let ridge = Mat4::from_diagonal(Vec4::new(0.0, 0.005, 0.005, 0.005) * count);
            let [a, b, c, d] = part.square.0;
            let square = Mat4::from_cols(a, b, c, d) + ridge;
            if square.determinant().abs() <= f32::EPSILON {
                continue;
            }
            let found = square.inverse() * part.seen;
            if found.x > 1e-4 && found.is_finite() {
                let toward = Vec3::new(found.y, found.z, found.w) / found.x;
                sum += toward.clamp_length_max(MOST_DIRECTED) * count;
                weight += count;
            }
        }
        if weight > 0.0 { sum / weight } else { LightEstimate::default().directed }
    }
}

fn luminance(rgb: Vec3) -> f32 {
    rgb.dot(Vec3::new(0.2126, 0.7152, 0.0722))
}

trait Powi {
    fn powi(self, exponent: i32) -> Self;
}

impl Powi for Vec3 {
    fn powi(self, exponent: i32) -> Self {
        Self::from_array(self.to_array().map(|x| x.powi(exponent)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A ball's front under a light, of a reflectance by its height.
    fn seen(light: &LightEstimate, meter: &mut LightMeter) {
        meter.begin();
        for i in 0..60 {
            for k in 0..60 {
                let at = Vec3::new(i as f32 - 29.5, k as f32 - 29.5, 0.0) / 30.0;
                let wall = light.on(Vec3::Z, 1.0) * 0.8;
                meter.pixel(wall);
                if at.length_squared() < 0.98 {
                    let normal = at + Vec3::Z * (1.0 - at.length_squared()).sqrt();
                    let part = usize::from(at.y > 0.0);
                    let reflectance = [0.5, 0.25][part];
                    meter.body(part, normal, light.on(normal, 1.0) * reflectance);
                }
            }
        }
    }

    #[test]
    fn light_is_found_by_the_shading_of_a_body_whatever_its_reflectance() {
        let light = LightEstimate { level: Vec3::new(0.6, 0.5, 0.42), directed: Vec3::new(0.3, 0.4, 0.35) };
        let mut meter = LightMeter::default();
        seen(&light, &mut meter);
        let found = meter.end();
        assert!(found.directed.angle_between(light.directed).to_degrees() < 10.0, "{found:?}");
        assert!((found.directed.length() / light.directed.length() - 1.0).abs() < 0.3, "{found:?}");
        let tint = |l: Vec3| l / luminance(l);
        assert!(tint(found.level).distance(tint(light.level)) < 0.1, "{found:?}");
        let wall = |l: &LightEstimate| luminance(l.on(Vec3::Z, 1.0));
        assert!((wall(&found) / wall(&light) - 1.0).abs() < 0.25, "{found:?}");
    }

    #[test]
    fn a_black_picture_is_dark_and_nothing_is_not_a_number() {
        let mut meter = LightMeter::default();
        assert_eq!(meter.end(), LightEstimate::default());
        meter.begin();
        (0..100).for_each(|_| meter.pixel(Vec3::ZERO));
        let dark = meter.end();
        assert!(dark.level.is_finite() && dark.level.max_element() < 0.05, "{dark:?}");
    }

    #[test]
    fn a_shadow_takes_no_more_than_there_is() {
        let light = LightEstimate { level: Vec3::ONE, directed: Vec3::Y * 0.6 };
        assert!(light.on(Vec3::Y, 0.0).x < light.on(Vec3::Y, 1.0).x);
        assert!(light.on(Vec3::NEG_Y, 0.0).x > 0.1);
    }
}
