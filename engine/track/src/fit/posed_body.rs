//! A body of some shape in some pose: the position of each surface sample, and its derivatives by every unknown.
//!
//! Skinning is linear with one bone a joint. A sample `x = sum_j w_j (p_j + R_j (X - J_j))` of rest position `X` moves
//! with a turn about the axis `a` through the joint at `p` by `sum_j w_j a x (x_j - p)` over the bones `j` that hang
//! from it, with the root as a whole, and with a shape's parameter `s` by
//! `sum_j w_j (R_j dX/ds + dp_j/ds - R_j dJ_j/ds)`.

use glam::{Mat3, Quat, Vec3};
use toile_assets::body::shape::{BodyShape, SCALE, SHAPES, Shapes};
use toile_base::body::Region;
use toile_base::mesh::SkinWeights;
use toile_base::skeleton::{JOINTS, Joint, Skeleton, bone_joint};

use super::joint_angles::{ANGLES, JointAngle, joint_angles};

/// Unknowns of the pose: the root's position, then the joint angles.
pub const POSE: usize = 3 + ANGLES;

/// All unknowns: the pose, then the shape.
pub const UNKNOWNS: usize = POSE + SHAPES;

/// [`UNKNOWNS`] rounded up to whole lanes.
pub const WIDTH: usize = UNKNOWNS.next_multiple_of(8);

/// Derivatives of one number by every unknown.
pub type JacobianRow = [f32; WIDTH];

/// Most bones of one sample.
const BONES_EACH: usize = 4;

/// The middle of one face of the surface. Faces and not vertices, because a face is flat: where on it a measured point
/// lies changes nothing, while beside a vertex the surface falls away from its tangent plane.
#[derive(Debug, Clone)]
pub struct SurfaceSample {
    /// Vertices of its face.
    pub corners: [u32; 4],
    /// Position on the base mesh (m).
    drawn: Vec3,
    /// The shape parameters that move it: first and end in [`BodyModel::moves`].
    moves: (u32, u32),
    /// Joints that carry it, with their shares.
    bones: [(u8, f32); BONES_EACH],
    /// Whether the ground carries it when one stands.
    pub sole: bool,
    /// Whether hair may cover it.
    pub hairy: bool,
    /// The arm that it is on, if it is on one.
    pub arm: Option<Region>,
}

impl SurfaceSample {
    /// The joints that carry it, with their shares.
    pub fn bones(&self) -> impl Iterator<Item = (usize, f32)> + '_ {
        self.bones.iter().filter(|b| b.1 > 0.0).map(|b| (b.0 as usize, b.1))
    }
}

/// One sex's surface samples and joint angles: constant over the frames.
pub struct BodyModel {
    /// The shapes of its sex.
    pub shapes: &'static Shapes,
    /// What its surface is sampled at.
    pub samples: Vec<SurfaceSample>,
    /// Shape parameter and displacement a unit (m), for all samples.
    moves: Vec<(u32, Vec3)>,
    /// The angles of the pose, in the order of the unknowns.
    pub joint_angles: [JointAngle; ANGLES],
    /// The angles of each joint: first and end in `joint_angles`.
    of_joint: [(u8, u8); JOINTS],
}

/// Height below which the base mesh's surface is sole (m).
const SOLE: f32 = 0.012;

impl BodyModel {
    /// Samples at least about `spacing` (m) apart; every face for 0.
    pub fn new(shapes: &'static Shapes, spacing: f32) -> Self {
        let joint_angles = joint_angles(&shapes.skeleton(shapes.mean()));
        let mut of_joint = [(0u8, 0u8); JOINTS];
        for (i, joint) in Joint::ALL.into_iter().enumerate() {
            let first = joint_angles.iter().position(|t| t.joint == joint).unwrap_or(0);
            let count = joint_angles.iter().filter(|t| t.joint == joint).count();
            of_joint[i] = (first as u8, (first + count) as u8);
        }
        let mut taken = std::collections::BTreeSet::new();
        let (mut samples, mut moves) = (Vec::new(), Vec::new());
        for &corners in &shapes.base().quads {
            let sample = sample(shapes, corners, &mut moves);
            let cell = (sample.drawn / spacing.max(1e-6)).floor().to_array().map(|c| c as i32);
            if spacing == 0.0 || taken.insert(cell) {
                samples.push(sample);
            }
        }
        Self { shapes, samples, moves, joint_angles, of_joint }
    }

