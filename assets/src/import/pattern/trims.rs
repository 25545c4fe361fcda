//! Trims of a panel in GarmentCode's JSON: a key of our own, which other readers of the format pass over.

use glam::DVec2;
use serde_json::Value;

use super::error::{PatternFault, meant};
use super::json::{list, name, pair};
use crate::pattern::Trim;
use crate::pattern::limits::MAX_REACH_M;
use toile_base::garment::trim::TrimKind;

/// Widest trim (m): half of a coat's facing.
const MAX_HALF_M: f64 = 0.15;

/// Width of what says none (m): a shirt's button, and a strip as wide as a placket.
const fn usual_half(kind: TrimKind) -> f64 {
    match kind {
        TrimKind::Button => 0.0055,
        TrimKind::Stitches | TrimKind::Edge => 0.0006,
        TrimKind::Strip => 0.016,
        TrimKind::Zip => 0.006,
    }
}

/// Colour of what says none (sRGB): mother of pearl, and metal.
const USUAL_COLOUR: [f32; 3] = [0.86, 0.84, 0.8];

/// Reads the trims of a panel; without the key there are none.
pub fn read(panel: &str, value: &Value, unit: f64) -> Result<Vec<Trim>, PatternFault> {
    if !value.is_null() && !value.is_array() {
        return Err(PatternFault::Content(format!(
            "panel {panel}: its trims are no list; write [{{\"kind\": \"button\", ...}}]"
        )));
    }
    list(value).iter().enumerate().map(|(i, trim)| one(&format!("panel {panel}, trim {i}"), trim, unit)).collect()
}

fn one(place: &str, value: &Value, unit: f64) -> Result<Trim, PatternFault> {
    let wrong = |what: String| PatternFault::Content(format!("{place}: {what}"));
    let names = TrimKind::ALL.map(TrimKind::name);
    let said = value["kind"].as_str().unwrap_or_default();
    let kind = TrimKind::ALL.into_iter().find(|k| k.name() == said).ok_or_else(|| {
        let known = names.into_iter().filter(|_| !said.is_empty());
        let cure = meant(said, known, &format!("give one of {}", names.join(", ")));
        wrong(format!("its kind is \"{}\"; {cure}", name(said)))
    })?;
    let end = |key: &str| {
        let at = pair(&value[key]).map(|p| p * unit).filter(|p| p.is_finite() && p.length() < MAX_REACH_M);
        at.ok_or_else(|| {
            wrong(format!("{key} is no pair of numbers within {MAX_REACH_M} m; give a point of the drawing"))
        })
    };
    let from = end("from")?;
    let to = if value["to"].is_null() { from + DVec2::new(0.0, 0.001) } else { end("to")? };
    let half = match &value["width"] {
        Value::Null => usual_half(kind),
        width => {
            width.as_f64().map(|w| 0.5 * w * unit).filter(|h| (0.0..=MAX_HALF_M).contains(h)).ok_or_else(|| {
                wrong(format!("its width is no number from 0 to {} m; give it in the file's unit", 2.0 * MAX_HALF_M))
            })?
        }
    };
    let colour = match list(&value["colour"]) {
        [] => USUAL_COLOUR,
        [r, g, b] => {
            let channel = |v: &Value| v.as_f64().filter(|x| (0.0..=1.0).contains(x)).map(|x| x as f32);
            match [channel(r), channel(g), channel(b)] {
                [Some(r), Some(g), Some(b)] => [r, g, b],
                _ => return Err(wrong("its colour is not three numbers from 0 to 1; give sRGB".into())),
            }
        }
        _ => return Err(wrong("its colour is not three numbers from 0 to 1; give sRGB".into())),
    };
    Ok(Trim { kind, ends: [from, to], half, colour })
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::*;

    #[test]
    fn buttons_and_strips_are_read_in_the_files_unit() {
        let trims = json!([
            {"kind": "button", "from": [1, 20], "width": 2, "colour": [0.1, 0.2, 0.3]},
            {"kind": "strip", "from": [0, 0], "to": [0, 50]},
        ]);
        let read = read("front", &trims, 0.01).unwrap();
        assert_eq!((read[0].kind, read[0].half, read[0].colour), (TrimKind::Button, 0.01, [0.1, 0.2, 0.3]));
        assert_eq!((read[1].kind, read[1].ends[1], read[1].half), (TrimKind::Strip, DVec2::new(0.0, 0.5), 0.016));
        assert_eq!(super::read("front", &Value::Null, 0.01), Ok(Vec::new()));
    }

    #[test]
    fn what_is_wrong_is_one_sentence_with_its_place() {
        let good = json!({"kind": "zip", "from": [0, 0], "to": [0, 20], "width": 1.2, "colour": [0.5, 0.5, 0.5]});
        for (key, value, wanted) in [
            ("kind", json!("buton"), "did you mean button?"),
            ("kind", json!(null), "give one of button, stitches, edge, strip, zip"),
            ("from", json!([1]), "from is no pair"),
            ("to", json!([1e300, 0]), "to is no pair"),
            ("width", json!(-1), "width is no number"),
            ("width", json!("wide"), "width is no number"),
            ("colour", json!([2, 0, 0]), "colour is not three numbers"),
            ("colour", json!([0, 0]), "colour is not three numbers"),
        ] {
            let mut bad = good.clone();
            bad[key] = value;
            let said = read("front", &json!([bad]), 0.01).unwrap_err().of("x.json").to_string();
            assert!(said.contains("panel front, trim 0") && said.contains(wanted) && said.contains("; "), "{said}");
        }
        assert!(read("front", &json!("zip"), 0.01).is_err());
    }
}
