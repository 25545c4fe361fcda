//! The mirror: from a picture and a snapshot to what the shopper sees.

use glam::{Vec2, Vec3};
use toile_base::frame::{DepthFrame, Joints};
use toile_base::limits::MAX_SIDE;
use toile_base::mesh::vertex_normals;
use toile_engine::body::JointFrames;
use toile_engine::world::Snapshot;
use toile_sensors::colour_camera::ColourCamera;
use toile_sensors::limits::MAX_COLOUR_PIXELS;
use toile_sensors::person_mask::PersonMask;
use toile_sensors::source::live::ColourImage;

use super::background::Background;
use super::canvas::{Canvas, Faces, NOTHING, Seen};
use super::framing::Framing;
use super::light::LightMeter;
use super::model::OwnPictureModel;
use super::occlusion::DepthInPicture;
use super::paint::{Layers, Painter, SeenGarment};
use super::repose::{LENGTHS, Repose};
use super::shadow::ShadowMap;
use super::support::{Plain, Support};
use crate::image::{Size, linear};

/// Farthest distance of the shopper from their place in the snapshot (m); a person farther off is another.
const FARTHEST_M: f32 = 0.8;

/// Share of the garments' vertices that have to be within the picture.
const LEAST_IN_PICTURE: f32 = 0.6;

/// Successive pictures that must confirm the shopper before the garment is drawn.
const STEADY: u32 = 2;

/// Pixels between two that say what the light is like.
const METERED: usize = 6;

/// A picture, and all that was seen in it.
#[derive(Debug, Clone, Copy)]
pub struct OwnPictureInput<'a> {
    /// The camera's picture.
    pub picture: &'a ColourImage,
    /// How it was seen; none where that is not known.
    pub camera: Option<&'a ColourCamera>,
    /// The joints in it, in our world.
    pub joints: &'a Joints,
    /// Depth of the same moment, where there is any.
    pub depth: Option<&'a DepthFrame>,
    /// Odds of a person, where they are known.
    pub mask: Option<&'a PersonMask>,
    /// Colours of the garments (linear RGB, inner first) in place of their own; empty leaves them.
    pub colours: &'a [[f32; 3]],
}

/// How it is shown.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct OwnPictureOptions {
    /// Size of the mirror (pixels).
    pub size: Size,
    /// What is free of it, left and right (shares of its width): there the shopper stands.
    pub free: [f32; 2],
}

impl OwnPictureOptions {
    /// All of a mirror of this size.
    pub const fn of(size: Size) -> Self {
        Self { size, free: [0.0, 1.0] }
    }
}

/// Draws the mirror, picture by picture. Its storage grows to a size once and stays.
#[derive(Debug, Clone, Default)]
pub struct OwnPicture {
    size: (u32, u32),
    rgb: Vec<u8>,
    background: Background,
    depth: DepthInPicture,
    body: Canvas,
    cloth: Canvas,
    points: Vec<Vec3>,
    normals: Vec<Vec3>,
    seen: Vec<Seen>,
    garments: Vec<SeenGarment>,
    light: LightMeter,
    maps: [ShadowMap; 2],
    painter: Painter,
    decoded: Vec<f32>,
    /// Column of the picture at which the shopper stands, once they were seen.
    column: Option<f32>,
    /// Successive pictures that have confirmed the shopper.
    steady: u32,
}

impl OwnPicture {
    /// A mirror that has shown no person.
    pub fn new() -> Self {
        Self { decoded: (0..=255_u8).map(|b| linear(f32::from(b) / 255.0)).collect(), ..Self::default() }
    }

    /// The mirror's picture: red, green, blue, rows from the top `[3 * width * height]`.
    pub fn picture(&self) -> (Size, &[u8]) {
        (Size::new(self.size.0, self.size.1), &self.rgb)
    }

    /// Whether cloth is seen at each pixel of the last picture that has any `[pixels]`.
    pub fn shown(&self) -> impl Iterator<Item = bool> {
        self.painter.shown()
    }

    /// Forgets the light and the shopper's place and blackens their picture, because another person may stand there.
    pub fn forget(&mut self) {
        self.rgb.fill(0);
        self.light.reset();
        (self.column, self.steady) = (None, 0);
    }

