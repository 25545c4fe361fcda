//! The layout: every vertex has one place among its bones, few lanes are empty, and the workers' shares are alike.

use toile_base::body::{Measures, Sex};

use super::*;
use crate::lanes::MOST;

#[test]
fn every_vertex_has_a_place_of_its_own_among_its_bones() {
    let crowd = Crowd::<8>::new(3_000, 1.0);
    let job = crowd.job();
    let mut slots = job.layout.slots.to_vec();
    slots.sort_unstable();
    slots.dedup();
    assert_eq!(slots.len(), 3_000);
    for v in 0..3_000 {
        let bones = job.layout.bones_of(v);
        assert!(crowd.weights[v].iter().all(|(b, _)| bones.contains(&b)), "vertex {v} on {bones:?}");
    }
    let filled: usize = job.layout.filled.iter().map(|f| usize::from(*f)).sum();
    assert_eq!(filled, 3_000);
}

#[test]
fn a_loop_over_what_is_laid_gives_the_kernels_bits() {
    let crowd = Crowd::<8>::new(1_501, 1.0);
    let job = crowd.job();
    let got = posed(&job, Blend::Dual, &crowd.palette);
    let (duals, runs) = (dual_palette(&crowd.palette), job.runs().collect::<Vec<_>>());
    let mut seen = vec![false; 1_501];
    for laid in job.laid() {
        assert!(!std::mem::replace(&mut seen[laid.vertex], true), "vertex {} is laid twice", laid.vertex);
        assert_eq!((laid.position, laid.vertex), (crowd.positions[laid.vertex], laid.vertex));
        let bones = runs[laid.run];
        let base = duals[usize::from(bones[0])];
        let (mut real, mut dual) = (base.real, base.dual);
        for (bone, weight) in bones[1..].iter().zip(laid.weights) {
            let bone = duals[usize::from(*bone)];
            real += (bone.real - base.real) * weight;
            dual += (bone.dual - base.dual) * weight;
        }
        let (v, w, u, s) = (real.truncate(), real.w, dual.truncate(), dual.w);
        let squared = v.x * v.x + v.y * v.y + v.z * v.z + w * w;
        let moved = v.cross(v.cross(laid.position) + laid.position * w + u) + (u * w - v * s);
        assert_eq!(got.position(laid.vertex), laid.position + moved * (2.0 / squared), "vertex {}", laid.vertex);
    }
    assert!(seen.iter().all(|s| *s));
}

#[test]
fn the_workers_share_blocks_alike_and_no_block_twice() {
    let job = Crowd::<4>::new(5_000, 1.0).job();
    let blocks = |runs: &[crate::skin::layout::BoneRun]| runs.iter().map(|r| r.blocks).sum::<usize>();
    let (one, two) = job.layout.runs.split_at(job.layout.half);
    let mut next: Vec<(usize, usize)> = job.layout.runs.iter().map(|r| (r.first, r.blocks)).collect();
    next.sort_unstable();
    assert!(next.windows(2).all(|w| w[0].0 + w[0].1 == w[1].0), "blocks follow each other");
    assert_eq!(blocks(one) + blocks(two), job.layout.filled.len());
    let cost =
        |runs: &[crate::skin::layout::BoneRun]| -> usize { runs.iter().map(|r| r.blocks * (27 + 24 * r.count)).sum() };
    let (one, two) = (cost(one), cost(two));
    assert!(one.abs_diff(two) <= 2 * (27 + 24 * 4), "{one} against {two}");
}

#[test]
fn remainders_share_blocks() {
    // Fifty sets of two bones out of a limb's chain, three vertices each: by themselves they would fill 3 lanes of 16.
    let weights: Vec<SkinWeights> = (0..150)
        .map(|v| SkinWeights { bones: [(v / 3) as u8, (v / 3 + 1) as u8, 0, 0], weights: [0.5, 0.5, 0.0, 0.0] })
        .collect();
    let points = vec![Vec3::Y; 150];
    let job = SkinningJob::new(&points, &points, &weights).unwrap();
    assert!(job.layout.filled.len() < 25, "{} blocks", job.layout.filled.len());
}

#[test]
fn the_bodies_lanes_are_mostly_filled() {
    for sex in [Sex::Female, Sex::Male] {
        let body = toile_assets::body::build(sex, &Measures::average(sex)).unwrap();
        let job = SkinningJob::new(&body.mesh.positions, &body.normals, &body.weights).unwrap();
        let mut found = Vec::new();
        for width in widths() {
            let padding = SkinningJob { width, ..job.clone() }.padding();
            assert_eq!(padding.vertices, body.mesh.positions.len());
            assert!(padding.lanes >= padding.vertices && padding.lanes <= padding.blocks * MOST);
            found.push(padding.share());
        }
        assert_eq!(found[0], 0.0, "one lane is never empty");
        assert!(found.iter().all(|f| *f < 0.05), "{sex:?}: {found:?} of the lanes are empty");
    }
}
