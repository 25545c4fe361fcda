//! Garments that a shop has as photographs: a picture from the front, and one from behind, laid on the garment of their cut
//! (Ugur 2008, section 6.2: two points of known distance, a level that stays where the body has it, limits of stretch).

use std::sync::Arc;

use glam::{Vec2, Vec3};
use serde::Deserialize;

use super::fitting::{FittingLevel, StretchLimits, check_registration};
use super::picture;
use crate::texture::Atlas;
use toile_base::body::{Body, Measures};
use toile_base::garment::Garment;
use toile_base::garment::look::MeshPicture;
use toile_base::numeric::statistics;
use toile_base::texture::Texture;

/// A manifest's entry for a garment's photographs.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PhotographedGarment {
    /// The picture from the front, transparent beside the garment.
    pub front: String,
    /// The picture from behind, of the same scale and level; without it the front is seen there too.
    pub back: Option<String>,
    /// Two points of the front at the level, the one as far from the middle as the other: pixels from the upper left corner.
    pub points: [[f32; 2]; 2],
    /// How far apart they are on the garment (mm).
    pub distance_mm: f32,
    /// The level.
    pub level: FittingLevel,
    /// Limits of stretch, which decide who can wear it.
    #[serde(default)]
    pub stretches: StretchLimits,
}

/// How much longer or shorter than its cut a garment may be in its photograph, from the level down (1).
const OTHER_CUT: f32 = 0.3;

/// Height of the rows in which outlines are compared (m).
const ROW_M: f32 = 0.01;

/// How much more or less than most of its rows a row of the picture is stretched (1): where sleeves of the picture end at other heights
/// than those of the cloth, outlines do not say what meets what.
const ROW_STRETCH: f32 = 1.12;

/// A texel counts as garment from this opacity on.
const OPAQUE: u8 = 128;

impl PhotographedGarment {
    /// Checks what can be checked without the pictures.
    ///
    /// # Errors
    /// The fault and its cure.
    pub fn check(&self) -> Result<(), String> {
        check_registration(&self.points, self.distance_mm, "image")?;
        self.stretches.check("image")
    }

    /// The pictures that it names.
    pub fn files(&self) -> impl Iterator<Item = &str> {
        [Some(self.front.as_str()), self.back.as_deref()].into_iter().flatten()
    }

    /// Whether a body can wear it.
    ///
    /// # Errors
    /// The girth that is outside of what it stretches to.
    pub fn worn_by(&self, body: &Measures) -> Result<(), String> {
        self.stretches.hold(body)
    }

    /// Its pictures, read: the front's size in pixels before it was fitted, and both as textures.
    ///
    /// # Errors
    /// A picture that cannot be read, points outside of it, nothing opaque in it.
    pub fn read(&self, mut file: impl FnMut(&str) -> Result<Vec<u8>, String>) -> Result<GarmentPhotographs, String> {
        self.check()?;
        let mut one = |name: &str| {
            let bytes = file(name)?;
            let size = picture::size(&bytes).map_err(|e| format!("{name}: {e}"))?;
            let texture = crate::texture::decode(&bytes).map_err(|e| format!("{name}: {e}"))?;
            let view = PhotographView::of(texture)
                .ok_or_else(|| format!("{name} shows nothing: all of it is transparent; cut the garment out again"))?;
            Ok::<_, String>((Vec2::from_array(size.map(|n| n as f32)), view))
        };
        let (size, front) = one(&self.front)?;
        if self.points.iter().any(|p| p[0] > size.x || p[1] > size.y) {
            return Err(format!(
                "image.points lie outside of {}, which has {} x {} pixels; mark them again",
                self.front, size.x, size.y
            ));
        }
        let back = self.back.as_deref().map(one).transpose()?.map(|(_, view)| view);
        let [a, b] = self.points.map(Vec2::from);
        let metres = self.distance_mm * 1e-3 / a.distance(b);
        let anchor = 0.5 * (a + b) / size;
        Ok(GarmentPhotographs { front, back, anchor, high_m: size.y * metres, own: self.clone() })
    }
}

