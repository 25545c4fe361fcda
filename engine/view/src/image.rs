//! Pictures in memory, PNG files and animated PNG files.

use std::io::Write;

use crate::tone_mapping;
use png::{BitDepth, ColorType, Compression, Encoder, Filter, SrgbRenderingIntent};

/// Why a picture could not be written.
#[derive(Debug, thiserror::Error)]
pub enum Error {
    /// The PNG encoder or the file under it refused.
    #[error("the PNG could not be written ({0}); check that the place is writable and has room")]
    Png(#[from] png::EncodingError),
    /// A frame is not as large as its animation.
    #[error("frame {index} is {got} but the animation is {want}; render all its frames in one size")]
    FrameSize {
        /// Number of the frame, from 0.
        index: u32,
        /// Its width and height (pixels).
        got: Size,
        /// Size of the animation (pixels).
        want: Size,
    },
    /// An animation cannot have so many or so few frames, or so many a second.
    #[error("an animation of {frames} frames at {fps} a second cannot be written; ask for at least 1 of each")]
    Tempo {
        /// Frames asked for.
        frames: u32,
        /// Frames a second asked for.
        fps: u16,
    },
}

/// Width and height (pixels).
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Hash)]
pub struct Size {
    /// Width (pixels).
    pub width: u32,
    /// Height (pixels).
    pub height: u32,
}

impl Size {
    /// A size of so many columns and rows.
    pub const fn new(width: u32, height: u32) -> Self {
        Self { width, height }
    }
}

impl std::fmt::Display for Size {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{} x {} pixels", self.width, self.height)
    }
}

/// A picture: sRGB, 8 bits a channel, rows from the top.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Image {
    size: Size,
    bytes: Vec<u8>,
}

/// Linear light of an sRGB value, both 0..1: for colours that are given as people write them.
pub fn linear(srgb: f32) -> f32 {
    tone_mapping::decode(srgb)
}

/// A rectangle of pixels.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct Patch {
    x: u32,
    y: u32,
    size: Size,
}

impl Image {
    /// A picture of one sRGB colour.
    pub fn filled(size: Size, colour: [u8; 3]) -> Self {
        Self { size, bytes: colour.repeat(size.width as usize * size.height as usize) }
    }

    /// Its pixels, row by row from the top left: red, green and blue.
    pub fn pixels_mut(&mut self) -> impl Iterator<Item = &mut [u8; 3]> {
        self.bytes.as_chunks_mut().0.iter_mut()
    }

    /// Width and height.
    pub fn size(&self) -> Size {
        self.size
    }

    /// All pixels as red, green, blue, rows from the top `[3 x width x height]`.
    pub fn bytes(&self) -> &[u8] {
        &self.bytes
    }

    /// One pixel, or `None` outside.
    pub fn pixel(&self, x: u32, y: u32) -> Option<[u8; 3]> {
        self.at(i64::from(x), i64::from(y)).map(|i| [self.bytes[i], self.bytes[i + 1], self.bytes[i + 2]])
    }

    /// Paints a rectangle; what lies outside is cut off.
    pub fn fill(&mut self, x: i32, y: i32, size: Size, colour: [u8; 3]) {
        for row in 0..size.height {
            for column in 0..size.width {
                self.mix(i64::from(x) + i64::from(column), i64::from(y) + i64::from(row), colour, 255);
            }
        }
    }

    /// Copies a picture in with its upper left corner at (x, y); what lies outside is cut off.
    pub fn paste(&mut self, x: i32, y: i32, other: &Self) {
        let width = other.size.width.max(1) as usize * 3;
        for (row, line) in (0..).zip(other.bytes.chunks_exact(width)) {
            for (column, colour) in (0..).zip(line.chunks_exact(3)) {
                let colour = [colour[0], colour[1], colour[2]];
                self.mix(i64::from(x) + column, i64::from(y) + row, colour, 255);
            }
        }
    }

    /// Lays a colour over one pixel with a coverage of 0..255.
    pub(crate) fn mix(&mut self, x: i64, y: i64, colour: [u8; 3], cover: u8) {
        let Some(at) = self.at(x, y) else { return };
        for (old, new) in self.bytes[at..at + 3].iter_mut().zip(colour) {
            let (o, n, c) = (u32::from(*old), u32::from(new), u32::from(cover));
            *old = ((o * (255 - c) + n * c + 127) / 255) as u8;
        }
    }

    /// The rows from the top, to be written.
    pub(crate) fn rows_mut(&mut self) -> impl Iterator<Item = &mut [u8]> + Send {
        self.bytes.chunks_exact_mut(self.size.width.max(1) as usize * 3)
    }

