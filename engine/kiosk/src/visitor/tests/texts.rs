//! The texts: all languages have the same keys, every key of the code exists, and no text falls back.

use std::collections::{BTreeMap, BTreeSet};

use fluent_syntax::ast::{Entry, Expression, InlineExpression, Pattern, PatternElement};
use fluent_syntax::parser::parse;

use super::*;
use crate::visitor::texts::{TextKey, TextValue};

/// The variables of each text of a language.
fn variables(language: Language) -> BTreeMap<String, BTreeSet<String>> {
    let parsed = parse(language.text()).unwrap_or_else(|(_, errors)| panic!("{}: {errors:?}", language.tag()));
    let mut all = BTreeMap::new();
    for entry in parsed.body {
        if let Entry::Message(message) = entry {
            assert!(message.attributes.is_empty());
            let mut found = BTreeSet::new();
            of_pattern(&message.value.expect("a text"), &mut found);
            let name = message.id.name.to_owned();
            assert!(all.insert(name.clone(), found).is_none(), "{}: {name} twice", language.tag());
        }
    }
    all
}

fn of_pattern(pattern: &Pattern<&str>, found: &mut BTreeSet<String>) {
    for element in &pattern.elements {
        let PatternElement::Placeable { expression } = element else { continue };
        match expression {
            Expression::Inline(inline) => of_inline(inline, found),
            Expression::Select { selector, variants } => {
                of_inline(selector, found);
                variants.iter().for_each(|v| of_pattern(&v.value, found));
            }
        }
    }
}

fn of_inline(inline: &InlineExpression<&str>, found: &mut BTreeSet<String>) {
    match inline {
        InlineExpression::VariableReference { id } => drop(found.insert(id.name.to_owned())),
        InlineExpression::StringLiteral { .. } | InlineExpression::NumberLiteral { .. } => {}
        other => panic!("no text refers to another or calls a function: {other:?}"),
    }
}

#[test]
fn every_language_has_every_text_with_the_same_variables() {
    let english = variables(Language::English);
    for language in Language::ALL {
        let other = variables(language);
        for (key, wanted) in &english {
            let found = other.get(key).unwrap_or_else(|| panic!("{} has no {key}", language.tag()));
            assert_eq!(found, wanted, "{} {key}", language.tag());
        }
        let more: Vec<&String> = other.keys().filter(|key| !english.contains_key(*key)).collect();
        assert!(more.is_empty(), "{} has {more:?}, which nobody says", language.tag());
    }
}

#[test]
fn every_word_of_the_code_is_in_the_texts_and_every_text_is_a_word_of_the_code() {
    let english = variables(Language::English);
    let keys: BTreeSet<&str> = TextKey::ALL.iter().map(|key| key.name()).collect();
    assert_eq!(keys, english.keys().map(String::as_str).collect());
    // And the code does say each of them.
    let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("src/visitor");
    let mut code = String::new();
    for folder in [folder.clone(), folder.join("pages")] {
        for file in std::fs::read_dir(folder).unwrap().flatten().map(|e| e.path()) {
            if file.extension().is_some_and(|e| e == "rs") && !file.ends_with("text_keys.rs") {
                code.push_str(&std::fs::read_to_string(file).unwrap());
            }
        }
    }
    for key in TextKey::ALL {
        assert!(code.contains(&format!("TextKey::{key:?}")), "nobody says {}", key.name());
    }
}

#[test]
fn no_text_is_that_of_another_language_but_for_names() {
    let text = |language: Language| -> BTreeMap<String, String> {
        let entries = language.text().split("\n\n").flat_map(|p| p.split('\n'));
        let pair = |line: &str| line.split_once(" = ").map(|(k, v)| (k.to_owned(), v.to_owned()));
        entries.filter_map(pair).collect()
    };
    let english = text(Language::English);
    for language in &Language::ALL[1..] {
        let other = text(*language);
        let same =
            |key: &&String| other.get(*key) == english.get(*key) && english[*key].chars().any(char::is_alphabetic);
        let same: Vec<&String> = english.keys().filter(same).collect();
        // Some words travel: a T-shirt, coral, a heading of variables alone.
        let travels = ["garment-tee", "colour-coral", "list-comma"];
        let untold: Vec<_> = same.iter().filter(|k| !travels.contains(&k.as_str())).collect();
        assert!(untold.len() <= 4, "{}: as in English: {untold:?}", language.tag());
    }
}

/// Whether words are whole: nothing is missing in them, and none is a key's name.
fn whole(text: &str) -> bool {
    !text.trim().is_empty()
        && !text.contains(['{', '}', '$'])
        && TextKey::ALL.iter().all(|key| text != key.name() || !text.contains('-'))
}

