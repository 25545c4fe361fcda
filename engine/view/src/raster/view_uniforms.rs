//! The uniform block of one view: camera, lighting, and the beams that light is sampled by.
//!
//! The disc of an area light and the sky are sampled by many parallel beams, each a directional light with a shadow map
//! (Heckbert and Herf 1997, "Simulating soft shadows with graphics hardware"; for the sky, Sattler et al. 2004, "Hardware-
//! accelerated ambient occlusion computation"). No noise, no blur across edges, and the same for every driver.

use glam::{Mat4, Vec2, Vec3, Vec4};

use super::render_quality::{MOST_BEAMS, RenderQuality};
use crate::image::Size;
use crate::lighting::{CURVE, DEPTH, Lighting, PAINT, POOL};
use crate::ray_tracer::LEAST_FACING;
use crate::sampling::disc;
use crate::scene::{Bounds, CameraFrame, OrbitCamera};

/// Numbers of the uniform block before the beams.
const HEAD: usize = 100;

/// Numbers of a beam.
const BEAM: usize = 16;

/// Size of the uniform block (bytes).
pub const BLOCK: u64 = ((HEAD + BEAM * MOST_BEAMS as usize) * 4) as u64;

// No more than every driver binds.
const _: () = assert!(BLOCK <= 16 * 1024);

/// Nearest and farthest depth that is drawn, in distances of the eye from the target.
const NEAR: f32 = 0.05;
const FAR: f32 = 4.0;

/// Gap between a surface and where its shadow is looked up (texels of a depth map).
const OFFSET: f32 = 0.9;

/// The backdrop, as the shaders read it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum BackdropKind {
    /// The curved backdrop in a pool of light.
    Curved,
    /// A picture; how its width and height compare with the view's, so that it covers it.
    Picture(Vec2),
}

/// One view of the scene.
#[derive(Debug, Clone, Copy)]
pub struct ViewUniforms {
    /// Camera of the view.
    pub camera: OrbitCamera,
    /// The part of the target that is drawn on (pixels).
    pub size: Size,
    /// The box around all that is drawn.
    pub subject: Bounds,
    /// The box that lighting and backdrop are fitted to.
    pub stands: Bounds,
    /// Backdrop behind the subject.
    pub behind: BackdropKind,
}

impl ViewUniforms {
    /// The uniform block: the same fields in the same order as `Frame` in `common.wgsl`.
    pub fn block(&self, quality: &RenderQuality) -> Vec<f32> {
        let aspect = self.size.width as f32 / self.size.height.max(1) as f32;
        let view = self.camera.view(aspect);
        let lighting = Lighting::new(&view, self.stands, true);
        let shadows = ShadowVolume::new(self.subject, quality);
        let mut words = UniformWords(Vec::with_capacity(HEAD + BEAM * quality.beams() as usize));
        words.matrix(clip_from_world(&view, &self.camera));
        words.vec(view.origin, self.camera.distance);
        words.vec(view.forward, LEAST_FACING);
        words.vec(view.right * view.half.x, 0.0);
        words.vec(view.up * view.half.y, 0.0);
        words.vec(lighting.key.middle(), lighting.key.breadth());
        words.vec(lighting.key.colour, 0.0);
        words.vec(lighting.rim.middle(), 0.0);
        words.vec(lighting.rim.colour, 0.0);
        words.vec(lighting.sky, 0.0);
        words.vec(lighting.ground, 0.0);
        words.vec(lighting.fill, 0.0);
        words.vec(lighting.fill_toward, lighting.reach());
        let size = lighting.backdrop.size();
        words.vec(lighting.backdrop.centre, size);
        words.vec(lighting.backdrop.away, DEPTH * size);
        words.vec(PAINT, CURVE * size);
        let empty = self.subject.is_empty();
        let Bounds { min, max } = if empty { Bounds { min: Vec3::ZERO, max: Vec3::ONE } } else { self.subject };
        words.vec(min, POOL * size);
        words.vec(max, if empty { 0.0 } else { 1.0 });
        words.four([quality.key, quality.rim, quality.sky, 0].map(|n| n as f32));
        let (kind, scale) = match self.behind {
            BackdropKind::Curved => (0.0, Vec2::ONE),
            BackdropKind::Picture(scale) => (1.0, scale),
        };
        words.four([scale.x, scale.y, kind, 0.0]);
        let maps = [quality.grid().0, quality.grid().1].map(|tiles| (tiles * quality.tile) as f32);
        words.four([self.size.width as f32, self.size.height as f32, maps[0], maps[1]]);
        words.four([shadows.width, shadows.offset, shadows.reach * shadows.reach, shadows.width / quality.tile as f32]);
        debug_assert_eq!(words.0.len(), HEAD);
        let (columns, rows) = quality.grid();
        for (number, toward) in (0..).zip(beams(&lighting, quality)) {
            let tile = Vec2::new((number % columns) as f32, (number / columns) as f32);
            let grid = Vec2::new(columns as f32, rows as f32);
            shadows.beam(toward, tile / grid, 1.0 / grid).into_iter().for_each(|row| words.four(row.to_array()));
        }
        words.0
    }
}

