//! The frame: one step of the whole scene, stage after stage, and the snapshot that it publishes.
//!
//! Reads: filtered joints. Writes: a [`Snapshot`] for whoever draws, meters, a state hash.
//! Budget: 8,333 us a step, of which the cloth has the most; no allocation after [`Frame::new`].
//! Thread: physics.

use std::time::Instant;

use glam::{Affine3A, Vec3};
use hdrhistogram::Histogram;
use toile_assets::body::Body;
use toile_assets::garment::Garment;
use toile_assets::limits::{STEP_HZ, STEP_SECONDS};
use toile_assets::rig::Rig;
use toile_assets::skeleton::{BONES, Pose};
use toile_sensors::frame::Joints;

use crate::body::{Poser, palette};
use crate::cloth::measure::{self, Strain};
use crate::cloth::{Cloth, Settings, Step};
use crate::colliders::{ColliderError, Colliders, RestSphere};
use crate::crew::{Crew, CrewError, SHARES};
use crate::relay::{Reader, Relay, Writer};
use crate::skin::{Blend, Posed, SkinError, SkinningJob};

/// Steps in which the body moves from its rest pose into the shopper's first pose while it is being dressed.
pub const DRESS_STEPS: u64 = STEP_HZ as u64;

/// Steps in which the garments then settle before the session starts.
pub const SETTLE_STEPS: u64 = STEP_HZ as u64 / 2;

/// How the body is skinned: dual quaternions take no longer than linear blending, and where that thins a bent elbow to half
/// they keep it, at the price of a bulge of some millimetres (docs/skinning.md).
pub const BLEND: Blend = Blend::Dual;

/// Longest step that the meter tells apart from a longer one (us).
const METER_MAX_US: u64 = 1_000_000;

/// What was drawn last: everything that a picture needs, copied once a step.
#[derive(Debug, Clone, PartialEq)]
pub struct Snapshot {
    /// Steps since the session began.
    pub tick: u64,
    /// The body: positions (m) and unit normals, which [`Posed::read`] brings into the order of the mesh.
    pub skin: Posed,
    /// Particles of each garment, world (m) `[garments][particles]`.
    pub garments: Box<[Box<[Vec3]>]>,
}

/// What the steps of a session came to, for the report.
#[derive(Debug, Clone)]
pub struct Meters {
    /// Time of each step, pose to publish (ns).
    pub step_ns: Histogram<u64>,
    /// Sum over the steps of the mean strain.
    strain_sum: f64,
    /// Sum over the steps of the 99th percentile of strain.
    strain_p99_sum: f64,
    /// Worst strain of any edge in any step (1).
    pub strain_max: f32,
    /// Deepest penetration in any step (m).
    pub penetration_max: f32,
    /// Steps metered.
    pub steps: u64,
}

impl Meters {
    fn new() -> Self {
        // Bounds are constants that the histogram accepts; three digits keep 0.1 % of each value.
        let step_ns = Histogram::new_with_bounds(1, METER_MAX_US * 1_000, 3).expect("constant bounds are valid");
        Self { step_ns, strain_sum: 0.0, strain_p99_sum: 0.0, strain_max: 0.0, penetration_max: 0.0, steps: 0 }
    }

    /// Strain over the session: mean of the means, mean of the 99th percentiles, worst.
    pub fn strain(&self) -> Strain {
        let steps = self.steps.max(1) as f64;
        Strain {
            mean: (self.strain_sum / steps) as f32,
            p99: (self.strain_p99_sum / steps) as f32,
            max: self.strain_max,
        }
    }
}

