//! Laws of what a particle keeps in mind: how much, and which.

use glam::Vec3;
use toile_assets::bake::bake;
use toile_assets::fabric::Fabric;
use toile_assets::garment::{Garment, Shape};

use super::*;
use crate::cloth::layers::garment_surface::{GarmentMotion, GarmentSurface};
use crate::cloth::layers::pair::Wearing;
use crate::cloth::state::State;
use crate::lanes::Width;

/// Vertices a side of a sheet, and how far they are apart (m).
const SIDE: u32 = 8;
const SPACING_M: f32 = 0.02;

/// One garment of square sheets that hang together nowhere, each where `at` says (m).
fn sheets(count: u32, at: impl Fn(u32) -> Vec3) -> Garment {
    let mut fabric = Fabric::built_in("cotton-jersey").unwrap();
    fabric.thickness_mm = 10.0;
    let place = |row: u32, column: u32| {
        let within = Vec3::new(column as f32, 0.0, (row % SIDE) as f32) * SPACING_M;
        (at(row / SIDE) + within, false)
    };
    let mut shape = Shape::sheet(count * SIDE, SIDE, place);
    shape.faces.retain(|f| f.iter().all(|v| v / (SIDE * SIDE) == f[0] / (SIDE * SIDE)));
    bake("sheets", "one", &shape, &fabric).unwrap()
}

/// The folds of a garment, all of them one worker's, and its particles.
struct Folded {
    garment: Garment,
    surface: GarmentSurface,
    pair: LayerPair,
    motion: GarmentMotion,
    shares: [FoldShare; 2],
    state: State,
    tick: u64,
}

impl Folded {
    fn new(count: u32) -> Self {
        // Far apart, so that none are sewn together.
        let garment = sheets(count, |k| Vec3::Y * (k as f32));
        let surface = GarmentSurface::new(&garment).with_folds(&garment);
        Self {
            pair: LayerPair::new(std::slice::from_ref(&garment), 0, 0, Wearing::Folded, 1),
            motion: GarmentMotion::new(&surface),
            shares: [0, 1].map(|share| FoldShare::new(garment.particles(), share)),
            state: State::new(&garment.start, &garment.inverse_mass),
            surface,
            garment,
            tick: 0,
        }
    }

    /// Which sheet a particle is of.
    fn sheet(&self, particle: u32) -> u32 {
        self.garment.source[particle as usize] / (SIDE * SIDE)
    }

    /// Finds the contacts where each sheet is moved from where it starts (m).
    fn find(&mut self, width: Width, moved: impl Fn(u32) -> Vec3) -> Vec<LayerContact> {
        let at = |i: u32| self.garment.start[i as usize] + moved(self.sheet(i));
        let positions: Vec<Vec3> = (0..self.garment.particles() as u32).map(at).collect();
        self.find_at(width, &positions)
    }

    fn find_at(&mut self, width: Width, positions: &[Vec3]) -> Vec<LayerContact> {
        self.state = State::new(positions, &self.garment.inverse_mass);
        let Self { surface, motion, pair, shares, state, tick, .. } = self;
        let columns = state.columns();
        motion.take(surface, columns, width);
        let scene = PairScene {
            columns: [columns; 2],
            surfaces: [surface; 2],
            motions: [motion; 2],
            step_seconds: 1.0 / 120.0,
            tick: *tick,
            width,
        };
        let mut contacts = Vec::new();
        for share in shares {
            let of = FoldScene { surface: surface.folds.as_ref().unwrap(), motion: &motion.folds };
            let mut own = Vec::with_capacity(FoldShare::most_contacts(pair.count));
            share.find(pair, &scene, of, &mut own);
            contacts.extend(own);
        }
        *tick += 1;
        contacts
    }

    /// The sheets that a particle keeps in mind, in order.
    fn minded(&self, particle: u32) -> Vec<u32> {
        let all = self.shares.iter().flat_map(|s| s.pieces[particle as usize]);
        let pieces = all.filter(|p| p.triangle != NONE);
        let mut sheets: Vec<u32> = pieces.map(|p| self.sheet(self.surface.mesh.corners(p.triangle)[0])).collect();
        sheets.sort_unstable();
        sheets
    }

    fn crowded(&self) -> u64 {
        self.shares.iter().map(|s| s.counts().crowded).sum()
    }
}

