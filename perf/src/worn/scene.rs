//! Garments on a performing mannequin, ready to be stepped.

use glam::{Affine3A, Vec3};
use toile_assets::drafting;
use toile_assets::scene::{self, shopper};
use toile_bake::bake;
use toile_base::body::Body;
use toile_base::garment::{Garment, Part};
use toile_base::limits::STEP_SECONDS;
use toile_base::mesh::SkinWeights;
use toile_base::numeric::hash;
use toile_base::skeleton::{BONES, Pose, Skeleton};
use toile_engine::body::palette;
use toile_engine::body_surface::BodySurface;
use toile_engine::cloth::contact::garments::{GarmentContact, lay_outside};
use toile_engine::cloth::step::measure;
use toile_engine::cloth::step::program::METERED_STAGES;
use toile_engine::cloth::{Cloth, ContactRates, Quality, Settings, Step};
use toile_engine::colliders::Colliders;
use toile_engine::lanes::Width;
use toile_engine::skin::{Blend, Posed, SkinningJob};
use toile_engine::workers::WorkerPool;
use toile_fitting::heap::{Heap, HeapProbe};
use toile_fitting::timing;
use toile_gpu::backend::{Backend, Backends, ClothStepper};
use toile_gpu::cloth_batch::ClothBatch;

use super::error::WornError;
use super::mannequin::AverageBody;

/// Most garments on one mannequin: as many as an outfit of the shop has layers.
pub const MAX_OUTFIT: usize = 4;

/// Time in which the mannequin goes from the pose that garments are cut in to that of the performance (s).
const POSE_S: f64 = 0.75;

/// What is performed, to and fro without end, because both ends stand still: from where the arms are lifted to where the
/// body has turned and come to rest (s).
const PERFORMED_S: [f64; 2] = [scene::STILL_S as f64, 9.4];

/// One run of garments on a mannequin.
#[derive(Debug, Clone, PartialEq)]
pub struct WornOptions {
    /// Garments of the wardrobe, by name, in wearing order; the first decides whose body it is.
    pub garments: Vec<String>,
    /// Threads that step.
    pub threads: usize,
    /// Lane width; the widest if not given.
    pub lanes: Option<Width>,
    /// Tested settings; the engine's own choice if not given.
    pub quality: Option<Quality>,
    /// Substeps of a step; the garments' own choice if not given.
    pub substeps: Option<u32>,
    /// Whether garments keep their order; without it they pass through each other.
    pub layers: bool,
    /// Whether each keeps from passing through itself.
    pub folds: bool,
    /// Whether they lie on the skin; without it, on the cones.
    pub skin: bool,
    /// Runs of which the median is reported.
    pub runs: usize,
    /// Steps of a run.
    pub steps: usize,
    /// Where the garments are stepped, if contact allows it.
    pub backend: Backend,
}

impl WornOptions {
    /// The engine's settings.
    fn settings(&self) -> Result<Settings, WornError> {
        if let Some(width) = self.lanes.filter(|w| !w.available()) {
            return Err(WornError::NoSuchLanes { lanes: width.lanes(), widest: Width::widest().lanes() });
        }
        let default = Settings::default();
        Ok(Settings {
            quality: self.quality.unwrap_or(default.quality),
            substeps: self.substeps,
            workers: self.threads,
            contact: ContactRates::on(self.folds, self.layers, self.skin),
            width: self.lanes.unwrap_or(default.width),
            ..default
        })
    }
}

/// Garments on one mannequin.
#[derive(Debug)]
pub struct WornScene {
    /// The garments, in wearing order.
    pub garments: Vec<Garment>,
    /// Their sizes.
    pub sizes: Vec<String>,
    /// Their states.
    pub cloths: Vec<Cloth>,
    /// Steps taken so far.
    pub tick: u64,
    /// Bytes on the heap of the baked garments and of their states, where the program counts them.
    pub memory_bytes: Option<u64>,
    /// The mannequin, as it is built.
    pub body: Body,
    bones: [Affine3A; BONES],
    settings: Settings,
    colliders: Colliders,
    pool: WorkerPool,
    backends: Backends,
    stepper: ClothStepper,
    layers: Option<GarmentContact>,
    skinning: SkinningJob,
    /// The bone that carries most of each triangle's first corner `[triangles]`.
    skin_bones: Vec<u8>,
    skin: Posed,
}

