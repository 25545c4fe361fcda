//! In which unit, along which axis and how high a mesh stands: found by whether a body stands in it.

use glam::Vec3;

use super::mesh::ForeignMesh;
use crate::rig::skin::SkinByHeight;
use toile_base::body::Body;

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

/// Narrowest and broadest garment (m): a child's wristband, and sleeves that are stretched out.
const NARROWEST_M: f32 = 0.04;
const BROADEST_M: f32 = 2.4;

/// How far from the skin a mesh of unknown unit may lie in the mean, as a part of how large it is (1): what is small lies near to
/// whatever it stands beside.
const MOST_OFF: f32 = 0.11;

/// Vertices that are asked how far the skin is.
const ASKED: usize = 240;

/// Of them only those so near to the middle of the body (m) if they are one in [`FEWEST_OF`] at least: how arms are held differs.
const TRUNK_M: f32 = 0.2;
const FEWEST_OF: usize = 4;

/// Share of them that may lie in the body, and how deep counts as in it (m): a mesh made for a slimmer person does.
const MOST_INSIDE: f32 = 0.4;
const INSIDE_M: f32 = 0.02;

/// Share of them that lie around the body, so that the skin under them looks away from the middle of the mesh: of trousers those
/// between the legs do not, of what lies beside a limb next to none do.
const LEAST_AROUND: f32 = 0.6;

/// How far from the skin they may lie in the mean (m), each counted as [`FAR_M`] at most: a wide skirt's hem is farther.
const MEAN_M: f32 = 0.15;
const FAR_M: f32 = 0.3;

/// Steps in which a mesh is lifted until a body stands in it (m).
const LIFT_M: f32 = 0.02;

/// Feet at 0 are no chance: a mesh is lifted only where it fits so many times better then (1).
const LIFTED: f32 = 2.0;

/// How far below the floor a mesh may reach that stands on it (m): soles.
const BELOW_M: f32 = 0.1;

/// So many times better a mesh has to fit that is to be turned (1): most files have y up.
const SELDOM: f32 = 1.2;

/// Of lifts that fit about as well, so many times the best off at most, it is the lowest (1): cloth hangs as low as it may.
const AS_WELL: f32 = 1.03;

/// Another unit that fits so much less well than the best is no doubt (1).
const SURER: f32 = 1.2;

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
    let fit = |axes: FileAxes| fit(&skin, &asked, &axes).filter(|off| *off <= MOST_OFF);
    let plain = unit.map_or(FileAxes::PLAIN, |(metres, unit)| FileAxes { metres, unit, ..FileAxes::PLAIN });
    if plausible(&plain, low, high) && self::fit(&skin, &asked, &plain).is_some() {
        return Ok(plain);
    }
    let mut readings: Vec<FileAxes> = Vec::new();
    for (metres, unit) in UNITS.into_iter().filter(|u| unit.is_none_or(|given| given == *u)) {
        readings.extend([false, true].map(|z_up| FileAxes { metres, unit, z_up, lift: 0.0 }));
    }
    readings.retain(|axes| plausible(axes, low, high));
    let standing = readings.iter().filter(|axes| axes.place(low).y.min(axes.place(high).y) > -BELOW_M);
    let mut found: Vec<_> = standing.filter_map(|axes| fit(*axes).map(|off| (off, *axes))).collect();
    let lifted = readings.iter().filter_map(|axes| best_lift(axes, [low, high], body.measures.stature, fit));
    found.extend(lifted.map(|(off, axes)| (off * LIFTED, axes)));
    found.iter_mut().filter(|(_, axes)| axes.z_up).for_each(|(off, _)| *off *= SELDOM);
    found.sort_by(|a, b| a.0.total_cmp(&b.0));
    match found[..] {
        [] => Err(no_person_inside(low, high)),
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
    (HEIGHTS_M[0]..HEIGHTS_M[1]).contains(&size.y) && (NARROWEST_M..BROADEST_M).contains(&size.x.max(size.z))
}

/// The lift with which a reading fits best, with how well it fits.
fn best_lift(
    axes: &FileAxes,
    corners: [Vec3; 2],
    stature: f32,
    fit: impl Fn(FileAxes) -> Option<f32>,
) -> Option<(f32, FileAxes)> {
    let heights = corners.map(|p| axes.place(p).y);
    let (low, high) = (heights[0].min(heights[1]), heights[0].max(heights[1]));
    // From feet on the floor to the top of the head.
    let steps = ((stature - (high - low)) / LIFT_M).max(0.0) as usize;
    let lifted = (0..=steps).map(|k| FileAxes { lift: LIFT_M * k as f32 - low, ..*axes });
    let fits: Vec<(f32, FileAxes)> = lifted.filter_map(|axes| fit(axes).map(|off| (off, axes))).collect();
    let best = fits.iter().map(|f| f.0).reduce(f32::min)?;
    fits.into_iter().find(|f| f.0 <= best * AS_WELL)
}