    /// The shape parameters that move a sample, and its displacement a unit before scaling (m).
    fn moves(&self, sample: &SurfaceSample) -> &[(u32, Vec3)] {
        &self.moves[sample.moves.0 as usize..sample.moves.1 as usize]
    }

    /// Rest position of a sample on a shape (m).
    fn place(&self, sample: &SurfaceSample, shape: &[f32; SHAPES], scale: f32) -> Vec3 {
        scale * self.moves(sample).iter().fold(sample.drawn, |p, &(k, d)| p + d * shape[k as usize])
    }
}

/// The mean of a face's corners.
fn sample(shapes: &Shapes, corners: [u32; 4], moves: &mut Vec<(u32, Vec3)>) -> SurfaceSample {
    let base = shapes.base();
    let first = moves.len();
    let mut joints: Vec<(u8, f32)> = Vec::new();
    for v in corners {
        for &(k, d) in shapes.moves(v as usize) {
            match moves[first..].iter_mut().find(|m| m.0 == k) {
                Some(m) => m.1 += d / 4.0,
                None => moves.push((k, d / 4.0)),
            }
        }
        for (bone, weight) in base.weights[v as usize].iter() {
            let joint = bone_joint(bone as usize).map_or(0, Joint::index) as u8;
            match joints.iter_mut().find(|j| j.0 == joint) {
                Some(j) => j.1 += weight,
                None => joints.push((joint, weight)),
            }
        }
    }
    joints.sort_by(|a, b| b.1.total_cmp(&a.1).then(a.0.cmp(&b.0)));
    let whole: f32 = joints.iter().take(BONES_EACH).map(|j| j.1).sum();
    let bones: [(u8, f32); BONES_EACH] =
        std::array::from_fn(|k| joints.get(k).map_or((0, 0.0), |j| (j.0, j.1 / whole)));
    let drawn = corners.map(|v| base.positions[v as usize]).iter().sum::<Vec3>() / 4.0;
    let arm = Some(base.regions[corners[0] as usize]).filter(|r| matches!(r, Region::LeftArm | Region::RightArm));
    let hairy = [Joint::Head, Joint::Neck].iter().any(|j| j.index() == bones[0].0 as usize);
    SurfaceSample { corners, drawn, moves: (first as u32, moves.len() as u32), bones, sole: drawn.y < SOLE, hairy, arm }
}

/// The unknowns of the fit: pose and shape.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FitState {
    /// Position of the pelvis, world (m).
    pub root: Vec3,
    /// Rotation of each joint relative to its parent; the pelvis' relative to the world.
    pub local: [Quat; JOINTS],
    /// Parameters of the shape.
    pub shape: BodyShape,
}

impl FitState {
    /// The state after a step, given in the order of the unknowns.
    pub fn stepped(&self, model: &BodyModel, step: &[f64; UNKNOWNS]) -> Self {
        let mut next = *self;
        next.root += Vec3::new(step[0] as f32, step[1] as f32, step[2] as f32);
        let mut turned = [Vec3::ZERO; JOINTS];
        for (turn, by) in model.joint_angles.iter().zip(&step[3..]) {
            turned[turn.joint.index()] += turn.axis * *by as f32;
        }
        for (local, by) in next.local.iter_mut().zip(turned) {
            *local = (Quat::from_scaled_axis(by) * *local).normalize();
        }
        for (joint, &(first, end)) in next.local.iter_mut().zip(&model.of_joint) {
            // Rotations about two axes in turn also give one about the third, which is removed.
            if end - first < 3 {
                let whole = joint.to_scaled_axis();
                let axes = model.joint_angles[first as usize..end as usize].iter().map(|t| t.axis);
                *joint = Quat::from_scaled_axis(axes.map(|a| a * a.dot(whole)).sum());
            }
        }
        for (k, s) in next.shape.iter_mut().enumerate() {
            let [least, most] = model.shapes.bounds(k);
            *s = (*s + step[POSE + k]).clamp(least, most);
        }
        next
    }
}

