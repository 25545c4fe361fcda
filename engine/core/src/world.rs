//! The world: one step of the whole scene, stage after stage, and the snapshot that it publishes.
//!
//! A step may take 8,333 us, of which the cloth has the most. Nothing is allocated after [`World::new`]. It runs on the physics
//! thread.

mod meters;

use glam::{Affine3A, Vec3};
use toile_base::body::Body;
use toile_base::frame::Joints;
use toile_base::garment::{Garment, Part};
use toile_base::limits::{STEP_HZ, STEP_SECONDS};
use toile_base::numeric::hash::Fnv1a;
use toile_base::numeric::portable;
use toile_base::rig::Rig;
use toile_base::skeleton::{BONES, Pose};

use crate::body::{Poser, palette};
use crate::body_surface::BodySurface;
use crate::clock::{Clock, RealClock};
use crate::cloth::contact::garments::{GarmentContact, lay_outside};
use crate::cloth::step::measure::{self, Strain};
use crate::cloth::{Cloth, ContactRates, Settings, Step, Wind};
use crate::colliders::{ColliderError, Colliders, RestSphere};
use crate::meter::{CLOTH, PLACE, POSE, PUBLISH, SKIN};
use crate::skin::{Blend, Posed, SkinError, SkinningJob};
use crate::triple_buffer::{Reader, TripleBuffer, Writer};
use crate::workers::{SHARES, WorkerPool, WorkerPoolError};
use meters::StageTimes;

pub use meters::Meters;

/// Steps in which the body moves from its rest pose into the shopper's first pose while it is being dressed.
pub const DRESS_STEPS: u64 = STEP_HZ as u64;

/// Steps in which the garments then settle before the session starts.
pub const SETTLE_STEPS: u64 = STEP_HZ as u64 / 2;

/// How the body is skinned: dual quaternions take no longer than linear blending, and where that thins a bent elbow to half
/// they keep it, at the price of a bulge of some millimetres (docs/skinning.md).
pub const BLEND: Blend = Blend::Dual;

/// What was drawn last: everything that a picture needs, copied once a step.
#[derive(Debug, Clone, PartialEq)]
pub struct Snapshot {
    /// Steps since the session began.
    pub tick: u64,
    /// When what it shows came to be.
    pub times: SnapshotTimes,
    /// The body: positions (m) and unit normals, which [`Posed::read`] brings into the order of the mesh.
    pub skin: Posed,
    /// Particles of each garment, world (m) `[garments][particles]`.
    pub garments: Box<[Box<[Vec3]>]>,
    /// How the body is bent: what brings it along with a picture of another moment.
    pub pose: Pose,
}

/// When what a snapshot shows came to be, on the loop's clock (ns); all 0 where no loop ran.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct SnapshotTimes {
    /// When the newest sensor frame in it was taken.
    pub seen_ns: u64,
    /// When that frame arrived here.
    pub arrived_ns: u64,
    /// Its number, from 1; 0 is none.
    pub frame: u64,
    /// When the step was due.
    pub scheduled_ns: u64,
    /// When the step began.
    pub begun_ns: u64,
    /// When the snapshot was published.
    pub published_ns: u64,
}

