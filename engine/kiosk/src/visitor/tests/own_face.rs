//! A shopper's own face on the mannequin: offered where it is on, put on when they ask, taken away when they say so, and gone with them.

use super::*;
use crate::visitor::screen::{Block, BodyView};
use crate::visitor::texts::TextKey;

const TROUBLES: [(FaceTrouble, TextKey); 5] = [
    (FaceTrouble::NoPicture, TextKey::FaceNoPicture),
    (FaceTrouble::Unseen, TextKey::FaceUnseen),
    (FaceTrouble::TooFar, TextKey::FaceFar),
    (FaceTrouble::Turned, TextKey::FaceTurned),
    (FaceTrouble::Unlike, TextKey::FaceUnlike),
];

fn offers(play: &Play, action: Action) -> bool {
    play.screen().controls.iter().any(|c| c.action == action)
}

fn says(play: &Play, key: TextKey) -> bool {
    let words = play.texts.of(play.model.language()).text(key);
    play.screen().blocks.contains(&Block::Text(words))
}

/// Dressed, and on the page of the face.
fn open(face: Result<(), FaceTrouble>) -> Play {
    let mut play = Play::dressed();
    play.offer_faces(face);
    play.press(Action::Open(Page::Face));
    play
}

/// How often a person was dressed.
fn dressed(play: &Play) -> usize {
    play.effects.iter().filter(|e| matches!(e, Effect::Dress { .. })).count()
}

#[test]
fn no_face_is_offered_unless_the_shop_wants_it_and_none_is_taken_unless_the_shopper_asks() {
    let mut play = Play::dressed();
    play.update(Input::OwnPicture(1));
    assert!(!offers(&play, Action::Open(Page::Face)), "off by default");
    play.offer_faces(Ok(()));
    assert!(offers(&play, Action::Open(Page::Face)));
    // Who sees themselves has no mannequin that would have it.
    play.press(Action::OwnPicture);
    assert!(!offers(&play, Action::Open(Page::Face)));
    play.press(Action::OwnPicture);
    play.press(Action::Open(Page::Face));
    play.wait(3_000);
    assert!(says(&play, TextKey::FaceWhat) && says(&play, TextKey::FaceKept));
    assert!(!offers(&play, Action::RemoveFace), "there is none");
    assert!(!play.effects.iter().any(|e| matches!(e, Effect::TakeFace { .. })), "a page that is open takes nothing");
}

#[test]
fn a_face_is_put_on_stays_with_other_clothes_and_is_taken_away() {
    let mut play = open(Ok(()));
    let before = dressed(&play);
    play.press(Action::TakeFace);
    assert!(play.model.visit.face.asked.is_some() && !offers(&play, Action::TakeFace), "one at a time");
    play.wait(800);
    assert!(play.model.visit.face.on && dressed(&play) == before + 1, "dressed anew with it");
    play.wait(800);
    assert!(says(&play, TextKey::FaceOn) && says(&play, TextKey::FaceKept));
    assert!(matches!(play.screen().body_view, BodyView::Shopper { own_picture: false, .. }));
    play.press(Action::Back);
    play.press(Action::Size(1));
    play.wait(1_000);
    assert!(play.model.visit.face.on && !play.effects.contains(&Effect::Hide));
    play.press(Action::Open(Page::Face));
    play.press(Action::RemoveFace);
    // It is gone at once, and not when they are dressed again.
    assert!(play.effects.contains(&Effect::Hide) && play.screen().body_view == BodyView::Mannequin);
    assert_eq!(play.model.visit.face, Default::default());
    play.wait(800);
    assert!(matches!(play.screen().body_view, BodyView::Shopper { .. }) && says(&play, TextKey::FaceWhat));
}

#[test]
fn what_goes_wrong_is_said_and_leaves_everything_as_it_was() {
    for (trouble, key) in TROUBLES {
        let mut play = open(Err(trouble));
        let before = dressed(&play);
        play.press(Action::TakeFace);
        play.wait(800);
        assert!(says(&play, key) && says(&play, TextKey::FaceKept), "{trouble:?}");
        assert!(!play.model.visit.face.on && dressed(&play) == before);
        // A face that is on stays when the next one goes wrong.
        play.face = Ok(());
        play.press(Action::TakeFace);
        play.wait(1_600);
        play.face = Err(trouble);
        play.press(Action::TakeFace);
        play.wait(800);
        assert!(says(&play, key) && play.model.visit.face.on && offers(&play, Action::RemoveFace));
        // What went wrong is said once.
        play.press(Action::Back);
        play.press(Action::Open(Page::Face));
        assert!(!says(&play, key) && says(&play, TextKey::FaceOn));
    }
}

#[test]
fn a_face_is_wiped_on_leaving_and_for_strangers() {
    let on = || {
        let mut play = open(Ok(()));
        play.press(Action::TakeFace);
        play.wait(1_600);
        assert!(play.model.visit.face.on);
        play
    };
    let mut play = on();
    play.press(Action::Back);
    play.press(Action::Leave);
    assert!(play.effects.contains(&Effect::Forget) && play.model.visit.face == Default::default());
    let mut play = on();
    play.see(None);
    play.wait(20_000);
    assert!(play.effects.contains(&Effect::Forget) && play.model.visit.face == Default::default());
    let mut play = on();
    play.see(Some(2));
    play.wait(1_100);
    assert!(play.page() == Page::Second && play.effects.contains(&Effect::Hide));
    assert_eq!(play.model.visit.face, Default::default());
    // One that is being taken while they leave is thrown away.
    let mut play = open(Ok(()));
    play.press(Action::TakeFace);
    play.press(Action::Back);
    play.press(Action::Leave);
    play.wait(2_000);
    assert_eq!(play.model.visit.face, Default::default());
}
