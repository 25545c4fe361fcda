//! The keys of the configuration: one that is not known is refused by its name, its line and the nearest that is.

use std::ops::Range;

use toml::de::{DeTable, DeValue};

use crate::exit::AppError;

/// Every table and its keys.
pub const KEYS: [(&str, &[&str]); 8] = [
    ("wear", &["garments", "size", "quality"]),
    ("sensor", &["source", "session", "pause_s", "vmc"]),
    ("session", &["step_in_s", "measure_s", "step_out_s", "wipe_s"]),
    ("health", &["every_s"]),
    ("machine", &["workers", "lock_memory"]),
    ("display", &["lower_edge_mm", "height_mm", "language", "large_type", "motion", "picture_minutes", "mark_m"]),
    ("metrics", &["port"]),
    ("crash", &["recording"]),
];

/// Refuses a text with a key that is not known.
///
/// # Errors
/// The first such key, or what makes the text no TOML.
pub fn check(file: &str, text: &str) -> Result<(), AppError> {
    let document = DeTable::parse(text).map_err(|e| told(file, text, &e))?;
    let tables: Vec<&str> = KEYS.iter().map(|(table, _)| *table).collect();
    for (name, value) in document.get_ref() {
        let Some((table, keys)) = KEYS.iter().find(|(table, _)| *table == name.get_ref().as_ref()) else {
            return Err(unknown(file, text, name.span(), name.get_ref(), &tables, ""));
        };
        let DeValue::Table(inner) = value.get_ref() else { continue };
        for (key, _) in inner {
            if !keys.contains(&key.get_ref().as_ref()) {
                return Err(unknown(file, text, key.span(), key.get_ref(), keys, table));
            }
        }
    }
    Ok(())
}

fn unknown(file: &str, text: &str, span: Range<usize>, key: &str, known: &[&str], table: &str) -> AppError {
    let place = if table.is_empty() { "as a table".to_owned() } else { format!("in [{table}]") };
    AppError::Input(format!(
        "{file}:{}: `{key}` is not known {place}; did you mean `{}`, of {}?",
        line(text, span.start),
        nearest(key, known),
        known.join(", ")
    ))
}

/// The known key with the fewest letters between it and this one; of equals the first.
fn nearest<'a>(key: &str, known: &[&'a str]) -> &'a str {
    known.iter().copied().min_by_key(|k| strsim::damerau_levenshtein(key, k)).unwrap_or_default()
}

/// An error of the parser as one sentence with its line.
pub fn told(file: &str, text: &str, error: &toml::de::Error) -> AppError {
    let at = error.span().map_or(text.len(), |span| span.start);
    AppError::Input(format!(
        "{file}:{}: {}; compare it with what `toile kiosk --print-config` prints",
        line(text, at),
        error.message()
    ))
}

/// The line of a place, from 1.
fn line(text: &str, at: usize) -> usize {
    1 + text.as_bytes().iter().take(at).filter(|b| **b == b'\n').count()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn said(text: &str) -> String {
        check("k.toml", text).unwrap_err().to_string()
    }

    #[test]
    fn an_unknown_key_is_named_with_its_line_and_its_nearest() {
        let key = said("# a kiosk\n[wear]\nquality = \"shop\"\ngarmets = []\n");
        assert!(key.starts_with("k.toml:4: `garmets` is not known in [wear]; did you mean `garments`"), "{key}");
        let table = said("[wear]\n\n[sesion]\nwipe_s = 1\n");
        assert!(table.starts_with("k.toml:3: `sesion` is not known as a table; did you mean `session`"), "{table}");
        let dotted = said("metrics.prot = 1");
        assert!(dotted.starts_with("k.toml:1: `prot`") && dotted.contains("`port`"), "{dotted}");
    }

    #[test]
    fn every_known_key_passes() {
        for (table, keys) in KEYS {
            for key in keys {
                assert!(check("k.toml", &format!("[{table}]\n{key} = 1")).is_ok(), "{table}.{key}");
            }
        }
    }
}
