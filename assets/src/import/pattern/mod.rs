//! Sewn patterns from files: GarmentCode and Garment-Pattern-Generator JSON, FreeSewing drafts, DXF-AAMA and ASTM.

mod dxf;
mod error;
mod freesewing;
mod garment_code;
mod json;
mod piece;
mod seam_file;
mod trims;

use std::path::Path;

pub use error::PatternError;

use crate::file::{self, FileError, FileKind};
use crate::pattern::Pattern;
use crate::pattern::limits::MAX_PATTERN_BYTES;
use error::PatternFault;
use piece::Piece;
use seam_file::SeamFile;

/// Limits of a pattern file.
const PATTERN_FILE: FileKind =
    FileKind { name: "a pattern", max_bytes: MAX_PATTERN_BYTES, cure: "export one garment, without pictures" };

/// Limits of a seam file of a draft.
const SEAMS: FileKind = FileKind { name: "a seam file", max_bytes: MAX_PATTERN_BYTES, cure: "name each seam once" };

/// Reads a pattern; `seams` names the seam file of a draft.
///
/// # Errors
/// One sentence: the file, what is wrong where, and the cure.
pub fn read(path: &Path, seams: Option<&Path>) -> Result<Pattern, PatternError> {
    let text = read_text(path, &PATTERN_FILE)?;
    let name = path.display().to_string();
    let Some(beside) = seams else { return parse(&name, &text, None) };
    let seams = file::read_text(beside, &SEAMS)?;
    parse(&name, &text, Some((&beside.display().to_string(), &seams)))
}

/// Text of a file that may be a pattern; as [`decode`].
///
/// # Errors
/// If it cannot be read, is too large or is no text.
pub fn read_text(path: &Path, kind: &FileKind) -> Result<String, FileError> {
    let not_text = || FileError::NotText { path: path.display().to_string(), kind: *kind };
    decode(file::read(path, kind)?).ok_or_else(not_text)
}

/// Bytes as text: UTF-8, or DXF in the code page of its writer's country, as all DXF before 2007 is. That is read byte by
/// byte, which changes letters of names and no number. `None` for all else.
pub fn decode(bytes: Vec<u8>) -> Option<String> {
    match String::from_utf8(bytes) {
        Ok(text) => Some(text),
        Err(e) if dxf::looks_like(e.as_bytes()) => Some(e.as_bytes().iter().map(|b| char::from(*b)).collect()),
        Err(_) => None,
    }
}

/// Reads a pattern from text; the names stand in error messages. What format it is, the text says itself.
///
/// # Errors
/// As [`read`].
pub fn parse(name: &str, text: &str, seams: Option<(&str, &str)>) -> Result<Pattern, PatternError> {
    let here = |fault: PatternFault| fault.of(name);
    let pieces = if text.trim_start().starts_with(['{', '/']) {
        let file = json::read(text).map_err(here)?;
        if file["pattern"].is_object() {
            return garment_code::parse(&file).map_err(here);
        }
        if !file["parts"].is_object() {
            return Err(here(PatternFault::Content(
                "it holds neither a pattern nor parts; give GarmentCode's specification or FreeSewing's draft".into(),
            )));
        }
        freesewing::pieces(&file).map_err(here)?
    } else {
        dxf::pieces(text).map_err(here)?
    };
    sew(&pieces, name, seams)
}

/// The pieces of a draft sewn by their seam file, if there is one.
fn sew(pieces: &[Piece], name: &str, seams: Option<(&str, &str)>) -> Result<Pattern, PatternError> {
    match seams {
        None => seam_file::unsewn(pieces).map_err(|fault| fault.of(name)),
        Some((file, text)) => SeamFile::parse(text).and_then(|seams| seams.sew(pieces)).map_err(|fault| fault.of(file)),
    }
}
