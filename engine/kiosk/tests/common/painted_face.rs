//! A drawn face before a camera: a head of another shape than the mannequin's with a painted face, drawn by the ray tracer, of which every
//! point's true place is known.

use glam::{DVec3, Vec2, Vec3};
use toile_assets::body::base::BaseBody;
use toile_assets::body::shape::Shapes;
use toile_base::body::{Region, Sex};
use toile_base::frame::Intrinsics;
use toile_base::mesh::vertex_normals;
use toile_base::numeric::random::SplitMix64;
use toile_base::skeleton::Joint;
use toile_base::texture::Texture;
use toile_pose::face::FaceLandmarks;
use toile_sensors::source::live::ColourImage;
use toile_view::cloth_look::{GarmentLook, TileLevels};
use toile_view::figure::{Hair, HairMesh};
use toile_view::image::{Size, linear};
use toile_view::scene::{Colours, Material, OrbitCamera, PictureScene, PictureSurface};
use toile_view::trace::{TraceQuality, TracedScene};

/// Texels along a side of the painted atlas.
const ATLAS: usize = 2_048;

/// Colours of the painting (sRGB).
const SKIN: [f32; 3] = [214.0, 165.0, 136.0];
const LIPS: [f32; 3] = [178.0, 92.0, 88.0];
const DARK: [f32; 3] = [62.0, 44.0, 36.0];
const WHITE: [f32; 3] = [236.0, 232.0, 226.0];
const IRIS: [f32; 3] = [84.0, 68.0, 48.0];
const HAIR: [u8; 3] = [76, 57, 47];

/// A head with its painting, about the middle of its head.
pub struct PaintedHead {
    pub sex: Sex,
    /// Vertices of the whole body (m) `[vertices]`.
    pub truth: Vec<DVec3>,
    look: GarmentLook,
    hair: HairMesh,
}

/// How a picture is taken: of what so far below the middle of the head (m), from how far (m), from how far to their left and from how high over
/// it (rad, m), with how many pixels a side.
#[derive(Debug, Clone, Copy)]
pub struct Shot {
    pub below: f32,
    pub distance: f32,
    pub yaw: f32,
    pub height: f32,
    pub size: Size,
    pub fov_y: f32,
}

impl PaintedHead {
    /// Sides stretched, another nose and chin: a head that is not the mannequin's.
    pub fn new(sex: Sex, seed: u64) -> Self {
        let base = Shapes::of(sex).base();
        let truth = stranger(base, seed);
        let single: Vec<Vec3> = truth.iter().map(|p| p.as_vec3()).collect();
        let joint = base.skeleton.at(Joint::Head);
        let hair = HairMesh::of(&single, &base.regions, &base.triangles, joint, Hair::usual(sex)).unwrap();
        Self { sex, look: painted(base, &truth), truth, hair }
    }

    /// Where the 68 points are (m).
    pub fn marks(&self) -> Vec<DVec3> {
        FaceLandmarks::new().on(&self.truth)
    }

    /// The vertices of the face between chin and brow.
    pub fn face(&self) -> Vec<usize> {
        let base = Shapes::of(self.sex).base();
        let middle = middle(base);
        let is_face = |v: &usize| {
            let p = base.positions[*v].as_dvec3() - middle;
            base.regions[*v] == Region::Head && p.z > 0.02 && p.y < 0.09 && p.y > -0.06
        };
        (0..base.positions.len()).filter(is_face).collect()
    }

    fn camera(&self, shot: &Shot) -> OrbitCamera {
        let Shot { below, distance, yaw, height, fov_y, .. } = *shot;
        let target = middle(Shapes::of(self.sex).base()).as_vec3() - Vec3::Y * below;
        OrbitCamera { target, yaw, height, distance, fov_y }
    }

    /// The lens of a shot.
    pub fn lens(shot: &Shot) -> Intrinsics {
        let (width, height) = (shot.size.width, shot.size.height);
        let f = 0.5 * height as f32 / (0.5 * shot.fov_y).tan();
        Intrinsics { width, height, fx: f, fy: f, cx: 0.5 * width as f32 - 0.5, cy: 0.5 * height as f32 - 0.5 }
    }

    /// Where a place (m) is from the camera: right, down, ahead (m).
    pub fn seen(&self, shot: &Shot, place: DVec3) -> DVec3 {
        let camera = self.camera(shot);
        let back = Vec3::new(shot.yaw.sin(), 0.0, shot.yaw.cos());
        let origin = camera.target + back * shot.distance + Vec3::Y * shot.height;
        let forward = (camera.target - origin).normalize().as_dvec3();
        let right = Vec3::new(shot.yaw.cos(), 0.0, -shot.yaw.sin()).as_dvec3();
        let to = place - origin.as_dvec3();
        DVec3::new(to.dot(right), -to.dot(right.cross(forward)), to.dot(forward))
    }

