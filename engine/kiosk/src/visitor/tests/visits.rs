//! Visits: one shopper, another person, an empty view, and the pages in between.

use std::net::{Ipv4Addr, SocketAddr};

use super::*;
use crate::service::session::SessionState;
use crate::visitor::model::NavigationKey;
use crate::visitor::picture_link::PictureServer;
use crate::visitor::screen::{Block, BodyView, ControlStyle};
use crate::visitor::texts::TextKey;
use toile_track::gesture::Gesture;

/// Every page that a visitor can come to.
const ALL: [Page; 15] = [
    Page::Attract,
    Page::Guide,
    Page::Measuring,
    Page::Unmeasured,
    Page::Fitting,
    Page::Garments,
    Page::Zones,
    Page::Zone,
    Page::Compare,
    Page::Picture,
    Page::OwnMeasures,
    Page::MeasureEntry,
    Page::Settings,
    Page::Second,
    Page::Leaving,
];

#[test]
fn a_visit_by_touch_ends_where_it_began() {
    let mut play = Play::dressed();
    let trousers = play.model.wardrobe.find("wide-leg-trousers").unwrap();
    let shirt = play.model.wardrobe.find("tee").unwrap();
    play.press(Action::Open(Page::Garments));
    play.press(Action::Garment(trousers));
    play.press(Action::Garment(shirt));
    assert_eq!(play.model.visit.outfit.iter().map(|w| w.item).collect::<Vec<_>>(), [trousers, shirt]);
    play.press(Action::Colour(2));
    play.wait(1_000);
    assert_eq!(play.screen().colours.len(), 2);
    play.press(Action::Back);
    play.press(Action::Open(Page::Zones));
    assert!(matches!(play.screen().body_view, BodyView::Shopper { fit: true, .. }));
    play.press(Action::Zone(0));
    assert!(play.screen().blocks.len() >= 5, "body, garment, range, how sure, what would make it surer");
    play.press(Action::Back);
    play.press(Action::Open(Page::Compare));
    assert!(matches!(play.screen().body_view, BodyView::Shopper { .. }), "not draped yet");
    play.wait(1_000);
    assert!(matches!(play.screen().body_view, BodyView::Two { .. }));
    let other = play.model.visit.pair.as_ref().unwrap().other.size;
    play.press(Action::Wear);
    play.wait(1_000);
    assert_eq!((play.page(), play.model.worn().unwrap().size), (Page::Zones, other));
    play.press(Action::Back);
    play.press(Action::TakePicture);
    play.wait(1_000);
    assert!(play.screen().blocks.iter().any(|b| matches!(b, Block::Code { side: 3, .. })));
    play.press(Action::Back);
    play.press(Action::Leave);
    assert_eq!((play.page(), play.model.state()), (Page::Attract, SessionState::Attract));
    assert!(play.effects.contains(&Effect::Forget));
    assert_eq!(play.screen().body_view, BodyView::Mannequin);
}

#[test]
fn a_picture_that_is_served_is_announced_can_be_had_without_the_network_and_ends_with_the_visit() {
    let address = SocketAddr::from((Ipv4Addr::LOCALHOST, 0));
    let server = Arc::new(PictureServer::start(address, vec![7; 100]).unwrap());
    let code = PictureCode { side: 2, dark: vec![true; 4] };
    let mut play = Play::dressed();
    play.link = Some(PictureLink { code, network: Some("Shop guest".into()), server: server.clone() });
    play.press(Action::TakePicture);
    play.wait(1_000);
    let shown = |play: &Play| {
        play.screen().blocks.iter().find_map(|b| if let Block::Code { side, .. } = b { Some(*side) } else { None })
    };
    assert_eq!(shown(&play), Some(2));
    let words = texts_of(&play.screen()).join(" ");
    assert!(words.contains("Shop guest") && words.contains("without encryption"), "{words}");
    play.press(Action::OtherCode);
    assert_eq!(shown(&play), Some(3), "the code that holds the picture");
    assert!(texts_of(&play.screen()).join(" ").contains("nothing is sent"));
    play.press(Action::OtherCode);
    assert_eq!(shown(&play), Some(2));
    play.link = None;
    play.press(Action::Back);
    play.press(Action::Leave);
    assert_eq!(Arc::strong_count(&server), 1, "the visit has let go of it");
}

