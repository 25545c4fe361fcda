//! Tests of the sweep: nothing moves at rest, the same input gives the same bits, and a bent limb keeps its volume better.

use glam::{Affine3A, Quat, Vec3};
use toile_assets::body::{En, Wanted};
use toile_base::body::{Body, Sex};
use toile_base::skeleton::{BONES, Joint, Pose};

use crate::body::palette;
use crate::skin::{Blend, PosedMesh, SkinningJob, SweptSkin};

fn woman() -> Body {
    toile_assets::body::fitted(Sex::Female, &Wanted::<En>::new()).unwrap().body
}

struct Swept {
    job: SkinningJob,
    sweep: SweptSkin,
    body: Body,
}

impl Swept {
    fn new() -> Self {
        let body = woman();
        let (points, normals) = (&body.mesh.positions, &body.normals);
        Self {
            job: SkinningJob::new(points, normals, &body.weights).unwrap(),
            sweep: SweptSkin::new(&body.skeleton, points, normals, &body.weights),
            body,
        }
    }

    fn posed(&self, pose: &Pose, swept: bool) -> PosedMesh {
        let mut bones = [Affine3A::IDENTITY; BONES];
        palette(&self.body.skeleton, pose, &mut bones);
        let mut posed = self.job.posed_mesh();
        self.job.run_mesh(Blend::Dual, &bones, &mut posed);
        if swept {
            self.sweep.run(&bones, &mut posed);
        }
        posed
    }

    fn volume(&self, posed: &PosedMesh) -> f64 {
        let at = |v: u32| Vec3::from(posed.vertices()[v as usize].position).as_dvec3();
        self.body.mesh.triangles.iter().map(|&[a, b, c]| at(a).dot(at(b).cross(at(c))) / 6.0).sum()
    }

    fn bent(&self, joint: Joint, degrees: f32) -> Pose {
        let skeleton = &self.body.skeleton;
        let bends = if joint == Joint::LeftElbow { Vec3::Z } else { Vec3::NEG_Z };
        let axis = skeleton.offset(joint).normalize().cross(bends).normalize();
        let mut pose = Pose::rest(skeleton);
        pose.local[joint.index()] = Quat::from_axis_angle(axis, degrees.to_radians());
        pose
    }
}

#[test]
fn a_sweep_at_rest_moves_nothing() {
    let swept = Swept::new();
    let rest = swept.posed(&Pose::rest(&swept.body.skeleton), true);
    for (v, p) in rest.vertices().iter().zip(&swept.body.mesh.positions) {
        assert!(Vec3::from(v.position).distance(*p) < 2e-5, "{p} moved to {:?}", v.position);
    }
    assert!(swept.sweep.bindings.len() > 500, "{}", swept.sweep.bindings.len());
}

#[test]
fn a_bent_limb_that_is_swept_keeps_its_volume_and_the_same_bits() {
    let swept = Swept::new();
    let rest = swept.volume(&swept.posed(&Pose::rest(&swept.body.skeleton), false));
    for (joint, degrees) in
        [(Joint::LeftElbow, 90.0), (Joint::LeftElbow, 120.0), (Joint::LeftKnee, 90.0), (Joint::LeftKnee, 120.0)]
    {
        let pose = swept.bent(joint, degrees);
        let (with, without) = (swept.posed(&pose, true), swept.posed(&pose, false));
        let lost = |p: &PosedMesh| 1e6 * (swept.volume(p) - rest);
        println!("{joint:?} {degrees}: dual {:+.1} ml, swept {:+.1} ml", lost(&without), lost(&with));
        assert!(lost(&with).abs() < lost(&without).abs(), "{joint:?} {degrees}");
        assert_eq!(with, swept.posed(&pose, true));
        for v in with.vertices() {
            let n = Vec3::from(v.normal);
            assert!(n.is_finite() && (n.length() - 1.0).abs() < 1e-3, "{n}");
        }
    }
}