/// A posed body.
pub struct PosedBody {
    rest: Skeleton,
    scale: f32,
    /// Rotation of each joint from rest to world.
    turned: [Mat3; JOINTS],
    /// Where each joint is, world (m).
    pub place: [Vec3; JOINTS],
    /// World axis of each joint angle.
    axes: [Vec3; ANGLES],
    /// `dp_j/ds - R_j dJ_j/ds` of each joint and parameter.
    drift: Vec<[Vec3; SHAPES]>,
    /// How far each sample lies from where its shape puts it, at rest (m).
    pub displaced: Vec<Vec3>,
    /// Rest position of each sample (m).
    rest_points: Vec<Vec3>,
    /// Position of each sample, world (m).
    pub points: Vec<Vec3>,
    /// Outward normal of each sample, world.
    pub normals: Vec<Vec3>,
}

impl PosedBody {
    /// Room for a model's samples; posed later.
    pub fn new(model: &BodyModel) -> Self {
        let n = model.samples.len();
        Self {
            rest: model.shapes.skeleton(model.shapes.mean()),
            scale: 1.0,
            turned: [Mat3::IDENTITY; JOINTS],
            place: [Vec3::ZERO; JOINTS],
            axes: [Vec3::ZERO; ANGLES],
            drift: vec![[Vec3::ZERO; SHAPES]; JOINTS],
            displaced: vec![Vec3::ZERO; n],
            rest_points: vec![Vec3::ZERO; n],
            points: vec![Vec3::ZERO; n],
            normals: vec![Vec3::ZERO; n],
        }
    }

    /// Poses the body; `rest_normals` are those of its samples at rest.
    pub fn pose(&mut self, model: &BodyModel, state: &FitState, rest_normals: &[Vec3]) {
        self.rest = model.shapes.skeleton(&state.shape);
        self.scale = state.shape[SCALE].exp() as f32;
        self.joints(state);
        for (axis, turn) in self.axes.iter_mut().zip(&model.joint_angles) {
            let parent = turn.joint.parent().map_or(Mat3::IDENTITY, |p| self.turned[p.index()]);
            *axis = parent * turn.axis;
        }
        self.drifts(model);
        let shape = state.shape.map(|s| s as f32);
        for (i, sample) in model.samples.iter().enumerate() {
            let rest_points = model.place(sample, &shape, self.scale) + self.displaced[i];
            let (mut point, mut normal) = (Vec3::ZERO, Vec3::ZERO);
            for &(j, w) in sample.bones.iter().filter(|b| b.1 > 0.0) {
                let j = j as usize;
                point += w * (self.place[j] + self.turned[j] * (rest_points - self.rest.rest[j]));
                normal += w * (self.turned[j] * rest_normals[i]);
            }
            (self.rest_points[i], self.points[i]) = (rest_points, point);
            self.normals[i] = normal.normalize_or_zero();
        }
    }

    /// A surface with the base's vertices at rest, posed by linear skinning with one bone a joint (m) `[vertices]`.
    pub fn skinned(&mut self, model: &BodyModel, state: &FitState, rest: &[Vec3]) -> Vec<Vec3> {
        self.rest = model.shapes.skeleton(&state.shape);
        self.joints(state);
        let skinned = |(p, weights): (&Vec3, &SkinWeights)| {
            let by_bone = weights.iter().map(|(bone, w)| {
                let j = bone_joint(bone as usize).map_or(0, Joint::index);
                w * (self.place[j] + self.turned[j] * (*p - self.rest.rest[j]))
            });
            by_bone.sum::<Vec3>()
        };
        rest.iter().zip(&model.shapes.base().weights).map(skinned).collect()
    }