    /// Draws a picture: with the garments, or plain, and then why.
    ///
    /// # Errors
    /// Why there is no garment on it; the picture is there all the same, but for [`Plain::NoPicture`], where it is black.
    pub fn draw(
        &mut self,
        model: &OwnPictureModel,
        snapshot: &Snapshot,
        input: &OwnPictureInput<'_>,
        options: &OwnPictureOptions,
    ) -> Result<(), Plain> {
        let size = options.size;
        self.size = (size.width, size.height);
        self.rgb.resize(3 * size.width as usize * size.height as usize, 0);
        let picture = input.picture;
        if !is_picture(picture) {
            self.rgb.fill(0);
            self.steady = 0;
            return Err(Plain::NoPicture);
        }
        let framing = self.framing(input, options);
        self.background.draw(picture, &framing, &mut self.rgb);
        let posed = self.pose(model, snapshot, input, &framing);
        let camera = match posed.and_then(|camera| self.bear_out(input, &camera, &framing).map(|()| camera)) {
            Ok(camera) => camera,
            Err(plain) => {
                self.steady = 0;
                return Err(plain);
            }
        };
        self.steady += 1;
        if self.steady < STEADY {
            return Err(Plain::Unsure);
        }
        self.paint(model, input, &camera, &framing);
        Ok(())
    }

    /// Follows the shopper across the picture, and not every sway.
    fn framing(&mut self, input: &OwnPictureInput<'_>, options: &OwnPictureOptions) -> Framing {
        let picture = [input.picture.width, input.picture.height];
        let pelvis = input.joints.believed(toile_base::skeleton::Joint::Pelvis);
        let column = input.camera.zip(pelvis).and_then(|(camera, p)| {
            let camera = camera.scaled_to(picture[0], picture[1]);
            camera.project(camera.camera_to_world.inverse().transform_point3(p)).map(|at| at.x)
        });
        let now = column.or(self.column);
        let followed = now.map(|now| self.column.map_or(now, |was| was + 0.2 * (now - was)));
        self.column = followed.filter(|c| c.is_finite());
        Framing::covering(picture, options.size, self.column.unwrap_or(0.5 * picture[0] as f32), options.free)
    }

    /// Brings body and garments to where the picture has them, and into the mirror.
    fn pose(
        &mut self,
        model: &OwnPictureModel,
        snapshot: &Snapshot,
        input: &OwnPictureInput<'_>,
        framing: &Framing,
    ) -> Result<ColourCamera, Plain> {
        let camera = input.camera.filter(|c| c.fault().is_none()).ok_or(Plain::UnknownCamera)?;
        let camera = camera.scaled_to(input.picture.width, input.picture.height);
        if !model.wears(&snapshot.garments) || snapshot.skin.vertices() != model.vertices() {
            return Err(Plain::Changing);
        }
        let own = JointFrames::new(&model.skeleton, &snapshot.pose).position;
        let repose = Repose::new(&own, input.joints).ok_or(Plain::Nobody)?;
        let [least, most] = repose.lengths;
        if !(LENGTHS.contains(&least) && LENGTHS.contains(&most)) || repose.shift_m > FARTHEST_M {
            return Err(Plain::Unsure);
        }
        let world_to_camera = camera.camera_to_world.inverse();
        let place = |p: Vec3, recess: f32| -> Seen {
            let p = world_to_camera.transform_point3(p);
            let Some(pixel) = camera.project(p) else { return Vec3::ZERO };
            framing.to_mirror(pixel).extend(1.0 / (p.z + recess))
        };
        self.points.resize(model.vertices(), Vec3::ZERO);
        self.normals.resize(model.vertices(), Vec3::ZERO);
        snapshot.skin.read(&mut self.points, &mut self.normals);
        repose.apply(&model.weights, &mut self.points, &mut self.normals);
        self.seen.clear();
        self.seen.extend(self.points.iter().zip(&model.recess).map(|(p, recess)| place(*p, *recess)));
        self.garments.resize_with(model.garments.len(), SeenGarment::default);
        let mut first = 0;
        for ((to, worn), own) in self.garments.iter_mut().zip(&snapshot.garments).zip(&model.garments) {
            to.points.clear();
            to.points.extend_from_slice(worn);
            to.normals.clear();
            to.normals.resize(worn.len(), Vec3::ZERO);
            repose.apply(&own.weights, &mut to.points, &mut to.normals);
            vertex_normals(&to.points, &own.triangles, &mut to.normals);
            to.seen.clear();
            to.seen.extend(to.points.iter().map(|p| place(*p, 0.0)));
            to.first = first;
            first += own.triangles.len() as u32;
        }
        self.raster(model, framing.size);
        Ok(camera)
    }

