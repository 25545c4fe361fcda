//! A body that moves as an animation of its file says: our poses, and the file's own skin in f64 that they are held against.
//!
//! Our rest pose is the file's bind pose, so a joint's rotation from rest to world is the rotation of its skin matrix (the joint's
//! place in the scene times its inverse bind matrix), seen from our axes. Between two of our joints a file may have more, of a
//! spine for example. So a joint with one child is turned on, by the shortest way, until that lies in the direction in which the
//! file has it; one with several is turned so that they lie nearest to where the file has them (Horn 1987, "Closed-form
//! solution of absolute orientation using unit quaternions"). What scales joints is left out: our bones are rigid.

use glam::{DMat3, DMat4, DQuat, DVec3, DVec4, Quat};

use super::animation::GltfClip;
use super::error::Flaw;
use super::imported::ImportedBody;
use super::raw::{RawBody, RawInfluences};
use super::skinned::BoundJoints;
use toile_base::limits::STEP_HZ;
use toile_base::skeleton::{JOINTS, Joint, Pose, Skeleton};

/// How much a joint's own rotation counts where it is laid by its children (m2): as axes of 5 mm, so that children in one line
/// leave no turn about it open.
const OWN_TURN_M2: f64 = 2.5e-5;

/// An imported body with the motion of one animation.
#[derive(Debug)]
pub struct MovingBody {
    /// The body in its rest pose, and what was found in its file.
    pub imported: ImportedBody,
    /// Name of the animation.
    pub animation: String,
    /// Its length (s).
    pub seconds: f64,
    /// Its poses [`STEP_HZ`] times a second, from its beginning to its end.
    pub poses: Vec<Pose>,
    skin: MovingSkin,
}

/// The file's own skin in motion.
pub(super) struct MovingSkin {
    joints: BoundJoints,
    /// Joints and what is above them, parents first, as indices of the raw ones.
    order: Vec<usize>,
    parents: Vec<Option<usize>>,
    /// Which raw joint each of ours is.
    places: [Option<usize>; JOINTS],
    clip: GltfClip,
    /// From the file's space to ours.
    ours: DMat4,
    influences: Vec<RawInfluences>,
    rest: Vec<DVec3>,
}

impl std::fmt::Debug for MovingSkin {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "MovingSkin({} vertices, {} s)", self.rest.len(), self.clip.seconds)
    }
}

impl MovingSkin {
    /// Of a raw body that stands in our axes and unit.
    pub fn new(raw: &RawBody, joints: BoundJoints, clip: GltfClip, ours: DMat4) -> Self {
        let parents: Vec<Option<usize>> = raw.joints.iter().map(|j| j.parent).collect();
        let depth = |mut k: usize| {
            let mut depth = 0;
            while let Some(parent) = parents[k] {
                (k, depth) = (parent, depth + 1);
            }
            depth
        };
        let mut order: Vec<usize> = (0..parents.len()).collect();
        order.sort_by_key(|k| depth(*k));
        Self {
            joints,
            order,
            parents,
            places: raw.reading.places,
            clip,
            ours,
            influences: raw.influences.clone(),
            rest: raw.positions.iter().map(|p| p.as_dvec3()).collect(),
        }
    }

    /// The skin matrices of all raw joints at a time (s), from rest to world in our axes and unit.
    fn matrices(&self, seconds: f64) -> Vec<DMat4> {
        let mut local: Vec<DMat4> = self.joints.of.iter().map(|n| self.joints.nodes.local(*n).as_dmat4()).collect();
        for (node, now) in self.clip.at(seconds) {
            if let Ok(k) = self.joints.of.binary_search(&node) {
                local[k] = now;
            }
        }
        let mut world = local.clone();
        for &k in &self.order {
            if let Some(parent) = self.parents[k] {
                world[k] = world[parent] * local[k];
            }
        }
        let back = self.ours.inverse();
        let skin = |(world, bound): (&DMat4, &glam::Mat4)| self.ours * *world * bound.as_dmat4().inverse() * back;
        world.iter().zip(&self.joints.bound).map(skin).collect()
    }

