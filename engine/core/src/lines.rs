//! Debug lines, such as fibers and contacts. Filled outside of the frame, from its snapshot, into memory allocated at load.

use glam::{Vec3, Vec4Swizzles};
use toile_base::garment::layout::Layout;
use toile_base::garment::{Garment, Solver};

use crate::cloth::{Cloth, contact};
use crate::colliders::Colliders;

/// Lines of one garment's fibers, of a body's capsules: what is enough for the garments of the wardrobe.
pub const CAPACITY: usize = 1 << 16;

/// Seconds that a particle's velocity is drawn ahead.
const AHEAD_S: f32 = 0.05;

/// Cloth nearer to a collider than its contact offset and this much is drawn as touching it (m).
const TOUCHING_M: f32 = 5e-4;

/// Length of a contact's normal as it is drawn (m).
const NORMAL_M: f32 = 0.02;

/// A tether longer than this share of its length is drawn as taut.
const TAUT: f32 = 0.98;

/// Lines around a sphere's circle.
const AROUND: usize = 20;

/// A line between two places.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Line {
    /// Where it begins, world (m).
    pub from: Vec3,
    /// Where it ends, world (m).
    pub to: Vec3,
    /// Linear RGB, each 0..1.
    pub colour: Vec3,
}

toile_base::named! {
    /// Kinds of lines.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
    pub enum Kind {
        /// What holds the cloth together, coloured by what solves it.
        Fibers = "fibers",
        /// Spheres and capsules of the body.
        Colliders = "colliders",
        /// Where cloth touches the body, along the way out of it.
        Contacts = "contacts",
        /// What holds each particle to where the garment hangs, red where it is taut.
        Tethers = "tethers",
        /// How fast each particle moves.
        Velocity = "velocity",
    }
}

/// Colours, linear RGB, told apart by colour-blind eyes too (Okabe and Ito 2008, "Color universal design").
const ORANGE: Vec3 = Vec3::new(0.791, 0.347, 0.0);
const SKY: Vec3 = Vec3::new(0.093, 0.456, 0.815);
const GREEN: Vec3 = Vec3::new(0.0, 0.342, 0.171);
const YELLOW: Vec3 = Vec3::new(0.871, 0.776, 0.054);
const BLUE: Vec3 = Vec3::new(0.0, 0.168, 0.445);
const RED: Vec3 = Vec3::new(0.665, 0.112, 0.0);

/// Lines, within a fixed capacity.
#[derive(Debug, Clone, PartialEq)]
pub struct Lines {
    lines: Box<[Line]>,
    len: usize,
    left_out: usize,
}

impl Lines {
    /// Room for so many. At load.
    pub fn new(capacity: usize) -> Self {
        let none = Line { from: Vec3::ZERO, to: Vec3::ZERO, colour: Vec3::ZERO };
        Self { lines: vec![none; capacity].into(), len: 0, left_out: 0 }
    }

    /// The lines that were added since they were last cleared.
    pub fn as_slice(&self) -> &[Line] {
        &self.lines[..self.len]
    }

    /// Lines that there was no room for since they were last cleared.
    pub fn left_out(&self) -> usize {
        self.left_out
    }

    /// Forgets all lines.
    pub fn clear(&mut self) {
        (self.len, self.left_out) = (0, 0);
    }

    /// Adds one where there is room and both ends are finite.
    pub fn push(&mut self, from: Vec3, to: Vec3, colour: Vec3) {
        if !(from.is_finite() && to.is_finite()) {
            return;
        }
        match self.lines.get_mut(self.len) {
            Some(line) => {
                *line = Line { from, to, colour };
                self.len += 1;
            }
            None => self.left_out += 1,
        }
    }

    /// Adds what a garment shows of a kind; of the colliders, which are the body's, nothing.
    pub fn add_garment(&mut self, kind: Kind, cloth: &Cloth, garment: &Garment, colliders: &Colliders) {
        match kind {
            Kind::Fibers => self.fibers(cloth, garment.layout()),
            Kind::Contacts => self.contacts(cloth, garment, colliders),
            Kind::Tethers => self.tethers(cloth, garment),
            Kind::Velocity => self.velocity(cloth, garment),
            Kind::Colliders => {}
        }
    }

    /// Adds spheres and capsules where they are at the end of the step.
    pub fn add_colliders(&mut self, colliders: &Colliders) {
        for sphere in colliders.end() {
            for axis in [Vec3::X, Vec3::Y, Vec3::Z] {
                self.circle(sphere.xyz(), axis, sphere.w, SKY);
            }
        }
        for capsule in 0..colliders.capsules().len() {
            let cone = colliders.cone(capsule, 1.0);
            let Some(axis) = (cone.b - cone.a).try_normalize() else { continue };
            let (side, other) = axis.any_orthonormal_pair();
            for across in [side, -side, other, -other] {
                self.push(cone.a + across * cone.ra, cone.b + across * cone.rb, BLUE);
            }
        }
    }

