//! A turn before the display: offered where there is depth, taken up only by turning, and never waited for.

use std::f32::consts::TAU;

use super::*;
use crate::visitor::screen::Block;
use crate::visitor::size_fit::tests::woman;

/// Until measuring has begun.
fn measuring() -> Play {
    let mut play = Play::new();
    play.face(0.0);
    while play.page() != Page::Measuring {
        play.wait(20);
    }
    play
}

/// Turns by a way (rad) within so many seconds.
fn turn(play: &mut Play, way: f32, seconds: f32) {
    let steps = (seconds * 50.0) as u32;
    for i in 1..=steps {
        play.face(way * i as f32 / steps as f32);
        play.wait(20);
    }
}

fn guide(play: &Play) -> Option<usize> {
    play.screen().blocks.iter().find_map(|b| match b {
        Block::TurnGuide { seen, .. } => Some(seen.iter().filter(|s| **s).count()),
        _ => None,
    })
}

fn measured(play: &Play) -> [usize; 2] {
    let count = |is: fn(&Effect) -> bool| play.effects.iter().filter(|e| is(e)).count();
    [count(|e| matches!(e, Effect::Measure { .. })), count(|e| matches!(e, Effect::MeasureTurn { .. }))]
}

#[test]
fn who_stands_still_has_their_answer_as_soon_as_who_is_offered_no_turn() {
    let until = |mut play: Play| {
        while play.page() != Page::Fitting {
            play.wait(20);
        }
        (play.now, measured(&play))
    };
    let mut plain = Play::new();
    plain.see(Some(1));
    let offered = measuring();
    assert_eq!(guide(&offered), Some(1), "the offer stands on the page");
    let (plain, offered) = (until(plain), until(offered));
    assert_eq!(plain, offered);
    assert_eq!(offered.1, [1, 0]);
}

#[test]
fn who_turns_is_measured_from_all_sides_and_dressed_in_that() {
    let mut play = measuring();
    play.face(0.0);
    play.wait(400);
    turn(&mut play, TAU, 6.0);
    assert_eq!(measured(&play), [1, 1]);
    play.known = woman(0.95, 0.80, 1.03);
    play.wait(4_000);
    assert_eq!(play.page(), Page::Fitting);
    assert!(play.model.known().is_some() && play.model.visit.turn.is_none() && play.model.visit.front.is_none());
}

#[test]
fn the_ring_fills_while_they_turn_and_who_stops_gets_what_was_seen_from_the_front() {
    let mut play = measuring();
    play.face(0.0);
    turn(&mut play, 0.4 * TAU, 2.4);
    assert_eq!(play.page(), Page::Measuring, "who turns is waited for");
    let seen = guide(&play).unwrap();
    assert!((13..=16).contains(&seen), "{seen} of 36 sides");
    assert!(texts_of(&play.screen()).contains(&"Keep turning, slowly.".to_owned()));
    play.wait(2_200);
    assert_eq!(measured(&play), [1, 0]);
    play.wait(1_000);
    assert_eq!(play.page(), Page::Fitting);
    assert!(play.model.visit.front.is_none());
}

#[test]
fn a_turn_that_begins_while_the_clothes_are_put_on_is_measured_too() {
    let mut play = measuring();
    play.face(0.0);
    // The front is measured; the clothes are being put on.
    play.wait(800);
    assert!(play.model.visit.dressing.is_some());
    // It cannot be measured: what was seen from the front counts.
    play.fails = true;
    turn(&mut play, 0.8 * TAU, 4.8);
    assert_eq!((measured(&play), play.page()), ([1, 1], Page::Measuring));
    play.fails = false;
    play.wait(3_000);
    assert_eq!(play.page(), Page::Fitting);
    assert!(play.model.known().is_some() && play.model.visit.front.is_none());
}

#[test]
fn no_turn_is_offered_to_who_sits_nor_where_there_is_no_depth() {
    let mut play = Play::new();
    play.face(0.0);
    play.wait(600);
    play.press(Action::Seated);
    while play.page() != Page::Measuring {
        play.wait(20);
    }
    assert_eq!(guide(&play), None);
    let mut play = Play::new();
    play.see(Some(1));
    while play.page() != Page::Measuring {
        play.wait(20);
    }
    assert_eq!(guide(&play), None);
}

#[test]
fn another_person_ends_a_turn_and_leaves_nothing() {
    let mut play = measuring();
    play.face(0.0);
    turn(&mut play, 0.3 * TAU, 1.8);
    play.press(Action::Leave);
    assert!(play.model.visit.turn.is_none() && play.model.visit.front.is_none());
    let mut play = measuring();
    play.face(0.0);
    turn(&mut play, 0.3 * TAU, 1.8);
    play.see(Some(2));
    play.wait(1_100);
    assert_eq!(play.page(), Page::Second);
    assert!(play.model.visit.turn.is_none() && play.model.visit.front.is_none());
}