#[test]
fn who_has_said_that_they_are_done_is_not_measured_again_until_they_begin_or_step_away() {
    let mut play = Play::dressed();
    play.press(Action::Leave);
    play.wait(20_000);
    assert_eq!(play.page(), Page::Attract);
    play.press(Action::Begin);
    play.wait(600);
    assert_eq!((play.page(), play.model.state()), (Page::Guide, SessionState::Measuring));
    let mut play = Play::dressed();
    play.press(Action::Leave);
    play.see(None);
    play.wait(2_500);
    play.see(Some(2));
    play.wait(600);
    assert_eq!(play.page(), Page::Guide);
}

#[test]
fn who_is_left_alone_is_warned_and_then_forgotten_and_who_comes_back_in_time_goes_on() {
    let mut play = Play::dressed();
    play.see(None);
    play.wait(2_100);
    assert_eq!(play.page(), Page::Leaving);
    let seconds = |play: &Play| {
        play.screen()
            .blocks
            .iter()
            .find_map(|b| if let Block::Countdown { seconds } = b { Some(*seconds) } else { None })
    };
    assert_eq!(seconds(&play), Some(5));
    play.wait(2_000);
    assert_eq!(seconds(&play), Some(3));
    play.see(Some(1));
    play.wait(600);
    assert_eq!(play.page(), Page::Fitting);
    play.see(None);
    play.wait(2_100);
    play.press(Action::Stay);
    play.wait(600);
    assert_eq!(play.page(), Page::Fitting, "who touches is there");
    play.wait(20_000);
    assert_eq!(play.page(), Page::Attract);
    assert!(play.model.visit.known.is_none() && play.model.visit.outfit.is_empty());
}

#[test]
fn another_person_sees_nothing_of_the_first() {
    let mut play = Play::dressed();
    play.press(Action::TakePicture);
    play.wait(1_000);
    play.see(Some(2));
    play.wait(1_100);
    assert_eq!(play.page(), Page::Second);
    assert!(play.effects.contains(&Effect::Hide));
    assert!(play.model.visit.picture.code().is_none(), "the picture is gone");
    assert_eq!(play.screen().body_view, BodyView::Mannequin);
    play.press(Action::Stay);
    assert!(matches!(play.effects.last(), Some(Effect::Dress { .. })));
    assert_eq!(
        (play.page(), play.screen().body_view),
        (Page::Fitting, BodyView::Mannequin),
        "hidden until it is put on"
    );
    play.wait(1_000);
    assert!(matches!(play.screen().body_view, BodyView::Shopper { .. }));
    play.wait(5_000);
    assert_eq!(play.page(), Page::Fitting, "asked once");
    play.see(Some(3));
    play.wait(1_100);
    play.press(Action::Begin);
    play.wait(600);
    assert_eq!(play.page(), Page::Guide);
    assert!(play.model.visit.known.is_none());
    // Nearer than the shopper counts too, and no answer is an answer.
    let mut play = Play::dressed();
    let near = Presence { people: 2, who: Some(1), nearer: true, ..Presence::default() };
    play.update(Input::Presence(near));
    play.wait(1_100);
    assert_eq!(play.page(), Page::Second);
    play.wait(20_100);
    assert!(play.model.visit.known.is_none() && play.effects.contains(&Effect::Forget));
}

#[test]
fn who_comes_while_the_first_is_gone_never_sees_their_body() {
    let mut play = Play::dressed();
    play.see(None);
    play.wait(2_500);
    play.see(Some(2));
    for _ in 0..300 {
        play.wait(20);
        assert!(!matches!(play.page(), Page::Fitting), "at {} ms", play.now / MS);
        if play.page() == Page::Second {
            return;
        }
    }
    panic!("nobody was asked: {:?}", play.page());
}