/// Why a scene cannot be set up.
#[derive(Debug, thiserror::Error)]
pub enum WorldError {
    /// Colliders that cannot be used.
    #[error(transparent)]
    Colliders(#[from] ColliderError),
    /// A skin that cannot be used.
    #[error(transparent)]
    Skin(#[from] SkinError),
    /// The worker pool cannot be started.
    #[error(transparent)]
    WorkerPool(#[from] WorkerPoolError),
}

/// The scene in motion: a body, its colliders, its garments.
#[derive(Debug)]
pub struct World {
    body: Body,
    garments: Box<[Garment]>,
    cloths: Box<[Cloth]>,
    /// What keeps them in their order; none where no two can meet.
    layers: Option<GarmentContact>,
    settings: Settings,
    poser: Poser,
    pose: Pose,
    palette: [Affine3A; BONES],
    colliders: Colliders,
    pool: WorkerPool,
    /// Steps in which a worker panicked.
    broken: u64,
    skinning: SkinningJob,
    /// The body as last skinned; changes places with a snapshot's when it is published.
    skin: Posed,
    tick: u64,
    clock: RealClock,
    meters: Meters,
    measure_every: u64,
    writer: Writer<Snapshot>,
}

impl World {
    /// All storage of a scene. The reader is the end at which pictures are made.
    pub fn new(
        body: Body,
        rig: &Rig,
        mut garments: Vec<Garment>,
        settings: Settings,
    ) -> Result<(Self, Reader<Snapshot>), WorldError> {
        lay_outside(&mut garments);
        let spheres = rig.spheres.each_ref().map(|s| RestSphere::on_bone(&body.skeleton, s.bone, s.offset, s.radius));
        let skinning = SkinningJob::new(&body.mesh.positions, &body.normals, &body.weights)?;
        let parts: Vec<Part> = garments.iter().flat_map(|g| g.parts.iter().copied()).collect();
        let surface = BodySurface::new(&body, &skinning.posed(), &parts);
        let colliders = Colliders::new(&spheres, &rig.capsules, true)?.with_skin(surface);
        let ready = |g: &Garment, cloth: Cloth| if settings.wind.is_some() { cloth.in_wind(g) } else { cloth };
        let cloths: Box<[Cloth]> = garments.iter().map(|g| ready(g, Cloth::new(g, &colliders))).collect();
        let snapshot = Snapshot {
            tick: 0,
            times: SnapshotTimes::default(),
            skin: skinning.posed(),
            garments: garments.iter().map(|g| g.start.clone()).collect(),
            pose: Pose::rest(&body.skeleton),
        };
        let TripleBuffer { writer, reader } = TripleBuffer::new(&snapshot);
        let pool = WorkerPool::new(settings.workers.clamp(1, SHARES))?;
        let world = Self {
            poser: Poser::new(&body.skeleton).keeping_clear(&spheres, &rig.capsules),
            pose: Pose::rest(&body.skeleton),
            palette: [Affine3A::IDENTITY; BONES],
            colliders,
            broken: 0,
            skinning,
            skin: snapshot.skin,
            tick: 0,
            clock: RealClock::default(),
            meters: Meters::new(),
            measure_every: 1,
            writer,
            layers: GarmentContact::new(&garments),
            garments: garments.into(),
            cloths,
            // As many as there are, whatever was asked for.
            settings: Settings { workers: pool.workers(), ..settings },
            pool,
            body,
        };
        Ok((world, reader))
    }

    /// Dresses the shopper before the session starts: from the rest pose, in which garments are cut, into the pose of
    /// the session's first joints, then at rest until the garments have settled. Not metered.
    pub fn dress(&mut self, first: &Joints) {
        self.poser.reset();
        let goal = self.poser.pose(first, STEP_SECONDS);
        self.dress_in_pose(&goal);
    }

    /// The same for a session of poses that are known: nothing filters or limits them.
    pub fn dress_in_pose(&mut self, goal: &Pose) {
        let clock = self.clock;
        let rest = Pose::rest(&self.body.skeleton);
        for step in 1..=DRESS_STEPS + SETTLE_STEPS {
            let t = (step as f32 / DRESS_STEPS as f32).min(1.0);
            self.pose = blend(&rest, goal, t * t * (3.0 - 2.0 * t));
            self.advance(&mut StageTimes::from(clock.now_ns()), &clock);
        }
    }

    /// The same, and shows them as they then stand: readers have that snapshot before the first step.
    pub fn dress_and_show(&mut self, first: &Joints) {
        self.dress(first);
        let clock = self.clock;
        self.publish(SnapshotTimes::default(), &clock);
    }

    /// The same with another pool, one whose helper has a core of its own for example. At load.
    #[must_use]
    pub fn with_workers(self, pool: WorkerPool) -> Self {
        Self { settings: Settings { workers: pool.workers(), ..self.settings }, pool, ..self }
    }

    /// Swaps worker pools with a world that is no longer stepped, which gets this one's: no thread begins or ends.
    pub fn swap_workers(&mut self, from: &mut Self) {
        std::mem::swap(&mut self.pool, &mut from.pool);
        self.settings.workers = self.pool.workers();
        from.settings.workers = from.pool.workers();
    }

    /// Strain and penetration are measured every so many steps, for a loop that has other things to do with the time;
    /// 0 is never.
    pub fn measure_every(&mut self, steps: u64) {
        self.measure_every = steps;
    }

    /// Spoils the state of every garment ([`Cloth::inject_fault`]).
    pub fn inject_fault(&mut self, seed: u64) {
        self.cloths.iter_mut().for_each(|cloth| cloth.inject_fault(seed));
    }

    /// What quality control gave up: the share of the substeps that is left, and whether there is wind.
    pub fn set_quality(&mut self, substep_share: f32, wind: Option<Wind>) {
        (self.settings.substep_share, self.settings.wind) = (substep_share, wind);
    }

    /// How often what is left of contact is looked for.
    pub fn set_contact(&mut self, every: ContactRates) {
        self.settings.contact = every;
        if let Some(layers) = &mut self.layers
            && !layers.asked(&self.settings)
        {
            layers.forget();
            self.cloths.iter_mut().for_each(Cloth::forget_the_body);
        }
    }

    /// One step of the session: the joints as they are at its end.
    pub fn step(&mut self, joints: &Joints) {
        let clock = self.clock;
        self.step_at(joints, SnapshotTimes::default(), &clock);
        self.measure();
    }

    /// The step itself, as the loop takes it: what it shows is published with these times.
    pub fn step_at(&mut self, joints: &Joints, times: SnapshotTimes, clock: &impl Clock) {
        let begun_ns = clock.now_ns();
        // It wakes while the body is posed and skinned.
        self.pool.wake();
        self.pose = self.poser.pose(joints, STEP_SECONDS);
        self.finish_step(StageTimes::from(begun_ns), times, clock);
    }

    /// One step of a session of poses that are known: the body in its pose at the step's end.
    pub fn step_in_pose(&mut self, pose: &Pose) {
        let clock = self.clock;
        let stage_times = StageTimes::from(clock.now_ns());
        self.pool.wake();
        self.pose = *pose;
        self.finish_step(stage_times, SnapshotTimes::default(), &clock);
        self.measure();
    }

    /// The stages after the pose, published and metered.
    fn finish_step(&mut self, mut stage_times: StageTimes, times: SnapshotTimes, clock: &impl Clock) {
        self.advance(&mut stage_times, clock);
        self.publish(times, clock);
        stage_times.lap(PUBLISH, clock.now_ns());
        self.meters.timed(stage_times.ns);
        self.tick += 1;
    }

    /// The stages after the pose, in order.
    fn advance(&mut self, stage_times: &mut StageTimes, clock: &impl Clock) {
        palette(&self.body.skeleton, &self.pose, &mut self.palette);
        stage_times.lap(POSE, clock.now_ns());
        // What a worker that panicked left out shows the body as it was.
        let skinned = self.skinning.run_with(&mut self.pool, BLEND, &self.palette, &mut self.skin);
        self.broken += u64::from(!skinned);
        stage_times.lap(SKIN, clock.now_ns());
        self.colliders.place(&self.palette);
        self.colliders.place_skin(&self.skin);
        stage_times.lap(PLACE, clock.now_ns());
        let Self { cloths, garments, layers, pool, palette, colliders, settings, .. } = self;
        let step = Step { palette, colliders, settings };
        let layers = layers.as_mut().filter(|layers| layers.asked(settings));
        match (&mut cloths[..], &garments[..], layers) {
            (cloths, garments, Some(layers)) => {
                let work = layers.step(pool, cloths, garments, &step);
                self.broken += u64::from(work.is_err());
            }
            // One garment is shared by the workers; several are one worker's each.
            ([cloth], [garment], None) => cloth.step_with(pool, garment, &step),
            (cloths, garments, None) => {
                let work = pool.each(cloths, |i, cloth| cloth.step(&garments[i], &step));
                // The garment whose step broke off keeps what it had published.
                self.broken += u64::from(work.is_err());
            }
        }
        stage_times.lap(CLOTH, clock.now_ns());
    }

    fn publish(&mut self, times: SnapshotTimes, clock: &impl Clock) {
        let Self { writer, skin, cloths, tick, pose, .. } = self;
        writer.publish_with(|snapshot| {
            (snapshot.tick, snapshot.pose) = (*tick, *pose);
            // No copy: the next step writes all of the one that comes back.
            std::mem::swap(&mut snapshot.skin, skin);
            for (to, cloth) in snapshot.garments.iter_mut().zip(cloths.iter()) {
                to.iter_mut().zip(&cloth.positions).for_each(|(t, p)| *t = (*p).into());
            }
            snapshot.times = SnapshotTimes { published_ns: clock.now_ns(), ..times };
        });
    }

    /// Strain and penetration of the state that was reached, outside of the timed part. Some 100 us for 6,000 particles.
    pub fn measure(&mut self) {
        if self.measure_every == 0 || !self.tick.is_multiple_of(self.measure_every) {
            return;
        }
        let (mut worst, mut deepest) = (Strain::default(), 0.0f32);
        for (cloth, garment) in self.cloths.iter_mut().zip(&self.garments) {
            let strain = measure::strain(cloth, garment);
            worst.mean = worst.mean.max(strain.mean);
            worst.p99 = worst.p99.max(strain.p99);
            worst.max = worst.max.max(strain.max);
            deepest = deepest.max(measure::penetration(cloth, garment, &self.colliders));
        }
        self.meters.measured(worst, deepest);
    }

    /// The meters of the session so far.
    pub fn meters(&self) -> &Meters {
        &self.meters
    }

    /// Forgets them: what comes before a benchmark is not its matter.
    pub fn clear_meters(&mut self) {
        self.meters.clear();
    }

    /// Steps of the session so far.
    pub fn tick(&self) -> u64 {
        self.tick
    }

    /// Steps in which a worker panicked and garments kept what they had published.
    pub fn broken(&self) -> u64 {
        self.broken
    }

    /// How the cloth is stepped.
    pub fn settings(&self) -> &Settings {
        &self.settings
    }

    /// The pose of the last step.
    pub fn pose(&self) -> &Pose {
        &self.pose
    }

    /// The shopper's body as it moves.
    pub fn body(&self) -> &Body {
        &self.body
    }

    /// The garments, in the order in which they were given.
    pub fn garments(&self) -> &[Garment] {
        &self.garments
    }

    /// Their states, in the same order.
    pub fn cloths(&self) -> &[Cloth] {
        &self.cloths
    }

    /// What keeps the garments in their order, where several are worn that can meet.
    pub fn layers(&self) -> Option<&GarmentContact> {
        self.layers.as_ref()
    }

    /// The colliders as last placed.
    pub fn colliders(&self) -> &Colliders {
        &self.colliders
    }

    /// FNV-1a over the bits of pose and particles: equal states give equal hashes.
    pub fn state_hash(&self) -> u64 {
        let mut hash = Fnv1a::default();
        let mut add = |value: f32| hash.number(value);
        self.pose.root.to_array().into_iter().for_each(&mut add);
        self.pose.local.iter().flat_map(|q| q.to_array()).for_each(&mut add);
        for cloth in &self.cloths {
            cloth.positions.iter().flat_map(|p| p.to_array()).for_each(&mut add);
            (0..cloth.positions.len()).flat_map(|i| cloth.velocity(i).to_array()).for_each(&mut add);
            cloth.sticks().iter().chain(cloth.link_sticks().flatten()).copied().for_each(&mut add);
        }
        hash.finish()
    }

    /// The same for every step of a recording: other numbers, a tenth of the time.
    pub fn fingerprint(&self) -> u64 {
        let mut print = Fingerprint::default();
        print.add(&self.pose.root.to_array());
        self.pose.local.iter().for_each(|q| print.add(&q.to_array()));
        for cloth in &self.cloths {
            cloth.state.positions().into_iter().chain(cloth.state.velocities()).for_each(|column| print.add(column));
            if !cloth.sticks().is_empty() {
                print.add(cloth.sticks());
            }
            cloth.link_sticks().for_each(|sticks| print.add(sticks));
        }
        print.end()
    }
}

/// A hash over columns of numbers: four sums side by side, as a processor multiplies.
#[derive(Default)]
struct Fingerprint([u64; 4]);

impl Fingerprint {
    /// An odd number without a pattern: 2^64 over the golden ratio.
    const ODD: u64 = 0x9e37_79b9_7f4a_7c15;

    fn add(&mut self, numbers: &[f32]) {
        let (fours, rest) = numbers.as_chunks::<4>();
        fours.iter().for_each(|four| self.four(four.map(f32::to_bits)));
        let mut last = [0; 4];
        last.iter_mut().zip(rest).for_each(|(to, n)| *to = n.to_bits());
        self.four(last);
    }

    fn four(&mut self, bits: [u32; 4]) {
        for (sum, bits) in self.0.iter_mut().zip(bits) {
            *sum = (*sum ^ u64::from(bits)).wrapping_mul(Self::ODD).rotate_left(29);
        }
    }

    fn end(self) -> u64 {
        self.0.into_iter().fold(0, |hash, sum| (hash ^ sum).wrapping_mul(Self::ODD).rotate_left(29))
    }
}

/// A pose between two others.
fn blend(from: &Pose, to: &Pose, t: f32) -> Pose {
    Pose {
        root: from.root.lerp(to.root, t),
        local: std::array::from_fn(|i| portable::slerp(from.local[i], to.local[i], t)),
    }
}

#[cfg(test)]
mod tests {
    use toile_assets::scene;

    use super::*;

    #[test]
    fn settings_name_the_workers_that_there_are() {
        let (sex, measures) = scene::SHOPPER;
        let body = toile_assets::body::build(sex, &measures).unwrap();
        let rig = toile_assets::rig::fit(&body);
        for (asked, given) in [(0, 1), (1, 1), (2, 2), (9, SHARES)] {
            let settings = Settings { workers: asked, ..Settings::default() };
            let (world, _reader) = World::new(body.clone(), &rig, Vec::new(), settings).unwrap();
            assert_eq!(world.settings().workers, given, "{asked} asked for");
            let (other, _reader) = World::new(body.clone(), &rig, Vec::new(), Settings::default()).unwrap();
            let world = other.with_workers(WorkerPool::new(given).unwrap());
            assert_eq!(world.settings().workers, given);
        }
    }
}