    fn raster(&mut self, model: &OwnPictureModel, size: Size) {
        self.body.clear(size);
        self.body.draw(&self.seen, &model.triangles, 0, Faces::Outer);
        self.cloth.clear(size);
        for (garment, own) in self.garments.iter().zip(&model.garments) {
            self.cloth.draw(&garment.seen, &own.triangles, garment.first, Faces::Both);
        }
    }

    /// Checks that the picture confirms the shopper.
    fn bear_out(&mut self, input: &OwnPictureInput<'_>, camera: &ColourCamera, framing: &Framing) -> Result<(), Plain> {
        self.depth.take(input.depth, camera);
        let k = camera.intrinsics;
        let (width, height) = (k.width as f32, k.height as f32);
        let inside = |seen: &Seen| {
            let at = framing.to_picture(seen.truncate());
            seen.z > 0.0 && at.x >= 0.0 && at.y >= 0.0 && at.x < width && at.y < height
        };
        let all: usize = self.garments.iter().map(|g| g.seen.len()).sum();
        let within = self.garments.iter().flat_map(|g| &g.seen).filter(|s| inside(s)).count();
        if (within as f32) < LEAST_IN_PICTURE * all as f32 {
            return Err(Plain::OutOfPicture);
        }
        let mut support = Support::default();
        let [[x0, x1], [y0, y1]] = self.body.drawn().map(|r| r.map(|n| n as usize));
        for y in (y0..y1).step_by(METERED) {
            for x in (x0..x1).step_by(METERED) {
                let at = y * framing.size.width as usize + x;
                if self.body.triangle[at] != NOTHING {
                    let pixel = framing.to_picture(Vec2::new(x as f32, y as f32));
                    support.look(pixel, 1.0 / self.body.near[at], &self.depth, input.mask);
                }
            }
        }
        if support.is_enough() { Ok(()) } else { Err(Plain::Unsure) }
    }

    fn paint(
        &mut self,
        model: &OwnPictureModel,
        input: &OwnPictureInput<'_>,
        camera: &ColourCamera,
        framing: &Framing,
    ) {
        let light = self.meter_light(model);
        let middle = self.points.iter().sum::<Vec3>() / self.points.len().max(1) as f32;
        let [on_cloth, on_body] = &mut self.maps;
        on_cloth.begin(light.toward(), middle, 1.05);
        on_body.begin(light.toward(), middle, 1.05);
        on_body.draw(&self.points, &model.triangles, Faces::Outer);
        for (garment, own) in self.garments.iter().zip(&model.garments) {
            on_cloth.draw(&garment.points, &own.triangles, Faces::Both);
        }
        for garment in &mut self.garments {
            let SeenGarment { points, normals, light: lit, .. } = garment;
            lit.clear();
            lit.extend(points.iter().zip(normals.iter()).map(|(p, n)| {
                let open = on_cloth.open(*p + *n * 0.01).min(on_body.open(*p + *n * 0.03));
                [light.on(*n, open), light.on(-*n, 0.4 * open)]
            }));
        }
        let Self { body, cloth, depth, garments, maps, painter, rgb, .. } = self;
        let mask = input.mask.filter(|mask| mask.side > 0);
        let colours = input.colours;
        let layers = Layers { model, framing, camera, body, cloth, depth, mask, garments, colours };
        painter.shadows(&layers, &light, [&maps[0], &maps[1]], rgb);
        painter.cloth(&layers, rgb);
    }

    /// What the picture, which has no garment yet, says of the light.
    fn meter_light(&mut self, model: &OwnPictureModel) -> super::light::LightEstimate {
        self.light.begin();
        let width = self.size.0 as usize;
        for y in (0..self.size.1 as usize).step_by(METERED) {
            for x in (0..width).step_by(METERED) {
                let at = y * width + x;
                let [r, g, b] = [0, 1, 2].map(|c| self.decoded[usize::from(self.rgb[3 * at + c])]);
                let rgb = Vec3::new(r, g, b);
                self.light.pixel(rgb);
                let triangle = self.body.triangle[at];
                if triangle != NOTHING {
                    let normal = self.normals[model.triangles[triangle as usize][0] as usize];
                    self.light.body(model.parts[triangle as usize] as usize, normal, rgb);
                }
            }
        }
        self.light.end()
    }
}

/// Whether it is a picture that can be shown.
fn is_picture(picture: &ColourImage) -> bool {
    let ColourImage { width, height, ref rgb } = *picture;
    let pixels = u64::from(width) * u64::from(height);
    let size = width >= 16 && height >= 16 && width <= MAX_SIDE && height <= MAX_SIDE && pixels <= MAX_COLOUR_PIXELS;
    size && rgb.len() as u64 == 3 * pixels
}
