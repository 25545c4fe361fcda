mod face_page;
mod pages;

use std::sync::Arc;

use super::theme::{LEAST_LINE, ScreenStyle, TARGET_MM};
use super::*;
use crate::visitor::screen::{Block, BodyView, Control, ControlStyle, Page, ScreenPicture};
use egui::{Color32, FontFamily, FontId, Rgba};
use toile_assets::catalogue::{Picture, ShopTheme, ThemeColours};

const OWN: Palette = Palette::OWN;

/// Displays that the screens are made for: standing and lying, large and small, with the size of a pixel (mm).
pub const DISPLAYS: [DisplayMetrics; 4] = [
    DisplayMetrics { size: [1080, 1920], pixel_mm: 0.63 },
    DisplayMetrics { size: [1920, 1080], pixel_mm: 0.63 },
    DisplayMetrics { size: [720, 1280], pixel_mm: 0.6 },
    DisplayMetrics { size: [540, 960], pixel_mm: 1.26 },
];

fn control(action: Action, label: &str, style: ControlStyle) -> Control {
    Control { action, label: label.into(), detail: None, is_detail_spare: false, style, chosen: false, picture: None }
}

/// One of everything.
fn full() -> Screen {
    let mut controls = vec![control(Action::Measure, "Measure again", ControlStyle::Primary)];
    controls.extend((0..5).map(|i| control(Action::Garment(i), "Wide trousers", ControlStyle::Plain)));
    controls.extend((0..4).map(|i| control(Action::Colour(i), "Bottle green", ControlStyle::Swatch([0.1, 0.2, 0.3]))));
    controls.push(control(Action::Back, "Back", ControlStyle::Quiet));
    controls[2].chosen = true;
    Screen {
        page: Page::Fitting,
        heading: "Sun dress, size 40".into(),
        blocks: vec![
            Block::Text("It suits you.".into()),
            Block::Fit { text: "Waist: snug (+1 \u{b1} 1 cm)".into(), tightness: Some(0.4) },
            Block::Legend { ends: ["loose".into(), "tight".into()] },
        ],
        controls,
        focus: 0,
        body_view: BodyView::Shopper { yaw: 0.0, fit: true, unknown: [false; 3], judged: None, own_picture: false },
        type_scale: 1.0,
        reach: 0.65,
        reach_low: 0.1,
        colours: vec![],
        language: "en",
        theme: ScreenTheme::default(),
        logo: None,
    }
}

fn laid(screen: &Screen, display: DisplayMetrics) -> (ScreenPainter, PaintedScreen) {
    let mut painter = ScreenPainter::default();
    let painted = painter.paint(screen, display);
    (painter, painted)
}

#[test]
fn what_can_be_pressed_is_large_enough_apart_and_within_reach() {
    for display in DISPLAYS {
        let screen = full();
        let (painter, _) = laid(&screen, display);
        let laid = painter.laid().unwrap();
        let least = (TARGET_MM / display.pixel_mm).min(display.size[1] as f32 * 0.1);
        assert!(laid.fits && laid.scrolls == 0.0, "{display:?}");
        for (i, button) in laid.buttons.iter().enumerate() {
            assert!(button.rect.width() >= least && button.rect.height() >= least, "{display:?}: {:?}", button.rect);
            let floor = display.size[1] as f32;
            assert!(floor - button.rect.top() <= screen.reach * floor, "{display:?}: beyond reach");
            assert!(floor - button.rect.bottom() >= screen.reach_low * floor - 1.0, "{display:?}: below reach");
            assert!(laid.buttons[..i].iter().all(|b| !b.rect.intersects(button.rect)), "{display:?}");
            assert!(laid.panel.contains_rect(button.rect));
            let room = button.rect.width();
            assert!(button.label.rect.width() <= room, "words beyond their button");
            assert_eq!(laid.hit(button.rect.center(), 0.0), Some(button.index));
        }
    }
}

