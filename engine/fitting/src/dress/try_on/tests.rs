//! Tests of the request.

use super::*;
use toile_track::tape_readings::TapeReadings;

#[test]
fn nobody_wears_forty_shirts() {
    let request = TryOn::of_shopper(&vec!["tee".to_owned(); 40], None, ShopperFacts::default());
    let refused = request.open().unwrap_err();
    assert!(
        matches!(&refused, FittingError::Input(text) if text.contains(&format!("at most {MAX_GARMENTS}"))),
        "{refused}"
    );
}

#[test]
fn recordings_of_old_are_read() {
    let old = r#"{"version":"0.3.0","session":"shopper (embedded)","sex":"female","measures":[1071141446,1052097214,
        1064081555,1061186543,1064975991],"garments":[["strap-dress","38"]],"quality":"shop"}"#;
    let request: TryOn = serde_json::from_str(old).unwrap();
    let Wearer::Body { sex: Sex::Female, measures } = request.wearer else { panic!("{request:?}") };
    assert_eq!(measures.stature.to_bits(), 1_071_141_446);
    assert_eq!(request.garments, [RequestedGarment::named("strap-dress", Some("38".into()))]);
    let text: String = old.chars().filter(|c| !c.is_whitespace()).collect();
    let again = serde_json::to_string(&request).unwrap().replace(' ', "");
    assert_eq!(again, text, "the keys are those of old");
    for wrong in [old.replace("female", "tall"), old.replace("shop\"", "best\""), old.replace("measures", "sizes")] {
        assert!(serde_json::from_str::<TryOn>(&wrong).is_err(), "{wrong}");
    }
}

#[test]
fn a_request_is_read_as_it_was_written() {
    let tape = TapeReadings::of(&["chest=912"]).unwrap();
    let shopper = ShopperFacts { sex: Some(Sex::Male), tape, clothed: false, ..ShopperFacts::default() };
    let mut request = TryOn::of_shopper(&["tee".to_owned()], None, shopper).in_quality(Quality::Fine);
    request.tuck.push("tee".into());
    let text = serde_json::to_string(&request).unwrap();
    assert_eq!(serde_json::from_str::<TryOn>(&text).unwrap(), request, "{text}");
    let refused = request.dress().unwrap_err();
    assert!(refused.to_string().contains("was not measured"), "{refused}");
}
