//! Points that were marked on photographs of a face: JSON with 68 points in the order of Multi-PIE and iBUG, 468 or 478 in that of
//! MediaPipe's face mesh, or points by name.
//!
//! ```json
//! {"photographs": [{"picture": "front.jpg", "camera": "cam1", "points": [[412.5, 610.0], null]}]}
//! ```
//!
//! A point that is not seen is `null`. `camera` names one of a calibration; without it `focal_px`, where the lens is known. Names are
//! the numbers of the 68 points: `"30"` is the tip of the nose. `outline` is a curve along the outline of the head, or several. With
//! `"sequence": true` the photographs are frames of one camera in the order of time, and some may show no person.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use glam::DVec2;
use serde::Deserialize;
use toile_assets::file::{self, FileKind};

use crate::error::{FilePlace, ReaderFault, SourceError};
use crate::limits::MAX_CAMERAS;

/// Points of a face.
pub const FACE_POINTS: usize = 68;

/// Points of MediaPipe's face mesh.
pub const MESH_POINTS: usize = 468;

/// Fewest points of a photograph: a pose has six numbers.
const FEWEST: usize = 8;

/// The points of MediaPipe's face mesh that are those of the 68, in their order.
const OF_MESH: [usize; FACE_POINTS] = [
    162, 234, 93, 58, 172, 136, 149, 148, 152, 377, 378, 365, 397, 288, 323, 454, 389, 71, 63, 105, 66, 107, 336, 296,
    334, 293, 301, 168, 197, 5, 4, 75, 97, 2, 326, 305, 33, 160, 158, 133, 153, 144, 362, 385, 387, 263, 373, 380, 61,
    39, 37, 0, 267, 269, 291, 405, 314, 17, 84, 181, 78, 82, 13, 312, 308, 317, 14, 87,
];

/// The 68 points among all those of MediaPipe's face mesh.
///
/// # Panics
/// If there are fewer than [`MESH_POINTS`].
pub fn of_mesh<T: Copy>(mesh: &[T]) -> [T; FACE_POINTS] {
    OF_MESH.map(|k| mesh[k])
}

/// Most frames of a sequence: five minutes at 30 Hz.
const MAX_FRAMES: usize = 9_000;

/// Most points of the curves of one photograph: the outline of a mask of 4K has fewer.
const MAX_OUTLINE: usize = 20_000;

const FILE: FileKind = FileKind { name: "a file of points", max_bytes: 128 << 20, cure: "give the points of one face" };

const CURE: &str =
    "give 68 points in the order of Multi-PIE, 468 or 478 in MediaPipe's, or an object of names and points";

/// Content of a file of points.
#[derive(Debug, Clone, PartialEq)]
pub struct MarkedPhotographs {
    /// The photographs of one moment, or the frames of a sequence.
    pub photographs: Vec<MarkedPhotograph>,
    /// Whether they are frames of one camera in the order of time.
    pub sequence: bool,
}

