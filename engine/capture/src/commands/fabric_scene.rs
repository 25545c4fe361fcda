//! A scene file whose garment's fabric is varied.

use std::path::{Path, PathBuf};

use glam::Vec3;
use toile_assets::file::{self, FileKind};
use toile_assets::scene_file::{SceneFile, SceneSource};
use toile_base::fabric::Fabric;
use toile_capture::recover::VALUES;
use toile_cli::exit::AppError;
use toile_fitting::scene::Runner;

/// Largest scene file.
const SCENE: FileKind = FileKind { name: "a scene file", max_bytes: 1 << 20, cure: "give the scene of one garment" };

/// A scene of one garment, and how often its motion is looked at.
#[derive(Debug)]
pub(super) struct FabricScene {
    path: PathBuf,
    text: String,
    /// Steps of the engine a frame that was captured.
    steps: usize,
    start: [f64; VALUES],
    vertices: usize,
}

impl FabricScene {
    /// The values that are varied; stretch is that of warp and weft alike, bending that of all directions.
    pub const NAMES: [&'static str; VALUES] = ["stretch_n_m", "shear_n_m", "bend_un_m", "damping_per_s"];

    /// Keys of a fabric in a scene file, by the value that they take.
    const KEYS: [(&'static str, usize); 7] = [
        ("stretch_warp_n_m", 0),
        ("stretch_weft_n_m", 0),
        ("shear_n_m", 1),
        ("bend_warp_un_m", 2),
        ("bend_weft_un_m", 2),
        ("bend_bias_un_m", 2),
        ("damping_per_s", 3),
    ];

    /// Reads a scene for a motion of so many frames a second.
    pub fn read(path: &Path, rate: u32) -> Result<Self, AppError> {
        let refused = |why: String| AppError::input(format!("{}: {why}", path.display()));
        let text = file::read_text(path, &SCENE).map_err(AppError::input)?;
        let scene = parse(path, &text)?;
        let table: toml::Table =
            text.parse().map_err(|e| refused(format!("it is no TOML ({e}); give a scene file")))?;
        let hz = table.get("step_hz").and_then(|v| v.as_float().or(v.as_integer().map(|i| i as f64))).unwrap_or(120.0);
        let steps = (hz / f64::from(rate)).round() as usize;
        if steps == 0 || (steps as f64 * f64::from(rate) - hz).abs() > 1e-6 {
            return Err(refused(format!(
                "{hz} steps a second are no multiple of {rate} frames; change step_hz or --rate"
            )));
        }
        let [garment] = &scene.garments[..] else {
            return Err(refused(format!(
                "it has {} garments; give a scene of the captured one alone",
                scene.garments.len()
            )));
        };
        let fabric = table.get("garment").and_then(first).and_then(|g| g.get("fabric")).and_then(toml::Value::as_table);
        let number = |key: &str| {
            let value = fabric.and_then(|f| f.get(key)).and_then(|v| v.as_float().or(v.as_integer().map(|i| i as f64)));
            value.filter(|v| v.is_finite() && *v > 0.0)
        };
        let mut start = [0.0; VALUES];
        for (k, start) in start.iter_mut().enumerate() {
            let (key, _) = Self::KEYS.iter().find(|(_, of)| *of == k).expect("each value has a key");
            *start = number(key).ok_or_else(|| {
                refused(format!(
                    "[garment.fabric] has no {key} above 0 to start from; give a guess within a factor of five"
                ))
            })?;
        }
        let vertices = garment.mesh.start.len();
        Ok(Self { path: path.to_path_buf(), text, steps, start, vertices })
    }

    /// The values that the scene has.
    pub const fn start(&self) -> [f64; VALUES] {
        self.start
    }

    /// Whether a motion is that of the scene's mesh; how many vertices it has.
    pub fn check(&self, captured: &[Vec<Vec3>]) -> Result<usize, AppError> {
        match captured.iter().find(|f| f.len() != self.vertices) {
            None => Ok(self.vertices),
            Some(frame) => Err(AppError::input(format!(
                "{}: its garment has {} vertices and what was captured {}; give the scene of the captured mesh",
                self.path.display(),
                self.vertices,
                frame.len()
            ))),
        }
    }

    /// The motion with some values (m).
    pub fn simulate(&self, values: &[f64; VALUES], frames: usize) -> Result<Vec<Vec<Vec3>>, AppError> {
        let mut scene = parse(&self.path, &self.text)?;
        for (key, of) in Self::KEYS {
            let value = values[of] as f32;
            let found = |(name, least, most): &(&str, f32, f32)| *name == key && (*least..=*most).contains(&value);
            if !Fabric::RANGES.iter().any(found) {
                let path = self.path.display();
                return Err(AppError::input(format!(
                    "{path}: the search came to {key} = {value}, which no fabric has; start from other values"
                )));
            }
            scene.garments[0].fabric.set_figure(key, value);
        }
        let mut runner = Runner::new(scene).map_err(AppError::input)?;
        let mut all = Vec::with_capacity(frames);
        for _ in 0..frames {
            all.push(runner.positions(0).collect());
            (0..self.steps).for_each(|_| runner.step());
        }
        Ok(all)
    }
}

/// A scene of text that stands in a file's place.
fn parse(path: &Path, text: &str) -> Result<SceneFile, AppError> {
    let folder = path.parent().unwrap_or(Path::new(""));
    SceneFile::parse(&path.display().to_string(), text, SceneSource::Folder(folder)).map_err(AppError::input)
}

/// The only or the first table of a key that may stand several times.
fn first(value: &toml::Value) -> Option<&toml::Value> {
    value.as_array().map_or(Some(value), |all| all.first())
}