    /// Our pose at a time (s).
    fn pose(&self, skeleton: &Skeleton, seconds: f64) -> Pose {
        let matrices = self.matrices(seconds);
        let of = |joint: Joint| self.places[joint.index()].map(|k| &matrices[k]);
        let turn = |m: &DMat4| m.to_scale_rotation_translation().1.normalize();
        let place = |joint: Joint| of(joint).map(|m| m.transform_point3(skeleton.at(joint).as_dvec3()));
        let mut world = [DQuat::IDENTITY; JOINTS];
        let mut local = [Quat::IDENTITY; JOINTS];
        for joint in Joint::ALL {
            let above = joint.parent().map_or(DQuat::IDENTITY, |p| world[p.index()]);
            let mut now = of(joint).map_or(above, turn);
            if let Some(from) = place(joint) {
                let children = Joint::ALL.into_iter().filter(|child| child.parent() == Some(joint));
                let way = |child: Joint| Some((skeleton.offset(child).as_dvec3(), place(child)? - from));
                now = laid(now, &children.filter_map(way).collect::<Vec<_>>());
            }
            world[joint.index()] = now;
            local[joint.index()] = (above.inverse() * now).normalize().as_quat();
        }
        let root = place(Joint::Pelvis).unwrap_or_default().as_vec3();
        Pose { root, local }
    }

    /// The file's own skin at a time (s).
    fn surface(&self, seconds: f64) -> Vec<DVec3> {
        let matrices = self.matrices(seconds);
        let vertex = |(p, influences): (&DVec3, &RawInfluences)| {
            let carried = influences.0.iter().filter(|(_, w)| *w > 0.0);
            carried.map(|(joint, w)| f64::from(*w) * matrices[usize::from(*joint)].transform_point3(*p)).sum()
        };
        self.rest.iter().zip(&self.influences).map(vertex).collect()
    }
}

/// A rotation turned on so that the ways to children, as they are at rest, lie as they are wanted: exactly in the direction of a
/// single one, nearest to several.
fn laid(now: DQuat, children: &[(DVec3, DVec3)]) -> DQuat {
    match children {
        [] => now,
        [(rest, want)] => match ((now * *rest).try_normalize(), want.try_normalize()) {
            (Some(have), Some(want)) => (DQuat::from_rotation_arc(have, want) * now).normalize(),
            _ => now,
        },
        _ => {
            let own = DVec3::AXES.map(|axis| (axis, now * axis * OWN_TURN_M2));
            let all = children.iter().copied().chain(own);
            // Columns are those of the wanted ways: s[i][j] is rest_j want_i.
            let s = all
                .fold(DMat3::ZERO, |s, (rest, want)| s + DMat3::from_cols(want * rest.x, want * rest.y, want * rest.z));
            nearest(&s)
        }
    }
}

/// The rotation nearest to a matrix (Horn 1987, section 4): the eigenvector of the largest eigenvalue of a symmetric matrix of
/// quaternions, by squaring it again and again.
fn nearest(s: &DMat3) -> DQuat {
    let at = |want: usize, rest: usize| s.col(rest)[want];
    let [xx, yy, zz] = [0, 1, 2].map(|k| at(k, k));
    let [x, y, z] = [at(2, 1) - at(1, 2), at(0, 2) - at(2, 0), at(1, 0) - at(0, 1)];
    let [xy, yz, zx] = [at(0, 1) + at(1, 0), at(1, 2) + at(2, 1), at(2, 0) + at(0, 2)];
    let mut power = DMat4::from_cols(
        DVec4::new(xx - yy - zz, xy, zx, x),
        DVec4::new(xy, yy - xx - zz, yz, y),
        DVec4::new(zx, yz, zz - xx - yy, z),
        DVec4::new(x, y, z, xx + yy + zz),
    );
    let size = |m: &DMat4| m.to_cols_array().iter().map(|x| x * x).sum::<f64>().sqrt().max(f64::MIN_POSITIVE);
    // No eigenvalue is negative then, and the largest stays the largest.
    power += DMat4::from_diagonal(DVec4::splat(size(&power)));
    for _ in 0..SQUARINGS {
        power = power * (1.0 / size(&power));
        power = power * power;
    }
    let column = [power.x_axis, power.y_axis, power.z_axis, power.w_axis];
    let longest = column.into_iter().max_by(|a, b| a.length_squared().total_cmp(&b.length_squared()));
    DQuat::from_vec4(longest.unwrap_or(DVec4::W)).normalize()
}

