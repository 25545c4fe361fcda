//! Scene files: any mesh, fabric, pins, colliders and settings of a user's own, described in TOML.
//!
//! `docs/scene.md` is the reference of the format; [`schema`] is what it is made from.

mod colliders;
mod error;
pub mod examples;
mod garment;
mod pins;
mod primitive;
pub mod schema;
mod source;
mod table;
#[cfg(test)]
mod tests;
mod track;
mod weld;

use std::path::Path;

use glam::Vec3;
use toml::de::DeTable;

pub use colliders::{SceneColliders, ScenePlane};
pub use error::SceneError;
pub use garment::{SceneGarment, UserMesh};
pub use pins::PinMotion;
use pins::SceneLoader;
pub use source::SceneSource;
pub use track::Track;

use crate::file::{self, FileKind};
use error::SceneDocument;
use table::SceneTable;
use toile_base::limits::{MAX_SCENE_GARMENTS, MAX_SCENE_VERTICES};

/// Air that moves.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Wind {
    /// Velocity of the air (m/s).
    pub velocity: Vec3,
    /// Drag coefficient (1).
    pub drag: f32,
    /// Lift coefficient (1).
    pub lift: f32,
}

/// How the cloth is stepped, where the scene says so.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct SceneSettings {
    /// The quality's name, one of [`schema::QUALITIES`].
    pub quality: Option<&'static str>,
    /// Substeps of a step.
    pub substeps: Option<u32>,
    /// Speed limit of a particle (m/s).
    pub max_speed: Option<f32>,
    /// Damping time of stretch (s).
    pub stretch_damping: Option<f32>,
    /// Lanes that kernels run on: 1, 4, 8 or 16.
    pub lanes: Option<u32>,
    /// Whether garments keep the order in which they are listed.
    pub layers: Option<bool>,
    /// Whether each garment keeps from passing through itself.
    pub folds: Option<bool>,
}

/// A whole scene, checked.
#[derive(Debug, Clone, PartialEq)]
pub struct SceneFile {
    /// Name in reports.
    pub name: String,
    /// Length of the run (s).
    pub duration: f64,
    /// Steps a second.
    pub step_hz: f64,
    /// Steps before this time (s) are not measured.
    pub measure_from: f64,
    /// Acceleration of gravity (m/s2).
    pub gravity: Vec3,
    /// Wind, where there is any.
    pub wind: Option<Wind>,
    /// How the cloth is stepped.
    pub settings: SceneSettings,
    /// The pieces of cloth, at least one.
    pub garments: Vec<SceneGarment>,
    /// Colliders that the cloth meets.
    pub colliders: SceneColliders,
    /// Rigid motions of pin groups: group g of a pinned vertex follows `pins[g - 1]`, group 0 stands.
    pub pins: Vec<PinMotion>,
}

/// The scene file itself: vertices picked one by one make the longest.
const SCENE_FILE: FileKind = FileKind { name: "a scene file", max_bytes: 16 << 20, cure: "give a scene of TOML" };

impl SceneFile {
    /// Reads a scene file; the files that it names are looked for in its folder.
    pub fn read(path: &Path) -> Result<Self, SceneError> {
        let text = file::read_text(path, &SCENE_FILE).map_err(|e| e.reason());
        let text = text.map_err(|reason| SceneError::Read { path: path.to_path_buf(), reason })?;
        let folder = path.parent().unwrap_or(Path::new(""));
        Self::parse(&path.display().to_string(), &text, SceneSource::Folder(folder))
    }

    /// Reads one of the [`examples`].
    pub fn example(name: &str) -> Result<Self, SceneError> {
        let known = || examples::names().collect::<Vec<_>>().join(", ");
        let text = examples::text(name);
        let text = text.ok_or_else(|| SceneError::NoExample { name: name.into(), known: known() })?;
        Self::parse(&format!("{name}.toml"), text, SceneSource::Inside(examples::FILES))
    }

