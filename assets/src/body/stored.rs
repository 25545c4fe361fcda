//! The drawn bodies as they are stored: `data/body/base.bin`, written by `toile-sculpt`.
//!
//! Little endian. Magic `TOILEBDY`, version, counts of vertices, quads and texture points (u32 each); positions of the
//! woman, then the man (3 f32 a vertex, m); rest joints of both (3 f32 a joint, m); quads (4 u16), texture corners (4 u16
//! a quad), chart (u8 a quad), part of the body (u8 a vertex), mirror image (u16 a vertex), texture points (2 u16, shares
//! of 65,535); last the FNV-1a hash of all that (u64).

use glam::{Vec2, Vec3};

use toile_base::body::{Region, Sex};
use toile_base::numeric::hash;
use toile_base::skeleton::{JOINTS, Skeleton};

const MAGIC: &[u8; 8] = b"TOILEBDY";
const VERSION: u32 = 1;

/// Both bodies: what they share, and what each has of its own.
#[derive(Debug, Clone, PartialEq)]
pub struct StoredBodies {
    /// Surface points (m) of the woman and the man `[vertices]`.
    pub positions: [Vec<Vec3>; 2],
    /// Joint centres of both.
    pub skeletons: [Skeleton; 2],
    /// Faces, counter-clockwise from outside `[quads]`.
    pub quads: Vec<[u32; 4]>,
    /// Texture points, 0 to 1, v upwards `[texture points]`.
    pub uvs: Vec<Vec2>,
    /// Texture point of each corner of each face `[quads]`.
    pub corners: Vec<[u32; 4]>,
    /// Piece of the atlas of each face, by number `[quads]`.
    pub charts: Vec<u8>,
    /// Part of the body `[vertices]`.
    pub regions: Vec<Region>,
    /// Mirror image of each vertex `[vertices]`.
    pub mirrors: Vec<u32>,
}

/// Why stored bodies cannot be read.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
pub enum StoredError {
    /// Other bytes, another version, or cut short.
    #[error(
        "the stored bodies are not a file of version {VERSION} in full: write it again with `cargo run --release -p toile-sculpt`"
    )]
    Format,
    /// The hash does not agree.
    #[error(
        "the stored bodies are damaged, their hash does not agree: write the file again with `cargo run --release -p toile-sculpt`"
    )]
    Damaged,
}

const REGIONS: [Region; 6] =
    [Region::Torso, Region::Head, Region::LeftArm, Region::RightArm, Region::LeftLeg, Region::RightLeg];

impl StoredBodies {
    /// Which of the two a sex's is.
    pub fn index(sex: Sex) -> usize {
        usize::from(sex == Sex::Male)
    }

    /// The body as the bytes of its file.
    pub fn encode(&self) -> Vec<u8> {
        let mut out = Vec::new();
        out.extend(MAGIC);
        for count in [VERSION, self.regions.len() as u32, self.quads.len() as u32, self.uvs.len() as u32] {
            out.extend(count.to_le_bytes());
        }
        let points = self.positions.iter().flatten().chain(self.skeletons.iter().flat_map(|s| &s.rest));
        points.for_each(|p| p.to_array().iter().for_each(|x| out.extend(x.to_le_bytes())));
        let small = |x: u32| (x as u16).to_le_bytes();
        for &v in self.quads.iter().chain(&self.corners).flatten() {
            out.extend(small(v));
        }
        out.extend(&self.charts);
        out.extend(self.regions.iter().map(|r| REGIONS.iter().position(|o| o == r).expect("a known part") as u8));
        self.mirrors.iter().for_each(|&v| out.extend(small(v)));
        for uv in &self.uvs {
            [uv.x, uv.y].iter().for_each(|x| out.extend(small((x * 65_535.0).round() as u32)));
        }
        let hash = hash::of_bytes(&out);
        out.extend(hash.to_le_bytes());
        out
    }

    /// Reads the file's bytes.
    pub fn decode(bytes: &[u8]) -> Result<Self, StoredError> {
        let (body, hash) = bytes.split_last_chunk::<8>().ok_or(StoredError::Format)?;
        if !body.starts_with(MAGIC) {
            return Err(StoredError::Format);
        }
        if hash::of_bytes(body) != u64::from_le_bytes(*hash) {
            return Err(StoredError::Damaged);
        }
        ByteReader(&body[8..]).stored().ok_or(StoredError::Format)
    }
}

/// Bytes still to be read.
struct ByteReader<'a>(&'a [u8]);

impl ByteReader<'_> {
    fn take<const N: usize>(&mut self) -> Option<[u8; N]> {
        let (head, tail) = self.0.split_first_chunk::<N>()?;
        self.0 = tail;
        Some(*head)
    }

    fn many<T>(&mut self, count: usize, mut one: impl FnMut(&mut Self) -> Option<T>) -> Option<Vec<T>> {
        (0..count).map(|_| one(self)).collect()
    }

    fn count(&mut self) -> Option<usize> {
        self.take().map(|b| u32::from_le_bytes(b) as usize)
    }

    fn small(&mut self) -> Option<u32> {
        self.take().map(|b| u32::from(u16::from_le_bytes(b)))
    }

    fn index(&mut self, below: usize) -> Option<u32> {
        self.small().filter(|&v| (v as usize) < below)
    }

    fn quad(&mut self, below: usize) -> Option<[u32; 4]> {
        Some([self.index(below)?, self.index(below)?, self.index(below)?, self.index(below)?])
    }

    fn point(&mut self) -> Option<Vec3> {
        let mut next = || self.take().map(f32::from_le_bytes);
        Some(Vec3::new(next()?, next()?, next()?))
    }

    fn skeleton(&mut self) -> Option<Skeleton> {
        let joints = self.many(JOINTS, Self::point)?;
        Some(Skeleton { rest: joints.try_into().ok()? })
    }

    fn stored(&mut self) -> Option<StoredBodies> {
        if self.count()? != VERSION as usize {
            return None;
        }
        let [vertices, quads, points] = [self.count()?, self.count()?, self.count()?];
        let positions = [self.many(vertices, Self::point)?, self.many(vertices, Self::point)?];
        let skeletons = [self.skeleton()?, self.skeleton()?];
        let faces = self.many(quads, |r| r.quad(vertices))?;
        let corners = self.many(quads, |r| r.quad(points))?;
        let charts = self.many(quads, |r| r.take::<1>().map(|b| b[0]))?;
        let regions = self.many(vertices, |r| REGIONS.get(usize::from(r.take::<1>()?[0])).copied())?;
        let mirrors = self.many(vertices, |r| r.index(vertices))?;
        let share = |r: &mut Self| r.small().map(|x| x as f32 / 65_535.0);
        let uvs = self.many(points, |r| Some(Vec2::new(share(r)?, share(r)?)))?;
        self.0.is_empty().then_some(StoredBodies {
            positions,
            skeletons,
            quads: faces,
            uvs,
            corners,
            charts,
            regions,
            mirrors,
        })
    }
}