/// Directions of all beams: key lamp, rim lamp, sky.
fn beams(lighting: &Lighting, quality: &RenderQuality) -> Vec<Vec3> {
    // A sunflower's seeds fill disc and sphere evenly for any count (Vogel 1979).
    const GOLDEN: f32 = 0.618_034;
    let seed = |i: u32, count: u32| Vec2::new((i as f32 + 0.5) / count as f32, (i as f32 * GOLDEN).fract());
    let lamp = |lamp: &crate::lighting::AreaLight, count: u32| -> Vec<Vec3> {
        let spot = |i| if count == 1 { lamp.middle() } else { lamp.direction(seed(i, count)) };
        (0..count).map(spot).collect()
    };
    let sky = |i: u32| {
        let at = seed(i, quality.sky);
        let up = 1.0 - 2.0 * at.x;
        let level = disc(Vec2::new(1.0, at.y)) * (1.0 - up * up).max(0.0).sqrt();
        Vec3::new(level.x, up, level.y)
    };
    let mut all = lamp(&lighting.key, quality.key);
    all.extend(lamp(&lighting.rim, quality.rim));
    all.extend((0..quality.sky).map(sky));
    all
}

/// The ball that all depth maps look at.
#[derive(Debug, Clone, Copy)]
struct ShadowVolume {
    centre: Vec3,
    /// Diameter, with a margin of two texels (m).
    width: f32,
    /// Gap between a surface and where its shadow is looked up (m).
    offset: f32,
    /// From its middle to the last texel whose neighbours are in the tile too (m).
    reach: f32,
}

impl ShadowVolume {
    fn new(subject: Bounds, quality: &RenderQuality) -> Self {
        let subject = if subject.is_empty() { Bounds { min: Vec3::ZERO, max: Vec3::ONE } } else { subject };
        let tile = quality.tile as f32;
        let width = (subject.max - subject.min).length().max(0.01) * tile / (tile - 4.0);
        let reach = width * (0.5 - 1.0 / tile);
        Self { centre: (subject.min + subject.max) * 0.5, width, offset: OFFSET * width / tile, reach }
    }

    /// Rows that take a place to its tile (0..1 across the whole texture) and its depth in the map (0..1), and the
    /// direction.
    fn beam(&self, toward: Vec3, corner: Vec2, share: Vec2) -> [Vec4; 4] {
        let (a, b) = toward.any_orthonormal_pair();
        let row = |axis: Vec3, share: f32, corner: f32| {
            let axis = axis * (share / self.width);
            axis.extend(corner + 0.5 * share - axis.dot(self.centre))
        };
        [row(a, share.x, corner.x), row(b, share.y, corner.y), row(-toward, 1.0, 0.0), toward.extend(0.0)]
    }
}

/// World to clip space as the drivers have it: x and y -1..1, y up, depth 0..1.
fn clip_from_world(view: &CameraFrame, camera: &OrbitCamera) -> Mat4 {
    let eye = Mat4::from_cols(
        Vec3::new(view.right.x, view.up.x, -view.forward.x).extend(0.0),
        Vec3::new(view.right.y, view.up.y, -view.forward.y).extend(0.0),
        Vec3::new(view.right.z, view.up.z, -view.forward.z).extend(0.0),
        Vec3::new(-view.right.dot(view.origin), -view.up.dot(view.origin), view.forward.dot(view.origin)).extend(1.0),
    );
    let (near, far) = (NEAR * camera.distance.max(0.01), FAR * camera.distance.max(0.01));
    let depth = far / (near - far);
    let lens = Mat4::from_cols(
        Vec4::new(1.0 / view.half.x, 0.0, 0.0, 0.0),
        Vec4::new(0.0, 1.0 / view.half.y, 0.0, 0.0),
        Vec4::new(0.0, 0.0, depth, -1.0),
        Vec4::new(0.0, 0.0, near * depth, 0.0),
    );
    lens * eye
}

