//! A survey of a shape: what baking makes of it, and warnings about its mesh.

use glam::Vec3;

use super::fibers::{self, Coverage, Direction};
use super::solver::SolverChoice;
use super::{bending, tethers};
use crate::shape::Shape;
use toile_base::fabric::Fabric;
use toile_base::garment::Solver;

/// A triangle whose height is a smaller part of its longest side than this is a needle.
const NEEDLE: f32 = 0.1;

/// Edges that differ in length by more than this make some of them far too fine or far too coarse.
const MOST_UNEVEN: f32 = 20.0;

/// Where a smaller share of the free vertices hangs by fibers, little of the cloth is held up: sleeves hang from the body
/// by what lies across, and so do the inner sides of trouser legs, but most of a garment hangs from where it is fixed.
const LEAST_HANGING: f64 = 0.5;

/// Where a larger share of the edges is alone, the mesh gives fibers nothing to follow.
const MOST_LOOSE: f64 = 0.2;

/// What there is of one solver.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct SolverCount {
    /// The solver that is counted.
    pub solver: Solver,
    /// Fibers that it solves; edges alone count as one each.
    pub fibers: usize,
    /// Edges of these fibers.
    pub edges: usize,
}

/// What baking makes of a shape.
#[derive(Debug, Clone, PartialEq)]
pub struct MeshSurvey {
    /// Vertices of the shape.
    pub vertices: usize,
    /// Triangles; a quad counts as two.
    pub triangles: usize,
    /// Vertices that do not move.
    pub fixed: usize,
    /// Edges that the fibers cover.
    pub coverage: Coverage,
    /// Which fibers are solved how, those between fixed vertices left out.
    pub solvers: [SolverCount; 3],
    /// Tethers of the garment.
    pub tethers: usize,
    /// Bending stencils along warp, weft and bias.
    pub stencils: [usize; 3],
    /// What is likely to look or to run worse than it could; one sentence each, with its cure.
    pub warnings: Vec<String>,
    /// Remarks that are no warnings, one sentence each.
    pub notes: Vec<String>,
}

/// Surveys a shape that baking accepts.
pub fn survey(shape: &Shape, fabric: &Fabric) -> MeshSurvey {
    let edges = fibers::edges_of(shape);
    let chains = fibers::trace(&shape.cut, &edges);
    let chooser = SolverChoice::new(shape, &shape.solver);
    let mut solvers = [Solver::SemiImplicit, Solver::GaussSeidel, Solver::ZeroStretch].map(|solver| SolverCount {
        solver,
        fibers: 0,
        edges: 0,
    });
    for piece in chains.iter().flat_map(|fiber| fiber.split_at_pins(&shape.fixed)) {
        let solver = chooser.choose(&piece);
        for solved in solvers.iter_mut().filter(|s| s.solver == solver) {
            solved.fibers += 1;
            solved.edges += piece.edges.len();
        }
    }
    let bends = bending::stencils(shape, &edges, fabric);
    let along = |d: Direction| bends.iter().filter(|b| b.direction == d).count();
    let coverage = Coverage::of(&chains, &shape.fixed);
    let tethers = tethers::tethers(shape).len();
    MeshSurvey {
        vertices: shape.cut.len(),
        triangles: shape.triangles().len(),
        fixed: shape.cut.len() - coverage.free,
        solvers,
        tethers,
        stencils: [Direction::Warp, Direction::Weft, Direction::Bias].map(along),
        warnings: support(&coverage, tethers).into_iter().chain(flaws(shape)).chain(loose(&coverage)).collect(),
        notes: notes(fabric),
        coverage,
    }
}

/// What does not hang from anything.
fn support(coverage: &Coverage, tethers: usize) -> Vec<String> {
    let mut warnings = Vec::new();
    let falling = coverage.free - tethers;
    if falling == coverage.free && falling > 0 {
        warnings.push("nothing is fixed, so the garment will fall; end the material of faces that stay on the body other than in Free".into());
    } else if falling > 0 {
        warnings.push(format!(
            "{falling} vertices are sewn to nothing that is fixed and will fall; sew them on or fix them"
        ));
    } else if coverage.hanging_share() < LEAST_HANGING {
        let held = 100.0 * coverage.hanging_share();
        warnings.push(format!("only {held:.0} % of the free vertices hang by fibers down the warp; mesh the cloth finer, or turn its warp upright"));
    }
    warnings
}

fn loose(coverage: &Coverage) -> Option<String> {
    let share = coverage.loose as f64 / coverage.edges.max(1) as f64;
    (share > MOST_LOOSE).then(|| {
        let percent = 100.0 * share;
        format!("{percent:.0} % of the edges are in no fiber and cost the most; a more even mesh has longer fibers")
    })
}

