//! Two motions of one mesh side by side: the distance between them over time (MIRAGES 2006, section 5.3.3).
//!
//! `e = 1/N sum |x_i - y_i|` in each frame: how far each point of the one grid lies from its counterpart on the other, on average.

use std::path::{Path, PathBuf};

use glam::Vec3;
use serde::Serialize;
use toile_assets::export::ply_positions;
use toile_assets::file::{self, FileKind};

use crate::error::CaptureError;

/// Largest file of one frame.
const FRAME: FileKind = FileKind { name: "a mesh as PLY", max_bytes: 256 << 20, cure: "give meshes of one frame each" };

/// How far two motions lie apart.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Comparison {
    /// Frames that were compared.
    pub frames: usize,
    /// Vertices of each.
    pub vertices: usize,
    /// Mean, 95th percentile and largest distance of a vertex from its counterpart, over all frames (mm).
    pub mean_mm: f64,
    /// 95th percentile (mm).
    pub p95_mm: f64,
    /// Largest (mm).
    pub max_mm: f64,
    /// The distance e of each frame (mm).
    pub over_time_mm: Vec<f64>,
}

/// Compares two motions, frame by frame, up to the end of the shorter.
///
/// # Errors
/// One sentence where a frame has not as many vertices as its counterpart, or there are no frames.
pub fn compare(a: &[Vec<Vec3>], b: &[Vec<Vec3>]) -> Result<Comparison, CaptureError> {
    let frames = a.len().min(b.len());
    let cure = "give the same mesh in both folders, with its vertices in the same order";
    let (mut all, mut over_time) = (Vec::new(), Vec::with_capacity(frames));
    for (f, (a, b)) in a.iter().zip(b).enumerate() {
        if a.len() != b.len() || a.is_empty() {
            let problem = format!("frame {f} has {} vertices in the one and {} in the other", a.len(), b.len());
            return Err(CaptureError::unfit("the two motions", problem, cure));
        }
        let off = a.iter().zip(b).map(|(p, q)| f64::from(p.distance(*q)) * 1e3);
        let first = all.len();
        all.extend(off);
        over_time.push(all[first..].iter().sum::<f64>() / a.len() as f64);
    }
    if all.is_empty() {
        return Err(CaptureError::unfit("the two motions", "there are no frames to compare", cure));
    }
    all.sort_by(f64::total_cmp);
    Ok(Comparison {
        frames,
        vertices: a[0].len(),
        mean_mm: all.iter().sum::<f64>() / all.len() as f64,
        p95_mm: all[(all.len() * 95 / 100).min(all.len() - 1)],
        max_mm: all[all.len() - 1],
        over_time_mm: over_time,
    })
}

/// The motion of a folder of PLY files, in the order of their names, as `toile capture flow` and `toile run --dump` write them (m).
///
/// # Errors
/// One sentence with the path where a file cannot be read, or there is none.
pub fn read_motion(folder: &Path) -> Result<Vec<Vec<Vec3>>, CaptureError> {
    let shown = folder.display().to_string();
    let refused = |error| CaptureError::Io { path: shown.clone(), action: "read", error };
    let mut files: Vec<PathBuf> = Vec::new();
    for entry in std::fs::read_dir(folder).map_err(refused)? {
        let path = entry.map_err(refused)?.path();
        if path.extension().is_some_and(|e| e.eq_ignore_ascii_case("ply")) {
            files.push(path);
        }
    }
    files.sort();
    if files.is_empty() {
        return Err(CaptureError::unfit(shown, "it holds no PLY files", "give a folder with a PLY file a frame"));
    }
    let read = |path: &PathBuf| {
        let bytes = file::read(path, &FRAME).map_err(|e| CaptureError::Source(e.into()))?;
        ply_positions(&bytes).map_err(|problem| {
            CaptureError::unfit(
                path.display().to_string(),
                problem,
                "write it with toile capture flow or toile run --dump",
            )
        })
    };
    files.iter().map(read).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_distance_is_the_mean_of_each_frame() {
        let still = vec![vec![Vec3::ZERO; 4]; 3];
        let moved: Vec<Vec<Vec3>> = (0..3).map(|f| vec![Vec3::X * 1e-3 * f as f32; 4]).collect();
        let found = compare(&still, &moved).unwrap();
        assert!(found.over_time_mm.iter().zip([0.0, 1.0, 2.0]).all(|(a, b)| (a - b).abs() < 1e-6), "{found:?}");
        assert!((found.mean_mm - 1.0).abs() < 1e-6 && (found.max_mm - 2.0).abs() < 1e-6);
        assert!(
            compare(&still, &[vec![Vec3::ZERO; 5]]).unwrap_err().to_string().contains("4 vertices in the one and 5")
        );
        assert!(compare(&still, &[]).is_err());
    }
}
