//! Rays: what each pixel sees (survey), and the light that reaches it (expose).

use glam::{Vec2, Vec3};

use crate::{
    image::Size,
    sample::{Sample, Use, disc},
    scene::View,
    shade::Place,
    stage::Stage,
    studio::{Lamp, PAINT, Studio},
    tree::{Hit, Ray},
};

/// Gap between a surface and the rays that leave it, in subject heights.
const LIFT: f32 = 5e-5;

/// Least cosine between a shading normal and the eye: interpolated normals may turn away at the outline.
pub const LEAST_FACING: f32 = 0.02;

/// Cosine between the normals of neighbouring pixels below which an edge runs between them.
const CREASE: f32 = 0.8;

/// Distance of a neighbour from a pixel's plane beyond which an edge runs between them, in pixels.
const STEP: f32 = 2.0;

/// Weight of red, green and blue in brightness (Rec. 709).
const LUMA: Vec3 = Vec3::new(0.2126, 0.7152, 0.0722);

/// What owns a pixel that sees the cove.
const COVE: u32 = u32::MAX;

/// Work spent on each pixel.
#[derive(Debug, Clone, Copy)]
pub struct Plan {
    /// Samples of a pixel that sees one smooth thing.
    pub inside: u32,
    /// Samples of a pixel on an edge.
    pub edge: u32,
    /// How far shadows are smoothed over like neighbours (pixels).
    pub reach: i32,
}

/// What stands in the middle of a pixel.
#[derive(Debug, Clone, Copy, Default)]
pub struct Guide {
    /// Which surface.
    pub owner: u32,
    /// Where it is (m).
    pub position: Vec3,
    /// Its unit shading normal.
    pub normal: Vec3,
}

/// Light and shadow of one pixel, apart, so that shadows can be smoothed and colours stay sharp: the ratio estimator
/// of Heitz, Hill and McGuire (2018, "Combining analytic direct illumination and stochastic shadows").
#[derive(Debug, Clone, Copy, Default)]
pub struct Texel {
    /// Light from the key and the rim lamp as if nothing stood in its way.
    pub lamps: [Vec3; 2],
    /// Brightness of that light that does arrive, and of all of it.
    pub arrived: [[f32; 2]; 2],
    /// Ambient light where all of it arrives, and where none does but what is reflected nearby.
    pub ambient: [Vec3; 2],
    /// Share of ambient light that arrives.
    pub open: f32,
    /// True where unlike things meet.
    pub edge: bool,
    /// True where no shadow can fall.
    pub clear: bool,
    /// Rays walked through the tree.
    pub rays: u32,
}

/// One exposure: what all its pixels share.
pub struct Shot<'a> {
    stage: &'a Stage<'a>,
    studio: Studio,
    view: View,
    pub size: Size,
    pub plan: Plan,
    lift: f32,
}

impl<'a> Shot<'a> {
    pub fn new(stage: &'a Stage<'a>, studio: Studio, view: View, size: Size, plan: Plan) -> Self {
        Self { stage, studio, view, size, plan, lift: LIFT * studio.cove.size() }
    }

    /// First pass: what is in the middle of each pixel of a row.
    pub fn survey(&self, y: u32, row: &mut [Guide]) {
        for (x, guide) in (0..).zip(row) {
            let ray = self.ray(x, y, Vec2::splat(0.5));
            *guide = match self.stage.tree.closest(&ray, f32::INFINITY) {
                Some(hit) => {
                    let (owner, place) = self.place(&ray, hit);
                    Guide { owner, position: ray.origin + ray.direction * hit.distance, normal: place.normal }
                }
                None => {
                    let place = self.backdrop(&ray);
                    Guide { owner: COVE, position: place.position, normal: place.normal }
                }
            };
        }
    }

    /// Second pass: light and shadow of each pixel of a row.
    pub fn expose(&self, y: u32, guides: &[Guide], row: &mut [Texel]) {
        for (x, texel) in (0..).zip(row) {
            let guide = &guides[self.index(x, y)];
            texel.edge = self.on_edge(x, y, guide, guides);
            texel.clear = !texel.edge && guide.owner == COVE && self.studio.clear(guide.position);
            let samples = match (texel.edge, texel.clear) {
                (true, _) => self.plan.edge,
                (false, true) => 1,
                (false, false) => self.plan.inside,
            };
            for number in 0..samples {
                let sample = Sample::new(x, y, number);
                let at = if texel.clear { Vec2::splat(0.5) } else { sample.pair(Use::Pixel).map(tent) };
                self.look(&self.ray(x, y, at), sample, texel);
            }
            let share = 1.0 / samples as f32;
            texel.lamps = texel.lamps.map(|l| l * share);
            texel.ambient = texel.ambient.map(|a| a * share);
            texel.arrived = texel.arrived.map(|a| a.map(|a| a * share));
            texel.open *= share;
        }
    }

