//! Cloth into the picture: its colour in the picture's light, what lies before it left out, edges soft, shadows around it.

use glam::{Vec2, Vec3};
use toile_sensors::colour_camera::ColourCamera;
use toile_sensors::person_mask::PersonMask;

use super::canvas::{self, Canvas, NOTHING, Seen};
use super::framing::Framing;
use super::light::LightEstimate;
use super::model::OwnPictureModel;
use super::occlusion::{self, BodyThere, DepthInPicture};
use super::shadow::ShadowMap;
use crate::tone_mapping;

/// Steps of linear light in the table of sRGB bytes.
const TONES: usize = 4096;

/// Pixels between two places at which a shadow is looked up.
const SHADED: usize = 4;

/// Farthest from the garment that a shadow falls (pixels of 1000 rows).
const AROUND: u32 = 160;

/// Measured so near to the floor, a pixel shows it (m).
const FLOOR_M: f32 = 0.06;

/// What a picture is painted from.
pub struct Layers<'a> {
    /// Body and garments.
    pub model: &'a OwnPictureModel,
    /// From pixels of the mirror to those of the picture.
    pub framing: &'a Framing,
    /// The camera.
    pub camera: &'a ColourCamera,
    /// Nearest triangles of the body and of the garments.
    pub body: &'a Canvas,
    /// The garments' triangles are counted one garment after the other.
    pub cloth: &'a Canvas,
    /// Depth, where there is any.
    pub depth: &'a DepthInPicture,
    /// Odds of a person, where they are known.
    pub mask: Option<&'a PersonMask>,
    /// Vertices of each garment as they are seen, places (m) and light on them.
    pub garments: &'a [SeenGarment],
    /// Colours of their grounds, linear RGB; their own where there is none.
    pub colours: &'a [[f32; 3]],
}

/// A garment as it is seen.
#[derive(Debug, Clone, Default)]
pub struct SeenGarment {
    /// Vertices in the mirror.
    pub seen: Vec<Seen>,
    /// Their places (m) and unit normals.
    pub points: Vec<Vec3>,
    /// Unit normals.
    pub normals: Vec<Vec3>,
    /// Light on them, from before and from behind, linear RGB.
    pub light: Vec<[Vec3; 2]>,
    /// Number of its first triangle.
    pub first: u32,
}

/// Paints.
#[derive(Debug, Clone, Default)]
pub struct Painter {
    /// What the cloth shows where it is seen, and whether it is `[pixels]`.
    cloth: Vec<([u8; 3], bool)>,
    tones: Vec<u8>,
    shaded: Vec<f32>,
}

impl Layers<'_> {
    /// The fitted body at a pixel of the mirror.
    pub fn body_at(&self, at: usize) -> Option<BodyThere> {
        let triangle = self.body.triangle[at];
        if triangle == NOTHING {
            return None;
        }
        let first = self.model.triangles[triangle as usize][0] as usize;
        Some(BodyThere { z: 1.0 / self.body.near[at], is_covered: self.model.recess[first] > 0.0 })
    }

    /// The garment and the triangle of it that is nearest at a pixel.
    fn cloth_at(&self, at: usize) -> Option<(usize, usize)> {
        let triangle = self.cloth.triangle[at];
        let worn = self.garments.iter().rposition(|g| g.first <= triangle)?;
        (triangle != NOTHING).then(|| (worn, (triangle - self.garments[worn].first) as usize))
    }

    fn is_hidden(&self, at: usize, pixel: Vec2) -> bool {
        let z = 1.0 / self.cloth.near[at];
        occlusion::is_before(self.framing.to_picture(pixel), z, self.body_at(at), self.depth, self.mask)
    }
}

impl Painter {
    /// Whether cloth is seen at each pixel, in the last picture that has any `[pixels]`.
    pub fn shown(&self) -> impl Iterator<Item = bool> {
        self.cloth.iter().map(|(_, is)| *is)
    }

