//! Judges whether a scene fits into its period, and finds changes that would make it fit.

use serde::Serialize;
use toile_engine::cloth::{Cloth, Quality, Settings, Step};
use toile_engine::frame_loop::quality_control::{QUALITY_LEVELS, QualityLevel};
use toile_engine::meter::{PERIOD_NS, STEP_BUDGET_US};

use super::cost::{Costs, GarmentTime};
use super::scene::PlannedScene;
use super::work::{FirstStep, Work, beside, near};

/// Whether a scene fits.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct PlanVerdict {
    /// What a step is predicted to take (us).
    pub step_us: f64,
    /// What it may take, so that a step of twice the usual length is still in time (us).
    pub budget_us: f64,
    /// Time between two steps (us).
    pub period_us: f64,
    /// Whether it is within the budget.
    pub within_budget: bool,
    /// Whether it fits at all.
    pub fits: bool,
    /// What quality control would have to give up for the budget to hold; none where nothing, or where nothing helps.
    pub gives_up: Option<&'static str>,
    /// What would bring it within the budget, the least loss first; empty where nothing is needed.
    pub cures: Vec<String>,
}

/// A scene's garments, counted and timed.
#[derive(Debug, Clone, PartialEq)]
pub struct Priced {
    /// What their first step showed `[garments]`.
    pub first: Vec<FirstStep>,
    /// Work of a step of each garment `[garments]`.
    pub work: Vec<Work>,
    /// Time of a step of each garment `[garments]`.
    pub times: Vec<GarmentTime>,
    /// The stages of a step (us), as [`Costs::step`] has them.
    pub stages_us: [f64; toile_engine::meter::STAGES.len()],
}

impl Priced {
    /// Counts a scene's work by one step where it stands at its start, and prices it.
    pub fn of(scene: &PlannedScene, costs: &Costs, workers: usize) -> Self {
        Self::with(scene, &scene.settings, costs, workers)
    }

    fn with(scene: &PlannedScene, settings: &[Settings], costs: &Costs, workers: usize) -> Self {
        let bones = scene.skeleton.as_ref().map_or([glam::Affine3A::IDENTITY; _], super::scene::rest_bones);
        let one = |(k, (garment, settings)): (usize, (_, &Settings))| {
            let mut cloth = Cloth::new(garment, &scene.colliders);
            cloth.step(garment, &Step { palette: &bones, colliders: &scene.colliders, settings });
            let first = FirstStep::of(&cloth, near(garment, &scene.colliders));
            // What lies by the skin is taken from the pairs of the cones.
            let left = 1.0 - first.on_skin / garment.particles().max(1) as f64;
            let first = FirstStep { beside: beside(k, &scene.garments), near: first.near * left, ..first };
            (first, Work::of(garment, settings, &first))
        };
        let (first, work): (Vec<_>, Vec<_>) = scene.garments.iter().zip(settings).enumerate().map(one).unzip();
        let times: Vec<GarmentTime> = work.iter().map(|w| costs.garment(w)).collect();
        let stages_us = costs.step(&times, scene.particles(), workers);
        Self { first, work, times, stages_us }
    }

    /// Time of a step (us).
    pub fn step_us(&self) -> f64 {
        self.stages_us.iter().sum()
    }
}

/// Judges a scene.
pub fn judge(scene: &PlannedScene, priced: &Priced, costs: &Costs, workers: usize) -> PlanVerdict {
    let budget_us = STEP_BUDGET_US as f64 * scene.period_us / (PERIOD_NS as f64 * 1e-3);
    let step_us = priced.step_us();
    let changed = |change: &dyn Fn(&mut Settings)| {
        let mut settings = scene.settings.clone();
        settings.iter_mut().for_each(change);
        Priced::with(scene, &settings, costs, workers).step_us()
    };
    let within_budget = step_us <= budget_us;
    let helps = |level: &&QualityLevel| changed(&|s| *s = level.of(s)) <= budget_us;
    let gives_up = if within_budget { None } else { QUALITY_LEVELS[1..].iter().find(helps).map(|r| r.gives_up) };
    let cures = if within_budget { Vec::new() } else { cures(scene, priced, costs, (workers, budget_us), &changed) };
    PlanVerdict {
        step_us,
        budget_us,
        period_us: scene.period_us,
        within_budget,
        fits: step_us <= scene.period_us,
        gives_up,
        cures,
    }
}

/// What a step takes where a change is made to the settings (us).
type Changed<'a> = dyn Fn(&dyn Fn(&mut Settings)) -> f64 + 'a;

/// What would bring a scene within the budget, each priced like the scene itself.
fn cures(
    scene: &PlannedScene,
    priced: &Priced,
    costs: &Costs,
    (workers, budget_us): (usize, f64),
    changed: &Changed<'_>,
) -> Vec<String> {
    let mut cures = Vec::new();
    let us = |us: f64| format!("{:.1} ms", us * 1e-3);
    let mut add = |what: String, takes: f64| {
        if takes <= budget_us {
            cures.push(format!("{what} ({})", us(takes)));
        }
    };
    if workers < 2 {
        let two = costs.step(&priced.times, scene.particles(), 2).iter().sum();
        add("give the program a second core".to_owned(), two);
    }
    let quality = scene.settings[0].quality;
    for lower in Quality::ALL.into_iter().rev().filter(|q| (*q as usize) < quality as usize) {
        add(format!("quality {lower} in place of {quality}"), changed(&|s| s.quality = lower));
    }
    coarser(scene, priced, budget_us, &mut add);
    for (k, garment) in scene.garments.iter().enumerate().filter(|_| scene.garments.len() > 1) {
        let left: Vec<GarmentTime> =
            priced.times.iter().enumerate().filter(|(i, _)| *i != k).map(|(_, t)| t.clone()).collect();
        let particles = scene.particles() - garment.particles();
        add(format!("leave out {}", garment.name), costs.step(&left, particles, workers).iter().sum());
    }
    cures
}

/// The spacing at which the garment that takes most would leave the step within the budget: its time goes with its
/// particles.
fn coarser(scene: &PlannedScene, priced: &Priced, budget_us: f64, add: &mut impl FnMut(String, f64)) {
    let times = priced.times.iter().map(|t| t.one_us).enumerate();
    let Some((most, _)) = times.max_by(|a, b| a.1.total_cmp(&b.1)) else { return };
    let garment = &scene.garments[most];
    let cloth_us = priced.stages_us[toile_engine::meter::CLOTH];
    let left = budget_us - (priced.step_us() - cloth_us);
    let share = left / cloth_us;
    if share <= 0.0 {
        return;
    }
    let spacing = super::scene::spacing_mm(garment);
    let what = format!(
        "{} in a spacing of {:.0} mm in place of {spacing:.0} mm, which is {:.0} particles in place of {}",
        garment.name,
        spacing / share.sqrt(),
        garment.particles() as f64 * share,
        garment.particles()
    );
    if scene.garments.len() == 1 {
        add(what, budget_us);
    } else {
        add(format!("{what}, and the others alike"), budget_us);
    }
}
