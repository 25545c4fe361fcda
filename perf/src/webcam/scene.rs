//! People who move before a webcam and a depth camera at one place: what both see, and where their joints really are.

use glam::{Affine3A, Vec3};
use toile_assets::body::BodyError;
use toile_assets::scene::shopper;
use toile_base::body::Body;
use toile_base::clock::SECOND_NS;
use toile_base::frame::{DepthFrame, Intrinsics, Joints};
use toile_base::numeric::random::SplitMix64;
use toile_base::skeleton::BONES;
use toile_engine::body::{JointFrames, palette};
use toile_engine::skin::SkinningJob;
use toile_engine::world::BLEND;
use toile_pose::scale::WebcamMount;
use toile_sensors::source::live::ColourImage;
use toile_sensors::source::synthetic::{KinectNoise, SyntheticCamera, room};
use toile_view::image::Size;
use toile_view::scene::{Colours, MANNEQUIN, Material, OrbitCamera, PictureScene, PictureSurface};
use toile_view::trace::{TraceQuality, TracedScene};

use toile_assets::people::SizedPerson;

/// Width and height of the pictures (px), and the focal length of a webcam that sees 60 degrees.
pub const SIZE: [u32; 2] = [640, 480];
const FOCAL: f32 = 0.87 * 640.0;

/// Where the cameras are, and the point at which they look (m).
const PLACE: Vec3 = Vec3::new(0.0, 1.4, 2.8);
const TARGET: Vec3 = Vec3::new(0.0, 0.86, 0.0);

/// Where the wall stands (m).
pub const WALL: f32 = -0.9;

/// Deviation of a webcam's noise (of 255).
const NOISE: f32 = 2.0;

/// What is seen at one moment, and the truth.
pub struct WebcamMoment {
    /// Time since the begin (ns).
    pub time_ns: u64,
    /// The webcam's picture.
    pub picture: ColourImage,
    /// The depth camera's image, with a Kinect's noise.
    pub depth: DepthFrame,
    /// Where the joints are.
    pub truth: Joints,
}

/// The camera of both: the webcam's picture and the depth are seen from one place.
pub fn camera() -> SyntheticCamera {
    let [width, height] = SIZE;
    let (cx, cy) = (0.5 * width as f32 - 0.5, 0.5 * height as f32 - 0.5);
    let intrinsics = Intrinsics { width, height, fx: FOCAL, fy: FOCAL, cx, cy };
    SyntheticCamera::looking_at(intrinsics, PLACE, TARGET)
}

/// How the webcam stands.
pub fn mount() -> WebcamMount {
    let away = TARGET - PLACE;
    WebcamMount { height_m: Some(PLACE.y), down: (-away.y).atan2(-away.z), ..WebcamMount::default() }
}

/// One person who performs.
pub struct Performer {
    body: Body,
    random: SplitMix64,
    noise: KinectNoise,
}

impl Performer {
    /// A person, with the noise of a seed.
    ///
    /// # Errors
    /// A body that cannot be made.
    pub fn new(person: &SizedPerson, seed: u64) -> Result<Self, BodyError> {
        Ok(Self { body: person.body()?, random: SplitMix64::new(seed), noise: KinectNoise::new(seed) })
    }

    /// What is seen at a time of the performance (s), which is the `number`th picture.
    pub fn at(&mut self, seconds: f32, number: u64, rate_hz: u64) -> WebcamMoment {
        let body = &self.body;
        let job = SkinningJob::new(&body.mesh.positions, &body.normals, &body.weights).expect("a body has its weights");
        let (mut skin, mut normals, mut posed) = (body.mesh.positions.clone(), body.normals.clone(), job.posed());
        let mut bones = [Affine3A::IDENTITY; BONES];
        let pose = shopper(&body.skeleton, seconds);
        palette(&body.skeleton, &pose, &mut bones);
        job.run(BLEND, &bones, &mut posed);
        posed.read(&mut skin, &mut normals);
        let time_ns = number * SECOND_NS / rate_hz;
        let camera = camera();
        let intrinsics = camera.intrinsics;
        let view = room::view(&camera, WALL, &[(&skin, &body.mesh.triangles)]);
        let depth = camera.frame(time_ns, self.noise.apply(&intrinsics, &view.z));
        let surface = PictureSurface {
            positions: &skin,
            normals: &normals,
            triangles: &body.mesh.triangles,
            colours: Colours::One(MANNEQUIN),
            material: Material::Skin,
            look: None,
        };
        let truth = Joints::seen(time_ns, JointFrames::new(&body.skeleton, &pose).position);
        let picture = picture(&[surface], &mut self.random);
        WebcamMoment { time_ns, picture, depth, truth }
    }
}

/// The webcam's picture of surfaces before a plain wall.
pub fn picture(surfaces: &[PictureSurface<'_>], random: &mut SplitMix64) -> ColourImage {
    let [width, height] = SIZE;
    let away = TARGET - PLACE;
    let view = OrbitCamera {
        target: TARGET,
        yaw: 0.0,
        height: -away.y,
        distance: -away.z,
        fov_y: 2.0 * (0.5 * height as f32 / FOCAL).atan(),
    };
    let scene = TracedScene::build(PictureScene { surfaces, floor: true });
    let image = scene.render(&view, Size::new(width, height), TraceQuality::Motion);
    let mut noisy = |v: u8| (f32::from(v) + NOISE * random.gaussian()).round().clamp(0.0, 255.0) as u8;
    let rgb = image.bytes().iter().map(|v| noisy(*v)).collect();
    ColourImage { width, height, rgb }
}

/// The same picture as a webcam sends it: YUYV, by BT.601 with brightness of 16 to 235.
pub fn yuyv(picture: &ColourImage, out: &mut Vec<u8>) {
    for two in picture.rgb.as_chunks::<6>().0 {
        let [first, second] = [0, 3].map(|at| [two[at], two[at + 1], two[at + 2]].map(f32::from));
        let light = |[r, g, b]: [f32; 3]| 16.0 + 0.257 * r + 0.504 * g + 0.098 * b;
        let [r, g, b] = std::array::from_fn(|c| 0.5 * (first[c] + second[c]));
        let (u, v) = (128.0 - 0.148 * r - 0.291 * g + 0.439 * b, 128.0 + 0.439 * r - 0.368 * g - 0.071 * b);
        out.extend([light(first), u, light(second), v].map(|x| x.round().clamp(0.0, 255.0) as u8));
    }
}
