//! Landmarks of the body: the places that a tape is laid from, tied to the surface so that they move with it.
//!
//! Each is a share of the way along one edge of the mesh, so that its height on the drawing is met exactly and it
//! follows every morph. The drawing names them as points (`data/body/landmarks.toml`), and [`Landmarks::place`] finds
//! them on whatever mesh the body has. Paired ones are the left side's: the body is symmetric.

use std::sync::LazyLock;

use glam::Vec3;
use serde::Deserialize;

use toile_base::body::{Region, Sex};

toile_base::named! {
    /// A named place on the surface of the body.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Deserialize)]
    #[serde(rename_all = "snake_case")]
    #[repr(u8)]
    pub enum Landmark {
        /// Top of the head.
        Crown,
        /// Adam's apple, where ANSUR II lays the tape round the neck, square to the neck.
        Infrathyroid,
        /// Front of the neck 2 cm below the Adam's apple, where EN 13402 lays it.
        NeckFront,
        /// 7th cervical vertebra.
        Cervicale,
        /// Notch above the breastbone.
        Suprasternale,
        /// Tip of the shoulder blade.
        Acromion,
        /// Front fold of the armpit.
        Axilla,
        /// Most forward point of the breast.
        BustPoint,
        /// Just below the breasts, in front.
        Underbust,
        /// Natural waistline, midway between the lowest rib and the hip bone, in front.
        NaturalWaist,
        /// Navel: ANSUR II's waist.
        Omphalion,
        /// Outside of the hip joint.
        Trochanterion,
        /// Greatest protrusion of the buttock.
        Buttock,
        /// Lowest point between the legs.
        Crotch,
        /// Greatest girth of the thigh, below the crotch, on the outside.
        Thigh,
        /// Middle of the kneecap.
        Midpatella,
        /// Greatest girth of the calf, behind.
        Calf,
        /// Outer ankle bone.
        Malleolus,
        /// Greatest girth of the upper arm, on its upper side.
        Biceps,
        /// Tip of the elbow.
        Olecranon,
        /// Wrist, on its back.
        Stylion,
        /// Tip of the middle finger.
        Dactylion,
    }
}

/// Number of landmarks.
pub const LANDMARKS: usize = 22;

impl Landmark {
    /// The landmark's place in every `[_; LANDMARKS]` array.
    pub const fn index(self) -> usize {
        self as usize
    }

    /// The part of the body that its edge is looked for on; at a border either part will do.
    fn lies_on(self, region: Region) -> bool {
        match self {
            Self::Crown => region == Region::Head,
            Self::Infrathyroid | Self::NeckFront | Self::Cervicale => matches!(region, Region::Head | Region::Torso),
            Self::Biceps | Self::Olecranon | Self::Stylion | Self::Dactylion => region == Region::LeftArm,
            Self::Midpatella | Self::Calf | Self::Malleolus => region == Region::LeftLeg,
            Self::Acromion | Self::Axilla => matches!(region, Region::Torso | Region::LeftArm),
            _ => matches!(region, Region::Torso | Region::LeftLeg),
        }
    }
}

/// A point tied to an edge of the mesh.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Mark {
    /// The edge's vertices.
    pub ends: [u32; 2],
    /// Share of the way from the first to the second, 0 to 1.
    pub share: f32,
}

impl Mark {
    /// A landmark that is a vertex itself.
    pub const fn vertex(v: u32) -> Self {
        Self { ends: [v, v], share: 0.0 }
    }

    /// Where it lies on a mesh (m), or how it moves in a field of displacements.
    pub fn on(&self, values: &[Vec3]) -> Vec3 {
        let [a, b] = self.ends.map(|v| values[v as usize]);
        a + (b - a) * self.share
    }
}

/// The landmarks of one mesh.
#[derive(Debug, Clone, PartialEq)]
pub struct Landmarks {
    /// One mark a landmark, in the order of [`Landmark::ALL`].
    pub marks: [Mark; LANDMARKS],
}

/// The drawing's points, one a landmark (m).
pub type DrawnMarks = [Vec3; LANDMARKS];

impl Landmarks {
    /// The mark of one landmark.
    pub const fn mark(&self, landmark: Landmark) -> Mark {
        self.marks[landmark.index()]
    }

    /// Ties the drawing's points to a mesh: each to the point at exactly its height, on an edge of its part of the
    /// body, that lies nearest; where no edge spans that height, to the nearest vertex.
    pub fn place(positions: &[Vec3], triangles: &[[u32; 3]], regions: &[Region], drawn: &DrawnMarks) -> Self {
        let marks = Landmark::ALL.map(|landmark| {
            let wanted = drawn[landmark.index()];
            let admits = |v: u32| landmark.lies_on(regions[v as usize]);
            let mut best = (f32::MAX, Mark::vertex(0));
            for t in triangles {
                for (a, b) in [(t[0], t[1]), (t[1], t[2]), (t[2], t[0])] {
                    // A closed mesh has each edge twice, once each way.
                    if a < b && admits(a) && admits(b) {
                        let mark = level_with(positions, [a, b], wanted.y);
                        let off = mark.map_or(f32::MAX, |m| m.on(positions).distance_squared(wanted));
                        if off < best.0 {
                            best = (off, mark.expect("a mark that is off by something"));
                        }
                    }
                }
            }
            if best.0 < f32::MAX { best.1 } else { nearest_vertex(positions, wanted, admits) }
        });
        Self { marks }
    }

    /// The drawing's points of one sex (m).
    pub fn drawn(sex: Sex) -> DrawnMarks {
        match sex {
            Sex::Female => DRAWN[0],
            Sex::Male => DRAWN[1],
        }
    }
}

/// The point of an edge at one height.
fn level_with(positions: &[Vec3], ends: [u32; 2], height: f32) -> Option<Mark> {
    let [low, high] = ends.map(|v| positions[v as usize].y);
    if (height - low) * (height - high) > 0.0 || low == high {
        return None;
    }
    Some(Mark { ends, share: (height - low) / (high - low) })
}

fn nearest_vertex(positions: &[Vec3], to: Vec3, admits: impl Fn(u32) -> bool) -> Mark {
    let all = (0..positions.len() as u32).filter(|&v| admits(v));
    let off = |v: &u32| positions[*v as usize].distance_squared(to);
    Mark::vertex(all.min_by(|a, b| off(a).total_cmp(&off(b))).unwrap_or(0))
}

/// Points of both sexes, by name (mm).
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct DrawnLandmarks {
    female: std::collections::BTreeMap<Landmark, [f32; 3]>,
    male: std::collections::BTreeMap<Landmark, [f32; 3]>,
}

static DRAWN: LazyLock<[DrawnMarks; 2]> = LazyLock::new(|| {
    // Part of the program, and read by a test: a failure here is a build that never passed its tests.
    let text = include_str!("../../data/body/landmarks.toml");
    let drawings: DrawnLandmarks = toml::from_str(text).expect("the embedded landmarks are well formed");
    [drawings.female, drawings.male]
        .map(|points| Landmark::ALL.map(|l| Vec3::from(*points.get(&l).expect("every landmark is drawn")) * 1e-3))
});
