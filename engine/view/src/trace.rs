//! The picture: rays from the eye, shadows, occlusion, and the pixels they add up to.
//!
//! Every number that jitters comes from the pixel and the sample's number (`sample`), so a picture has the same bytes
//! for any number of threads.

use std::{
    num::NonZero,
    sync::{
        Mutex, PoisonError,
        atomic::{AtomicU64, Ordering},
    },
    thread,
};

use glam::{Vec2, Vec3};

use crate::{
    image::{Image, Size},
    sample::{MOST_SAMPLES, Sample, Use, mix},
    scene::{Bounds, Camera, Scene, Surface, View},
    shade::Place,
    studio::{PAINT, Studio},
    tone,
    tree::{Hit, Ray, Tree},
};

/// Gap between a surface and the rays that leave it (m), under the subject's size times this.
const LIFT: f32 = 5e-5;

/// Least cosine between a shading normal and the eye: interpolated normals may turn away at the outline.
const LEAST_FACING: f32 = 0.02;

/// Weight of red, green and blue in brightness (Rec. 709).
const LUMA: Vec3 = Vec3::new(0.2126, 0.7152, 0.0722);

/// How much work a picture is worth.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Quality {
    /// To be looked at: pixels take samples until their noise is about two steps of a byte.
    Still,
    /// One frame of an animation: four samples a pixel.
    Motion,
}

/// Samples of a pixel.
#[derive(Debug, Clone, Copy)]
struct Plan {
    /// Samples every pixel takes.
    least: u32,
    /// Samples none exceeds.
    most: u32,
    /// Standard error of the brightness (square root of linear, 0..1) that is good enough.
    tolerance: f32,
}

impl Quality {
    fn plan(self) -> Plan {
        match self {
            Self::Still => Plan { least: 8, most: MOST_SAMPLES, tolerance: 0.009 },
            Self::Motion => Plan { least: 4, most: 4, tolerance: 1.0 },
        }
    }
}

/// Renders one picture: builds the tree and looks once. Several views of one scene share a [`Stage`].
pub fn render(scene: &Scene<'_>, camera: &Camera, size: Size, quality: Quality) -> Image {
    Stage::build(*scene).render(camera, size, quality)
}

/// A scene made ready to be looked at, from any number of cameras.
#[derive(Debug)]
pub struct Stage<'a> {
    scene: Scene<'a>,
    tree: Tree,
    /// First triangle of each surface in the tree's numbering.
    starts: Vec<u32>,
}

/// One picture's cost.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Cost {
    /// Rays walked through the tree: from the eye, for shadows, for occlusion.
    pub rays: u64,
}

impl<'a> Stage<'a> {
    /// Builds the tree over every triangle of the scene that has three finite corners and an area.
    pub fn build(scene: Scene<'a>) -> Self {
        let mut starts = Vec::with_capacity(scene.surfaces.len());
        let mut next = 0;
        for surface in scene.surfaces {
            starts.push(next);
            next += surface.triangles.len() as u32;
        }
        let corner = |s: &Surface<'_>, i: u32| s.positions.get(i as usize).copied().unwrap_or(Vec3::NAN);
        let faces = scene.surfaces.iter().flat_map(|s| s.triangles.iter().map(move |t| t.map(|i| corner(s, i))));
        Self { scene, tree: Tree::build(faces), starts }
    }

    /// The box around everything that can be seen.
    pub fn bounds(&self) -> Bounds {
        self.tree.bounds()
    }

    /// The picture from one camera, on all cores.
    pub fn render(&self, camera: &Camera, size: Size, quality: Quality) -> Image {
        self.render_on(thread::available_parallelism().map_or(1, NonZero::get), camera, size, quality).0
    }

