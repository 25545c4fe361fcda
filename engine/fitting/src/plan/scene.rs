//! A scene as the plan sees it: baked garments, colliders, and the places of the bones at every step.

use glam::Affine3A;
use toile_assets::scene_file::SceneFile;
use toile_base::body::Body;
use toile_base::clock::ticks_to_ns;
use toile_base::frame::Joints;
use toile_base::garment::{Garment, Part};
use toile_base::limits::STEP_SECONDS;
use toile_base::rig::Rig;
use toile_base::skeleton::{BONES, Pose, Skeleton};
use toile_engine::body::{Poser, palette};
use toile_engine::body_surface::BodySurface;
use toile_engine::cloth::contact::garments::{GarmentContact, lay_outside};
use toile_engine::cloth::{Cloth, Settings, Step};
use toile_engine::colliders::{Colliders, RestSphere};
use toile_engine::skin::{Blend, Posed, SkinningJob};
use toile_engine::workers::WorkerPool;
use toile_engine::world::{DRESS_STEPS, SETTLE_STEPS};
use toile_sensors::sample::sample;

use super::PlanError;
use crate::scene;

/// Most steps of a session or a scene file that are played: ten seconds.
pub const MOST_STEPS: usize = 1_200;

/// What moves bones and colliders.
#[derive(Debug, Clone)]
pub enum PlannedMotion {
    /// A shopper: the bones at the end of each step, the steps of dressing first.
    Shopper(Box<[[Affine3A; BONES]]>),
    /// A scene file.
    File(Box<SceneFile>),
}

/// A scene to plan: garments, colliders, and how they move.
#[derive(Debug, Clone)]
pub struct PlannedScene {
    /// Name in reports.
    pub name: String,
    /// The garments, inner first.
    pub garments: Vec<Garment>,
    /// How each is stepped.
    pub settings: Vec<Settings>,
    /// What they meet, where it stands at the start.
    pub colliders: Colliders,
    /// How bones and colliders move.
    pub motion: PlannedMotion,
    /// The shopper's skeleton, where there is a shopper.
    pub skeleton: Option<Skeleton>,
    /// What moves the shopper's skin.
    pub skinning: Option<SkinningJob>,
    /// Steps that only dress the shopper.
    pub dressing: usize,
    /// Time between two steps (us).
    pub period_us: f64,
}

impl PlannedScene {
    /// A shopper in some garments, moved as a track of believable joints says.
    ///
    /// # Errors
    /// Colliders that the engine does not take.
    pub fn worn(
        body: &Body,
        rig: &Rig,
        mut garments: Vec<Garment>,
        settings: Settings,
        track: &[Joints],
    ) -> Result<Self, PlanError> {
        let spheres = rig.spheres.each_ref().map(|s| RestSphere::on_bone(&body.skeleton, s.bone, s.offset, s.radius));
        lay_outside(&mut garments);
        let skinning = SkinningJob::new(&body.mesh.positions, &body.normals, &body.weights)?;
        let parts: Vec<Part> = garments.iter().flat_map(|g| g.parts.iter().copied()).collect();
        let surface = BodySurface::new(body, &skinning.posed(), &parts);
        let mut colliders = Colliders::new(&spheres, &rig.capsules, true)?.with_skin(surface);
        let poser = Poser::new(&body.skeleton).keeping_clear(&spheres, &rig.capsules);
        let bones = poses(&body.skeleton, poser, track);
        let rest = rest_bones(&body.skeleton);
        colliders.place(&rest);
        let mut skin = skinning.posed();
        skinning.run(Blend::Linear, &rest, &mut skin);
        colliders.place_skin(&skin);
        Ok(Self {
            name: String::new(),
            settings: vec![settings; garments.len()],
            garments,
            colliders,
            motion: PlannedMotion::Shopper(bones.into()),
            skeleton: Some(body.skeleton.clone()),
            skinning: Some(skinning),
            dressing: (DRESS_STEPS + SETTLE_STEPS) as usize,
            period_us: f64::from(STEP_SECONDS) * 1e6,
        })
    }

    /// A scene file.
    ///
    /// # Errors
    /// A mesh that cannot be baked, colliders that the engine does not take.
    pub fn file(file: SceneFile) -> Result<Self, PlanError> {
        let (garments, colliders) = (scene::bake_all(&file)?, scene::placed(&file)?);
        Ok(Self {
            name: file.name.clone(),
            settings: vec![scene::settings(&file); garments.len()],
            garments,
            colliders,
            period_us: 1e6 / file.step_hz,
            motion: PlannedMotion::File(Box::new(file)),
            skeleton: None,
            skinning: None,
            dressing: 0,
        })
    }

    /// Steps that can be played.
    pub fn steps(&self) -> usize {
        match &self.motion {
            PlannedMotion::Shopper(bones) => bones.len(),
            PlannedMotion::File(file) => (file.steps() as usize).min(MOST_STEPS),
        }
    }

    /// Where bones and colliders are at the end of a step, counted from 0.
    pub fn place(&self, step: usize, bones: &mut [Affine3A; BONES], colliders: &mut Colliders) {
        match &self.motion {
            PlannedMotion::Shopper(all) => {
                if let Some(at) = all.get(step) {
                    *bones = *at;
                }
                colliders.place(bones);
            }
            PlannedMotion::File(file) => {
                let end = (step + 1) as f64 / file.step_hz;
                scene::place(colliders, file, end);
                *bones = scene::palette(file, end);
            }
        }
    }

