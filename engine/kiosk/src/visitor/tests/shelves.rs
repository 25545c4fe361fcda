//! A wardrobe of any size on pages of six, and one that changes between visitors.

use std::sync::Arc;

use super::super::actions::SHELF;
use super::super::screen::{Action, ControlStyle, Page};
use super::super::wardrobe::Wardrobe;
use super::{Play, STOCK};
use crate::visitor::screen::Screen;

/// The kiosk's own garments again and again, each under a name of its own.
fn many(count: usize, photograph: bool) -> Wardrobe {
    let stock = Wardrobe::clone(&STOCK);
    let mut items: Vec<_> = stock.items.iter().cycle().take(count).cloned().collect();
    for (i, item) in items.iter_mut().enumerate().filter(|(i, _)| *i >= stock.items.len() || photograph) {
        item.name = format!("{}-{i}", item.name);
        item.photograph = photograph.then(|| "front.png".into());
    }
    Wardrobe { items, ..stock }
}

fn garments(screen: &Screen) -> Vec<usize> {
    let place = |action| if let Action::Garment(place) = action { Some(place) } else { None };
    screen.controls.iter().filter_map(|control| place(control.action)).collect()
}

fn dressed(count: usize) -> Play {
    let mut play = Play::new();
    play.model.restock(Arc::new(many(count, false)), vec!["strap-dress".into()]);
    play.see(Some(1));
    play.wait(6_000);
    assert_eq!(play.page(), Page::Fitting);
    play.press(Action::Open(Page::Garments));
    play
}

#[test]
fn every_garment_of_a_large_wardrobe_is_on_some_page_and_each_leads_back() {
    for count in [5, 6, 7, 12, 13, 200] {
        let mut play = dressed(count);
        let mut seen = std::collections::BTreeSet::new();
        let worn = play.model.visit.in_hand;
        assert!(garments(&play.screen()).contains(&worn), "what is in hand is shown first");
        for _ in 0..count.div_ceil(SHELF) {
            let screen = play.screen();
            seen.extend(garments(&screen));
            assert!(garments(&screen).len() <= SHELF);
            assert_eq!(screen.controls.last().map(|c| c.action), Some(Action::Back), "{count}");
            if count > SHELF {
                play.press(Action::Shelf(1));
                let screen = play.screen();
                assert_eq!(screen.controls[screen.focus].action, Action::Shelf(1), "the focus stays where it was");
            }
        }
        assert_eq!(seen.len(), count);
        assert!(garments(&play.screen()).contains(&worn), "round and round");
        if count > 2 * SHELF {
            play.press(Action::Shelf(-1));
            assert_eq!(garments(&play.screen()).last(), Some(&(count - 1)), "and back");
        }
    }
}

#[test]
fn garments_with_photographs_are_tiles_with_price_and_what_pressing_does() {
    let mut wardrobe = many(8, true);
    wardrobe.items[7].photograph = None;
    wardrobe.items.iter_mut().for_each(|item| item.price = Some("1249.50 EUR".parse().unwrap()));
    let first = wardrobe.items[0].name.clone();
    let mut play = Play::new();
    play.model.restock(Arc::new(wardrobe), vec![first]);
    play.press(Action::Language(1));
    play.see(Some(1));
    play.wait(6_000);
    play.press(Action::Open(Page::Garments));
    let screen = play.screen();
    let tiles: Vec<_> = screen.controls.iter().filter(|c| matches!(c.action, Action::Garment(_))).collect();
    assert!(tiles.iter().all(|tile| matches!(tile.style, ControlStyle::Tile(_))));
    let worn = tiles[0].detail.as_deref().unwrap();
    assert!(worn.starts_with("1249,50 EUR \u{b7} "), "{worn}");
    // On the next page one has none, and is a tile all the same: all of a row look alike.
    play.press(Action::Shelf(1));
    assert!(matches!(play.screen().controls[1].style, ControlStyle::Tile(_)));
}

#[test]
fn a_wardrobe_changes_only_without_a_visitor() {
    let mut play = Play::new();
    assert!(play.model.is_idle());
    play.press(Action::LargeType);
    assert!(!play.model.is_idle(), "somebody looks");
    play.wait(31_000);
    assert!(play.model.is_idle());
    play.see(Some(1));
    play.wait(6_000);
    assert!(!play.model.is_idle());
    play.press(Action::Leave);
    play.see(None);
    play.wait(8_000);
    assert!(play.model.is_idle(), "{:?}", play.page());
    play.model.restock(Arc::new(many(3, false)), vec!["slim-trousers".into()]);
    play.see(Some(2));
    play.wait(6_000);
    let worn = play.model.visit.outfit[0].item;
    assert_eq!(play.model.wardrobe.items[worn].name, "slim-trousers");
}