impl WornScene {
    /// The scene at its start: every garment as it is cut, on a mannequin in the pose that it is cut in.
    ///
    /// # Errors
    /// Where the options cannot be met.
    pub fn new(options: &WornOptions, heap: &HeapProbe) -> Result<Self, WornError> {
        let names = &options.garments[..];
        if names.len() > MAX_OUTFIT {
            return Err(WornError::TooMany { given: names.len(), most: MAX_OUTFIT });
        }
        let settings = options.settings()?;
        let mannequin = AverageBody::of(names.first().map_or("", |n| n))?;
        let colliders = mannequin.colliders()?;
        let body = &mannequin.body;
        let skinning = SkinningJob::new(&body.mesh.positions, &body.normals, &body.weights)?;
        let (mut garments, mut sizes) = (Vec::new(), Vec::new());
        let before = heap.read();
        for name in names {
            let (size, shape, fabric) = mannequin.wear(name)?;
            let mut garment = bake(name, &size, &shape, &fabric)?;
            garment.set_layer(drafting::style(name).map_or(0, |style| style.layer));
            garments.push(garment);
            sizes.push(size);
        }
        if settings.contact.layers > 0 {
            lay_outside(&mut garments);
        }
        let layers = GarmentContact::new(&garments).filter(|layers| layers.asked(&settings));
        let parts: Vec<Part> = garments.iter().flat_map(|g| g.parts.iter().copied()).collect();
        let colliders = match settings.contact.skin > 0 {
            true => colliders.with_skin(BodySurface::new(body, &skinning.posed(), &parts)),
            false => colliders,
        };
        let cloths = garments.iter().map(|garment| Cloth::new(garment, &colliders)).collect();
        let bytes = between(before, heap.read());
        let backends = Backends::for_scene(options.backend, layers.as_ref(), &colliders, &settings);
        let mut scene = Self {
            garments,
            sizes,
            cloths,
            tick: 0,
            memory_bytes: bytes,
            skin_bones: body.mesh.triangles.iter().map(|t| heaviest(&body.weights[t[0] as usize])).collect(),
            body: mannequin.body,
            bones: [Affine3A::IDENTITY; BONES],
            settings,
            colliders,
            pool: WorkerPool::new(options.threads)?,
            stepper: backends.stepper(),
            backends,
            layers,
            skin: skinning.posed(),
            skinning,
        };
        scene.place(&performed(&scene.body.skeleton, 0));
        Ok(scene)
    }

    /// Places the body where it is at the end of the coming step. Not timed.
    pub fn prepare(&mut self) {
        self.prepare_in(&performed(&self.body.skeleton, self.tick + 1));
    }

    /// The same with a body that does something else than perform: its pose at the end of the coming step.
    pub fn prepare_in(&mut self, pose: &Pose) {
        self.tick += 1;
        self.place(pose);
        timing::wake(&mut self.pool);
    }

    fn place(&mut self, pose: &Pose) {
        palette(&self.body.skeleton, pose, &mut self.bones);
        self.colliders.place(&self.bones);
        self.skinning.run(Blend::Linear, &self.bones, &mut self.skin);
        self.colliders.place_skin(&self.skin);
    }

    /// Deepest point of a garment in the body so far into the step (m).
    pub fn penetration(&mut self) -> f64 {
        let Self { cloths, garments, colliders, .. } = self;
        let each = cloths.iter_mut().zip(garments).map(|(c, g)| f64::from(measure::penetration(c, g, colliders)));
        each.fold(0.0, f64::max)
    }

    /// One step of every garment: what is timed.
    ///
    /// # Panics
    /// Where the engine does.
    pub fn step(&mut self) {
        let step = Step { palette: &self.bones, colliders: &self.colliders, settings: &self.settings };
        if let Some(layers) = &mut self.layers {
            let garments = (&mut self.cloths[..], &self.garments[..]);
            let done = self.stepper.step_apart(layers, &mut self.pool, garments, &step);
            return done.expect("a share of the step panicked");
        }
        let steps = [step; MAX_OUTFIT];
        let mut garments = [&self.garments[0]; MAX_OUTFIT];
        let count = self.cloths.len();
        garments.iter_mut().zip(&self.garments).for_each(|(to, garment)| *to = garment);
        let mut batch = ClothBatch { cloths: &mut self.cloths, garments: &garments[..count], steps: &steps[..count] };
        let done = self.stepper.step(&mut batch, Some(&mut self.pool));
        done.expect("a share of the step panicked");
    }

