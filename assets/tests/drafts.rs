//! Garments that we draft ourselves, sewn up around the bodies of their sizes: that they hang as what they are.

use glam::Vec3;
use toile_assets::drafting;
use toile_assets::draping::{DrapedPattern, PatternPackage};
use toile_base::body::{Body, Measures, Sex};
use toile_base::garment::gather::WIDENS_M;
use toile_base::garment::tuck::SLIPS_M;
use toile_base::garment::{Garment, Tuck};
use toile_base::skeleton::Joint;

/// Strain of all but one in a hundred edges (1): trousers reach it at the crotch.
const STRAIN_P99: f32 = 0.06;

/// Widest gap of a seam before its sides are merged (m).
const OPEN_M: f64 = 0.04;

fn hung(name: &str, size: &str) -> (PatternPackage, Body, DrapedPattern) {
    let package = drafting::package(name).unwrap();
    let body = package.body_of(size).unwrap().unwrap();
    let pattern = package.sized(size, &body.measures).unwrap();
    let draped = package.drape(&pattern, &body, &toile_assets::fabric::built_in(&package.fabric).unwrap()).unwrap();
    let quality = draped.quality;
    assert!(quality.strain_p99 < STRAIN_P99.into() && quality.strain_mean < 0.01, "{name} {size}: {quality:?}");
    // An edge or two of the largest scarf lie in the neck's hollow.
    assert!(quality.crossings <= 4 && quality.penetration == 0.0, "{name} {size}: {quality:?}");
    assert!(quality.seams_open < OPEN_M, "{name} {size}: {quality:?}");
    (package, body, draped)
}

/// The highest and the lowest point.
fn ends(draped: &DrapedPattern) -> [f32; 2] {
    let heights = draped.at.iter().map(|p| p.y);
    [heights.clone().fold(f32::MIN, f32::max), heights.fold(f32::MAX, f32::min)]
}

/// Positions of a panel's points.
fn of(package: &PatternPackage, draped: &DrapedPattern, panel: &str) -> Vec<Vec3> {
    let pattern = package.parse().unwrap();
    let index = pattern.panels().iter().position(|p| p.name == panel).unwrap();
    draped.sewn.number[index].iter().map(|v| draped.at[*v as usize]).collect()
}

#[test]
fn a_tee_lies_on_the_shoulders_and_its_sleeves_around_the_arms() {
    for (name, size) in [("tee", "38"), ("shirt", "44"), ("mens-jumper", "M")] {
        let (package, body, draped) = hung(name, size);
        let [top, low] = ends(&draped);
        assert!(top > body.levels.shoulder && top < body.levels.neck + 0.08, "{name}: its neck is at {top}");
        assert!(low < body.levels.waist - 0.1 && low > body.levels.crotch - 0.1, "{name}: its hem is at {low}");
        let [shoulder, elbow] = [Joint::LeftShoulder, Joint::LeftElbow].map(|j| body.skeleton.at(j));
        let along = (elbow - shoulder).normalize();
        let sleeve = of(&package, &draped, "left sleeve");
        let upper: Vec<&Vec3> = sleeve.iter().filter(|p| (0.1..0.2).contains(&(**p - shoulder).dot(along))).collect();
        // All around the bone, at no great distance from it.
        let off = |p: &Vec3| *p - shoulder - along * (*p - shoulder).dot(along);
        assert!(upper.len() > 30 && upper.iter().all(|p| off(p).length() < 0.16), "{name}");
        for side in [Vec3::Z, Vec3::NEG_Z, Vec3::Y, Vec3::NEG_Y] {
            assert!(upper.iter().any(|p| off(p).dot(side) > 0.02), "{name}: nothing towards {side}");
        }
    }
}

#[test]
fn a_waistband_sits_at_the_waist() {
    for (name, size, hem) in
        [("straight-skirt", "32", 0.08), ("circle-skirt", "44", 0.2), ("straight-trousers", "38", -0.35)]
    {
        let (package, body, draped) = hung(name, size);
        let band = of(&package, &draped, "front band");
        let top = band.iter().map(|p| p.y).fold(f32::MIN, f32::max);
        assert!((top - body.levels.waist).abs() < 0.03, "{name}: {top} at a waist of {}", body.levels.waist);
        let [_, low] = ends(&draped);
        assert!((low - body.levels.knee - hem).abs() < 0.1, "{name}: its hem is at {low}");
    }
}

