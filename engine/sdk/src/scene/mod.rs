//! Scenes in motion: a dressed body, or cloth and colliders of a scene file.
//!
//! Dressing takes a second and more, a step at most 8.3 ms, a picture a second. A scene may be sent to another thread.

mod cloth;
mod dressed;
mod options;
mod vertex_order;
mod worn;

use std::fmt::Write;
use std::path::Path;

use glam::Vec3;
use toile_assets::scene_file::{SceneFile, SceneSource};
use toile_base::frame::Joints;
use toile_base::limits::STEP_HZ;
use toile_base::mesh::vertex_normals;

use crate::body::Body;
use crate::error::{Error, Result};
use crate::garment::Garment;
use crate::picture::{Look, Picture, View};
use cloth::ClothScene;
use dressed::DressedScene;
use worn::no_body;

pub use options::{DressOptions, Motion};
pub use worn::{GarmentStats, WornGarment};

/// Length of a step of a dressed body (s). Said here once: a scene file may have another, so ask [`Scene::time_step`] for a
/// scene's own.
pub const TIME_STEP: f64 = 1.0 / STEP_HZ as f64;

/// A scene in motion. Garments are numbered from 0, inner first; lengths are metres, y is up.
#[derive(Debug)]
pub struct Scene {
    kind: SceneKind,
}

#[derive(Debug)]
enum SceneKind {
    Dressed(Box<DressedScene>),
    Cloth(Box<ClothScene>),
}

/// Everything that a display needs of one moment, copied.
#[derive(Debug, Clone, PartialEq)]
pub struct Snapshot {
    /// Steps taken.
    pub step: u64,
    /// Time reached (s).
    pub time_s: f64,
    /// Vertices of each garment in the caller's order (m).
    pub garments: Vec<Vec<Vec3>>,
    /// Vertices of the body (m); empty in a scene file.
    pub body: Vec<Vec3>,
    /// Unit normals of the body.
    pub body_normals: Vec<Vec3>,
}

impl Scene {
    /// Puts garments on a body that stands, inner first, each in the size that was asked for or the one that fits, and lets them
    /// settle.
    ///
    /// # Errors
    /// More garments than a body wears; a garment that cannot be laid on this body.
    pub fn dress(body: &Body, garments: &[Garment]) -> Result<Self> {
        Self::dress_with(body, garments, &DressOptions::default())
    }

    /// The same with a motion, quality, workers, wind and what is tucked in.
    ///
    /// # Errors
    /// As [`Self::dress`]; joints that give no pose, options that cannot be had.
    pub fn dress_with(body: &Body, garments: &[Garment], options: &DressOptions) -> Result<Self> {
        let dressed = DressedScene::dress(body, garments, options)?;
        Ok(Self { kind: SceneKind::Dressed(Box::new(dressed)) })
    }

    /// Reads a scene file, with the files beside it that it names, and honours all that it says (docs/scene.md).
    ///
    /// # Errors
    /// What in the file cannot be used: file, line, key and cure. No key is passed over.
    pub fn open(path: impl AsRef<Path>) -> Result<Self> {
        Self::of(ClothScene::new(SceneFile::read(path.as_ref()).map_err(Error::input)?)?)
    }

    /// The same of a text; the files that it names are given along, by the names that it has for them, and no other is read.
    /// `name` is what messages call the text.
    ///
    /// # Errors
    /// As [`Self::open`].
    pub fn parse(name: &str, text: &str, files: &[(String, Vec<u8>)]) -> Result<Self> {
        Self::of(ClothScene::parse(name, text, SceneSource::Memory(files))?)
    }

    /// A piece of cloth of the caller's own triangles (m) in a built-in fabric, held at the vertices `pins`, which stay at exactly
    /// these positions. For wind, colliders and moving pins write a scene file.
    ///
    /// # Errors
    /// A mesh that cannot be cloth, a pin that is no vertex, an unknown fabric.
    pub fn of_mesh(positions: &[Vec3], triangles: &[[u32; 3]], pins: &[u32], fabric: &str) -> Result<Self> {
        let mut obj = String::new();
        for p in positions {
            // The shortest decimals that read back as the same number.
            _ = writeln!(obj, "v {} {} {}", p.x, p.y, p.z);
        }
        if let Some(at) = triangles.iter().position(|t| t.iter().any(|v| *v as usize >= positions.len())) {
            let count = positions.len();
            return Err(Error::input(format!(
                "triangle {at} has a vertex that there is not: {count} are given, and they are counted from 0"
            )));
        }
        for [a, b, c] in triangles.iter().map(|t| t.map(|v| u64::from(v) + 1)) {
            _ = writeln!(obj, "f {a} {b} {c}");
        }
        let mut text =
            format!("duration = 36000\n[garment]\nname = \"cloth\"\nmesh = \"cloth.obj\"\nfabric = {fabric:?}\n");
        if !pins.is_empty() {
            _ = writeln!(text, "pin = {{ vertices = {pins:?} }}");
        }
        Self::parse("cloth", &text, &[("cloth.obj".to_owned(), obj.into_bytes())])
    }

