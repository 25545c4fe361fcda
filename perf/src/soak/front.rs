//! Front: makes scenes when they are asked for, and hands them over; drops those that come back. Tries garments that are broken.

use toile_assets::wardrobe;
use toile_engine::clock::Clock;
use toile_engine::frame_loop::ThreadLoop;
use toile_engine::frame_loop::physics_thread::FrameScene;
use toile_fitting::live::assembly::SceneHandover;
use toile_fitting::live::scene_changer::{DressedScene, SceneChanger};

use super::company::Company;
use super::lives::{Ground, Sign, Telling};
use super::script::Kind;

/// A garment that was asked for is handed over no sooner than this (ns): what making it takes, on the simulated clock.
const MAKING_NS: u64 = 500_000_000;

/// Time between two looks (ns).
const LOOK_NS: u64 = 20_000_000;

/// The life.
pub struct Front<C> {
    ground: Ground<C>,
    company: Company,
    changer: SceneChanger<FrameScene, ()>,
    /// The next dressing of the script.
    next: usize,
    /// A scene that is made, when it may be handed over (ns), and whether another shopper comes with it.
    made: Option<(u64, DressedScene<FrameScene, ()>, bool)>,
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

impl<C: Clock> Front<C> {
    /// At load; the first scene is shown already.
    pub fn new(ground: Ground<C>, company: Company, handover: SceneHandover<FrameScene, ()>) -> Self {
        let broken = ground.script.faults_of(Kind::BrokenGarment).map(|f| ground.origin_ns + f.from_ns).collect();
        Self {
            ground,
            company,
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
        let Some(dressing) = self.ground.script.dressings.get(self.next) else { return };
        let (at, number, afresh) = (self.ground.origin_ns + dressing.at_ns, self.next as u64, dressing.afresh);
        if now < at || self.made.is_some() {
            return;
        }
        self.next += 1;
        match self.company.make(number) {
            Ok((frame, reader)) => {
                let scene = FrameScene::new(frame);
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
        for text in broken() {
            match wardrobe::parse("broken", &text) {
                Ok(_) => self.accepted += 1,
                Err(_) => self.refused += 1,
            }
        }
        self.refusal = Some([now, self.ground.clock.now_ns()]);
    }
}

/// Garment files that nobody can wear: cut off, with a number that is none or beyond measure, without what they need, with what
/// nobody knows, and noise.
fn broken() -> [String; 6] {
    const GARMENT: &str = include_str!("../../../assets/data/garments/sun-dress.toml");
    let line = |key: &str| GARMENT.lines().find(|l| l.starts_with(key)).unwrap_or_default();
    let spacing = line("spacing_mm");
    [
        GARMENT[..GARMENT.len() / 3].to_owned(),
        GARMENT.replace(spacing, "spacing_mm = nan"),
        GARMENT.replace(spacing, "spacing_mm = 1e30"),
        GARMENT.replace(line("columns"), ""),
        format!("{GARMENT}\nunheard_of = 1\n"),
        GARMENT.chars().rev().collect(),
    ]
}

impl<C: Clock> ThreadLoop for Front<C> {
    fn run_due(&mut self) -> Option<u64> {
        let now = self.ground.clock.now_ns();
        self.try_broken(now);
        self.make(now);
        self.hand_over(now);
        Some(self.ground.clock.now_ns() + LOOK_NS)
    }
}

impl<C: Clock> Telling for Front<C> {
    fn sign(&mut self) -> Option<Sign> {
        let refusal = self.refusal.take().map(Sign::Refused);
        Some(refusal.unwrap_or_else(|| Sign::Front(self.ground.clock.now_ns())))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_broken_garment_is_refused() {
        for (i, text) in broken().iter().enumerate() {
            assert!(wardrobe::parse("broken", text).is_err(), "file {i}");
        }
    }
}
