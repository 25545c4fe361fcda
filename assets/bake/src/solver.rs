//! Which solver each fiber gets.
//!
//! What carries weight is solved as a whole, since a sweep from link to link lets it stretch by the number of its links:
//! fibers down the garment; and what runs along the bias, because link by link a substep leaves a fraction of its
//! stiffness (`diagonals` says what can be). What lies across carries itself alone: Gauss-Seidel. (A waistband
//! solved directly took a quarter of the skirt's step for nothing that its strain showed.) A garment file may say otherwise
//! ([`Overrides`]).

use std::collections::BTreeMap;

use super::fibers::{Direction, Fiber};
use crate::check::corners;
use crate::overrides::{Overrides, SolverRegion};
use crate::shape::Shape;
use toile_base::garment::Solver;

/// Chooses solvers for the fibers of one shape.
#[derive(Debug, Clone)]
pub struct SolverChoice {
    overrides: Overrides,
    fixed: Vec<bool>,
    /// True where a vertex is fixed or a side joins it to one that is.
    held: Vec<bool>,
    /// True where the cloth ends.
    rim: Vec<bool>,
}

impl SolverChoice {
    /// Looks at the shape once; `overrides` are those of its garment file.
    pub fn new(shape: &Shape, overrides: &Overrides) -> Self {
        let mut sides: BTreeMap<(u32, u32), u32> = BTreeMap::new();
        for face in &shape.faces {
            let ring = corners(face);
            for (k, &a) in ring.iter().enumerate() {
                let b = ring[(k + 1) % ring.len()];
                *sides.entry((a.min(b), a.max(b))).or_default() += 1;
            }
        }
        let mut found = Self {
            overrides: *overrides,
            fixed: shape.fixed.clone(),
            held: shape.fixed.clone(),
            rim: vec![false; shape.fixed.len()],
        };
        for (&(a, b), &faces) in &sides {
            let (a, b) = (a as usize, b as usize);
            found.held[a] |= shape.fixed[b];
            found.held[b] |= shape.fixed[a];
            if faces == 1 {
                (found.rim[a], found.rim[b]) = (true, true);
            }
        }
        found
    }

    /// The solver of a fiber.
    pub fn choose(&self, fiber: &Fiber) -> Solver {
        let region = self.region(fiber);
        self.overrides.of(fiber.direction, region).unwrap_or(match (fiber.direction, region) {
            (Direction::Warp | Direction::Bias, _) if !fiber.is_loose() => Solver::SemiImplicit,
            _ => Solver::GaussSeidel,
        })
    }

    /// The region that a fiber belongs to: hoops that can move alone.
    pub fn region(&self, fiber: &Fiber) -> Option<SolverRegion> {
        let all = |is: &[bool]| fiber.vertices.iter().all(|&v| is[v as usize]);
        if fiber.direction != Direction::Weft || !fiber.is_hoop() || all(&self.fixed) {
            None
        } else if all(&self.held) {
            Some(SolverRegion::Waistband)
        } else {
            all(&self.rim).then_some(SolverRegion::Hem)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fibers;
    use crate::tests::meshes::{rough_skirt, split, tube};

    /// A tube whose first row does not move.
    fn skirt() -> (Shape, Vec<Fiber>) {
        let (positions, faces) = split(tube(12, 6), true);
        let fixed = (0..72).map(|v| v < 12).collect();
        let shape = Shape { cut: positions.clone(), worn: positions, faces, fixed, ..Shape::default() };
        let fibers = fibers::trace(&shape.cut, &fibers::edges(&shape.cut, &shape.faces));
        (shape, fibers)
    }

    fn chosen(overrides: Overrides) -> impl Fn(Direction, usize) -> Solver {
        let (shape, fibers) = skirt();
        let chooser = SolverChoice::new(&shape, &overrides);
        move |direction, row| {
            let at = |f: &&Fiber| f.direction == direction && f.vertices[0] / 12 == row as u32;
            chooser.choose(fibers.iter().find(at).expect("a fiber of that row"))
        }
    }

    #[test]
    fn what_carries_weight_is_solved_as_a_whole() {
        let solver = chosen(Overrides::default());
        assert_eq!(solver(Direction::Warp, 0), Solver::SemiImplicit);
        for row in 1..6 {
            assert_eq!(solver(Direction::Weft, row), Solver::GaussSeidel);
        }
        // Diagonals run on through quads, and are alone between triangles that lean to and fro.
        for (mesh, alone) in [(tube(12, 6), false), (split(tube(12, 6), true), true)] {
            let shape =
                Shape { cut: mesh.0.clone(), worn: mesh.0, faces: mesh.1, fixed: vec![false; 72], ..Shape::default() };
            let chooser = SolverChoice::new(&shape, &Overrides::default());
            let fibers = fibers::trace(&shape.cut, &fibers::edges(&shape.cut, &shape.faces));
            let bias: Vec<&Fiber> = fibers.iter().filter(|f| f.direction == Direction::Bias).collect();
            let expected = if alone { Solver::GaussSeidel } else { Solver::SemiImplicit };
            assert!(!bias.is_empty() && bias.iter().all(|f| f.is_loose() == alone && chooser.choose(f) == expected));
        }
    }

    #[test]
    fn a_region_goes_before_a_direction_and_both_before_the_bake() {
        let solver = chosen(Overrides {
            warp: Some(Solver::GaussSeidel),
            weft: Some(Solver::SemiImplicit),
            waistband: Some(Solver::ZeroStretch),
            hem: Some(Solver::GaussSeidel),
            bias: None,
        });
        assert_eq!(solver(Direction::Warp, 0), Solver::GaussSeidel);
        let rows = [1, 2, 3, 4, 5].map(|row| solver(Direction::Weft, row));
        let (zero, whole, sweep) = (Solver::ZeroStretch, Solver::SemiImplicit, Solver::GaussSeidel);
        assert_eq!(rows, [zero, whole, whole, whole, sweep]);
    }

    #[test]
    fn long_fibers_of_an_irregular_skirt_are_solved_as_a_whole_and_single_edges_are_not() {
        let (positions, faces) = rough_skirt(0.06, 2);
        let fixed = positions.iter().map(|p| p.y > -1e-3).collect();
        let shape = Shape { cut: positions.clone(), worn: positions, faces, fixed, ..Shape::default() };
        let chooser = SolverChoice::new(&shape, &Overrides::default());
        for fiber in fibers::trace(&shape.cut, &fibers::edges(&shape.cut, &shape.faces)) {
            let whole = fiber.direction != Direction::Weft && fiber.edges.len() > 1;
            assert_eq!(chooser.choose(&fiber), if whole { Solver::SemiImplicit } else { Solver::GaussSeidel });
        }
    }
}