    /// The picture, and where the 68 points are in it (px, whole numbers at the middles of pixels).
    pub fn taken(&self, shot: &Shot) -> (ColourImage, Vec<Vec2>) {
        let base = Shapes::of(self.sex).base();
        let positions: Vec<Vec3> = self.truth.iter().map(|p| p.as_vec3()).collect();
        let mut normals = vec![Vec3::ZERO; positions.len()];
        vertex_normals(&positions, &base.triangles, &mut normals);
        let colour = |c: [f32; 3]| Vec3::from_array(c.map(|b| linear(b / 255.0)));
        let surfaces = [
            PictureSurface {
                positions: &positions,
                normals: &normals,
                triangles: &base.triangles,
                colours: Colours::One(colour(SKIN)),
                material: Material::Skin,
                look: Some(self.look.shown()),
            },
            PictureSurface {
                positions: &self.hair.positions,
                normals: &self.hair.normals,
                triangles: &self.hair.triangles,
                colours: Colours::One(colour(HAIR.map(f32::from))),
                material: Material::Skin,
                look: None,
            },
        ];
        let scene = TracedScene::build(PictureScene { surfaces: &surfaces, floor: shot.below > 0.5 });
        let image = scene.render(&self.camera(shot), shot.size, TraceQuality::Motion);
        let rgb = image.bytes().to_vec();
        let picture = ColourImage { width: shot.size.width, height: shot.size.height, rgb };
        let k = Self::lens(shot);
        let pixel = |p: DVec3| {
            let p = self.seen(shot, p);
            Vec2::new(k.cx + k.fx * (p.x / p.z) as f32, k.cy + k.fy * (p.y / p.z) as f32)
        };
        (picture, self.marks().into_iter().map(pixel).collect())
    }
}

fn middle(base: &BaseBody) -> DVec3 {
    base.skeleton.at(Joint::Head).as_dvec3() + DVec3::new(0.0, 0.06, 0.03)
}

/// A head of other proportions, with another nose and chin, not quite symmetric.
fn stranger(base: &BaseBody, seed: u64) -> Vec<DVec3> {
    let mut rng = SplitMix64::new(seed);
    let mut g = || f64::from(rng.gaussian());
    let middle = middle(base);
    let stretch = DVec3::new(0.04 * g(), 0.03 * g(), 0.04 * g());
    let (nose, chin) = (DVec3::new(0.0, 0.002 * g(), 0.003 * g()), DVec3::new(0.0, 0.003 * g(), 0.003 * g()));
    let cheek = DVec3::new(0.001 * g(), 0.001 * g(), 0.001 * g());
    let drawn: Vec<DVec3> = base.positions.iter().map(|p| p.as_dvec3()).collect();
    let marks = FaceLandmarks::new().on(&drawn);
    let bump = |p: DVec3, at: DVec3, wide: f64| (-p.distance_squared(at) / (2.0 * wide * wide)).exp();
    let moved = |(p, region): (&DVec3, &Region)| {
        // Below the head the body is as it is drawn.
        let share = if *region == Region::Head { ((p.y - marks[8].y + 0.03) / 0.03).clamp(0.0, 1.0) } else { 0.0 };
        let way = (*p - middle) * stretch + nose * bump(*p, marks[30], 0.014) + chin * bump(*p, marks[8], 0.022);
        *p + (way + cheek * bump(*p, marks[3], 0.03)) * share
    };
    drawn.iter().zip(&base.regions).map(moved).collect()
}

/// The atlas with the face painted where the points of this head are.
fn painted(base: &BaseBody, truth: &[DVec3]) -> GarmentLook {
    let marks: Vec<Vec2> = FaceLandmarks::new().on(truth).iter().map(|p| p.as_vec3().truncate()).collect();
    let ears = FaceLandmarks::new().on(truth)[0].z as f32;
    let [r, g, b] = SKIN.map(|c| c as u8);
    let mut texels = vec![[r, g, b, 255]; ATLAS * ATLAS];
    for (t, corners) in base.triangles.iter().zip(base.triangle_corners()) {
        if !t.iter().all(|v| base.regions[*v as usize] == Region::Head) {
            continue;
        }
        let places = t.map(|v| truth[v as usize].as_vec3());
        let uv = corners.map(|k| {
            let uv = base.uvs[k as usize];
            Vec2::new(uv.x, 1.0 - uv.y) * ATLAS as f32 - 0.5
        });
        for_each_texel(uv, |at, weights| {
            let p: Vec3 = places.iter().zip(weights).map(|(p, w)| *p * w).sum();
            if p.z > ears {
                let [r, g, b] = paint(p.truncate(), &marks).map(|c| c.clamp(0.0, 255.0) as u8);
                texels[at] = [r, g, b, 255];
            }
        });
    }
    let tile = Texture { width: ATLAS as u32, height: ATLAS as u32, texels };
    let corners = base.triangle_corners().iter().map(|t| t.map(|k| base.uvs[k as usize])).collect();
    GarmentLook { tile: Some(TileLevels::of(&tile)), corners, opacity: 1.0, ..GarmentLook::default() }
}