#[test]
fn every_page_speaks_every_language_whole() {
    let mut seen = BTreeSet::new();
    let mut look = |play: &mut Play| {
        seen.insert(play.page());
        for language in Language::ALL {
            play.model.visit.language = language;
            for text in texts_of(&play.screen()) {
                assert!(whole(&text), "{} on {:?}: {text:?}", language.tag(), play.page());
            }
        }
        play.model.visit.language = Language::English;
    };
    let mut play = Play::new();
    look(&mut play);
    play.see(Some(1));
    for _ in 0..30 {
        play.wait(200);
        look(&mut play);
    }
    for page in [Page::Garments, Page::Zones, Page::Compare, Page::Settings] {
        play.press(Action::Open(page));
        look(&mut play);
        if page == Page::Zones {
            play.press(Action::Zone(1));
            look(&mut play);
            play.press(Action::Back);
        }
        play.wait(1_000);
        look(&mut play);
        play.press(Action::Back);
    }
    for size in 0..play.model.wardrobe.items[play.model.visit.in_hand].sizes.len() {
        play.model.visit.outfit = play.model.with_size(size);
        play.model.take_in_hand(None);
        look(&mut play);
    }
    for outcome in 0..8 {
        play.picture_is(outcome);
        look(&mut play);
        play.press(Action::OwnPicture);
        look(&mut play);
        play.press(Action::OwnPicture);
    }
    play.offer_faces(Err(FaceTrouble::TooFar));
    look(&mut play);
    play.press(Action::Open(Page::Face));
    for face in [FaceTrouble::NoPicture, FaceTrouble::Unseen, FaceTrouble::Turned, FaceTrouble::Unlike].map(Err) {
        look(&mut play);
        play.press(Action::TakeFace);
        look(&mut play);
        play.wait(800);
        look(&mut play);
        play.face = face;
    }
    play.face = Ok(());
    play.press(Action::TakeFace);
    for _ in 0..2 {
        play.wait(800);
        look(&mut play);
    }
    play.press(Action::Back);
    play.press(Action::TakePicture);
    play.wait(1_000);
    look(&mut play);
    play.see(Some(2));
    play.wait(1_100);
    look(&mut play);
    let mut play = Play::dressed();
    play.see(None);
    play.wait(2_100);
    look(&mut play);
    let mut play = Play::new();
    play.fails = true;
    play.see(Some(1));
    play.wait(5_000);
    look(&mut play);
    play.known.missing = crate::visitor::size_fit::BodyPart::ALL.to_vec();
    play.fails = false;
    play.press(Action::Measure);
    play.wait(9_000);
    look(&mut play);
    // Measures by tape, typed, refused, accepted and listed.
    play.press(Action::Open(Page::OwnMeasures));
    look(&mut play);
    for keys in [&[][..], &[7], &[0, 9, 0]] {
        play.press(Action::OwnMeasure(1));
        look(&mut play);
        keys.iter().for_each(|digit| play.press(Action::Digit(*digit)));
        play.press(Action::Accept);
        look(&mut play);
        if play.page() == Page::MeasureEntry {
            play.press(Action::Back);
        }
    }
    play.press(Action::OwnMeasure(1));
    look(&mut play);
    assert_eq!(seen.len(), 16, "{seen:?}");
}

#[test]
fn numbers_and_plurals_are_those_of_the_language() {
    let texts = &*TEXTS;
    let ease = |language: Language| {
        let values = [
            ("zone", TextValue::Text("Z")),
            ("feel", TextValue::Text("F")),
            ("ease", TextValue::Number(1.25, 1)),
            ("sigma", TextValue::Number(0.5, 1)),
        ];
        texts.of(language).format(TextKey::FitEase, &values)
    };
    for language in Language::ALL {
        let (text, point) = (ease(language), matches!(language, Language::English | Language::Japanese));
        assert_eq!((text.contains("1.3"), text.contains("1,3")), (point, !point), "{text}");
        assert!(text.contains("cm"), "{text}");
    }
    let seconds =
        |language, count| texts.of(language).format(TextKey::LeavingSeconds, &[("seconds", TextValue::Count(count))]);
    assert_eq!(seconds(Language::English, 1), "In 1 second you are forgotten.");
    assert_eq!(seconds(Language::English, 2), "In 2 seconds you are forgotten.");
    for language in [Language::German, Language::French, Language::Spanish] {
        let [one, two] = [1, 2].map(|n| seconds(language, n));
        assert_ne!(one.replace('1', "2"), two, "{}", language.tag());
    }
    let minus = texts.of(Language::German).format(TextKey::ZoneGarment, &[("garment", TextValue::Number(-0.04, 1))]);
    assert!(minus.contains("0,0") && !minus.contains(['-', '\u{2212}']), "nothing is less than nothing: {minus}");
}

#[test]
fn what_is_said_of_a_zone_is_said_with_its_error() {
    let play = Play::dressed();
    let fits: Vec<String> = texts_of(&play.screen()).into_iter().filter(|t| t.contains('±')).collect();
    assert_eq!(fits.len(), 3, "{fits:?}");
    assert!(fits.iter().all(|t| t.contains("(+") && t.contains(" cm)")), "{fits:?}");
    println!("{}", fits.join("\n"));
}
