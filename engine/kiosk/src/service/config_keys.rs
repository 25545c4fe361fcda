//! The keys of the configuration. An unknown key is refused with its name, its line and the nearest known key.

use toile_assets::toml_keys::{self, UnknownKey, place};
use toml::de::{DeTable, DeValue};

use crate::error::KioskError;

/// Every table and its keys.
pub const KEYS: [(&str, &[&str]); 10] = [
    ("wear", &["garments", "catalogue", "size", "quality"]),
    ("shopper", &["sex", "age", "measures"]),
    (
        "sensor",
        &[
            "source",
            "session",
            "pause_s",
            "vmc",
            "camera",
            "device",
            "turned_degrees",
            "camera_height_mm",
            "camera_tilt_degrees",
        ],
    ),
    ("session", &["step_in_s", "measure_s", "step_out_s", "wipe_s"]),
    ("health", &["every_s"]),
    ("machine", &["workers", "lock_memory"]),
    (
        "display",
        &[
            "lower_edge_mm",
            "height_mm",
            "language",
            "large_type",
            "motion",
            "picture_minutes",
            "mark_m",
            "skin",
            "hair",
            "own_picture",
            "face",
        ],
    ),
    ("picture", &["serve", "network"]),
    ("metrics", &["port"]),
    ("crash", &["recording"]),
];

/// Refuses a text with a key that is not known.
///
/// # Errors
/// The first such key, or what makes the text no TOML.
pub fn check(file: &str, text: &str) -> Result<(), KioskError> {
    let document = DeTable::parse(text).map_err(|e| parse_error(file, text, &e))?;
    let document = document.get_ref();
    let unknown = |key: UnknownKey| KioskError::Input(format!("{file}:{}: {}", place(text, key.at).0, key.message));
    toml_keys::check(document, "a configuration", &KEYS.map(|(table, _)| table)).map_err(unknown)?;
    for (table, keys) in KEYS {
        if let Some(DeValue::Table(inner)) = document.get(table).map(|value| value.get_ref()) {
            toml_keys::check(inner, &format!("[{table}]"), keys).map_err(unknown)?;
        }
    }
    Ok(())
}

/// An error of the parser as one sentence with its line.
pub fn parse_error(file: &str, text: &str, error: &toml::de::Error) -> KioskError {
    let at = error.span().map_or(text.len(), |span| span.start);
    KioskError::Input(format!(
        "{file}:{}: {}; compare it with what `toile kiosk --print-config` prints",
        place(text, at).0,
        error.message()
    ))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sentence(text: &str) -> String {
        check("k.toml", text).unwrap_err().to_string()
    }

    #[test]
    fn an_unknown_key_is_named_with_its_line_and_its_nearest() {
        let key = sentence("# a kiosk\n[wear]\nquality = \"shop\"\ngarmets = []\n");
        assert_eq!(key, "k.toml:4: [wear] has no key \"garmets\"; did you mean \"garments\"?");
        let table = sentence("[wear]\n\n[sesion]\nwipe_s = 1\n");
        assert_eq!(table, "k.toml:3: a configuration has no key \"sesion\"; did you mean \"session\"?");
        let dotted = sentence("metrics.prot = 1");
        assert_eq!(dotted, "k.toml:1: [metrics] has no key \"prot\"; did you mean \"port\"?");
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
