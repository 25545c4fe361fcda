//! The head adapted to marked points and to its outline: its pose before the cameras and its field of displacements, in turn.

use glam::DVec3;
use toile_base::body::Sex;

use super::head_mesh::HeadMesh;
use super::head_pose::{POSE_ROUNDS, first_pose, pose_step};
use super::landmarks::FaceLandmarks;
use super::outline::{OutlineStretch, seen_outlines, stretches};
use super::prior::OffsetField;
use super::sighting::{HeadPose, Sighting, across, marked_points, observations, residual};
use super::unfit::UnfitFace;
use super::view::FaceView;

/// Rounds of pose and field in turn, by the points and then with the outlines.
const ROUNDS: usize = 8;
const OUTLINE_ROUNDS: usize = 8;

/// Residual over which points are those of no face, or in another order (px a thousand of focal length).
pub(super) const LARGEST_RESIDUAL: f64 = 12.0;

/// How far ahead of the middle of the head the face begins (m).
const FACE: f64 = 0.03;

/// An adapted head.
#[derive(Debug, Clone)]
pub struct AdaptedHead {
    /// Whose drawing it was adapted from.
    pub sex: Sex,
    /// The whole body at rest with the adapted head (m) `[vertices]`.
    pub rest: Vec<DVec3>,
    /// The same where it stands before the cameras (m) `[vertices]`.
    pub placed: Vec<DVec3>,
    /// Triangles of the head.
    pub triangles: Vec<[u32; 3]>,
    /// Root mean square distance of the points from where they were marked (px).
    pub residual_px: f64,
    /// Points that were used, over all photographs.
    pub points: usize,
    /// Stretches of outline that the rim was brought to, and its root mean square distance from them (px).
    pub outline: (usize, f64),
    /// Mean displacement of the face from the mannequin's (m).
    pub moved: f64,
    /// The 68 points on the adapted head (m, from its middle) `[68]`, and its pose.
    pub(super) marks: Vec<DVec3>,
    pub(super) pose: HeadPose,
}

/// The search for a head: what is known of it so far.
struct HeadSearch<'a> {
    views: &'a [FaceView],
    mesh: HeadMesh,
    /// The 68 points on the mannequin's head and on this one (m, from the middle).
    drawn: Vec<DVec3>,
    marks: Vec<DVec3>,
    field: OffsetField,
    pose: HeadPose,
    /// What the outlines last showed.
    outlines: Vec<Sighting>,
}

/// Adapts the mannequin's head of a sex to the photographs.
///
/// # Errors
/// One sentence where the points are those of no head before these cameras, or the outlines those of another.
pub fn adapt(views: &[FaceView], sex: Sex) -> Result<AdaptedHead, UnfitFace> {
    let mesh = HeadMesh::of(sex);
    let drawn = FaceLandmarks::new().on(&mesh.positions);
    let pose = first_pose(views, &drawn)?;
    let marks = drawn.clone();
    let mut search =
        HeadSearch { views, mesh, drawn, marks, field: OffsetField::default(), pose, outlines: Vec::new() };
    for _ in 0..ROUNDS {
        search.round();
    }
    let [off, relative] = search.residual();
    if relative.is_nan() || relative >= LARGEST_RESIDUAL {
        let problem = format!("they lie {off:.1} px from those of any head that stands before these cameras");
        let cure = "check their order, left and right (the wearer's right is point 0), and the cameras' names";
        return Err(UnfitFace::new("the points", problem, cure));
    }
    let stretches: Vec<Vec<OutlineStretch>> = views.iter().map(stretches).collect();
    let count = stretches.iter().map(Vec::len).sum::<usize>();
    for _ in 0..if count > 0 { OUTLINE_ROUNDS } else { 0 } {
        search.find_outlines(&stretches);
        if 2 * search.outlines.len() < count {
            let problem = format!("{} of {count} stretches lie near the rim of the head", search.outlines.len());
            let cure =
                "mark where the head itself ends, without hair and shoulders, in the pixels of the same photograph";
            return Err(UnfitFace::new("the outline", problem, cure));
        }
        search.round();
    }
    search.settle();
    Ok(search.adapted(sex))
}

impl HeadSearch<'_> {
    /// All that the photographs show.
    fn sightings(&self) -> Vec<Sighting> {
        let mut all = marked_points(self.views, &self.drawn, &self.marks);
        all.extend(&self.outlines);
        all
    }

    /// Pose, then field.
    fn round(&mut self) {
        self.settle();
        self.field = OffsetField::of(&observations(self.views, &self.sightings(), self.pose));
        self.marks = self.drawn.iter().map(|p| *p + self.field.at(*p)).collect();
        // Places of the rim lie above the neck, where all of the field counts.
        self.outlines.iter_mut().for_each(|s| s.own = s.drawn + self.field.at(s.drawn));
    }

    /// The pose alone.
    fn settle(&mut self) {
        let sightings = self.sightings();
        for _ in 0..POSE_ROUNDS {
            self.pose = pose_step(self.views, &sightings, self.pose);
        }
    }

    fn find_outlines(&mut self, stretches: &[Vec<OutlineStretch>]) {
        let own = self.mesh.moved(&self.field);
        self.outlines = seen_outlines(self.views, stretches, &self.mesh, &own, self.pose);
    }

    fn residual(&self) -> [f64; 2] {
        residual(self.views, &marked_points(self.views, &self.drawn, &self.marks), self.pose)
    }

    fn adapted(self, sex: Sex) -> AdaptedHead {
        let head = AdaptedHead::of(sex, &self.mesh, &self.field, self.pose);
        AdaptedHead {
            residual_px: self.residual()[0],
            points: self.views.iter().map(|v| v.points.iter().flatten().count()).sum(),
            outline: (self.outlines.len(), across(self.views, &self.outlines, self.pose)),
            ..head
        }
    }
}

impl AdaptedHead {
    /// The head that a field makes of the mannequin's, where it stands; nothing is said of what was seen of it.
    pub(super) fn of(sex: Sex, mesh: &HeadMesh, field: &OffsetField, pose: HeadPose) -> Self {
        let own = mesh.moved(field);
        let face: Vec<f64> = (0..own.len())
            .filter(|v| mesh.share[*v] > 0.0 && mesh.positions[*v].z > FACE)
            .map(|v| own[v].distance(mesh.positions[v]))
            .collect();
        // About the joint of head and neck, so that the chin stays over the throat.
        let rest = |v: usize| own[v] * (1.0 + (pose.size - 1.0) * mesh.share[v]) + mesh.middle;
        let drawn = FaceLandmarks::new().on(&mesh.positions);
        Self {
            sex,
            rest: (0..own.len()).map(rest).collect(),
            placed: own.iter().map(|p| pose.to_world(*p)).collect(),
            triangles: mesh.triangles.clone(),
            residual_px: 0.0,
            points: 0,
            outline: (0, 0.0),
            moved: face.iter().sum::<f64>() / face.len().max(1) as f64,
            marks: drawn.iter().map(|p| *p + field.at(*p)).collect(),
            pose,
        }
    }
}
