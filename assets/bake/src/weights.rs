//! Weights: what sticks to the body moves with the skin beneath it.

use glam::Vec3;

use toile_base::body::Body;
use toile_base::mesh::SkinWeights;
use toile_base::skeleton::{BONES, Joint};

/// Body vertices that share in a garment vertex: enough to smooth over one quad of the body.
const NEIGHBOURS: usize = 6;

/// Skin weights for points near the body: the weights of the nearest body vertices, nearer ones counting more, cut to
/// the four strongest bones among those that `carries` admits for a point: a bodice does not follow the arm beside it.
pub fn transfer(body: &Body, points: &[Vec3], carries: impl Fn(Vec3, usize) -> bool) -> Vec<SkinWeights> {
    points.iter().map(|&p| at(body, p, &|bone| carries(p, bone))).collect()
}

/// The trunk's bones: which carry a bodice or a waistband.
pub fn trunk(bone: usize) -> bool {
    [Joint::Pelvis, Joint::Spine, Joint::Chest].iter().any(|j| j.index() == bone)
}

/// The trunk's bones and the shoulder girdle's: which carry straps and yokes.
pub fn shoulders(bone: usize) -> bool {
    trunk(bone) || [Joint::Neck, Joint::LeftClavicle, Joint::RightClavicle].iter().any(|j| j.index() == bone)
}

fn at(body: &Body, point: Vec3, carries: &impl Fn(usize) -> bool) -> SkinWeights {
    let mut nearest = [(f32::MAX, 0usize); NEIGHBOURS];
    for (i, p) in body.mesh.positions.iter().enumerate() {
        let d2 = p.distance_squared(point);
        if d2 < nearest[NEIGHBOURS - 1].0 {
            nearest[NEIGHBOURS - 1] = (d2, i);
            nearest.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        }
    }
    let mut sum = [0.0f32; BONES];
    for (d2, i) in nearest {
        let share = (d2 + 1e-6).recip();
        let w = &body.weights[i];
        let carried = w.bones.iter().zip(&w.weights).filter(|(b, _)| carries(usize::from(**b)));
        carried.for_each(|(&b, &x)| sum[usize::from(b)] += share * x);
    }
    if sum.iter().all(|x| *x <= 0.0) {
        // Nothing near is admitted: such a point follows the chest, which carries every garment.
        sum[Joint::Chest.index()] = 1.0;
    }
    SkinWeights::strongest((0u8..).zip(sum)).0
}