/// Why a scene cannot be set up.
#[derive(Debug, thiserror::Error)]
pub enum FrameError {
    /// The body's colliders.
    #[error(transparent)]
    Colliders(#[from] ColliderError),
    /// The body's skin.
    #[error(transparent)]
    Skin(#[from] SkinError),
    /// The workers.
    #[error(transparent)]
    Crew(#[from] CrewError),
}

/// The scene in motion: a body, its colliders, its garments.
#[derive(Debug)]
pub struct Frame {
    body: Body,
    garments: Box<[Garment]>,
    cloths: Box<[Cloth]>,
    settings: Settings,
    poser: Poser,
    pose: Pose,
    palette: [Affine3A; BONES],
    colliders: Colliders,
    crew: Crew,
    /// Steps in which a worker panicked.
    broken: u64,
    skinning: SkinningJob,
    /// The body as last skinned; changes places with a snapshot's when it is published.
    skin: Posed,
    tick: u64,
    meters: Meters,
    writer: Writer<Snapshot>,
}

impl Frame {
    /// All storage of a scene. The reader is the end at which pictures are made.
    pub fn new(
        body: Body,
        rig: &Rig,
        garments: Vec<Garment>,
        settings: Settings,
    ) -> Result<(Self, Reader<Snapshot>), FrameError> {
        let spheres = rig.spheres.each_ref().map(|s| RestSphere::on_bone(&body.skeleton, s.bone, s.offset, s.radius));
        let colliders = Colliders::new(&spheres, &rig.capsules, true)?;
        let skinning = SkinningJob::new(&body.mesh.positions, &body.normals, &body.weights)?;
        let ready = |g: &Garment, cloth: Cloth| if settings.wind.is_some() { cloth.in_wind(g) } else { cloth };
        let cloths: Box<[Cloth]> = garments.iter().map(|g| ready(g, Cloth::new(g, &colliders))).collect();
        let snapshot =
            Snapshot { tick: 0, skin: skinning.posed(), garments: garments.iter().map(|g| g.start.clone()).collect() };
        let Relay { writer, reader } = Relay::new(&snapshot);
        let frame = Self {
            poser: Poser::new(&body.skeleton).keeping_clear(&spheres, &rig.capsules),
            pose: Pose::rest(&body.skeleton),
            palette: [Affine3A::IDENTITY; BONES],
            colliders,
            crew: Crew::new(settings.workers.clamp(1, SHARES))?,
            broken: 0,
            skinning,
            skin: snapshot.skin,
            tick: 0,
            meters: Meters::new(),
            writer,
            garments: garments.into(),
            cloths,
            settings,
            body,
        };
        Ok((frame, reader))
    }

    /// Dresses the shopper before the session starts: from the rest pose, in which garments are cut, into the pose of
    /// the session's first joints, then at rest until the garments have settled. Not metered.
    pub fn dress(&mut self, first: &Joints) {
        self.poser.reset();
        let rest = Pose::rest(&self.body.skeleton);
        let goal = self.poser.pose(first, STEP_SECONDS);
        for step in 1..=DRESS_STEPS + SETTLE_STEPS {
            let t = (step as f32 / DRESS_STEPS as f32).min(1.0);
            self.pose = blend(&rest, &goal, t * t * (3.0 - 2.0 * t));
            self.advance();
        }
    }

    /// One step of the session: the joints as they are at its end.
    pub fn step(&mut self, joints: &Joints) {
        let begun = Instant::now();
        // It wakes while the body is posed and skinned.
        self.crew.wake();
        self.pose = self.poser.pose(joints, STEP_SECONDS);
        self.advance();
        self.publish();
        let ns = begun.elapsed().as_nanos().min(u128::from(METER_MAX_US * 1_000)) as u64;
        self.meters.step_ns.saturating_record(ns);
        self.measure();
        self.tick += 1;
    }

    /// The stages after the pose, in order.
    fn advance(&mut self) {
        palette(&self.body.skeleton, &self.pose, &mut self.palette);
        // What a worker that panicked left out shows the body as it was.
        let skinned = self.skinning.run_with(&mut self.crew, BLEND, &self.palette, &mut self.skin);
        self.broken += u64::from(!skinned);
        self.colliders.place(&self.palette);
        let Self { cloths, garments, crew, palette, colliders, settings, .. } = self;
        let step = Step { palette, colliders, settings };
        match (&mut cloths[..], &garments[..]) {
            // One garment is shared by the workers; several are one worker's each.
            ([cloth], [garment]) => cloth.step_with(crew, garment, &step),
            (cloths, garments) => {
                let work = crew.each(cloths, |i, cloth| cloth.step(&garments[i], &step));
                // The garment whose step broke off keeps what it had published.
                self.broken += u64::from(work.is_err());
            }
        }
    }

    fn publish(&mut self) {
        let Self { writer, skin, cloths, tick, .. } = self;
        writer.publish_with(|snapshot| {
            snapshot.tick = *tick;
            // No copy: the next step writes all of the one that comes back.
            std::mem::swap(&mut snapshot.skin, skin);
            for (to, cloth) in snapshot.garments.iter_mut().zip(cloths.iter()) {
                to.iter_mut().zip(&cloth.positions).for_each(|(t, p)| *t = (*p).into());
            }
        });
    }

    /// Strain and penetration of the state that was reached, outside of the timed part.
    fn measure(&mut self) {
        let mut worst = Strain::default();
        for (cloth, garment) in self.cloths.iter_mut().zip(&self.garments) {
            let strain = measure::strain(cloth, garment);
            worst.mean = worst.mean.max(strain.mean);
            worst.p99 = worst.p99.max(strain.p99);
            worst.max = worst.max.max(strain.max);
            let depth = measure::penetration(cloth, garment, &self.colliders);
            self.meters.penetration_max = self.meters.penetration_max.max(depth);
        }
        self.meters.strain_sum += f64::from(worst.mean);
        self.meters.strain_p99_sum += f64::from(worst.p99);
        self.meters.strain_max = self.meters.strain_max.max(worst.max);
        self.meters.steps += 1;
    }

    /// The meters of the session so far.
    pub fn meters(&self) -> &Meters {
        &self.meters
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

    /// The body.
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

    /// The colliders as last placed.
    pub fn colliders(&self) -> &Colliders {
        &self.colliders
    }

    /// FNV-1a over the bits of pose and particles: equal states give equal hashes.
    pub fn state_hash(&self) -> u64 {
        let mut hash = 0xcbf2_9ce4_8422_2325u64;
        let mut add = |value: f32| {
            for byte in value.to_bits().to_le_bytes() {
                hash = (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3);
            }
        };
        self.pose.root.to_array().into_iter().for_each(&mut add);
        self.pose.local.iter().flat_map(|q| q.to_array()).for_each(&mut add);
        for cloth in &self.cloths {
            cloth.positions.iter().flat_map(|p| p.to_array()).for_each(&mut add);
            (0..cloth.positions.len()).flat_map(|i| cloth.velocity(i).to_array()).for_each(&mut add);
        }
        hash
    }
}

/// A pose between two others.
fn blend(from: &Pose, to: &Pose, t: f32) -> Pose {
    Pose { root: from.root.lerp(to.root, t), local: std::array::from_fn(|i| from.local[i].slerp(to.local[i], t)) }
}
