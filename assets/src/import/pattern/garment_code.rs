//! GarmentCode's JSON and the older dialect of the Garment-Pattern-Generator.
//!
//! Both hold panels of vertices and edges between them, and stitches from edge to edge. The control points of a curve
//! stand relative to its edge: along it, and across it to the left. The older dialect knows quadratic curves alone.

use glam::{DQuat, DVec2, DVec3, EulerRot};
use serde_json::{Map, Value};

use super::error::{PatternFault, meant};
use super::json::{index, list, name, pair, text, triple};
use super::trims;
use crate::pattern::limits::{MAX_PANEL_EDGES, MAX_PANELS, MAX_SEAMS};
use crate::pattern::{Curve, Panel, PanelEdge, PanelPlacement, Pattern, PatternFlaw, Seam, SeamSide};
use toile_base::garment::trim::MAX_TRIMS;

/// What a stitch says whose outside meets an inside: it is sewn from both beginnings.
const RIGHT_TO_WRONG: &str = "right_wrong";

/// How the file's numbers are read.
struct Dialect {
    /// Metres of one unit.
    unit: f64,
    /// True where control points stand in the panel's own frame.
    absolute: bool,
}

/// Reads a file that holds a `pattern`.
pub fn parse(file: &Value) -> Result<Pattern, PatternFault> {
    let properties = &file["properties"];
    let units = properties["units_in_meter"].as_f64().filter(|u| *u >= 1e-3 && *u <= 1e6);
    let units = units.ok_or_else(|| {
        "properties.units_in_meter is not there or is no positive number; give 100 where the pattern is in centimetres"
            .to_owned()
    })?;
    let dialect = Dialect { unit: 1.0 / units, absolute: properties["curvature_coords"] == "absolute" };
    let pattern = &file["pattern"];
    let panels =
        pattern["panels"].as_object().ok_or("pattern.panels is no table of panels; export it again".to_owned())?;
    if panels.len() > MAX_PANELS {
        return Err(too_many("the pattern", "panels", panels.len(), MAX_PANELS, "MAX_PANELS"));
    }
    if panels.is_empty() {
        return Err(PatternFlaw::Empty.into());
    }
    let read: Result<Vec<Panel>, PatternFault> =
        panels.iter().map(|(key, value)| panel(&name(key), value, &dialect)).collect();
    let read = read?;
    let count = read.iter().map(|p| p.trims.len()).sum();
    if count > MAX_TRIMS {
        return Err(too_many("the pattern", "trims", count, MAX_TRIMS, "MAX_TRIMS"));
    }
    Ok(Pattern::checked(read, stitches(&pattern["stitches"], panels)?)?)
}

fn too_many(place: &str, what: &'static str, count: usize, most: usize, limit: &'static str) -> PatternFault {
    PatternFault::Flaw(PatternFlaw::TooMany { place: place.into(), what, count, most, limit })
}

fn panel(own: &str, value: &Value, dialect: &Dialect) -> Result<Panel, PatternFault> {
    let vertices = list(&value["vertices"]).iter().enumerate().map(|(i, v)| {
        let point = pair(v).map(|p| p * dialect.unit);
        point.ok_or_else(|| format!("panel {own}: vertex {i} is no pair of numbers; export it again"))
    });
    let vertices = vertices.collect::<Result<Vec<DVec2>, String>>()?;
    let edges = list(&value["edges"]);
    if edges.len() > MAX_PANEL_EDGES {
        return Err(too_many(&format!("panel {own}"), "edges", edges.len(), MAX_PANEL_EDGES, "MAX_PANEL_EDGES"));
    }
    let edges = edges.iter().enumerate().map(|(number, edge)| {
        let curve = curve(own, number, edge, &vertices, dialect)?;
        Ok(PanelEdge { curve, number, label: text(&edge["label"]).map(|l| name(&l)) })
    });
    let edges = edges.collect::<Result<Vec<PanelEdge>, PatternFault>>()?;
    let panel = Panel {
        name: own.to_owned(),
        label: text(&value["label"]),
        edges,
        grain: DVec2::Y,
        behind: false,
        placement: placement(own, value, dialect)?,
        trims: trims::read(own, &value["trims"], dialect.unit)?,
    };
    // The order in which a panel is drawn says which side is the outside: from there its edges run counter-clockwise.
    Ok(Panel { behind: panel.signed_area() < 0.0, ..panel })
}

