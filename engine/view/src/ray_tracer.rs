//! The two passes that trace rays: the first hit of each pixel, and the light that reaches it.

use glam::{Vec2, Vec3};

use crate::{
    bvh::{Hit, Ray},
    image::Size,
    lighting::{AreaLight, Lighting, PAINT},
    sampling::{PixelSample, SampleDimension, disc},
    scene::CameraFrame,
    shading::SurfacePoint,
    traced_scene::TracedScene,
};

/// Gap between a surface and the rays that leave it, in subject heights.
const RAY_OFFSET: f32 = 5e-5;

/// Least cosine between a shading normal and the direction to the camera: interpolated normals may turn away at the outline.
pub const LEAST_FACING: f32 = 0.02;

/// Cosine between the normals of neighbouring pixels below which an edge runs between them.
const CREASE: f32 = 0.8;

/// Distance of a neighbour from a pixel's plane beyond which an edge runs between them, in pixels.
const STEP: f32 = 2.0;

/// Weight of red, green and blue in brightness (Rec. 709).
const LUMA: Vec3 = Vec3::new(0.2126, 0.7152, 0.0722);

/// The surface number of a pixel that sees the backdrop.
const BACKDROP: u32 = u32::MAX;

/// Samples of each pixel, and the width of the shadow filter.
#[derive(Debug, Clone, Copy)]
pub struct SampleCounts {
    /// Samples of a pixel within one smooth surface.
    pub inside: u32,
    /// Samples of a pixel on an edge.
    pub edge: u32,
    /// Radius of the shadow filter (pixels).
    pub reach: i32,
}

/// First hit of the ray through a pixel's middle.
#[derive(Debug, Clone, Copy, Default)]
pub struct PrimaryHit {
    /// Index of the surface; [`BACKDROP`] for the backdrop.
    pub owner: u32,
    /// Position in the world (m).
    pub position: Vec3,
    /// Unit shading normal.
    pub normal: Vec3,
}

/// Light and shadow of one pixel, apart, so that shadows can be smoothed and colours stay sharp: the ratio estimator
/// of Heitz, Hill and McGuire (2018, "Combining analytic direct illumination and stochastic shadows").
#[derive(Debug, Clone, Copy, Default)]
pub struct PixelLight {
    /// Light from the key and the rim light without shadows, linear RGB.
    pub lamps: [Vec3; 2],
    /// Luminance of the unshadowed samples of each light, and of all its samples.
    pub arrived: [[f32; 2]; 2],
    /// Ambient light without occlusion, and with full occlusion (reflected by what is near), linear RGB.
    pub ambient: [Vec3; 2],
    /// Fraction of ambient light that is not occluded.
    pub open: f32,
    /// True at an edge between surfaces or at a crease.
    pub edge: bool,
    /// True where no shadow can fall, so that no shadow rays are traced.
    pub clear: bool,
    /// Rays that were traced for its light.
    pub rays: u32,
}

/// Layers of sheer cloth that a ray goes through at most.
const MOST_LAYERS: usize = 8;

/// Fraction of the golden section.
const GOLDEN: f32 = 0.618_034;

/// Data shared by all pixels of one picture.
pub struct RayTracer<'a> {
    scene: &'a TracedScene<'a>,
    lighting: Lighting,
    view: CameraFrame,
    pub size: Size,
    pub samples: SampleCounts,
    ray_offset: f32,
}

impl<'a> RayTracer<'a> {
    pub fn new(
        scene: &'a TracedScene<'a>,
        lighting: Lighting,
        view: CameraFrame,
        size: Size,
        samples: SampleCounts,
    ) -> Self {
        Self { scene, lighting, view, size, samples, ray_offset: RAY_OFFSET * lighting.backdrop.size() }
    }

    /// First pass: what is in the middle of each pixel of a row.
    pub fn trace_primary(&self, y: u32, row: &mut [PrimaryHit]) {
        for (x, hit_here) in (0..).zip(row) {
            let ray = self.ray(x, y, Vec2::splat(0.5));
            *hit_here = match self.scene.bvh.closest(&ray, f32::INFINITY) {
                Some(hit) => {
                    let (owner, point) = self.point(&ray, hit);
                    PrimaryHit { owner, position: ray.origin + ray.direction * hit.distance, normal: point.normal }
                }
                None => {
                    let point = self.backdrop(&ray);
                    PrimaryHit { owner: BACKDROP, position: point.position, normal: point.normal }
                }
            };
        }
    }

    /// Second pass: light and shadow of each pixel of a row.
    pub fn trace_light(&self, y: u32, hits: &[PrimaryHit], row: &mut [PixelLight]) {
        for (x, light_here) in (0..).zip(row) {
            let hit_here = &hits[self.index(x, y)];
            light_here.edge = self.is_on_edge(x, y, hit_here, hits);
            light_here.clear = !light_here.edge && hit_here.owner == BACKDROP && self.lighting.clear(hit_here.position);
            let samples = match (light_here.edge, light_here.clear) {
                (true, _) => self.samples.edge,
                (false, true) => 1,
                (false, false) => self.samples.inside,
            };
            for number in 0..samples {
                let sample = PixelSample::new(x, y, number);
                let at =
                    if light_here.clear { Vec2::splat(0.5) } else { sample.pair(SampleDimension::Pixel).map(tent) };
                self.add_ray(&self.ray(x, y, at), sample, light_here);
            }
            let share = 1.0 / samples as f32;
            light_here.lamps = light_here.lamps.map(|l| l * share);
            light_here.ambient = light_here.ambient.map(|a| a * share);
            light_here.arrived = light_here.arrived.map(|a| a.map(|a| a * share));
            light_here.open *= share;
        }
    }