fn for_each_texel([a, b, c]: [Vec2; 3], mut each: impl FnMut(usize, [f32; 3])) {
    let area = (b - a).perp_dot(c - a);
    let (low, high) = (a.min(b).min(c) - 1.0, a.max(b).max(c) + 1.0);
    if area.abs() < 1e-6 {
        return;
    }
    for y in low.y.max(0.0) as usize..=(high.y.max(0.0) as usize).min(ATLAS - 1) {
        for x in low.x.max(0.0) as usize..=(high.x.max(0.0) as usize).min(ATLAS - 1) {
            let p = Vec2::new(x as f32, y as f32);
            let (wb, wc) = ((p - a).perp_dot(c - a) / area, (b - a).perp_dot(p - a) / area);
            let weights = [1.0 - wb - wc, wb, wc];
            if weights.iter().all(|w| *w > -0.2) {
                each(y * ATLAS + x, weights);
            }
        }
    }
}

/// The colour of a place of the face as it is seen from before (m).
fn paint(p: Vec2, marks: &[Vec2]) -> [f32; 3] {
    let mut colour = SKIN;
    let mut mix = |with: [f32; 3], share: f32| {
        let share = share.clamp(0.0, 1.0);
        colour.iter_mut().zip(with).for_each(|(c, w)| *c += (w - *c) * share);
    };
    let soft = |distance: f32, wide: f32| 1.0 - (distance / wide).clamp(0.0, 1.0);
    let near = |at: Vec2, wide: f32| (-(p - at).length_squared() / (2.0 * wide * wide)).exp();
    // Cheeks, the sides of the nose, the hollows of the eyes, the fold below the lip.
    [3, 13].into_iter().for_each(|k| mix([216.0, 140.0, 120.0], 0.45 * near(marks[k].lerp(marks[30], 0.45), 0.014)));
    [31, 35].into_iter().for_each(|k| mix(DARK, 0.25 * near(marks[k], 0.004)));
    [[36, 39], [42, 45]].into_iter().for_each(|[a, b]| mix(DARK, 0.22 * near(marks[a].midpoint(marks[b]), 0.016)));
    mix(DARK, 0.2 * near(marks[57].lerp(marks[8], 0.3), 0.006));
    [32, 34].into_iter().for_each(|k| mix(DARK, 0.9 * near(marks[k], 0.002)));
    // Brows.
    for brow in [17..21, 22..26] {
        let off = brow.map(|k| to_segment(p, marks[k], marks[k + 1])).fold(f32::MAX, f32::min);
        mix(DARK, 0.85 * soft(off - 0.0012, 0.0014));
    }
    // Eyes: white, iris, pupil, the line of the lashes.
    for eye in [36, 42] {
        let outline: Vec<Vec2> = (eye..eye + 6).map(|k| marks[k]).collect();
        let centre = outline.iter().copied().sum::<Vec2>() / 6.0;
        let inside = soft(-to_polygon(p, &outline), 0.0006);
        mix(WHITE, inside);
        mix(IRIS, inside * soft(p.distance(centre) - 0.0048, 0.0006));
        mix([18.0; 3], inside * soft(p.distance(centre) - 0.002, 0.0005));
        let upper = (eye..eye + 3).map(|k| to_segment(p, marks[k], marks[k + 1])).fold(f32::MAX, f32::min);
        mix(DARK, 0.9 * soft(upper - 0.0006, 0.0008));
        let lower = [(3, 4), (4, 5), (5, 0)].map(|(a, b)| to_segment(p, outline[a], outline[b]));
        mix(DARK, 0.4 * soft(lower.into_iter().fold(f32::MAX, f32::min) - 0.0002, 0.0008));
    }
    // Lips, and the line between them.
    let lips: Vec<Vec2> = (48..60).map(|k| marks[k]).collect();
    mix(LIPS, soft(-to_polygon(p, &lips), 0.001));
    let between = [48, 60, 61, 62, 63, 64, 54].windows(2).map(|w| to_segment(p, marks[w[0]], marks[w[1]]));
    mix(DARK, 0.8 * soft(between.fold(f32::MAX, f32::min) - 0.0003, 0.0009));
    colour
}

fn to_segment(p: Vec2, a: Vec2, b: Vec2) -> f32 {
    let t = ((p - a).dot(b - a) / (b - a).length_squared().max(1e-12)).clamp(0.0, 1.0);
    p.distance(a.lerp(b, t))
}

/// How far inside of a polygon a place lies, negative outside of it (m).
fn to_polygon(p: Vec2, outline: &[Vec2]) -> f32 {
    let mut inside = false;
    let mut off = f32::MAX;
    for (i, a) in outline.iter().enumerate() {
        let b = outline[(i + 1) % outline.len()];
        off = off.min(to_segment(p, *a, b));
        if (a.y > p.y) != (b.y > p.y) && p.x < (b.x - a.x) * (p.y - a.y) / (b.y - a.y) + a.x {
            inside = !inside;
        }
    }
    if inside { off } else { -off }
}
