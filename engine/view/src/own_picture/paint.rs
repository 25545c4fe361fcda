//! Cloth into the picture: its colour in the picture's light, what lies before it left out, edges soft, shadows around it.

use std::ops::Range;

use glam::{Vec2, Vec3};
use toile_sensors::colour_camera::ColourCamera;
use toile_sensors::person_mask::PersonMask;

use super::canvas::{self, Canvas, NOTHING, Seen};
use super::framing::Framing;
use super::garment_colour::ClothFacet;
use super::light::LightEstimate;
use super::model::OwnPictureModel;
use super::occlusion::{self, BodyThere, DepthInPicture};
use super::rays::Rays;
use super::shadow::ShadowMap;
use crate::image::Size;
use crate::tone_mapping;

/// Steps of linear light in the table of sRGB bytes.
const TONES: usize = 4096;

/// Pixels between two places at which a shadow is looked up.
const SHADED: usize = 4;

/// A shadow that takes less of the light changes no byte.
const LEAST_DARK: f32 = 0.004;

/// Farthest from the garment that a shadow falls (pixels of 1000 rows).
const AROUND: u32 = 160;

/// Measured so near to the floor, a pixel shows it (m).
const FLOOR_M: f32 = 0.06;

/// Inputs of a painted picture.
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
    /// Columns and rows of it that were painted on.
    painted: [Range<usize>; 2],
    size: Size,
    tones: Vec<u8>,
    shaded: Vec<f32>,
    rays: Rays,
}

/// A triangle of cloth that is seen: what is the same at all of its pixels.
struct SeenFacet<'a> {
    cloth: ClothFacet<'a>,
    corners: [Seen; 3],
    /// Light on the corners, on the face that is seen.
    light: [Vec3; 3],
    ground: Vec3,
}

