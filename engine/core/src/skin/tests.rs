//! Tests of the skin: scalar references in f64 and in plain f32, the same bits at every width, and refused input.

mod layout;
mod references;
mod shapes;
mod sweep;

use glam::{Affine3A, Quat, Vec3};
use toile_base::mesh::{Influences, SkinWeights};
use toile_base::skeleton::BONES;

use super::{Blend, Posed, PosedMesh, SkinError, SkinningJob, dual_palette};
use crate::lanes::Width;
use crate::workers::WorkerPool;

/// A generator of our own: uniform in 0..1.
fn uniform(state: &mut u64) -> f32 {
    *state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
    (*state >> 40) as f32 / (1 << 24) as f32
}

/// Vertices with one to `N` influences, and a palette.
struct Crowd<const N: usize> {
    positions: Vec<Vec3>,
    normals: Vec<Vec3>,
    weights: Vec<Influences<N>>,
    palette: [Affine3A; BONES],
}

impl<const N: usize> Crowd<N> {
    /// Bones that are turned by up to `angle` (rad) about any axis. Neighbours in the list share some of their bones, as
    /// on a body.
    fn new(vertices: usize, angle: f32) -> Self {
        let mut state = 11;
        let mut u = || uniform(&mut state);
        let positions = (0..vertices).map(|_| Vec3::new(u() - 0.5, 1.8 * u(), u() - 0.5)).collect();
        let mut direction = || (Vec3::new(u(), u(), u()) - 0.5).normalize_or(Vec3::Y);
        let normals = (0..vertices).map(|_| direction()).collect();
        let palette = std::array::from_fn(|_| Quat::from_axis_angle(direction(), 1.0));
        let palette = palette.map(|turn: Quat| {
            let (axis, _) = turn.to_axis_angle();
            Affine3A::from_rotation_translation(Quat::from_axis_angle(axis, angle * u()), axis * (2.0 * u() - 1.0))
        });
        let weights = (0..vertices)
            .map(|v| {
                let first = (v / 40 * 7 + (u() * 3.0) as usize) % (BONES - 2 * N);
                let mut w: [f32; N] = std::array::from_fn(|i| if i <= v % N { 0.05 + u() } else { 0.0 });
                let sum: f32 = w.iter().sum();
                w = w.map(|x| x / sum);
                Influences { bones: std::array::from_fn(|i| (first + 2 * i) as u8), weights: w }
            })
            .collect();
        Self { positions, normals, weights, palette }
    }

    fn job(&self) -> SkinningJob {
        SkinningJob::new(&self.positions, &self.normals, &self.weights).unwrap()
    }
}

fn widths() -> impl Iterator<Item = Width> {
    Width::ALL.into_iter().filter(|w| w.available())
}

fn posed(job: &SkinningJob, blend: Blend, palette: &[Affine3A; BONES]) -> Posed {
    let mut posed = job.posed();
    job.run(blend, palette, &mut posed);
    posed
}

/// The same of a surface in the order of the mesh.
fn mesh_bits(mesh: &PosedMesh) -> Vec<u32> {
    mesh.vertices().iter().flat_map(|v| v.position.into_iter().chain(v.normal)).map(f32::to_bits).collect()
}

/// All numbers of a surface, by their bits.
fn bits(posed: &Posed) -> Vec<u32> {
    let numbers = |v: usize| [posed.position(v), posed.normal(v)].map(|v| v.to_array());
    (0..posed.vertices()).flat_map(numbers).flatten().map(f32::to_bits).collect()
}

#[test]
fn every_width_and_both_workers_give_the_same_bits() {
    fn check<const N: usize>() {
        let crowd = Crowd::<N>::new(2_003, 1.0);
        for blend in Blend::ALL {
            let mut job = SkinningJob { width: Width::One, ..crowd.job() };
            let truth = bits(&posed(&job, blend, &crowd.palette));
            for width in widths() {
                job.width = width;
                assert_eq!(bits(&posed(&job, blend, &crowd.palette)), truth, "{N} influences, {blend}, {width} lanes");
                for workers in [1, 2] {
                    let mut pool = WorkerPool::new(workers).unwrap();
                    let mut shared = job.posed();
                    assert!(job.run_with(&mut pool, blend, &crowd.palette, &mut shared));
                    assert_eq!(bits(&shared), truth, "{N} influences, {blend}, {width} lanes, {workers} workers");
                    let mut mesh = job.posed_mesh();
                    assert!(job.run_mesh_with(&mut pool, blend, &crowd.palette, &mut mesh));
                    assert_eq!(mesh_bits(&mesh), truth, "{N} influences, {blend}, {width} lanes, {workers} workers");
                }
            }
        }
    }
    check::<1>();
    check::<4>();
    check::<8>();
}

