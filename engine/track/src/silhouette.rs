//! One frame's reading of a person: heights of the floor and the top of the head, and breadth and depth of the torso
//! at the levels of chest, waist and hip, the arms left out.
//!
//! Definitions are those of EN 13402-1 and ISO 8559-1: levels are fixed fractions of stature (see
//! [`crate::anthropometry::LevelFractions`]), not the widest or narrowest place, which lies 12 to 27 mm of girth away.

use glam::{Vec2, Vec3};

use crate::anthropometry::{LevelFractions, stature};
use crate::estimate::Estimate;
use crate::point_cloud::PersonCloud;
use crate::section::{TorsoSection, measure_torso};
use toile_assets::sizes::Population;
use toile_base::numeric::statistics::median_of;

/// The floor counts as given by the camera's pose if the feet end this near to y = 0 (m).
const FLOOR_NEAR: f32 = 0.12;

/// A body seen from the floor up is at least this high (m); less is a part of one.
const WHOLE_BODY: f32 = 1.2;

/// Bands of the torso are this high to either side of their level (m): ten rows of pixels at 2.4 m.
const BAND: f32 = 0.02;

/// The head lies within this of the body's axis, raised hands beyond (m).
const HEAD_REACH: f32 = 0.13;

/// The top of the head is where so many points lie higher: one would be noise, a head 4 mm down is thirteen wide.
const TOP_POINTS: usize = 4;

/// Rows of pixels between the highest of them and the top of the head: half a row by itself, and what a Kinect loses of
/// surface that it sees at a grazing angle (6.2 mm at 2.5 m, from mannequins; see `toile_perf::agreement`).
const ROWS_LOST: f32 = 1.93;

/// Radius of the top of the head (m): a camera below it sees the horizon of this sphere, not its top.
const CROWN_RADIUS: f32 = 0.12;

/// Distance from the top of the head to the acromion as a fraction of stature, and its spread (ANSUR II).
const HEAD_AND_NECK: Estimate = Estimate::new(0.180, 0.009);

/// Points farther apart than this belong to different parts of the body (m).
const APART: f32 = 0.025;

/// Plausible breadths of the outline at the shoulders, as a fraction of stature; raised arms lie beyond.
const OUTLINE_BREADTH: std::ops::Range<f32> = 0.17..0.34;

/// Error of the shoulder line, which is where the outline widens (m).
const SHOULDER_LINE: f32 = 0.02;

/// Part of the way from waist to chest that sleeves and armpits leave alone.
const BELOW_ARMPITS: f32 = 0.6;

/// The reading of one frame.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SilhouetteReading {
    /// Top of the head above the floor (m), as the person stands: with hair and shoes; `None` if the feet are not seen.
    pub stature: Option<f32>,
    /// Breadth of the outline at the shoulders (m).
    pub shoulders: Option<f32>,
    /// The torso at chest level.
    pub chest: Option<TorsoSection>,
    /// The chest was hidden by arms or sleeves, and is carried on from below the armpits.
    pub chest_hidden: bool,
    /// The torso at waist level.
    pub waist: Option<TorsoSection>,
    /// The torso at hip level.
    pub hip: Option<TorsoSection>,
}

/// Reads one frame.
pub fn read(cloud: &PersonCloud, levels: &LevelFractions, population: Population) -> Option<SilhouetteReading> {
    let upright = UprightPerson::new(cloud, population)?;
    let section = |level: f32| upright.section(level);
    let shoulders = upright.shoulders(levels);
    // Raised arms pull sleeves and armpits into the chest's level; without an outline of the shoulders they are raised.
    let seen = shoulders.and_then(|_| section(levels.chest));
    let chest = seen.or_else(|| upright.below_armpits(levels)).or_else(|| section(levels.chest));
    Some(SilhouetteReading {
        stature: upright.floor.map(|floor| upright.top - floor),
        shoulders,
        chest,
        chest_hidden: seen.is_none(),
        waist: section(levels.waist),
        hip: section(levels.hip),
    })
}

/// A person's points turned to face +z, with the heights that everything is counted from.
struct UprightPerson {
    /// Points relative to the body's axis, facing +z (m), lowest first.
    points: Vec<Vec3>,
    top: f32,
    floor: Option<f32>,
    height: f32,
    pitch: f32,
}

