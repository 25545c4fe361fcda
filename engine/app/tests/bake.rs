//! `toile bake` as a user or a script meets it.

use std::fs;

use crate::common::{Scratch, sentence, stdout};
use serde_json::Value;

#[test]
fn bake_reports_what_a_garment_becomes() {
    let scratch = Scratch::new("bake");
    let output = scratch.toile(&["bake", "strap-dress", "--size", "40", "--fabric", "cotton-jersey", "--json"]);
    assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
    assert!(output.stderr.is_empty());
    let json: Value = serde_json::from_str(&stdout(&output)).expect("stdout is exactly one JSON object");
    assert_eq!((&json["schema"], &json["garment"]), (&"toile.bake/1".into(), &"strap-dress".into()));
    assert_eq!((&json["size"], &json["fabric"]), (&"40".into(), &"cotton-jersey".into()));
    let number = |key: &str| json.pointer(key).and_then(Value::as_f64).unwrap_or_else(|| panic!("{key}: {json}"));
    let covered: f64 = ["warp", "weft", "hoops", "bias", "loose"].map(|k| number(&format!("/edges/{k}"))).iter().sum();
    assert_eq!(covered, number("/edges/all"));
    assert_eq!(number("/vertices"), number("/fixed") + number("/hanging/free"));
    for key in ["/tethers", "/stencils/warp", "/stencils/weft", "/bytes", "/bake_ms", "/substeps", "/fibers/longest"] {
        assert!(number(key) > 0.0, "{key}");
    }
    assert_eq!(json["solvers"][0]["solver"], "semi-implicit");
    assert_eq!(json["warnings"].as_array().map(Vec::len), Some(0), "{}", json["warnings"]);

    let output = scratch.toile(&["bake", "strap-dress"]);
    assert_eq!(output.status.code(), Some(0));
    let text = stdout(&output);
    assert!(text.contains("strap-dress, size") && text.contains("down the warp") && !text.contains('\x1b'), "{text}");
}

#[test]
fn bake_tells_what_is_wrong_with_a_mesh_of_the_users() {
    let scratch = Scratch::new("bake-mesh");
    let folder = scratch.path();
    // Two strips of cloth, one of them sewn to nothing: its material says that it moves.
    let mut text = String::from("o strips\n");
    for (x, top) in [(-0.2, 1.0), (0.15, 0.9)] {
        for row in 0..5 {
            text += &format!("v {x} {y} 0.1\nv {} {y} 0.1\n", x + 0.05, y = top - 0.05 * f64::from(row));
        }
    }
    for (material, first) in [("Band", 1), ("ClothFree", 3), ("ClothFree", 5), ("ClothFree", 7)] {
        text += &format!("usemtl {material}\nf {} {} {} {first}\n", first + 2, first + 3, first + 1);
    }
    for first in [11, 13, 15, 17] {
        text += &format!("f {} {} {} {first}\n", first + 2, first + 3, first + 1);
    }
    fs::write(folder.join("strips.obj"), text).unwrap();
    let output = scratch.toile(&["bake", "strips.obj", "--json"]);
    assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
    let json: Value = serde_json::from_str(&stdout(&output)).unwrap();
    assert_eq!((&json["vertices"], &json["fixed"], &json["tethers"]), (&20.into(), &4.into(), &6.into()));
    assert!(json["warnings"][0].as_str().unwrap().contains("10 vertices are sewn to nothing"), "{json}");

    fs::write(folder.join("wool.toml"), "name = 'wool'\n").unwrap();
    fs::write(folder.join("line.obj"), "v 0 0 0\nv 0 1 0\nv 0 2 0\nf 1 2 3\n").unwrap();
    let refused: [(&[&str], &str); 7] = [
        (&["bake", "crinoline"], "strap-dress"),
        (&["bake", "absent.obj"], "absent.obj"),
        (&["bake", "line.obj"], "no person stands in it"),
        (&["bake", "strap-dress", "--size", "999"], "999"),
        (&["bake", "strips.obj", "--size", "40"], "leave the size out"),
        (&["bake", "strap-dress", "--fabric", "tin"], "toile fabric list"),
        (&["bake", "strap-dress", "--fabric", "wool.toml"], "wool.toml"),
    ];
    for (line, word) in refused {
        let output = scratch.toile(line);
        assert_eq!(output.status.code(), Some(4), "{line:?}");
        assert!(output.stdout.is_empty(), "{line:?}");
        let message = sentence(&output);
        assert!(message.contains(word) && message.contains("; "), "{line:?}: {message}");
    }
}
