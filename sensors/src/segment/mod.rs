//! Finds the shopper in a depth frame: takes the floor away, then finds pieces of surface, people, and the one in the measuring zone.
//!
//! Runs on the sensor thread: at most 5 ms for a 640x480 frame. After the first frame it allocates nothing.
//!
//! No user map is needed. The floor is a plane found by random sampling and then fitted robustly ([`floor`]); what stands on it
//! falls into pieces where depth jumps (`pieces`); pieces that carry a head above a chest are people, and one piece of
//! two people who touch is parted between their heads (`heads`). Of the people, the shopper is the nearest one in the
//! [`Zone`], and stays the shopper until they leave it. No pixel of another person is in the mask.

pub mod floor;
mod grid;
mod heads;
mod people;
mod pieces;

use glam::{Vec2, Vec3};

use floor::{Floor, FloorFinder};
use grid::Grid;
use people::PeopleFinder;
use toile_base::frame::DepthFrame;

pub use grid::same_surface;
pub use people::Person;

/// Where a shopper stands to be measured, on the floor, seen from the camera.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Zone {
    /// Nearest and farthest distance ahead of the camera (m).
    pub ahead: [f32; 2],
    /// Half of its breadth (m).
    pub half_width: f32,
    /// Place of the mark on the floor (x and z in our world, m), if it is known: the shopper is the person nearest to it.
    pub mark: Option<Vec2>,
}

impl Default for Zone {
    fn default() -> Self {
        Self { ahead: [0.6, 4.0], half_width: 0.8, mark: None }
    }
}

impl Zone {
    /// Whether a place on the floor (m: to the camera's right, ahead of it) is in the zone, widened by a margin (m).
    fn holds(&self, place: Vec2, margin: f32) -> bool {
        let [near, far] = self.ahead;
        (near - margin..=far + margin).contains(&place.y) && place.x.abs() <= self.half_width + margin
    }
}

/// The shopper keeps being the shopper up to so far outside the zone (m): one foot on its edge must not flicker.
const LEAVING: f32 = 0.25;

/// Farthest that a shopper moves between two frames (m): a run of 6 m/s at 10 Hz.
const LONGEST_STEP: f32 = 0.6;

/// What a difference of a metre in height weighs against a metre between two places (1): of two people who are as near to where the
/// shopper was, the one of their size is the shopper. Raised arms make a person taller, so that it weighs little.
const SIZE_WEIGHT: f32 = 0.5;

/// A shopper not seen for so long has left (ns).
const FORGOTTEN_NS: u64 = toile_base::clock::SECOND_NS / 2;

/// Result of one frame.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Segmentation<'a> {
    /// 1 where a pixel shows the shopper, else 0 `[width * height]`.
    pub mask: &'a [u8],
    /// The shopper, if one stands in the zone.
    pub shopper: Option<Person>,
    /// How many other people are seen.
    pub others: usize,
    /// Distance of the nearest of these on the floor (m).
    pub nearest_other: Option<f32>,
    /// The floor, once it was seen.
    pub floor: Option<Floor>,
}

/// The shopper of the frames before.
#[derive(Debug, Clone, Copy)]
struct ShopperTrack {
    place: Vec2,
    /// Their height as it was seen (m).
    top: f32,
    seen_ns: u64,
}

/// Finds the shopper, frame by frame.
#[derive(Debug, Clone)]
pub struct Segmenter {
    zone: Zone,
    finder: FloorFinder,
    grid: Grid,
    people: PeopleFinder,
    track: Option<ShopperTrack>,
    mask: Vec<u8>,
}

impl Default for Segmenter {
    fn default() -> Self {
        Self::new(Zone::default())
    }
}

impl Segmenter {
    /// A segmenter that has seen nothing.
    pub fn new(zone: Zone) -> Self {
        Self {
            zone,
            finder: FloorFinder::default(),
            grid: Grid::default(),
            people: PeopleFinder::default(),
            track: None,
            mask: Vec::new(),
        }
    }

    /// Forgets the shopper and the floor.
    pub fn reset(&mut self) {
        *self = Self::new(self.zone);
    }

    /// Finds the shopper in the next frame. The same frames give the same masks.
    pub fn push(&mut self, frame: &DepthFrame) -> Segmentation<'_> {
        let up = frame.camera_to_world.matrix3.transpose() * Vec3::Y;
        self.grid.load(frame);
        self.finder.push(frame, up);
        let height = frame.camera_to_world.translation.y;
        self.grid.stand(self.finder.floor().map_or(Floor { up, height }, |f| *f), self.finder.floor().is_some());
        self.people.find(&mut self.grid, self.zone.ahead[1]);
        let mark = self.zone.mark.map(|mark| on_the_floor(frame, mark));
        let chosen = self.choose(frame.time_ns, mark);
        self.people.gather(&self.grid, chosen);
        self.mask.clear();
        self.mask.resize(frame.depth_mm.len(), 0);
        self.grid.mask(frame, self.people.shopper_cells(), &mut self.mask);
        self.grid.remember(self.people.shopper_cells());
        let shopper = chosen.map(|i| self.people.all()[i]);
        let others = self.people.all().len() - usize::from(chosen.is_some());
        let beside = self.people.all().iter().enumerate().filter(|(i, _)| Some(*i) != chosen);
        let nearest_other = beside.map(|(_, p)| p.place.length()).min_by(f32::total_cmp);
        Segmentation { mask: &self.mask, shopper, others, nearest_other, floor: self.finder.floor().copied() }
    }

    /// Chooses the shopper among the people: the same person as before, by place and by size; once they have left, the nearest in
    /// the zone to the mark, or to the camera if no mark is known. A person who hides the shopper for a moment does not take their place.
    fn choose(&mut self, time_ns: u64, mark: Option<Vec2>) -> Option<usize> {
        let people = self.people.all();
        let nearest = |cost: &dyn Fn(&Person) -> Option<f32>| {
            let costs = people.iter().enumerate().filter_map(|(i, p)| Some((i, cost(p)?)));
            costs.min_by(|a, b| a.1.total_cmp(&b.1)).map(|(i, _)| i)
        };
        let chosen = match self.track.filter(|t| time_ns.saturating_sub(t.seen_ns) <= FORGOTTEN_NS) {
            Some(track) => nearest(&|p| {
                let step = p.place.distance(track.place);
                let near = step < LONGEST_STEP && self.zone.holds(p.place, LEAVING);
                near.then_some(step + SIZE_WEIGHT * (p.top - track.top).abs())
            }),
            None => nearest(&|p| self.zone.holds(p.place, 0.0).then_some(p.place.distance(mark.unwrap_or(Vec2::ZERO)))),
        };
        if let Some(i) = chosen {
            self.track = Some(ShopperTrack { place: people[i].place, top: people[i].top, seen_ns: time_ns });
        }
        chosen
    }
}

/// A place of our world's floor (x, z, m) as people have theirs: to the camera's right, ahead of it.
fn on_the_floor(frame: &DepthFrame, place: Vec2) -> Vec2 {
    let pose = frame.camera_to_world;
    let flat = |v: glam::Vec3A| Vec2::new(v.x, v.z);
    let ahead = flat(pose.matrix3.z_axis).normalize_or(Vec2::NEG_Y);
    // Right of who looks along -z is +x.
    let right = Vec2::new(-ahead.y, ahead.x);
    let from = place - flat(pose.translation);
    Vec2::new(from.dot(right), from.dot(ahead))
}
