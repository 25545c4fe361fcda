//! Cloth: one garment as particles, stepped at 120 Hz.
//!
//! A step of 6,000 particles may take 3 ms on one core ([`STEP_BUDGET_US`]). Nothing is allocated after [`Cloth::new`]. It runs on
//! the physics thread, and two workers may share a step.

pub mod contact;
pub mod forces;
pub mod links;
pub mod state;
pub mod step;

use std::sync::Arc;

use glam::{Affine3A, Vec3A};
use toile_base::garment::layout::OWNERS;
use toile_base::garment::{Garment, Layout};
use toile_base::skeleton::BONES;

use crate::bounded::Fill;
use crate::colliders::Colliders;
use crate::lanes::{RECORD, Store};
use forces::root::RootMotion;
pub use forces::root::{RootSettings, Teleport};
pub use forces::wind::Wind;
use state::State;
use step::program::METERED_STAGES;
pub use step::settings::{ContactRates, Quality, Settings};

/// What a step of one garment may cost (us): a third of the 8,333 us that 120 Hz leaves, so that two garments and the
/// rest of the frame fit beside it.
pub const STEP_BUDGET_US: f32 = 3_000.0;

/// What the surroundings do during one step.
#[derive(Debug, Clone, Copy)]
pub struct Step<'a> {
    /// Skin matrices at the end of the step.
    pub palette: &'a [Affine3A; BONES],
    /// The body's spheres and capsules at the start and the end of the step.
    pub colliders: &'a Colliders,
    /// How the cloth is stepped.
    pub settings: &'a Settings,
}

/// The state of one garment. All storage is made once.
#[derive(Debug, Clone)]
pub struct Cloth {
    /// World position (m) at the end of the last step `[particles]`: always finite.
    pub positions: Box<[Vec3A]>,
    /// The constraints of the garment that all of this was made for.
    layout: Arc<Layout>,
    /// The particles as the kernels have them.
    pub(crate) state: State,
    /// Where the skinned particles are to be.
    pins: state::pins::Pins,
    /// What contact keeps from step to step.
    contacts: contact::body::Contacts,
    /// Room of each worker for a fiber's factors.
    scratch: [Store; OWNERS],
    /// Records of the particles; none where nothing reads any.
    records: Store,
    /// Room for bending that is stiffer than a substep; none where it cannot be.
    bending_scratch: forces::stiff_bending::StiffBendingScratch,
    /// What bending remembers by friction; empty where nothing rubs.
    friction: forces::bend_friction::FrictionState,
    /// Stretch curves of links; empty where one slope is all.
    link_curves: links::link_curves::CurveState,
    /// Room for what is solved along the bias.
    bias_scratch: links::diagonals::DiagonalScratch,
    /// Tensions of weft links, of fibers, of crossing fibers within a substep; empty where they have no compliance.
    tension: [Store; 3],
    /// Room to sort strains in (1).
    pub(crate) strains: Box<[f32]>,
    prepared: step::prepared::Prepared,
    /// The root's motion, and the point of the garment at rest that it is taken at (m).
    root: RootMotion,
    origin: Vec3A,
    /// Accelerations of the particles besides gravity (m/s2).
    acceleration: forces::wind::Accelerations,
    /// The triangles as the wind has them, where there is wind.
    faces: Option<forces::wind::Faces>,
    /// What happened that should not have.
    pub events: step::guard::GuardEvents,
    /// Time spent in each of [`METERED_STAGES`] during the last step that was metered (ns).
    pub stage_ns: [u64; METERED_STAGES.len()],
    /// Of these the greater share of each phase (ns): what two workers cannot go below.
    pub greater_share_ns: [u64; METERED_STAGES.len()],
    /// Steps in a row that were rolled back.
    rolled: u32,
    /// Whether the last step found the state to be sound and nothing has written to it since.
    checked: bool,
}