    /// Distance between neighbouring pixels at a point (m).
    pub fn grain(&self, position: Vec3) -> f32 {
        self.view.width_at(position) / self.size.width as f32
    }

    fn index(&self, x: u32, y: u32) -> usize {
        y as usize * self.size.width as usize + x as usize
    }

    fn ray(&self, x: u32, y: u32, at: Vec2) -> Ray {
        let scale = Vec2::new(1.0 / self.size.width as f32, 1.0 / self.size.height as f32);
        Ray::new(self.view.origin, self.view.direction((Vec2::new(x as f32, y as f32) + at) * scale))
    }

    /// True if a neighbouring pixel belongs to another surface or lies beyond a crease.
    fn is_on_edge(&self, x: u32, y: u32, hit_here: &PrimaryHit, hits: &[PrimaryHit]) -> bool {
        let (columns, rows) = (x.saturating_sub(1)..=x + 1, y.saturating_sub(1)..=y + 1);
        let step = STEP * self.grain(hit_here.position);
        rows.filter(|&y| y < self.size.height).any(|y| {
            columns.clone().filter(|&x| x < self.size.width).any(|x| {
                let other = &hits[self.index(x, y)];
                let away = hit_here.normal.dot(other.position - hit_here.position).abs();
                let bent = hit_here.normal.dot(other.normal) < CREASE || away > step;
                other.owner != hit_here.owner || (bent && hit_here.owner != BACKDROP)
            })
        })
    }

    /// Adds the light along one ray to a pixel.
    fn add_ray(&self, ray: &Ray, sample: PixelSample, light_here: &mut PixelLight) {
        if !light_here.clear {
            light_here.rays += 1;
            if let Some((ray, hit)) = self.closest(ray, sample) {
                let ray = &ray;
                return self.add_light(&self.point(ray, hit).1, Vec3::ONE, sample, light_here);
            }
        }
        let point = self.backdrop(ray);
        self.add_light(&point, Vec3::splat(self.lighting.backdrop.pool(point.position)), sample, light_here);
    }

    /// Adds the light that a point sends to the camera, times `filter`.
    fn add_light(&self, point: &SurfacePoint, filter: Vec3, sample: PixelSample, light_here: &mut PixelLight) {
        let painted = !light_here.clear && (point.on_subject || !self.lighting.clear(point.position));
        let lamps: [(&AreaLight, SampleDimension); 2] =
            [(&self.lighting.key, SampleDimension::Key), (&self.lighting.rim, SampleDimension::Rim)];
        // The backdrop stands out of the rim lamp's beam.
        for (i, (lamp, dimension)) in (0..).zip(lamps).take(if point.on_subject { 2 } else { 1 }) {
            let light = point.reflect(lamp.middle()) * lamp.colour * filter;
            let brightness = light.dot(LUMA);
            if brightness <= 0.0 {
                continue;
            }
            let toward = lamp.direction(sample.pair(dimension));
            let arrives = !painted || self.is_unblocked(point, toward, f32::INFINITY, sample, light_here);
            light_here.lamps[i] += light;
            light_here.arrived[i][0] += if arrives { brightness } else { 0.0 };
            light_here.arrived[i][1] += brightness;
        }
        let mirrored = 2.0 * point.normal.dot(point.eye) * point.normal - point.eye;
        let ambient = point.glow(self.lighting.ambient(point.normal), self.lighting.ambient(mirrored)) * filter;
        light_here.ambient[0] += ambient;
        light_here.ambient[1] += ambient * point.bounce();
        light_here.open += if !painted || self.ambient_visible(point, sample, light_here) { 1.0 } else { 0.0 };
    }

    /// True if nothing lies in this direction nearer than `limit` (m).
    fn is_unblocked(
        &self,
        point: &SurfacePoint,
        toward: Vec3,
        limit: f32,
        sample: PixelSample,
        light_here: &mut PixelLight,
    ) -> bool {
        light_here.rays += 1;
        let ray = Ray::new(point.position + point.flat * self.ray_offset, toward);
        if !self.scene.sheer {
            return !self.scene.bvh.blocked(&ray, limit);
        }
        match self.closest(&ray, sample) {
            Some((from, hit)) => (from.origin - ray.origin).length() + hit.distance > limit,
            None => true,
        }
    }