    fn circle(&mut self, centre: Vec3, axis: Vec3, radius: f32, colour: Vec3) {
        let (side, other) = axis.any_orthonormal_pair();
        let at = |i: usize| {
            let (sin, cos) = (i as f32 / AROUND as f32 * std::f32::consts::TAU).sin_cos();
            centre + (side * cos + other * sin) * radius
        };
        (0..AROUND).for_each(|i| self.push(at(i), at(i + 1), colour));
    }

    /// Links by what solves them: fibers whole, by index list, along the bias; links one by one, coloured sets.
    fn fibers(&mut self, cloth: &Cloth, layout: &Layout) {
        let at = |i: u32| Vec3::from(cloth.positions[i as usize]);
        for bundle in &layout.fibers.bundles {
            let rows = &layout.fibers.rows[bundle.rows.start as usize..bundle.rows.end as usize];
            let colour = colour_of(bundle.solver);
            for pair in rows.windows(2) {
                let reach = pair[0].lanes.min(pair[1].lanes);
                (0..reach).for_each(|k| self.push(at(pair[0].first + k), at(pair[1].first + k), colour));
            }
        }
        for list in &layout.crossing.lists {
            for link in 0..list.links() {
                let index = |row: u32, lane: u32| {
                    layout.crossing.index[(list.first + (row % list.rows) * list.lanes + lane) as usize]
                };
                let colour = colour_of(list.solver);
                (0..list.lanes).for_each(|l| self.push(at(index(link, l)), at(index(link + 1, l)), colour));
            }
        }
        layout.diagonals.for_each(|_, [a, b]| self.push(at(a), at(b), GREEN));
        layout.weft.tuples.for_each(|_, [a, b]| self.push(at(a), at(b), YELLOW));
        layout.shear.tuples.for_each(|_, [a, b]| self.push(at(a), at(b), SKY));
    }

    fn contacts(&mut self, cloth: &Cloth, garment: &Garment, colliders: &Colliders) {
        let cones = colliders.cones_at(1.0);
        let near = garment.fabric.contact_offset_mm * 1e-3 + TOUCHING_M;
        let free = garment.inverse_mass.iter().map(|w| *w > 0.0);
        for ((p, part), _) in cloth.positions.iter().zip(&garment.parts).zip(free).filter(|(_, free)| *free) {
            let mut bits = contact::body::reach(*part, colliders);
            while bits != 0 {
                let (distance, outwards) = cones[bits.trailing_zeros() as usize].distance((*p).into());
                bits &= bits - 1;
                if distance < near {
                    self.push(
                        (*p).into(),
                        Vec3::from(*p) + outwards * NORMAL_M,
                        if distance < 0.0 { RED } else { ORANGE },
                    );
                }
            }
        }
    }

    fn tethers(&mut self, cloth: &Cloth, garment: &Garment) {
        let tethers = &garment.layout().tethers;
        for (i, (anchor, length)) in (0..).zip(tethers.anchor.iter().zip(&tethers.length)) {
            let (from, to) = (Vec3::from(cloth.positions[*anchor as usize]), Vec3::from(cloth.positions[i]));
            if *length > 0.0 {
                self.push(from, to, if from.distance(to) > TAUT * length { RED } else { GREEN });
            }
        }
    }

    fn velocity(&mut self, cloth: &Cloth, garment: &Garment) {
        for (i, p) in cloth.positions.iter().enumerate().filter(|(i, _)| garment.inverse_mass[*i] > 0.0) {
            self.push((*p).into(), (*p + cloth.velocity(i) * AHEAD_S).into(), ORANGE);
        }
    }
}

fn colour_of(solver: Solver) -> Vec3 {
    match solver {
        Solver::SemiImplicit => ORANGE,
        Solver::ZeroStretch => RED,
        Solver::GaussSeidel => YELLOW,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::colliders::RestSphere;

    #[test]
    fn lines_beyond_the_capacity_are_counted() {
        let mut lines = Lines::new(2);
        (0..5).for_each(|i| lines.push(Vec3::ZERO, Vec3::X * i as f32, Vec3::ONE));
        lines.push(Vec3::NAN, Vec3::X, Vec3::ONE);
        assert_eq!((lines.as_slice().len(), lines.left_out()), (2, 3));
        lines.clear();
        assert_eq!((lines.as_slice().len(), lines.left_out()), (0, 0));
    }

    #[test]
    fn a_capsule_is_drawn_around_its_own_radius() {
        let sphere = |x: f32| RestSphere { bone: 0, centre: Vec3::new(x, 1.0, 0.0), radius: 0.1 };
        let mut colliders = Colliders::new(&[sphere(0.0), sphere(0.5)], &[[0, 1]], true).unwrap();
        colliders.place(&[glam::Affine3A::IDENTITY; toile_base::skeleton::BONES]);
        let mut lines = Lines::new(1000);
        lines.add_colliders(&colliders);
        assert_eq!(lines.as_slice().len(), 2 * 3 * AROUND + 4);
        let off = |p: Vec3| colliders.cone(0, 1.0).distance(p).0;
        assert!(lines.as_slice()[2 * 3 * AROUND..].iter().all(|l| off(l.from).abs() < 1e-5 && off(l.to).abs() < 1e-5));
    }
}