/// Squarings after which eigenvalues a millionth apart are told from each other.
const SQUARINGS: usize = 28;

impl MovingBody {
    pub(super) fn new(mut imported: ImportedBody, skin: MovingSkin) -> Result<Self, Flaw> {
        let (animation, seconds) = (skin.clip.name.clone(), skin.clip.seconds);
        let steps = (seconds * f64::from(STEP_HZ)).ceil() as u64;
        let poses: Vec<Pose> =
            (0..=steps).map(|k| skin.pose(&imported.body.skeleton, k as f64 / f64::from(STEP_HZ))).collect();
        if let Some(k) = poses.iter().position(|p| !p.root.is_finite() || p.local.iter().any(|q| !q.is_finite())) {
            let reason = format!("is not finite at {:.2} s; export it again", k as f64 / f64::from(STEP_HZ));
            return Err(Flaw::Animation { name: animation, reason });
        }
        if skin.clip.scales() {
            imported.report.notes.push(format!("animation {animation} scales joints, and our bones keep their length"));
        }
        Ok(Self { imported, animation, seconds, poses, skin })
    }

    /// The surface as the file itself skins it (all influences, linear blending, f64) at one of the poses, in the order of the
    /// body's vertices (m).
    pub fn surface(&self, pose: usize) -> Vec<DVec3> {
        self.skin.surface(pose as f64 / f64::from(STEP_HZ))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_rotation_is_found_by_where_it_takes_points() {
        for (k, axis) in
            [DVec3::X, DVec3::new(0.6, -0.8, 0.0), DVec3::new(1.0, 2.0, -3.0).normalize()].into_iter().enumerate()
        {
            for angle in [0.0, 0.3, -1.2, 2.5, std::f64::consts::PI] {
                let turn = DQuat::from_axis_angle(axis, angle);
                let ways = [DVec3::new(0.0, 0.2, 0.01), DVec3::new(0.05, 0.15, 0.0), DVec3::new(-0.05, 0.15, 0.0)];
                let children = ways.map(|rest| (rest, turn * rest));
                let found = laid(turn, &children);
                assert!(found.angle_between(turn) < 1e-6, "{k}, {angle}: {}", found.angle_between(turn));
                // From another rotation, which counts for little.
                let off = laid(turn * DQuat::from_rotation_z(0.2), &children);
                assert!(off.angle_between(turn) < 2e-3, "{k}, {angle}: {}", off.angle_between(turn));
            }
        }
    }

    #[test]
    fn one_child_is_aimed_at_and_children_in_one_line_keep_the_turn_about_it() {
        let turn = DQuat::from_rotation_y(0.7);
        let aimed = laid(turn, &[(DVec3::Y * 0.3, DVec3::new(0.1, 0.3, 0.0))]);
        assert!((aimed * DVec3::Y).angle_between(DVec3::new(0.1, 0.3, 0.0)) < 1e-6);
        let line = [(DVec3::Y * 0.3, DVec3::Y * 0.3), (DVec3::Y * 0.1, DVec3::Y * 0.1)];
        assert!(laid(turn, &line).angle_between(turn) < 1e-6);
        assert_eq!(laid(turn, &[]), turn);
    }
}
