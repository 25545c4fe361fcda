//! Tests every page of the visitor, in every language, on every display: the rules of the layout, and pictures to look at.

use std::collections::BTreeMap;
use std::path::PathBuf;

use toile_view::image::Size;
use toile_view::raster::{AdapterChoice, Gpu, Offscreen};

use super::DISPLAYS;
use crate::visitor::own_face::FaceTrouble;
use crate::visitor::screen::{Action, Block, BodyView, Page};
use crate::visitor::tests::Play;
use crate::visitor::texts::Language;
use crate::window::camera::tests::least_share;
use crate::window::overlay::Overlay;
use crate::window::paint::*;

/// The pages of a visit in a language, and in large type.
pub fn all(language: usize, large: bool) -> BTreeMap<String, Screen> {
    let mut seen = usual(language, large);
    seen.extend(by_tape(language, large));
    seen.extend(own_picture(language, large));
    seen.extend(own_face(language, large));
    seen
}

/// The pages of a person who may see themselves: offered, and with the longest word about why nothing is worn.
fn own_picture(language: usize, large: bool) -> BTreeMap<String, Screen> {
    let mut play = begun(language, large);
    play.see(Some(1));
    play.wait(6_000);
    play.picture_is(1);
    let offered = play.screen();
    play.press(Action::OwnPicture);
    play.picture_is(3);
    let plain = play.screen();
    [("30-see-myself".to_owned(), offered), ("31-myself".to_owned(), plain)].into()
}

/// The pages of a person who puts their own face on the mannequin: offered beside all else, asked for, with the longest trouble, and on.
fn own_face(language: usize, large: bool) -> BTreeMap<String, Screen> {
    let mut seen = BTreeMap::new();
    let mut play = begun(language, large);
    play.see(Some(1));
    play.wait(6_000);
    play.picture_is(1);
    play.offer_faces(Err(FaceTrouble::Unseen));
    let mut keep = |name: &str, play: &Play| seen.insert(format!("4{}-{name}", seen.len()), play.screen());
    keep("fitting-with-face", &play);
    play.press(Action::Open(Page::Face));
    keep("face", &play);
    play.press(Action::TakeFace);
    keep("face-taking", &play);
    play.wait(1_000);
    keep("face-unseen", &play);
    play.offer_faces(Ok(()));
    play.press(Action::TakeFace);
    play.wait(2_000);
    keep("face-on", &play);
    seen
}

/// A visit in a language, and in large type.
fn begun(language: usize, large: bool) -> Play {
    let mut play = Play::new();
    play.press(Action::Language(language));
    if large {
        play.press(Action::LargeType);
    }
    play
}

/// The pages of a person who is offered a turn, whose hip is not seen, and who gives measures by tape.
fn by_tape(language: usize, large: bool) -> BTreeMap<String, Screen> {
    let mut seen = BTreeMap::new();
    let mut play = begun(language, large);
    let mut keep = |name: &str, play: &Play| {
        seen.insert(format!("2{}-{name}", seen.len()), play.screen());
    };
    play.hide_hip();
    play.face(0.0);
    while play.page() != Page::Measuring {
        play.wait(100);
    }
    play.face(0.0);
    keep("offered", &play);
    for side in 0..10 {
        play.face(0.17 * side as f32);
        play.wait(160);
    }
    keep("turning", &play);
    while play.page() == Page::Measuring {
        play.wait(100);
    }
    keep("partly", &play);
    play.press(Action::Open(Page::OwnMeasures));
    keep("own", &play);
    let give = |play: &mut Play, own: usize, digits: &[u8]| {
        play.press(Action::OwnMeasure(own));
        digits.iter().for_each(|digit| play.press(Action::Digit(*digit)));
        play.press(Action::Accept);
    };
    for (own, digits) in [(0, [0, 9, 4]), (2, [1, 0, 2]), (3, [1, 7, 0]), (5, [0, 7, 8])] {
        give(&mut play, own, &digits);
    }
    keep("given", &play);
    give(&mut play, 1, &[7]);
    keep("impossible", &play);
    play.press(Action::Back);
    give(&mut play, 4, &[1, 2, 5]);
    keep("contradiction", &play);
    play.press(Action::Back);
    play.press(Action::OwnMeasure(2));
    keep("entry", &play);
    play.press(Action::RemoveMeasure);
    play.wait(1_500);
    play.press(Action::Back);
    while play.page() != Page::Fitting {
        play.press(Action::Back);
    }
    keep("unknown", &play);
    play.press(Action::Open(Page::Zones));
    keep("unknown-zones", &play);
    play.press(Action::Zone(2));
    keep("unknown-zone", &play);
    play.press(Action::Back);
    play.press(Action::Open(Page::Compare));
    play.wait(1_500);
    keep("unknown-compare", &play);
    seen
}