/// A picture of a garment, and where in each row it is.
#[derive(Debug, Clone, PartialEq)]
struct PhotographView {
    texture: Arc<Texture>,
    /// Leftmost and rightmost part of the garment in each row, 0 to 1 across `[rows]`.
    rows: Vec<[f32; 2]>,
    /// Its highest and its lowest row, 0 to 1 down.
    ends: [f32; 2],
}

impl PhotographView {
    /// None of a picture that shows nothing. What is transparent takes the nearest colour of its row, so that cloth beside
    /// the outline is no hole.
    fn of(mut texture: Texture) -> Option<Self> {
        let (width, height) = (texture.width as usize, texture.height as usize);
        let mut rows: Vec<Option<[f32; 2]>> = Vec::with_capacity(height);
        for row in texture.texels.chunks_exact_mut(width) {
            let opaque: Vec<usize> = (0..width).filter(|x| row[*x][3] >= OPAQUE).collect();
            let (Some(&first), Some(&last)) = (opaque.first(), opaque.last()) else {
                rows.push(None);
                continue;
            };
            rows.push(Some([first as f32 / width as f32, (last + 1) as f32 / width as f32]));
            let mut near = 0;
            for x in 0..width {
                while near + 1 < opaque.len() && opaque[near + 1].abs_diff(x) <= opaque[near].abs_diff(x) {
                    near += 1;
                }
                let [r, g, b, _] = row[opaque[near]];
                row[x] = [r, g, b, 255];
            }
        }
        let high = rows.iter().position(Option::is_some)?;
        let low = rows.iter().rposition(Option::is_some)?;
        let mut filled = Vec::with_capacity(height);
        for y in 0..height {
            let nearest = (0..height).filter(|r| rows[*r].is_some()).min_by_key(|r| r.abs_diff(y))?;
            filled.push(rows[nearest]?);
            if nearest != y {
                texture.texels.copy_within(nearest * width..(nearest + 1) * width, y * width);
            }
        }
        let ends = [high as f32 / height as f32, (low + 1) as f32 / height as f32];
        Some(Self { texture: Arc::new(texture), rows: filled, ends })
    }

    /// Where the garment is in the row at a height of the picture, 0 to 1 down.
    fn row(&self, down: f32) -> [f32; 2] {
        let row = (down * self.rows.len() as f32) as usize;
        self.rows[row.min(self.rows.len() - 1)]
    }
}

/// The pictures of a garment, registered.
#[derive(Debug, Clone, PartialEq)]
pub struct GarmentPhotographs {
    front: PhotographView,
    back: Option<PhotographView>,
    /// The middle of both points in the front, 0 to 1 across and down.
    anchor: Vec2,
    /// Height of the whole picture on the garment (m).
    high_m: f32,
    /// The manifest.
    own: PhotographedGarment,
}

impl GarmentPhotographs {
    /// The manifest's entry for them.
    pub fn manifest(&self) -> &PhotographedGarment {
        &self.own
    }