/// How far the asked vertices lie from the skin in the mean, as a part of how large they are (1); nothing where the body does not
/// stand in them.
fn fit(skin: &SkinByHeight<'_>, asked: &[Vec3], axes: &FileAxes) -> Option<f32> {
    let placed: Vec<Vec3> = asked.iter().map(|p| axes.place(*p)).collect();
    let trunk: Vec<Vec3> = placed.iter().copied().filter(|p| p.x.abs() < TRUNK_M).collect();
    let placed = if trunk.len() * FEWEST_OF >= placed.len() { trunk } else { placed };
    let count = placed.len().max(1) as f32;
    let middle = placed.iter().sum::<Vec3>() / count;
    let (mut inside, mut around, mut mean) = (0.0, 0.0, 0.0);
    for p in &placed {
        let Some((v, far)) = skin.distance_of(*p, |_| true) else { continue };
        inside += if far < -INSIDE_M { 1.0 / count } else { 0.0 };
        around += if skin.normal(v).dot(*p - middle) > 0.0 { 1.0 / count } else { 0.0 };
        mean += far.abs().min(FAR_M) / count;
    }
    let corner = |of: fn(Vec3, Vec3) -> Vec3| placed.iter().copied().reduce(of).unwrap_or_default();
    let size = corner(Vec3::max).distance(corner(Vec3::min)).max(HEIGHTS_M[0]);
    let stands = inside <= MOST_INSIDE && around >= LEAST_AROUND && mean <= MEAN_M;
    stands.then_some(mean / size)
}

fn no_person_inside(low: Vec3, high: Vec3) -> String {
    let [x, y, z] = (high - low).to_array();
    format!(
        "no person stands in it: it is {x:.4} by {y:.4} by {z:.4} large and from {:.4} to {:.4} high, which is no garment on a \
         body in any unit; export it in metres, y up, around a person who stands on y = 0",
        low.y, high.y
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{drafting, fabric};
    use toile_base::body::{Measures, Sex};

    fn body() -> Body {
        crate::body::build(Sex::Female, &Measures::average(Sex::Female)).unwrap()
    }

    /// A garment of our own on a body, as its mesh would be exported.
    fn worn(name: &str, body: &Body) -> ForeignMesh {
        let package = drafting::package(name).unwrap();
        let shape = package.draft("42", body, &fabric::built_in(&package.fabric).unwrap()).unwrap();
        ForeignMesh { positions: shape.worn, faces: shape.faces, ..ForeignMesh::default() }
    }

    /// The same as a file in another unit and place would have it.
    fn written(mesh: &ForeignMesh, place: impl Fn(Vec3) -> Vec3) -> ForeignMesh {
        ForeignMesh { positions: mesh.positions.iter().map(|p| place(*p)).collect(), ..mesh.clone() }
    }

    #[test]
    fn units_axes_and_heights_are_found() {
        let body = body();
        for name in ["tee", "wide-leg-trousers", "strap-dress"] {
            let mesh = worn(name, &body);
            for (metres, unit) in UNITS {
                let found = recognise(&written(&mesh, |p| p / metres), &body, None).unwrap();
                assert_eq!((found.unit, found.z_up, found.lift), (unit, false, 0.0), "{name}");
            }
            let found = recognise(&written(&mesh, |p| Vec3::new(p.x, -p.z, p.y) * 100.0), &body, None).unwrap();
            assert_eq!((found.unit, found.z_up), ("centimetres", true), "{name}");
            let found = recognise(&written(&mesh, |p| (p - Vec3::Y * 0.9) * 10.0), &body, None).unwrap();
            // Wide trousers lie nearer to the skin two hands higher.
            let sure = if name == "wide-leg-trousers" { 0.2 } else { 0.08 };
            assert!(found.unit == "decimetres" && (found.lift - 0.9).abs() < sure, "{name}: {found:?}");
        }
    }

    #[test]
    fn what_no_body_stands_in_is_refused_in_one_sentence() {
        let body = body();
        let mesh = worn("tee", &body);
        let wrong: [&dyn Fn(Vec3) -> Vec3; 4] =
            [&|p| p * 1e-5, &|p| p * 1e6, &|p| p * Vec3::new(0.05, 1.0, 0.05), &|p| p + Vec3::X * 3.0];
        for place in wrong {
            let message = recognise(&written(&mesh, place), &body, None).unwrap_err();
            assert!(message.contains("; ") && !message.contains('\n'), "{message}");
        }
    }
}
