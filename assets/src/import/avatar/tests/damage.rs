//! Damage of every kind: an error, or a body that the engine can use, and never a panic.

use proptest::prelude::*;
use serde_json::{Value, json};

use super::super::{ImportOptions, ImportedBody, parse};
use super::{FILE, GltfEdit, alone};

/// A body from damaged bytes, if there is one, is one that the engine can use.
fn survives(bytes: &[u8]) {
    if let Ok(ImportedBody { body, .. }) =
        parse(bytes, &alone, &ImportOptions { allow_holes: true, ..ImportOptions::default() })
    {
        let count = body.mesh.positions.len();
        assert!(body.mesh.triangles.iter().flatten().all(|v| (*v as usize) < count));
        assert!(body.mesh.positions.iter().chain(&body.normals).all(|p| p.is_finite()));
        assert!(body.weights.iter().all(|w| (w.weights.iter().sum::<f32>() - 1.0).abs() < 1e-5));
        assert!(body.weights.iter().flat_map(|w| w.bones).all(|b| usize::from(b) < toile_base::skeleton::BONES));
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 256, failure_persistence: None, ..ProptestConfig::default() })]

    /// Bytes anywhere in the file.
    #[test]
    fn no_damaged_byte_is_a_panic(damage in prop::collection::vec((0.0f64..1.0, any::<u8>()), 1..8)) {
        let mut bytes = FILE.clone();
        for (place, byte) in damage {
            let at = (place * bytes.len() as f64) as usize;
            bytes[at] = byte;
        }
        survives(&bytes);
    }

    /// Bytes of the header and the description, where every one counts.
    #[test]
    fn no_damaged_description_is_a_panic(damage in prop::collection::vec((0usize..12_000, any::<u8>()), 1..4)) {
        let mut bytes = FILE.clone();
        let end = bytes.len();
        for (at, byte) in damage {
            bytes[at % end] = byte;
        }
        survives(&bytes);
    }

    /// Numbers of the description replaced by others.
    #[test]
    fn no_wrong_number_is_a_panic(pick in any::<prop::sample::Index>(), value in prop_oneof![
        Just(json!(0)), Just(json!(-1)), Just(json!(1)), Just(json!(u64::MAX)), Just(json!(1e300)), Just(json!(null)),
        Just(json!("x")), Just(json!([])), Just(json!({})), (0u64..70_000).prop_map(|n| json!(n)),
    ]) {
        let mut edit = GltfEdit::new();
        let places = numbers(&edit.json);
        *edit.json.pointer_mut(&places[pick.index(places.len())]).unwrap() = value;
        survives(&edit.bytes());
    }
}

/// Where the numbers of a description stand.
fn numbers(value: &Value) -> Vec<String> {
    match value {
        Value::Number(_) => vec![String::new()],
        Value::Array(all) => {
            let inner = |(i, v): (usize, &Value)| numbers(v).into_iter().map(move |p| format!("/{i}{p}"));
            all.iter().enumerate().flat_map(inner).collect()
        }
        Value::Object(all) => {
            let inner = |(k, v): (&String, &Value)| {
                let key = k.clone();
                numbers(v).into_iter().map(move |p| format!("/{key}{p}"))
            };
            all.iter().flat_map(inner).collect()
        }
        _ => Vec::new(),
    }
}
