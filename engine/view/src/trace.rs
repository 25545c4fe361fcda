//! The picture: a scene made ready, and its three passes: survey, expose, develop.
//!
//! Every number that jitters comes from the pixel and the sample's number (`sample`), and every pixel is written by one
//! thread alone, so a picture has the same bytes for any number of threads.

use std::{
    num::NonZero,
    sync::{Mutex, PoisonError},
    thread,
};

use crate::{
    develop::develop,
    expose::{Guide, Plan, Shot, Texel},
    image::{Image, Size},
    scene::{Camera, Scene},
    studio::Studio,
};

pub use crate::stage::Stage;

/// How much work a picture is worth.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Quality {
    /// To be looked at: eight samples a pixel, four times as many along edges.
    Still,
    /// One frame of an animation: two samples a pixel, eight along edges.
    Motion,
}

impl Quality {
    fn plan(self) -> Plan {
        match self {
            Self::Still => Plan { inside: 8, edge: 32, reach: 3 },
            Self::Motion => Plan { inside: 2, edge: 8, reach: 3 },
        }
    }
}

/// Renders one picture: builds the tree and looks once. Several views of one scene share a [`Stage`].
pub fn render(scene: &Scene<'_>, camera: &Camera, size: Size, quality: Quality) -> Image {
    Stage::build(*scene).render(camera, size, quality)
}

/// One picture's cost.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Cost {
    /// Rays walked through the tree: from the eye, for shadows, for occlusion.
    pub rays: u64,
}

impl Stage<'_> {
    /// The picture from one camera, on all cores.
    pub fn render(&self, camera: &Camera, size: Size, quality: Quality) -> Image {
        self.render_on(thread::available_parallelism().map_or(1, NonZero::get), camera, size, quality).0
    }

    /// The picture and its cost, on this many threads; the bytes do not depend on how many.
    pub fn render_on(&self, threads: usize, camera: &Camera, size: Size, quality: Quality) -> (Image, Cost) {
        let view = camera.view(size.width as f32 / size.height.max(1) as f32);
        let studio = Studio::new(&view, self.bounds(), self.scene.floor);
        let shot = Shot::new(self, studio, view, size, quality.plan());
        self.take(&shot, threads)
    }

    /// The three passes over all pixels.
    pub(crate) fn take(&self, shot: &Shot<'_>, threads: usize) -> (Image, Cost) {
        let size = shot.size;
        let (width, pixels) = (size.width.max(1) as usize, size.width as usize * size.height as usize);
        let mut guides = vec![Guide::default(); pixels];
        by_rows(threads, guides.chunks_mut(width), |y, row| shot.survey(y, row));
        let mut texels = vec![Texel::default(); pixels];
        by_rows(threads, texels.chunks_mut(width), |y, row| shot.expose(y, &guides, row));
        let mut image = Image::filled(size, [0; 3]);
        by_rows(threads, image.rows_mut(), |y, row| develop(y, shot, &guides, &texels, row));
        let rays = texels.iter().map(|t| u64::from(t.rays)).sum::<u64>() + pixels as u64;
        (image, Cost { rays })
    }
}

/// Lends every row to one of the threads, which takes the next row that nobody has taken.
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
        scene::{Colours, Material, Surface},
        tone,
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
        for material in [Material::Skin, Material::Cloth, Material::Chart] {
            let surface = Surface {
                positions: &positions,
                normals: &normals,
                triangles: &triangles,
                colours: Colours::One(Vec3::ONE),
                material,
            };
            let surfaces = [surface];
            let stage = Stage::build(Scene { surfaces: &surfaces, floor: false });
            let size = Size::new(40, 40);
            let view = Camera::front(&stage.bounds(), 1.0).view(1.0);
            let studio = Studio::furnace(&view, stage.bounds(), level);
            let (image, _) = stage.take(&Shot::new(&stage, studio, view, size, Quality::Still.plan()), 1);
            let want = tone::bytes(tone::compress(Vec3::splat(level)), 0.0);
            for (x, y) in [(20, 20), (12, 20), (20, 10), (26, 26), (20, 31), (8, 20)] {
                let got = image.pixel(x, y).unwrap();
                let far = got.iter().zip(want).map(|(a, b)| a.abs_diff(b)).max().unwrap();
                assert!(far <= 1, "{material:?} at ({x}, {y}): {got:?}, the furnace is {want:?}");
            }
        }
    }
}