    /// The nearest thing that holds a ray back, and the last part of the ray: between the threads of sheer cloth some go on.
    fn closest(&self, ray: &Ray, sample: PixelSample) -> Option<(Ray, Hit)> {
        let hit = self.scene.bvh.closest(ray, f32::INFINITY)?;
        if !self.scene.sheer {
            return Some((*ray, hit));
        }
        let (mut ray, mut hit) = (*ray, hit);
        let mut draw = sample.pair(SampleDimension::Gap).x;
        for _ in 0..MOST_LAYERS {
            let look = self.scene.scene.surfaces[self.scene.owner(hit.triangle)].look;
            if draw < look.map_or(1.0, |look| look.opacity) {
                break;
            }
            // Each layer draws anew: steps of the golden section fill the interval evenly.
            draw = (draw + GOLDEN).fract();
            ray = Ray::new(ray.origin + ray.direction * (hit.distance + self.ray_offset), ray.direction);
            hit = self.scene.bvh.closest(&ray, f32::INFINITY)?;
        }
        Some((ray, hit))
    }

    /// True if ambient light reaches a point along one cosine-weighted ray. The ray's reach is drawn too, so that an
    /// occluder's weight falls off linearly with its distance.
    fn ambient_visible(&self, point: &SurfacePoint, sample: PixelSample, light_here: &mut PixelLight) -> bool {
        let at = disc(sample.pair(SampleDimension::Ambient));
        let (a, b) = point.normal.any_orthonormal_pair();
        let up = (1.0 - at.length_squared()).max(0.0).sqrt();
        let toward = a * at.x + b * at.y + point.normal * up;
        // Interpolated normals send some rays below their own triangle: those are mirrored out of it.
        let toward = toward - point.flat * (2.0 * toward.dot(point.flat).min(0.0));
        self.is_unblocked(
            point,
            toward,
            self.lighting.reach() * sample.pair(SampleDimension::Reach).x,
            sample,
            light_here,
        )
    }

    /// The point on the backdrop that a ray meets; one straight ahead where it meets none.
    fn backdrop(&self, ray: &Ray) -> SurfacePoint {
        let (distance, normal) = self.lighting.backdrop.meet(ray);
        SurfacePoint::painted(ray.origin + ray.direction * distance, normal, PAINT, -ray.direction)
    }

    /// The point on the subject that a ray met, and which surface it is on.
    fn point(&self, ray: &Ray, hit: Hit) -> (u32, SurfacePoint) {
        let owner = self.scene.owner(hit.triangle);
        let surface = &self.scene.scene.surfaces[owner];
        let triangle = (hit.triangle - self.scene.starts[owner]) as usize;
        let corners = surface.triangles[triangle];
        let weights = [1.0 - hit.u - hit.v, hit.u, hit.v];
        let points = corners.map(|i| surface.positions[i as usize]);
        let twice_area = (points[1] - points[0]).cross(points[2] - points[0]);
        let flat = twice_area.normalize_or(Vec3::Y);
        // Both sides of every surface are lit: the normals turn to the eye.
        let side = if flat.dot(ray.direction) > 0.0 { -1.0 } else { 1.0 };
        let flat = flat * side;
        let normals = corners.map(|i| {
            let normal = surface.normals.get(i as usize).copied().unwrap_or(Vec3::ZERO) * side;
            if normal.is_finite() && normal.dot(flat) > 0.0 { normal } else { flat }
        });
        let eye = -ray.direction;
        let ground = surface.colours.blend(corners, weights);
        let colour = match &surface.look {
            Some(look) => {
                let (size, pixel) = (twice_area.length().sqrt(), self.grain(blend(points, weights)));
                look.colour(triangle, weights, ground, size, pixel)
            }
            None => ground,
        };
        let point = SurfacePoint {
            position: rounded(blend(points, weights), points, normals, weights),
            normal: facing(blend(normals, weights).normalize_or(flat), eye),
            flat,
            colour,
            material: surface.material,
            eye,
            on_subject: true,
        };
        (owner as u32, point)
    }
}

fn blend(values: [Vec3; 3], weights: [f32; 3]) -> Vec3 {
    values[0] * weights[0] + values[1] * weights[1] + values[2] * weights[2]
}

/// Lifts a point of a flat triangle onto the curved surface its normals mean, which keeps the facets of the mesh out of
/// the soft edge of its own shadow (Hanika 2021, "Hacking the shadow terminator", Ray Tracing Gems II, chapter 4).
fn rounded(point: Vec3, corners: [Vec3; 3], normals: [Vec3; 3], weights: [f32; 3]) -> Vec3 {
    let lifts = std::array::from_fn(|i| normals[i] * (point - corners[i]).dot(normals[i]).min(0.0));
    point - blend(lifts, weights)
}

/// The normal, tilted towards the eye where it would turn away from it.
fn facing(normal: Vec3, eye: Vec3) -> Vec3 {
    let missing = LEAST_FACING - normal.dot(eye);
    if missing > 0.0 { (normal + eye * missing).normalize() } else { normal }
}

/// Warps a uniform number into a tent one and a half pixels wide around the pixel's middle: smoother edges than a box.
fn tent(x: f32) -> f32 {
    let side = if x < 0.5 { (2.0 * x).sqrt() - 1.0 } else { 1.0 - (2.0 - 2.0 * x).sqrt() };
    0.5 + 0.75 * side
}
