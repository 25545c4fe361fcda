//! MakeHuman's files: plain text, and text packed by gzip (RFC 1952), of a bounded size.

use std::io::Read;
use std::path::{Path, PathBuf};

use flate2::read::GzDecoder;
use glam::Vec3;
use serde_json::Value;

use crate::import::avatar::{AvatarError, Flaw, load};

/// Most bytes that a packed file may unpack to: weights of the largest rig take 12 MB.
const MAX_UNPACKED: u64 = 64 << 20;

/// A plain file's text.
pub(super) fn text(path: &Path) -> Result<String, AvatarError> {
    let bytes = load(path).map_err(|flaw| flaw.of(path))?;
    String::from_utf8(bytes)
        .map_err(|_| Flaw::Syntax { reason: "it is no text; use MakeHuman's own file".into() }.of(path))
}

/// A packed file's text.
pub(super) fn unpacked(path: &Path) -> Result<String, AvatarError> {
    let packed = load(path).map_err(|flaw| flaw.of(path))?;
    let mut text = String::new();
    let read = GzDecoder::new(&*packed).take(MAX_UNPACKED + 1).read_to_string(&mut text);
    let reason = match read {
        Err(e) => format!("it cannot be unpacked ({e}); copy MakeHuman's own file again"),
        Ok(bytes) if bytes as u64 > MAX_UNPACKED => {
            format!("it unpacks to more than {MAX_UNPACKED} bytes; use MakeHuman's own file")
        }
        Ok(_) => return Ok(text),
    };
    Err(Flaw::Syntax { reason }.of(path))
}

/// A packed JSON file.
pub(super) fn json_gz(path: &Path) -> Result<Value, AvatarError> {
    let text = unpacked(path)?;
    serde_json::from_str(&text).map_err(|e| Flaw::Syntax { reason: format!("{e}; use MakeHuman's own file") }.of(path))
}

/// Adds targets to the base: each moves its vertices by so much of its offsets (dm).
pub(super) fn targets(folder: &Path, chosen: &[(String, f32)], positions: &mut [Vec3]) -> Result<(), AvatarError> {
    for (name, share) in chosen {
        let path = find(folder, name).ok_or_else(|| Flaw::NoTarget { name: name.clone() }.of(folder))?;
        add(&unpacked(&path)?, *share, positions).map_err(|reason| Flaw::Syntax { reason }.of(&path))?;
    }
    Ok(())
}

/// The target of a name, in the folder or in one below it, the first in order of their names.
fn find(folder: &Path, name: &str) -> Option<PathBuf> {
    let file = format!("{}.target.gz", name.trim_end_matches(".gz").trim_end_matches(".target"));
    if file.contains(['/', '\\']) {
        return None;
    }
    let below = std::fs::read_dir(folder).into_iter().flatten().flatten().map(|e| e.path()).filter(|p| p.is_dir());
    let mut folders: Vec<PathBuf> = below.collect();
    folders.sort();
    folders.insert(0, folder.to_path_buf());
    folders.into_iter().map(|f| f.join(&file)).find(|f| f.is_file())
}

fn add(text: &str, share: f32, positions: &mut [Vec3]) -> Result<(), String> {
    for (i, line) in text.lines().enumerate() {
        let line = line.split('#').next().unwrap_or_default();
        let mut words = line.split_whitespace();
        let Some(vertex) = words.next() else { continue };
        let mut number = || words.next().and_then(|w| w.parse::<f32>().ok()).filter(|x| x.is_finite());
        let offset = (|| Some(Vec3::new(number()?, number()?, number()?)))();
        let to = vertex.parse().ok().and_then(|v: usize| positions.get_mut(v));
        let (Some(to), Some(offset)) = (to, offset) else {
            let n = i + 1;
            return Err(format!(
                "line {n} is not a vertex of the base and three numbers; copy MakeHuman's own file again"
            ));
        };
        *to += offset * share;
    }
    Ok(())
}
