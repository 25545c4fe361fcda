//! Tests of contact. `Bed` is a garment without cloth: particles, colliders, and nothing between them.

mod friction;
mod parity;
mod plain;
mod tunnel;

use glam::{Vec3, Vec3A, Vec4};
use toile_base::garment::Part;

use super::*;
use crate::cloth::state::{State, get, set};
use crate::colliders::RestSphere;

pub const HOW: ContactSettings = ContactSettings {
    offset_m: 0.002,
    friction_static: 0.4,
    friction_kinetic: 0.3,
    step_seconds: 1.0 / 120.0,
    continuous: true,
    skin_every: 0,
};

/// A small generator of its own: the tests give the same numbers everywhere.
pub struct Random(pub u64);

impl Random {
    pub fn unit(&mut self) -> f32 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 40) as f32 / (1u64 << 24) as f32
    }
    pub fn between(&mut self, low: f32, high: f32) -> f32 {
        low + (high - low) * self.unit()
    }
    pub fn point(&mut self, size: f32) -> Vec3 {
        Vec3::new(self.between(-size, size), self.between(-size, size), self.between(-size, size))
    }
    pub fn direction(&mut self) -> Vec3 {
        loop {
            let p = self.point(1.0);
            if (0.01..1.0).contains(&p.length_squared()) {
                return p.normalize();
            }
        }
    }
}

/// Colliders that move from one set of spheres to another in a step.
pub fn colliders(from: &[Vec4], to: &[Vec4], capsules: &[[u8; 2]], floor: bool) -> Colliders {
    let rest = vec![RestSphere { bone: 0, centre: Vec3::ZERO, radius: 0.0 }; from.len()];
    let mut colliders = Colliders::new(&rest, capsules, floor).unwrap();
    colliders.force(from, to);
    colliders
}

pub struct Bed {
    pub state: State,
    pub contacts: Contacts,
    pub width: Width,
    pub how: ContactSettings,
}

impl Bed {
    pub fn new(positions: &[Vec3], colliders: &Colliders) -> Self {
        let spans = [vec![(0, positions.len() as u32)], vec![]];
        Self::split(positions, colliders, &spans)
    }

    pub fn split(positions: &[Vec3], colliders: &Colliders, spans: &[Vec<(u32, u32)>; 2]) -> Self {
        let parts = vec![Part::All; positions.len()];
        Self {
            state: State::new(positions, &vec![1.0; positions.len()]),
            contacts: Contacts::new(spans, &parts, positions, colliders),
            width: Width::widest(),
            how: HOW,
        }
    }

    /// Where particle `i` is.
    pub fn at(&mut self, i: usize) -> Vec3 {
        get(self.state.columns().x, i).into()
    }

    pub fn previous(&mut self, i: usize) -> Vec3 {
        get(self.state.columns().previous, i).into()
    }

    /// The substep starts where the particle is and would end at `to` but for contact.
    pub fn send(&mut self, i: usize, to: Vec3) {
        let cols = self.state.columns();
        set(cols.previous, i, get(cols.x, i));
        set(cols.x, i, to.into());
    }

    pub fn find(&mut self, colliders: &Colliders) {
        let cols = self.state.columns();
        (0..2).for_each(|w| self.contacts.owners()[w].find(self.width, cols, colliders, &self.how));
    }

    pub fn solve(&mut self, span: [f32; 2]) {
        let cols = self.state.columns();
        (0..2).for_each(|w| self.contacts.owners()[w].solve(self.width, cols, span, &self.how));
    }

    pub fn positions(&mut self) -> Vec<Vec3> {
        let cols = self.state.columns();
        (0..cols.w.len()).map(|i| get(cols.x, i).into()).collect()
    }

    /// All bits of the state.
    pub fn bits(&mut self) -> Vec<u32> {
        let cols = self.state.columns();
        let columns = cols.x.into_iter().chain(cols.previous);
        columns.flat_map(|c| (0..c.len()).map(move |i| c.get(i).to_bits())).collect()
    }
}

/// Particles in and around a walking pair of legs, and what carries them.
pub fn crowd(n: usize, seed: u64) -> (Vec<Vec3>, Colliders) {
    let mut random = Random(seed);
    let from = [
        Vec4::new(-0.1, 0.9, 0.0, 0.11),
        Vec4::new(-0.11, 0.5, 0.02, 0.07),
        Vec4::new(-0.11, 0.1, 0.0, 0.05),
        Vec4::new(0.1, 0.9, 0.0, 0.11),
        Vec4::new(0.0, 0.95, 0.05, 0.3),
    ];
    let to = from.map(|s| s + Vec4::new(0.01, 0.0, 0.08 * (1.0 - s.y), 0.0));
    let colliders = colliders(&from, &to, &[[0, 1], [1, 2], [3, 3], [0, 3], [4, 0]], true);
    let point = |_| {
        let p = random.point(0.3);
        Vec3::new(p.x, 0.02 + (p.y + 0.3) * 1.8, p.z)
    };
    ((0..n).map(point).collect(), colliders)
}

/// Sends every particle on a way of its own of up to `far` (m) and settles its velocity for the search.
pub fn stir(bed: &mut Bed, far: f32, seed: u64) {
    let mut random = Random(seed);
    for (i, p) in bed.positions().into_iter().enumerate() {
        let way = random.direction() * far * random.unit();
        set(bed.state.columns().v, i, Vec3A::from(way * 480.0));
        bed.send(i, p + way);
    }
}
