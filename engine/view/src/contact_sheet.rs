//! Contact sheets: several pictures on one page, with a title, captions and a legend.

use crate::{
    image::{Image, Size},
    text::{self, TextSize},
};

/// Background colour of the page, sRGB.
pub const PAPER: [u8; 3] = [250, 249, 247];

/// Titles and captions, sRGB.
const INK: [u8; 3] = [44, 42, 40];

/// Further lines under a title, sRGB.
const QUIET: [u8; 3] = [122, 118, 114];

/// Empty space around the page and between pictures (pixels).
const MARGIN: u32 = 32;
const GAP: u32 = 14;

/// The three views of a try-on side by side. The first line of the title is set large, further lines small under it;
/// the legend, such as [`crate::fit_map::legend`] drawn on [`PAPER`], stands below.
pub fn triptych(front: &Image, side: &Image, back: &Image, title: &str, legend: Option<&Image>) -> Image {
    let captions = ["front", "side", "back"];
    page(&[front, side, back], 3, &captions, title, legend)
}

/// Views side by side, each over its caption, under a title as that of [`triptych`].
pub fn views(views: &[&Image], captions: &[&str], title: &str) -> Image {
    page(views, views.len(), captions, title, None)
}

/// Pictures in rows of `columns`, each over its caption (missing captions are left out).
pub fn contact_sheet(images: &[&Image], columns: usize, captions: &[&str]) -> Image {
    page(images, columns, captions, "", None)
}

/// Lays out a page from the top: title, rows of pictures, legend.
fn page(images: &[&Image], columns: usize, captions: &[&str], title: &str, legend: Option<&Image>) -> Image {
    let columns = columns.clamp(1, images.len().max(1)) as u32;
    let cell = images
        .iter()
        .fold(Size::new(1, 1), |s, i| Size::new(s.width.max(i.size().width), s.height.max(i.size().height)));
    let caption = if captions.iter().any(|c| !c.is_empty()) { TextSize::Small.height() + 8 } else { 0 };
    let (across, down) = (cell.width + GAP, cell.height + caption + GAP);
    let rows = (images.len() as u32).div_ceil(columns);
    let width = 2 * MARGIN + columns * across - GAP;
    let head = title_height(title);
    let foot = legend.map_or(0, |l| l.size().height + MARGIN - GAP);
    let height = 2 * MARGIN + head + (rows * down).saturating_sub(GAP) + foot;
    let mut sheet = Image::filled(Size::new(width, height), PAPER);

    draw_title(&mut sheet, title);
    for (i, image) in (0..).zip(images) {
        let x = MARGIN + i % columns * across + (cell.width - image.size().width) / 2;
        let y = MARGIN + head + i / columns * down;
        sheet.paste(x as i32, y as i32, image);
        let words = captions.get(i as usize).copied().unwrap_or_default();
        let words = TextSize::Small.fitted(words, cell.width);
        let left = MARGIN + i % columns * across + (cell.width - TextSize::Small.width(&words).min(cell.width)) / 2;
        text::draw(&mut sheet, left as i32, (y + cell.height + 8) as i32, &words, TextSize::Small, QUIET);
    }
    if let Some(legend) = legend {
        let x = width.saturating_sub(legend.size().width) / 2;
        sheet.paste(x as i32, (height - MARGIN - legend.size().height) as i32, legend);
    }
    sheet
}

/// Room that the title takes, the space under it included (pixels).
fn title_height(title: &str) -> u32 {
    let lines = title.lines().count() as u32;
    if lines == 0 { 0 } else { TextSize::Large.height() + 4 + (lines - 1) * (TextSize::Small.height() + 4) + 16 }
}

fn draw_title(sheet: &mut Image, title: &str) {
    let room = sheet.size().width - 2 * MARGIN;
    let mut y = MARGIN;
    for (i, line) in title.lines().enumerate() {
        let (size, ink) = if i == 0 { (TextSize::Large, INK) } else { (TextSize::Small, QUIET) };
        text::draw(sheet, MARGIN as i32, y as i32, &size.fitted(line, room), size, ink);
        y += size.height() + 4;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_triptych_holds_all_three_views_unchanged_and_in_order() {
        let views = [[200, 0, 0], [0, 200, 0], [0, 0, 200]].map(|c| Image::filled(Size::new(60, 100), c));
        let legend = Image::filled(Size::new(80, 20), [1, 2, 3]);
        let sheet = triptych(&views[0], &views[1], &views[2], "Skirt, size M\nwaist 740 mm", Some(&legend));
        for (i, view) in (0..).zip(&views) {
            let x = MARGIN + i * (60 + GAP);
            let y = MARGIN + title_height("a\nb");
            assert_eq!(sheet.pixel(x, y), view.pixel(0, 0));
            assert_eq!(sheet.pixel(x + 59, y + 99), view.pixel(0, 0));
            assert_eq!(sheet.pixel(x, y - 1), Some(PAPER));
        }
        let ink = |colour: [u8; 3]| sheet.bytes().chunks_exact(3).filter(|p| **p == colour).count();
        assert_eq!(ink([1, 2, 3]), 80 * 20, "the legend is whole");
        let dark = |rows: std::ops::Range<u32>| {
            let pixels = rows.flat_map(|y| (0..sheet.size().width).map(move |x| (x, y)));
            pixels.filter(|&(x, y)| sheet.pixel(x, y).is_some_and(|p| p[0] < 180 && p[0].abs_diff(p[2]) < 9)).count()
        };
        let captions = MARGIN + title_height("a\nb") + 100;
        assert!(dark(MARGIN..MARGIN + 24) > 80, "the title is set");
        assert!(dark(captions..captions + 24) > 80, "the captions are set");
    }

    #[test]
    fn a_contact_sheet_takes_any_count_size_and_caption() {
        let images = [Size::new(30, 20), Size::new(10, 40), Size::new(1, 1)].map(|s| Image::filled(s, [9; 3]));
        let sheet = contact_sheet(&[&images[0], &images[1], &images[2]], 2, &["one", "two with a long caption"]);
        assert_eq!(sheet.size().width, 2 * MARGIN + 2 * 30 + GAP);
        let painted = sheet.bytes().chunks_exact(3).filter(|p| **p == [9; 3]).count();
        assert_eq!(painted, 30 * 20 + 10 * 40 + 1);
        assert!(contact_sheet(&[], 0, &[]).size().width > 0);
    }
}
