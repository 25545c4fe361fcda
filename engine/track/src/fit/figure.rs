//! A body of some shape in some pose: where each sample of its surface lies, and how it moves with every unknown.
//!
//! Skinning is linear with one bone a joint. A sample `x = sum_j w_j (p_j + R_j (X - J_j))` of rest position `X` moves
//! with a turn about the axis `a` through the joint at `p` by `sum_j w_j a x (x_j - p)` over the bones `j` that hang
//! from it, with the root as a whole, and with a shape's parameter `s` by
//! `sum_j w_j (R_j dX/ds + dp_j/ds - R_j dJ_j/ds)`.

use glam::{Mat3, Quat, Vec3};
use toile_assets::body::shape::{SCALE, SHAPES, Shape, Shapes};
use toile_assets::skeleton::{JOINTS, Joint, Skeleton, bone_joint};

use super::turns::{TURNS, Turn, turns};

/// Unknowns of the pose: the root's place, then the turns.
pub(super) const POSE: usize = 3 + TURNS;

/// All unknowns: the pose, then the shape.
pub(super) const UNKNOWNS: usize = POSE + SHAPES;

/// [`UNKNOWNS`] rounded up to whole lanes.
pub(super) const WIDTH: usize = UNKNOWNS.next_multiple_of(8);

/// How one number changes with every unknown.
pub(super) type Row = [f32; WIDTH];

/// Most bones of one sample.
const BONES_EACH: usize = 4;

/// The middle of one face of the surface. Faces and not vertices, because a face is flat: where on it a measured point
/// lies changes nothing, while beside a vertex the surface falls away from its tangent plane.
#[derive(Debug, Clone)]
pub(super) struct Sample {
    /// Its face.
    pub corners: [u32; 4],
    /// Its place on the drawn body (m).
    drawn: Vec3,
    /// The sliders that move it: first and end in [`Cast::moves`].
    moves: (u32, u32),
    /// Joints that carry it, with their shares.
    bones: [(u8, f32); BONES_EACH],
    /// Whether the ground carries it when one stands.
    pub sole: bool,
    /// Whether hair may cover it.
    pub hairy: bool,
}

impl Sample {
    /// The joints that carry it, with their shares.
    pub(super) fn bones(&self) -> impl Iterator<Item = (usize, f32)> + '_ {
        self.bones.iter().filter(|b| b.1 > 0.0).map(|b| (b.0 as usize, b.1))
    }
}

/// One sex's samples and angles: what does not change from frame to frame.
pub(super) struct Cast {
    pub shapes: &'static Shapes,
    pub samples: Vec<Sample>,
    /// Sliders and moves a unit of all samples.
    moves: Vec<(u32, Vec3)>,
    pub turns: [Turn; TURNS],
    /// The turns of each joint: first and end.
    of_joint: [(u8, u8); JOINTS],
}

/// Height below which the drawn body's surface is sole (m).
const SOLE: f32 = 0.012;

impl Cast {
    /// Samples at least about `spacing` (m) apart; every face for 0.
    pub(super) fn new(shapes: &'static Shapes, spacing: f32) -> Self {
        let turns = turns(&shapes.skeleton(shapes.mean()));
        let mut of_joint = [(0u8, 0u8); JOINTS];
        for (i, joint) in Joint::ALL.into_iter().enumerate() {
            let first = turns.iter().position(|t| t.joint == joint).unwrap_or(0);
            let count = turns.iter().filter(|t| t.joint == joint).count();
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
        Self { shapes, samples, moves, turns, of_joint }
    }

    /// The sliders that move a sample, and by how much a unit, before scaling (m).
    fn moves(&self, sample: &Sample) -> &[(u32, Vec3)] {
        &self.moves[sample.moves.0 as usize..sample.moves.1 as usize]
    }

    /// Where a sample lies on a shape in the rest pose (m).
    fn place(&self, sample: &Sample, shape: &[f32; SHAPES], scale: f32) -> Vec3 {
        scale * self.moves(sample).iter().fold(sample.drawn, |p, &(k, d)| p + d * shape[k as usize])
    }
}

/// The mean of a face's corners.
fn sample(shapes: &Shapes, corners: [u32; 4], moves: &mut Vec<(u32, Vec3)>) -> Sample {
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
    let hairy = [Joint::Head, Joint::Neck].iter().any(|j| j.index() == bones[0].0 as usize);
    Sample { corners, drawn, moves: (first as u32, moves.len() as u32), bones, sole: drawn.y < SOLE, hairy }
}

/// What is sought: pose and shape.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct State {
    /// Place of the pelvis, world (m).
    pub root: Vec3,
    /// Rotation of each joint relative to its parent; the pelvis' relative to the world.
    pub local: [Quat; JOINTS],
    /// The shape.
    pub shape: Shape,
}