fn curve(
    panel: &str,
    number: usize,
    edge: &Value,
    vertices: &[DVec2],
    dialect: &Dialect,
) -> Result<Curve, PatternFault> {
    let wrong = |what: &str| PatternFault::Content(format!("panel {panel}, edge {number}: {what}; export it again"));
    let [from, to] = list(&edge["endpoints"]) else { return Err(wrong("endpoints is no pair of vertices")) };
    let vertex = |v: &Value| {
        let found = index(v).and_then(|i| vertices.get(i)).copied();
        found.ok_or_else(|| wrong(&format!("it ends at vertex {} of {}", name(&v.to_string()), vertices.len())))
    };
    let (start, end) = (vertex(from)?, vertex(to)?);
    let along = end - start;
    let control = |value: &Value| {
        let p = pair(value).ok_or_else(|| wrong("a control point is no pair of numbers"))?;
        Ok::<DVec2, PatternFault>(if dialect.absolute {
            p * dialect.unit
        } else {
            start + along * p.x + along.perp() * p.y
        })
    };
    let bend = &edge["curvature"];
    if bend.is_null() {
        return Ok(Curve::Line([start, end]));
    }
    if bend.is_array() {
        return Ok(Curve::quadratic(start, control(bend)?, end));
    }
    match (bend["type"].as_str(), list(&bend["params"])) {
        (Some("quadratic"), [c]) => Ok(Curve::quadratic(start, control(c)?, end)),
        (Some("cubic"), [c, d]) => Ok(Curve::Cubic([start, control(c)?, control(d)?, end])),
        (Some("circle"), [radius, large, right]) => {
            let number_of = |v: &Value| v.as_f64().or_else(|| v.as_bool().map(f64::from));
            let numbers = [radius, large, right].map(number_of);
            let [Some(r), Some(large), Some(right)] = numbers else {
                return Err(wrong("a circle's params are no numbers"));
            };
            let radius = r * dialect.unit;
            let arc = Curve::arc([start, end], radius, large != 0.0, right != 0.0);
            arc.ok_or_else(|| PatternFlaw::Radius { panel: panel.into(), edge: number, radius }.into())
        }
        _ => Err(wrong("its curvature is none of quadratic, cubic or circle with its params")),
    }
}

fn placement(panel: &str, value: &Value, dialect: &Dialect) -> Result<Option<PanelPlacement>, PatternFault> {
    let vector = |key: &str| match &value[key] {
        Value::Null => Ok(None),
        v => {
            triple(v).map(Some).ok_or_else(|| format!("panel {panel}: its {key} is not three numbers; export it again"))
        }
    };
    let (Some(translation), rotation) = (vector("translation")?, vector("rotation")?.unwrap_or(DVec3::ZERO)) else {
        return Ok(None);
    };
    let [x, y, z] = rotation.to_array().map(f64::to_radians);
    // About x first, then y, then z, all of them fixed axes.
    let rotation = DQuat::from_euler(EulerRot::ZYX, z, y, x);
    Ok(Some(PanelPlacement { translation: translation * dialect.unit, rotation }))
}

fn stitches(value: &Value, panels: &Map<String, Value>) -> Result<Vec<Seam>, PatternFault> {
    let stitches = list(value);
    if stitches.len() > MAX_SEAMS {
        return Err(too_many("the pattern", "stitches", stitches.len(), MAX_SEAMS, "MAX_SEAMS"));
    }
    let seam = |(i, stitch): (usize, &Value)| {
        let (a, b, word) = match list(stitch) {
            [a, b] => (a, b, None),
            [a, b, word] => (a, b, word.as_str()),
            _ => {
                return Err(PatternFault::Content(format!(
                    "stitch {i} is no pair of edges; sew one edge to one other"
                )));
            }
        };
        let stitch = format!("stitch {i}");
        let start = side(&stitch, a, panels)?;
        let mut end = side(&stitch, b, panels)?;
        end.reversed = word != Some(RIGHT_TO_WRONG);
        Ok(Seam { name: stitch, sides: [start, end] })
    };
    stitches.iter().enumerate().map(seam).collect()
}

