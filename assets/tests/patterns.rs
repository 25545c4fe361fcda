//! Sewn patterns by others: read, meshed as promised, sewn into one surface, and refused in one sentence where they are
//! damaged.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use glam::Vec3;
use proptest::prelude::*;
use toile_assets::import::pattern::{PatternError, parse, read};
use toile_assets::pattern::Pattern;
use toile_assets::tailor::{SewnMesh, TailorError, sew};
use toile_bake::check::check;
use toile_base::numeric::random::SplitMix64;

use crate::recordings;

/// Spacings at which the promises are held (m).
const SPACINGS: [f64; 2] = [0.015, 0.025];

/// Least share of the inner particles that lie on a warp and a weft fiber.
const REGULAR: f64 = 0.85;

/// Smallest angle, where no corner of the panel is sharper (degrees).
const LEAST_ANGLE: f64 = 20.0;

/// Most that the area of a panel's mesh is off.
const AREA: f64 = 1e-3;

/// The drafts of FreeSewing that have a seam file, and the file.
const DRAFTS: [(&str, &str); 4] = [
    ("aaron-cisFemaleAdult34", "aaron"),
    ("brian-cisMaleAdult38", "brian"),
    ("sandy-cisFemaleAdult34", "sandy"),
    ("sandy-cisFemaleAdult42", "sandy"),
];

fn seam_file(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("data/patterns/{name}.toml"))
}

/// The shared patterns with their seam files.
fn shared() -> Vec<(PathBuf, Option<PathBuf>)> {
    let Some(root) = recordings::folder().map(|folder| folder.join("patterns")) else { return Vec::new() };
    let mut found = Vec::new();
    for folder in ["garment-pattern-generator", "garmentcode"] {
        let files = std::fs::read_dir(root.join(folder)).unwrap().map(|entry| entry.unwrap().path());
        let json = |path: &PathBuf| path.extension().is_some_and(|e| e == "json" || e == "jsonc");
        found.extend(files.filter(json).map(|path| (path, None)));
    }
    found.sort();
    assert_eq!(found.len(), 13, "ten of the older dialect, its template, and two of GarmentCode");
    found.extend(DRAFTS.map(|(draft, seams)| (root.join(format!("freesewing/{draft}.json")), Some(seam_file(seams)))));
    found
}

fn each(link_curve: impl Fn(&str, &Pattern, f64, &SewnMesh)) {
    for (path, seams) in shared() {
        let pattern = read(&path, seams.as_deref()).unwrap();
        for spacing in SPACINGS {
            let sewn = sew(&pattern, spacing).unwrap();
            link_curve(&format!("{} at {spacing} m", path.file_name().unwrap().display()), &pattern, spacing, &sewn);
        }
    }
}

#[test]
fn shared_patterns_are_meshed_as_promised() {
    each(|name, pattern, _, sewn| {
        let (mut inner, mut regular) = (0, 0);
        for (mesh, panel) in sewn.panels.iter().zip(pattern.panels()) {
            let quality = mesh.quality(panel);
            assert!(
                quality.least_angle >= LEAST_ANGLE.min(quality.sharpest_corner),
                "{name}, {}: {quality:?}",
                panel.name
            );
            assert!(quality.area_error.abs() <= AREA, "{name}, {}: {quality:?}", panel.name);
            (inner, regular) = (inner + quality.inner, regular + quality.regular);
        }
        assert!(regular as f64 >= REGULAR * inner as f64, "{name}: {regular} of {inner} are on fibers");
    });
}

#[test]
fn points_of_the_outline_follow_it_at_the_spacing() {
    each(|name, pattern, spacing, sewn| {
        for (mesh, panel) in sewn.panels.iter().zip(pattern.panels()) {
            for (e, edge) in panel.edges.iter().enumerate() {
                let start = mesh.points[mesh.boundary.starts[e]];
                assert!(start.distance(edge.curve.start()) < 1e-12, "{name}, {}", panel.name);
            }
            let outline = &mesh.boundary.points;
            let chords = outline.iter().zip(outline.iter().cycle().skip(1)).map(|(a, b)| a.distance(*b));
            assert!(chords.into_iter().all(|c| c <= spacing * 1.05), "{name}, {}", panel.name);
        }
    });
}