    /// Reads a scene from text; `file` is what messages call it.
    pub fn parse(file: &str, text: &str, source: SceneSource<'_>) -> Result<Self, SceneError> {
        let document = SceneDocument { file, text };
        let entries = DeTable::parse(text).map_err(|e| {
            let at = e.span().map_or(0, |span| span.start);
            document.error(at, format!("this is not TOML: {}; see docs/scene.md for the format", e.message()))
        })?;
        let root = SceneTable::open(document, entries.get_ref(), "", 0)?;
        let pass = root.choice("bad_rows")? == Some(1);
        let mut loading = SceneLoader { source, pass, pins: Vec::new() };
        let garments = garments(&root, &mut loading)?;
        let colliders = root.table("colliders")?.map(|table| SceneColliders::load(&table, source, pass));
        let stem = Path::new(file).file_stem().unwrap_or_default().to_string_lossy().into_owned();
        let scene = Self {
            name: root.text("name")?.map_or(stem, str::to_owned),
            duration: root.number("duration")?,
            step_hz: root.number("step_hz")?,
            measure_from: root.number("measure_from")?,
            gravity: root.vector("gravity")?,
            wind: root.table("wind")?.map(|table| wind(&table)).transpose()?,
            settings: root.table("settings")?.map(|table| settings(&table)).transpose()?.unwrap_or_default(),
            garments,
            colliders: colliders.transpose()?.unwrap_or_default(),
            pins: loading.pins.into_iter().map(|(_, motion)| motion).collect(),
        };
        if scene.steps() == 0 {
            return Err(root.wrong("duration", "is shorter than one step; give a longer one"));
        }
        if scene.measure_from >= scene.duration {
            return Err(
                root.wrong("measure_from", "lies past the end, so that nothing is measured; give an earlier time")
            );
        }
        Ok(scene)
    }

    /// Whole steps of the run.
    pub fn steps(&self) -> u64 {
        // A step that ends within a millionth of the duration belongs to it.
        (self.duration * self.step_hz + 1e-6).floor() as u64
    }
}

fn garments(root: &SceneTable<'_>, loading: &mut SceneLoader<'_>) -> Result<Vec<SceneGarment>, SceneError> {
    let tables = root.tables("garment")?;
    if tables.is_empty() {
        return Err(root.error("garment is missing; give at least one table [[garment]] with a mesh, grid or tube"));
    }
    if let Some(table) = tables.get(MAX_SCENE_GARMENTS) {
        let count = tables.len();
        return Err(
            table.error(format!("the scene has {count} garments, more than {MAX_SCENE_GARMENTS}; leave some out"))
        );
    }
    let mut garments: Vec<SceneGarment> = Vec::new();
    let mut vertices = 0;
    for (i, table) in tables.iter().enumerate() {
        let garment = SceneGarment::load(table, i + 1, loading)?;
        if garments.iter().any(|g| g.name == garment.name) {
            return Err(table.wrong("name", format!("\"{}\" stands twice; give each garment its own", garment.name)));
        }
        vertices += garment.mesh.start.len();
        if vertices > MAX_SCENE_VERTICES {
            return Err(table.error(format!(
                "the garments so far have {vertices} vertices, more than the {MAX_SCENE_VERTICES} that one scene may have; take \
                 coarser meshes or fewer garments (`toile plan` says what fits into real time)"
            )));
        }
        garments.push(garment);
    }
    Ok(garments)
}

fn wind(table: &SceneTable<'_>) -> Result<Wind, SceneError> {
    Ok(Wind {
        velocity: table.vector("velocity")?,
        drag: table.number("drag")? as f32,
        lift: table.number("lift")? as f32,
    })
}

fn settings(table: &SceneTable<'_>) -> Result<SceneSettings, SceneError> {
    let lanes = table.maybe_count("lanes")?;
    if lanes.is_some_and(|n| ![1, 4, 8, 16].contains(&n)) {
        return Err(table.wrong("lanes", "is no width that processors have; give 1, 4, 8 or 16"));
    }
    Ok(SceneSettings {
        quality: table.choice("quality")?.map(|i| schema::QUALITIES[i]),
        substeps: table.maybe_count("substeps")?,
        max_speed: table.maybe_number("max_speed")?.map(|v| v as f32),
        stretch_damping: table.maybe_number("stretch_damping")?.map(|v| v as f32),
        lanes,
        layers: Some(table.flag("layers")?),
        folds: Some(table.flag("folds")?),
    })
}