impl UprightPerson {
    fn new(cloud: &PersonCloud, population: Population) -> Option<Self> {
        let mut points = cloud.points.clone();
        points.sort_unstable_by(|a, b| a.y.total_cmp(&b.y));
        let bottom = points.get(points.len() / 300)?.y;
        let rough_top = points[points.len() - 1 - points.len() / 300].y;
        let trunk = band(&points, bottom + 0.45 * (rough_top - bottom), bottom + 0.8 * (rough_top - bottom));
        let axis = Vec2::new(median_of(trunk.iter().map(|p| p.x))?, median_of(trunk.iter().map(|p| p.z))?);
        for p in &mut points {
            *p -= Vec3::new(axis.x, 0.0, axis.y);
        }
        let top = top_of_head(&points, cloud.pitch)? + beyond_horizon(cloud.elevation);
        let floor = match bottom {
            b if b.abs() < FLOOR_NEAR => Some(0.0),
            b if !cloud.cut_below && top - b > WHOLE_BODY => Some(b),
            _ => None,
        };
        let height = match floor {
            Some(floor) => top - floor,
            None => height_from_shoulders(&points, top, population),
        };
        let mut upright = Self { points, top, floor, height, pitch: cloud.pitch };
        upright.turn();
        Some(upright)
    }

    /// World height of a level given as a fraction of stature (m).
    fn at(&self, fraction: f32) -> f32 {
        self.top - (1.0 - fraction) * self.height
    }

    /// Turns the person to face +z: the shoulder blades and collar bones make the band under the neck a bar whose
    /// depth rises to one side when the person is turned.
    fn turn(&mut self) {
        let bar = band(&self.points, self.at(0.72), self.at(0.80));
        let (mut n, mut sx, mut sz, mut sxx, mut sxz) = (0.0, 0.0, 0.0, 0.0, 0.0);
        for p in bar.iter().filter(|p| p.x.abs() < 0.15) {
            n += 1.0;
            sx += p.x;
            sz += p.z;
            sxx += p.x * p.x;
            sxz += p.x * p.z;
        }
        let spread = n * sxx - sx * sx;
        if n < 50.0 || spread <= 0.0 {
            return;
        }
        // Beyond 30 degrees one side hides the other and no turning brings it back.
        let yaw = ((n * sxz - sx * sz) / spread).clamp(-0.58, 0.58).atan();
        let (sin, cos) = yaw.sin_cos();
        for p in &mut self.points {
            (p.x, p.z) = (cos * p.x + sin * p.z, cos * p.z - sin * p.x);
        }
    }

    fn section(&self, level: f32) -> Option<TorsoSection> {
        let y = self.at(level);
        // A picture that ends inside the band shows less than the band.
        let lowest = self.points.first()?.y;
        (lowest < y - BAND).then(|| measure_torso(band(&self.points, y - BAND, y + BAND), self.pitch)).flatten()
    }

    /// The chest where the arms hide its sides: the torso's edges between waist and armpits, carried on upwards.
    fn below_armpits(&self, levels: &LevelFractions) -> Option<TorsoSection> {
        let steps = 12;
        let seen: Vec<(f32, TorsoSection)> = (0..steps)
            .filter_map(|i| {
                let level = levels.waist + BELOW_ARMPITS * (levels.chest - levels.waist) * i as f32 / steps as f32;
                Some((level, self.section(level)?))
            })
            .collect();
        if seen.len() * 2 < steps {
            return None;
        }
        let line = |value: fn(&TorsoSection) -> f32| {
            let n = seen.len() as f32;
            let mean_x = seen.iter().map(|(x, _)| x).sum::<f32>() / n;
            let mean_y = seen.iter().map(|(_, s)| value(s)).sum::<f32>() / n;
            let slope = seen.iter().map(|(x, s)| (x - mean_x) * (value(s) - mean_y)).sum::<f32>()
                / seen.iter().map(|(x, _)| (x - mean_x).powi(2)).sum::<f32>();
            mean_y + slope * (levels.chest - mean_x)
        };
        Some(TorsoSection { breadth: line(|s| s.breadth), front: line(|s| s.front), arc: line(|s| s.arc) })
    }

