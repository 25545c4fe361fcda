//! Measures that shoppers took by tape: typed, refused with a reason, merged with the seen measures, removed, forgotten.

use super::*;
use crate::visitor::measure_entry::OwnMeasure;
use crate::visitor::model::NavigationKey;
use crate::visitor::screen::{Block, BodyView};

fn place(own: OwnMeasure) -> usize {
    OwnMeasure::ALL.into_iter().position(|o| o == own).unwrap()
}

/// A person whose hip was not seen, on the page of their own measures.
fn listed() -> Play {
    let mut play = Play::new();
    play.hide_hip();
    play.see(Some(1));
    play.wait(6_000);
    assert_eq!(play.page(), Page::Unmeasured);
    play.press(Action::Open(Page::OwnMeasures));
    play
}

/// Types a length into the page of a measure, from the list, and accepts it.
fn give(play: &mut Play, own: OwnMeasure, keys: &str) {
    play.press(Action::OwnMeasure(place(own)));
    for key in keys.chars() {
        play.press(if key == '.' { Action::Point } else { Action::Digit(key as u8 - b'0') });
    }
    play.press(Action::Accept);
}

fn words(play: &Play) -> String {
    texts_of(&play.screen()).join(" | ")
}

fn size(play: &Play) -> usize {
    play.model.visit.fit.as_ref().unwrap().size
}

#[test]
fn an_unseen_hip_is_typed_and_sizes_follow() {
    let mut play = listed();
    let dressed = |play: &Play| play.effects.iter().filter(|e| matches!(e, Effect::Dress { .. })).count();
    let (before, guessed) = (dressed(&play), play.model.known().unwrap().measured.measures);
    give(&mut play, OwnMeasure::Hip, "112.5");
    assert_eq!((play.page(), dressed(&play)), (Page::OwnMeasures, before + 1));
    let known = play.model.known().unwrap();
    assert!(known.missing.is_empty() && (known.measured.measures.hip_girth.unwrap().value - 1.125).abs() < 0.005);
    assert_eq!(known.measured.measures.stature.unwrap().value.round(), guessed.stature.unwrap().value.round());
    assert!(words(&play).contains("112.5 cm"), "{}", words(&play));
    play.wait(1_000);
    let wide = size(&play);
    play.press(Action::Back);
    assert_eq!(play.page(), Page::Fitting, "nothing is missing any more");
    // Removed again.
    play.press(Action::Open(Page::Settings));
    play.press(Action::Open(Page::OwnMeasures));
    play.press(Action::OwnMeasure(place(OwnMeasure::Hip)));
    play.press(Action::RemoveMeasure);
    assert!(play.model.visit.tape.is_empty() && play.model.known().unwrap().measured.measures.hip_girth.is_none());
    give(&mut play, OwnMeasure::Chest, "112");
    play.wait(1_000);
    assert!(size(&play) != wide || wide > 0);
    assert!(matches!(play.screen().body_view, BodyView::Shopper { fit: false, .. }));
}

#[test]
fn sizes_grow_with_the_chest_that_is_typed() {
    let with = |chest: &str| {
        let mut play = listed();
        give(&mut play, OwnMeasure::Chest, chest);
        play.wait(1_000);
        size(&play)
    };
    assert!(with("84") < with("100"));
}

#[test]
fn what_cannot_be_is_said_in_the_shoppers_language_and_nothing_is_lost() {
    let mut play = listed();
    give(&mut play, OwnMeasure::Chest, "92");
    for (own, keys, english) in [
        (OwnMeasure::Waist, "", "Type a length first"),
        (OwnMeasure::Waist, "7.4", "Please check the number and the unit"),
        (OwnMeasure::Underbust, "125", "does not go with your other measures"),
    ] {
        let effects = play.effects.len();
        give(&mut play, own, keys);
        assert_eq!((play.page(), play.effects.len()), (Page::MeasureEntry, effects), "{own:?}");
        assert!(words(&play).contains(english), "{}", words(&play));
        assert_eq!(play.model.visit.entry.as_ref().unwrap().typed(), keys, "what was typed stays");
        assert_eq!(play.model.visit.tape.given().count(), 1, "and so does what was accepted");
        for language in &Language::ALL[1..] {
            play.model.visit.language = *language;
            let said = words(&play);
            assert!(!said.contains("measure") && !said.contains("people"), "{}: {said}", language.tag());
        }
        play.model.visit.language = Language::English;
        play.press(Action::Back);
    }
    // The next key takes the sentence away.
    give(&mut play, OwnMeasure::Waist, "7.4");
    play.press(Action::DeleteDigit);
    assert_eq!(play.model.visit.entry.as_ref().unwrap().fault, None);
}

