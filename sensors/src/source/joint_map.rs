//! Maps the points of trackers' skeletons to our joints: one table for all trackers.
//!
//! The table is data (`data/joint_map.csv`), a row a joint by its H-Anim name, a column a tracker. A cell is a point's
//! number and name, `mid(a;b)` for the middle of two points, or a point with `(offset)` that lies beside the joint.
//! A chest has two rows, for trackers differ in which of the two they give: that of ours by place comes first.

use glam::Vec3;
use toile_base::skeleton::{JOINTS, Joint};

use toile_base::frame::{Joints, TrackedJoint};

const TABLE: &str = include_str!("../../data/joint_map.csv");

toile_base::named! {
    /// A tracker's set of points.
    #[derive(Debug, Clone, Copy, PartialEq, Eq)]
    pub enum Format {
        /// Kinect v1: 20 joints.
        Kinect20,
        /// Kinect v2: 25 joints.
        Kinect25,
        /// Azure Kinect body tracking (k4abt).
        Azure32,
        /// Nuitrack's skeleton.
        Nuitrack,
        /// MediaPipe's pose landmarks (BlazePose): 33 points.
        MediaPipe33,
        /// OpenPose, model BODY_25.
        OpenPose25,
        /// OpenPose, model BODY_25B.
        OpenPose25B,
    }
}

impl Format {
    /// Points of a skeleton.
    pub const fn points(self) -> usize {
        match self {
            Self::Kinect20 => 20,
            Self::Kinect25 | Self::Nuitrack | Self::OpenPose25 | Self::OpenPose25B => 25,
            Self::Azure32 => 32,
            Self::MediaPipe33 => 33,
        }
    }

    /// Its column in the table.
    const fn column(self) -> usize {
        match self {
            Self::Kinect20 => 1,
            Self::Kinect25 => 2,
            Self::Azure32 => 3,
            Self::Nuitrack => 4,
            Self::MediaPipe33 => 5,
            Self::OpenPose25 => 6,
            Self::OpenPose25B => 7,
        }
    }
}

/// Column of the bones that the VMC protocol names.
const VMC_COLUMN: usize = 8;

/// Source of a joint among a tracker's points.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Source {
    /// The joint lies at a point of the tracker.
    Point(usize),
    /// In the middle of two.
    Middle(usize, usize),
    /// Not at, but beside a point: how far is for the reader to say.
    Beside(usize),
}

impl Source {
    fn parse(cell: &str) -> Option<Self> {
        if let Some(pair) = cell.strip_prefix("mid(") {
            let (a, b) = pair.strip_suffix(')')?.split_once(';')?;
            return Some(Self::Middle(a.parse().ok()?, b.parse().ok()?));
        }
        let number = cell.split(' ').next()?.parse().ok()?;
        Some(if cell.ends_with("(offset)") { Self::Beside(number) } else { Self::Point(number) })
    }

    /// The largest point number in it.
    #[cfg(test)]
    fn last(self) -> usize {
        match self {
            Self::Point(a) | Self::Beside(a) => a,
            Self::Middle(a, b) => a.max(b),
        }
    }
}

/// Of one tracker: the source of each of our joints.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct JointMap([Option<Source>; JOINTS]);

impl JointMap {
    /// The map of a tracker.
    pub fn of(format: Format) -> Self {
        let mut map = [None; JOINTS];
        for (joint, cell) in column(format.column()) {
            let source: &mut Option<Source> = &mut map[joint.index()];
            *source = source.or(Source::parse(cell));
        }
        Self(map)
    }

    /// Position of a joint; `None` if the tracker has none.
    pub fn source(&self, joint: Joint) -> Option<Source> {
        self.0[joint.index()]
    }

    /// Our joints of a tracker's points, already in world axes (m). The middle of two points is believed as far as the
    /// less believed of them; joints beside a point, and points that are not there, are left absent.
    pub fn joints(&self, time_ns: u64, points: &[TrackedJoint]) -> Joints {
        let mut out = Joints::absent(time_ns);
        let point = |k: usize| points.get(k).copied().unwrap_or_default();
        for (tracked, source) in out.joints.iter_mut().zip(self.0) {
            *tracked = match source {
                Some(Source::Point(k)) => point(k),
                Some(Source::Middle(a, b)) => middle(point(a), point(b)),
                Some(Source::Beside(_)) | None => TrackedJoint::default(),
            };
        }
        out
    }
}

/// Middle of two points, believed as far as the less believed one.
pub(super) fn middle(a: TrackedJoint, b: TrackedJoint) -> TrackedJoint {
    let position = if a.confidence.min(b.confidence) > 0.0 { (a.position + b.position) * 0.5 } else { Vec3::ZERO };
    TrackedJoint { position, confidence: a.confidence.min(b.confidence) }
}