#[test]
fn who_cannot_be_measured_is_told_and_may_try_again() {
    let mut play = Play::new();
    play.fails = true;
    play.see(Some(1));
    play.wait(4_000);
    assert_eq!(play.page(), Page::Unmeasured);
    play.fails = false;
    play.press(Action::Measure);
    assert_eq!(play.page(), Page::Guide);
    assert!(play.screen().blocks.iter().any(|b| matches!(b, Block::Countdown { seconds: 4 })), "time to walk back");
    play.wait(7_500);
    assert_eq!(play.page(), Page::Fitting);
    // A garment that cannot be put on leaves the one before.
    play.fails = true;
    let before = play.model.visit.outfit.clone();
    play.press(Action::Open(Page::Garments));
    play.press(Action::Garment(play.model.wardrobe.find("tee").unwrap()));
    play.wait(1_000);
    assert_eq!(play.model.visit.outfit, before);
    play.press(Action::Back);
    play.press(Action::TakePicture);
    play.wait(1_000);
    assert!(play.screen().controls.iter().any(|c| c.action == Action::TakePicture), "again, please");
    play.press(Action::Back);
    play.press(Action::Open(Page::Compare));
    play.wait(1_000);
    assert!(matches!(play.screen().body_view, BodyView::Shopper { .. }));
    assert!(play.screen().blocks.len() >= 2, "the words still hold");
}

#[test]
fn who_is_measured_again_may_go_on_with_what_was_measured_before() {
    let mut play = Play::dressed();
    play.press(Action::Open(Page::Settings));
    play.press(Action::Measure);
    assert_eq!(play.page(), Page::Guide);
    play.press(Action::Back);
    assert_eq!(play.page(), Page::Fitting);
    play.fails = true;
    play.press(Action::Open(Page::Settings));
    play.press(Action::Measure);
    play.wait(8_000);
    assert_eq!((play.page(), play.screen().heading.as_str()), (Page::Unmeasured, "That did not work"));
    play.press(Action::Back);
    assert_eq!(play.page(), Page::Fitting);
    assert!(play.model.visit.known.is_some());
}

#[test]
fn a_language_that_was_chosen_and_left_is_forgotten() {
    let mut play = Play::new();
    play.press(Action::Language(2));
    play.press(Action::LargeType);
    assert_eq!(play.screen().language, "fr");
    play.wait(29_000);
    assert_eq!(play.screen().language, "fr");
    play.wait(2_000);
    assert_eq!((play.screen().language, play.screen().type_scale), ("en", 1.0));
    // Who chose it and steps in keeps it.
    play.press(Action::Language(2));
    play.see(Some(1));
    play.wait(60_000);
    assert_eq!((play.page(), play.screen().language), (Page::Fitting, "fr"));
}

#[test]
fn who_sits_is_measured_as_far_as_possible_and_told_what_is_missing() {
    let mut play = Play::new();
    play.known.measured.measures.hip_girth = None;
    play.known.measured.measures.inseam = None;
    play.known = VisitorMeasures::new(play.known.measured.clone(), true);
    let seen = Presence { people: 1, who: Some(1), seated: true, head_mm: Some(1_150.0), ..Presence::default() };
    play.update(Input::Presence(seen));
    play.wait(600);
    assert_eq!(play.screen().heading, "Face the mirror");
    let seated = play.screen().reach;
    play.wait(5_000);
    assert!(play.effects.iter().any(|e| matches!(e, Effect::Measure { seated: true, .. })));
    assert_eq!(play.page(), Page::Unmeasured);
    assert!(
        texts_of(&play.screen()).contains(&"Not seen: hip and leg length.".to_owned()),
        "{:?}",
        texts_of(&play.screen())
    );
    play.press(Action::Back);
    assert_eq!(play.page(), Page::Fitting);
    assert!(seated < Play::dressed().screen().reach, "within reach of a seated arm");
    let why = |play: &mut Play, place| {
        play.press(Action::Open(Page::Zones));
        play.press(Action::Zone(place));
        texts_of(&play.screen()).join(" ")
    };
    let hip = play.model.visit.fit.as_ref().unwrap().zones.iter().position(|z| z.zone.name() == "hip").unwrap();
    assert!(why(&mut play, hip).contains("could not be seen"));
}