/// To these heights (m) above the first sheet.
fn to(heights: [f32; 4]) -> impl Fn(u32) -> Vec3 {
    move |k| Vec3::Y * (heights[k as usize] - k as f32)
}

#[test]
fn a_third_piece_takes_the_place_of_the_farther_one_and_of_its_contact() {
    let mut folded = Folded::new(4);
    folded.find(Width::widest(), to([0.0, 0.009, -0.008, 0.5]));
    let inner: Vec<u32> = (0..folded.garment.particles() as u32).filter(|&i| folded.minded(i) == [1, 2]).collect();
    assert!(inner.len() >= ((SIDE - 2) * (SIDE - 2)) as usize, "{} particles lie between two sheets", inner.len());
    assert_eq!(folded.crowded(), 0);
    let contacts = folded.find(Width::widest(), to([0.0, 0.009, -0.008, 0.005]));
    let mut replaced = 0;
    for &i in inner.iter().filter(|&&i| folded.minded(i) != [1, 2]) {
        assert_eq!(folded.minded(i), [2, 3], "particle {i}");
        let met: Vec<u32> = contacts.iter().filter(|c| c.particle == i).map(|c| folded.sheet(c.corners[0])).collect();
        assert!(met.len() == 2 && !met.contains(&1), "particle {i} still meets what it does not mind: {met:?}");
        replaced += 1;
    }
    assert!(replaced > 0 && folded.crowded() >= replaced, "{replaced} of {}", folded.crowded());
    assert!(contacts.iter().all(|c| c.normal.is_normalized()));
}

#[test]
fn of_equally_near_pieces_the_lower_index_is_kept() {
    let piece = |distance, triangle| Piece { distance, triangle, ..NO_PIECE };
    assert!(piece(0.002, 9).order() < piece(0.003, 1).order());
    assert!(piece(0.002, 1).order() < piece(0.002, 9).order());
}

#[test]
fn of_equally_near_particles_the_lowest_index_is_found_at_every_width() {
    let seeds = |width| {
        let mut folded = Folded::new(2);
        // Each particle of one sheet is over the middle of four of the other.
        let half = Vec3::new(0.5, 0.0, 0.5) * SPACING_M;
        folded.find(width, |k| if k == 0 { Vec3::ZERO } else { Vec3::Y * (0.009 - 1.0) + half });
        let all: Vec<FoldSeed> = folded.shares.iter().flat_map(|s| s.seeds.clone()).collect();
        (folded, all)
    };
    let (folded, first) = seeds(Width::One);
    assert!(first.len() > 2 * ((SIDE - 2) * (SIDE - 2)) as usize, "{} seeds", first.len());
    let at = |i: u32| Vec3::from_array(folded.state.positions().map(|c| c[i as usize]));
    for seed in &first {
        let distance = |j: u32| (at(j) - at(seed.particle)).length_squared();
        let others = (0..folded.garment.particles() as u32).filter(|&j| folded.sheet(j) != folded.sheet(seed.particle));
        let nearest = others.min_by(|&a, &b| distance(a).total_cmp(&distance(b)).then(a.cmp(&b)));
        assert_eq!(Some(seed.vertex), nearest, "of particle {}", seed.particle);
    }
    for width in Width::ALL.into_iter().filter(|w| w.available()) {
        assert_eq!(seeds(width).1, first, "{width} lanes");
    }
}

#[test]
fn crushed_cloth_never_needs_more_room_than_was_made() {
    let mut folded = Folded::new(4);
    let before = folded.shares.each_ref().map(FoldShare::bytes);
    let mut chance = 1u64;
    let mut unit = move || {
        chance = chance.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (chance >> 40) as f32 / (1u64 << 24) as f32
    };
    for _ in 0..40 {
        let ball = |_| Vec3::new(unit(), unit(), unit()) * 0.04;
        let positions: Vec<Vec3> = folded.garment.start.iter().map(ball).collect();
        let contacts = folded.find_at(Width::widest(), &positions);
        assert!(contacts.iter().all(|c| c.normal != Vec3A::ZERO));
        for share in &folded.shares {
            let mut minding = share.minding.clone();
            minding.sort_unstable();
            minding.dedup();
            assert_eq!(minding.len(), share.minding.len(), "a particle is listed twice");
        }
    }
    assert!(folded.crowded() > 0, "nothing was crowded");
    assert_eq!(folded.shares.each_ref().map(FoldShare::bytes), before, "something grew");
}