    /// Lays the pictures on a garment that is dressed on a body: rows of the picture on rows of the cloth, its level where the
    /// body has it, its outline on the cloth's.
    ///
    /// # Errors
    /// A cut that is much longer or shorter than what the picture shows.
    pub fn lay_on(&self, garment: &mut Garment, body: &Body) -> Result<(), String> {
        let level = self.own.level.height(&body.levels);
        let (low, high) = garment.start.iter().fold((f32::MAX, f32::MIN), |(l, h), p| (l.min(p.y), h.max(p.y)));
        let rows = ClothRows::of(&garment.start, low, high);
        // Down from the level the hems meet, upwards the upper edges.
        let below = (self.front.ends[1] - self.anchor.y) * self.high_m;
        let cut = level - low;
        if below > 0.05 && cut > 0.05 && (below / cut - 1.0).abs() > OTHER_CUT {
            return Err(format!(
                "its photograph shows {:.0} mm below the {:?} and its cut has {:.0} mm; choose another cut, or measure image.distance_mm again",
                below * 1e3,
                self.own.level,
                cut * 1e3
            ));
        }
        let behind = self.back.as_ref().unwrap_or(&self.front);
        let atlas = Atlas::of(&[self.front.texture.clone(), behind.texture.clone()]).ok_or("it has no pictures")?;
        let usual = self.scale(&rows, [low, level, high]);
        let place = |view: &PhotographView, p: Vec3, side: f32| {
            let down = self.down(view, p.y, [low, level, high]);
            let ([from, to], [left, right]) = (view.row(down), rows.at(p.y));
            let scale = ((to - from) / (right - left).max(1e-3)).clamp(usual / ROW_STRETCH, usual * ROW_STRETCH);
            // From behind the wearer's left is on the left. Beside the outline the picture has the nearest colour.
            let across = 0.5 * (from + to) + side * scale * (p.x - 0.5 * (left + right));
            Vec2::new(across.clamp(0.0, 0.999), (1.0 - down).clamp(0.0, 0.999))
        };
        let corners = garment.triangles.iter().map(|t| {
            let [a, b, c] = t.map(|v| garment.start[v as usize]);
            let side = if (b - a).cross(c - a).z < 0.0 { -1.0 } else { 1.0 };
            let view = if side > 0.0 { &self.front } else { behind };
            atlas.place(usize::from(side < 0.0), [a, b, c].map(|p| place(view, p, side)))
        });
        let corners = corners.collect();
        garment.look_mut().picture = Some(MeshPicture { corners, texture: atlas.texture.clone() });
        Ok(())
    }

    /// How much of the picture's breadth a metre of most of the cloth's rows takes (1/m).
    fn scale(&self, rows: &ClothRows, levels: [f32; 3]) -> f32 {
        let row = |(i, [left, right]): (usize, &[f32; 2])| {
            let down = self.down(&self.front, rows.low + (i as f32 + 0.5) * ROW_M, levels);
            let [from, to] = self.front.row(down);
            (to - from) / (right - left).max(1e-3)
        };
        statistics::median_of(rows.sides.iter().enumerate().map(row)).unwrap_or(1.0)
    }

    /// How far down the picture a height of the cloth is, 0 to 1.
    fn down(&self, view: &PhotographView, y: f32, [low, level, high]: [f32; 3]) -> f32 {
        let [top, bottom] = view.ends;
        let anchor = self.anchor.y.clamp(top, bottom);
        let part = |span: f32| span.max(1e-3);
        if low >= level || high <= level {
            // The level lies beyond the garment: all of it between its ends.
            return top + (bottom - top) * ((high - y) / part(high - low)).clamp(0.0, 1.0);
        }
        if y < level {
            anchor + (bottom - anchor) * ((level - y) / part(level - low)).clamp(0.0, 1.0)
        } else {
            anchor - (anchor - top) * ((y - level) / part(high - level)).clamp(0.0, 1.0)
        }
    }
}

/// How far cloth reaches to both sides, by height.
struct ClothRows {
    low: f32,
    sides: Vec<[f32; 2]>,
}

impl ClothRows {
    fn of(points: &[Vec3], low: f32, high: f32) -> Self {
        let count = ((high - low) / ROW_M).ceil().max(1.0) as usize + 1;
        let mut sides = vec![[f32::MAX, f32::MIN]; count];
        for p in points {
            let row = ((p.y - low) / ROW_M) as usize;
            // Cells are wider than rows: each point counts for its neighbours too.
            for side in &mut sides[row.saturating_sub(1)..(row + 2).min(count)] {
                *side = [side[0].min(p.x), side[1].max(p.x)];
            }
        }
        for i in 1..count {
            if sides[i][0] > sides[i][1] {
                sides[i] = sides[i - 1];
            }
        }
        Self { low, sides }
    }

