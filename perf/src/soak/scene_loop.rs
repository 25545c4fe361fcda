//! Makes scenes when they are asked for, and hands them over; drops those that come back. Tries garments that are broken.

use toile_assets::{drafting, draping};
use toile_engine::clock::Clock;
use toile_engine::frame_loop::ThreadLoop;
use toile_engine::frame_loop::physics_thread::WorldScene;
use toile_fitting::live::live_scene::SceneHandover;
use toile_fitting::live::scene_changer::{DressedScene, SceneChanger};

use super::fault_kind::FaultKind;
use super::observed_loops::{Observation, ObservedLoop, RunContext};
use super::scene_maker::SceneMaker;

/// A garment that was asked for is handed over no sooner than this (ns): what making it takes, on the simulated clock.
const MAKING_NS: u64 = 500_000_000;

/// Time between two looks (ns).
const LOOK_NS: u64 = 20_000_000;

/// The thread that makes scenes.
pub struct SceneLoop<C> {
    context: RunContext<C>,
    scene_maker: SceneMaker,
    changer: SceneChanger<WorldScene, ()>,
    /// The next request of the scenario.
    next: usize,
    /// A scene that is made, when it may be handed over (ns), and whether another shopper comes with it.
    made: Option<(u64, DressedScene<WorldScene, ()>, bool)>,
    /// The text of a package that is whole.
    dress: String,
    /// When broken garments are tried (ns), and how often that was done.
    broken: Box<[u64]>,
    tried: usize,
    /// Broken garments that were refused.
    pub refused: u64,
    /// Broken garments that were accepted.
    pub accepted: u64,
    /// Why a scene could not be made; the one before stays on.
    pub trouble: Option<String>,
    refusal: Option<[u64; 2]>,
}

impl<C: Clock> SceneLoop<C> {
    /// At load; the first scene is shown already.
    pub fn new(context: RunContext<C>, scene_maker: SceneMaker, handover: SceneHandover<WorldScene, ()>) -> Self {
        let broken =
            context.scenario.faults_of(FaultKind::BrokenGarment).map(|f| context.origin_ns + f.from_ns).collect();
        let dress = drafting::package("strap-dress").map_or_else(|_| String::new(), |package| package.text());
        Self {
            context,
            scene_maker,
            dress,
            changer: SceneChanger::new(handover, false, None),
            next: 1,
            made: None,
            broken,
            tried: 0,
            refused: 0,
            accepted: 0,
            trouble: None,
            refusal: None,
        }
    }

    /// Scenes that were handed over.
    pub fn changes(&self) -> u64 {
        self.changer.changes()
    }

    /// Makes the scene that is due, if one is.
    fn make(&mut self, now: u64) {
        let Some(request) = self.context.scenario.requests.get(self.next) else { return };
        let (at, number, afresh) = (self.context.origin_ns + request.at_ns, self.next as u64, request.afresh);
        if now < at || self.made.is_some() {
            return;
        }
        self.next += 1;
        match self.scene_maker.make(number) {
            Ok((frame, reader)) => {
                let scene = WorldScene::new(frame);
                let scene = DressedScene { scene, reader, outfit: (), still: None, note: None, number: Some(number) };
                self.made = Some((at + MAKING_NS, scene, afresh));
            }
            Err(error) => self.trouble = Some(error.to_string()),
        }
    }

    /// Has what is ready shown.
    fn hand_over(&mut self, now: u64) {
        if !self.changer.is_waiting()
            && let Some((_, scene, afresh)) = self.made.take_if(|(at, ..)| *at <= now)
        {
            self.changer.show(scene, afresh);
        }
        self.changer.update();
    }

    fn try_broken(&mut self, now: u64) {
        if self.broken.get(self.tried).is_none_or(|at| now < *at) {
            return;
        }
        self.tried += 1;
        for text in broken(&self.dress) {
            match is_read(text) {
                true => self.accepted += 1,
                false => self.refused += 1,
            }
        }
        self.refusal = Some([now, self.context.clock.now_ns()]);
    }
}

/// Packages that are refused: cut off, with a number beyond measure, without a needed key, with an unknown key, of a fabric that there is
/// not, and noise.
fn broken(dress: &str) -> [String; 6] {
    let with = |key: &str, value: &str| dress.replacen(&format!("\"{key}\": "), &format!("\"{key}\": {value}"), 1);
    [
        dress[..dress.len() / 3].to_owned(),
        with("spacing_mm", "1e30"),
        dress.replacen("\"pattern\"", "\"pattern_of_another\"", 1),
        dress.replacen('{', "{\"unheard_of\": 1,", 1),
        with("seams", "7"),
        dress.chars().rev().collect(),
    ]
}

/// Whether a package is read, and its pattern too.
fn is_read(text: String) -> bool {
    draping::parse_package("broken.json", text, None).is_ok_and(|package| package.parse().is_ok())
}

impl<C: Clock> ThreadLoop for SceneLoop<C> {
    fn run_due(&mut self) -> Option<u64> {
        let now = self.context.clock.now_ns();
        self.try_broken(now);
        self.make(now);
        self.hand_over(now);
        Some(self.context.clock.now_ns() + LOOK_NS)
    }
}

impl<C: Clock> ObservedLoop for SceneLoop<C> {
    fn observation(&mut self) -> Option<Observation> {
        let refusal = self.refusal.take().map(Observation::Refused);
        Some(refusal.unwrap_or_else(|| Observation::SceneMaker(self.context.clock.now_ns())))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_broken_garment_is_refused() {
        let dress = drafting::package("strap-dress").unwrap().text();
        assert!(is_read(dress.clone()));
        for (i, text) in broken(&dress).into_iter().enumerate() {
            assert!(text != dress && !is_read(text), "file {i}");
        }
    }
}
