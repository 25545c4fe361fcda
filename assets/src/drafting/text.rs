//! A draft as the text of a GarmentCode pattern, which any reader of that format, ours too, checks and shows.

use glam::DVec2;
use serde_json::{Value, json};

use super::garment::{DraftGarment, DraftSeamSide};
use super::panel::{DraftEdge, DraftPanel, DraftSide};
use crate::pattern::{Curve, Trim};

/// Units of the text in a metre: centimetres.
const UNITS: f64 = 100.0;

/// How far panels are laid from the body's axis, and at which height (cm): sides are all that is taken from it.
const AWAY: f64 = 25.0;
const HEIGHT: f64 = 100.0;

/// The text of a draft.
pub fn garment_code(garment: &DraftGarment) -> String {
    let panels: serde_json::Map<String, Value> =
        garment.panels.iter().map(|panel| (panel.name.to_owned(), drawn(panel))).collect();
    let seams: Vec<Value> =
        garment.seams.iter().map(|seam| json!(seam.each_ref().map(|side| end(garment, side)))).collect();
    let order: Vec<&str> = garment.panels.iter().map(|p| p.name).collect();
    let text = json!({
        "pattern": { "panels": panels, "stitches": seams, "panel_order": order },
        "properties": { "curvature_coords": "relative", "units_in_meter": UNITS },
    });
    text.to_string()
}

/// A side of a stitch. What is not there gets a number that no panel has, which the reader refuses.
fn end(garment: &DraftGarment, (panel, label): &DraftSeamSide) -> Value {
    let edges = garment.panel(panel).map_or(&[][..], |p| &p.edges);
    let edge = edges.iter().position(|e| e.label == *label).unwrap_or(edges.len());
    json!({ "panel": panel, "edge": edge })
}

fn drawn(panel: &DraftPanel) -> Value {
    let count = panel.edges.len();
    let vertices: Vec<Value> = panel.edges.iter().map(|e| point(e.curve.start() * UNITS)).collect();
    let edges: Vec<Value> = panel.edges.iter().enumerate().map(|(i, e)| edge(e, [i, (i + 1) % count])).collect();
    let (label, translation, turn) = match panel.side {
        DraftSide::Front => ("body", [0.0, HEIGHT, AWAY], 0.0),
        DraftSide::Back => ("body", [0.0, HEIGHT, -AWAY], 180.0),
        DraftSide::LeftArm => ("arm", [2.0 * AWAY, HEIGHT, 0.0], 90.0),
        DraftSide::RightArm => ("arm", [-2.0 * AWAY, HEIGHT, 0.0], -90.0),
    };
    json!({
        "label": label, "translation": translation, "rotation": [0.0, turn, 0.0], "vertices": vertices, "edges": edges,
        "trims": panel.trims.iter().map(trim).collect::<Vec<Value>>(),
    })
}

fn edge(edge: &DraftEdge, ends: [usize; 2]) -> Value {
    match &edge.curve {
        Curve::Cubic([start, a, b, end]) => {
            let controls = [a, b].map(|p| point(relative(*start, *end, *p)));
            json!({ "endpoints": ends, "label": edge.label, "curvature": { "type": "cubic", "params": controls } })
        }
        _ => json!({ "endpoints": ends, "label": edge.label }),
    }
}

fn trim(trim: &Trim) -> Value {
    let [from, to] = trim.ends.map(|p| point(p * UNITS));
    let width = (2e6 * trim.half * UNITS).round() / 1e6;
    json!({ "kind": trim.kind.name(), "from": from, "to": to, "width": width, "colour": trim.colour })
}

/// A control point along an edge, and across it to the left, in lengths of the edge.
fn relative(start: DVec2, end: DVec2, p: DVec2) -> DVec2 {
    let along = end - start;
    let off = p - start;
    DVec2::new(off.dot(along), along.perp_dot(off)) / along.length_squared()
}

/// A point, to the hundredth of a micrometre: neighbours share their corners' very digits.
fn point(p: DVec2) -> Value {
    let digits = |x: f64| (x * 1e6).round() / 1e6;
    json!([digits(p.x), digits(p.y)])
}
