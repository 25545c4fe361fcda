//! Rendering a picture by ray tracing: a scene and its three passes (first hits, light, shadow filter).
//!
//! Every number that jitters comes from the pixel and the sample's number (`sampling`), and every pixel is written by one
//! thread alone, so a picture has the same bytes for any number of threads.

use std::{
    num::NonZero,
    sync::{Mutex, PoisonError},
    thread,
};

use crate::{
    image::{Image, Size},
    lighting::Lighting,
    ray_tracer::{PixelLight, PrimaryHit, RayTracer, SampleCounts},
    scene::{OrbitCamera, PictureScene},
    shadow_filter::filter_and_tone_map,
};

pub use crate::traced_scene::TracedScene;

/// Quality of a ray-traced picture.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum TraceQuality {
    /// A still: eight samples a pixel, four times as many along edges.
    Still,
    /// One frame of an animation: two samples a pixel, eight along edges.
    Motion,
}

impl TraceQuality {
    fn samples(self) -> SampleCounts {
        match self {
            Self::Still => SampleCounts { inside: 8, edge: 32, reach: 3 },
            Self::Motion => SampleCounts { inside: 2, edge: 8, reach: 3 },
        }
    }
}

/// Renders one picture, hierarchy included. Several views of one scene share a [`TracedScene`].
pub fn render(scene: &PictureScene<'_>, camera: &OrbitCamera, size: Size, quality: TraceQuality) -> Image {
    TracedScene::build(*scene).render(camera, size, quality)
}

/// One picture's cost.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct TraceCost {
    /// Rays traced: from the camera, for shadows, for occlusion.
    pub rays: u64,
}

impl TracedScene<'_> {
    /// The picture from one camera, on all cores.
    pub fn render(&self, camera: &OrbitCamera, size: Size, quality: TraceQuality) -> Image {
        self.render_on(thread::available_parallelism().map_or(1, NonZero::get), camera, size, quality).0
    }

    /// The picture and its cost, on this many threads; the bytes do not depend on how many.
    pub fn render_on(
        &self,
        threads: usize,
        camera: &OrbitCamera,
        size: Size,
        quality: TraceQuality,
    ) -> (Image, TraceCost) {
        let view = camera.view(size.width as f32 / size.height.max(1) as f32);
        let lighting = Lighting::new(&view, self.bounds(), self.scene.floor);
        let tracer = RayTracer::new(self, lighting, view, size, quality.samples());
        self.render_passes(&tracer, threads)
    }

    /// The three passes over all pixels.
    pub(crate) fn render_passes(&self, tracer: &RayTracer<'_>, threads: usize) -> (Image, TraceCost) {
        let size = tracer.size;
        let (width, pixels) = (size.width.max(1) as usize, size.width as usize * size.height as usize);
        let mut hits = vec![PrimaryHit::default(); pixels];
        by_rows(threads, hits.chunks_mut(width), |y, row| tracer.trace_primary(y, row));
        let mut lights = vec![PixelLight::default(); pixels];
        by_rows(threads, lights.chunks_mut(width), |y, row| tracer.trace_light(y, &hits, row));
        let mut image = Image::filled(size, [0; 3]);
        by_rows(threads, image.rows_mut(), |y, row| filter_and_tone_map(y, tracer, &hits, &lights, row));
        let rays = lights.iter().map(|t| u64::from(t.rays)).sum::<u64>() + pixels as u64;
        (image, TraceCost { rays })
    }
}

/// Distributes the rows over the threads; each takes the next free row.
fn by_rows<R: Send>(threads: usize, rows: impl Iterator<Item = R> + Send, work: impl Fn(u32, R) + Sync) {
    let rows = Mutex::new((0..).zip(rows));
    thread::scope(|scope| {
        for _ in 0..threads.max(1) {
            scope.spawn(|| {
                loop {
                    let next = rows.lock().unwrap_or_else(PoisonError::into_inner).next();
                    let Some((y, row)) = next else { break };
                    work(y, row);
                }
            });
        }
    });
}

#[cfg(test)]
mod tests {
    use glam::Vec3;

    use super::*;
    use crate::{
        scene::{Colours, Material, PictureSurface},
        tone_mapping,
    };

    /// A ball of radius 0.5 around (0, 1, 0): positions, normals, triangles.
    fn ball() -> (Vec<Vec3>, Vec<Vec3>, Vec<[u32; 3]>) {
        let (around, rings) = (48, 24);
        let normals: Vec<_> = (0..=rings)
            .flat_map(|r| (0..around).map(move |a| (r as f32 / rings as f32, a as f32 / around as f32)))
            .map(|(r, a)| {
                let (polar, turn) = (r * std::f32::consts::PI, a * std::f32::consts::TAU);
                Vec3::new(polar.sin() * turn.sin(), polar.cos(), polar.sin() * turn.cos())
            })
            .collect();
        let triangles = (0..rings)
            .flat_map(|r| (0..around).map(move |a| (r * around + a, r * around + (a + 1) % around)))
            .flat_map(|(a, b)| [[a, a + around, b], [b, a + around, b + around]])
            .collect();
        (normals.iter().map(|n| *n * 0.5 + Vec3::Y).collect(), normals, triangles)
    }

    /// In a furnace (equal light from everywhere, no lamps) a convex thing that reflects everything looks just like
    /// its surroundings: it neither swallows nor makes light.
    #[test]
    fn a_white_ball_vanishes_in_the_furnace() {
        let (positions, normals, triangles) = ball();
        let level = 0.6;
        for material in [Material::Skin, Material::Cloth, Material::Diffuse] {
            let surface = PictureSurface {
                positions: &positions,
                normals: &normals,
                triangles: &triangles,
                colours: Colours::One(Vec3::ONE),
                material,
                look: None,
            };
            let surfaces = [surface];
            let stage = TracedScene::build(PictureScene { surfaces: &surfaces, floor: false });
            let size = Size::new(40, 40);
            let view = OrbitCamera::front(&stage.bounds(), 1.0).view(1.0);
            let lighting = Lighting::furnace(&view, stage.bounds(), level);
            let (image, _) =
                stage.render_passes(&RayTracer::new(&stage, lighting, view, size, TraceQuality::Still.samples()), 1);
            let want = tone_mapping::bytes(tone_mapping::compress(Vec3::splat(level)), 0.0);
            for (x, y) in [(20, 20), (12, 20), (20, 10), (26, 26), (20, 31), (8, 20)] {
                let got = image.pixel(x, y).unwrap();
                let far = got.iter().zip(want).map(|(a, b)| a.abs_diff(b)).max().unwrap();
                assert!(far <= 1, "{material:?} at ({x}, {y}): {got:?}, the furnace is {want:?}");
            }
        }
    }
}
