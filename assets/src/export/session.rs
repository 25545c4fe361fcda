//! A session exported: what moves is written frame by frame to the files of every format asked for.

use std::fs::File;
use std::io::{self, BufWriter, Write};

use glam::{Affine3A, Vec3};

use super::frame_rate::FrameRate;
use super::moving_glb::{self, MAX_GLB_FRAMES, MovingGlb};
use super::obj;
use super::part::MovingPart;
use super::ply::ply;
use super::point_cache::{CacheFormat, PointCache};
use super::surface::png;
use super::usda::{self, UsdMesh, stage};
use toile_base::skeleton::BONES;

toile_base::named! {
    /// A format of moving surfaces.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
    pub enum ExportFormat {
        /// One animated GLB: the body by its skeleton, garments by morph targets.
        Glb = "glb",
        /// USD as text: a file a surface, and one that shows them all.
        Usd = "usd",
        /// MDD point caches, each beside an OBJ.
        Mdd = "mdd",
        /// PC2 point caches, each beside an OBJ.
        Pc2 = "pc2",
        /// A PLY for each surface in each frame.
        Ply = "ply",
    }
}

/// Most PLY files of a session: beyond it a folder is slow to list.
const MAX_PLY_FILES: usize = 1_000_000;

/// What is to be written.
#[derive(Debug)]
pub struct ExportPlan {
    name: String,
    formats: Vec<ExportFormat>,
    parts: Vec<MovingPart>,
    rate: FrameRate,
}

/// Why an export stopped.
#[derive(Debug, thiserror::Error)]
#[error("{file}: {reason}")]
pub struct ExportError {
    /// Name of the file that was being written.
    pub file: String,
    /// The system's message.
    pub reason: io::Error,
}

/// One frame: what each surface is like in it.
#[derive(Debug, Clone, Copy)]
pub struct ExportFrame<'a> {
    /// Skin matrices of the body (rest to world, rigid), where there is one.
    pub palette: Option<&'a [Affine3A; BONES]>,
    /// Positions (m) `[parts][vertices]`, a body's as the engine skins it.
    pub positions: &'a [&'a [Vec3]],
}

/// Makes a file of a plain name to be written to.
pub type OpenFile = Box<dyn FnMut(&str) -> io::Result<File>>;

impl ExportPlan {
    /// A plan for files whose names begin with `name`. A body may be the first of the parts, and no other. Parts of the same
    /// name, and of names that no file has, get other ones.
    ///
    /// # Errors
    /// A sentence that says what is too much for a format, and the cure.
    pub fn new(name: &str, formats: &[ExportFormat], parts: Vec<MovingPart>, rate: FrameRate) -> Result<Self, String> {
        let formats: Vec<ExportFormat> = ExportFormat::ALL.into_iter().filter(|f| formats.contains(f)).collect();
        let frames = rate.frames;
        let cure = "write fewer frames a second, or another format";
        if formats.contains(&ExportFormat::Glb) {
            if frames > MAX_GLB_FRAMES {
                return Err(format!("a GLB file holds {MAX_GLB_FRAMES} frames, and this has {frames}; {cure}"));
            }
            moving_glb::fits(&parts, rate).map_err(|e| format!("{e}; {cure}"))?;
        }
        if formats.contains(&ExportFormat::Ply) && frames * parts.len() > MAX_PLY_FILES {
            return Err(format!("that is {} PLY files, more than {MAX_PLY_FILES}; {cure}", frames * parts.len()));
        }
        let mut plan = Self { name: file_word(name), formats, parts, rate };
        plan.tell_apart();
        Ok(plan)
    }

    /// Gives every part a name of its own, as files and USD may have it.
    fn tell_apart(&mut self) {
        let mut taken: Vec<String> = Vec::new();
        for part in &mut self.parts {
            let plain = file_word(&part.name);
            let mut word = plain.clone();
            let mut k = 1;
            while taken.iter().any(|t| usda::identifier(t) == usda::identifier(&word)) {
                k += 1;
                word = format!("{plain}-{k}");
            }
            taken.push(word.clone());
            part.name = word;
        }
    }

