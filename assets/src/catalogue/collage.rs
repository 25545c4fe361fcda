//! Garments that a shop has as photographs alone: pictures from the front, the side and behind, with an arm layer, laid on the picture
//! of a body (Ugur 2008, sections 6.1 and 6.2: eight layers of wearing, seven fitting levels, limits of stretch).

use serde::Deserialize;

use super::fitting::{FittingLevel, StretchLimits, check_registration};
use super::limits::MAX_PIXELS;
use super::package::is_plain;
use super::picture::{self, Picture};

toile_base::named! {
    /// In which layer a garment is worn, the innermost first.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Deserialize)]
    #[serde(rename_all = "kebab-case")]
    pub enum WearingLayer {
        /// Underwear.
        Underwear = "underwear",
        /// Tank tops and slips.
        TankTops = "tank-tops",
        /// Shirts, skirts, trousers.
        Shirts = "shirts",
        /// Jackets and cardigans.
        Jackets = "jackets",
        /// Belts and jewellery.
        Belts = "belts",
        /// Coats.
        Coats = "coats",
        /// Scarves and shawls.
        Scarves = "scarves",
        /// Shoes, bags, slippers.
        Shoes = "shoes",
    }
}

/// Number of layers.
pub const LAYERS: usize = 8;

/// Most pixels along a side at which a photograph is kept: a picture of a body has no more rows.
const SIDE: u32 = 2_048;

/// Most characters of a garment's name.
const MAX_NAME: usize = 80;

/// One side of a garment.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CollageView {
    /// The picture, transparent beside the garment.
    pub picture: String,
    /// A picture of the same size, white where the garment lies on the arms; without it, it lies on none.
    pub arms: Option<String>,
    /// Two points at the level, the one as far from the middle of the body as the other: pixels from the upper left corner.
    pub points: [[f32; 2]; 2],
    /// How far apart they are on the garment, as a ruler lies before it (mm).
    pub distance_mm: f32,
}

/// A garment of photographs.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CollageGarment {
    /// Its name.
    pub name: String,
    /// The layer in which it is worn.
    pub layer: WearingLayer,
    /// Level at which it stays in place on the body.
    pub level: FittingLevel,
    /// Limits of stretch, which decide who can wear it.
    #[serde(default)]
    pub stretches: StretchLimits,
    /// From the front.
    pub front: Option<CollageView>,
    /// From the wearer's left.
    pub side: Option<CollageView>,
    /// From behind.
    pub back: Option<CollageView>,
}

/// A garment's pictures, read.
#[derive(Debug, Clone, PartialEq)]
pub struct CollagePictures {
    /// Colours times opacity, and opacity.
    pub picture: Picture,
    /// How much of each pixel lies on an arm, of 255 `[height][width]`; empty without an arm layer.
    pub arms: Vec<u8>,
    /// The two points in the pixels of `picture`.
    pub points: [[f32; 2]; 2],
    /// How far apart they are (m).
    pub distance: f32,
}

impl CollageGarment {
    /// Reads and checks a garment's file.
    ///
    /// # Errors
    /// The fault and its cure.
    pub fn parse(text: &str) -> Result<Self, String> {
        let garment: Self = toml::from_str(text).map_err(|e| {
            let line = crate::toml_keys::place(text, e.span().map_or(0, |s| s.start)).0;
            format!("line {line}: {}; see docs/collage.md", e.message())
        })?;
        garment.check()?;
        Ok(garment)
    }

    fn check(&self) -> Result<(), String> {
        if self.name.trim().is_empty() || self.name.chars().count() > MAX_NAME {
            return Err(format!("name must have 1 to {MAX_NAME} characters; correct it"));
        }
        self.stretches.check("garment").map_err(|e| e.replace("garment.stretches", "stretches"))?;
        let views = [("front", &self.front), ("side", &self.side), ("back", &self.back)];
        if views.iter().all(|(_, view)| view.is_none()) {
            return Err("it has no picture; give [front], [side] or [back]".to_owned());
        }
        for (table, view) in views {
            let Some(view) = view else { continue };
            check_registration(&view.points, view.distance_mm, table)?;
            let bad = [Some(&view.picture), view.arms.as_ref()].into_iter().flatten().find(|f| !is_plain(f));
            if let Some(bad) = bad {
                let shown: String = bad.chars().take(80).filter(|c| !c.is_control()).collect();
                return Err(format!("{table}: {shown} is no plain file name; keep pictures beside the garment's file"));
            }
        }
        Ok(())
    }

    /// Its views, from the front, the side and behind.
    pub fn views(&self) -> [Option<&CollageView>; 3] {
        [self.front.as_ref(), self.side.as_ref(), self.back.as_ref()]
    }

    /// Reads the pictures of its views; `file` gives the bytes of a file beside the garment's own.
    ///
    /// # Errors
    /// A picture that cannot be read, shows nothing or has no transparent part, points outside of it, an arm layer of another size.
    pub fn read(
        &self,
        mut file: impl FnMut(&str) -> Result<Vec<u8>, String>,
    ) -> Result<[Option<CollagePictures>; 3], String> {
        let mut one = |view: Option<&CollageView>| view.map(|v| v.read(&mut file)).transpose();
        let [front, side, back] = self.views();
        Ok([one(front)?, one(side)?, one(back)?])
    }
}

