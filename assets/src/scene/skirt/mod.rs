//! The skirt: the scene on which Toile and its peers are timed, with the same geometry, motion and fabric for each.
//!
//! A cone hangs from a ring around the waist: radius 0.18 m at 1.08 m above the floor, 0.42 m at 0.30 m. Its ring is
//! pinned and follows the root; a body of 16 spheres and 28 tapered capsules walks in it.

mod body;
mod irregular;
mod surface;

use std::f64::consts::TAU;

use glam::Vec3;

use toile_bake::Shape;
use toile_base::fabric::loop_widths::LoopWidths;
use toile_base::fabric::stretch_curve::{ShearLock, StretchCurve, StretchCurves};
use toile_base::fabric::{Fabric, USUAL_SHEEN, USUAL_THREADS, Weave};

pub use body::{CAPSULES, JOINTS, SPHERES, SkirtMotion, root, spheres};
pub use irregular::irregular;
pub use surface::hem;
use surface::{point, push};

/// Mass of the whole skirt, the pinned ring included (kg).
pub const MASS_KG: f32 = 0.31;

/// The scene's wind: velocity (m/s), drag and lift coefficient.
pub const WIND: (Vec3, f32, f32) = (Vec3::new(1.0, 0.0, 0.5), 0.1, 0.05);

/// Part of its speed that the cloth keeps after a second in the air.
const KEPT_AFTER_1_S: f32 = 0.35;

toile_base::named! {
    /// How the skirt's threads stretch.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
    pub enum Stretch {
        /// Not at all: what is measured is the solver's error alone.
        #[default]
        Inextensible = "inextensible",
        /// As woven cloth: 2,000 N/m along warp and weft.
        Physical = "physical",
    }
}

impl Stretch {
    /// Tensile stiffness (N/m).
    pub fn stiffness_n_m(self) -> f32 {
        match self {
            Self::Inextensible => f32::INFINITY,
            Self::Physical => 2_000.0,
        }
    }
}

/// The skirt as a grid of `n` rows and `n` columns, row after row, at least 3: vertex (i, j) is `i * n + j`. Row 0 is
/// fixed and moves with bone 0. Faces are quads; [`Shape::triangles`] gives the scene's alternating triangles.
pub fn shape(n: usize) -> Shape {
    let n = n.max(3);
    let mut shape = Shape::default();
    for i in 0..n {
        for j in 0..n {
            push(&mut shape, point(i as f64 / (n - 1) as f64, TAU * j as f64 / n as f64), i == 0);
        }
    }
    let at = |i: usize, j: usize| (i * n + j % n) as u32;
    for i in 0..n - 1 {
        for j in 0..n {
            shape.faces.push([at(i, j), at(i, j + 1), at(i + 1, j + 1), at(i + 1, j)]);
            shape.split.push((i + j) % 2 == 0);
        }
    }
    shape
}

/// Loops of a skirt that rubs: with its rigidities they keep the curvature of the wool tropical of Matsudaira et al. 2015, 24.6
/// 1/m.
pub const LOOPS: LoopWidths = LoopWidths { bend_warp_mn: 0.670, bend_weft_mn: 0.428, shear_n_m: 0.0 };

/// Curves of a skirt whose links have them: both ways a knee at 1 % under 20 N/m and the slope of `physical` behind it, shear that
/// rubs as a suiting's and locks at 12 degrees.
pub fn curves(fabric: &mut Fabric) {
    let curve = StretchCurve { knee_percent: 1.0, knee_n_m: 20.0, beyond_n_m: 4_000.0, hysteresis_n_m: 4.0 };
    fabric.stretch = StretchCurves { warp: Some(curve), weft: Some(curve) };
    fabric.shear_lock = Some(ShearLock { degrees: 12.0, beyond_n_m: 1_000.0 });
    fabric.hysteresis.shear_n_m = 1.5;
}