impl State {
    /// The state a step (in the order of the unknowns) further.
    pub(super) fn stepped(&self, cast: &Cast, step: &[f64; UNKNOWNS]) -> Self {
        let mut next = *self;
        next.root += Vec3::new(step[0] as f32, step[1] as f32, step[2] as f32);
        let mut turned = [Vec3::ZERO; JOINTS];
        for (turn, by) in cast.turns.iter().zip(&step[3..]) {
            turned[turn.joint.index()] += turn.axis * *by as f32;
        }
        for (local, by) in next.local.iter_mut().zip(turned) {
            *local = (Quat::from_scaled_axis(by) * *local).normalize();
        }
        for (joint, &(first, end)) in next.local.iter_mut().zip(&cast.of_joint) {
            // Turns about two axes, one after the other, come to one about the third as well.
            if end - first < 3 {
                let whole = joint.to_scaled_axis();
                let axes = cast.turns[first as usize..end as usize].iter().map(|t| t.axis);
                *joint = Quat::from_scaled_axis(axes.map(|a| a * a.dot(whole)).sum());
            }
        }
        for (k, s) in next.shape.iter_mut().enumerate() {
            let [least, most] = cast.shapes.bounds(k);
            *s = (*s + step[POSE + k]).clamp(least, most);
        }
        next
    }
}

/// A posed body.
pub(super) struct Figure {
    rest: Skeleton,
    scale: f32,
    /// Rotation of each joint from rest to world, and its place.
    turned: [Mat3; JOINTS],
    pub place: [Vec3; JOINTS],
    /// World axis of each turn.
    axes: [Vec3; TURNS],
    /// `dp_j/ds - R_j dJ_j/ds` of each joint and parameter.
    drift: Vec<[Vec3; SHAPES]>,
    /// Rest position, world position and world normal of each sample.
    still: Vec<Vec3>,
    pub points: Vec<Vec3>,
    pub normals: Vec<Vec3>,
}

impl Figure {
    pub(super) fn new(cast: &Cast) -> Self {
        let n = cast.samples.len();
        Self {
            rest: cast.shapes.skeleton(cast.shapes.mean()),
            scale: 1.0,
            turned: [Mat3::IDENTITY; JOINTS],
            place: [Vec3::ZERO; JOINTS],
            axes: [Vec3::ZERO; TURNS],
            drift: vec![[Vec3::ZERO; SHAPES]; JOINTS],
            still: vec![Vec3::ZERO; n],
            points: vec![Vec3::ZERO; n],
            normals: vec![Vec3::ZERO; n],
        }
    }

    /// Poses the body; `still_normals` are those of its samples at rest.
    pub(super) fn pose(&mut self, cast: &Cast, state: &State, still_normals: &[Vec3]) {
        self.rest = cast.shapes.skeleton(&state.shape);
        self.scale = state.shape[SCALE].exp() as f32;
        self.joints(state);
        for (axis, turn) in self.axes.iter_mut().zip(&cast.turns) {
            let parent = turn.joint.parent().map_or(Mat3::IDENTITY, |p| self.turned[p.index()]);
            *axis = parent * turn.axis;
        }
        self.drifts(cast);
        let shape = state.shape.map(|s| s as f32);
        for (i, sample) in cast.samples.iter().enumerate() {
            let still = cast.place(sample, &shape, self.scale);
            let (mut point, mut normal) = (Vec3::ZERO, Vec3::ZERO);
            for &(j, w) in sample.bones.iter().filter(|b| b.1 > 0.0) {
                let j = j as usize;
                point += w * (self.place[j] + self.turned[j] * (still - self.rest.rest[j]));
                normal += w * (self.turned[j] * still_normals[i]);
            }
            (self.still[i], self.points[i]) = (still, point);
            self.normals[i] = normal.normalize_or_zero();
        }
    }