impl CollageView {
    fn read(&self, file: &mut impl FnMut(&str) -> Result<Vec<u8>, String>) -> Result<CollagePictures, String> {
        let bytes = file(&self.picture)?;
        let name = &self.picture;
        let [width, height] = size(&bytes).map_err(|e| format!("{name}: {e}"))?;
        let picture = Picture::decode(&bytes, SIDE).map_err(|e| format!("{name}: {e}"))?;
        let shown = picture.pixels.iter().filter(|p| p[3] >= 128).count();
        if shown == 0 {
            return Err(format!("{name} shows nothing: all of it is transparent; cut the garment out again"));
        }
        if picture.pixels.iter().all(|p| p[3] == 255) {
            return Err(format!("{name} is nowhere transparent; cut the garment out of its background"));
        }
        if self.points.iter().any(|p| p[0] > width || p[1] > height) {
            return Err(format!("points lie outside of {name}, which has {width} x {height} pixels; mark them again"));
        }
        let arms = match &self.arms {
            Some(arms) => {
                let bytes = file(arms)?;
                let own = size(&bytes).map_err(|e| format!("{arms}: {e}"))?;
                if own != [width, height] {
                    return Err(format!(
                        "{arms} has {} x {} pixels and {name} {width} x {height}; save both at one size",
                        own[0], own[1]
                    ));
                }
                let mask = Picture::decode(&bytes, SIDE).map_err(|e| format!("{arms}: {e}"))?;
                mask.pixels.iter().map(|[r, g, b, _]| *r.max(g).max(b)).collect()
            }
            None => Vec::new(),
        };
        let shrunk = picture.width.max(picture.height) as f32 / width.max(height);
        Ok(CollagePictures {
            points: self.points.map(|p| p.map(|c| c * shrunk)),
            distance: self.distance_mm * 1e-3,
            picture,
            arms,
        })
    }
}

/// Width and height of a picture in a file.
fn size(bytes: &[u8]) -> Result<[f32; 2], String> {
    let size @ [width, height] = picture::size(bytes)?;
    if width.max(height) > MAX_PIXELS {
        return Err(format!("it has {width} x {height} pixels, and at most {MAX_PIXELS} are shown; make it smaller"));
    }
    Ok(size.map(|n| n as f32))
}

#[cfg(test)]
mod tests {
    use std::io::Cursor;

    use image::{ImageFormat, Rgba, RgbaImage};

    use super::*;
    use toile_base::body::Measures;

    const SAID: &str = "name = \"Tee\"\nlayer = \"shirts\"\nlevel = \"shoulders\"\n[front]\npicture = \"f.png\"\narms = \"a.png\"\n\
        points = [[10, 8], [50, 8]]\ndistance_mm = 400\n[stretches]\nchest = [820, 960]\n";

    fn png(width: u32, height: u32, pixel: impl Fn(u32, u32) -> [u8; 4]) -> Vec<u8> {
        let mut bytes = Cursor::new(Vec::new());
        let picture = RgbaImage::from_fn(width, height, |x, y| Rgba(pixel(x, y)));
        picture.write_to(&mut bytes, ImageFormat::Png).unwrap();
        bytes.into_inner()
    }

    fn tee() -> Vec<u8> {
        png(60, 80, |x, y| if (5..55).contains(&x) && y > 4 { [200, 10, 10, 255] } else { [0; 4] })
    }

    #[test]
    fn a_garment_of_photographs_is_read_with_its_arm_layer() {
        let garment = CollageGarment::parse(SAID).unwrap();
        assert!(garment.layer < WearingLayer::Coats && WearingLayer::ALL.len() == LAYERS);
        let arms = png(60, 80, |x, _| if x < 15 { [255; 4] } else { [0, 0, 0, 255] });
        let [front, side, back] = garment.read(|f| Ok(if f == "f.png" { tee() } else { arms.clone() })).unwrap();
        let front = front.unwrap();
        assert!(side.is_none() && back.is_none());
        assert_eq!((front.arms[0], front.arms[30], front.points[1]), (255, 0, [50.0, 8.0]));
        let woman = Measures::average(toile_base::body::Sex::Female);
        let large = Measures { chest_girth: 1.2, ..woman };
        assert!(garment.stretches.hold(&large).unwrap_err().contains("820 to 960 mm"));
        assert!((garment.stretches.most().unwrap() - 960.0 / 820.0).abs() < 1e-6);
    }

    #[test]
    fn bad_garments_are_one_sentence() {
        let parse = |from: &str, to: &str| CollageGarment::parse(&SAID.replace(from, to)).unwrap_err();
        assert!(parse("\"shirts\"", "\"shirt\"").contains("line 2"));
        assert!(parse("distance_mm = 400", "distance_mm = 4").contains("front.distance_mm must lie from"));
        assert!(parse("[[10, 8], [50, 8]]", "[[10, 8], [12, 8]]").contains("front.points"));
        assert!(parse("f.png", "../f.png").contains("is no plain file name"));
        assert!(parse("[820, 960]", "[960, 820]").contains("stretches.chest"));
        assert!(
            CollageGarment::parse("name = \"x\"\nlayer = \"coats\"\nlevel = \"neck\"\n")
                .unwrap_err()
                .contains("no picture")
        );
        let garment = CollageGarment::parse(SAID).unwrap();
        let read = |f: Vec<u8>, a: Vec<u8>| {
            let refused = garment.read(|n| Ok(if n == "f.png" { f.clone() } else { a.clone() })).unwrap_err();
            assert!(!refused.contains('\n'), "{refused}");
            refused
        };
        let clear = png(60, 80, |_, _| [0; 4]);
        let full = png(60, 80, |_, _| [9, 9, 9, 255]);
        assert!(read(clear, tee()).contains("shows nothing"));
        assert!(read(full, tee()).contains("nowhere transparent"));
        assert!(read(tee(), png(30, 40, |_, _| [0; 4])).contains("save both at one size"));
        assert!(read(b"GIF89a".to_vec(), tee()).contains("no picture"));
        assert!(read(png(40, 80, |x, _| [9, 9, 9, if x < 9 { 0 } else { 255 }]), tee()).contains("outside of f.png"));
    }
}