#[test]
fn what_is_read_stands_in_its_order_and_on_the_panel() {
    for display in DISPLAYS {
        let (painter, _) = laid(&full(), display);
        let laid = painter.laid().unwrap();
        let mut y = laid.heading.0.y + laid.heading.1.size().y;
        for block in &laid.blocks {
            assert!(block.rect.top() >= y && laid.panel.contains_rect(block.rect), "{display:?}");
            y = block.rect.bottom();
        }
        assert!(y <= laid.window.top());
        assert!(!laid.free.intersects(laid.panel.shrink(1.0)), "the body is not hidden");
        assert!(laid.free.area() > 0.25 * (display.size[0] * display.size[1]) as f32, "{display:?}");
    }
}

#[test]
fn no_line_is_smaller_than_a_sixtieth_of_the_display() {
    for display in DISPLAYS {
        let size = display.size.map(|n| n as f32);
        for squeeze in [1.0, 0.8, 0.6] {
            let look = ScreenStyle::of(size, display.pixel_mm, 1.0, OWN).squeezed(squeeze);
            for font in [look.text(), look.label(), look.small(), look.heading()] {
                assert!(font.size >= (size[1] * LEAST_LINE).floor(), "{display:?} at {squeeze}: {}", font.size);
            }
        }
    }
}

#[test]
fn larger_type_is_larger() {
    let large = Screen { type_scale: 1.4, ..full() };
    let body = |screen: &Screen| laid(screen, DISPLAYS[0]).0.laid().unwrap().look.body;
    assert!(body(&large) > body(&full()));
}

#[test]
fn a_list_that_is_longer_than_the_reach_scrolls_and_follows_the_focus() {
    let mut screen = full();
    screen.controls =
        (0..60).map(|i| control(Action::Garment(i), &format!("Garment {i}"), ControlStyle::Plain)).collect();
    screen.reach = 0.35;
    let (mut painter, _) = laid(&screen, DISPLAYS[0]);
    assert!(painter.laid().unwrap().scrolls > 0.0);
    screen.focus = 59;
    painter.paint(&screen, DISPLAYS[0]);
    let scrolled = painter.finger.feedback().scrolled;
    let laid = painter.laid().unwrap();
    let last = laid.buttons[59].rect.translate(vec2(0.0, -scrolled));
    assert!(laid.window.expand(1.0).contains_rect(last), "the focus is in sight");
    assert_eq!(painter.touch(TouchEvent::Down(last.center()), &screen), None);
    assert_eq!(painter.touch(TouchEvent::Up(last.center()), &screen), Some(Action::Garment(59)));
    // A drag scrolls and presses nothing.
    let from = last.center();
    painter.touch(TouchEvent::Down(from), &screen);
    painter.touch(TouchEvent::Move(from + vec2(0.0, 300.0)), &screen);
    assert_eq!(painter.touch(TouchEvent::Up(from + vec2(0.0, 300.0)), &screen), None);
    assert!(painter.finger.feedback().scrolled < scrolled);
}

#[test]
fn a_finger_presses_where_it_went_down_and_turns_beside_the_panel() {
    let screen = full();
    let (mut painter, _) = laid(&screen, DISPLAYS[0]);
    let at = |painter: &ScreenPainter, i: usize| painter.laid().unwrap().buttons[i].rect.center();
    let (one, other) = (at(&painter, 0), at(&painter, 3));
    painter.touch(TouchEvent::Down(one), &screen);
    assert_eq!(painter.finger.feedback().pressed, Some(0));
    assert_eq!(painter.touch(TouchEvent::Up(one), &screen), Some(Action::Measure));
    painter.touch(TouchEvent::Down(one), &screen);
    assert_eq!(painter.touch(TouchEvent::Up(other), &screen), None, "it slid onto another");
    painter.touch(TouchEvent::Down(one), &screen);
    painter.touch(TouchEvent::Cancel, &screen);
    assert_eq!(painter.touch(TouchEvent::Up(one), &screen), None);
    let free = painter.laid().unwrap().free.center();
    painter.touch(TouchEvent::Down(free), &screen);
    let turned: Vec<_> =
        (0..20).filter_map(|i| painter.touch(TouchEvent::Move(free + vec2(-30.0 * i as f32, 0.0)), &screen)).collect();
    assert!(turned.len() > 2 && turned.iter().all(|t| *t == Action::Turn(-1)), "{turned:?}");
}