#[test]
fn lengths_are_those_of_the_unit_and_of_the_language() {
    let mut play = listed();
    play.press(Action::Unit);
    give(&mut play, OwnMeasure::Chest, "36.5");
    let chest = play.model.visit.tape.at(OwnMeasure::Chest.index()).unwrap();
    assert!((chest - 0.9271).abs() < 1e-4 && words(&play).contains("36.5 in"), "{chest} {}", words(&play));
    play.press(Action::Unit);
    assert!(words(&play).contains("92.7 cm"), "{}", words(&play));
    play.model.visit.language = Language::German;
    assert!(words(&play).contains("92,7 cm"), "{}", words(&play));
    play.press(Action::OwnMeasure(place(OwnMeasure::Waist)));
    play.press(Action::Digit(7));
    play.press(Action::Point);
    let entry =
        play.screen().blocks.into_iter().find_map(|b| if let Block::Entry { text } = b { Some(text) } else { None });
    assert_eq!(entry.unwrap(), "7, cm");
}

#[test]
fn a_measure_can_be_given_by_keys_alone() {
    let mut play = listed();
    let go = |play: &mut Play, action: Action| {
        let at = play.screen().controls.iter().position(|c| c.action == action).unwrap();
        while play.screen().focus != at {
            play.update(Input::Key(NavigationKey::Tab));
        }
        play.update(Input::Key(NavigationKey::Enter));
    };
    go(&mut play, Action::OwnMeasure(place(OwnMeasure::Waist)));
    for digit in [7, 4] {
        go(&mut play, Action::Digit(digit));
    }
    go(&mut play, Action::Accept);
    assert!((play.model.visit.tape.at(OwnMeasure::Waist.index()).unwrap() - 0.74).abs() < 1e-5);
    // With the digits of a keyboard; Enter accepts.
    go(&mut play, Action::OwnMeasure(place(OwnMeasure::Neck)));
    for action in [Action::Digit(3), Action::Digit(9), Action::DeleteDigit, Action::Digit(6)] {
        play.update(Input::Typed(action));
    }
    play.update(Input::Key(NavigationKey::Enter));
    assert!((play.model.visit.tape.at(OwnMeasure::Neck.index()).unwrap() - 0.36).abs() < 1e-5);
    play.update(Input::Typed(Action::Digit(1)));
    assert_eq!(play.page(), Page::OwnMeasures, "no keypad, no key");
}

#[test]
fn who_is_measured_again_keeps_what_they_took_by_tape_and_who_leaves_leaves_nothing() {
    let mut play = listed();
    give(&mut play, OwnMeasure::Hip, "104.3");
    play.press(Action::Back);
    play.press(Action::Open(Page::Settings));
    play.press(Action::Measure);
    play.wait(8_000);
    assert!((play.model.known().unwrap().measured.measures.hip_girth.unwrap().value - 1.043).abs() < 0.005);
    play.press(Action::Open(Page::Settings));
    play.press(Action::Open(Page::OwnMeasures));
    play.press(Action::OwnMeasure(0));
    play.press(Action::Digit(9));
    play.see(None);
    play.wait(20_000);
    let left = format!("{:?}", play.model);
    assert!(!left.contains("1.043") && play.model.visit.entry.is_none() && play.model.visit.tape.is_empty(), "{left}");
}

#[test]
fn an_unseen_zone_has_no_feel_and_no_colour() {
    let mut play = Play::new();
    play.hide_hip();
    play.see(Some(1));
    play.wait(6_000);
    play.press(Action::Back);
    assert_eq!(play.page(), Page::Fitting);
    let offered = |play: &Play| play.screen().controls.iter().any(|c| c.action == Action::Open(Page::OwnMeasures));
    assert!(offered(&play));
    assert!(words(&play).contains("Hip: not seen, so how it fits is not known"), "{}", words(&play));
    let marks = |play: &Play| -> Vec<bool> {
        let marks = play.screen().blocks.into_iter();
        marks
            .filter_map(|b| if let Block::Fit { tightness, .. } = b { Some(tightness.is_some()) } else { None })
            .collect()
    };
    assert_eq!(marks(&play).iter().filter(|known| !**known).count(), 1);
    play.press(Action::Open(Page::Zones));
    assert!(offered(&play));
    let BodyView::Shopper { fit: true, unknown, .. } = play.screen().body_view else { panic!() };
    assert_eq!(unknown, [false, false, true]);
    let hip = play.model.visit.fit.as_ref().unwrap().zones.iter().position(|z| z.feel.is_none()).unwrap();
    play.press(Action::Zone(hip));
    assert!(offered(&play));
    play.press(Action::Open(Page::OwnMeasures));
    give(&mut play, OwnMeasure::Hip, "98");
    play.wait(1_000);
    play.press(Action::Back);
    assert_eq!(play.page(), Page::Zone);
    assert!(!words(&play).contains("not known"), "{}", words(&play));
    let BodyView::Shopper { unknown, .. } = play.screen().body_view else { panic!() };
    assert_eq!(unknown, [false; 3]);
}