    fn joints(&mut self, state: &State) {
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

    fn drifts(&mut self, cast: &Cast) {
        for k in 0..SHAPES {
            let scale = self.scale;
            let rest = &self.rest.rest;
            let joint = |j: usize| if k == SCALE { rest[j] } else { scale * cast.shapes.joint_moves(k)[j] };
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

    /// How high a sample lies above where it would on level ground at 0 (m).
    pub(super) fn above_rest(&self, index: usize) -> f32 {
        self.points[index].y - self.still[index].y
    }

    /// How [`Figure::above_rest`] changes with every unknown.
    pub(super) fn row_above_rest(&self, cast: &Cast, index: usize) -> Row {
        let mut row = self.row(cast, index, Vec3::Y);
        for &(k, by) in cast.moves(&cast.samples[index]) {
            row[POSE + k as usize] -= self.scale * by.y;
        }
        row[POSE + SCALE] -= self.still[index].y;
        row
    }

    /// How a sample's place along a direction changes with every unknown.
    pub(super) fn row(&self, cast: &Cast, index: usize, along: Vec3) -> Row {
        let sample = &cast.samples[index];
        let mut row = [0.0; WIDTH];
        row[..3].copy_from_slice(&along.to_array());
        let mut inward = Vec3::ZERO;
        for &(j, w) in sample.bones.iter().filter(|b| b.1 > 0.0) {
            let bone = j as usize;
            let at = self.place[bone] + self.turned[bone] * (self.still[index] - self.rest.rest[bone]);
            let mut above = Some(Joint::ALL[bone]);
            while let Some(joint) = above {
                let (first, end) = cast.of_joint[joint.index()];
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
        for &(k, by) in cast.moves(sample) {
            row[POSE + k as usize] += self.scale * inward.dot(by);
        }
        row[POSE + SCALE] += inward.dot(self.still[index]);
        row
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use toile_assets::body::Sex;

    /// A bent, turned body of an unusual shape.
    fn bent(cast: &Cast) -> State {
        let mut state =
            State { root: Vec3::new(0.3, 0.9, -0.2), local: [Quat::IDENTITY; JOINTS], shape: *cast.shapes.mean() };
        let mut step = [0.0; UNKNOWNS];
        for (i, s) in step.iter_mut().enumerate().skip(3) {
            let wave = (i as f64 * 1.7).sin();
            *s = if i < POSE { 0.4 * wave } else { 0.03 * wave };
        }
        state = state.stepped(cast, &step);
        state
    }

    #[test]
    fn rows_are_the_change_of_a_sample_with_every_unknown() {
        let cast = Cast::new(Shapes::of(Sex::Female), 0.12);
        let state = bent(&cast);
        let normals = vec![Vec3::Z; cast.samples.len()];
        let mut figure = Figure::new(&cast);
        let mut moved = Figure::new(&cast);
        const BY: f64 = 2e-3;
        let mut worst = 0.0f32;
        for unknown in 0..UNKNOWNS {
            // A bent joint with two axes loses what both turns come to about the third, which its rows leave out: they are
            // exact where it is straight.
            let mut state = state;
            if let Some(turn) = cast.turns.get(unknown.wrapping_sub(3))
                && cast.turns.iter().filter(|other| other.joint == turn.joint).count() == 2
            {
                state.local[turn.joint.index()] = Quat::IDENTITY;
            }
            figure.pose(&cast, &state, &normals);
            let [before, after] = [-BY, BY].map(|by| {
                let mut step = [0.0; UNKNOWNS];
                step[unknown] = by;
                moved.pose(&cast, &state.stepped(&cast, &step), &normals);
                moved.points.clone()
            });
            for i in 0..cast.samples.len() {
                for axis in [Vec3::X, Vec3::Y, Vec3::Z] {
                    let change = (after[i] - before[i]).dot(axis) / (2.0 * BY as f32);
                    let off = (figure.row(&cast, i, axis)[unknown] - change).abs();
                    worst = worst.max(off);
                    assert!(off < 2e-3, "unknown {unknown} sample {i}: {change} off by {off}");
                }
            }
        }
        println!("worst {worst}");
    }

    #[test]
    fn the_rest_pose_is_the_body_itself() {
        let cast = Cast::new(Shapes::of(Sex::Male), 0.03);
        let shape = *cast.shapes.mean();
        let rest = cast.shapes.skeleton(&shape);
        let state = State { root: rest.at(Joint::Pelvis), local: [Quat::IDENTITY; JOINTS], shape };
        let mut figure = Figure::new(&cast);
        figure.pose(&cast, &state, &vec![Vec3::Y; cast.samples.len()]);
        for (sample, point) in cast.samples.iter().zip(&figure.points) {
            let corners = sample.corners.map(|v| cast.shapes.place(v as usize, &shape));
            assert!(point.distance(corners.iter().sum::<Vec3>() / 4.0) < 1e-5);
        }
        assert!(cast.samples.iter().filter(|s| s.sole).count() > 10);
    }
}