    /// What keeps the garments in their order, where they do.
    pub fn layers(&self) -> Option<&GarmentContact> {
        self.layers.as_ref()
    }

    /// What was asked to step the garments, and what has.
    pub fn backends(&self) -> &Backends {
        &self.backends
    }

    /// The body's joints.
    pub fn skeleton(&self) -> &Skeleton {
        &self.body.skeleton
    }

    /// The skin as last placed: where its vertices are (m), and its triangles.
    pub fn skin(&self) -> (Vec<Vec3>, &[[u32; 3]]) {
        ((0..self.skin.vertices()).map(|v| self.skin.position(v)).collect(), &self.body.mesh.triangles)
    }

    /// The skin as last placed, as a picture takes it.
    pub fn posed(&self) -> &Posed {
        &self.skin
    }

    /// The bone that carries most of a triangle of the skin.
    pub fn bone_of(&self, triangle: u32) -> u8 {
        self.skin_bones[triangle as usize]
    }

    /// How the steps are done.
    pub fn settings(&self) -> &Settings {
        &self.settings
    }

    /// The body as it stood at the start and the end of the last step.
    pub fn colliders(&self) -> &Colliders {
        &self.colliders
    }

    /// Takes some steps more with the meters on: the mean time of each stage of a step, all garments (us).
    pub fn stages_us(&mut self, steps: usize) -> Vec<(&'static str, f64)> {
        self.settings.timed = true;
        let mut sums = [0.0; METERED_STAGES.len()];
        for _ in 0..steps {
            self.prepare();
            self.step();
            if self.stepper.backend() == Backend::Gpu {
                let spent = self.stepper.spent().map(|s| s.stages_ns);
                sums.iter_mut().zip(spent.into_iter().flatten()).for_each(|(sum, ns)| *sum += ns);
                continue;
            }
            let stages = self.cloths.iter().map(|c| c.stage_ns);
            stages.for_each(|ns| sums.iter_mut().zip(ns).for_each(|(sum, ns)| *sum += ns as f64));
        }
        self.settings.timed = false;
        METERED_STAGES.into_iter().zip(sums).map(|(name, ns)| (name, ns * 1e-3 / steps as f64)).collect()
    }

    /// FNV-1a over the bits of all positions, garment by garment in the order of the meshes' vertices.
    pub fn state_hash(&self) -> u64 {
        let of = |(cloth, garment): (&Cloth, &Garment)| {
            let mut at = vec![[0.0; 3]; garment.source.len()];
            garment.source.iter().zip(&cloth.positions).for_each(|(&v, p)| at[v as usize] = p.to_array());
            at.into_iter().flatten()
        };
        hash::of_numbers(self.cloths.iter().zip(&self.garments).flat_map(of))
    }
}

/// The bone that carries most of a vertex.
fn heaviest(weights: &SkinWeights) -> u8 {
    let pairs = weights.bones.iter().zip(weights.weights);
    pairs.max_by(|a, b| a.1.total_cmp(&b.1)).map_or(0, |(bone, _)| *bone)
}

fn between(a: Option<Heap>, b: Option<Heap>) -> Option<u64> {
    u64::try_from(b?.live_bytes - a?.live_bytes).ok()
}

/// Step after which the mannequin is so far into the performance (s).
pub fn step_at(performance_s: f64) -> u64 {
    ((POSE_S + performance_s - PERFORMED_S[0]) / f64::from(STEP_SECONDS)).round() as u64
}

/// The pose at the end of a step: on the way into the performance first.
fn performed(skeleton: &Skeleton, tick: u64) -> Pose {
    let time = tick as f64 * f64::from(STEP_SECONDS);
    let [from, to] = PERFORMED_S;
    // There and back: the distance from the nearest whole round.
    let round = 2.0 * (to - from);
    let within = (time - POSE_S).max(0.0) % round;
    let goal = shopper(skeleton, (from + within.min(round - within)) as f32);
    let part = (time / POSE_S).min(1.0) as f32;
    if part < 1.0 { on_the_way(skeleton, &goal, part) } else { goal }
}

/// The pose a part of the way (0..1) from the rest pose to another.
pub fn on_the_way(skeleton: &Skeleton, goal: &Pose, part: f32) -> Pose {
    let t = part * part * (3.0 - 2.0 * part);
    let rest = Pose::rest(skeleton);
    Pose { root: rest.root.lerp(goal.root, t), local: std::array::from_fn(|i| rest.local[i].slerp(goal.local[i], t)) }
}
