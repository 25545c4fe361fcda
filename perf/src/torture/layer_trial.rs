//! One trial of cloths over one another, and what is seen of them from the first step on.

use glam::{Affine3A, DVec3, Vec3, Vec3A};
use toile_bake::Shape;
use toile_bake::bake;
use toile_bake::check::MeshError;
use toile_base::garment::{Garment, Part};
use toile_base::skeleton::BONES;
use toile_engine::cloth::contact::garments::GarmentContact;
use toile_engine::cloth::{Cloth, ContactRates, Settings, Step};
use toile_engine::colliders::Colliders;
use toile_engine::workers::WorkerPool;

use super::crossed::CrossedEdges;
use super::outcome::TrialFindings;
use super::piece::{self, CELL_M};
use super::trial::TrialFigures;

/// Sheets over one another above a floor.
#[derive(Debug)]
pub struct LayerTrial {
    garments: Vec<Garment>,
    cloths: Vec<Cloth>,
    layers: GarmentContact,
    pool: WorkerPool,
    floor: Colliders,
    settings: Settings,
    crossed: CrossedEdges,
    seen: TrialFigures,
}

impl LayerTrial {
    /// So many sheets in wearing order, the innermost first, each particle where `place` says (m, m/s): of which sheet, and where
    /// it is in a flat one about the origin.
    ///
    /// # Errors
    /// Where a sheet cannot be baked.
    pub fn new(
        sheets: usize,
        vertices: [usize; 2],
        settings: &Settings,
        mut place: impl FnMut(usize, Vec3) -> (Vec3, Vec3),
    ) -> Result<Self, MeshError> {
        let shape = level(vertices);
        let bake = |layer: usize| {
            let mut garment = bake("torture", "one", &shape, &piece::denim())?;
            garment.set_layer(layer as u8);
            Ok(garment)
        };
        let garments = (0..sheets).map(bake).collect::<Result<Vec<Garment>, MeshError>>()?;
        let floor = Colliders::new(&[], &[], true).expect("no colliders are within every limit");
        let mut cloths: Vec<Cloth> = garments.iter().map(|g| Cloth::new(g, &floor)).collect();
        for (sheet, (cloth, garment)) in cloths.iter_mut().zip(&garments).enumerate() {
            for (i, start) in garment.start.iter().enumerate() {
                let (at, velocity) = place(sheet, *start);
                cloth.disturb(i, at.into(), velocity.into());
            }
        }
        let faces: Vec<&[[u32; 3]]> = garments.iter().map(|g| &*g.triangles).collect();
        Ok(Self {
            crossed: CrossedEdges::new(&faces),
            layers: GarmentContact::new(&garments).expect("sheets have faces"),
            pool: WorkerPool::new(1).expect("one worker is the caller's thread"),
            settings: Settings { contact: ContactRates { layers: 1, folds: 1, ..settings.contact }, ..*settings },
            seen: TrialFigures::default(),
            garments,
            cloths,
            floor,
        })
    }

    /// Runs for so long (s) and looks: nothing may cross, and each sheet be over those that it is worn over.
    pub fn back_in_order(mut self, seconds: f32) -> TrialFindings {
        self.crossed.look(&positions(&self.cloths));
        let dt = self.settings.step_seconds;
        (0..(seconds / dt).round() as u64).for_each(|_| self.step());
        self.crossed.look(&positions(&self.cloths));
        let wrong = self.wrong();
        let limit = Some(self.settings.max_speed);
        let found = TrialFindings { seen: self.seen, limit, ..TrialFindings::default() };
        let mut found = found.uncrossed(&self.crossed, seconds, dt);
        if wrong > 0 {
            found.miss = Some(format!("{wrong} particles on the wrong side after {seconds} s"));
        }
        found
    }

    fn step(&mut self) {
        let palette = [Affine3A::IDENTITY; BONES];
        let step = Step { palette: &palette, colliders: &self.floor, settings: &self.settings };
        // Without another worker there is none that could panic.
        let _ = self.layers.step(&mut self.pool, &mut self.cloths, &self.garments, &step);
        self.crossed.after_step(&positions(&self.cloths));
        for cloth in &self.cloths {
            self.seen.nonfinite += piece::nonfinite(cloth);
            let speeds = (0..cloth.positions.len()).map(|i| cloth.velocity(i).length());
            self.seen.max_speed = speeds.fold(self.seen.max_speed, f32::max);
        }
    }

    /// Particles that lie behind a face of a sheet that they are worn over.
    fn wrong(&self) -> usize {
        let outer = (1..self.cloths.len()).flat_map(|outer| (0..outer).map(move |inner| (outer, inner)));
        outer.map(|(outer, inner)| self.behind(outer, inner)).sum()
    }

    /// Particles of one sheet behind the faces of another, square to which they are within a cell.
    fn behind(&self, outer: usize, inner: usize) -> usize {
        let at = |sheet: usize, i: usize| self.cloths[sheet].positions[i].as_dvec3();
        let faces = self.garments[inner].triangles.iter().map(|t| t.map(|v| at(inner, v as usize)));
        let faces: Vec<[DVec3; 3]> = faces.collect();
        let near = |p: DVec3| {
            let heights = faces.iter().filter_map(|face| height_over(face, p));
            heights.filter(|h| h.abs() < f64::from(CELL_M)).min_by(|a, b| a.abs().total_cmp(&b.abs()))
        };
        (0..self.cloths[outer].positions.len()).filter(|&i| near(at(outer, i)).is_some_and(|h| h < 0.0)).count()
    }
}

/// How far a point is in front of a triangle that it is square to (m).
fn height_over([a, b, c]: &[DVec3; 3], p: DVec3) -> Option<f64> {
    let normal = (b - a).cross(c - a);
    let side = |from: &DVec3, to: &DVec3| (to - from).cross(p - from).dot(normal) >= 0.0;
    (side(a, b) && side(b, c) && side(c, a)).then(|| (p - a).dot(normal.normalize_or_zero()))
}

fn positions(cloths: &[Cloth]) -> Vec<&[Vec3A]> {
    cloths.iter().map(|c| &*c.positions).collect()
}

/// A free sheet that lies about the origin, its front upwards.
fn level([columns, rows]: [usize; 2]) -> Shape {
    let mut shape = Shape::default();
    let place = |k: usize, count: usize| (k as f32 - 0.5 * (count - 1) as f32) * CELL_M;
    for v in 0..columns * rows {
        let [x, z] = [place(v % columns, columns), place(v / columns, rows)];
        shape.push(Vec3::new(x, -z, 0.0), Vec3::new(x, 0.0, z), false, Part::All);
        shape.weights.push(Default::default());
    }
    let at = |row: usize, column: usize| (row * columns + column) as u32;
    for row in 1..rows {
        for column in 1..columns {
            shape.faces.push([at(row, column - 1), at(row, column), at(row - 1, column), at(row - 1, column - 1)]);
        }
    }
    shape
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sheets_in_the_wrong_order_are_seen() {
        let behind = |heights: [f32; 2]| {
            let place = |sheet: usize, p: Vec3| (p + Vec3::Y * heights[sheet], Vec3::ZERO);
            LayerTrial::new(2, [5, 5], &Settings::default(), place).unwrap().wrong()
        };
        assert_eq!(behind([0.1, 0.103]), 0);
        assert!(behind([0.1, 0.097]) > 15);
        assert_eq!(behind([0.1, 0.01]), 0, "a cell away nothing touches");
    }
}
