//! Three-point lighting (key, rim and fill light with soft ambient light), and a curved backdrop behind the subject.
//!
//! The lights follow the camera, as if the subject stood on a turntable. Light is scaled so that a white matte surface
//! facing a light of colour c sends c to the camera.

use glam::{Vec2, Vec3};

use crate::{
    bvh::Ray,
    sampling::disc,
    scene::{Bounds, CameraFrame},
};

/// Reflectance of the backdrop, linear RGB.
pub const PAINT: Vec3 = Vec3::new(0.70, 0.695, 0.69);

/// Reach of ambient occlusion, in subject heights.
const REACH: f32 = 0.22;

/// A distant light that appears as a disc.
#[derive(Debug, Clone, Copy)]
pub struct AreaLight {
    toward: Vec3,
    across: [Vec3; 2],
    pub colour: Vec3,
}

impl AreaLight {
    /// A lamp `azimuth` to the right of the camera and `elevation` over the horizon (rad) as seen from the subject,
    /// with the apparent radius `radius` (rad).
    fn new(view: &CameraFrame, azimuth: f32, elevation: f32, radius: f32, colour: Vec3) -> Self {
        let back = -Vec3::new(view.forward.x, 0.0, view.forward.z).normalize_or(Vec3::NEG_Z);
        let level = back * azimuth.cos() + view.right * azimuth.sin();
        let toward = (level * elevation.cos() + Vec3::Y * elevation.sin()).normalize();
        let across = toward.any_orthonormal_pair();
        let across = [across.0, across.1].map(|a| a * radius.tan());
        Self { toward, across, colour }
    }

    /// Direction towards a place on the lamp's disc; `at` is uniform in the unit square.
    pub fn direction(&self, at: Vec2) -> Vec3 {
        let at = disc(at);
        (self.toward + self.across[0] * at.x + self.across[1] * at.y).normalize()
    }

    /// Tangent of the lamp's apparent radius.
    pub fn breadth(&self) -> f32 {
        self.across[0].length()
    }

    /// Direction towards the lamp's middle.
    pub fn middle(&self) -> Vec3 {
        self.toward
    }
}

/// All light of one picture.
#[derive(Debug, Clone, Copy)]
pub struct Lighting {
    /// The main light, from one side of the camera.
    pub key: AreaLight,
    /// The light from behind that draws the outline.
    pub rim: AreaLight,
    /// Ambient light from above, linear RGB.
    pub sky: Vec3,
    /// Ambient light from below, linear RGB.
    pub ground: Vec3,
    /// Ambient light added from the side of the fill light, linear RGB.
    pub fill: Vec3,
    /// Unit direction towards the fill light.
    pub fill_toward: Vec3,
    /// The box around the subject (m).
    pub subject: Bounds,
    /// The backdrop behind the subject.
    pub backdrop: CurvedBackdrop,
}

impl Lighting {
    /// Lights the subject within `bounds` for one camera.
    pub fn new(view: &CameraFrame, bounds: Bounds, floor: bool) -> Self {
        let backdrop = CurvedBackdrop::new(view, bounds, floor);
        let fill_toward = (view.right * 0.55 - view.forward + Vec3::Y * 0.15).normalize();
        Self {
            key: AreaLight::new(view, -0.98, 0.80, 0.17, Vec3::new(1.0, 0.965, 0.915) * 0.98),
            rim: AreaLight::new(view, 2.45, 0.55, 0.12, Vec3::new(0.92, 0.97, 1.05) * 0.55),
            sky: Vec3::new(0.53, 0.53, 0.54),
            ground: Vec3::new(0.23, 0.22, 0.21),
            fill: Vec3::new(0.16, 0.165, 0.175),
            fill_toward,
            subject: bounds,
            backdrop,
        }
    }

    /// Ambient light that a surface with this normal receives, or that comes from around this direction.
    pub fn ambient(&self, normal: Vec3) -> Vec3 {
        let facing = 0.5 + 0.5 * normal.dot(self.fill_toward);
        self.ground.lerp(self.sky, 0.5 + 0.5 * normal.y) + self.fill * (facing * facing)
    }

    /// Reach of ambient occlusion (m): hollows smaller than this darken.
    pub fn reach(&self) -> f32 {
        REACH * self.backdrop.size
    }