    fn has(&self, format: ExportFormat) -> bool {
        self.formats.contains(&format)
    }

    /// A file of a part.
    fn file(&self, part: &MovingPart, ending: &str) -> String {
        format!("{}-{}.{ending}", self.name, part.name)
    }

    /// The file of a part's picture, where it has one that is not inside another file.
    fn picture(&self, part: &MovingPart) -> Option<String> {
        let beside = self.has(ExportFormat::Usd) || self.has_caches();
        part.look.picture.as_ref().filter(|_| beside).map(|_| self.file(part, "png"))
    }

    fn has_caches(&self) -> bool {
        self.has(ExportFormat::Mdd) || self.has(ExportFormat::Pc2)
    }

    fn ply(&self, part: &MovingPart, frame: usize) -> String {
        format!("{}-{}-{frame:06}.ply", self.name, part.name)
    }

    /// The names of all files that it writes.
    pub fn files(&self) -> Vec<String> {
        let mut files = Vec::new();
        if self.has(ExportFormat::Glb) {
            files.push(format!("{}.glb", self.name));
        }
        if self.has(ExportFormat::Usd) {
            files.push(format!("{}.usda", self.name));
        }
        for part in &self.parts {
            files.extend(self.picture(part));
            files.extend(self.has(ExportFormat::Usd).then(|| self.file(part, "usda")));
            let still = ["obj", "mtl"].into_iter().filter(|_| self.has_caches());
            files.extend(still.map(|ending| self.file(part, ending)));
            files.extend(self.caches().map(|(_, ending)| self.file(part, ending)));
            let plys = if self.has(ExportFormat::Ply) { self.rate.frames } else { 0 };
            files.extend((0..plys).map(|frame| self.ply(part, frame)));
        }
        files
    }

    fn caches(&self) -> impl Iterator<Item = (CacheFormat, &'static str)> + '_ {
        let all = [(ExportFormat::Mdd, CacheFormat::Mdd, "mdd"), (ExportFormat::Pc2, CacheFormat::Pc2, "pc2")];
        all.into_iter().filter(|(format, ..)| self.has(*format)).map(|(_, cache, ending)| (cache, ending))
    }

    /// Opens the files.
    ///
    /// # Errors
    /// A file that cannot be written.
    pub fn begin(self, mut open: OpenFile) -> Result<SessionExport, ExportError> {
        let (mut glb, mut meshes, mut caches) = (None, Vec::new(), Vec::new());
        if self.has(ExportFormat::Glb) {
            let file = format!("{}.glb", self.name);
            let writer = create(&mut open, &file)?;
            let begun = MovingGlb::begin(writer, &self.name, &self.parts, self.rate);
            glb = Some((begun.map_err(|e| failed(&file, e))?, file));
        }
        if self.has(ExportFormat::Usd) {
            let all: Vec<(String, String)> =
                self.parts.iter().map(|p| (usda::identifier(&p.name), self.file(p, "usda"))).collect();
            whole(&mut open, &format!("{}.usda", self.name), stage(&self.name, &all, self.rate).as_bytes())?;
        }
        for part in &self.parts {
            if let (Some(file), Some(picture)) = (self.picture(part), &part.look.picture) {
                whole(&mut open, &file, &png(picture))?;
            }
            if self.has(ExportFormat::Usd) {
                let file = self.file(part, "usda");
                let begun = UsdMesh::begin(create(&mut open, &file)?, part, self.picture(part).as_deref(), self.rate);
                meshes.push((begun.map_err(|e| failed(&file, e))?, file));
            }
            let mut of_part = Vec::new();
            for (format, ending) in self.caches() {
                let file = self.file(part, ending);
                let begun = PointCache::begin(create(&mut open, &file)?, format, part.vertices, self.rate);
                of_part.push((begun.map_err(|e| failed(&file, e))?, file));
            }
            caches.push(of_part);
        }
        Ok(SessionExport { plan: self, open, glb, meshes, caches, added: 0 })
    }
}

/// A name as a part of a file's name: letters, digits, `-`, `_`.
fn file_word(name: &str) -> String {
    let plain = |c: char| if c.is_alphanumeric() || c == '_' { c } else { '-' };
    let word: String = name.chars().map(plain).collect();
    if word.is_empty() { "part".into() } else { word }
}

fn failed(file: &str, reason: io::Error) -> ExportError {
    ExportError { file: file.to_owned(), reason }
}

fn create(open: &mut OpenFile, file: &str) -> Result<BufWriter<File>, ExportError> {
    open(file).map(BufWriter::new).map_err(|e| failed(file, e))
}

fn whole(open: &mut OpenFile, file: &str, bytes: &[u8]) -> Result<(), ExportError> {
    let written = open(file).and_then(|mut f| f.write_all(bytes));
    written.map_err(|e| failed(file, e))
}

/// A writer and the name of its file.
type Named<T> = (T, String);

/// Files being written.
pub struct SessionExport {
    plan: ExportPlan,
    open: OpenFile,
    glb: Option<Named<MovingGlb<BufWriter<File>>>>,
    meshes: Vec<Named<UsdMesh<BufWriter<File>>>>,
    /// Of each part.
    caches: Vec<Vec<Named<PointCache<BufWriter<File>>>>>,
    added: usize,
}

impl std::fmt::Debug for SessionExport {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "SessionExport({:?}, {} frames)", self.plan, self.added)
    }
}

