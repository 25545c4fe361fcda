//! Patterns by others, sewn up around a body: what is promised of every one, and what is refused.

use std::path::{Path, PathBuf};

use glam::Vec3;
use toile_assets::drafting;
use toile_assets::draping::{self, DrapeError, DrapedPattern, SkinField, drape, ease, read_package};
use toile_assets::import::pattern::{parse, read};
use toile_assets::pattern::{Panel, Pattern};
use toile_assets::sizes::{Girth, SizeTable};
use toile_bake::bake;
use toile_base::body::{Body, Measures, Sex};
use toile_base::fabric::Fabric;
use toile_base::garment::{Garment, Part};
use toile_base::skeleton::Joint;

use crate::recordings;

/// Spacing at which the rules are checked (m): coarse, so that a test takes seconds.
const SPACING: f64 = 0.03;

fn women(size: &str) -> Body {
    let table = SizeTable::embedded("women").unwrap();
    toile_assets::body::build(Sex::Female, &Measures::from(table.size_body(size).unwrap())).unwrap()
}

fn lawn() -> Fabric {
    toile_assets::fabric::built_in("cotton-lawn").unwrap()
}

fn aaron() -> Option<Pattern> {
    let draft = recordings::folder()?.join("patterns/freesewing/aaron-cisFemaleAdult34.json");
    let seams = Path::new(env!("CARGO_MANIFEST_DIR")).join("data/patterns/aaron.toml");
    Some(read(&draft, Some(&seams)).unwrap())
}

fn shared(name: &str) -> Option<PathBuf> {
    Some(recordings::folder()?.join("patterns").join(name))
}

/// A tube of two panels, `width` broad each and `height` high (cm), front and back.
fn tube(width: f64, height: f64) -> String {
    let panel = |z: f64, turn: f64| {
        format!(
            r#"{{"vertices": [[0,0],[{width},0],[{width},{height}],[0,{height}]], "translation": [{x}, 40, {z}],
            "rotation": [0, {turn}, 0], "edges": [{{"endpoints":[0,1]}},{{"endpoints":[1,2]}},{{"endpoints":[2,3]}},{{"endpoints":[3,0]}}]}}"#,
            x = if turn == 0.0 { -0.5 * width } else { 0.5 * width }
        )
    };
    format!(
        r#"{{"pattern": {{"panels": {{"front": {}, "back": {}}}, "stitches": [
        [{{"panel":"front","edge":1}},{{"panel":"back","edge":3}}], [{{"panel":"front","edge":3}},{{"panel":"back","edge":1}}]]}},
        "properties": {{"curvature_coords": "relative", "units_in_meter": 100}}}}"#,
        panel(25.0, 0.0),
        panel(-25.0, 180.0)
    )
}

fn check_rules(name: &str, pattern: &Pattern, body: &Body, draped: &DrapedPattern) {
    let quality = draped.quality;
    assert!(draped.at.iter().all(|p| p.is_finite()), "{name}");
    assert_eq!(quality.penetration, 0.0, "{name}");
    assert!(quality.strain_mean < 0.03, "{name}: {quality:?}");
    // Every panel hangs on its own side: what faces front before what faces back.
    let middle = |panel: usize| {
        let own = &draped.sewn.number[panel];
        own.iter().map(|v| draped.at[*v as usize]).sum::<Vec3>() / own.len() as f32
    };
    let place = |word: &str| pattern.panels().iter().position(|p| p.name.contains(word)).map(middle);
    if let (Some(front), Some(back)) = (place("front"), place("back")) {
        assert!(front.z > back.z + 0.05, "{name}: {front} {back}");
    }
    assert!(draped.at.iter().all(|p| p.y > -0.02 && p.y < body.measures.stature + 0.1), "{name}");
}

#[test]
fn a_tube_hangs_around_the_waist_with_the_girth_that_it_was_cut_with() {
    let body = women("38");
    let pattern = parse("tube", &tube(53.0, 40.0), None).unwrap();
    let draped = drape(&pattern, &body, &lawn(), 0.02).unwrap();
    check_rules("tube", &pattern, &body, &draped);
    assert!(draped.quality.strain_p99 < 0.06 && draped.quality.crossings == 0, "{:?}", draped.quality);
    // Its ease is the pattern's own: twice 530 mm less the waist.
    let zones = ease(&pattern, &body).unwrap().zones;
    let waist = zones.iter().find(|z| z.zone == Girth::Waist).unwrap();
    assert!((waist.pattern - 1.06).abs() < 1e-3, "{waist:?}");
    // The mesh bakes: rest lengths are those of the flat panels.
    let shape = draped.shape(&body, &SkinField::new(&body));
    let garment = bake("tube", "38", &shape, &lawn()).unwrap();
    let mass: f32 = garment.inverse_mass.iter().filter(|w| **w > 0.0).map(|w| w.recip()).sum();
    assert!(mass > 0.8 * 1.06 * 0.4 * lawn().density_kg_m2 && garment.fixed.len() > 10, "{mass}");
    let chord = garment.strain_edges.iter().map(|e| e.1).fold(0.0, f32::max);
    assert!(chord < 0.0205, "{chord}");
}