    fn joints(&mut self, state: &FitState) {
        for joint in Joint::ALL {
            let i = joint.index();
            let local = Mat3::from_quat(state.local[i]);
            match joint.parent().map(Joint::index) {
                None => (self.turned[i], self.place[i]) = (local, state.root),
                Some(p) => {
                    self.turned[i] = self.turned[p] * local;
                    self.place[i] = self.place[p] + self.turned[p] * (self.rest.rest[i] - self.rest.rest[p]);
                }
            }
        }
    }

    fn drifts(&mut self, model: &BodyModel) {
        for k in 0..SHAPES {
            let scale = self.scale;
            let rest = &self.rest.rest;
            let joint = |j: usize| if k == SCALE { rest[j] } else { scale * model.shapes.joint_moves(k)[j] };
            let mut moved = [Vec3::ZERO; JOINTS];
            for j in Joint::ALL {
                let i = j.index();
                if let Some(p) = j.parent().map(Joint::index) {
                    moved[i] = moved[p] + self.turned[p] * (joint(i) - joint(p));
                }
                self.drift[i][k] = moved[i] - self.turned[i] * joint(i);
            }
        }
    }

    /// Derivatives of a joint's place along a direction.
    pub fn joint_row(&self, model: &BodyModel, joint: Joint, along: Vec3) -> JacobianRow {
        let mut row = [0.0; WIDTH];
        row[..3].copy_from_slice(&along.to_array());
        let i = joint.index();
        let mut above = joint.parent();
        while let Some(carrier) = above {
            let (first, end) = model.of_joint[carrier.index()];
            let pull = (self.place[i] - self.place[carrier.index()]).cross(along);
            for t in first as usize..end as usize {
                row[3 + t] += self.axes[t].dot(pull);
            }
            above = carrier.parent();
        }
        for (k, r) in row[POSE..POSE + SHAPES].iter_mut().enumerate() {
            let rest = self.rest.rest[i];
            let moved = if k == SCALE { rest } else { self.scale * model.shapes.joint_moves(k)[i] };
            *r = along.dot(self.drift[i][k] + self.turned[i] * moved);
        }
        row
    }

    /// Height of a sample above its height in the rest pose on level ground at 0 (m).
    pub fn above_rest(&self, index: usize) -> f32 {
        self.points[index].y - self.rest_points[index].y
    }

    /// Derivatives of [`PosedBody::above_rest`].
    pub fn row_above_rest(&self, model: &BodyModel, index: usize) -> JacobianRow {
        let mut row = self.row(model, index, Vec3::Y);
        for &(k, by) in model.moves(&model.samples[index]) {
            row[POSE + k as usize] -= self.scale * by.y;
        }
        row[POSE + SCALE] -= self.rest_points[index].y;
        row
    }