    /// Paints the cloth into the mirror `[3 * width * height]`.
    pub fn cloth(&mut self, layers: &Layers<'_>, out: &mut [u8]) {
        self.prepare();
        let width = layers.cloth.size.width as usize;
        let [columns, rows] = layers.cloth.drawn().map(|r| r.map(|n| n as usize));
        self.cloth.clear();
        self.cloth.resize(layers.cloth.near.len(), ([0; 3], false));
        // A border of one, so that the neighbours of every pixel are of this picture.
        let grown = |[a, b]: [usize; 2], end: u32| a.saturating_sub(2)..(b + 2).min(end as usize);
        let (columns, rows) = (grown(columns, layers.cloth.size.width), grown(rows, layers.cloth.size.height));
        for y in rows.clone() {
            for x in columns.clone() {
                let at = y * width + x;
                let pixel = Vec2::new(x as f32, y as f32);
                self.cloth[at] = match layers.cloth_at(at).filter(|_| !layers.is_hidden(at, pixel)) {
                    Some((worn, triangle)) => (self.colour(layers, worn, triangle, pixel), true),
                    None => ([0; 3], false),
                };
            }
        }
        for y in rows.start + 1..rows.end.saturating_sub(1) {
            for x in columns.start + 1..columns.end.saturating_sub(1) {
                let at = y * width + x;
                self.blend(at, width, layers, &mut out[3 * at..3 * at + 3]);
            }
        }
    }

    fn prepare(&mut self) {
        if self.tones.is_empty() {
            let tone = |i: usize| {
                // Bright cloth runs softly into white, as a camera's does.
                let light = 1.25 * i as f32 / (TONES - 1) as f32;
                let soft = if light < 0.7 { light } else { 0.7 + 0.3 * (1.0 - (-(light - 0.7) / 0.3).exp()) };
                (tone_mapping::encode(soft) * 255.0 + 0.5) as u8
            };
            self.tones.extend((0..TONES).map(tone));
        }
    }

    /// Colour of the cloth at a pixel, as sRGB bytes.
    fn colour(&self, layers: &Layers<'_>, worn: usize, number: usize, pixel: Vec2) -> [u8; 3] {
        let (garment, own) = (&layers.garments[worn], &layers.model.garments[worn]);
        let corners = own.triangles[number].map(|v| v as usize);
        let seen = corners.map(|v| garment.seen[v]);
        let weights = canvas::weights(seen, pixel);
        let [a, b, c] = corners.map(|v| garment.points[v]);
        let size = (b - a).cross(c - a).length().sqrt();
        let near = seen[0].z.max(1e-3);
        let wide = 1.0 / (near * layers.camera.intrinsics.fx * layers.framing.scale);
        let ground = layers.colours.get(worn).map_or(own.colour.ground, |c| Vec3::from_array(*c));
        let base = own.colour.at(number, weights, ground, [size, wide]);
        // The mirror shows a front face counter-clockwise with rows downwards.
        let front =
            (seen[1].x - seen[0].x) * (seen[2].y - seen[0].y) - (seen[1].y - seen[0].y) * (seen[2].x - seen[0].x) > 0.0;
        let light: Vec3 = corners.iter().zip(weights).map(|(v, w)| garment.light[*v][usize::from(!front)] * w).sum();
        let tone = |x: f32| self.tones[((x / 1.25 * (TONES - 1) as f32) as usize).min(TONES - 1)];
        (base * light).to_array().map(tone)
    }

    /// A pixel is as much cloth as its neighbourhood is.
    fn blend(&self, at: usize, width: usize, layers: &Layers<'_>, out: &mut [u8]) {
        let nine = [
            at - width - 1,
            at - width,
            at - width + 1,
            at - 1,
            at,
            at + 1,
            at + width - 1,
            at + width,
            at + width + 1,
        ];
        let count: u32 = nine.iter().map(|i| u32::from(self.cloth[*i].1)).sum();
        if count == 0 {
            return;
        }
        let (colour, is) = self.cloth[at];
        let colour = if is {
            colour
        } else {
            let seen = nine.iter().map(|i| &self.cloth[*i]).filter(|(_, is)| *is);
            let sum = seen.fold([0_u32; 3], |sum, (colour, _)| [0, 1, 2].map(|c| sum[c] + u32::from(colour[c])));
            sum.map(|s| (s / count) as u8)
        };
        let opacity = layers.cloth_at(at).map_or(1.0, |(worn, _)| layers.model.garments[worn].colour.opacity());
        let alpha = (count as f32 / 9.0 * opacity * 256.0) as u32;
        out.iter_mut().zip(colour).for_each(|(to, c)| {
            *to = ((u32::from(*to) * (256 - alpha) + u32::from(c) * alpha) / 256) as u8;
        });
    }

