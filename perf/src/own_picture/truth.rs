//! The true wearer of the garment: the cameras' view of them without it, and the garment's true place.

use glam::Vec3;
use toile_assets::scene::SHOPPER;
use toile_base::clock::ticks_to_ns;
use toile_base::frame::{DepthFrame, Intrinsics};
use toile_base::numeric::random::SplitMix64;
use toile_engine::triple_buffer::Reader;
use toile_engine::world::{Snapshot, World};
use toile_fitting::FittingError;
use toile_fitting::dress::try_on::{DressedWorld, RequestedGarment, TryOn};
use toile_sensors::source::live::ColourImage;
use toile_sensors::source::synthetic::{KinectNoise, SyntheticCamera, room};
use toile_view::drawn_frame::DrawnFrame;
use toile_view::figure::{Appearance, Hair};

use super::motion::OwnMotion;
use super::outline::{self, Outline};
use crate::webcam::scene;

/// Label of the garment in the view of the truth: after floor and body.
const GARMENT: u8 = room::PERSON + 1;

/// What the cameras see at a moment.
pub struct TruthMoment {
    /// Which picture it is.
    pub number: u64,
    /// When it was taken (ns).
    pub time_ns: u64,
    /// The colour camera's picture: the person without the garment.
    pub picture: ColourImage,
    /// Depth from the same place, with a Kinect's noise.
    pub depth: DepthFrame,
}

/// The person, in the garments or without any.
pub struct Actor {
    motion: OwnMotion,
    world: World,
    reader: Reader<Snapshot>,
    bare: DrawnFrame,
    dressed: DrawnFrame,
    random: SplitMix64,
    noise: KinectNoise,
    /// The outline of the last picture, and which it is of; the garment's pixels in it.
    known: Option<(u64, Outline)>,
    real: Option<(u64, ColourImage)>,
}

fn appearance() -> Appearance {
    Appearance { hair: Hair::Short, ..Appearance::default() }
}

impl Actor {
    /// Dresses the actor in garments of these names and sizes; there may be none.
    pub fn new(motion: OwnMotion, garments: &[RequestedGarment]) -> Result<Self, FittingError> {
        let (sex, measures) = SHOPPER;
        let request = TryOn::of_body("truth", sex, measures, garments.to_vec());
        let body = toile_assets::body::build(sex, &measures).map_err(FittingError::input)?;
        let DressedWorld { world, reader, .. } = request.build(&motion.joints(&body.skeleton, 0.0, 0))?;
        Ok(Self {
            motion,
            bare: DrawnFrame::of(world.body(), &[], appearance()),
            dressed: DrawnFrame::new(&world, appearance()),
            world,
            reader,
            random: SplitMix64::new(7),
            noise: KinectNoise::new(7),
            known: None,
            real: None,
        })
    }

    /// A step of 120 Hz.
    pub fn step(&mut self, tick: u64) {
        let time_ns = ticks_to_ns(tick);
        let joints = self.motion.joints(&self.world.body().skeleton, time_ns as f32 * 1e-9, time_ns);
        self.world.step(&joints);
    }

    /// The same after the steps that lead to a picture.
    pub fn moment_at(&mut self, tick: u64, number: u64) -> TruthMoment {
        while self.world.tick() <= tick {
            self.step(self.world.tick());
        }
        self.moment(tick, number)
    }

    /// What the cameras see now.
    pub fn moment(&mut self, tick: u64, number: u64) -> TruthMoment {
        let time_ns = ticks_to_ns(tick);
        let snapshot = self.reader.latest().clone();
        self.bare.place(&[] as &[Box<[Vec3]>], &snapshot.skin);
        self.dressed.update(&snapshot);
        let surfaces = self.bare.surfaces(None);
        let camera = scene::camera();
        let view = room::view(&camera, scene::WALL, &[(surfaces[0].positions, surfaces[0].triangles)]);
        let depth = camera.frame(time_ns, self.noise.apply(&camera.intrinsics, &view.z));
        let picture = scene::picture(&surfaces, &mut self.random);
        TruthMoment { number, time_ns, picture, depth }
    }

    /// Where the garment is seen in this moment, which is the last that was taken.
    pub fn outline(&mut self, moment: &TruthMoment) -> &Outline {
        if self.known.as_ref().is_none_or(|(number, _)| *number != moment.number) {
            let [width, height] = outline::SIZE;
            let small = scene::camera();
            let k = small.intrinsics;
            let scale = height as f32 / k.height as f32;
            let centre = |c: f32| (c + 0.5) * scale - 0.5;
            let intrinsics =
                Intrinsics { width, height, fx: k.fx * scale, fy: k.fy * scale, cx: centre(k.cx), cy: centre(k.cy) };
            let surfaces = self.dressed.surfaces(None);
            let seen: Vec<_> = surfaces.iter().map(|s| (s.positions, s.triangles)).collect();
            let view = room::view(&SyntheticCamera { intrinsics, ..small }, scene::WALL, &seen);
            let mask: Vec<bool> = view.label.iter().map(|label| *label >= GARMENT).collect();
            // The mirror shows left on the left.
            let mirrored: Vec<bool> = mask.chunks(width as usize).flat_map(|row| row.iter().rev().copied()).collect();
            self.known = Some((moment.number, Outline::of(&mirrored)));
        }
        let (_, outline) = self.known.as_ref().expect("it was made just now");
        outline
    }

    /// The picture as it would be of a person who wears the garment.
    pub fn real(&mut self, moment: &TruthMoment) -> &ColourImage {
        if self.real.as_ref().is_none_or(|(number, _)| *number != moment.number) {
            let picture = scene::picture(&self.dressed.surfaces(None), &mut self.random);
            self.real = Some((moment.number, picture));
        }
        let (_, picture) = self.real.as_ref().expect("it was made just now");
        picture
    }

    /// Brightness of the cloth in the mirror (RGB) and in the truth, where both show it: sums; looked at in every sixth picture.
    pub fn brightness(&mut self, moment: &TruthMoment, mirror: &[u8]) -> [f64; 2] {
        if !moment.number.is_multiple_of(10) {
            return [0.0; 2];
        }
        let mask = self.outline(moment).mask().to_vec();
        let real = self.real(moment);
        let [width, height] = outline::SIZE.map(|n| n as usize);
        let mut sums = [0.0; 2];
        let (across, down) = (real.width as usize, real.height as usize);
        for (at, pixel) in mirror.as_chunks::<3>().0.iter().enumerate().filter(|(at, _)| mask[*at]) {
            let (x, y) = ((width - 1 - at % width) * across / width, at / width * down / height);
            let other = &real.rgb[3 * (y * across + x)..][..3];
            sums[0] += pixel.iter().map(|c| f64::from(*c)).sum::<f64>();
            sums[1] += other.iter().map(|c| f64::from(*c)).sum::<f64>();
        }
        sums
    }
}