fn usual(language: usize, large: bool) -> BTreeMap<String, Screen> {
    let mut seen = BTreeMap::new();
    let mut play = begun(language, large);
    let mut keep = |name: &str, play: &Play| {
        seen.insert(format!("{:02}-{name}", seen.len()), play.screen());
    };
    keep("attract", &play);
    play.see(Some(1));
    play.wait(1_500);
    keep("guide", &play);
    while play.page() == Page::Guide {
        play.wait(100);
    }
    play.wait(500);
    keep("measuring", &play);
    while play.page() == Page::Measuring {
        play.wait(100);
    }
    keep("fitting", &play);
    play.press(Action::Open(Page::Garments));
    keep("garments", &play);
    play.press(Action::Back);
    play.press(Action::Open(Page::Zones));
    keep("zones", &play);
    play.press(Action::Zone(1));
    keep("zone", &play);
    play.press(Action::Back);
    play.press(Action::Open(Page::Compare));
    play.wait(1_500);
    keep("compare", &play);
    play.press(Action::Back);
    play.press(Action::Back);
    play.press(Action::TakePicture);
    play.wait(1_500);
    keep("picture", &play);
    play.press(Action::Back);
    play.press(Action::Open(Page::Settings));
    keep("settings", &play);
    play.press(Action::Back);
    play.see(Some(2));
    play.wait(3_000);
    keep("second", &play);
    play.press(Action::Stay);
    play.see(None);
    while play.page() != Page::Leaving {
        play.wait(100);
    }
    keep("leaving", &play);
    seen
}

/// Where pictures of all pages go, to be looked at: `TOILE_SCREENS=/tmp/screens cargo test ... every_page`; needs a graphics driver.
const PICTURES: &str = "TOILE_SCREENS";

/// Draws what was painted, over a plain ground.
struct Proof {
    gpu: Gpu,
    overlay: Overlay,
    folder: PathBuf,
}

impl Proof {
    fn options() -> Option<Self> {
        let folder = PathBuf::from(std::env::var_os(PICTURES)?);
        std::fs::create_dir_all(&folder).unwrap();
        let gpu = Gpu::offscreen(&AdapterChoice::Software).unwrap();
        let overlay = Overlay::new(&gpu.device, Offscreen::FORMAT);
        Some(Self { gpu, overlay, folder })
    }

    fn print(&mut self, display: DisplayMetrics, name: &str, painted: &PaintedScreen) {
        let Self { gpu, overlay, folder } = self;
        let [w, h] = display.size;
        let canvas = Offscreen::new(gpu, Size::new(w, h)).unwrap();
        overlay.update_textures(&gpu.device, &gpu.queue, painted);
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        let view = canvas.target().create_view(&Default::default());
        overlay.draw((&gpu.device, &gpu.queue), &mut encoder, (&view, display.size), painted, true);
        gpu.queue.submit([encoder.finish()]);
        overlay.free_textures(painted);
        let mut bytes = Vec::new();
        canvas.read(gpu).unwrap().write_png(&mut bytes).unwrap();
        std::fs::write(folder.join(format!("{w}x{h}-{name}.png")), bytes).unwrap();
    }
}

/// Least share of the display's height that a body has where clothes are shown.
const LEAST_BODY: f32 = 0.6;

/// Most modules of a side that a link's code has (version 5 of QR codes); one that holds the picture itself has over a hundred.
const LINK_SIDE: usize = 37;

/// The share of the display's height that a body has on a page; none where clothes are not what is looked at, and where a code that holds
/// a picture is read off the display.
fn body_share(screen: &Screen, display: DisplayMetrics, free: [f32; 4]) -> Option<f32> {
    let [w, h] = display.size.map(|n| n as f32);
    let holds_picture = |block: &Block| matches!(block, Block::Code { side, .. } if *side > LINK_SIDE);
    let has_clothes = matches!(
        screen.page,
        Page::Fitting | Page::Garments | Page::Zones | Page::Zone | Page::Compare | Page::Picture
    );
    match screen.body_view {
        _ if !has_clothes => None,
        BodyView::Shopper { .. } if !screen.blocks.iter().any(holds_picture) => Some(least_share(free, w / h)),
        BodyView::Two { .. } => {
            let [left, top, right, bottom] = free;
            let free = if right < 1.0 { [0.0, top, 1.0, bottom] } else { [left, top, right, bottom] };
            Some(least_share(free, 0.5 * w / h))
        }
        _ => None,
    }
}

/// That every page, in every language and in type of a size, has its place on every display.
fn have_their_places(large: bool) {
    let (mut bad, mut painter, mut proof) = (Vec::new(), ScreenPainter::default(), Proof::options());
    for language in 0..Language::ALL.len() {
        for (name, screen) in all(language, large) {
            for display in DISPLAYS {
                let painted = painter.paint(&screen, display);
                if let Some(proof) = &mut proof {
                    let size = if large { "large-" } else { "" };
                    proof.print(display, &format!("{size}{}-{name}", screen.language), &painted);
                }
                let laid = painter.laid().unwrap();
                let share = body_share(&screen, display, painted.free);
                let [w, h] = display.size;
                if !large && share.is_some_and(|share| share < LEAST_BODY) {
                    bad.push(format!("{name} {} {w}x{h}: a body of {:.3}", screen.language, share.unwrap_or(0.0)));
                }
                // Large type may scroll what is pressed; nothing that is read is ever cut off.
                if !laid.fits || (laid.scrolls > 0.0 && !large) {
                    bad.push(format!("{name} {} {large} {w}x{h}: scrolls {:.0}", screen.language, laid.scrolls));
                }
            }
        }
    }
    assert!(bad.is_empty(), "{} of them:\n{}", bad.len(), bad.join("\n"));
}

// Two tests, so that two cores share the hundreds of pages.
#[test]
fn every_page_has_its_place_on_every_display() {
    have_their_places(false);
}

#[test]
fn every_page_in_large_type_has_its_place() {
    have_their_places(true);
}
