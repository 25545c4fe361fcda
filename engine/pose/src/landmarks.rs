//! The body's landmarks within a region of a picture.

use glam::{Vec2, Vec3};
use toile_sensors::person_mask::PersonMask;
use toile_sensors::source::live::ColourImage;

use crate::network::{Network, logistic};
use crate::region::{Border, Region};
use crate::tflite::NetworkFault;

/// Landmarks of a body.
pub const POINTS: usize = 33;

/// Landmarks of the network, the last of which say where the body will be next, and of its body in metres.
const ALL: usize = 39;

/// Numbers of a landmark: place, visibility, presence.
const NUMBERS: usize = 5;

/// Side of the network's image (px).
const SIDE: usize = 256;

/// One landmark.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct PoseLandmark {
    /// Place in the picture (px).
    pub pixel: Vec2,
    /// Place from the middle of the hips (m, of a body of the network's own idea of size): x right, y down, z away from the camera.
    pub world: Vec3,
    /// How likely it is in view, not hidden, and within the picture: 0 to 1.
    pub confidence: f32,
}

/// What the network says of a region.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Landmarks {
    /// How likely a person is there, 0 to 1.
    pub presence: f32,
    /// The landmarks, in the network's order.
    pub points: [PoseLandmark; POINTS],
    /// Middle of the hips and a point of the circle around the body (px): where to look next.
    pub next: [Vec2; 2],
}

impl Landmarks {
    /// Whether every number is finite.
    pub fn is_finite(&self) -> bool {
        let finite = |p: &PoseLandmark| p.pixel.is_finite() && p.world.is_finite() && p.confidence.is_finite();
        self.presence.is_finite() && self.points.iter().all(finite) && self.next.iter().all(|p| p.is_finite())
    }
}

/// Places of the mask that one of a [`PersonMask`] stands for, across and down.
const COARSER: usize = 2;

/// Finds landmarks in regions.
#[derive(Debug)]
pub struct Landmarker {
    network: Network,
    /// Which parts of the last region show the person, where that is wanted.
    mask: Option<PersonMask>,
}

impl Landmarker {
    /// Of the file of one of the two networks; with the mask of the person, or without. Called at load: it allocates.
    ///
    /// # Errors
    /// A file of another network.
    pub fn load(bytes: &[u8], with_mask: bool) -> Result<Self, NetworkFault> {
        let wanted: [&[usize]; 4] = [&[1, ALL * NUMBERS], &[1, 1], &[1, ALL * 3], &[1, SIDE, SIDE, 1]];
        let network = Network::load(bytes, &wanted[..3 + usize::from(with_mask)])?;
        network.takes_square(SIDE)?;
        let side = SIDE / COARSER;
        let mask = with_mask.then(|| PersonMask { side: 0, odds: vec![0.0; side * side], ..PersonMask::default() });
        Ok(Self { network, mask })
    }

    /// Which parts of the last region show the person; none where that was not wanted.
    pub fn mask(&self) -> Option<&PersonMask> {
        self.mask.as_ref()
    }

    /// Forgets where the person was.
    pub fn wipe_mask(&mut self) {
        if let Some(mask) = &mut self.mask {
            mask.wipe();
        }
    }

    fn take_mask(&mut self, region: &Region) {
        let Some(mask) = &mut self.mask else { return };
        let raw = self.network.output(3);
        mask.side = SIDE / COARSER;
        mask.from_picture = region.from_picture();
        for (at, odds) in mask.odds.iter_mut().enumerate() {
            let (x, y) = (at % mask.side * COARSER, at / mask.side * COARSER);
            *odds = logistic(raw[y * SIDE + x]);
        }
    }

    /// The landmarks in a region.
    pub fn find(&mut self, picture: &ColourImage, region: &Region) -> Landmarks {
        region.sample(picture, Border::Nearest, [1.0, 0.0], self.network.input(), SIDE);
        self.network.run();
        self.take_mask(region);
        let (raw, world) = (self.network.output(0).as_chunks::<NUMBERS>().0, self.network.output(2).as_chunks::<3>().0);
        let pixel = |k: usize| region.pixel(Vec2::new(raw[k][0], raw[k][1]) / SIDE as f32);
        let size = Vec2::new(picture.width as f32, picture.height as f32);
        let turn = region.turn();
        let points = std::array::from_fn(|k| {
            let pixel = pixel(k);
            let [x, y, z] = world[k];
            let within = pixel.cmpge(Vec2::ZERO).all() && pixel.cmple(size).all();
            let [.., visibility, presence] = raw[k].map(logistic);
            let confidence = if within { visibility.min(presence) } else { 0.0 };
            PoseLandmark { pixel, world: (turn * Vec2::new(x, y)).extend(z), confidence }
        });
        Landmarks { presence: self.network.output(1)[0], points, next: [pixel(POINTS), pixel(POINTS + 1)] }
    }
}