#[test]
fn every_page_is_reached_by_keys_alone_and_by_gestures_alone() {
    let presses = |gestures: bool| {
        let mut play = Play::new();
        let mut dice = Dice(7);
        play.known.measured.measures.hip_girth = None;
        play.known = VisitorMeasures::new(play.known.measured.clone(), false);
        play.see(Some(1));
        for turn in 0..20_000 {
            let input = match (gestures, dice.below(3)) {
                (false, 0) => Input::Key(NavigationKey::Tab),
                (false, 1) => Input::Key(NavigationKey::Enter),
                (false, _) => Input::Key(NavigationKey::BackTab),
                (true, 0) => Input::Gesture(Gesture::SwipeRight),
                (true, 1) => Input::Gesture(Gesture::Confirm),
                (true, _) => Input::Gesture(Gesture::SwipeLeft),
            };
            if !(150..200).contains(&(turn % 400)) {
                play.update(input);
            }
            play.wait(20 * dice.below(60) as u64);
            // Now and then they leave, or another person comes.
            match turn % 400 {
                150 => play.see(None),
                200 => play.see(Some(1 + turn / 400)),
                350 => play.see(Some(1_000 + turn)),
                _ => {}
            }
            if play.pages.len() == ALL.len() {
                return;
            }
        }
        let missing: Vec<Page> = ALL.into_iter().filter(|p| !play.pages.contains(p)).collect();
        panic!("gestures {gestures}: never on {missing:?}");
    };
    presses(false);
    presses(true);
}

#[test]
fn swipes_move_the_focus_and_once_the_view_is_turned_they_turn_it_on() {
    let mut play = Play::dressed();
    play.update(Input::Gesture(Gesture::SwipeRight));
    assert_eq!(play.screen().focus, 1);
    play.update(Input::Gesture(Gesture::SwipeLeft));
    assert_eq!(play.screen().focus, 0);
    let turn = play.screen().controls.iter().position(|c| c.action == Action::Turn(1)).unwrap();
    (0..turn).for_each(|_| play.update(Input::Gesture(Gesture::SwipeRight)));
    play.update(Input::Gesture(Gesture::Confirm));
    play.update(Input::Gesture(Gesture::SwipeRight));
    play.wait(1_000);
    assert_eq!(play.screen().focus, turn);
    assert!((play.model.yaw() - std::f32::consts::FRAC_PI_2).abs() < 1e-5, "{}", play.model.yaw());
    play.wait(4_000);
    play.update(Input::Gesture(Gesture::SwipeRight));
    assert_eq!(play.screen().focus, turn + 1);
    play.press(Action::Open(Page::Zones));
    play.update(Input::Gesture(Gesture::SwipeUp));
    assert_eq!(play.page(), Page::Fitting, "up is back");
}

#[test]
fn strangers_gestures_and_late_presses_do_nothing() {
    let mut play = Play::dressed();
    play.see(Some(9));
    play.update(Input::Gesture(Gesture::Confirm));
    assert_eq!(play.page(), Page::Fitting);
    play.see(Some(1));
    play.update(Input::Pressed(Action::Zone(0)));
    play.update(Input::Pressed(Action::Size(100)));
    assert_eq!(play.page(), Page::Fitting);
}

#[test]
fn a_reply_to_who_has_left_says_nothing() {
    let mut play = Play::new();
    play.see(Some(1));
    play.wait(2_100);
    assert_eq!(play.page(), Page::Measuring);
    play.press(Action::Leave);
    play.wait(3_000);
    assert!(play.model.visit.known.is_none(), "measured too late");
    assert_eq!(play.page(), Page::Attract);
}

#[test]
fn a_picture_goes_after_its_minutes_or_at_once() {
    let mut play = Play::dressed();
    play.press(Action::TakePicture);
    play.wait(1_000);
    assert!(
        texts_of(&play.screen()).contains(&"It is deleted in 2 minutes.".to_owned()),
        "{:?}",
        texts_of(&play.screen())
    );
    play.wait(180_000);
    assert_eq!(play.page(), Page::Fitting);
    assert!(play.model.visit.picture.code().is_none());
    play.press(Action::TakePicture);
    play.wait(1_000);
    play.press(Action::DeletePicture);
    assert!(play.page() == Page::Fitting && play.model.visit.picture.code().is_none());
}

