//! Stretch by zone in each pose, and the rise of hems.

use glam::Vec3;
use serde::Serialize;
use toile_base::body::Levels;
use toile_base::garment::{Garment, Part};
use toile_base::skeleton::{Joint, Pose, Skeleton};
use toile_engine::cloth::{Cloth, Settings};

use super::poses;
use crate::FittingError;
use crate::dress::try_on::DressedBody;

/// Share of the edges of a zone that may be stretched more than what is told: single edges beside a seam say nothing.
const BEYOND: f32 = 0.1;

/// A zone of fewer edges is none.
const LEAST_EDGES: usize = 24;

/// Stretched by this many times what is comfortable it pulls hard.
const HARD: f32 = 2.0;

/// Share of a garment's particles that are its hem: the lowest as it is put on.
const HEM: f32 = 0.03;

/// A part of the body that a garment covers.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum CoveredZone {
    /// Both arms.
    Sleeves,
    /// Shoulders, chest and the back behind them.
    Chest,
    /// From below the breasts to half of the way to the hip.
    Waist,
    /// Down to the crotch: the seat.
    Hip,
    /// Below it.
    Legs,
}

impl CoveredZone {
    /// All of them, from the top down.
    pub const ALL: [Self; 5] = [Self::Sleeves, Self::Chest, Self::Waist, Self::Hip, Self::Legs];

    /// As a sentence has it.
    pub const fn words(self) -> &'static str {
        match self {
            Self::Sleeves => "the sleeves",
            Self::Chest => "chest and shoulders",
            Self::Waist => "the waist",
            Self::Hip => "the seat",
            Self::Legs => "the legs",
        }
    }

    fn of(part: Part, p: Vec3, levels: &Levels) -> Self {
        match part {
            Part::LeftArm | Part::RightArm => Self::Sleeves,
            _ if p.y > levels.underbust => Self::Chest,
            _ if p.y > 0.5 * (levels.waist + levels.hip) => Self::Waist,
            _ if p.y > levels.crotch => Self::Hip,
            _ => Self::Legs,
        }
    }
}

/// How a zone holds.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Pull {
    /// Within what its fabric's wearers find comfortable.
    Easy,
    /// Beyond it.
    Pulls,
    /// Beyond twice of it.
    Hard,
}

/// What a zone of a garment does in a pose.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct ZonePull {
    /// The zone.
    pub zone: CoveredZone,
    /// Stretch that nine tenths of its edges stay below (1).
    pub stretch: f32,
    /// The same while standing (1).
    pub standing: f32,
    /// Stretch that is comfortable in its fabric (1).
    pub comfortable: f32,
    /// How it holds.
    pub pull: Pull,
}

/// What a garment does in a pose.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct GarmentPulls {
    /// Its name.
    pub garment: String,
    /// The zones that it covers.
    pub zones: Vec<ZonePull>,
    /// How far its hem rides up the trunk, against standing (mm), negative is down; none of one that ends on the legs.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub rides_up_mm: Option<f32>,
}

/// What all garments do in a pose.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct PosePulls {
    /// What is done.
    pub pose: &'static str,
    /// The garments, inner first.
    pub garments: Vec<GarmentPulls>,
}

/// How a body takes a pose.
type TakePose = fn(&Skeleton) -> Pose;

/// What is tried, as a sentence begins, and the pose of it.
const TRIED: [(&str, TakePose); 2] = [("raising the arms", poses::arms_raised), ("sitting", poses::sitting)];

/// Tries the poses in garments that are worn together.
///
/// # Errors
/// Garments that no frame holds.
pub fn in_poses(dressed: &DressedBody, settings: &Settings) -> Result<Vec<PosePulls>, FittingError> {
    let (body, garments) = (&dressed.body, &dressed.garments);
    let standing = look(dressed, settings, poses::arms_down)?;
    let tried = |(name, pose): (&'static str, TakePose)| {
        let now = look(dressed, settings, pose)?;
        let both = garments.iter().zip(standing.iter().zip(now));
        let garments = both.map(|(garment, (before, now))| compare(garment, &body.levels, before, &now)).collect();
        Ok(PosePulls { pose: name, garments })
    };
    TRIED.into_iter().map(tried).collect()
}

/// What is seen of a garment in one pose.
struct Seen {
    /// Stretch of each zone that it covers, in their order.
    stretch: Vec<Option<f32>>,
    /// Mean height of its hem in the pelvis' own frame (m).
    hem: f32,
}

fn look(dressed: &DressedBody, settings: &Settings, pose: TakePose) -> Result<Vec<Seen>, FittingError> {
    let body = &dressed.body;
    let (mut frame, _reader) = dressed.clone().build(*settings).map_err(FittingError::input)?;
    frame.dress(&poses::joints(&body.skeleton, &pose(&body.skeleton)));
    let now = frame.pose();
    let (root, turn) = (now.root, now.local[Joint::Pelvis.index()].inverse());
    let seen = |(cloth, garment): (&Cloth, &Garment)| Seen {
        stretch: stretches(cloth, garment, &body.levels).to_vec(),
        hem: hem(garment).map(|(v, share)| (turn * (Vec3::from(cloth.positions[v]) - root)).y * share).sum(),
    };
    Ok(frame.cloths().iter().zip(frame.garments()).map(seen).collect())
}