    /// True for a place on the backdrop that no shadow of the subject can reach.
    pub fn clear(&self, place: Vec3) -> bool {
        if !self.backdrop.floor || self.subject.is_empty() {
            return true;
        }
        let (min, max) = (self.subject.min - place, self.subject.max - place);
        // The box grown by the lamp's breadth as seen from here, against the ray to the lamp's middle.
        let breadth = self.key.breadth() * min.abs().max(max.abs()).length();
        let inverse = self.key.toward.recip();
        let (a, b) = ((min - breadth) * inverse, (max + breadth) * inverse);
        let shaded = a.min(b).max_element().max(0.0) <= a.max(b).min_element();
        let gap = min.max(-max).max(Vec3::ZERO).length();
        !shaded && gap > self.reach()
    }

    /// No lamps, and the same light from everywhere: a surface that reflects all of it cannot be seen.
    #[cfg(test)]
    pub fn furnace(view: &CameraFrame, bounds: Bounds, level: f32) -> Self {
        let mut lighting = Self::new(view, bounds, false);
        (lighting.key.colour, lighting.rim.colour, lighting.fill) = (Vec3::ZERO, Vec3::ZERO, Vec3::ZERO);
        (lighting.sky, lighting.ground) = (Vec3::splat(level), Vec3::splat(level));
        lighting
    }
}

/// A floor that curves up into a wall behind the subject, so that no line parts them.
#[derive(Debug, Clone, Copy)]
pub struct CurvedBackdrop {
    /// The subject's middle on the floor.
    pub centre: Vec3,
    /// Level, away from the camera.
    pub away: Vec3,
    /// The subject's height, the measure of everything here (m).
    size: f32,
    pub floor: bool,
}

/// Where the curve starts behind the subject, in subject heights.
pub const DEPTH: f32 = 0.75;

/// Radius of the curve, in subject heights: so wide that the preset cameras see no end of it, nor a line where it ends.
pub const CURVE: f32 = 2.4;

/// Distance over which the light around the subject falls to half, in subject heights.
pub const POOL: f32 = 2.3;

impl CurvedBackdrop {
    fn new(view: &CameraFrame, bounds: Bounds, floor: bool) -> Self {
        let bounds = if bounds.is_empty() { Bounds { min: Vec3::ZERO, max: Vec3::Y } } else { bounds };
        let centre = (bounds.min + bounds.max) * 0.5;
        let size = bounds.max.y.max((bounds.max - bounds.min).max_element()).max(0.05);
        let away = Vec3::new(view.forward.x, 0.0, view.forward.z).normalize_or(Vec3::NEG_Z);
        Self { centre: Vec3::new(centre.x, 0.0, centre.z), away, size, floor }
    }

    /// The subject's height (m), the measure of everything here.
    pub fn size(&self) -> f32 {
        self.size
    }

    /// Where a ray meets the backdrop: distance and the normal that faces into the room. The wall has no top, so rays that
    /// lead away from it meet it far behind the camera: they are given a place far ahead.
    pub fn meet(&self, ray: &Ray) -> (f32, Vec3) {
        let (depth, radius) = (DEPTH * self.size, CURVE * self.size);
        let (w, y) = ((ray.origin - self.centre).dot(self.away), ray.origin.y);
        let (dw, dy) = (ray.direction.dot(self.away), ray.direction.y);
        if self.floor {
            let floor = -y / dy;
            if dy < 0.0 && floor > 0.0 && w + floor * dw <= depth {
                return (floor, Vec3::Y);
            }
            // The far side of the cylinder whose axis runs across at (depth, radius).
            let (cw, cy) = (w - depth, y - radius);
            let (a, b, c) = (dw * dw + dy * dy, cw * dw + cy * dy, cw * cw + cy * cy - radius * radius);
            let root = b * b - a * c;
            let curve = (root.max(0.0).sqrt() - b) / a;
            let (hw, hy) = (cw + curve * dw, cy + curve * dy);
            if root >= 0.0 && curve > 0.0 && hw >= 0.0 && hy <= 0.0 {
                return (curve, (-self.away * hw - Vec3::Y * hy) / radius);
            }
        }
        let wall = (depth + radius - w) / dw;
        (if dw > 0.0 && wall > 0.0 { wall } else { 1e3 * self.size }, -self.away)
    }

    /// Brightness of the light on the backdrop at a place (1 at the subject).
    pub fn pool(&self, place: Vec3) -> f32 {
        let from = place - self.centre - Vec3::Y * (0.5 * self.size);
        let level = from - self.away * from.dot(self.away);
        let far = (level.length_squared() + 0.15 * from.length_squared()) / (POOL * self.size).powi(2);
        1.0 / (1.0 + far)
    }
}
