//! FreeSewing's drafted JSON: parts with paths of moves, lines and curves, in millimetres with y down.
//!
//! A part's outline is its path `seam`. Nothing says what is sewn to what, or that a piece is cut on the fold: that stands
//! in a seam file.

use glam::DVec2;
use serde_json::Value;

use super::error::PatternFault;
use super::json::{list, name, pair};
use super::piece::Piece;
use crate::pattern::Curve;
use crate::pattern::limits::MAX_PANELS;

/// Metres of one unit, y turned up.
const UNIT: DVec2 = DVec2::new(1e-3, -1e-3);

/// The path of a part that is its outline.
const OUTLINE: &str = "seam";

/// Reads the pieces of a file that holds `parts`; parts without an outline are notes, and hidden ones were only drafted for
/// others to build on.
pub fn pieces(file: &Value) -> Result<Vec<Piece>, PatternFault> {
    let parts =
        file["parts"].as_object().ok_or("parts is no table of drafted parts; export the draft again".to_owned())?;
    let drawn: Vec<_> = parts.iter().filter(|(_, part)| is_drawn(part)).collect();
    if drawn.is_empty() {
        return Err(PatternFault::Content(format!(
            "no part has a path named {OUTLINE}; draft the pattern before exporting it"
        )));
    }
    if drawn.len() > MAX_PANELS {
        return Err(PatternFault::Content(format!(
            "it has {} parts, more than the {MAX_PANELS} of MAX_PANELS; split it",
            drawn.len()
        )));
    }
    drawn.into_iter().map(|(key, part)| piece(&name(key), &part["paths"][OUTLINE])).collect()
}

fn is_drawn(part: &Value) -> bool {
    let outline = &part["paths"][OUTLINE];
    outline.is_object() && part["hidden"] != true && outline["hidden"] != true
}

fn piece(own: &str, path: &Value) -> Result<Piece, PatternFault> {
    let mut steps = Vec::new();
    let mut at: Option<DVec2> = None;
    let mut start = DVec2::ZERO;
    let mut closed = false;
    for (i, step) in list(&path["ops"]).iter().enumerate() {
        let wrong = |what: &str| format!("part {own}, step {i} of its outline: {what}; export the draft again");
        let point = |key: &str| {
            let point = pair(&step[key]).map(|p| p * UNIT);
            point.ok_or_else(|| wrong(&format!("{key} is no pair of numbers")))
        };
        if closed {
            return Err(wrong("it goes on after it was closed").into());
        }
        match (step["type"].as_str(), at) {
            (Some("move"), None) => {
                start = point("to")?;
                at = Some(start);
            }
            (Some("move"), Some(_)) => return Err(wrong("it moves on without a line").into()),
            (Some("line"), Some(from)) => {
                let to = point("to")?;
                steps.push(Curve::Line([from, to]));
                at = Some(to);
            }
            (Some("curve"), Some(from)) => {
                let to = point("to")?;
                steps.push(Curve::Cubic([from, point("cp1")?, point("cp2")?, to]));
                at = Some(to);
            }
            (Some("close"), Some(from)) => {
                steps.push(Curve::Line([from, start]));
                closed = true;
            }
            _ => return Err(wrong("it is none of move (first), line, curve and close").into()),
        }
    }
    Piece::of_steps(own, &steps, Some(DVec2::Y))
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::*;

    fn draft(ops: &Value) -> Result<Vec<Piece>, String> {
        let file = json!({"parts": {"a": {"paths": {"seam": {"ops": ops}}}, "note": {"paths": {}},
            "base": {"paths": {"seam": {"hidden": true, "ops": []}}}}});
        pieces(&file).map_err(|fault| fault.of("draft.json").to_string())
    }

    #[test]
    fn steps_are_numbered_and_those_without_length_left_out() {
        let ops = json!([{"type": "move", "to": [0, 0]}, {"type": "line", "to": [0, 100]}, {"type": "line", "to": [0, 100]},
            {"type": "curve", "to": [100, 0], "cp1": [50, 100], "cp2": [100, 50]}, {"type": "close"}]);
        let pieces = draft(&ops).unwrap();
        let numbers: Vec<usize> = pieces[0].edges.iter().map(|e| e.0).collect();
        assert_eq!(numbers, [0, 2, 3]);
        assert_eq!(pieces[0].edges[0].1.end(), DVec2::new(0.0, -0.1));
    }

    #[test]
    fn faults_name_the_step() {
        let start = json!({"type": "move", "to": [0, 0]});
        for (ops, wanted) in [
            (json!([{"type": "line", "to": [1, 1]}]), "step 0"),
            (json!([start, {"type": "line", "to": [1]}]), "step 1 of its outline: to is no pair"),
            (json!([start, {"type": "curve", "to": [1, 1], "cp1": [0, 1]}]), "cp2 is no pair"),
            (json!([start, {"type": "close"}, {"type": "line", "to": [1, 1]}]), "after it was closed"),
            (json!([start, start]), "moves on"),
            (json!([start, {"type": "noop"}]), "none of move"),
        ] {
            let message = draft(&ops).unwrap_err();
            assert!(message.contains(wanted) && message.contains("export the draft again"), "{message}");
        }
        assert!(pieces(&json!({"parts": {}})).is_err() && pieces(&json!({})).is_err());
    }
}