    /// Darkens skin and floor where the garment's shadow falls, before the cloth is painted.
    pub fn shadows(&mut self, layers: &Layers<'_>, light: &LightEstimate, maps: [&ShadowMap; 2], out: &mut [u8]) {
        let size = layers.cloth.size;
        let around = AROUND * size.height / 1000;
        let grown = |[a, b]: [u32; 2], end: u32| (a.saturating_sub(around), (b + around).min(end));
        let [columns, rows] = layers.cloth.drawn();
        let ((x0, x1), (y0, y1)) = (grown(columns, size.width), grown(rows, size.height));
        if x0 >= x1 || y0 >= y1 {
            return;
        }
        let [across, down] = [x1 - x0, y1 - y0].map(|n| n as usize / SHADED + 2);
        self.shaded.clear();
        for k in 0..across * down {
            let pixel =
                Vec2::new((x0 as usize + k % across * SHADED) as f32, (y0 as usize + k / across * SHADED) as f32);
            self.shaded.push(dark(layers, pixel, maps) * light.shadow_strength());
        }
        for y in y0 as usize..y1 as usize {
            for x in x0 as usize..x1 as usize {
                let dark = self.dark_between(x - x0 as usize, y - y0 as usize, across);
                if dark > 0.004 {
                    // A share of linear light is about the root of it in bytes.
                    let keeps = ((1.0 - dark).sqrt() * 256.0) as u32;
                    let at = 3 * (y * size.width as usize + x);
                    out[at..at + 3].iter_mut().for_each(|c| *c = (u32::from(*c) * keeps / 256) as u8);
                }
            }
        }
    }

    fn dark_between(&self, x: usize, y: usize, across: usize) -> f32 {
        let at = y / SHADED * across + x / SHADED;
        let [dx, dy] = [x, y].map(|n| (n % SHADED) as f32 / SHADED as f32);
        let of = |i: usize| self.shaded.get(i).copied().unwrap_or(0.0);
        let (upper, lower) =
            (of(at) + (of(at + 1) - of(at)) * dx, of(at + across) + (of(at + across + 1) - of(at + across)) * dx);
        upper + (lower - upper) * dy
    }
}

/// How dark the garment makes what is seen at a pixel of the mirror: skin of the fitted body, or the floor, which the body itself shades
/// in the picture already.
fn dark(layers: &Layers<'_>, pixel: Vec2, [cloth, body]: [&ShadowMap; 2]) -> f32 {
    let size = layers.cloth.size;
    let inside = pixel.x >= 0.0 && pixel.y >= 0.0 && pixel.x < size.width as f32 && pixel.y < size.height as f32;
    if !inside {
        return 0.0;
    }
    let at = pixel.y as usize * size.width as usize + pixel.x as usize;
    let seen = layers.framing.to_picture(pixel);
    let ray = layers.camera.ray(seen);
    let to_world = &layers.camera.camera_to_world;
    let measured = layers.depth.at(seen);
    if let Some(there) = layers.body_at(at).filter(|b| !b.is_covered) {
        let place = to_world.transform_point3(ray * there.z);
        return 1.0 - cloth.open(place);
    }
    // Where the ray meets the floor.
    let (origin, way) = (Vec3::from(to_world.translation), to_world.transform_vector3(ray));
    if way.y >= -1e-3 {
        return 0.0;
    }
    let z = -origin.y / way.y;
    let is_floor = measured.map_or_else(
        || layers.mask.and_then(|mask| mask.at(seen)).is_none_or(|odds| odds < 0.4),
        |measured| (measured - z).abs() * -way.y < FLOOR_M,
    );
    if !is_floor {
        return 0.0;
    }
    let place = origin + way * z;
    ((1.0 - cloth.open(place)) - (1.0 - body.open(place))).max(0.0)
}