    fn at(&self, y: f32) -> [f32; 2] {
        let row = ((y - self.low) / ROW_M).max(0.0);
        let (i, part) = (row as usize, row.fract());
        let [a, b] = [i, i + 1].map(|i| self.sides[i.min(self.sides.len() - 1)]);
        [0, 1].map(|k| a[k] + (b[k] - a[k]) * part)
    }
}

#[cfg(test)]
mod tests {
    use std::io::Cursor;

    use image::{ImageFormat, Rgba, RgbaImage};

    use super::*;
    use crate::drafting;
    use toile_base::body::Sex;

    /// A tee from the front: red where the wearer's right is, green at the left, its lower third blue, nothing beside it.
    fn photograph() -> Vec<u8> {
        let picture = RgbaImage::from_fn(400, 500, |x, y| match (x, y) {
            (0..50 | 350.., _) | (_, 0..40 | 460..) => Rgba([0; 4]),
            (_, 320..) => Rgba([0, 0, 255, 255]),
            (..200, _) => Rgba([255, 0, 0, 255]),
            _ => Rgba([0, 255, 0, 255]),
        });
        let mut bytes = Cursor::new(Vec::new());
        picture.write_to(&mut bytes, ImageFormat::Png).unwrap();
        bytes.into_inner()
    }

    fn said() -> PhotographedGarment {
        let text = "front = \"f.png\"\npoints = [[80, 70], [320, 70]]\ndistance_mm = 380\nlevel = \"shoulders\"\n\
            [stretches]\nchest = [820, 960]\n";
        toml::from_str(text).unwrap()
    }

    fn tee() -> (Body, Garment) {
        let package = drafting::package("tee").unwrap();
        let body = package.body_of("38").unwrap().unwrap();
        let garment = package.dress("38", &body).unwrap();
        assert_eq!(body.sex, Sex::Female);
        (body, garment)
    }

    fn colour(garment: &Garment, at: impl Fn(Vec3) -> bool, front: bool) -> [u8; 3] {
        let picture = garment.look.picture.as_ref().unwrap();
        let (w, h) = (picture.texture.width as f32, picture.texture.height as f32);
        let found = garment.triangles.iter().zip(&picture.corners).find(|(t, _)| {
            let [a, b, c] = t.map(|v| garment.start[v as usize]);
            at((a + b + c) / 3.0) && ((b - a).cross(c - a).z > 0.0) == front
        });
        let (_, corners) = found.expect("a triangle is there");
        let uv = (corners[0] + corners[1] + corners[2]) / 3.0;
        let [r, g, b, a] = picture.texture.texels[((1.0 - uv.y) * h) as usize * w as usize + (uv.x * w) as usize];
        assert_eq!(a, 255);
        [r, g, b]
    }

    #[test]
    fn left_is_left_from_both_sides_and_the_hem_is_the_hem() {
        let (body, mut garment) = tee();
        let photographs = said().read(|_| Ok(photograph())).unwrap();
        photographs.lay_on(&mut garment, &body).unwrap();
        let chest = body.levels.chest;
        let high = |p: Vec3| (p.y - chest).abs() < 0.03;
        assert_eq!(colour(&garment, |p| high(p) && (0.04..0.1).contains(&p.x), true), [0, 255, 0]);
        assert_eq!(colour(&garment, |p| high(p) && (-0.1..-0.04).contains(&p.x), true), [255, 0, 0]);
        // Without a picture from behind the front is seen there: its left on the left.
        assert_eq!(colour(&garment, |p| high(p) && (0.04..0.1).contains(&p.x), false), [255, 0, 0]);
        let low = garment.start.iter().fold(f32::MAX, |l, p| l.min(p.y));
        // Resized, the picture mixes colours by a few of 255.
        assert!(colour(&garment, |p| p.y < low + 0.05, true)[2] > 240);
    }