impl SessionExport {
    /// Writes the next frame.
    ///
    /// # Errors
    /// A file that cannot be written.
    pub fn add(&mut self, frame: &ExportFrame<'_>) -> Result<(), ExportError> {
        let Self { plan, open, glb, meshes, caches, added } = self;
        if let Some((glb, file)) = glb {
            glb.add(frame.palette, frame.positions).map_err(|e| failed(file, e))?;
        }
        for ((mesh, file), positions) in meshes.iter_mut().zip(frame.positions) {
            mesh.add(positions).map_err(|e| failed(file, e))?;
        }
        for (of_part, positions) in caches.iter_mut().zip(frame.positions) {
            of_part.iter_mut().try_for_each(|(cache, file)| cache.add(positions).map_err(|e| failed(file, e)))?;
        }
        for (part, positions) in plan.parts.iter().zip(frame.positions) {
            if *added == 0 && plan.has_caches() {
                let mtl = plan.file(part, "mtl");
                whole(open, &plan.file(part, "obj"), obj::obj(part, positions, &mtl).as_bytes())?;
                whole(open, &mtl, obj::mtl(part, plan.picture(part).as_deref()).as_bytes())?;
            }
            if plan.has(ExportFormat::Ply) {
                let faces = part.faces.iter().map(MovingPart::corners);
                whole(open, &plan.ply(part, *added), &ply(positions, faces))?;
            }
        }
        *added += 1;
        Ok(())
    }

    /// Frames so far.
    pub fn frames(&self) -> usize {
        self.added
    }

    /// Ends all files.
    ///
    /// # Errors
    /// A file that cannot be written, and frames that are missing.
    pub fn finish(self) -> Result<(), ExportError> {
        if let Some((glb, file)) = self.glb {
            glb.finish().map_err(|e| failed(&file, e))?;
        }
        for (mesh, file) in self.meshes {
            mesh.finish().map_err(|e| failed(&file, e))?;
        }
        for (cache, file) in self.caches.into_iter().flatten() {
            cache.finish().map_err(|e| failed(&file, e))?;
        }
        Ok(())
    }
}