impl Layers<'_> {
    /// The fitted body at a pixel of the mirror.
    pub fn body_at(&self, at: usize) -> Option<BodyThere> {
        let triangle = self.body.triangle[at];
        if triangle == NOTHING {
            return None;
        }
        Some(BodyThere { z: 1.0 / self.body.near[at], is_covered: self.model.is_covered[triangle as usize] })
    }

    /// The garment and the triangle of it that is nearest at a pixel.
    fn cloth_at(&self, at: usize) -> Option<(usize, usize)> {
        let triangle = self.cloth.triangle[at];
        let worn = self.garments.iter().rposition(|g| g.first <= triangle)?;
        (triangle != NOTHING).then(|| (worn, (triangle - self.garments[worn].first) as usize))
    }

    /// A triangle that is seen, by its number among all garments'.
    fn facet(&self, triangle: u32) -> Option<SeenFacet<'_>> {
        let worn = self.garments.iter().rposition(|g| g.first <= triangle)?;
        let (garment, own) = (&self.garments[worn], &self.model.garments[worn]);
        let number = (triangle - garment.first) as usize;
        let vertices = own.triangles[number].map(|v| v as usize);
        let corners = vertices.map(|v| garment.seen[v]);
        let [a, b, c] = vertices.map(|v| garment.points[v]);
        let size = (b - a).cross(c - a).length().sqrt();
        let near = corners[0].z.max(1e-3);
        let wide = 1.0 / (near * self.camera.intrinsics.fx * self.framing.scale);
        let [p, q, r] = corners.map(Vec3::truncate);
        // The mirror shows a front face so: it turns left and right.
        let is_front = (q - p).perp_dot(r - p) > 0.0;
        Some(SeenFacet {
            cloth: own.colour.facet(number, size, wide),
            corners,
            light: vertices.map(|v| garment.light[v][usize::from(!is_front)]),
            ground: self.colours.get(worn).map_or(own.colour.ground, |c| Vec3::from_array(*c)),
        })
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
        self.clear(layers.cloth.size);
        let size = layers.cloth.size;
        let width = size.width as usize;
        // A border, so that the neighbours of every pixel are of this picture.
        let grown = |[a, b]: [u32; 2], end: u32| a.saturating_sub(2) as usize..(b + 2).min(end) as usize;
        let [columns, rows] = layers.cloth.drawn();
        let (columns, rows) = (grown(columns, size.width), grown(rows, size.height));
        self.painted = [columns.clone(), rows.clone()];
        let mut last = None;
        for y in rows.clone() {
            for x in columns.clone() {
                let (at, pixel) = (y * width + x, Vec2::new(x as f32, y as f32));
                let triangle = layers.cloth.triangle[at];
                if triangle == NOTHING || layers.is_hidden(at, pixel) {
                    continue;
                }
                // Neighbours are mostly of one triangle.
                if last.as_ref().is_none_or(|(number, _)| *number != triangle) {
                    last = layers.facet(triangle).map(|facet| (triangle, facet));
                }
                if let Some((_, facet)) = &last {
                    self.cloth[at] = (self.colour(facet, pixel), true);
                }
            }
        }
        for y in rows.start + 1..rows.end.saturating_sub(1) {
            self.blend_row(y, columns.clone(), layers, out);
        }
    }

    /// Empties what was painted; all of it where the size changes.
    fn clear(&mut self, size: Size) {
        let nothing = ([0; 3], false);
        if self.size == size {
            let [columns, rows] = &self.painted;
            for y in rows.clone() {
                let row = y * size.width as usize;
                self.cloth[row + columns.start..row + columns.end].fill(nothing);
            }
        } else {
            self.size = size;
            self.cloth.clear();
            self.cloth.resize(size.width as usize * size.height as usize, nothing);
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
    fn colour(&self, facet: &SeenFacet<'_>, pixel: Vec2) -> [u8; 3] {
        let weights = canvas::weights(facet.corners, pixel);
        let base = facet.cloth.at(weights, facet.ground);
        let light = facet.light[0] * weights[0] + facet.light[1] * weights[1] + facet.light[2] * weights[2];
        let tone = |x: f32| self.tones[((x / 1.25 * (TONES - 1) as f32) as usize).min(TONES - 1)];
        (base * light).to_array().map(tone)
    }

    /// Each pixel of a row is as much cloth as its neighbourhood is.
    fn blend_row(&self, y: usize, columns: Range<usize>, layers: &Layers<'_>, out: &mut [u8]) {
        // A mirror so narrow has no pixel with neighbours.
        if columns.len() < 3 {
            return;
        }
        let width = layers.cloth.size.width as usize;
        let rows = [y - 1, y, y + 1].map(|y| &self.cloth[y * width..(y + 1) * width]);
        let in_column = |x: usize| rows.iter().map(|row| u32::from(row[x].1)).sum::<u32>();
        let is_sheer = layers.model.garments.iter().any(|g| g.colour.opacity() < 1.0);
        let (mut before, mut here) = (in_column(columns.start), in_column(columns.start + 1));
        for x in columns.start + 1..columns.end - 1 {
            let after = in_column(x + 1);
            let count = before + here + after;
            (before, here) = (here, after);
            if count == 0 {
                continue;
            }
            let at = y * width + x;
            let to = &mut out[3 * at..3 * at + 3];
            let (colour, is) = rows[1][x];
            if count == 9 && !is_sheer {
                to.copy_from_slice(&colour);
                continue;
            }
            let colour = if is { colour } else { mean_around(rows, x, count) };
            let opacity = layers.cloth_at(at).map_or(1.0, |(worn, _)| layers.model.garments[worn].colour.opacity());
            let alpha = (count as f32 / 9.0 * opacity * 256.0) as u32;
            to.iter_mut().zip(colour).for_each(|(to, c)| {
                *to = ((u32::from(*to) * (256 - alpha) + u32::from(c) * alpha) / 256) as u8;
            });
        }
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
        let strength = light.shadow_strength();
        self.rays.make(layers.camera);
        self.shaded.clear();
        for k in 0..across * down {
            let pixel =
                Vec2::new((x0 as usize + k % across * SHADED) as f32, (y0 as usize + k / across * SHADED) as f32);
            self.shaded.push(dark(layers, &self.rays, pixel, maps) * strength);
        }
        for y in y0 as usize..y1 as usize {
            let row = (y - y0 as usize) / SHADED * across;
            let part = (y - y0 as usize) % SHADED;
            for (block, first) in (x0 as usize..x1 as usize).step_by(SHADED).enumerate() {
                let at = row + block;
                let corners = [at, at + 1, at + across, at + across + 1].map(|i| self.shaded[i]);
                // Most places are not in the shadow.
                if corners.iter().all(|dark| *dark <= LEAST_DARK) {
                    continue;
                }
                for x in first..(first + SHADED).min(x1 as usize) {
                    let dark = between(corners, [x - first, part]);
                    if dark > LEAST_DARK {
                        // A share of linear light is about the root of it in bytes.
                        let keeps = ((1.0 - dark).sqrt() * 256.0) as u32;
                        let at = 3 * (y * size.width as usize + x);
                        out[at..at + 3].iter_mut().for_each(|c| *c = (u32::from(*c) * keeps / 256) as u8);
                    }
                }
            }
        }
    }
}

/// How dark it is between four places, upper and lower ones, at a pixel right and down of the first.
fn between([a, b, c, d]: [f32; 4], at: [usize; 2]) -> f32 {
    let [dx, dy] = at.map(|n| n as f32 / SHADED as f32);
    let (upper, lower) = (a + (b - a) * dx, c + (d - c) * dx);
    upper + (lower - upper) * dy
}

/// The mean colour of the cloth, of which there are `count` pixels, among nine.
fn mean_around(rows: [&[([u8; 3], bool)]; 3], x: usize, count: u32) -> [u8; 3] {
    let seen = rows.iter().flat_map(|row| &row[x - 1..=x + 1]).filter(|(_, is)| *is);
    let sum = seen.fold([0_u32; 3], |sum, (colour, _)| [0, 1, 2].map(|c| sum[c] + u32::from(colour[c])));
    sum.map(|s| (s / count) as u8)
}

/// How dark the garment makes what is seen at a pixel of the mirror: skin of the fitted body, or the floor, which the body itself shades
/// in the picture already.
fn dark(layers: &Layers<'_>, rays: &Rays, pixel: Vec2, [cloth, body]: [&ShadowMap; 2]) -> f32 {
    let size = layers.cloth.size;
    let inside = pixel.x >= 0.0 && pixel.y >= 0.0 && pixel.x < size.width as f32 && pixel.y < size.height as f32;
    if !inside {
        return 0.0;
    }
    let at = pixel.y as usize * size.width as usize + pixel.x as usize;
    let seen = layers.framing.to_picture(pixel);
    let ray = rays.at(layers.camera, seen);
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
    let open = cloth.open(place);
    // What is open to the garment is so to the light, whatever the body does.
    if open < 1.0 { (body.open(place) - open).max(0.0) } else { 0.0 }
}
