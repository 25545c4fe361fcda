//! The page about scene files says what the program takes: every key, and scenes that can be run.

use toile_assets::scene_file::{SceneFile, SceneSource, schema};
use toile_bake::bake;
use toile_workspace::tree;

fn page() -> String {
    tree::read(&tree::root().join("docs/scene.md"))
}

#[test]
fn every_key_stands_in_the_page_as_the_schema_has_it() {
    let page = page();
    for key in schema::KEYS {
        assert!(page.contains(&key.row()), "docs/scene.md lacks the row of {}:\n{}", key.path(), key.row());
    }
    let reference = schema::reference();
    assert!(page.contains(reference.trim_end()), "the reference in docs/scene.md is out of date; it is:\n{reference}");
}

#[test]
fn every_scene_of_the_page_is_one() {
    let page = page();
    let blocks: Vec<&str> = page.split("```toml\n").skip(1).filter_map(|rest| rest.split("```").next()).collect();
    assert!(blocks.len() >= 2, "only {} scenes were found", blocks.len());
    for text in blocks {
        let scene =
            SceneFile::parse("docs/scene.md", text, SceneSource::Inside(&[])).unwrap_or_else(|e| panic!("{e}\n{text}"));
        assert!(scene.steps() > 0);
    }
}

#[test]
fn published_outfits_are_scenes_as_they_are() {
    let Some(data) = toile_workspace::recordings::folder() else { return };
    let outfits = data.join("garments/makehuman");
    for (file, vertices) in
        [("female_elegantsuit01", 2_205), ("female_sportsuit01", 1_797), ("male_casualsuit04", 1_696)]
    {
        // Decimetres, and faces of a strip drawn from the other side.
        let text = format!(
            "[garment]\nmesh = \"{file}.obj\"\nscale = 0.1\n[[garment.pin]]\nbox = [[-5, 0.3, -5], [5, 5, 5]]\n"
        );
        let scene = SceneFile::parse(file, &text, SceneSource::Folder(&outfits)).unwrap_or_else(|e| panic!("{e}"));
        let garment = &scene.garments[0];
        assert_eq!(garment.mesh.start.len(), vertices);
        let baked = bake(file, "one size", &garment.shape, &garment.fabric).unwrap_or_else(|e| panic!("{file}: {e}"));
        assert_eq!(baked.particles(), garment.shape.cut.len());
        assert!(baked.inverse_mass.iter().any(|w| *w > 0.0));
    }
}