#[test]
fn what_is_read_is_in_the_order_of_the_mesh() {
    let crowd = Crowd::<4>::new(333, 1.0);
    let rest = crowd.job().posed();
    let (mut p, mut n) = (vec![Vec3::ZERO; 333], vec![Vec3::ZERO; 333]);
    rest.read(&mut p, &mut n);
    assert_eq!(p, crowd.positions);
    for (v, normal) in n.into_iter().enumerate() {
        assert!(normal.distance(crowd.normals[v]) < 1e-6);
        assert_eq!((rest.position(v), rest.normal(v)), (p[v], normal));
    }
}

#[test]
fn bad_skins_are_refused_with_the_vertex() {
    let Crowd { positions, normals, weights, .. } = Crowd::<4>::new(8, 1.0);
    let with = |vertex: usize, bad: SkinWeights| {
        let mut weights = weights.clone();
        weights[vertex] = bad;
        SkinningJob::new(&positions, &normals, &weights).err()
    };
    let one = |w: f32| SkinWeights { bones: [1, 200, 0, 0], weights: [w, 0.0, 0.0, 0.0] };
    assert_eq!(with(5, one(1.0)), None, "a bone without weight is not looked at");
    assert_eq!(with(5, one(0.5)), Some(SkinError::BadSum { vertex: 5, sum: 0.5 }));
    assert_eq!(with(3, SkinWeights::default()), Some(SkinError::BadSum { vertex: 3, sum: 0.0 }));
    assert!(matches!(with(5, one(f32::NAN)), Some(SkinError::BadWeight { vertex: 5, bone: 1, .. })));
    assert!(matches!(with(5, one(f32::INFINITY)), Some(SkinError::BadWeight { vertex: 5, bone: 1, .. })));
    let negative = SkinWeights { bones: [0, 3, 0, 0], weights: [1.5, -0.5, 0.0, 0.0] };
    assert_eq!(with(2, negative), Some(SkinError::BadWeight { vertex: 2, bone: 3, weight: -0.5 }));
    let stray = SkinWeights { bones: [BONES as u8, 0, 0, 0], weights: [1.0, 0.0, 0.0, 0.0] };
    assert_eq!(with(7, stray), Some(SkinError::NoSuchBone { vertex: 7, bone: BONES as u8 }));
    let short = SkinningJob::new(&positions[1..], &normals, &weights).err();
    assert_eq!(short, Some(SkinError::Lengths { positions: 7, normals: 8, weights: 8 }));
    let mut torn = positions.clone();
    torn[3].y = f32::INFINITY;
    assert_eq!(SkinningJob::new(&torn, &normals, &weights).err(), Some(SkinError::NotFinite(3)));
    let nine = [Influences::<9>::default(); 8];
    assert_eq!(SkinningJob::new(&positions, &normals, &nine).err(), Some(SkinError::TooManyInfluences(9)));
    let message = SkinError::BadSum { vertex: 5, sum: 0.5 }.to_string();
    assert_eq!(message, "skin vertex 5 has weights that sum to 0.5; divide them by their sum, which must be 1");
}

#[test]
fn a_collapsed_normal_is_zero_and_an_empty_skin_does_nothing() {
    let weights = [SkinWeights { bones: [0, 1, 0, 0], weights: [0.5, 0.5, 0.0, 0.0] }];
    let mut palette = [Affine3A::IDENTITY; BONES];
    palette[1].matrix3 = -palette[1].matrix3;
    let job = SkinningJob::new(&[Vec3::X], &[Vec3::X], &weights).unwrap();
    assert_eq!(posed(&job, Blend::Linear, &palette).normal(0), Vec3::ZERO);
    // Half a turn either way: the two quaternions cancel, and what is shown is finite.
    palette[1] = Affine3A::from_rotation_y(std::f32::consts::PI);
    palette[0] = Affine3A::from_rotation_y(-std::f32::consts::PI);
    assert!(posed(&job, Blend::Dual, &palette).position(0).is_finite());
    let none: [SkinWeights; 0] = [];
    let empty = SkinningJob::new(&[], &[], &none).unwrap();
    assert_eq!(posed(&empty, Blend::Dual, &palette).vertices(), 0);
    assert_eq!(empty.padding().share(), 0.0);
}