    /// The picture and its cost, on this many threads; the bytes do not depend on how many.
    pub fn render_on(&self, threads: usize, camera: &Camera, size: Size, quality: Quality) -> (Image, Cost) {
        let view = camera.view(size.width as f32 / size.height.max(1) as f32);
        let studio = Studio::new(&view, self.bounds(), self.scene.floor);
        Shot { stage: self, studio, view, size, plan: quality.plan(), lift: LIFT * studio.scale() }.expose(threads)
    }
}

/// One exposure: what every pixel of it shares.
struct Shot<'a> {
    stage: &'a Stage<'a>,
    studio: Studio,
    view: View,
    size: Size,
    plan: Plan,
    lift: f32,
}

impl Shot<'_> {
    /// Develops all rows; each thread takes the next row that nobody has taken.
    fn expose(&self, threads: usize) -> (Image, Cost) {
        let mut image = Image::filled(self.size, [0; 3]);
        let rays = AtomicU64::new(0);
        let rows = Mutex::new(image.rows_mut().enumerate());
        thread::scope(|scope| {
            for _ in 0..threads.max(1) {
                scope.spawn(|| {
                    let mut mine = 0;
                    loop {
                        let next = rows.lock().unwrap_or_else(PoisonError::into_inner).next();
                        let Some((y, row)) = next else { break };
                        self.row(y as u32, row, &mut mine);
                    }
                    // Relaxed: a sum that is read only after the scope has joined every thread.
                    rays.fetch_add(mine, Ordering::Relaxed);
                });
            }
        });
        drop(rows);
        (image, Cost { rays: rays.into_inner() })
    }

    fn row(&self, y: u32, row: &mut [u8], rays: &mut u64) {
        for (x, pixel) in (0..).zip(row.chunks_exact_mut(3)) {
            let light = self.pixel(x, y, rays);
            // Half a byte of noise hides the steps of the backdrop's gradient.
            let dither = (mix(x ^ mix(y)) >> 8) as f32 / (1 << 24) as f32 - 0.5;
            pixel.copy_from_slice(&tone::bytes(light, dither));
        }
    }

    /// Display light of one pixel: samples are added until their mean is sure enough.
    fn pixel(&self, x: u32, y: u32, rays: &mut u64) -> Vec3 {
        let scale = Vec2::new(1.0 / self.size.width as f32, 1.0 / self.size.height as f32);
        let (mut sum, mut first, mut second) = (Vec3::ZERO, 0.0, 0.0);
        let mut count = 0;
        let mut check = self.plan.least;
        while count < self.plan.most {
            let sample = Sample::new(x, y, count);
            let at = (Vec2::new(x as f32, y as f32) + sample.pair(Use::Pixel).map(tent)) * scale;
            let ray = Ray::new(self.view.origin, self.view.direction(at));
            let light = tone::compress(self.look(&ray, sample, rays));
            let brightness = light.dot(LUMA).max(0.0).sqrt();
            (sum, first, second) = (sum + light, first + brightness, second + brightness * brightness);
            count += 1;
            if count == check {
                let n = count as f32;
                let variance = (second - first * first / n).max(0.0) / (n - 1.0);
                if variance <= self.plan.tolerance * self.plan.tolerance * n {
                    break;
                }
                check *= 2;
            }
        }
        sum / count as f32
    }

    /// Light that comes to the eye along a ray.
    fn look(&self, ray: &Ray, sample: Sample, rays: &mut u64) -> Vec3 {
        *rays += 1;
        match self.stage.tree.closest(ray, f32::INFINITY) {
            Some(hit) => self.subject(&self.place(ray, hit), sample, rays),
            None => self.backdrop(ray, sample, rays),
        }
    }

    /// Light from the subject.
    fn subject(&self, place: &Place, sample: Sample, rays: &mut u64) -> Vec3 {
        let mut light = Vec3::ZERO;
        for (lamp, use_) in [(&self.studio.key, Use::Key), (&self.studio.rim, Use::Rim)] {
            let toward = lamp.direction(sample.pair(use_));
            let share = place.reflect(toward);
            if share != Vec3::ZERO && self.open(place, toward, f32::INFINITY, rays) {
                light += share * lamp.colour;
            }
        }
        let mirrored = 2.0 * place.normal.dot(place.eye) * place.normal - place.eye;
        let glow = place.glow(self.studio.ambient(place.normal), self.studio.ambient(mirrored));
        light + glow * self.openness(place, sample, rays)
    }

    /// Light from the cove, with the subject's shadow on it.
    fn backdrop(&self, ray: &Ray, sample: Sample, rays: &mut u64) -> Vec3 {
        let cove = &self.studio.cove;
        let Some((distance, normal)) = cove.meet(ray) else { return cove.beyond() };
        let position = ray.origin + ray.direction * distance;
        let place = Place::painted(position, normal, PAINT, -ray.direction);
        let key = &self.studio.key;
        let mut light = key.colour * normal.dot(key.middle()).max(0.0);
        let mut around = self.studio.ambient(normal);
        if cove.takes_shadow() {
            if !self.open(&place, key.direction(sample.pair(Use::Key)), f32::INFINITY, rays) {
                light = Vec3::ZERO;
            }
            around *= self.openness(&place, sample, rays);
        }
        PAINT * (light + around) * cove.pool(position)
    }

    /// True if nothing lies in this direction nearer than `limit` (m).
    fn open(&self, place: &Place, toward: Vec3, limit: f32, rays: &mut u64) -> bool {
        *rays += 1;
        let ray = Ray::new(place.position + place.flat * self.lift, toward);
        !self.stage.tree.blocked(&ray, limit)
    }

    /// Share of ambient light that reaches a place: one cosine-weighted ray. Its reach is drawn too, so that an
    /// occluder's weight falls off linearly with its distance.
    fn openness(&self, place: &Place, sample: Sample, rays: &mut u64) -> Vec3 {
        let at = sample.pair(Use::Ambient);
        let (sin, cos) = (std::f32::consts::TAU * at.y).sin_cos();
        let radius = at.x.sqrt();
        let (a, b) = place.normal.any_orthonormal_pair();
        let up = (1.0 - at.x).max(0.0).sqrt();
        let toward = a * (radius * cos) + b * (radius * sin) + place.normal * up;
        // Interpolated normals send some rays below their own triangle: those are mirrored out of it.
        let toward = toward - place.flat * (2.0 * toward.dot(place.flat).min(0.0));
        let reach = self.studio.reach * sample.pair(Use::Reach).x;
        if self.open(place, toward, reach, rays) { Vec3::ONE } else { place.bounce() }
    }

    /// What the ray met.
    fn place(&self, ray: &Ray, hit: Hit) -> Place {
        let starts = &self.stage.starts;
        let owner = starts.partition_point(|&s| s <= hit.triangle) - 1;
        let surface = &self.stage.scene.surfaces[owner];
        let corners = surface.triangles[(hit.triangle - starts[owner]) as usize];
        let weights = [1.0 - hit.u - hit.v, hit.u, hit.v];
        let points = corners.map(|i| surface.positions[i as usize]);
        let flat = (points[1] - points[0]).cross(points[2] - points[0]).normalize_or(Vec3::Y);
        // Both sides of every surface are lit: the normals turn to the eye.
        let side = if flat.dot(ray.direction) > 0.0 { -1.0 } else { 1.0 };
        let flat = flat * side;
        let normals = corners.map(|i| {
            let normal = surface.normals.get(i as usize).copied().unwrap_or(Vec3::ZERO) * side;
            if normal.is_finite() && normal.dot(flat) > 0.0 { normal } else { flat }
        });
        let met = blend(points, weights);
        let eye = -ray.direction;
        Place {
            position: rounded(met, points, normals, weights),
            normal: facing(blend(normals, weights).normalize_or(flat), eye),
            flat,
            colour: blend(corners.map(|i| surface.colours.at(i)), weights),
            material: surface.material,
            eye,
        }
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