/// Each of our joints with the VMC bones that stand for it, the better one first.
pub(super) fn vmc_bones() -> impl Iterator<Item = (Joint, &'static str)> {
    column(VMC_COLUMN).filter(|(_, name)| !name.is_empty())
}

/// Joint and cell of each row of a column.
fn column(column: usize) -> impl Iterator<Item = (Joint, &'static str)> {
    TABLE.lines().skip(1).filter_map(move |line| {
        let mut cells = line.split(',');
        let joint = Joint::named(cells.next()?)?;
        Some((joint, cells.nth(column - 1)?))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_cell_is_understood_and_within_its_trackers_points() {
        assert!(TABLE.lines().skip(1).all(|line| Joint::named(line.split(',').next().unwrap()).is_some()));
        for format in Format::ALL {
            for (joint, cell) in column(format.column()).filter(|(_, cell)| !cell.is_empty()) {
                let source = Source::parse(cell).unwrap_or_else(|| panic!("{format:?} {joint:?}: {cell}"));
                assert!(source.last() < format.points(), "{format:?} {joint:?}: {cell}");
            }
        }
    }

    #[test]
    fn left_and_right_are_mirrored_and_no_point_is_two_joints() {
        for format in Format::ALL {
            let map = JointMap::of(format);
            let mut used = Vec::new();
            for joint in Joint::ALL {
                assert_eq!(map.source(joint).is_some(), map.source(joint.mirror()).is_some(), "{format:?} {joint:?}");
                if let Some(Source::Point(k)) = map.source(joint) {
                    assert!(!used.contains(&k), "{format:?}: point {k} is two joints");
                    used.push(k);
                }
            }
            assert!(used.len() > 10, "{format:?}");
        }
    }

    #[test]
    fn the_collar_bone_is_not_the_shoulder() {
        let azure = JointMap::of(Format::Azure32);
        assert_eq!(azure.source(Joint::LeftClavicle), Some(Source::Point(4)));
        assert_eq!(azure.source(Joint::LeftShoulder), Some(Source::Point(5)));
        assert_eq!(azure.source(Joint::Chest), Some(Source::Point(2)));
        let named = |name: &str| vmc_bones().find(|(_, bone)| *bone == name).map(|(joint, _)| joint);
        assert_eq!(named("LeftShoulder"), Some(Joint::LeftClavicle));
        assert_eq!(named("LeftUpperArm"), Some(Joint::LeftShoulder));
        assert_eq!(named("RightHand"), Some(Joint::RightWrist));
    }

    #[test]
    fn the_middle_is_believed_as_far_as_the_less_believed_end() {
        let mut points = [TrackedJoint { position: Vec3::X, confidence: 1.0 }; 33];
        points[24] = TrackedJoint { position: -Vec3::X, confidence: 0.3 };
        let joints = JointMap::of(Format::MediaPipe33).joints(7, &points);
        assert_eq!(joints.at(Joint::Pelvis), &TrackedJoint { position: Vec3::ZERO, confidence: 0.3 });
        assert_eq!(joints.at(Joint::LeftHip).position, Vec3::X);
        assert_eq!(joints.at(Joint::Spine).confidence, 0.0);
        assert_eq!(JointMap::of(Format::Azure32).joints(0, &[]), Joints::absent(0));
    }

    /// The shared table, or nothing where it is not set up; with CI=true that is a failure.
    fn shared() -> Option<Vec<Vec<String>>> {
        let folder = crate::recordings::folder()?;
        let text = std::fs::read_to_string(folder.join("protocols/joint_map.csv")).expect("the joint map is there");
        Some(text.lines().map(|line| line.split(',').map(str::to_owned).collect()).collect())
    }

    #[test]
    fn the_table_agrees_with_the_shared_one_cell_by_cell() {
        let Some(theirs) = shared() else { return };
        let names = [
            "hanim_v2",
            "kinect1_20",
            "kinect2_25",
            "azure_32",
            "nuitrack",
            "mediapipe_33",
            "openpose_body25",
            "openpose_body25b",
            "vmc_humanbodybone",
        ];
        let columns = names.map(|name| theirs[0].iter().position(|h| h == name).expect(name));
        let mut rows = 0;
        for ours in TABLE.lines().skip(1).map(|line| line.split(',').collect::<Vec<_>>()) {
            let hand = ours[0].contains("metacarpophalangeal");
            let Some(row) = theirs.iter().find(|row| row[0] == ours[0]) else {
                assert!(hand, "the shared table has no row {}", ours[0]);
                continue;
            };
            for (k, column) in columns.into_iter().enumerate() {
                assert_eq!(ours[k], row[column], "{} {}", ours[0], names[k]);
            }
            rows += 1;
        }
        // All rows but the root's, which only places the body.
        assert_eq!(rows, theirs.len() - 2);
    }
}