#[test]
fn sewn_panels_are_one_surface() {
    each(|name, pattern, _, sewn| {
        // Anywhere: only how the faces join is looked at.
        let mut random = SplitMix64::new(3);
        let mut anywhere = || Vec3::new(random.uniform(), random.uniform(), random.uniform());
        let positions: Vec<Vec3> = sewn.members.iter().map(|_| anywhere()).collect();
        check(&positions, &sewn.faces).unwrap_or_else(|e| panic!("{name}: {e}"));
        for (seam, vertices) in pattern.seams().iter().zip(&sewn.seams) {
            let panels: BTreeSet<usize> = seam.sides.iter().map(|side| side.panel).collect();
            let joined = |v: &u32| {
                let members = &sewn.members[*v as usize];
                panels.iter().all(|p| members.iter().any(|m| m[0] as usize == *p))
            };
            assert!(vertices.len() > 1 && vertices.iter().all(joined), "{name}, {}", seam.name);
        }
        let all: usize = sewn.panels.iter().map(|p| p.points.len()).sum();
        assert_eq!(sewn.members.iter().map(Vec::len).sum::<usize>(), all);
    });
}

/// At rest every face is as large and lies as it does in its panel, seen from outside.
#[test]
fn faces_at_rest_are_those_of_their_panels() {
    each(|name, pattern, _, sewn| {
        let area = |flat: &[glam::Vec2; 4], corners: usize| -> f64 {
            let ring = &flat[..corners];
            (0..corners).map(|i| 0.5 * f64::from(ring[i].perp_dot(ring[(i + 1) % corners]))).sum()
        };
        let mut areas = vec![0.0; pattern.panels().len()];
        for ((face, flat), panel) in sewn.faces.iter().zip(&sewn.flat).zip(&sewn.face_panels) {
            let area = area(flat, if face[3] == u32::MAX { 3 } else { 4 });
            assert!(area > 0.0, "{name}: a face is turned over");
            areas[*panel as usize] += area;
        }
        for (area, panel) in areas.iter().zip(pattern.panels()) {
            assert!((area / panel.signed_area().abs() - 1.0).abs() <= AREA, "{name}, {}", panel.name);
        }
    });
}

/// The side seams of a skirt run along its warp: every row of the front goes on in a row of the back.
#[test]
fn weft_runs_on_across_side_seams() {
    let Some(root) = recordings::folder() else { return };
    let pattern = read(&root.join("patterns/garment-pattern-generator/skirt_waistband.json"), None).unwrap();
    for spacing in SPACINGS {
        let sewn = sew(&pattern, spacing).unwrap();
        let is_row = |face: &[u32; 4], v: u32| {
            face[3] != u32::MAX && [[face[0], face[1]], [face[3], face[2]]].iter().any(|side| side.contains(&v))
        };
        let name = |p: usize| pattern.panels()[p].name.as_str();
        let sides = pattern.seams().iter().zip(&sewn.seams).filter(|(seam, _)| {
            let panels: BTreeSet<&str> = seam.sides.iter().map(|s| name(s.panel)).collect();
            panels == BTreeSet::from(["back", "front"])
        });
        let mut seen = 0;
        for v in sides.flat_map(|(_, vertices)| &vertices[1..vertices.len() - 1]) {
            let rows = sewn.faces.iter().zip(&sewn.face_panels).filter(|(face, _)| is_row(face, *v));
            assert_eq!(rows.map(|(_, panel)| *panel).collect::<BTreeSet<u32>>().len(), 2, "vertex {v}");
            seen += 1;
        }
        assert!(seen > 40);
    }
}

#[test]
fn drafts_are_sewn_edge_to_edge() {
    let Some(root) = recordings::folder() else { return };
    for (draft, seams) in DRAFTS {
        let pattern = read(&root.join(format!("patterns/freesewing/{draft}.json")), Some(&seam_file(seams))).unwrap();
        for seam in pattern.seams() {
            let [a, b] = seam.sides.map(|side| side.length(pattern.panels()));
            assert!((a / b - 1.0).abs() < 0.002, "{draft}, {}: {a} m to {b} m", seam.name);
        }
    }
}

#[test]
fn a_mesh_is_the_same_each_time() {
    let Some(root) = recordings::folder() else { return };
    let pattern = read(&root.join("patterns/garmentcode/dress_pencil_specification.json"), None).unwrap();
    assert_eq!(sew(&pattern, 0.025), sew(&pattern, 0.025));
}