#[test]
fn the_same_pattern_hangs_to_the_same_bits() {
    let body = women("38");
    let pattern = parse("tube", &tube(53.0, 30.0), None).unwrap();
    let [a, b] = [0, 1].map(|_| drape(&pattern, &body, &lawn(), SPACING).unwrap());
    assert!(a.at.iter().zip(&b.at).all(|(p, q)| p.to_array().map(f32::to_bits) == q.to_array().map(f32::to_bits)));
}

#[test]
fn shared_patterns_hang_where_they_belong() {
    for (file, size) in [
        ("garment-pattern-generator/skirt_2_panels.json", "34"),
        ("garment-pattern-generator/tee.json", "32"),
        ("garment-pattern-generator/pants_straight_sides.json", "32"),
        ("garmentcode/hoody_mean_specification.json", "38"),
    ] {
        let Some(path) = shared(file) else { return };
        let (pattern, body) = (read(&path, None).unwrap(), women(size));
        let draped = drape(&pattern, &body, &lawn(), SPACING).unwrap();
        check_rules(file, &pattern, &body, &draped);
        let shape = draped.shape(&body, &SkinField::new(&body));
        bake(file, size, &shape, &lawn()).unwrap();
        assert!(shape.fixed.iter().any(|f| *f), "{file}: nothing holds it");
    }
}

#[test]
fn legs_stay_on_their_own_sides() {
    let Some(path) = shared("garment-pattern-generator/pants_straight_sides.json") else { return };
    let (pattern, body) = (read(&path, None).unwrap(), women("32"));
    let draped = drape(&pattern, &body, &lawn(), SPACING).unwrap();
    for (panel, number) in pattern.panels().iter().zip(&draped.sewn.number) {
        let left = panel.name.starts_with('L');
        // The seam of the crotch belongs to both legs.
        let is_left = |panel: u32| pattern.panels()[panel as usize].name.starts_with('L');
        let own = |v: &&u32| draped.sewn.members[**v as usize].iter().all(|m| is_left(m[0]) == left);
        let at = number.iter().filter(own).map(|v| draped.at[*v as usize]);
        let low = at.filter(|p| p.y < body.levels.crotch - 0.05);
        let wrong = low.filter(|p| (p.x > 0.0) != left).count();
        assert_eq!(wrong, 0, "{}", panel.name);
    }
}

#[test]
fn drafts_hang_by_the_sides_that_their_seam_file_names() {
    let Some(pattern) = aaron() else { return };
    let body = women("32");
    check_rules("aaron", &pattern, &body, &drape(&pattern, &body, &lawn(), SPACING).unwrap());
}

#[test]
fn what_cannot_hang_is_refused_in_one_sentence() {
    let body = women("38");
    let text = tube(53.0, 30.0);
    let loose = text.replace(
        &text[text.find("\"stitches\"").unwrap()..text.find("\"properties\"").unwrap()],
        "\"stitches\": []}, ",
    );
    let pattern = parse("loose", &loose, None).unwrap();
    assert_eq!(drape(&pattern, &body, &lawn(), SPACING).unwrap_err(), DrapeError::NoSeams);
    let small = parse("small", &tube(20.0, 30.0), None).unwrap();
    let refused = drape(&small, &body, &lawn(), SPACING).unwrap_err().to_string();
    assert!(refused.contains("stretched") || refused.contains("open"), "{refused}");
    assert!(!refused.contains('\n'));
    let fine = drape(&parse("tube", &text, None).unwrap(), &body, &lawn(), 0.001).unwrap_err().to_string();
    assert!(fine.contains("spacing"), "{fine}");
}