    /// Distance between neighbouring pixels at a place (m).
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

    /// True if a pixel next to this one sees something unlike.
    fn on_edge(&self, x: u32, y: u32, guide: &Guide, guides: &[Guide]) -> bool {
        let (columns, rows) = (x.saturating_sub(1)..=x + 1, y.saturating_sub(1)..=y + 1);
        let step = STEP * self.grain(guide.position);
        rows.filter(|&y| y < self.size.height).any(|y| {
            columns.clone().filter(|&x| x < self.size.width).any(|x| {
                let other = &guides[self.index(x, y)];
                let away = guide.normal.dot(other.position - guide.position).abs();
                let bent = guide.normal.dot(other.normal) < CREASE || away > step;
                other.owner != guide.owner || (bent && guide.owner != COVE)
            })
        })
    }

    /// Adds what one ray sees to a pixel.
    fn look(&self, ray: &Ray, sample: Sample, texel: &mut Texel) {
        if !texel.clear {
            texel.rays += 1;
            if let Some(hit) = self.stage.tree.closest(ray, f32::INFINITY) {
                return self.light(&self.place(ray, hit).1, Vec3::ONE, sample, texel);
            }
        }
        let place = self.backdrop(ray);
        self.light(&place, Vec3::splat(self.studio.cove.pool(place.position)), sample, texel);
    }

    /// Adds the light that a place sends to the eye, times `filter`.
    fn light(&self, place: &Place, filter: Vec3, sample: Sample, texel: &mut Texel) {
        let painted = !texel.clear && (place.on_subject || !self.studio.clear(place.position));
        let lamps: [(&Lamp, Use); 2] = [(&self.studio.key, Use::Key), (&self.studio.rim, Use::Rim)];
        // The cove stands out of the rim lamp's beam.
        for (i, (lamp, use_)) in (0..).zip(lamps).take(if place.on_subject { 2 } else { 1 }) {
            let light = place.reflect(lamp.middle()) * lamp.colour * filter;
            let brightness = light.dot(LUMA);
            if brightness <= 0.0 {
                continue;
            }
            let arrives = !painted || self.open(place, lamp.direction(sample.pair(use_)), f32::INFINITY, texel);
            texel.lamps[i] += light;
            texel.arrived[i][0] += if arrives { brightness } else { 0.0 };
            texel.arrived[i][1] += brightness;
        }
        let mirrored = 2.0 * place.normal.dot(place.eye) * place.normal - place.eye;
        let ambient = place.glow(self.studio.ambient(place.normal), self.studio.ambient(mirrored)) * filter;
        texel.ambient[0] += ambient;
        texel.ambient[1] += ambient * place.bounce();
        texel.open += if !painted || self.breathes(place, sample, texel) { 1.0 } else { 0.0 };
    }

    /// True if nothing lies in this direction nearer than `limit` (m).
    fn open(&self, place: &Place, toward: Vec3, limit: f32, texel: &mut Texel) -> bool {
        texel.rays += 1;
        !self.stage.tree.blocked(&Ray::new(place.position + place.flat * self.lift, toward), limit)
    }

    /// True if ambient light reaches a place along one cosine-weighted ray. The ray's reach is drawn too, so that an
    /// occluder's weight falls off linearly with its distance.
    fn breathes(&self, place: &Place, sample: Sample, texel: &mut Texel) -> bool {
        let at = disc(sample.pair(Use::Ambient));
        let (a, b) = place.normal.any_orthonormal_pair();
        let up = (1.0 - at.length_squared()).max(0.0).sqrt();
        let toward = a * at.x + b * at.y + place.normal * up;
        // Interpolated normals send some rays below their own triangle: those are mirrored out of it.
        let toward = toward - place.flat * (2.0 * toward.dot(place.flat).min(0.0));
        self.open(place, toward, self.studio.reach() * sample.pair(Use::Reach).x, texel)
    }

    /// The place on the cove that a ray meets; one straight ahead where it meets none.
    fn backdrop(&self, ray: &Ray) -> Place {
        let (distance, normal) = self.studio.cove.meet(ray);
        Place::painted(ray.origin + ray.direction * distance, normal, PAINT, -ray.direction)
    }

    /// The place on the subject that a ray met, and which surface it is on.
    fn place(&self, ray: &Ray, hit: Hit) -> (u32, Place) {
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
        let eye = -ray.direction;
        let place = Place {
            position: rounded(blend(points, weights), points, normals, weights),
            normal: facing(blend(normals, weights).normalize_or(flat), eye),
            flat,
            colour: surface.colours.blend(corners, weights),
            material: surface.material,
            eye,
            on_subject: true,
        };
        (owner as u32, place)
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
