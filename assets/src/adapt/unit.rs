//! In which unit, along which axis and how high a mesh stands: found by whether a body stands in it.

use glam::Vec3;

use super::mesh::ForeignMesh;
use crate::body::Body;
use crate::rig::skin::SkinByHeight;

/// Units that meshes come in: metres a unit, and its name.
pub const UNITS: [(f32, &str); 6] = [
    (1.0, "metres"),
    (0.1, "decimetres"),
    (0.01, "centimetres"),
    (0.001, "millimetres"),
    (0.0254, "inches"),
    (0.3048, "feet"),
];

/// A garment is between a wristband and a bridal train high (m).
const HEIGHTS_M: [f32; 2] = [0.02, 2.4];

/// Broadest garment (m): sleeves that are stretched out.
const BROADEST_M: f32 = 2.4;

/// Vertices that are asked how far the skin is.
const ASKED: usize = 120;

/// Share of them that may lie in the body, and how deep counts as in it (m): arms may be held otherwise.
const MOST_INSIDE: f32 = 0.3;
const INSIDE_M: f32 = 0.02;

/// How far from the skin they may lie in the mean (m), each counted as [`FAR_M`] at most: a wide skirt's hem is farther.
const MEAN_M: f32 = 0.15;
const FAR_M: f32 = 0.3;

/// Steps in which a mesh is lifted until a body stands in it (m).
const LIFT_M: f32 = 0.02;

/// Another unit that fits so much less well than the best is no doubt (1).
const SURER: f32 = 1.3;

/// How the numbers of a file are read.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FileAxes {
    /// Metres a unit.
    pub metres: f32,
    /// Name of the unit.
    pub unit: &'static str,
    /// Whether z points up, so that the front looks along -y.
    pub z_up: bool,
    /// By how much everything is lifted afterwards (m).
    pub lift: f32,
}

impl FileAxes {
    /// As it should be: metres, y up, feet at 0.
    pub const PLAIN: Self = Self { metres: 1.0, unit: "metres", z_up: false, lift: 0.0 };

    /// A place of the file in metres, y up, the floor at 0.
    pub fn place(&self, p: Vec3) -> Vec3 {
        let p = if self.z_up { Vec3::new(p.x, p.z, -p.y) } else { p };
        p * self.metres + Vec3::Y * self.lift
    }

    /// In words.
    pub fn words(&self) -> String {
        let up = if self.z_up { "z" } else { "y" };
        let lift = if self.lift == 0.0 { String::new() } else { format!(", lifted by {:.0} mm", self.lift * 1e3) };
        format!("{}, {up} up{lift}", self.unit)
    }
}

