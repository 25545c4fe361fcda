//! The tables of FreeSewing's bodies against the measurements that they were made from.

use toile_assets::sizes::SizeTable;

use crate::recordings;

#[test]
fn every_freesewing_body_lies_in_the_middle_of_its_size() {
    let Some(root) = recordings::folder() else { return };
    let text = std::fs::read_to_string(root.join("patterns/freesewing/models-measurements.json")).unwrap();
    let bodies: serde_json::Value = serde_json::from_str(&text).unwrap();
    let mut seen = 0;
    for (name, body) in bodies["sets"].as_object().unwrap() {
        let (sex, code) = name.rsplit_once("Adult").unwrap();
        let table =
            SizeTable::embedded(if sex == "cisFemale" { "freesewing-women" } else { "freesewing-men" }).unwrap();
        let size = table.size_body(code).unwrap();
        for (key, girth) in [("chest", size.chest_girth), ("waist", size.waist_girth), ("seat", size.hip_girth)] {
            let wanted = body[key].as_f64().unwrap() as f32 / 1000.0;
            // Ranges that meet halfway have their middle at the body only where the steps are equal: to 1 mm they are.
            assert!((girth - wanted).abs() < 0.001, "{name} {key}: {girth} m, not {wanted} m");
        }
        let shoulder =
            (body["hpsToWaistBack"].as_f64().unwrap() + body["waistToFloor"].as_f64().unwrap()) as f32 / 1000.0;
        assert!((1.15..1.175).contains(&(size.stature / shoulder)), "{name}: {} m", size.stature);
        seen += 1;
    }
    assert_eq!(seen, 20);
}