    fn of(scene: ClothScene) -> Result<Self> {
        Ok(Self { kind: SceneKind::Cloth(Box::new(scene)) })
    }

    /// One step of [`Self::time_step`]. A body that follows a track goes on as in its last frame once that has ended.
    pub fn step(&mut self) {
        match &mut self.kind {
            SceneKind::Dressed(scene) => scene.step(),
            SceneKind::Cloth(scene) => scene.step(),
        }
    }

    /// So many steps.
    pub fn step_many(&mut self, steps: u64) {
        (0..steps).for_each(|_| self.step());
    }

    /// One step of a dressed body to joints of the caller's own, those at the step's end (m); it stays there until moved on.
    ///
    /// # Errors
    /// Joints that give no pose; a scene without a body, or whose body follows a track.
    pub fn step_to(&mut self, joints: &Joints) -> Result<()> {
        match &mut self.kind {
            SceneKind::Dressed(scene) => scene.step_to(joints),
            SceneKind::Cloth(_) => Err(no_body("body to move")),
        }
    }

    /// Steps taken so far.
    pub fn steps(&self) -> u64 {
        match &self.kind {
            SceneKind::Dressed(scene) => scene.steps(),
            SceneKind::Cloth(scene) => scene.steps(),
        }
    }

    /// Steps from beginning to end: of the track that is followed, or of the scene file's duration; none of a body that stands.
    pub fn duration_steps(&self) -> Option<u64> {
        match &self.kind {
            SceneKind::Dressed(scene) => scene.wanted(),
            SceneKind::Cloth(scene) => Some(scene.wanted()),
        }
    }

    /// Length of a step (s): [`TIME_STEP`], or as a scene file says.
    pub fn time_step(&self) -> f64 {
        match &self.kind {
            SceneKind::Dressed(_) => TIME_STEP,
            SceneKind::Cloth(scene) => scene.time_step(),
        }
    }

    /// Time reached (s).
    pub fn time(&self) -> f64 {
        match &self.kind {
            SceneKind::Dressed(scene) => scene.steps() as f64 / f64::from(STEP_HZ),
            SceneKind::Cloth(scene) => scene.time(),
        }
    }

    /// The garments, inner first.
    pub fn garments(&self) -> &[WornGarment] {
        match &self.kind {
            SceneKind::Dressed(scene) => scene.worn(),
            SceneKind::Cloth(scene) => scene.worn(),
        }
    }

    /// Where the vertices of a garment are (m), in the order of the caller's own mesh; of a garment that was drafted, in the order
    /// of its draft. Vertices that a mesh's repair joined or took away are where the nearest is that is left, and those without
    /// a face stand. Always finite.
    ///
    /// # Errors
    /// A garment's number out of range.
    pub fn positions(&self, garment: usize) -> Result<Vec<Vec3>> {
        let mut positions = vec![Vec3::ZERO; self.known(garment)?.vertices];
        self.read_positions(garment, &mut positions)?;
        Ok(positions)
    }

    /// The same into the caller's own storage; nothing is allocated.
    ///
    /// # Errors
    /// As [`Self::positions`]; storage of another length.
    pub fn read_positions(&self, garment: usize, positions: &mut [Vec3]) -> Result<()> {
        let vertices = self.known(garment)?.vertices;
        if positions.len() != vertices {
            let given = positions.len();
            return Err(Error::usage(format!(
                "garment {garment} has {vertices} vertices; give room for as many, not {given}"
            )));
        }
        match &self.kind {
            SceneKind::Dressed(scene) => fill(positions, scene.positions(garment)),
            SceneKind::Cloth(scene) => fill(positions, scene.positions(garment)),
        }
        Ok(())
    }

    /// Unit normals of a garment's vertices; zero where a vertex has no face.
    ///
    /// # Errors
    /// As [`Self::positions`].
    pub fn normals(&self, garment: usize) -> Result<Vec<Vec3>> {
        let positions = self.positions(garment)?;
        let mut normals = vec![Vec3::ZERO; positions.len()];
        vertex_normals(&positions, self.faces(garment)?, &mut normals);
        Ok(normals)
    }

    /// Triangles of a garment, by the vertices of [`Self::positions`]; quads are split. They never change.
    ///
    /// # Errors
    /// As [`Self::positions`].
    pub fn faces(&self, garment: usize) -> Result<&[[u32; 3]]> {
        self.known(garment)?;
        Ok(match &self.kind {
            SceneKind::Dressed(scene) => &scene.order(garment).triangles,
            SceneKind::Cloth(scene) => scene.triangles(garment),
        })
    }