impl Cloth {
    /// All storage of a garment, at rest where the garment starts; `colliders` says which capsules are which limb's.
    pub fn new(garment: &Garment, colliders: &Colliders) -> Self {
        let start: Box<[Vec3A]> = garment.start.iter().map(|&p| p.into()).collect();
        let layout = garment.shared_layout();
        let needs = [links::fibers::scratch_len(&layout.fibers), links::lists::scratch_len(&layout.crossing)];
        let prepared = step::prepared::Prepared::new(garment);
        let tension = prepared.tensions(layout).map(Store::zeros);
        let scratch = || Store::zeros(needs.into_iter().max().unwrap_or(0));
        Self {
            layout: Arc::clone(layout),
            state: State::new(&garment.start, &garment.inverse_mass),
            pins: state::pins::Pins::new(garment),
            contacts: contact::body::Contacts::new(&layout.spans, &garment.parts, &garment.start, colliders),
            scratch: [scratch(), scratch()],
            records: Store::zeros(if prepared.reads_records() { RECORD * (start.len() + OWNERS) } else { 0 }),
            bending_scratch: forces::stiff_bending::StiffBendingScratch::new(if prepared.stiff() {
                start.len()
            } else {
                0
            }),
            friction: forces::bend_friction::FrictionState::new(&prepared.friction, start.len()),
            link_curves: links::link_curves::CurveState::new(layout),
            bias_scratch: links::diagonals::DiagonalScratch::new(&garment.layout().diagonals, garment.start.len()),
            strains: vec![0.0; garment.strain_edges.len()].into(),
            prepared,
            tension,
            root: RootMotion::new(RootSettings::default()),
            origin: centre(garment),
            acceleration: forces::wind::Accelerations::new(start.len()),
            faces: None,
            events: step::guard::GuardEvents::default(),
            stage_ns: [0; METERED_STAGES.len()],
            greater_share_ns: [0; METERED_STAGES.len()],
            rolled: 0,
            checked: false,
            positions: start,
        }
    }

    /// Makes the garment ready for wind. At load.
    ///
    /// # Panics
    /// Where the state was made for another garment.
    pub fn in_wind(mut self, garment: &Garment) -> Self {
        assert!(self.is_of(garment), "the state was made for another garment");
        let owner = &garment.layout().owner;
        self.faces = Some(forces::wind::Faces::new(&garment.triangles, &garment.start, &garment.inverse_mass, owner));
        self
    }

    /// Whether the state was made for this garment or for a clone of it. Two workers step it by the garment's layout without a lock,
    /// so no step is made with another garment.
    pub fn is_of(&self, garment: &Garment) -> bool {
        Arc::ptr_eq(&self.layout, garment.shared_layout())
    }

    /// The same for a step, which counts what it refuses.
    pub(crate) fn accepts(&mut self, garment: &Garment) -> bool {
        let accepted = self.is_of(garment);
        self.events.refused += u64::from(!accepted);
        accepted
    }

    /// Velocity of a particle at the end of the last step (m/s).
    pub fn velocity(&self, particle: usize) -> Vec3A {
        Vec3A::from_array(self.state.velocities().map(|column| column[particle]))
    }

    /// Puts a particle somewhere, with a velocity (m, m/s): how tests and scenes disturb a garment.
    pub fn disturb(&mut self, particle: usize, position: Vec3A, velocity: Vec3A) {
        self.checked = false;
        let columns = self.state.columns();
        state::set(columns.x, particle, position);
        state::set(columns.previous, particle, position);
        state::set(columns.v, particle, velocity);
        if position.is_finite() {
            self.positions[particle] = position;
        }
    }

    /// The body gives way nowhere any more: for steps without contact of cloth with cloth, which would take that back.
    pub fn forget_the_body(&mut self) {
        self.state.forget_the_body();
    }

    /// Spoils the state between two steps, as a fault of the memory or of the solver itself would: what [`step::guard::spoil`] picks
    /// by `seed`. How a soak tries the guard; what was published stays.
    pub fn inject_fault(&mut self, seed: u64) {
        if self.positions.is_empty() {
            return;
        }
        self.checked = false;
        let columns = self.state.columns();
        for (i, what) in step::guard::spoil(seed, self.positions.len()) {
            match what {
                step::guard::InjectedFault::Place(x) => state::set(columns.x, i, x),
                step::guard::InjectedFault::Velocity(v) => state::set(columns.v, i, v),
            }
        }
    }

    /// The particles as the solver has them: what [`Cloth::disturb`] has put somewhere else is there already.
    pub fn state(&self) -> &State {
        &self.state
    }

    /// Bending remembers what that of another state of the same garment remembers; nothing where only one of them rubs.
    pub fn remember(&mut self, other: &Self) {
        if self.sticks().len() == other.sticks().len() {
            self.friction.sticks_mut().copy_from_slice(other.sticks());
        }
        self.link_curves.remember(&other.link_curves);
    }