    /// Derivatives of a sample's position along a direction.
    pub fn row(&self, model: &BodyModel, index: usize, along: Vec3) -> JacobianRow {
        let sample = &model.samples[index];
        let mut row = [0.0; WIDTH];
        row[..3].copy_from_slice(&along.to_array());
        let mut inward = Vec3::ZERO;
        for &(j, w) in sample.bones.iter().filter(|b| b.1 > 0.0) {
            let bone = j as usize;
            let at = self.place[bone] + self.turned[bone] * (self.rest_points[index] - self.rest.rest[bone]);
            let mut above = Some(Joint::ALL[bone]);
            while let Some(joint) = above {
                let (first, end) = model.of_joint[joint.index()];
                if first < end {
                    let pull = w * (at - self.place[joint.index()]).cross(along);
                    for t in first as usize..end as usize {
                        row[3 + t] += self.axes[t].dot(pull);
                    }
                }
                above = joint.parent();
            }
            inward += w * (self.turned[bone].transpose() * along);
            let along = w * along;
            for (r, drift) in row[POSE..].iter_mut().zip(&self.drift[bone]) {
                *r += along.dot(*drift);
            }
        }
        for &(k, by) in model.moves(sample) {
            row[POSE + k as usize] += self.scale * inward.dot(by);
        }
        row[POSE + SCALE] += inward.dot(self.rest_points[index]);
        row
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use toile_base::body::Sex;

    /// A bent, turned body of an unusual shape.
    fn bent(model: &BodyModel) -> FitState {
        let mut state =
            FitState { root: Vec3::new(0.3, 0.9, -0.2), local: [Quat::IDENTITY; JOINTS], shape: *model.shapes.mean() };
        let mut step = [0.0; UNKNOWNS];
        for (i, s) in step.iter_mut().enumerate().skip(3) {
            let wave = (i as f64 * 1.7).sin();
            *s = if i < POSE { 0.4 * wave } else { 0.03 * wave };
        }
        state = state.stepped(model, &step);
        state
    }

    #[test]
    fn rows_are_the_change_of_a_sample_with_every_unknown() {
        let model = BodyModel::new(Shapes::of(Sex::Female), 0.12);
        let state = bent(&model);
        let normals = vec![Vec3::Z; model.samples.len()];
        let mut posed = PosedBody::new(&model);
        let mut moved = PosedBody::new(&model);
        const BY: f64 = 2e-3;
        let mut worst = 0.0f32;
        for unknown in 0..UNKNOWNS {
            // A bent joint with two axes loses the rotation that both together give about the third, which its rows leave out: they are
            // exact where it is straight.
            let mut state = state;
            if let Some(turn) = model.joint_angles.get(unknown.wrapping_sub(3))
                && model.joint_angles.iter().filter(|other| other.joint == turn.joint).count() == 2
            {
                state.local[turn.joint.index()] = Quat::IDENTITY;
            }
            posed.pose(&model, &state, &normals);
            let [before, after] = [-BY, BY].map(|by| {
                let mut step = [0.0; UNKNOWNS];
                step[unknown] = by;
                moved.pose(&model, &state.stepped(&model, &step), &normals);
                (moved.points.clone(), moved.place)
            });
            for joint in Joint::ALL {
                for axis in [Vec3::X, Vec3::Y, Vec3::Z] {
                    let change = (after.1[joint.index()] - before.1[joint.index()]).dot(axis) / (2.0 * BY as f32);
                    let off = (posed.joint_row(&model, joint, axis)[unknown] - change).abs();
                    assert!(off < 2e-3, "unknown {unknown} {joint:?}: {change} off by {off}");
                }
            }
            let [before, after] = [before.0, after.0];
            for i in 0..model.samples.len() {
                for axis in [Vec3::X, Vec3::Y, Vec3::Z] {
                    let change = (after[i] - before[i]).dot(axis) / (2.0 * BY as f32);
                    let off = (posed.row(&model, i, axis)[unknown] - change).abs();
                    worst = worst.max(off);
                    assert!(off < 2e-3, "unknown {unknown} sample {i}: {change} off by {off}");
                }
            }
        }
        println!("worst {worst}");
    }

    #[test]
    fn the_rest_pose_is_the_body_itself() {
        let model = BodyModel::new(Shapes::of(Sex::Male), 0.03);
        let shape = *model.shapes.mean();
        let rest = model.shapes.skeleton(&shape);
        let state = FitState { root: rest.at(Joint::Pelvis), local: [Quat::IDENTITY; JOINTS], shape };
        let mut posed = PosedBody::new(&model);
        posed.pose(&model, &state, &vec![Vec3::Y; model.samples.len()]);
        for (sample, point) in model.samples.iter().zip(&posed.points) {
            let corners = sample.corners.map(|v| model.shapes.place(v as usize, &shape));
            assert!(point.distance(corners.iter().sum::<Vec3>() / 4.0) < 1e-5);
        }
        assert!(model.samples.iter().filter(|s| s.sole).count() > 10);
    }
}
