//! A garment on a body that moves as it was recorded: a file of plain numbers, written on one platform and played on all.
//!
//! All numbers are little-endian and follow each other: each array begins with its length (u32). First the body: positions,
//! normals, triangles, bones and weights of each vertex, rest places of the joints; then the spheres and capsules of its rig,
//! the baked garment in its byte form, and a pose for each step.

use glam::{Affine3A, Quat, Vec3};
use toile_base::body::{Body, Levels, Measures, Sex};
use toile_base::garment::Garment;
use toile_base::mesh::{Mesh, SkinWeights};
use toile_base::skeleton::{BONES, JOINTS, Pose, Skeleton};
use toile_engine::body::palette;
use toile_engine::body_surface::BodySurface;
use toile_engine::cloth::{Cloth, Settings, Step};
use toile_engine::colliders::{Colliders, RestSphere};
use toile_engine::lanes::Width;
use toile_engine::skin::SkinningJob;
use toile_engine::workers::WorkerPool;
use toile_engine::world::BLEND;

use crate::hash_of;

/// Levels of a body that is never measured.
const NO_LEVELS: Levels = Levels {
    neck: 0.0,
    shoulder: 0.0,
    chest: 0.0,
    underbust: 0.0,
    waist: 0.0,
    hip: 0.0,
    crotch: 0.0,
    knee: 0.0,
    ankle: 0.0,
};

/// A body, its colliders, a garment, and how the body moves.
pub struct DressRecording {
    /// The body; of its measures and levels nothing is stored.
    pub body: Body,
    /// The spheres of its rig in the rest pose.
    pub spheres: Vec<RestSphere>,
    /// The pairs of spheres that span a capsule.
    pub capsules: Vec<[u8; 2]>,
    /// The garment.
    pub garment: Garment,
    /// The body's pose at the end of each step.
    pub poses: Vec<Pose>,
}

/// Writes numbers one after the other.
#[derive(Default)]
struct Numbers(Vec<u8>);

impl Numbers {
    fn whole(&mut self, number: usize) {
        self.0.extend((number as u32).to_le_bytes());
    }

    fn real(&mut self, numbers: &[f32]) {
        numbers.iter().for_each(|number| self.0.extend(number.to_le_bytes()));
    }

    fn places(&mut self, places: &[Vec3]) {
        self.whole(places.len());
        places.iter().for_each(|place| self.real(&place.to_array()));
    }
}

/// Reads them back; `None` where the file ends too early.
struct Source<'a>(&'a [u8]);

impl<'a> Source<'a> {
    fn take(&mut self, bytes: usize) -> Option<&'a [u8]> {
        let (taken, left) = self.0.split_at_checked(bytes)?;
        self.0 = left;
        Some(taken)
    }

    fn whole(&mut self) -> Option<usize> {
        Some(u32::from_le_bytes(self.take(4)?.try_into().ok()?) as usize)
    }

    fn real<const N: usize>(&mut self) -> Option<[f32; N]> {
        let bytes = self.take(4 * N)?;
        Some(std::array::from_fn(|i| f32::from_le_bytes(std::array::from_fn(|k| bytes[4 * i + k]))))
    }

    fn list<T>(&mut self, mut one: impl FnMut(&mut Self) -> Option<T>) -> Option<Vec<T>> {
        (0..self.whole()?).map(|_| one(self)).collect()
    }

    fn place(&mut self) -> Option<Vec3> {
        self.real().map(Vec3::from_array)
    }
}

impl DressRecording {
    /// The file's bytes.
    pub fn to_bytes(&self) -> Vec<u8> {
        let mut out = Numbers::default();
        out.places(&self.body.mesh.positions);
        out.places(&self.body.normals);
        out.whole(self.body.mesh.triangles.len());
        self.body.mesh.triangles.iter().flatten().for_each(|&corner| out.whole(corner as usize));
        out.whole(self.body.weights.len());
        for weights in &self.body.weights {
            out.0.extend(weights.bones);
            out.real(&weights.weights);
        }
        out.places(&self.body.skeleton.rest);
        out.whole(self.spheres.len());
        for sphere in &self.spheres {
            out.whole(sphere.bone.into());
            out.real(&sphere.centre.to_array());
            out.real(&[sphere.radius]);
        }
        out.whole(self.capsules.len());
        self.capsules.iter().for_each(|pair| out.0.extend(pair));
        let garment = self.garment.to_bytes();
        out.whole(garment.len());
        out.0.extend(garment);
        out.whole(self.poses.len());
        for pose in &self.poses {
            out.real(&pose.root.to_array());
            pose.local.iter().for_each(|turn| out.real(&turn.to_array()));
        }
        out.0
    }

    /// Reads a file; `None` if it is not one.
    pub fn from_bytes(bytes: &[u8]) -> Option<Self> {
        let mut from = Source(bytes);
        let positions = from.list(Source::place)?;
        let normals = from.list(Source::place)?;
        let corner = |from: &mut Source<'_>| Some(from.whole()? as u32);
        let triangles = from.list(|from| Some([corner(from)?, corner(from)?, corner(from)?]))?;
        let weights =
            from.list(|from| Some(SkinWeights { bones: from.take(4)?.try_into().ok()?, weights: from.real()? }))?;
        let rest: [Vec3; JOINTS] = from.list(Source::place)?.try_into().ok()?;
        let spheres = from.list(|from| {
            let bone = u8::try_from(from.whole()?).ok()?;
            Some(RestSphere { bone, centre: from.place()?, radius: from.real::<1>()?[0] })
        })?;
        let capsules = from.list(|from| from.take(2)?.try_into().ok())?;
        let garment = from.whole()?;
        let garment = Garment::from_bytes(from.take(garment)?).ok()?;
        let poses = from.list(|from| {
            let root = from.place()?;
            let mut local = [Quat::IDENTITY; JOINTS];
            for turn in &mut local {
                *turn = Quat::from_array(from.real()?);
            }
            Some(Pose { root, local })
        })?;
        let body = Body {
            sex: Sex::Female,
            mesh: Mesh { positions, uvs: Vec::new(), triangles },
            normals,
            skeleton: Skeleton { rest },
            weights,
            regions: Vec::new(),
            levels: NO_LEVELS,
            measures: Measures::average(Sex::Female),
        };
        Some(Self { body, spheres, capsules, garment, poses })
    }

    /// The state hash after all poses, on so many lanes: the body is skinned and its colliders placed, then the cloth steps.
    ///
    /// # Panics
    /// If the body or the garment is none, which no platform may cause.
    pub fn hash(&self, width: Width) -> u64 {
        let Self { body, garment, .. } = self;
        let skinning = SkinningJob::new(&body.mesh.positions, &body.normals, &body.weights).expect("a body's skin");
        let mut skin = skinning.posed();
        let surface = BodySurface::new(body, &skin, &garment.parts);
        let colliders = Colliders::new(&self.spheres, &self.capsules, true).expect("a body's colliders");
        let mut colliders = colliders.with_skin(surface);
        let mut pool = WorkerPool::new(1).expect("one worker is the caller");
        let mut cloth = Cloth::new(garment, &colliders);
        let settings = Settings { width, ..Settings::default() };
        let mut bones = [Affine3A::IDENTITY; BONES];
        for pose in &self.poses {
            palette(&body.skeleton, pose, &mut bones);
            skinning.run_with(&mut pool, BLEND, &bones, &mut skin);
            colliders.place(&bones);
            colliders.place_skin(&skin);
            cloth.step(garment, &Step { palette: &bones, colliders: &colliders, settings: &settings });
        }
        hash_of(&cloth, 0..cloth.positions.len())
    }
}
