//! The surfaces of one person as they are and as they were measured, and a picture of how far these lie apart.

use std::f32::consts::FRAC_PI_2;

use glam::{Quat, Vec3};
use toile_base::mesh::vertex_normals;
use toile_base::numeric::random::SplitMix64;
use toile_fitting::dress::depth::posed;
use toile_track::fit::measuring::FittedMeasures;
use toile_view::contact_sheet::contact_sheet;
use toile_view::image::{Image, Size};
use toile_view::scene::{Bounds, Colours, Material, OrbitCamera, PictureScene, PictureSurface};
use toile_view::trace::{self, TraceQuality};

use super::standing::{Moment, StandingMotion, StudyPerson};

/// One picture of a body (px).
const PANEL: Size = Size::new(160, 320);

/// Distance that is shown in full colour (m).
const FULL: f32 = 0.02;

/// Linear RGB of a surface where it is true, lies outside, and lies inside.
const RIGHT: Vec3 = Vec3::splat(0.85);
const OUTSIDE: Vec3 = Vec3::new(0.75, 0.06, 0.04);
const INSIDE: Vec3 = Vec3::new(0.03, 0.12, 0.65);

/// A surface that stands, facing the camera (m).
#[derive(Debug, Clone)]
struct StandingSurface {
    positions: Vec<Vec3>,
    normals: Vec<Vec3>,
    triangles: Vec<[u32; 3]>,
}

impl StandingSurface {
    /// A surface at a moment of a turn, turned back to face the camera.
    fn new(mut positions: Vec<Vec3>, triangles: &[[u32; 3]], moment: Moment) -> Self {
        let back = Quat::from_rotation_y(-moment.turned);
        positions.iter_mut().for_each(|p| *p = back * *p);
        let mut normals = vec![Vec3::ZERO; positions.len()];
        vertex_normals(&positions, triangles, &mut normals);
        Self { positions, normals, triangles: triangles.to_vec() }
    }

    /// How far each vertex lies outside another surface (m) `[vertices]`: along the normal of that one's nearest vertex.
    fn outside(&self, other: &Self) -> Vec<f32> {
        let nearest = |p: Vec3| {
            let others = other.positions.iter().enumerate();
            others.min_by(|a, b| a.1.distance_squared(p).total_cmp(&b.1.distance_squared(p))).map(|(i, _)| i)
        };
        let off = |p: &Vec3| nearest(*p).map_or(0.0, |i| (*p - other.positions[i]).dot(other.normals[i]));
        self.positions.iter().map(off).collect()
    }

    fn draw(&self, colours: Colours<'_>, yaw: f32, bounds: &Bounds) -> Image {
        let surface = PictureSurface {
            positions: &self.positions,
            normals: &self.normals,
            triangles: &self.triangles,
            colours,
            material: Material::Skin,
            look: None,
        };
        let camera = OrbitCamera::framing(bounds, yaw, PANEL.width as f32 / PANEL.height as f32);
        trace::render(&PictureScene { surfaces: &[surface], floor: true }, &camera, PANEL, TraceQuality::Motion)
    }
}

/// A person's true surface and the measured ones, each as it stood in the last frame that it was measured from.
#[derive(Debug, Clone)]
pub struct PersonSurfaces {
    /// From the front: true, and measured.
    front: [StandingSurface; 2],
    /// The same once they have turned all round.
    turned: Option<[StandingSurface; 2]>,
}

impl PersonSurfaces {
    /// Measurements from the front and in a turn, each with the moment of its last frame; `None` for a person whose
    /// stance cannot be repeated, because each frame draws a sway of its own.
    pub(super) fn new(
        person: &StudyPerson,
        front: (&FittedMeasures, Moment),
        turned: Option<(&FittedMeasures, Moment)>,
    ) -> Option<Self> {
        matches!(person.motion, StandingMotion::Breathing(_)).then(|| {
            let pair = |(fitted, moment): (&FittedMeasures, Moment)| {
                let mut truth = Vec::new();
                person.stand(moment, &mut SplitMix64::new(0), &mut truth);
                let body = &fitted.body.body;
                [
                    StandingSurface::new(truth, person.triangles(), moment),
                    StandingSurface::new(posed(body, &fitted.pose), &body.mesh.triangles, moment),
                ]
            };
            Self { front: pair(front), turned: turned.map(pair) }
        })
    }

    /// The true body, and the measured ones from the front and after the turn, each from the front and from the left: red
    /// where they lie outside the true one, blue where inside, in full colour from 2 cm.
    pub fn picture(&self) -> Image {
        let mut panels = Vec::new();
        let bounds = Bounds::of(&self.front[0].positions);
        for yaw in [0.0, FRAC_PI_2] {
            panels.push(self.front[0].draw(Colours::One(RIGHT), yaw, &bounds));
        }
        for [truth, measured] in [Some(&self.front), self.turned.as_ref()].into_iter().flatten() {
            let colours: Vec<Vec3> = measured.outside(truth).into_iter().map(coloured).collect();
            for yaw in [0.0, FRAC_PI_2] {
                panels.push(measured.draw(Colours::PerVertex(&colours), yaw, &bounds));
            }
        }
        let captions = ["true", "", "from the front", "", "after a turn", ""];
        let panels: Vec<&Image> = panels.iter().collect();
        contact_sheet(&panels, panels.len(), &captions[..panels.len()])
    }
}

/// The colour of a distance (m).
fn coloured(outside: f32) -> Vec3 {
    let share = (outside / FULL).clamp(-1.0, 1.0);
    RIGHT.lerp(if share > 0.0 { OUTSIDE } else { INSIDE }, share.abs())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_larger_ball_lies_outside_a_smaller_one() {
        let ball = |radius: f32| {
            let corners = [Vec3::X, Vec3::Y, Vec3::Z, -Vec3::X, -Vec3::Y, -Vec3::Z];
            let faces = [[0, 1, 2], [1, 3, 2], [3, 4, 2], [4, 0, 2], [1, 0, 5], [3, 1, 5], [4, 3, 5], [0, 4, 5]];
            StandingSurface::new(corners.map(|p| p * radius).to_vec(), &faces, Moment::default())
        };
        let out = ball(1.01).outside(&ball(1.0));
        assert!(out.iter().all(|o| (o - 0.01).abs() < 1e-5), "{out:?}");
        assert!(ball(1.0).outside(&ball(1.01)).iter().all(|o| (o + 0.01).abs() < 1e-5));
        assert_eq!(coloured(0.0), RIGHT);
        assert_eq!((coloured(0.5), coloured(-0.5)), (OUTSIDE, INSIDE));
    }
}