#[test]
fn whatever_is_pressed_something_has_the_focus_and_one_control_at_most_stands_out() {
    let mut play = Play::new();
    let mut dice = Dice(2026);
    for turn in 0..9_000 {
        if turn % 500 == 499 {
            // Every person walks away, and what was touched is long ago.
            play.see(None);
            play.wait(13_000);
        }
        let controls = play.screen().controls;
        let input = match dice.below(14) {
            0 => Input::Key(NavigationKey::Escape),
            1 => Input::Gesture(Gesture::SwipeUp),
            2 => Input::Gesture(Gesture::Confirm),
            3 => Input::Key(NavigationKey::Tab),
            4 if turn % 5 == 0 => Input::Presence(Presence::default()),
            5 if turn % 7 == 0 => {
                Input::Presence(Presence { people: 1, who: Some(dice.below(3) as u32), ..Presence::default() })
            }
            6 => Input::Presence(Presence {
                people: 1,
                who: play.model.visit.shopper.or(Some(1)),
                ..Presence::default()
            }),
            _ => Input::Pressed(controls[dice.below(controls.len())].action),
        };
        play.fails = dice.below(10) == 0;
        play.update(input);
        play.wait(20 * dice.below(40) as u64);
        let screen = play.screen();
        assert!(screen.focus < screen.controls.len(), "{screen:?}");
        assert!(screen.controls.iter().filter(|c| c.style == ControlStyle::Primary).count() <= 1, "{screen:?}");
        let known = play.model.visit.known.is_some();
        assert!(known || !matches!(screen.body_view, BodyView::Shopper { .. } | BodyView::Two { .. }));
    }
    assert!(play.pages.len() >= 13, "{:?}", play.pages);
}

#[test]
fn a_camera_that_is_lost_or_covered_is_said_on_every_page_and_unsaid_when_it_is_back() {
    use toile_sensors::source::live::CameraState;
    let mut play = Play::dressed();
    let blocks = play.screen().blocks;
    for (state, words) in [
        (CameraState::Lost, Some("does not answer")),
        (CameraState::Covered, Some("covers the camera")),
        (CameraState::Frozen, Some("does not answer")),
        (CameraState::Seeing, None),
    ] {
        play.update(Input::Camera(state));
        let now = play.screen().blocks;
        match words {
            Some(words) => {
                assert!(matches!(&now[0], Block::Text(text) if text.contains(words)), "{state}: {now:?}");
                assert_eq!(now[1..], blocks);
            }
            None => assert_eq!(now, blocks),
        }
    }
}

/// A visitor may choose to see themselves, with a word where the clothes cannot be put on the picture, and is the mannequin's again when
/// they say so, or have left.
#[test]
fn own_pictures_are_shown_on_request_and_forgotten() {
    let sees = |play: &Play| matches!(play.screen().body_view, BodyView::Shopper { own_picture: true, .. });
    let offers = |play: &Play| play.screen().controls.iter().any(|c| c.action == Action::OwnPicture);
    let mut play = Play::dressed();
    assert!(!offers(&play), "without a camera's picture nothing is offered");
    play.update(Input::OwnPicture(0));
    assert!(offers(&play) && !sees(&play), "the mannequin first");
    play.press(Action::OwnPicture);
    assert!(sees(&play) && play.model.shows_own_picture());
    // A visitor who sees themselves turns the picture by turning.
    assert!(!play.screen().controls.iter().any(|c| matches!(c.action, Action::Turn(_))));
    let says = |play: &Play, key: TextKey| {
        let words = play.texts.of(play.model.language()).text(key);
        play.screen().blocks.contains(&Block::Text(words))
    };
    for (outcome, key) in [
        (0, TextKey::OwnPictureSoon),
        (1, TextKey::OwnPictureKept),
        (3, TextKey::OwnPictureCannot),
        (4, TextKey::OwnPictureNobody),
        (5, TextKey::OwnPictureBack),
        (6, TextKey::OwnPictureStill),
    ] {
        play.update(Input::OwnPicture(outcome));
        assert!(says(&play, key), "{outcome}");
    }
    // On the other pages of the body they are still there; the fit map is the mannequin's.
    play.press(Action::Open(Page::Garments));
    assert!(sees(&play));
    play.press(Action::Back);
    play.press(Action::Open(Page::Zones));
    assert!(!sees(&play) && !play.model.shows_own_picture());
    play.press(Action::Back);
    play.press(Action::OwnPicture);
    assert!(!sees(&play) && !play.model.shows_own_picture());
    play.press(Action::OwnPicture);
    play.press(Action::Leave);
    assert!(!play.model.shows_own_picture() && play.screen().body_view == BodyView::Mannequin);
}
