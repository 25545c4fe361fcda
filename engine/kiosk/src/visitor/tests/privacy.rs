//! No data of a person is left after they have left.

use super::*;
use crate::visitor::picture::encode;

/// Every number of what was measured, as debug texts write it.
fn numbers(known: &VisitorMeasures) -> Vec<String> {
    let taken = known.measured.measures.named();
    taken.iter().flat_map(|m| m.1).flat_map(|e| [format!("{:?}", e.value), format!("{:?}", e.sigma)]).collect()
}

#[test]
fn of_who_has_left_no_measure_is_left_in_the_machine() {
    for by_hand in [true, false] {
        let mut play = Play::new();
        // Measures that no table and no rule has.
        play.known = woman(0.901_234, 0.738_123, 0.980_321);
        let m = &mut play.known.measured.measures;
        let taken = [&mut m.stature, &mut m.shoulder_breadth, &mut m.chest_girth, &mut m.waist_girth, &mut m.hip_girth];
        for (i, e) in taken.into_iter().chain([&mut m.inseam, &mut m.arm_length]).flatten().enumerate() {
            (e.value, e.sigma) = (e.value + 0.000_071, 0.010_123 + 0.001 * i as f32);
        }
        play.known = VisitorMeasures::new(play.known.measured.clone(), false);
        let fresh = format!("{:?}", play.model.visit);
        play.see(Some(1));
        play.wait(6_000);
        play.press(Action::Open(Page::Compare));
        play.wait(1_000);
        play.press(Action::Back);
        play.press(Action::Open(Page::Settings));
        play.press(Action::Language(1));
        play.press(Action::LargeType);
        play.press(Action::Back);
        // A measure that they took by tape.
        play.press(Action::Open(Page::Settings));
        play.press(Action::Open(Page::OwnMeasures));
        play.press(Action::OwnMeasure(8));
        [3, 7].into_iter().for_each(|digit| play.press(Action::Digit(digit)));
        play.press(Action::Point);
        play.press(Action::Digit(4));
        play.press(Action::Accept);
        assert_eq!(play.model.visit.tape.given().count(), 1);
        play.wait(1_000);
        play.press(Action::Back);
        play.press(Action::Back);
        play.press(Action::TakePicture);
        play.wait(800);
        let before = format!("{:?}", play.model);
        // As the camera saw them, as they follow from the tape, and the tape's own.
        let mut numbers_known = numbers(&play.known);
        numbers_known.extend(numbers(play.model.known().unwrap()));
        numbers_known.extend(play.model.visit.tape.given().map(|(_, metres)| format!("{metres:?}")));
        assert!(numbers_known.iter().all(|n| before.contains(n)), "else the search finds nothing: {numbers_known:?}");
        if by_hand {
            play.press(Action::Back);
            play.press(Action::Leave);
        } else {
            play.see(None);
            play.wait(20_000);
        }
        let after = format!("{:?}", play.model);
        for number in &numbers_known {
            assert!(!after.contains(number), "{number} is left: {after}");
        }
        assert_eq!(format!("{:?}", play.model.visit), fresh, "nor is anything else: language, type, clothes");
        assert!(play.effects.contains(&Effect::Forget));
    }
}

#[test]
fn of_a_page_only_its_words_are_left_when_another_is_shown() {
    let mut play = Play::dressed();
    play.press(Action::Leave);
    let words = texts_of(&play.screen()).join(" ");
    assert!(!words.contains("cm") && !words.contains("Size"), "{words}");
}

#[test]
fn a_picture_is_in_no_debug_text() {
    let code = encode(&still()).unwrap();
    let message = format!("{code:?}");
    assert!(message.contains("side") && !message.contains("true") && message.len() < 60, "{message}");
}