#[test]
fn a_package_keeps_what_it_is_made_of() {
    let folder = std::env::temp_dir().join(format!("toile-package-{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    let path = folder.join("tube.json");
    std::fs::write(&path, tube(53.0, 30.0)).unwrap();
    let mut package = read_package(&path, None).unwrap();
    assert_eq!((package.spacing_mm, package.fabric.as_str()), (draping::SPACING_MM, draping::FABRIC));
    package.spacing_mm = 30.0;
    let kept = folder.join("kept.json");
    std::fs::write(&kept, package.text()).unwrap();
    assert_eq!(read_package(&kept, None).unwrap(), package);
    let garment = package.dress(draping::AS_DRAFTED, &women("38")).unwrap();
    assert!(garment.particles() > 100 && garment.layer > 0);
    std::fs::write(&kept, package.text().replace("\"spacing_mm\": 30.0", "\"spacing_mm\": 900.0")).unwrap();
    assert!(read_package(&kept, None).unwrap_err().to_string().contains("spacing"));
    std::fs::write(&kept, package.text().replace("\"name\"", "\"nom\"")).unwrap();
    assert!(read_package(&kept, None).unwrap_err().to_string().contains("nom"));
    std::fs::remove_dir_all(&folder).unwrap();
}

/// A tube for size 38 in a package that also has one for 42.
fn tubes() -> draping::PatternPackage {
    let folder = std::env::temp_dir().join(format!("toile-sizes-{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    let path = folder.join("tube.json");
    std::fs::write(&path, tube(48.0, 30.0)).unwrap();
    let mut package = read_package(&path, None).unwrap();
    std::fs::remove_dir_all(&folder).unwrap();
    let larger = draping::SizedDraft { size: "42".into(), pattern: tube(54.0, 30.0), seams: None };
    let kind = toile_assets::sizes::GarmentKind::Skirt;
    let (table, size) = ("women".into(), "38".into());
    package.sizes = Some(draping::PatternSizes { table, kind, size, drafts: vec![larger], girths: Vec::new() });
    package
}

#[test]
fn a_pattern_is_graded_between_its_drafts() {
    let package = tubes();
    let graded = package.graded().unwrap().unwrap();
    let made = graded.made();
    assert_eq!(made.iter().map(|(code, _)| code.as_str()).collect::<Vec<_>>(), ["38", "40", "42"]);
    // Waists of 72, 76 and 80 cm: 40 lies in the middle, and a waist of 74 cm a quarter of the way.
    let around = |pattern: &Pattern| 2.0 * pattern.panels()[0].lengths()[0];
    let got: Vec<f64> = made.iter().map(|(_, pattern)| around(pattern)).collect();
    for (got, want) in got.into_iter().zip([0.96, 1.02, 1.08]) {
        assert!((got - want).abs() < 1e-9, "{got} {want}");
    }
    let body = Measures { waist_girth: 0.74, ..Measures::average(Sex::Female) };
    assert!((around(&graded.to_measure(&body)) - 0.99).abs() < 1e-6);
    let stout = Measures { waist_girth: 1.1, ..body };
    assert!((around(&graded.to_measure(&stout)) - 1.08).abs() < 1e-9);
}

#[test]
fn a_size_that_is_not_made_names_those_that_are() {
    let package = tubes();
    let body = women("38").measures;
    let told = package.sized("44", &body).unwrap_err().to_string();
    assert_eq!(told, "tube is not made in size 44; choose one of 38, 40, 42");
    let mut wrong = package.clone();
    wrong.sizes.as_mut().unwrap().size = "42".into();
    assert!(wrong.graded().unwrap_err().to_string().contains("two drafts for size 42"));
    wrong.sizes.as_mut().unwrap().table = "giants".into();
    assert!(wrong.graded().unwrap_err().to_string().contains("giants"));
    wrong.sizes = None;
    let told = wrong.sized("38", &body).unwrap_err().to_string();
    assert_eq!(told, "tube is not made in size 38; choose one of as drafted");
}

#[test]
fn what_a_garment_is_its_panels_say() {
    let Some(aaron) = aaron() else { return };
    let body = women("38");
    assert_eq!(ease(&aaron, &body).unwrap().kind.name(), "t-shirt");
    let skirt = parse("tube", &tube(48.0, 50.0), None).unwrap();
    assert_eq!(ease(&skirt, &body).unwrap().kind.name(), "skirt");
    for (file, kind) in [
        ("garment-pattern-generator/pants_straight_sides.json", "trousers"),
        ("garment-pattern-generator/dress_sleeveless.json", "dress"),
        ("garment-pattern-generator/jumpsuit_sleeveless.json", "dress"),
        ("garment-pattern-generator/tee.json", "t-shirt"),
        ("garment-pattern-generator/skirt_8_panels.json", "skirt"),
        ("garmentcode/dress_pencil_specification.json", "dress"),
        ("garmentcode/hoody_mean_specification.json", "t-shirt"),
    ] {
        let Some(path) = shared(file) else { return };
        assert_eq!(ease(&read(&path, None).unwrap(), &body).unwrap().kind.name(), kind, "{file}");
    }
}

/// A draft of FreeSewing's for one of its bodies.
fn drafted(name: &str, size: &str) -> Pattern {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR"));
    let draft = folder.join(format!("tests/data/freesewing/{name}{size}.json"));
    read(&draft, Some(&folder.join(format!("data/patterns/{name}.toml")))).unwrap()
}

#[test]
fn grading_meets_the_draft_that_it_has_not_seen() {
    // Sandy's waistband is 80 or 100 mm wide and nothing between, and its skirt makes up for that.
    for (name, table, [small, unseen, large], most) in [
        ("aaron", "freesewing-women", ["34", "38", "42"], 0.002),
        ("sandy", "freesewing-women", ["34", "38", "42"], 0.006),
        ("brian", "freesewing-men", ["36", "40", "44"], 0.002),
    ] {
        let table = SizeTable::embedded(table).unwrap();
        let girth = |size: &str| {
            let [low, high] =
                table.size(size).unwrap().range(if name == "sandy" { Girth::Waist } else { Girth::Chest });
            f64::from(low + high)
        };
        let t = (girth(unseen) - girth(small)) / (girth(large) - girth(small));
        let graded = drafted(name, small).between(&drafted(name, large), t).unwrap();
        let truth = drafted(name, unseen);
        let mut worst: f64 = 0.0;
        let in_steps = |panel: &&Panel| panel.name.contains("band");
        assert_eq!(graded.panels().iter().filter(in_steps).count(), usize::from(name == "sandy"));
        for (got, want) in graded.panels().iter().zip(truth.panels()).filter(|(got, _)| !in_steps(got)) {
            let lengths = got.lengths().into_iter().zip(want.lengths());
            worst = lengths.map(|(a, b)| (a - b).abs()).fold(worst, f64::max);
            let corners = got.edges.iter().zip(&want.edges).map(|(a, b)| (a.curve.start() - b.curve.start()).length());
            worst = corners.fold(worst, f64::max);
        }
        let moved =
            (drafted(name, small).panels()[0].lengths()[0] - drafted(name, large).panels()[0].lengths()[0]).abs();
        println!("{name}: {:.2} mm off, of {:.0} mm", worst * 1e3, moved * 1e3);
        assert!(worst < most, "{name}: {:.2} mm off", worst * 1e3);
    }
}

/// Positions of the vertices of a garment's mesh (m), in their order.
fn in_mesh_order(garment: &Garment) -> Vec<Vec3> {
    let mut at = vec![Vec3::ZERO; garment.particles()];
    garment.source.iter().zip(&garment.start).for_each(|(v, p)| at[*v as usize] = *p);
    at
}

#[test]
fn what_hangs_on_the_body_of_its_size_comes_over_to_another() {
    let package = drafting::package("pencil-skirt").unwrap();
    let hung = package.hang(None, "38").unwrap().expect("38 is a size of its table");
    for size in ["38", "40"] {
        let wearer = women(size);
        let carried = package.dress_from(&hung, &wearer).unwrap();
        let again = package.dress_from(&hung, &wearer).unwrap();
        assert_eq!(carried.start, again.start, "the same bits in every run");
        let sewn = package.dress("38", &wearer).unwrap();
        let (one, other) = (in_mesh_order(&carried), in_mesh_order(&sewn));
        let apart: Vec<f32> = one.iter().zip(&other).map(|(a, b)| a.distance(*b)).collect();
        let mean = apart.iter().sum::<f32>() / apart.len() as f32;
        let field = SkinField::new(&wearer);
        let deepest = one.iter().filter_map(|p| field.nearest(*p)).map(|p| p.distance).fold(0.0, f32::min);
        println!("38 on {size}: {:.1} mm apart in the mean, {:.2} mm in the skin", mean * 1e3, -deepest * 1e3);
        assert!(mean < 0.015, "38 on {size}: {mean} m apart");
        assert!(deepest > -1e-4, "38 on {size}: {deepest} m in the skin");
    }
    // A size that is in no table fits no body.
    let drafted = draping::AS_DRAFTED;
    assert!(package.hang(None, drafted).unwrap().is_none());
}

#[test]
fn what_lies_over_an_arm_is_not_carried_by_the_shoulder_and_meets_the_arm() {
    let wearer = women("40");
    let poncho = drafting::package("poncho").unwrap().dress("40", &wearer).unwrap();
    let tip = wearer.skeleton.at(Joint::LeftShoulder).x.abs();
    let farthest = poncho.fixed.iter().map(|i| poncho.start[*i as usize].x.abs()).fold(0.0, f32::max);
    assert!(farthest < tip + 0.02, "{farthest} m of a shoulder at {tip} m");
    let over = |i: &usize| poncho.start[*i].x.abs() > tip + 0.1 && poncho.start[*i].y > wearer.levels.waist;
    let over: Vec<usize> = (0..poncho.particles()).filter(over).collect();
    let meets = over.iter().filter(|i| poncho.parts[**i] == Part::All).count();
    assert!(over.len() > 100 && 10 * meets > 9 * over.len(), "{meets} of {}", over.len());
}