/// Stretch that nine tenths of the edges of each zone stay below (1), in the order of [`CoveredZone::ALL`]; none of a zone that the
/// garment does not cover.
pub fn stretches(cloth: &Cloth, garment: &Garment, levels: &Levels) -> [Option<f32>; CoveredZone::ALL.len()] {
    CoveredZone::ALL.map(|zone| stretch(cloth, garment, zone, levels))
}

/// Stretch that all but a tenth of a zone's edges stay below.
fn stretch(cloth: &Cloth, garment: &Garment, zone: CoveredZone, levels: &Levels) -> Option<f32> {
    let inside = |v: u32| CoveredZone::of(garment.parts[v as usize], garment.start[v as usize], levels) == zone;
    let edges = garment.strain_edges.iter().filter(|(ends, _)| ends.iter().all(|v| inside(*v)));
    let free = edges.filter(|(ends, _)| ends.iter().any(|v| garment.inverse_mass[*v as usize] > 0.0));
    let length = |ends: &[u32; 2]| cloth.positions[ends[0] as usize].distance(cloth.positions[ends[1] as usize]);
    let mut all: Vec<f32> = free.map(|(ends, rest)| length(ends) / rest - 1.0).collect();
    if all.len() < LEAST_EDGES {
        return None;
    }
    all.sort_by(f32::total_cmp);
    Some(all[((1.0 - BEYOND) * all.len() as f32) as usize])
}

/// The particles of a garment's hem, and the share of each in its mean.
fn hem(garment: &Garment) -> impl Iterator<Item = (usize, f32)> + use<> {
    let mut order: Vec<usize> = (0..garment.particles()).filter(|v| !sleeve(garment.parts[*v])).collect();
    order.sort_by(|a, b| garment.start[*a].y.total_cmp(&garment.start[*b].y));
    let count = ((HEM * order.len() as f32) as usize).max(1).min(order.len());
    order.into_iter().take(count).map(move |v| (v, 1.0 / count as f32))
}

const fn sleeve(part: Part) -> bool {
    matches!(part, Part::LeftArm | Part::RightArm)
}

fn compare(garment: &Garment, levels: &Levels, before: &Seen, now: &Seen) -> GarmentPulls {
    let ends: f32 = hem(garment).map(|(v, share)| garment.start[v].y * share).sum();
    let comfortable = garment.fabric.comfortable_stretch;
    let zone = |((zone, before), now): ((CoveredZone, &Option<f32>), &Option<f32>)| {
        let (standing, stretch) = ((*before)?, (*now)?);
        let pull = match stretch / comfortable {
            times if times > HARD => Pull::Hard,
            times if times > 1.0 => Pull::Pulls,
            _ => Pull::Easy,
        };
        Some(ZonePull { zone, stretch, standing, comfortable, pull })
    };
    let zones = CoveredZone::ALL.into_iter().zip(&before.stretch).zip(&now.stretch);
    GarmentPulls {
        garment: garment.name.clone(),
        zones: zones.filter_map(zone).collect(),
        rides_up_mm: (ends > levels.crotch).then_some((now.hem - before.hem) * 1e3),
    }
}

#[cfg(test)]
mod tests {
    use toile_assets::drafting;
    use toile_base::body::{Measures, Sex};

    use super::*;

    /// Of a garment in a size on the body of another.
    fn tried(name: &str, size: &str, on: &str) -> Vec<PosePulls> {
        let package = drafting::package(name).unwrap();
        let body = package.body_of(on).unwrap().unwrap();
        let garment = package.dress(size, &body).unwrap();
        let settings = Settings { workers: 1, ..Settings::default() };
        in_poses(&DressedBody::new(toile_assets::rig::fit(&body), body, vec![garment]), &settings).unwrap()
    }

    fn at(pulls: &PosePulls, zone: CoveredZone) -> ZonePull {
        *pulls.garments[0].zones.iter().find(|z| z.zone == zone).unwrap()
    }

    #[test]
    fn a_narrow_skirt_pulls_at_a_larger_seat() {
        let (own, small) = (tried("pencil-skirt", "40", "40"), tried("pencil-skirt", "36", "40"));
        let seat = |pulls: &[PosePulls]| at(&pulls[1], CoveredZone::Hip);
        assert_eq!(own[1].pose, "sitting");
        assert!(seat(&small).stretch > seat(&small).standing, "{:?}", seat(&small));
        assert!(seat(&small).stretch > seat(&own).stretch + 0.01, "{:?} and {:?}", seat(&small), seat(&own));
        assert_eq!((seat(&small).pull, small[1].garments[0].rides_up_mm), (Pull::Hard, None));
    }

    #[test]
    fn a_tee_rides_up_when_the_arms_are_raised() {
        let pulls = tried("tee", "40", "40");
        assert!(pulls[0].garments[0].rides_up_mm.unwrap() > 15.0, "{:?}", pulls[0]);
        let zones: Vec<CoveredZone> = pulls[0].garments[0].zones.iter().map(|z| z.zone).collect();
        assert!(zones.contains(&CoveredZone::Sleeves) && !zones.contains(&CoveredZone::Legs), "{zones:?}");
    }

    #[test]
    fn a_body_that_wears_nothing_feels_nothing() {
        let body = toile_assets::body::build(Sex::Male, &Measures::average(Sex::Male)).unwrap();
        let bare = DressedBody::new(toile_assets::rig::fit(&body), body, Vec::new());
        let pulls = in_poses(&bare, &Settings { workers: 1, ..Settings::default() }).unwrap();
        assert!(pulls.len() == 2 && pulls.iter().all(|p| p.garments.is_empty()));
    }
}