    fn at(&self, x: i64, y: i64) -> Option<usize> {
        let inside = x >= 0 && y >= 0 && x < i64::from(self.size.width) && y < i64::from(self.size.height);
        inside.then_some((y as usize * self.size.width as usize + x as usize) * 3)
    }

    /// Writes an 8-bit RGB PNG marked as sRGB.
    ///
    /// # Errors
    /// [`Error::Png`] when the writer fails or the picture has no pixels.
    pub fn write_png(&self, writer: &mut impl Write) -> Result<(), Error> {
        let mut png = encoder(writer, self.size).write_header()?;
        png.write_image_data(&self.bytes)?;
        Ok(png.finish()?)
    }

    /// The least rectangle that holds every pixel that differs; one pixel where none does.
    fn changed(&self, before: &Self) -> Patch {
        let width = self.size.width as usize;
        let (mut left, mut right, mut top, mut bottom) = (width, 0, usize::MAX, 0);
        for (i, (a, b)) in self.bytes.chunks_exact(3).zip(before.bytes.chunks_exact(3)).enumerate() {
            if a != b {
                let (x, y) = (i % width, i / width);
                (left, right) = (left.min(x), right.max(x));
                (top, bottom) = (top.min(y), bottom.max(y));
            }
        }
        if top == usize::MAX {
            return Patch { x: 0, y: 0, size: Size::new(1, 1) };
        }
        let size = Size::new((right - left + 1) as u32, (bottom - top + 1) as u32);
        Patch { x: left as u32, y: top as u32, size }
    }

    /// The bytes of one rectangle.
    fn cut(&self, patch: Patch) -> Vec<u8> {
        let width = self.size.width as usize * 3;
        let columns = patch.x as usize * 3..(patch.x + patch.size.width) as usize * 3;
        let rows = self.bytes.chunks_exact(width).skip(patch.y as usize).take(patch.size.height as usize);
        rows.flat_map(|row| &row[columns.clone()]).copied().collect()
    }
}

fn encoder<W: Write>(writer: W, size: Size) -> Encoder<'static, W> {
    let mut png = Encoder::new(writer, size.width, size.height);
    png.set_color(ColorType::Rgb);
    png.set_depth(BitDepth::Eight);
    png.set_source_srgb(SrgbRenderingIntent::Perceptual);
    png.set_compression(Compression::Balanced);
    png.set_filter(Filter::Adaptive);
    png
}

/// An animated PNG that loops for ever, written frame by frame; of each frame only the rectangle that changed.
pub struct Animation<W: Write> {
    png: png::Writer<W>,
    size: Size,
    pushed: u32,
    before: Option<Image>,
}

impl<W: Write> Animation<W> {
    /// Starts a file of exactly `frames` frames, shown `fps` a second.
    ///
    /// # Errors
    /// [`Error::Tempo`] when either is 0; [`Error::Png`] when the writer fails or the size is empty.
    pub fn new(writer: W, size: Size, frames: u32, fps: u16) -> Result<Self, Error> {
        if frames == 0 || fps == 0 {
            return Err(Error::Tempo { frames, fps });
        }
        let mut png = encoder(writer, size);
        png.set_animated(frames, 0)?;
        png.set_frame_delay(1, fps)?;
        png.validate_sequence(true);
        Ok(Self { png: png.write_header()?, size, pushed: 0, before: None })
    }

    /// Writes the next frame.
    ///
    /// # Errors
    /// [`Error::FrameSize`] when it has another size; [`Error::Png`] when the writer fails or all frames are written.
    pub fn push(&mut self, image: &Image) -> Result<(), Error> {
        if image.size != self.size {
            return Err(Error::FrameSize { index: self.pushed, got: image.size, want: self.size });
        }
        let patch = match &self.before {
            Some(before) => image.changed(before),
            None => Patch { x: 0, y: 0, size: self.size },
        };
        if self.before.is_some() {
            self.png.reset_frame_position()?;
            self.png.set_frame_dimension(patch.size.width, patch.size.height)?;
            self.png.set_frame_position(patch.x, patch.y)?;
        }
        self.png.write_image_data(&image.cut(patch))?;
        self.pushed += 1;
        self.before = Some(image.clone());
        Ok(())
    }

    /// Writes the end of the file.
    ///
    /// # Errors
    /// [`Error::Png`] when the writer fails or frames are missing.
    pub fn finish(self) -> Result<(), Error> {
        Ok(self.png.finish()?)
    }
}