    /// Where links stick by friction, kind after kind (1); empty where one slope is all.
    pub fn link_sticks(&self) -> impl Iterator<Item = &[f32]> {
        self.link_curves.sticks().filter(|s| !s.is_empty())
    }

    /// Where bending sticks by friction, in the order of its slots (sqrt(N/m) m); empty where nothing rubs.
    pub fn sticks(&self) -> &[f32] {
        self.friction.sticks()
    }

    /// Takes over a step that was computed elsewhere: positions and velocities `[particles]` (m, m/s), and the events so far.
    pub fn take_over(&mut self, positions: &[Vec3A], velocities: &[Vec3A], events: step::guard::GuardEvents) {
        self.checked = false;
        let columns = self.state.columns();
        for (i, (&x, &v)) in positions.iter().zip(velocities).enumerate().take(self.positions.len()) {
            state::set(columns.x, i, x);
            state::set(columns.previous, i, x);
            state::set(columns.v, i, v);
            self.positions[i] = x;
        }
        self.events = events;
    }

    /// Positions of the skinned particles and the root in the last step, and the motion of the root: a stepper elsewhere goes on
    /// from them.
    pub fn course(&self) -> (&state::pins::Pins, &RootMotion) {
        (&self.pins, &self.root)
    }

    /// Takes over the same of a step that was made elsewhere. Allocates nothing.
    pub fn follow(&mut self, pins: &state::pins::Pins, root: &RootMotion) {
        self.pins.copy(pins);
        self.root = *root;
    }

    /// Whether it was made ready for wind.
    pub fn feels_wind(&self) -> bool {
        self.faces.is_some()
    }

    /// Prepares for some settings, as a step with them does first. Another garment than the state's own is refused and counted.
    pub fn prepare(&mut self, garment: &Garment, settings: &Settings) {
        if self.accepts(garment) {
            self.prepared.make(garment, &settings.sound());
        }
    }

    /// Kinetic energy (J); `garment` is the state's own.
    pub fn kinetic_energy(&self, garment: &Garment) -> f64 {
        let particles = garment.inverse_mass.iter().enumerate().filter(|(_, w)| **w > 0.0);
        particles.map(|(i, w)| 0.5 / f64::from(*w) * f64::from(self.velocity(i).length_squared())).sum()
    }

    /// Bytes that the state of the garment holds; its constraints are `Layout::bytes`.
    pub fn bytes(&self) -> usize {
        self.state.bytes()
            + size_of_val(&*self.positions)
            + self.pins.bytes()
            + self.contacts.bytes()
            + self.acceleration.bytes()
            + self.faces.as_ref().map_or(0, forces::wind::Faces::bytes)
            + self.records.bytes()
            + self.bending_scratch.bytes()
            + self.friction.bytes()
            + self.link_curves.bytes()
            + self.bias_scratch.bytes()
            + self.scratch.iter().map(Store::bytes).sum::<usize>()
            + self.tension.iter().map(Store::bytes).sum::<usize>()
            + self.prepared.bytes()
    }

    /// Particles that lay by the skin in the last step.
    pub fn on_skin(&self) -> usize {
        (0..self.positions.len() as u32).filter(|i| self.contacts.by_skin(*i).is_some()).count()
    }

    /// What contact did since the garment was made.
    pub fn contact_counts(&self) -> contact::body::ContactCounts {
        self.contacts.tally()
    }

    /// How full the lists were that steps fill: the fullest of them, and what all of them lost. Each can hold all that may come.
    pub fn lists(&self) -> Fill {
        self.contacts.usage().and(self.prepared.program.usage())
    }

    /// How bending went on in the last step.
    pub fn bend_pace(&self) -> forces::bending::BendingPace {
        self.prepared.bend_pace()
    }

    /// Substeps of a step as last prepared.
    pub fn substeps(&self) -> u32 {
        self.prepared.substeps()
    }
}

/// Where a garment hangs: the middle of its skinned particles, or of all where it has none (m).
pub fn centre(garment: &Garment) -> Vec3A {
    let fixed = garment.fixed.iter().map(|&i| garment.start[i as usize]);
    let (sum, count) = if garment.fixed.is_empty() {
        (garment.start.iter().copied().sum::<glam::Vec3>(), garment.start.len())
    } else {
        (fixed.sum(), garment.fixed.len())
    };
    (sum / count.max(1) as f32).into()
}