/// Numbers in the order of a uniform block.
struct UniformWords(Vec<f32>);

impl UniformWords {
    fn vec(&mut self, v: Vec3, w: f32) {
        self.four([v.x, v.y, v.z, w]);
    }

    fn four(&mut self, four: [f32; 4]) {
        self.0.extend(four);
    }

    fn matrix(&mut self, m: Mat4) {
        self.0.extend(m.to_cols_array());
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn uniforms() -> ViewUniforms {
        let subject = Bounds { min: Vec3::new(-0.4, 0.0, -0.2), max: Vec3::new(0.4, 1.7, 0.3) };
        let size = Size::new(300, 500);
        let camera = OrbitCamera::framing(&subject, 0.4, 0.6);
        ViewUniforms { camera, size, subject, stands: subject, behind: BackdropKind::Curved }
    }

    #[test]
    fn the_block_has_room_for_the_best_quality_and_is_finite() {
        for quality in [RenderQuality::LOW, RenderQuality::HIGH, RenderQuality::STILL] {
            let block = uniforms().block(&quality);
            assert_eq!(block.len(), HEAD + BEAM * quality.beams() as usize);
            assert!(block.len() * 4 <= BLOCK as usize && block.iter().all(|x| x.is_finite()));
        }
        let nothing =
            ViewUniforms { subject: Bounds::EMPTY, stands: Bounds::EMPTY, ..uniforms() }.block(&RenderQuality::LOW);
        assert!(nothing[..80].iter().all(|x| x.is_finite()), "an empty scene still has a camera");
    }

    /// The raster and the ray tracer see every point at the same place of the picture.
    #[test]
    fn the_lens_agrees_with_the_ray_tracers_rays() {
        let uniforms = uniforms();
        let view = uniforms.camera.view(0.6);
        let clip = clip_from_world(&view, &uniforms.camera);
        for (x, y, far) in [(0.5, 0.5, 3.0), (0.1, 0.2, 4.0), (0.9, 0.7, 5.5)] {
            let point = view.origin + view.direction(Vec2::new(x, y)) * far;
            let seen = clip.project_point3(point);
            assert!((seen.x - (2.0 * x - 1.0)).abs() < 1e-4 && (seen.y - (1.0 - 2.0 * y)).abs() < 1e-4, "{seen}");
            assert!((0.0..1.0).contains(&seen.z), "{seen}");
        }
    }

    #[test]
    fn every_beam_holds_the_whole_subject_in_its_own_tile() {
        let quality = RenderQuality::STILL;
        let block = uniforms().block(&quality);
        let (columns, rows) = quality.grid();
        let Bounds { min, max } = uniforms().subject;
        for (number, beam) in block[HEAD..].chunks(BEAM).enumerate() {
            let row = |i: usize| Vec4::from_slice(&beam[4 * i..]);
            let (column, line) = (number as u32 % columns, number as u32 / columns);
            for i in 0..8 {
                let pick = |bit: usize| if i >> bit & 1 == 0 { min } else { max };
                let p = Vec3::new(pick(0).x, pick(1).y, pick(2).z).extend(1.0);
                let (u, v, depth) = (row(0).dot(p), row(1).dot(p), row(2).dot(p));
                assert!(u * columns as f32 > column as f32 && u * (columns as f32) < column as f32 + 1.0);
                assert!(v * rows as f32 > line as f32 && v * (rows as f32) < line as f32 + 1.0);
                assert!((0.0..=1.0).contains(&depth), "beam {number}: depth {depth}");
            }
        }
    }

    #[test]
    fn the_sky_is_even_and_lamps_stay_on_their_discs() {
        let uniforms = uniforms();
        let lighting = Lighting::new(&uniforms.camera.view(0.6), uniforms.stands, true);
        let quality = RenderQuality::STILL;
        let all = beams(&lighting, &quality);
        let (lamps, sky) = all.split_at((quality.key + quality.rim) as usize);
        let lean = sky.iter().sum::<Vec3>() / sky.len() as f32;
        assert!(lean.length() < 0.03, "{lean}");
        let key: Vec3 = lamps[..quality.key as usize].iter().sum();
        assert!(key.normalize().dot(lighting.key.middle()) > 0.9999);
        assert!(all.iter().all(|b| b.is_normalized()));
    }
}