#[test]
fn all_textures_reach_the_gpu_with_the_first_painting() {
    let (_, painted) = laid(&full(), DISPLAYS[0]);
    assert!(!painted.shapes.is_empty());
    assert!(painted.textures.set.iter().any(|(_, deltas)| deltas.iter().any(|d| d.is_whole())), "the letters' texture");
}

#[test]
fn nothing_panics_on_a_display_that_is_none() {
    for size in [[0, 0], [1, 1], [240, 240], [8192, 240]] {
        laid(&full(), DisplayMetrics { size, pixel_mm: 0.5 });
        laid(&Screen { controls: vec![], blocks: vec![], ..full() }, DisplayMetrics { size, pixel_mm: 0.0 });
    }
}

/// WCAG 2.2's contrast ratio.
fn contrast(a: Color32, b: Color32) -> f32 {
    let luminance = |c: Color32| {
        let c = Rgba::from(c);
        0.2126 * c.r() + 0.7152 * c.g() + 0.0722 * c.b() + 0.05
    };
    let (a, b) = (luminance(a), luminance(b));
    a.max(b) / a.min(b)
}

#[test]
fn words_have_contrast_whatever_stands_behind_the_panel() {
    for behind in [Color32::WHITE, Color32::BLACK, Color32::from_rgb(200, 30, 30)] {
        let share = 1.0 - f32::from(OWN.panel.a()) / 255.0;
        let over = |c: u8, behind: u8| (f32::from(c) + share * f32::from(behind)) as u8;
        let panel = Color32::from_rgb(
            over(OWN.panel.r(), behind.r()),
            over(OWN.panel.g(), behind.g()),
            over(OWN.panel.b(), behind.b()),
        );
        assert!(contrast(OWN.ink, panel) > 7.0 && contrast(OWN.soft, panel) > 4.5, "{behind:?}");
        assert!(contrast(OWN.focus, panel) > 4.5);
    }
    assert!(contrast(OWN.on_accent, OWN.accent) > 7.0);
}

#[test]
fn every_character_of_every_text_has_a_glyph_in_both_weights() {
    let (painter, _) = laid(&full(), DISPLAYS[0]);
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/texts");
    let mut missing = std::collections::BTreeSet::new();
    let mut read = 0;
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        let text = std::fs::read_to_string(&path).unwrap();
        read += 1;
        for c in text.chars().filter(|c| !c.is_whitespace()) {
            for family in [FontFamily::Proportional, FontFamily::Name(fonts::BOLD.into())] {
                if !painter.context.fonts_mut(|f| f.has_glyph(&FontId::new(20.0, family.clone()), c)) {
                    missing.insert((path.file_name().unwrap().to_owned(), c));
                }
            }
        }
    }
    assert_eq!(read, 6, "six languages");
    assert!(missing.is_empty(), "run engine/kiosk/fonts/subset.sh: {missing:?}");
}

#[test]
fn fonts_are_small() {
    let all: usize = fonts::definitions(None).font_data.values().map(|f| f.bytes().len()).sum();
    assert!(all < 600_000, "{all} bytes");
}

fn picture(width: u32, height: u32) -> ScreenPicture {
    ScreenPicture(Arc::new(Picture {
        width,
        height,
        pixels: vec![[90, 60, 30, 255]; (width * height) as usize].into(),
    }))
}