/// Finds how a mesh's numbers are to be read, so that `body` stands in it; `unit` is given where the user knows it.
///
/// # Errors
/// A sentence, to stand behind the file's name, where no reading fits or two do.
pub fn recognise(mesh: &ForeignMesh, body: &Body, unit: Option<(f32, &'static str)>) -> Result<FileAxes, String> {
    let skin = SkinByHeight::new(body);
    let [low, high] = mesh.bounds();
    let asked: Vec<Vec3> = mesh.positions.iter().step_by(mesh.positions.len().div_ceil(ASKED)).copied().collect();
    let fit = |axes: FileAxes| fit(&skin, &asked, &axes);
    let plain = unit.map_or(FileAxes::PLAIN, |(metres, unit)| FileAxes { metres, unit, ..FileAxes::PLAIN });
    if plausible(&plain, low, high) && fit(plain).is_some() {
        return Ok(plain);
    }
    let mut found: Vec<(f32, FileAxes)> = Vec::new();
    for (metres, unit) in UNITS.into_iter().filter(|u| unit.is_none_or(|given| given == *u)) {
        for z_up in [false, true] {
            let axes = FileAxes { metres, unit, z_up, lift: 0.0 };
            if plausible(&axes, low, high) {
                found.extend(best_lift(&axes, [low, high], body.measures.stature, fit));
            }
        }
    }
    found.sort_by(|a, b| a.0.total_cmp(&b.0));
    match found[..] {
        [] => Err(nobody(low, high)),
        [(best, axes), ..] => match found.iter().find(|(f, a)| *f < best * SURER && a.unit != axes.unit) {
            Some((_, other)) => Err(format!(
                "its numbers may be {} or {}; name the unit in a TOML file beside it, unit = \"{}\", or export it in metres",
                axes.unit, other.unit, axes.unit
            )),
            None => Ok(axes),
        },
    }
}

fn plausible(axes: &FileAxes, low: Vec3, high: Vec3) -> bool {
    let size = (axes.place(high) - axes.place(low)).abs();
    (HEIGHTS_M[0]..HEIGHTS_M[1]).contains(&size.y) && size.x.max(size.z) < BROADEST_M
}

/// The lift with which a reading fits best, 0 if it fits so; with how well it fits.
fn best_lift(
    axes: &FileAxes,
    corners: [Vec3; 2],
    stature: f32,
    fit: impl Fn(FileAxes) -> Option<f32>,
) -> Option<(f32, FileAxes)> {
    if let Some(good) = fit(*axes) {
        return Some((good, *axes));
    }
    let heights = corners.map(|p| axes.place(p).y);
    let (low, high) = (heights[0].min(heights[1]), heights[0].max(heights[1]));
    // From feet on the floor to the top of the head.
    let steps = ((stature - (high - low)) / LIFT_M).max(0.0) as usize;
    let lifted = (0..=steps).map(|k| FileAxes { lift: LIFT_M * k as f32 - low, ..*axes });
    lifted.filter_map(|axes| fit(axes).map(|f| (f, axes))).min_by(|a, b| a.0.total_cmp(&b.0))
}

/// How far the asked vertices lie from the skin in the mean (m); nothing where the body does not stand in them.
fn fit(skin: &SkinByHeight<'_>, asked: &[Vec3], axes: &FileAxes) -> Option<f32> {
    let far: Vec<f32> =
        asked.iter().filter_map(|p| skin.distance_of(axes.place(*p), |_| true)).map(|(_, d)| d).collect();
    let count = far.len().max(1) as f32;
    let inside = far.iter().filter(|d| **d < -INSIDE_M).count() as f32 / count;
    let mean = far.iter().map(|d| d.abs().min(FAR_M)).sum::<f32>() / count;
    (inside <= MOST_INSIDE && mean <= MEAN_M).then_some(mean + inside * MEAN_M)
}

fn nobody(low: Vec3, high: Vec3) -> String {
    let [x, y, z] = (high - low).to_array();
    format!(
        "nobody stands in it: it is {x:.4} by {y:.4} by {z:.4} large and from {:.4} to {:.4} high, which is no garment on a \
         body in any unit; export it in metres, y up, around a person who stands on y = 0",
        low.y, high.y
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::body::{Measures, Sex};
    use crate::wardrobe;

    fn body() -> Body {
        Body::build(Sex::Female, &Measures::average(Sex::Female)).unwrap()
    }

    /// A garment of our own as a file in another unit and place would have it.
    fn written(name: &str, place: impl Fn(Vec3) -> Vec3) -> ForeignMesh {
        let shape = wardrobe::style(name).unwrap().draft(if name == "t-shirt" { "M" } else { "42" }, &body()).unwrap();
        let mut mesh = ForeignMesh { positions: shape.worn, faces: shape.faces, ..ForeignMesh::default() };
        mesh.positions.iter_mut().for_each(|p| *p = place(*p));
        mesh
    }

    #[test]
    fn units_axes_and_heights_are_found() {
        let body = body();
        for name in ["t-shirt", "wide-trousers", "sun-dress"] {
            for (metres, unit) in UNITS {
                let found = recognise(&written(name, |p| p / metres), &body, None).unwrap();
                assert_eq!((found.unit, found.z_up, found.lift), (unit, false, 0.0), "{name}");
            }
            let found = recognise(&written(name, |p| Vec3::new(p.x, -p.z, p.y) * 100.0), &body, None).unwrap();
            assert_eq!((found.unit, found.z_up), ("centimetres", true), "{name}");
            let found = recognise(&written(name, |p| (p - Vec3::Y * 0.9) * 10.0), &body, None).unwrap();
            assert!(found.unit == "decimetres" && (found.lift - 0.9).abs() < 0.06, "{name}: {found:?}");
        }
    }

    #[test]
    fn what_no_body_stands_in_is_refused_in_one_sentence() {
        let body = body();
        let wrong: [&dyn Fn(Vec3) -> Vec3; 4] =
            [&|p| p * 1e-5, &|p| p * 1e6, &|p| p * Vec3::new(0.05, 1.0, 0.05), &|p| p + Vec3::X * 3.0];
        for place in wrong {
            let message = recognise(&written("t-shirt", place), &body, None).unwrap_err();
            assert!(message.contains("; ") && !message.contains('\n'), "{message}");
        }
    }
}
