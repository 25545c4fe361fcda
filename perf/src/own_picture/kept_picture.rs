//! Pictures to look at: what the camera saw, what the mirror shows, and the truth.

use toile_view::image::{Image, Size};

use super::follower::Follower;
use super::outline::SIZE;
use super::truth::{Actor, TruthMoment};

/// Columns around the middle that a kept picture shows, and by how much it is made smaller.
const KEPT_COLUMNS: usize = 540;
const SMALLER: usize = 3;

/// Camera's picture, mirror and truth beside each other.
pub fn beside(follower: &mut Follower, actor: &mut Actor, moment: &TruthMoment) -> Image {
    let drawn = follower.draw(moment);
    let [width, height] = SIZE.map(|n| n as usize);
    let (across, down) = (KEPT_COLUMNS / SMALLER, height / SMALLER);
    let mut image = Image::filled(Size::new(3 * across as u32, down as u32), [0; 3]);
    let camera = (&moment.picture.rgb, [moment.picture.width as usize, moment.picture.height as usize], true);
    let real = actor.real(moment);
    let real = (&real.rgb, [real.width as usize, real.height as usize], true);
    let mirror = (&drawn.rgb, [width, height], false);
    let panels = [camera, mirror, real];
    for (at, pixel) in image.pixels_mut().enumerate() {
        let (panel, x, y) = (at % (3 * across) / across, at % across, at / (3 * across));
        let (bytes, [w, h], mirrored) = panels[panel];
        // The mean of a square of the mirror's pixels.
        let mut sum = [0_usize; 3];
        for (dx, dy) in (0..SMALLER * SMALLER).map(|i| (i % SMALLER, i / SMALLER)) {
            let (mx, my) = ((width - KEPT_COLUMNS) / 2 + x * SMALLER + dx, y * SMALLER + dy);
            let mx = if mirrored { width - 1 - mx } else { mx };
            let from = 3 * ((my * h / height) * w + mx * w / width);
            sum.iter_mut().zip(&bytes[from..from + 3]).for_each(|(sum, c)| *sum += usize::from(*c));
        }
        *pixel = sum.map(|s| (s / (SMALLER * SMALLER)) as u8);
    }
    image
}