    /// Particles of all garments.
    pub fn particles(&self) -> usize {
        self.garments.iter().map(Garment::particles).sum()
    }

    /// The garments' states before the first step.
    pub fn cloths(&self) -> Vec<Cloth> {
        let ready = |g: &Garment, s: &Settings, c: Cloth| if s.wind.is_some() { c.in_wind(g) } else { c };
        let all = self.garments.iter().zip(&self.settings);
        all.map(|(g, s)| ready(g, s, Cloth::new(g, &self.colliders))).collect()
    }
}

/// A scene under way.
pub struct Playing<'a> {
    /// The scene that is played.
    pub scene: &'a PlannedScene,
    /// State of each garment `[garments]`.
    pub cloths: Vec<Cloth>,
    /// The colliders as last placed.
    pub colliders: Colliders,
    /// The bones at the end of the last step.
    pub bones: [Affine3A; BONES],
    /// Steps taken so far.
    pub step: usize,
    /// What keeps the garments from passing through each other and themselves.
    pub layers: Option<GarmentContact>,
    /// The skin as last placed, where there is one.
    pub skin: Option<Posed>,
}

impl<'a> Playing<'a> {
    /// The scene at its start, before the first step.
    pub fn new(scene: &'a PlannedScene) -> Self {
        let bones = scene.skeleton.as_ref().map_or([Affine3A::IDENTITY; BONES], rest_bones);
        let skin = scene.skinning.as_ref().map(SkinningJob::posed);
        let (colliders, layers) = (scene.colliders.clone(), GarmentContact::new(&scene.garments));
        Self { scene, cloths: scene.cloths(), colliders, bones, step: 0, layers, skin }
    }

    /// The same moment, without any cloth yet.
    pub fn moment(&self) -> Self {
        let Self { scene, bones, step, .. } = *self;
        let (colliders, skin) = (self.colliders.clone(), self.skin.clone());
        Self { scene, cloths: Vec::new(), colliders, bones, step, layers: GarmentContact::new(&scene.garments), skin }
    }

    /// Places what the next step meets.
    pub fn place(&mut self) {
        self.scene.place(self.step, &mut self.bones, &mut self.colliders);
        if let (Some(job), Some(skin)) = (&self.scene.skinning, &mut self.skin) {
            job.run(Blend::Linear, &self.bones, skin);
            self.colliders.place_skin(skin);
        }
        self.step += 1;
    }

    /// The step of all garments with these settings, one of them shared by the workers, several one worker's each.
    pub fn take(&mut self, settings: &[Settings], pool: &mut WorkerPool) {
        let garments = &self.scene.garments;
        self.take_as(garments, settings, pool);
    }

    /// The same with garments that are changed.
    pub fn take_as(&mut self, garments: &[Garment], settings: &[Settings], pool: &mut WorkerPool) {
        let Self { cloths, colliders, bones, layers, .. } = self;
        let step = |i: usize| Step { palette: bones, colliders, settings: &settings[i] };
        // A worker that panics has said so, and the guard of the next step repairs what it left.
        match (&mut cloths[..], garments, layers.as_mut().filter(|l| l.asked(&settings[0]))) {
            (cloths, garments, Some(layers)) => _ = layers.step(pool, cloths, garments, &step(0)),
            ([cloth], [garment], None) => cloth.step_with(pool, garment, &step(0)),
            (cloths, garments, None) => _ = pool.each(cloths, |i, cloth| cloth.step(&garments[i], &step(i))),
        }
    }
}

/// The bones in the rest pose.
pub fn rest_bones(skeleton: &Skeleton) -> [Affine3A; BONES] {
    let mut bones = [Affine3A::IDENTITY; BONES];
    palette(skeleton, &Pose::rest(skeleton), &mut bones);
    bones
}

/// The bones at the end of each step: dressing as the frame does it, then the session.
fn poses(skeleton: &Skeleton, mut poser: Poser, track: &[Joints]) -> Vec<[Affine3A; BONES]> {
    let (Some(first), Some(last)) = (track.first(), track.last()) else { return Vec::new() };
    let rest = Pose::rest(skeleton);
    let goal = poser.pose(first, STEP_SECONDS);
    let mut all = Vec::new();
    let mut add = |pose: &Pose| {
        let mut bones = [Affine3A::IDENTITY; BONES];
        palette(skeleton, pose, &mut bones);
        all.push(bones);
    };
    for step in 1..=DRESS_STEPS + SETTLE_STEPS {
        let t = (step as f32 / DRESS_STEPS as f32).min(1.0);
        let t = t * t * (3.0 - 2.0 * t);
        let local = std::array::from_fn(|i| rest.local[i].slerp(goal.local[i], t));
        add(&Pose { root: rest.root.lerp(goal.root, t), local });
    }
    for tick in 0..MOST_STEPS as u64 {
        let now = first.time_ns + ticks_to_ns(tick);
        if now > last.time_ns {
            break;
        }
        add(&poser.pose(&sample(track, now).unwrap_or(*first), STEP_SECONDS));
    }
    all
}

/// Mean distance of neighbours of a garment (mm).
pub fn spacing_mm(garment: &Garment) -> f64 {
    let sum: f64 = garment.strain_edges.iter().map(|(_, rest)| f64::from(*rest)).sum();
    1e3 * sum / garment.strain_edges.len().max(1) as f64
}