/// One photograph with its points.
#[derive(Debug, Clone, PartialEq)]
pub struct MarkedPhotograph {
    /// The picture's file.
    pub picture: PathBuf,
    /// Its camera in a calibration.
    pub camera: Option<String>,
    /// Its focal length (px), where no calibration has it.
    pub focal_px: Option<f64>,
    /// The 68 points (px); none if they are not seen.
    pub points: [Option<DVec2>; FACE_POINTS],
    /// Curves along the head's outline (px) `[curves][points]`.
    pub outlines: Vec<Vec<DVec2>>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct RawFile {
    #[serde(default)]
    sequence: bool,
    photographs: Vec<RawPhotograph>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct RawPhotograph {
    picture: String,
    camera: Option<String>,
    focal_px: Option<f64>,
    points: RawPoints,
    outline: Option<RawOutline>,
}

#[derive(Deserialize)]
#[serde(untagged)]
enum RawOutline {
    One(Vec<Vec<f64>>),
    Several(Vec<Vec<Vec<f64>>>),
}

#[derive(Deserialize)]
#[serde(untagged)]
enum RawPoints {
    Ordered(Vec<Option<Vec<f64>>>),
    Named(BTreeMap<String, Vec<f64>>),
}

/// Reads a file of marked photographs; pictures lie beside it.
///
/// # Errors
/// One sentence where it is no JSON of this shape, has points of no order that is known, too few of them, or an outline that is no curve.
pub fn read_marked(path: &Path) -> Result<MarkedPhotographs, SourceError> {
    let shown = path.display().to_string();
    let text = file::read_text(path, &FILE)?;
    let folder = path.parent().unwrap_or(Path::new(""));
    parse(&text, folder).map_err(|fault| fault.at(&shown))
}

fn parse(text: &str, folder: &Path) -> Result<MarkedPhotographs, ReaderFault> {
    let whole = |problem: String| ReaderFault::new(FilePlace::Whole, problem, CURE);
    let raw: RawFile =
        serde_json::from_str(text).map_err(|e| whole(format!("it holds no marked photographs ({e})")))?;
    let (count, sequence) = (raw.photographs.len(), raw.sequence);
    let most = if sequence { MAX_FRAMES } else { MAX_CAMERAS };
    if count == 0 || count > most {
        return Err(whole(format!("{count} photographs where 1 to {most} are read")));
    }
    let one = |r: RawPhotograph| photograph(r, sequence, folder);
    let photographs = raw.photographs.into_iter().map(one).collect::<Result<_, _>>()?;
    Ok(MarkedPhotographs { photographs, sequence })
}

/// One photograph; a frame of a sequence may have no points at all.
fn photograph(r: RawPhotograph, sequence: bool, folder: &Path) -> Result<MarkedPhotograph, ReaderFault> {
    let whole = |problem: String| ReaderFault::new(FilePlace::Whole, format!("{}: {problem}", r.picture), CURE);
    let points = points(r.points, sequence).map_err(whole)?;
    let seen = points.iter().flatten().count();
    if seen < FEWEST && !sequence {
        return Err(whole(format!("{seen} points are marked and {FEWEST} are needed")));
    }
    if r.focal_px.is_some_and(|f| !(50.0..1e6).contains(&f)) {
        return Err(whole(format!("a focal length of {} px is no lens", r.focal_px.unwrap_or(0.0))));
    }
    if sequence && r.outline.is_some() {
        let problem = format!("{}: an outline in a sequence, which is followed by its points", r.picture);
        let cure = "leave it out, or give the photograph without \"sequence\"";
        return Err(ReaderFault::new(FilePlace::Whole, problem, cure));
    }
    let outlines = r.outline.map(outlines).transpose().map_err(|problem| {
        let cure = "give a curve as [[x, y], [x, y], ...] in the picture's pixels, or several of them";
        ReaderFault::new(FilePlace::Whole, format!("{}: {problem}", r.picture), cure)
    })?;
    let picture = folder.join(&r.picture);
    let outlines = outlines.unwrap_or_default();
    Ok(MarkedPhotograph { picture, camera: r.camera, focal_px: r.focal_px, points, outlines })
}

fn outlines(raw: RawOutline) -> Result<Vec<Vec<DVec2>>, String> {
    let curves = match raw {
        RawOutline::One(curve) => vec![curve],
        RawOutline::Several(curves) => curves,
    };
    let points = curves.iter().map(Vec::len).sum::<usize>();
    if points > MAX_OUTLINE {
        return Err(format!("an outline of {points} points where {MAX_OUTLINE} are read"));
    }
    let curve = |c: &Vec<Vec<f64>>| match c.len() {
        0 | 1 => Err(format!("an outline of {} points is no curve", c.len())),
        _ => c.iter().map(|p| place(p)).collect(),
    };
    curves.iter().map(curve).collect()
}

fn place(p: &[f64]) -> Result<DVec2, String> {
    match p {
        [x, y, ..] if x.is_finite() && y.is_finite() => Ok(DVec2::new(*x, *y)),
        _ => Err("a point is no pair of numbers".to_owned()),
    }
}

fn points(raw: RawPoints, may_be_none: bool) -> Result<[Option<DVec2>; FACE_POINTS], String> {
    let mut found = [None; FACE_POINTS];
    match raw {
        RawPoints::Ordered(all) if all.is_empty() && may_be_none => {}
        RawPoints::Ordered(all) => {
            let pick: Box<dyn Fn(usize) -> usize> = match all.len() {
                FACE_POINTS => Box::new(|i| i),
                468 | 478 => Box::new(|i| OF_MESH[i]),
                other => return Err(format!("{other} points, which is no order that is known")),
            };
            for (i, to) in found.iter_mut().enumerate() {
                *to = all[pick(i)].as_deref().map(place).transpose()?;
            }
        }
        RawPoints::Named(all) => {
            for (name, p) in all {
                let i = name.parse::<usize>().ok().filter(|i| *i < FACE_POINTS);
                let i =
                    i.ok_or_else(|| format!("there is no point \"{}\"", name.chars().take(40).collect::<String>()))?;
                found[i] = Some(place(&p)?);
            }
        }
    }
    Ok(found)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn file(points: &str) -> String {
        format!("{{\"photographs\": [{{\"picture\": \"a.png\", \"focal_px\": 900, \"points\": {points}}}]}}")
    }

    #[test]
    fn all_orders_give_the_same_points() {
        let all: Vec<String> = (0..FACE_POINTS).map(|i| format!("[{i}, 2.5]")).collect();
        let plain = parse(&file(&format!("[{}]", all.join(","))), Path::new("x")).unwrap();
        assert_eq!(plain.photographs[0].points[30], Some(DVec2::new(30.0, 2.5)));
        assert_eq!(plain.photographs[0].picture, Path::new("x/a.png"));
        let mut mesh = vec!["null".to_owned(); 468];
        (0..FACE_POINTS).for_each(|i| mesh[OF_MESH[i]] = format!("[{i}, 2.5, 0.1]"));
        assert_eq!(parse(&file(&format!("[{}]", mesh.join(","))), Path::new("x")).unwrap(), plain);
        let named: Vec<String> = (0..FACE_POINTS).map(|i| format!("\"{i}\": [{i}, 2.5]")).collect();
        assert_eq!(parse(&file(&format!("{{{}}}", named.join(","))), Path::new("x")).unwrap(), plain);
    }

    #[test]
    fn bad_points_are_one_sentence() {
        let said = |points: &str| parse(&file(points), Path::new("")).unwrap_err().at("p.json").to_string();
        assert!(said("[[1, 2]]").contains("1 points, which is no order that is known"));
        assert!(said("{\"30\": [1, 2]}").contains("1 points are marked and 8 are needed"));
        assert!(said("{\"nose\": [1, 2]}").contains("there is no point \"nose\""));
        assert!(said("{\"3\": [1]}").contains("no pair of numbers"));
        assert!(parse("{}", Path::new("")).unwrap_err().at("p.json").to_string().contains("no marked photographs"));
    }

    #[test]
    fn an_outline_is_one_curve_or_several() {
        let all: Vec<String> = (0..FACE_POINTS).map(|i| format!("[{i}, 2.5]")).collect();
        let of = |outline: &str| {
            parse(&file(&format!("[{}], \"outline\": {outline}", all.join(","))), Path::new(""))
                .map(|m| m.photographs[0].outlines.clone())
        };
        let curve = vec![DVec2::new(1.0, 2.0), DVec2::new(3.0, 4.0)];
        assert_eq!(of("[[1, 2], [3, 4]]").unwrap(), std::slice::from_ref(&curve));
        assert_eq!(of("[[[1, 2], [3, 4]], [[1, 2], [3, 4]]]").unwrap(), [curve.clone(), curve]);
        let said = |outline: &str| of(outline).unwrap_err().at("p.json").to_string();
        assert!(said("[[1, 2]]").contains("a.png: an outline of 1 points is no curve; give a curve as"));
        assert!(said("[[1, 2], [3]]").contains("no pair of numbers"));
        assert!(said("[1, 2]").contains("no marked photographs"));
    }

    #[test]
    fn frames_of_a_sequence_may_be_empty() {
        let frame = "{\"picture\": \"a.png\", \"points\": []}";
        let all = [frame; 20].join(",");
        let read = parse(&format!("{{\"sequence\": true, \"photographs\": [{all}]}}"), Path::new("")).unwrap();
        assert!(read.sequence && read.photographs.len() == 20);
        assert!(read.photographs[0].points.iter().all(Option::is_none));
        let said =
            parse(&format!("{{\"photographs\": [{frame}]}}"), Path::new("")).unwrap_err().at("p.json").to_string();
        assert!(said.contains("0 points, which is no order that is known"), "{said}");
        let outlined = frame.replace('}', ", \"outline\": [[1, 2], [3, 4]]}");
        let text = format!("{{\"sequence\": true, \"photographs\": [{outlined}]}}");
        let said = parse(&text, Path::new("")).unwrap_err().at("p.json").to_string();
        assert!(said.contains("an outline in a sequence, which is followed by its points; leave it out"), "{said}");
    }
}