/// The fabric of a skirt: of a density that gives it [`MASS_KG`], shear 100 N/m, and the bending of the median of 618
/// measured fabrics. Cloth is kept 1 mm off the body, which is less than half the thickness of the lightest of them and
/// more than what f32 and a substep's motion leave open.
pub fn fabric(shape: &Shape, stretch: Stretch) -> Fabric {
    let corner = |i: u32| shape.cut[i as usize].as_dvec3();
    let area = |t: &[u32; 3]| 0.5 * (corner(t[1]) - corner(t[0])).cross(corner(t[2]) - corner(t[0])).length();
    let area: f64 = shape.triangles().iter().map(area).sum();
    Fabric {
        name: "skirt".into(),
        title: "Benchmark skirt".into(),
        source: None,
        density_kg_m2: (f64::from(MASS_KG) / area) as f32,
        stretch_warp_n_m: stretch.stiffness_n_m(),
        stretch_weft_n_m: stretch.stiffness_n_m(),
        shear_n_m: 100.0,
        bend_warp_un_m: 13.6,
        bend_weft_un_m: 8.7,
        bend_bias_un_m: None,
        friction: 0.3,
        damping_per_s: -KEPT_AFTER_1_S.ln(),
        contact_offset_mm: 1.0,
        thickness_mm: toile_base::fabric::USUAL_THICKNESS_MM,
        comfortable_stretch: 0.05,
        colour: [0.24, 0.42, 0.55],
        weave: Weave::Plain,
        threads_per_cm: USUAL_THREADS,
        sheen: USUAL_SHEEN,
        opacity: 1.0,
        drape_percent: None,
        stretch: Default::default(),
        shear_lock: None,
        buckling: false,
        hysteresis: LoopWidths::default(),
        print: None,
        tile: None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use toile_bake::bake;
    use toile_bake::check;

    #[test]
    fn the_grid_is_the_scenes() {
        let (n, shape) = (64, shape(64));
        assert_eq!(shape.cut.len(), 4_096);
        assert_eq!(check::check(&shape.cut, &shape.faces), Ok(()));
        let at = |i: usize, j: usize| shape.cut[i * n + j];
        assert!((at(0, 5).distance(at(1, 5)) * 1e3 - 12.95).abs() < 0.01);
        // Column 16 of 64 is a quarter round: at the hem (0, 0.30, 0.42).
        assert!(at(63, 16).distance(Vec3::new(0.0, 0.30, 0.42)) < 1e-6);
        assert!(at(0, 0).distance(Vec3::new(0.18, 1.08, 0.0)) < 1e-6);
        for v in hem(n) {
            let p = shape.cut[v];
            assert!((p.x.hypot(p.z) - 0.42).abs() < 1e-6 && (p.y - 0.30).abs() < 1e-6, "{p}");
        }
        assert_eq!(shape.fixed.iter().filter(|f| **f).count(), n);
        assert!(shape.fixed[..n].iter().all(|f| *f));
    }

    #[test]
    fn its_triangles_alternate_and_look_outwards() {
        let (n, shape) = (32u32, shape(32));
        let triangles = shape.triangles();
        assert_eq!(triangles.len(), 2 * 31 * 32);
        // Quad (0, 0) with corners a b / d c: even, so (a, b, d) and (b, c, d). Quad (0, 1) is odd.
        let [a, b, c, d] = [0, 1, n + 1, n];
        assert_eq!(triangles[..2], [[a, b, d], [b, c, d]]);
        let [a, b, c, d] = [1, 2, n + 2, n + 1];
        assert_eq!(triangles[2..4], [[a, b, c], [a, c, d]]);
        for t in triangles {
            let [a, b, c] = t.map(|i| shape.cut[i as usize]);
            assert!((b - a).cross(c - a).dot((a + b + c).with_y(0.0)) > 0.0, "{t:?} looks inwards");
        }
    }

    #[test]
    fn its_mass_is_310_g_whatever_the_mesh() {
        for shape in [shape(32), shape(64), irregular(32, 1)] {
            let free = Shape { fixed: vec![false; shape.cut.len()], ..shape.clone() };
            let garment = bake("skirt", "one", &free, &fabric(&shape, Stretch::Physical)).unwrap();
            let mass: f64 = garment.inverse_mass.iter().map(|w| f64::from(*w).recip()).sum();
            assert!((mass - 0.31).abs() < 1e-6, "{mass} kg");
        }
    }

    #[test]
    fn a_weight_in_the_hem_is_the_hems_alone() {
        let (n, plain) = (32, shape(32));
        let mut heavy = plain.clone();
        heavy.heavier = vec![1.0; n * n];
        heavy.heavier[hem(n)].fill(1_000.0);
        let fabric = fabric(&plain, Stretch::Physical);
        let [light, heavy] = [plain, heavy].map(|s| bake("skirt", "one", &s, &fabric).unwrap().inverse_mass.clone());
        let ratio = |v: usize| light[v] / heavy[v];
        assert!((n..hem(n).start).all(|v| ratio(v) == 1.0));
        assert!(hem(n).all(|v| (ratio(v) - 1_000.0).abs() < 0.01));
    }

    #[test]
    fn the_air_takes_65_per_cent_of_the_speed_in_a_second() {
        let fabric = fabric(&shape(32), Stretch::Inextensible);
        assert!(((-fabric.damping_per_s).exp() - 0.35).abs() < 1e-6);
        assert_eq!(fabric.stretch_warp_n_m, f32::INFINITY);
    }
}
