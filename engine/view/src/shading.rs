//! Reflection of light by the materials.

use glam::Vec3;

use crate::scene::Material;

/// Reflectance of any dielectric seen head-on. The tone curve takes it off again.
pub const FRESNEL: f32 = 0.04;

/// Exponent of the mannequin's highlight: wide and soft, a matte lacquer.
pub const GLOSS: f32 = 18.0;

/// Strength of the cloth's sheen at the most grazing angle (Burley 2012, "Physically based shading at Disney").
const SHEEN: f32 = 0.35;

/// How far the sheen takes the cloth's own colour rather than white.
pub const SHEEN_TINT: f32 = 0.6;

/// Light that reaches an occluded point after all, reflected by what occludes it, times the point's own colour.
pub const BOUNCE: f32 = 0.45;

/// A visible point on a surface.
#[derive(Debug, Clone, Copy)]
pub struct SurfacePoint {
    /// Start of shadow and occlusion rays (m).
    pub position: Vec3,
    /// Unit normal to shade with, facing the camera.
    pub normal: Vec3,
    /// Unit normal of the triangle, facing the camera.
    pub flat: Vec3,
    /// Base colour, linear RGB.
    pub colour: Vec3,
    pub material: Material,
    /// Unit direction to the camera.
    pub eye: Vec3,
    /// True on the subject, false on the backdrop.
    pub on_subject: bool,
}

impl SurfacePoint {
    /// A matte point on something flat.
    pub fn painted(position: Vec3, normal: Vec3, colour: Vec3, eye: Vec3) -> Self {
        Self { position, normal, flat: normal, colour, material: Material::Diffuse, eye, on_subject: false }
    }

    /// Share of a lamp's light sent to the camera, the cosine included; the lamp stands at `toward`.
    pub fn reflect(&self, toward: Vec3) -> Vec3 {
        let cosine = self.normal.dot(toward);
        if cosine <= 0.0 {
            return Vec3::ZERO;
        }
        let half = (toward + self.eye).normalize_or(self.normal);
        let grazing = fifth(1.0 - toward.dot(half).clamp(0.0, 1.0));
        let answer = match self.material {
            Material::Skin => {
                // Blinn's highlight, scaled so that its energy does not depend on the exponent.
                let fresnel = FRESNEL + (1.0 - FRESNEL) * grazing;
                let lobe = (GLOSS + 8.0) / 8.0 * self.normal.dot(half).max(0.0).powf(GLOSS);
                self.colour * (1.0 - fresnel) + fresnel * lobe
            }
            Material::Cloth => self.veiled() + self.sheen_colour() * (SHEEN * grazing),
            Material::Diffuse => self.veiled(),
        };
        answer * cosine
    }

    /// Ambient light sent to the camera: `around` is what the surface receives, `mirrored` what comes from the mirror
    /// direction. Reflection takes from diffusion, so nothing gives back more than it gets.
    pub fn glow(&self, around: Vec3, mirrored: Vec3) -> Vec3 {
        let grazing = fifth(1.0 - self.normal.dot(self.eye).clamp(0.0, 1.0));
        match self.material {
            Material::Skin => {
                let fresnel = FRESNEL + 0.3 * grazing;
                self.colour * around * (1.0 - fresnel) + mirrored * fresnel
            }
            Material::Cloth => self.veiled().lerp(self.sheen_colour(), SHEEN * grazing) * around,
            Material::Diffuse => self.veiled() * around,
        }
    }

    /// Ambient light that an occluded point still gets, as a share of what an open one gets.
    pub fn bounce(&self) -> Vec3 {
        self.colour * BOUNCE
    }

    /// The base colour under the white reflection that any dielectric has.
    fn veiled(&self) -> Vec3 {
        self.colour.lerp(Vec3::ONE, FRESNEL)
    }

    fn sheen_colour(&self) -> Vec3 {
        let peak = self.colour.max_element().max(1e-3);
        Vec3::ONE.lerp(self.colour / peak, SHEEN_TINT)
    }
}

/// x^5, Schlick's approximation of the Fresnel reflectance.
fn fifth(x: f32) -> f32 {
    let square = x * x;
    square * square * x
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Light from one direction, counted over all directions that it may leave by: a matte chart gives back its
    /// colour and no more than all, skin and cloth at most a little more than all (highlight and sheen are added to the diffusion).
    #[test]
    fn no_material_makes_light() {
        for (material, colour, most) in
            [(Material::Diffuse, 1.0, 1.000_1), (Material::Skin, 0.95, 1.02), (Material::Cloth, 0.9, 1.02)]
        {
            for tilt in [0.2_f32, 0.7, 1.2] {
                let toward = Vec3::new(tilt.sin(), tilt.cos(), 0.0);
                let (mut sent, steps) = (0.0, 200);
                for i in 0..steps {
                    for j in 0..steps {
                        // Cosine-weighted directions of leaving: the mean of the answer is the share sent.
                        let (radius, turn) = (((i as f32 + 0.5) / steps as f32).sqrt(), j as f32 / steps as f32);
                        let (sin, cos) = (turn * std::f32::consts::TAU).sin_cos();
                        let eye = Vec3::new(radius * cos, (1.0 - radius * radius).sqrt(), radius * sin);
                        let mut point = SurfacePoint::painted(Vec3::ZERO, Vec3::Y, Vec3::splat(colour), eye);
                        point.material = material;
                        sent += point.reflect(toward).x / toward.y;
                    }
                }
                let share = sent / (steps * steps) as f32;
                assert!(share <= most && share >= 0.6, "{material:?} at {tilt}: sends {share} of what it gets");
            }
        }
    }
}