/// Between two drafts a tee's back was once taken for a sector of a ring, and a skirt's corner wound around the body.
#[test]
fn sizes_between_two_drafts_hang_as_the_drafts_do() {
    for (name, size) in [("tee", "40"), ("circle-skirt", "40"), ("circle-skirt", "46"), ("mens-shorts", "80")] {
        let _ = hung(name, size);
    }
}

#[test]
fn a_jacket_bakes_in_its_layer() {
    let (package, body, _) = hung("mens-blazer", "L");
    let garment = package.dress("L", &body).unwrap();
    assert!(garment.layer == 4 && garment.particles() > 2_000 && garment.fixed.len() > 10);
}

/// Held by the skin its part on the shoulders went through a shirt, and drew the shirt's back up.
#[test]
fn a_scarf_lies_around_the_neck_and_is_held_by_nothing() {
    for size in ["XXS", "M", "3XL"] {
        let (package, body, draped) = hung("scarf", size);
        let mean = |panel: &str| {
            let at = of(&package, &draped, panel);
            at.iter().sum::<Vec3>() / at.len() as f32
        };
        let neck = body.skeleton.at(Joint::Neck);
        let [left, right, back] = ["left collar", "right collar", "back collar"].map(|panel| mean(panel) - neck);
        assert!(back.z < left.z.min(right.z) && left.x > right.x, "{size}: {left} {right} {back}");
        assert!(left.y.min(right.y).min(back.y) > body.levels.shoulder - neck.y, "{size}: {left} {right} {back}");
        let [left, right] = ["left front", "right front"]
            .map(|end| of(&package, &draped, end).iter().map(|p| p.y).fold(f32::MAX, f32::min));
        assert!(left < right - 0.04 && right < body.levels.chest, "{size}: its ends are at {left} and {right}");
        let garment = package.dress(size, &body).unwrap();
        assert!(garment.layer == 6 && garment.fixed.is_empty(), "{size}: {} are held", garment.fixed.len());
    }
}

#[test]
fn a_dress_comes_back_from_its_bytes() {
    let body = toile_assets::body::build(Sex::Female, &Measures::average(Sex::Female)).unwrap();
    let dress = drafting::package("strap-dress").unwrap().dress("38", &body).unwrap();
    assert_eq!(Garment::from_bytes(&dress.to_bytes()).unwrap(), dress);
}

#[test]
fn what_is_tucked_in_gets_the_width_at_which_it_lies_and_the_rest_keeps_its_own() {
    let shopper = toile_assets::body::build(Sex::Female, &Measures::average(Sex::Female)).unwrap();
    let shirt = drafting::package("tee").unwrap().dress("38", &shopper).unwrap();
    let mut same = shirt.clone();
    same.gather();
    assert_eq!(same, shirt, "nothing is tucked in");
    let band = shopper.levels.waist - 0.05;
    let mut tucked = shirt.clone();
    let particles: Box<[bool]> = shirt.start.iter().map(|p| p.y < band).collect();
    let free = |[a, b]: [u32; 2]| [a, b].iter().all(|&v| shirt.start[v as usize].y > band + SLIPS_M + WIDENS_M);
    tucked.start_mut().iter_mut().zip(&particles).filter(|(_, inside)| **inside).for_each(|(p, _)| {
        (p.x, p.z) = (0.8 * p.x, 0.8 * p.z);
    });
    tucked.set_tuck(Some(Tuck { into: 0, band, particles: particles.clone() })).unwrap();
    tucked.gather();
    // The shirt starts a little wider or narrower than it is cut, because this shopper is not of its size.
    let as_cut = |garment: &Garment| {
        let of = |within: bool| {
            let links = garment.hoop_edges.iter().filter(|(ends, _)| free(*ends) == within);
            links.map(|(_, rest)| *rest).sum::<f32>()
        };
        [of(false), of(true)]
    };
    let ([before, rest], [after, kept]) = (as_cut(&shirt), as_cut(&tucked));
    assert!((0.7..0.95).contains(&(after / before)) && rest == kept, "{before} {after} {rest} {kept}");
    // The layout has them too: as many links, each as long as before or shorter.
    let lengths = |garment: &Garment| {
        let mut all = Vec::new();
        let links = &garment.layout().weft;
        links.tuples.for_each(|at, ends| all.push((ends, links.rest[at], links.compliance[at])));
        all
    };
    let (old, new) = (lengths(&shirt), lengths(&tucked));
    assert_eq!(old.len(), new.len());
    for ((ends, was, soft), (same_ends, is, same_soft)) in old.into_iter().zip(new) {
        assert_eq!((ends, soft), (same_ends, same_soft));
        assert!(is <= was && (!free(ends) || is == was), "{ends:?}: {was} became {is}");
    }
}