fn side(seam: &str, value: &Value, panels: &Map<String, Value>) -> Result<SeamSide, PatternFault> {
    let (Some(key), Some(edge)) = (value["panel"].as_str(), index(&value["edge"])) else {
        return Err(PatternFault::Content(format!("{seam} has a side without panel and edge; export it again")));
    };
    let Some(panel) = panels.keys().position(|k| k == key) else {
        let names: Vec<String> = panels.keys().map(|k| name(k)).collect();
        let cure = meant(key, names.iter().map(String::as_str), "export the pattern with all of its panels");
        return Err(PatternFlaw::NoPanel { seam: seam.into(), name: name(key), cure }.into());
    };
    Ok(SeamSide { panel, first: edge, count: 1, reversed: false })
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::*;

    fn square() -> Value {
        json!({
            "pattern": {
                "panels": {
                    "back": {"vertices": [[0, 0], [0, 30], [20, 30], [20, 0]], "translation": [0, 0, -10], "rotation": [0, 0, 0],
                        "edges": [{"endpoints": [0, 1]}, {"endpoints": [1, 2]}, {"endpoints": [2, 3]}, {"endpoints": [3, 0]}]},
                    "front": {"vertices": [[0, 0], [20, 0], [20, 30], [0, 30]],
                        "edges": [{"endpoints": [0, 1]}, {"endpoints": [1, 2]}, {"endpoints": [2, 3],
                            "curvature": {"type": "circle", "params": [10, 0, 0]}}, {"endpoints": [3, 0], "label": "left"}]}
                },
                "stitches": [[{"panel": "front", "edge": 3}, {"panel": "back", "edge": 0}],
                    [{"panel": "front", "edge": 1}, {"panel": "back", "edge": 2}]]
            },
            "properties": {"units_in_meter": 100, "curvature_coords": "relative"}
        })
    }

    fn message(file: &Value) -> String {
        parse(file).unwrap_err().of("x.json").to_string()
    }

    #[test]
    fn panels_edges_arcs_seams_and_sides_are_read() {
        let pattern = parse(&square()).unwrap();
        let [back, front] = pattern.panels() else { panic!("two panels") };
        assert!((back.signed_area() + 0.06).abs() < 1e-12 && pattern.shows_inside(0) && !pattern.shows_inside(1));
        // The neckline is a half circle cut out of the front.
        let half_circle = 0.5 * std::f64::consts::PI * 0.01;
        assert!((front.signed_area() - (0.06 - half_circle)).abs() < 1e-9);
        assert_eq!(front.edge_name(3), "edge 3 (left)");
        assert!(pattern.seams()[0].sides[1].reversed && back.placement.is_some() && front.placement.is_none());
    }

    #[test]
    fn rotations_are_about_fixed_axes_x_first() {
        let mut file = square();
        file["pattern"]["panels"]["back"]["rotation"] = json!([90, 90, 0]);
        let rotation = parse(&file).unwrap().panels()[0].placement.unwrap().rotation;
        // y goes to z about x, and z to x about y.
        assert!((rotation * DVec3::Y - DVec3::X).length() < 1e-12);
    }

    #[test]
    fn each_fault_is_one_sentence_with_its_place_and_cure() {
        let cases = [
            ("/properties/units_in_meter", json!(0), "units_in_meter"),
            ("/pattern/panels", json!([]), "no table of panels"),
            ("/pattern/panels", json!({}), "no panels"),
            ("/pattern/panels/front/vertices/1", json!([1]), "panel front: vertex 1"),
            ("/pattern/panels/front/edges/0/endpoints", json!([0, 9]), "panel front, edge 0: it ends at vertex 9 of 4"),
            ("/pattern/panels/front/edges/0/endpoints", json!([0, 2]), "edge 0 ends"),
            ("/pattern/panels/front/edges/2/curvature", json!({"type": "spiral"}), "quadratic, cubic or circle"),
            ("/pattern/panels/front/edges/2/curvature/params/0", json!(9), "too small a radius"),
            ("/pattern/panels/front/edges/0/curvature", json!([0.5, 2.0]), "crosses or touches"),
            ("/pattern/panels/front/vertices/1", json!([1e9, 1]), "reaches beyond"),
            ("/pattern/panels/back/rotation", json!([1, 2]), "rotation is not three numbers"),
            ("/pattern/stitches/0", json!([]), "stitch 0 is no pair"),
            ("/pattern/stitches/0/0/panel", json!("frnt"), "did you mean front?"),
            ("/pattern/stitches/0/0/edge", json!(7), "names edge 7 of panel front, which has 4"),
            ("/pattern/stitches/0/0/edge", json!(1), "sew each edge once"),
            ("/pattern/stitches/0/2", json!("right_wrong"), "swap the ends"),
        ];
        for (place, value, wanted) in cases {
            let mut file = square();
            match file.pointer_mut(place) {
                Some(at) => *at = value,
                None => match place.rsplit_once('/') {
                    Some((list, "2")) => file.pointer_mut(list).unwrap().as_array_mut().unwrap().push(value),
                    Some((table, key)) => file.pointer_mut(table).unwrap()[key] = value,
                    None => unreachable!("every place has a parent"),
                },
            }
            let message = message(&file);
            assert!(message.contains(wanted) && message.contains(';'), "{place}: {message}");
        }
    }

    #[test]
    fn huge_counts_end_quickly() {
        let mut file = square();
        let vertex = json!([0, 0]);
        file["pattern"]["panels"]["front"]["edges"] = json!(vec![json!({"endpoints": [0, 1]}); 100_000]);
        file["pattern"]["panels"]["front"]["vertices"] = json!(vec![vertex; 100_000]);
        assert!(message(&file).contains("100000 edges, more than the 1024 of MAX_PANEL_EDGES"));
        let mut file = square();
        file["pattern"]["stitches"] = json!(vec![json!([]); 100_000]);
        assert!(message(&file).contains("MAX_SEAMS"));
    }
}