    /// The vertices of a garment that are held: by pins, by the body where it is worn close, or without a face.
    ///
    /// # Errors
    /// As [`Self::positions`].
    pub fn pinned(&self, garment: usize) -> Result<Vec<u32>> {
        self.known(garment)?;
        let held: Vec<bool> = match &self.kind {
            SceneKind::Dressed(scene) => scene.pinned(garment).collect(),
            SceneKind::Cloth(scene) => scene.pinned(garment).collect(),
        };
        Ok((0..).zip(held).filter(|(_, held)| *held).map(|(vertex, _)| vertex).collect())
    }

    /// How a garment does at the moment: stretch, penetration. Allocates; not for every frame of a display.
    ///
    /// # Errors
    /// As [`Self::positions`].
    pub fn stats(&self, garment: usize) -> Result<GarmentStats> {
        self.known(garment)?;
        Ok(match &self.kind {
            SceneKind::Dressed(scene) => scene.stats(garment),
            SceneKind::Cloth(scene) => scene.stats(garment),
        })
    }

    /// Vertices of the body as it stands now (m), in the order of [`Body::positions`], and their unit normals.
    ///
    /// # Errors
    /// A scene without a body.
    pub fn body(&mut self) -> Result<(Vec<Vec3>, Vec<Vec3>)> {
        match &mut self.kind {
            SceneKind::Dressed(scene) => Ok(scene.skin()),
            SceneKind::Cloth(_) => Err(no_body("body to show")),
        }
    }

    /// Triangles of the body.
    ///
    /// # Errors
    /// A scene without a body.
    pub fn body_faces(&self) -> Result<&[[u32; 3]]> {
        match &self.kind {
            SceneKind::Dressed(scene) => Ok(&scene.body().mesh.triangles),
            SceneKind::Cloth(_) => Err(no_body("body to show")),
        }
    }

    /// Everything that a display needs of this moment.
    pub fn snapshot(&mut self) -> Snapshot {
        let garments = (0..self.garments().len()).map(|garment| match &self.kind {
            SceneKind::Dressed(scene) => scene.positions(garment).collect(),
            SceneKind::Cloth(scene) => scene.positions(garment).collect(),
        });
        let garments = garments.collect();
        let (step, time_s) = (self.steps(), self.time());
        let (body, body_normals) = match &mut self.kind {
            SceneKind::Dressed(scene) => scene.skin(),
            SceneKind::Cloth(_) => (Vec::new(), Vec::new()),
        };
        Snapshot { step, time_s, garments, body, body_normals }
    }

    /// How tight a garment sits at each vertex, -1 (loose) .. 1 (tight), in the mean of each zone as tight as its size was judged;
    /// [`fit_colour`](crate::fit_colour) gives the colours. NaN where a vertex has no face.
    ///
    /// # Errors
    /// As [`Self::positions`]; a scene without a body.
    pub fn fit_map(&self, garment: usize) -> Result<Vec<f32>> {
        self.known(garment)?;
        match &self.kind {
            SceneKind::Dressed(scene) => Ok(scene.fit_map(garment)),
            SceneKind::Cloth(_) => Err(no_body("fit map")),
        }
    }

    /// Pictures of this moment by the ray tracer, of `[width, height]` pixels each; it takes every core.
    ///
    /// # Errors
    /// A size that no picture has; a fit map of a scene without a body.
    pub fn pictures(&mut self, views: &[View], size: [u32; 2], look: Look) -> Result<Vec<Picture>> {
        match &mut self.kind {
            SceneKind::Dressed(scene) => scene.pictures(views, size, look),
            SceneKind::Cloth(scene) => scene.pictures(views, size, look),
        }
    }

    /// A hash of the whole state: the same input gives the same one on every run of a build, with one worker or two.
    pub fn state_hash(&self) -> u64 {
        match &self.kind {
            SceneKind::Dressed(scene) => scene.state_hash(),
            SceneKind::Cloth(scene) => scene.state_hash(),
        }
    }

    /// What the steps so far had to repair or leave out, a sentence each.
    pub fn warnings(&self) -> Vec<String> {
        match &self.kind {
            SceneKind::Dressed(scene) => scene.warnings(),
            SceneKind::Cloth(scene) => scene.warnings(),
        }
    }

    fn known(&self, garment: usize) -> Result<&WornGarment> {
        let all = self.garments();
        all.get(garment).ok_or_else(|| {
            let count = all.len();
            Error::usage(format!("there is no garment {garment}: the scene has {count}, counted from 0"))
        })
    }
}

fn fill(to: &mut [Vec3], from: impl Iterator<Item = Vec3>) {
    to.iter_mut().zip(from).for_each(|(to, from)| *to = from);
}