/// The shop's font of these tests: Latin letters, and no kana.
fn theme(colours: ThemeColours) -> ScreenTheme {
    let font: Arc<[u8]> = Arc::from(&include_bytes!("../../../fonts/NotoSans-Bold.ttf")[..]);
    ScreenTheme(Some(Arc::new(ShopTheme { logo: Some(picture(200, 80).0), colours, font: Some(font) })))
}

/// A page with six tiles, all of them in a shop's theme.
fn tiles() -> Screen {
    let tile = |i: usize| Control {
        picture: (i != 3).then(|| picture(120 + 10 * i as u32, 200)),
        detail: Some("49.90 EUR \u{b7} You are wearing it".into()),
        chosen: i == 1,
        ..control(Action::Garment(i), "Circle skirt", ControlStyle::Tile([0.2, 0.3, 0.1]))
    };
    let mut controls: Vec<Control> = (0..6).map(tile).collect();
    controls.extend((0..8).map(|i| control(Action::Colour(i), "Bottle green", ControlStyle::Swatch([0.1, 0.2, 0.3]))));
    controls.push(control(Action::Shelf(1), "More clothes", ControlStyle::Quiet));
    controls.push(control(Action::Back, "Back", ControlStyle::Quiet));
    let colours = ThemeColours { accent: [0.7, 0.2, 0.2], ground: [0.97, 0.95, 0.9], text: [0.1, 0.12, 0.1] };
    let theme = theme(colours);
    let logo = theme.0.as_ref().and_then(|theme| theme.logo.clone()).map(ScreenPicture);
    Screen { controls, theme, logo, blocks: full().blocks[..1].to_vec(), ..full() }
}

#[test]
fn photographs_and_logo_stand_within_their_tiles_and_the_panel_and_are_freed_with_the_page() {
    for display in DISPLAYS {
        let (mut painter, painted) = laid(&tiles(), display);
        let laid_out = painter.laid().unwrap();
        assert!(laid_out.fits, "{display:?}");
        let logo = laid_out.logo.unwrap();
        assert!(laid_out.panel.contains_rect(logo) && logo.bottom() <= laid_out.heading.0.y, "{display:?}");
        assert!((logo.width() / logo.height() - 2.5).abs() < 0.1, "a logo keeps its shape: {logo:?}");
        for button in &laid_out.buttons {
            assert!(laid_out.panel.contains_rect(button.rect) || laid_out.scrolls > 0.0, "{display:?}");
        }
        // The letters, the logo and five photographs.
        let uploaded = painted.textures.set.iter().filter(|(_, deltas)| deltas.iter().any(|d| d.is_whole())).count();
        assert!(uploaded >= 7 && painter.textures.len() == 6, "{uploaded}");
        let after = painter.paint(&full(), display);
        assert_eq!((painter.textures.len(), after.textures.free.len() >= 6), (0, true));
    }
}

#[test]
fn a_shops_colours_are_painted_and_its_font_leaves_what_it_lacks_to_ours() {
    let screen = tiles();
    let (mut painter, _) = laid(&screen, DISPLAYS[0]);
    assert_eq!(painter.palette.ink, Color32::from_rgb(26, 31, 26));
    for c in "A\u{df}\u{11f}7\u{30ab}\u{524d}".chars() {
        let font = FontId::new(20.0, FontFamily::Proportional);
        assert!(painter.context.fonts_mut(|f| f.has_glyph(&font, c)), "{c}");
    }
    let wide = |painter: &ScreenPainter, text: &str| {
        painter
            .context
            .fonts_mut(|f| f.layout_no_wrap(text.into(), FontId::new(20.0, FontFamily::Proportional), OWN.ink).size().x)
    };
    let (shops, kana) = (wide(&painter, "Fitting room"), wide(&painter, "\u{30ab}\u{30ab}"));
    painter.paint(&full(), DISPLAYS[0]);
    assert_eq!(painter.palette, OWN, "without a theme everything is as it was");
    assert_ne!(wide(&painter, "Fitting room"), shops, "its letters are its own");
    assert_eq!(wide(&painter, "\u{30ab}\u{30ab}"), kana);
}
