//! Pictures by the ray tracer, as arrays of RGBA.

use std::f32::consts::{FRAC_PI_2, PI};
use std::fs::File;
use std::io::BufWriter;
use std::ops::RangeInclusive;
use std::path::Path;

use toile_view::fit_map;
use toile_view::image::{Image, Size};
use toile_view::scene::{OrbitCamera, PictureScene as DrawnScene, PictureSurface};
use toile_view::trace::{TraceQuality, TracedScene};

use crate::error::{Error, Result};

/// Sides that a picture may have: fewer pixels show nothing, more are beyond any screen.
const SIDES: RangeInclusive<u32> = 16..=4320;

/// From where a picture is taken.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub enum View {
    /// From before the body.
    Front,
    /// From its left.
    Side,
    /// From behind.
    Back,
    /// Turned about the vertical from the front towards its left (degrees).
    Turned(f32),
}

/// What a picture shows of cloth.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
#[non_exhaustive]
pub enum Look {
    /// The fabrics.
    #[default]
    Fabric,
    /// The fit map, in the colours of [`fit_colour`].
    FitMap,
}

/// A picture: sRGB, 8 bits a channel, rows from the top.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Picture {
    image: Image,
}

impl Picture {
    /// Its width (px).
    pub fn width(&self) -> u32 {
        self.image.size().width
    }

    /// Its height (px).
    pub fn height(&self) -> u32 {
        self.image.size().height
    }

    /// Red, green, blue and 255 of each pixel, row by row from the top `[height * width * 4]`.
    pub fn rgba(&self) -> Vec<u8> {
        self.image.bytes().chunks_exact(3).flat_map(|rgb| [rgb[0], rgb[1], rgb[2], u8::MAX]).collect()
    }

    /// Writes it as a PNG file, over whatever was there.
    ///
    /// # Errors
    /// A file that cannot be written.
    pub fn write_png(&self, path: impl AsRef<Path>) -> Result<()> {
        let path = path.as_ref();
        let refused = |why: String| {
            Error::device(format!(
                "{} cannot be written: {why}; give the path of a file in a folder that exists",
                path.display()
            ))
        };
        let file = File::create(path).map_err(|e| refused(e.to_string()))?;
        self.image.write_png(&mut BufWriter::new(file)).map_err(|e| refused(e.to_string()))
    }
}

/// The colour of a value of the fit map, -1 (loose) .. 1 (tight): one of eight steps, sRGB, which colour-blind readers tell apart.
/// Mid grey for NaN.
pub fn fit_colour(tightness: f32) -> [u8; 3] {
    fit_map::step(tightness).map_or([128; 3], |step| fit_map::STEPS[step])
}

/// A size that a picture can have.
pub(crate) fn checked_size([width, height]: [u32; 2]) -> Result<Size> {
    if SIDES.contains(&width) && SIDES.contains(&height) {
        return Ok(Size::new(width, height));
    }
    let (least, most) = (SIDES.start(), SIDES.end());
    Err(Error::usage(format!("a picture of {width} x {height} pixels cannot be drawn; give {least} to {most} a side")))
}

/// Draws surfaces from each side; `facing` is the direction of the front (rad from +z towards +x).
pub(crate) fn draw(
    surfaces: &[PictureSurface<'_>],
    floor: bool,
    facing: f32,
    views: &[View],
    size: Size,
) -> Vec<Picture> {
    let scene = TracedScene::build(DrawnScene { surfaces, floor });
    let aspect = size.width as f32 / size.height as f32;
    let one = |view: &View| {
        let camera = OrbitCamera::framing(&scene.bounds(), facing + view.turn(), aspect);
        Picture { image: scene.render(&camera, size, TraceQuality::Still) }
    };
    views.iter().map(one).collect()
}

impl View {
    fn turn(self) -> f32 {
        match self {
            Self::Front => 0.0,
            Self::Side => FRAC_PI_2,
            Self::Back => PI,
            Self::Turned(degrees) => degrees.to_radians(),
        }
    }
}
