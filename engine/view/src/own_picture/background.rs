//! The camera's picture in the mirror: mirrored, and as large as the mirror.

use glam::Vec2;
use toile_engine::lanes::{Kernel, Lanes, Width};
use toile_sensors::source::live::ColourImage;

use super::framing::Framing;

/// What is beside a picture that is too narrow for the mirror.
const BESIDE: [u8; 3] = [28, 29, 32];

/// Shares are of so many parts.
const ONE: u32 = 64;

/// Parts of a share between two rows: 15 bits, so that a product's upper half is what is kept.
const ROW_ONE: f32 = 32_768.0;

/// A column of the mirror: the byte of the column left of it in a row of the picture, and the share of the one right of that.
type Column = (u32, u32);

/// Columns of the mirror, kept from picture to picture.
#[derive(Debug, Clone, Default)]
pub struct Background {
    columns: Vec<Option<Column>>,
    made_for: Option<(Framing, [u32; 2])>,
    /// Two rows of the picture at the mirror's columns, in parts of 1/64, and which they are: a row is looked at once, and shows in
    /// several of the mirror's `[3 * width]`.
    rows: [(Option<usize>, Vec<i16>); 2],
}

impl Background {
    /// Fills the mirror `[3 * width * height]`, between four pixels of the picture each.
    pub fn draw(&mut self, picture: &ColourImage, framing: &Framing, out: &mut [u8]) {
        let size = [picture.width, picture.height];
        if self.made_for != Some((*framing, size)) {
            self.columns.clear();
            self.columns.extend((0..framing.size.width).map(|x| column(framing, x, size[0])));
            self.made_for = Some((*framing, size));
        }
        self.rows.iter_mut().for_each(|(row, _)| *row = None);
        let last = picture.height as f32 - 1.0;
        for (y, row) in out.chunks_exact_mut(3 * framing.size.width as usize).enumerate() {
            let at = framing.to_picture(Vec2::new(0.0, y as f32)).y;
            if at < -0.5 || at > last + 0.5 {
                row.as_chunks_mut().0.fill(BESIDE);
                continue;
            }
            let at = at.clamp(0.0, last);
            let (upper, part) = (at as usize, (at.fract() * ROW_ONE) as i16);
            let lower = (upper + 1).min(last as usize);
            self.spread(picture, upper, lower);
            self.spread(picture, lower, upper);
            let [(first, one), (_, other)] = &self.rows;
            let (a, b) = if *first == Some(upper) { (one, other) } else { (other, one) };
            // Both are one row at the picture's end.
            let b = if upper == lower { a } else { b };
            Width::Eight.run(Between { a, b, share: part, out: row });
        }
    }

    /// Has a row of the picture at hand, in place of one that is not `kept`.
    fn spread(&mut self, picture: &ColourImage, wanted: usize, kept: usize) {
        if self.rows.iter().any(|(row, _)| *row == Some(wanted)) {
            return;
        }
        let (row, places) = &mut self.rows[usize::from(self.rows[0].0 == Some(kept))];
        *row = Some(wanted);
        let bytes = 3 * picture.width as usize;
        let colours = &picture.rgb[wanted * bytes..(wanted + 1) * bytes];
        places.clear();
        for column in &self.columns {
            places.extend_from_slice(
                &column.map_or(BESIDE.map(|c| i16::from(c) * ONE as i16), |column| at(colours, column)),
            );
        }
    }
}

fn column(framing: &Framing, x: u32, width: u32) -> Option<Column> {
    let at = framing.to_picture(Vec2::new(x as f32, 0.0)).x;
    let last = width as f32 - 1.0;
    if at < -0.5 || at > last + 0.5 {
        return None;
    }
    let at = at.clamp(0.0, last);
    // The last column is the one right of the last but one.
    let left = (at as u32).min(width.saturating_sub(2));
    Some((3 * left, ((at - left as f32) * ONE as f32) as u32))
}

/// A row of the picture at a column of the mirror, in parts of 1/64.
#[inline]
fn at(row: &[u8], (left, share): Column) -> [i16; 3] {
    let Some(two) = row.get(left as usize..).and_then(|r| r.first_chunk::<6>()) else {
        return BESIDE.map(|c| i16::from(c) * ONE as i16);
    };
    // At most 255 times 64.
    std::array::from_fn(|c| (u32::from(two[c]) * (ONE - share) + u32::from(two[c + 3]) * share) as i16)
}

/// A row of the mirror between two of the picture: plain code, compiled for each width that processors have.
struct Between<'a> {
    a: &'a [i16],
    b: &'a [i16],
    share: i16,
    out: &'a mut [u8],
}

impl Kernel for Between<'_> {
    type Out = ();

    #[inline(always)]
    fn run<L: Lanes>(self) {
        for ((to, a), b) in self.out.iter_mut().zip(self.a).zip(self.b) {
            *to = between(*a, *b, self.share);
        }
    }
}

/// A byte between two values in parts of 1/64, at a share in parts of 1/32768: to one step of a byte, in numbers of 16 bits, of which a
/// processor has many at once.
#[inline(always)]
fn between(a: i16, b: i16, share: i16) -> u8 {
    // The upper half of the product is half of what goes from a to b: at most 8160.
    let half = ((i32::from(b - a) * i32::from(share)) >> 16) as i16;
    ((a + 2 * half + (ONE / 2) as i16) >> ONE.ilog2()) as u8
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::image::Size;

    #[test]
    fn a_picture_as_large_as_the_mirror_is_the_picture_mirrored() {
        let rgb: Vec<u8> = (0..7 * 5 * 3).map(|i| (i * 7 % 256) as u8).collect();
        let picture = ColourImage { width: 7, height: 5, rgb };
        let mut out = vec![0; 7 * 5 * 3];
        Background::default().draw(&picture, &Framing::whole([7, 5]), &mut out);
        for (mirrored, row) in out.chunks(21).zip(picture.rgb.chunks(21)) {
            let back: Vec<u8> = row.chunks(3).rev().flatten().copied().collect();
            assert_eq!(mirrored, back);
        }
    }

    #[test]
    fn between_pixels_it_is_between_and_beside_it_is_plain() {
        let picture = ColourImage { width: 2, height: 2, rgb: vec![0, 0, 0, 200, 200, 200, 0, 0, 0, 200, 200, 200] };
        let framing = Framing::covering([2, 2], Size::new(12, 8), 0.5, [0.0, 1.0]);
        let mut out = vec![0; 12 * 8 * 3];
        Background::default().draw(&picture, &framing, &mut out);
        let row: Vec<u8> = out[..36].chunks(3).map(|p| p[1]).collect();
        assert_eq!((row[0], row[11]), (BESIDE[1], BESIDE[1]));
        assert_eq!((row[2], row[9]), (200, 0), "{row:?}");
        assert!(row[2..10].windows(2).all(|w| w[0] >= w[1]), "{row:?}");
    }
}
