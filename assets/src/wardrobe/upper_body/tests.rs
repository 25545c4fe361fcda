use std::collections::BTreeMap;

use super::*;
use crate::wardrobe;
use toile_bake::shape::NO_VERTEX;
use toile_base::body::{Measures, Sex};

const GARMENTS: [&str; 2] = ["t-shirt", "jacket"];

#[test]
fn the_coarsest_mesh_that_a_file_may_ask_for_is_drafted() {
    let shopper = crate::body::build(Sex::Female, &Measures::average(Sex::Female)).unwrap();
    for name in GARMENTS {
        let style = Style { columns: 16, spacing_mm: 60.0, ..wardrobe::style(name).unwrap() };
        assert!(style.draft("M", &shopper).unwrap().faces.len() > 100, "{name}");
    }
}

/// Edges of a shape with the number of faces at each.
fn edges(shape: &Shape) -> BTreeMap<[u32; 2], usize> {
    let mut edges = BTreeMap::new();
    for face in &shape.faces {
        let ring: Vec<u32> = face.iter().copied().filter(|v| *v != NO_VERTEX).collect();
        for k in 0..ring.len() {
            let (a, b) = (ring[k], ring[(k + 1) % ring.len()]);
            *edges.entry([a.min(b), a.max(b)]).or_default() += 1;
        }
    }
    edges
}

#[test]
fn no_size_has_needles_or_gaps() {
    for (name, sex) in GARMENTS.iter().flat_map(|name| [(name, Sex::Female), (name, Sex::Male)]) {
        let style = wardrobe::style(name).unwrap();
        let spacing = style.spacing_mm * 1e-3;
        let shopper = crate::body::build(sex, &Measures::average(sex)).unwrap();
        for size in style.sizes().unwrap().codes() {
            let shape = style.draft(size, &shopper).unwrap();
            let length = |[a, b]: &[u32; 2]| shape.cut[*a as usize].distance(shape.cut[*b as usize]);
            let edges = edges(&shape);
            let shortest = edges.keys().map(length).fold(f32::MAX, f32::min);
            let longest = edges.keys().map(length).fold(0.0, f32::max);
            // Where the neckline turns up, columns are as steep as it is.
            assert!(
                shortest > 0.35 * spacing && longest < 5.5 * spacing,
                "{name} {sex:?} {size}: {shortest} {longest}"
            );
            assert!(edges.values().all(|faces| *faces <= 2), "{name} {sex:?} {size}: a seam of three faces");
        }
    }
}

#[test]
fn a_closed_garment_has_four_borders_and_an_open_one_three() {
    let shopper = crate::body::build(Sex::Female, &Measures::average(Sex::Female)).unwrap();
    // Neck, hem and both sleeves; where it is open, one border runs from the neck down one edge, along the hem and up again.
    for (name, wanted) in [("t-shirt", 4), ("jacket", 3)] {
        let shape = wardrobe::style(name).unwrap().draft("M", &shopper).unwrap();
        let mut next: BTreeMap<u32, Vec<u32>> = BTreeMap::new();
        for ([a, b], _) in edges(&shape).into_iter().filter(|(_, faces)| *faces == 1) {
            next.entry(a).or_default().push(b);
            next.entry(b).or_default().push(a);
        }
        assert!(next.values().all(|n| n.len() == 2), "{name}: borders meet");
        let mut borders = 0;
        while let Some((&first, _)) = next.first_key_value() {
            let mut open = vec![first];
            while let Some(v) = open.pop() {
                open.extend(next.remove(&v).unwrap_or_default());
            }
            borders += 1;
        }
        assert_eq!(borders, wanted, "{name}");
    }
}

#[test]
fn an_open_jacket_hangs_from_its_yoke_with_its_edges_free_and_apart() {
    let style = wardrobe::style("jacket").unwrap();
    for sex in [Sex::Female, Sex::Male] {
        let shopper = crate::body::build(sex, &Measures::average(sex)).unwrap();
        let shape = style.draft("M", &shopper).unwrap();
        let held: Vec<usize> = (0..shape.fixed.len()).filter(|&i| shape.fixed[i]).collect();
        assert!(held.len() * 10 < shape.fixed.len(), "{} of {} are held", held.len(), shape.fixed.len());
        assert!(held.iter().all(|&i| shape.worn[i].y > shopper.levels.chest), "held below the shoulders");
        // In front nothing crosses the middle, and what is nearest to it is free.
        let in_front = |i: usize| shape.worn[i].z > 0.0 && shape.worn[i].y < shopper.levels.chest;
        let nearest = (0..shape.worn.len()).filter(|&i| in_front(i)).map(|i| shape.worn[i].x.abs());
        let nearest = nearest.fold(f32::MAX, f32::min);
        assert!((0.02..0.06).contains(&nearest), "{sex:?}: edges {nearest} m from the middle");
        assert!(held.iter().all(|&i| shape.worn[i].z < 0.0 || shape.worn[i].x.abs() > 2.0 * nearest));
    }
}

#[test]
fn a_jacket_is_worn_over_a_t_shirt_and_reaches_the_wrists() {
    let shopper = crate::body::build(Sex::Female, &Measures::average(Sex::Female)).unwrap();
    let shape = wardrobe::style("jacket").unwrap().draft("M", &shopper).unwrap();
    let reach = shape.worn.iter().map(|p| p.x).fold(0.0, f32::max);
    let wrist = shopper.skeleton.at(Joint::LeftWrist).x;
    assert!((wrist - 0.03..wrist + 0.08).contains(&reach), "sleeve ends at {reach} m, the wrist at {wrist} m");
    assert!(shape.parts.contains(&Part::LeftArm) && shape.parts.contains(&Part::RightArm));
    assert!(shape.parts.contains(&Part::Hollow) && shape.parts.contains(&Part::Trunk));
}