/// Texts of every format, with their seam files.
fn texts() -> Vec<(String, Option<String>)> {
    let text = |path: &Path| std::fs::read_to_string(path).unwrap();
    let mut found: Vec<(String, Option<String>)> =
        shared().iter().map(|(path, seams)| (text(path), seams.as_deref().map(text))).collect();
    found.retain(|(text, _)| text.len() < 15_000);
    found
}

fn parsed((text, seams): &(String, Option<String>)) -> Result<Pattern, PatternError> {
    parse("pattern", text, seams.as_deref().map(|text| ("seams", text)))
}

/// What is refused says so in one line with a cure; what is not refused can be meshed or says why not.
fn survives(file: &(String, Option<String>)) {
    let message = match parsed(file) {
        Err(e) => e.to_string(),
        Ok(pattern) => match sew(&pattern, 0.05) {
            Ok(sewn) => {
                let finite = |p: &glam::DVec2| p.is_finite();
                assert!(sewn.panels.iter().flat_map(|p| &p.points).all(finite));
                return;
            }
            Err(e @ (TailorError::TooMany { .. } | TailorError::Narrow { .. } | TailorError::Folded { .. })) => {
                e.to_string()
            }
            Err(e) => panic!("the spacing is one: {e}"),
        },
    };
    assert!(message.contains(';') && !message.contains('\n'), "{message}");
}

#[test]
fn a_file_cut_short_is_an_error() {
    for file in texts().iter().filter(|(text, _)| text.len() < 10_000) {
        for end in (0..file.0.trim_end().len()).filter(|end| file.0.is_char_boundary(*end)) {
            let cut = (file.0[..end].to_owned(), file.1.clone());
            let message = parsed(&cut).unwrap_err().to_string();
            assert!(message.contains(';') && !message.contains('\n'), "{end}: {message}");
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 400, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn no_damaged_byte_is_a_panic(
        pick in any::<prop::sample::Index>(),
        damage in prop::collection::vec((any::<prop::sample::Index>(), 32u8..127), 1..6),
    ) {
        let files = texts();
        if !files.is_empty() {
            let (text, seams) = files[pick.index(files.len())].clone();
            let mut bytes = text.into_bytes();
            for (at, byte) in damage {
                let at = at.index(bytes.len());
                bytes[at] = byte;
            }
            survives(&(String::from_utf8_lossy(&bytes).into_owned(), seams));
        }
    }

    #[test]
    fn no_damaged_seam_file_is_a_panic(
        pick in any::<prop::sample::Index>(),
        damage in prop::collection::vec((any::<prop::sample::Index>(), 32u8..127), 1..4),
    ) {
        let mut files = texts();
        files.retain(|(_, seams)| seams.is_some());
        if !files.is_empty() {
            let (text, seams) = files[pick.index(files.len())].clone();
            let mut bytes = seams.unwrap_or_default().into_bytes();
            for (at, byte) in damage {
                let at = at.index(bytes.len());
                bytes[at] = byte;
            }
            survives(&(text, Some(String::from_utf8_lossy(&bytes).into_owned())));
        }
    }

    /// Numbers replaced by others, so that outlines cross, panels grow huge and seams lead nowhere.
    #[test]
    fn no_wrong_number_is_a_panic(
        pick in any::<prop::sample::Index>(),
        places in prop::collection::vec((any::<prop::sample::Index>(), prop_oneof![
            Just("0".to_owned()), Just("-1".to_owned()), Just("7".to_owned()), Just("1e300".to_owned()), Just("18446744073709551615".to_owned()),
            Just("null".to_owned()), Just("[]".to_owned()), (-500.0f64..500.0).prop_map(|x| format!("{x:.3}")),
        ]), 1..3),
    ) {
        let files = texts();
        if !files.is_empty() {
            let (text, seams) = files[pick.index(files.len())].clone();
            let mut words: Vec<String> = text.split_inclusive([',', '[', ']', ':', '\n']).map(str::to_owned).collect();
            for (place, value) in places {
                let number = |w: &String| w.trim_end_matches([',', ']', '\n', '\r']).trim().parse::<f64>().is_ok();
                let numbers: Vec<usize> = (0..words.len()).filter(|&i| number(&words[i])).collect();
                let word = &mut words[numbers[place.index(numbers.len())]];
                let end = word.trim_end_matches([',', ']', '\n', '\r']).len();
                *word = format!("{value}{}", &word[end..]);
            }
            survives(&(words.concat(), seams));
        }
    }
}