    /// Breadth of the outline a little below the acromions' level, where it falls away from the shoulders.
    fn shoulders(&self, levels: &LevelFractions) -> Option<f32> {
        let y = self.at(levels.acromion) - BELOW_ACROMION;
        let mut highest = [f32::NEG_INFINITY; 2 * OUTLINE];
        for p in band(&self.points, y - 0.02, self.top) {
            let bin = (p.x / OUTLINE_STEP).floor() + OUTLINE as f32;
            if bin >= 0.0 && bin < highest.len() as f32 {
                highest[bin as usize] = highest[bin as usize].max(p.y);
            }
        }
        let right = (OUTLINE..2 * OUTLINE).find(|&i| highest[i] < y)?;
        let left = (0..OUTLINE).rev().find(|&i| highest[i] < y)?;
        let breadth = edge(&highest, right, right - 1, y) - edge(&highest, left, left + 1, y);
        OUTLINE_BREADTH.contains(&(breadth / self.height)).then_some(breadth)
    }
}

/// How far below the acromions' usual height the outline is read (m): at that height it is nearly level, so that an acromion
/// 10 mm lower than usual would take 40 mm off a side; here it falls away, and takes 10 mm.
const BELOW_ACROMION: f32 = 0.018;

/// Half the number of columns in which the outline of the shoulders is sought, and their width (m).
const OUTLINE: usize = 40;
const OUTLINE_STEP: f32 = 0.01;

/// Where the outline crosses height `y` between a column below it and the column before it, by linear interpolation.
fn edge(highest: &[f32], below: usize, above: usize, y: f32) -> f32 {
    let centre = |i: usize| (i as f32 + 0.5 - OUTLINE as f32) * OUTLINE_STEP;
    let (low, high) = (highest[below].max(y - 0.05), highest[above]);
    let part = if high > low { (high - y) / (high - low) } else { 0.5 };
    centre(above) + part * (centre(below) - centre(above))
}

/// Points between two heights; `points` is sorted by height.
fn band(points: &[Vec3], from: f32, to: f32) -> &[Vec3] {
    let start = points.partition_point(|p| p.y < from);
    let end = points.partition_point(|p| p.y < to);
    &points[start..end.max(start)]
}

/// The top of the head near the axis (m).
fn top_of_head(points: &[Vec3], pitch: f32) -> Option<f32> {
    let mut near = points.iter().rev().filter(|p| p.x.abs() < HEAD_REACH).map(|p| p.y);
    Some(near.nth(TOP_POINTS - 1)? + ROWS_LOST * pitch)
}

/// How far the top of the head rises above what a camera sees of it from below, at an elevation (rad).
fn beyond_horizon(elevation: f32) -> f32 {
    CROWN_RADIUS * (1.0 - elevation.max(0.0).cos())
}

/// Stature of a person seen in part: the head and neck are 18 % of it, drawn towards what people commonly measure.
fn height_from_shoulders(points: &[Vec3], top: f32, population: Population) -> f32 {
    let common = stature(population);
    let width = |below: f32| run(band(points, top - below - 0.01, top - below));
    // The shoulders begin where the outline first exceeds 20 % of stature in breadth, below the widest of hair.
    let line = (16..50).map(|cm| cm as f32 * 0.01).find(|&below| width(below) > 0.2 * common.value);
    let Some(line) = line else { return common.value };
    let value = line / HEAD_AND_NECK.value;
    let sigma = (SHOULDER_LINE / HEAD_AND_NECK.value).hypot(value * HEAD_AND_NECK.sigma / HEAD_AND_NECK.value);
    Estimate::new(value, sigma).fuse(common).value
}

/// Breadth of the piece that holds the axis (m): raised arms beside it do not count.
fn run(points: &[Vec3]) -> f32 {
    let mut xs: Vec<f32> = points.iter().map(|p| p.x).collect();
    xs.sort_unstable_by(f32::total_cmp);
    let middle = xs.partition_point(|&x| x < 0.0);
    let right = xs[middle..].windows(2).take_while(|w| w[1] - w[0] < APART).count();
    let left = xs[..middle].windows(2).rev().take_while(|w| w[1] - w[0] < APART).count();
    match (xs.get(middle + right), middle.checked_sub(left + 1).and_then(|i| xs.get(i))) {
        (Some(r), Some(l)) => r - l,
        _ => 0.0,
    }
}