/// Needles and uneven edges of the mesh as cut.
fn flaws(shape: &Shape) -> Vec<String> {
    let (mut needles, mut worst) = (0, (f32::MAX, 0usize));
    let (mut shortest, mut longest) = (f32::MAX, 0.0f32);
    for (i, [a, b, c]) in shape.triangles_as_cut().into_iter().enumerate() {
        let sides = [a.distance(b), b.distance(c), c.distance(a)];
        let long = sides.into_iter().fold(0.0, f32::max);
        let height = double_area(a, b, c) / long / long;
        shortest = sides.into_iter().fold(shortest, f32::min);
        longest = longest.max(long);
        needles += usize::from(height < NEEDLE);
        if height < worst.0 {
            worst = (height, i);
        }
    }
    let mut warnings = Vec::new();
    if needles > 0 {
        let (times, at) = (1.0 / worst.0, worst.1);
        warnings.push(format!(
            "{needles} triangles are needles, triangle {at} is {times:.0} times longer than wide; remesh them evenly"
        ));
    }
    if longest > MOST_UNEVEN * shortest {
        let (short, long) = (shortest * 1e3, longest * 1e3);
        warnings.push(format!("edges are between {short:.1} and {long:.0} mm long; remesh the garment more evenly"));
    }
    warnings
}

fn double_area(a: Vec3, b: Vec3, c: Vec3) -> f32 {
    (b - a).cross(c - a).length()
}

fn notes(fabric: &Fabric) -> Vec<String> {
    let mut warnings = Vec::new();
    let threads = 0.25 * (fabric.bend_warp_un_m + fabric.bend_weft_un_m);
    match fabric.bend_bias_un_m {
        None => warnings.push(format!(
            "{} gives no bend_bias_un_m, so that it bends along the bias as its threads alone do: {threads:.1} uN m",
            fabric.name
        )),
        Some(bias) if bias < threads => warnings.push(format!(
            "{} has bend_bias_un_m = {bias}, less than its threads alone have; {threads:.1} uN m is what is used",
            fabric.name
        )),
        Some(_) => {}
    }
    warnings
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tests::meshes::{rough_skirt, sheet, tube};

    fn shape((positions, faces): (Vec<Vec3>, Vec<crate::shape::Face>), top: f32) -> Shape {
        let fixed = positions.iter().map(|p| p.y > top).collect();
        Shape { cut: positions.clone(), worn: positions, faces, fixed, ..Shape::default() }
    }

    fn surveyed(shape: &Shape) -> MeshSurvey {
        survey(shape, &Fabric::cotton_lawn())
    }

    #[test]
    fn a_tube_is_surveyed_exactly() {
        let found = surveyed(&shape(tube(12, 6), -0.1));
        assert_eq!((found.vertices, found.triangles, found.fixed, found.tethers), (72, 120, 12, 60));
        let Coverage { edges, warp, hoops, bias, loose, .. } = found.coverage;
        assert_eq!((edges, warp, hoops, bias, loose), (60 + 72 + 120, 60, 72, 120, 0));
        // Twelve columns and the diagonals both ways; the fixed hoop has no solver.
        assert_eq!(found.solvers[0], SolverCount { solver: Solver::SemiImplicit, fibers: 12 + 24, edges: 60 + 120 });
        assert_eq!(found.solvers[1].edges, edges - 60 - 120 - 12);
        assert_eq!(found.stencils, [48, 60, 0]);
        assert!(found.warnings.is_empty(), "{:?}", found.warnings);
        assert!(found.notes[0].contains("bend_bias_un_m") && found.notes[0].contains("2.0 uN m"), "{:?}", found.notes);
    }

    #[test]
    fn an_irregular_skirt_gives_no_reason_to_warn() {
        let found = surveyed(&shape(rough_skirt(0.05, 1), -1e-3));
        assert!(found.warnings.is_empty(), "{:?}", found.warnings);
        assert_eq!(found.tethers, found.coverage.free);
        assert_eq!(found.solvers.iter().map(|s| s.fibers).min(), Some(0), "nothing is zero-stretch unless asked");
    }

    #[test]
    fn each_flaw_is_told_with_its_cure() {
        let warned = |shape: &Shape, word: &str| {
            let found = surveyed(shape).warnings;
            assert!(found.iter().any(|w| w.contains(word) && w.contains("; ")), "{word} is not in {found:?}");
        };
        warned(&shape(tube(12, 6), 9.0), "will fall");
        warned(&shape(sheet(4, 60, 0.3, 0.01), -0.001), "needles");
        let mut apart = shape(tube(12, 6), -0.1);
        let second = tube(12, 3);
        apart.faces.extend(second.1.iter().map(|f| f.map(|v| v + 72)));
        let far: Vec<Vec3> = second.0.iter().map(|p| *p * 0.02 - Vec3::Y * 3.0).collect();
        apart.cut.extend(&far);
        apart.worn.extend(&far);
        apart.fixed.extend(vec![false; 36]);
        warned(&apart, "36 vertices");
        warned(&apart, "mm long");
    }
}
