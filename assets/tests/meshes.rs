//! Meshes by others, from their files to shapes on a shopper.

use std::path::PathBuf;

use toile_assets::adapt::report::Behaviour;
use toile_assets::adapt::{OwnMesh, PieceReport};
use toile_assets::body::{Body, Measures, Sex};

#[path = "../../tests/src/recordings.rs"]
mod recordings;

const OUTFITS: [&str; 3] = ["female_elegantsuit01", "female_sportsuit01", "male_casualsuit04"];

fn outfit(name: &str) -> Option<PathBuf> {
    Some(recordings::folder()?.join("garments/makehuman").join(name).with_extension("obj"))
}

/// The shopper of the embedded session.
fn shopper(sex: Sex) -> Body {
    let measures =
        Measures { stature: 1.698, shoulder_breadth: 0.372, chest_girth: 0.902, waist_girth: 0.745, hip_girth: 0.978 };
    Body::build(sex, &measures).unwrap()
}

#[test]
fn outfits_by_others_lie_on_a_shopper() {
    for name in OUTFITS {
        let Some(file) = outfit(name) else { return };
        let start = std::time::Instant::now();
        let own = OwnMesh::read(&file).unwrap();
        let read = start.elapsed();
        let worn = own.wear(&shopper(own.sex.unwrap()));
        println!("{name}: read in {read:?}, worn after {:?}", start.elapsed());
        worn.report.lines().iter().for_each(|line| println!("  {line}"));
        for PieceReport { vertex, start_strain, behaviour, .. } in &worn.report.pieces {
            println!("  vertex {vertex}: {start_strain}");
            assert_ne!(*behaviour, Behaviour::Rigid);
        }
    }
}