    /// Sleeves of the picture end 60 mm lower than the cloth's: its rows there were half as wide again.
    #[test]
    fn rows_beside_sleeves_are_not_stretched() {
        let (body, mut garment) = tee();
        let mut photograph = image::load_from_memory(&photograph()).unwrap().into_rgba8();
        for (x, y, texel) in photograph.enumerate_pixels_mut() {
            let sleeve = y > 60 && y < 260 && (10..390).contains(&x);
            *texel = if sleeve { Rgba([9, 9, 9, 255]) } else { *texel };
        }
        let mut bytes = Cursor::new(Vec::new());
        photograph.write_to(&mut bytes, ImageFormat::Png).unwrap();
        let bytes = bytes.into_inner();
        said().read(|_| Ok(bytes.clone())).unwrap().lay_on(&mut garment, &body).unwrap();
        let picture = garment.look.picture.as_ref().unwrap();
        let mut scales = Vec::new();
        for (t, corners) in garment.triangles.iter().zip(&picture.corners) {
            let [a, b, c] = t.map(|v| garment.start[v as usize]);
            if (b - a).cross(c - a).z > 1e-5 && a.x.abs() < 0.1 {
                for (p, q, u, v) in [(a, b, corners[0], corners[1]), (b, c, corners[1], corners[2])] {
                    if (q.x - p.x).abs() > 0.01 && (q.y - p.y).abs() < 0.002 {
                        scales.push((v.x - u.x) / (q.x - p.x));
                    }
                }
            }
        }
        assert!(scales.len() > 20, "{}", scales.len());
        let usual = statistics::median_of(scales.iter().copied()).unwrap();
        let off = scales.iter().filter(|s| (**s / usual).max(usual / **s) > ROW_STRETCH * ROW_STRETCH).count();
        assert!(off * 20 < scales.len(), "{off} of {} edges", scales.len());
    }

    #[test]
    fn a_picture_of_another_cut_is_refused() {
        let (body, mut garment) = tee();
        let long = PhotographedGarment { distance_mm: 900.0, ..said() };
        let refused = long.read(|_| Ok(photograph())).unwrap().lay_on(&mut garment, &body).unwrap_err();
        assert!(refused.contains("choose another cut") && garment.look.picture.is_none(), "{refused}");
    }

    #[test]
    fn girths_beyond_its_stretch_are_named() {
        let body = |chest: f32| Measures { chest_girth: chest, ..tee().0.measures };
        assert_eq!(said().worn_by(&body(0.9)), Ok(()));
        let refused = said().worn_by(&body(1.012)).unwrap_err();
        assert!(refused.contains("820 to 960 mm") && refused.contains("1012"), "{refused}");
    }

    #[test]
    fn bad_registrations_are_one_sentence() {
        let nothing = || {
            let mut bytes = Cursor::new(Vec::new());
            RgbaImage::new(8, 8).write_to(&mut bytes, ImageFormat::Png).unwrap();
            bytes.into_inner()
        };
        let near = PhotographedGarment { points: [[80.0, 70.0], [81.0, 70.0]], ..said() };
        let outside = PhotographedGarment { points: [[80.0, 70.0], [900.0, 70.0]], ..said() };
        let inches = PhotographedGarment { distance_mm: 15.0, ..said() };
        let mut limits = said();
        limits.stretches.hip = Some([900.0, 800.0]);
        for (garment, picture, wanted) in [
            (near, photograph(), "image.points"),
            (outside, photograph(), "outside of f.png"),
            (inches, photograph(), "image.distance_mm"),
            (limits, photograph(), "image.stretches.hip"),
            (said(), b"GIF89a".to_vec(), "no picture"),
            (said(), photograph()[..60].to_vec(), "f.png"),
            (said(), nothing(), "shows nothing"),
        ] {
            let refused = garment.read(|_| Ok(picture.clone())).unwrap_err();
            assert!(refused.contains(wanted) && !refused.contains('\n'), "{refused}");
        }
    }
}
