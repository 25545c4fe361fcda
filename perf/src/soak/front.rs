//! Front: makes scenes when they are asked for, and hands them over; drops those that come back. Tries garments that are broken.

use toile_assets::wardrobe;
use toile_engine::clock::Clock;
use toile_engine::frame_loop::ThreadLoop;
use toile_engine::frame_loop::handover::{HandoverSender, SceneChange};
use toile_engine::frame_loop::physics_thread::FrameScene;
use toile_engine::frame_loop::render_thread::SceneView;

use super::company::Company;
use super::lives::{Ground, Sign, Telling};
use super::script::Kind;

/// A garment that was asked for is handed over no sooner than this (ns): what making it takes, on the simulated clock.
const MAKING_NS: u64 = 500_000_000;

/// Time between two looks (ns).
const LOOK_NS: u64 = 20_000_000;

/// A scene that is made, and when it may be handed over (ns).
type Made = (u64, Box<SceneChange<FrameScene>>, Box<SceneChange<SceneView<()>>>);

/// The life.
#[derive(Debug)]
pub struct Front<C> {
    ground: Ground<C>,
    company: Company,
    scenes: HandoverSender<FrameScene>,
    readers: HandoverSender<SceneView<()>>,
    /// The next dressing of the script.
    next: usize,
    made: Option<Made>,
    reader: Option<Box<SceneChange<SceneView<()>>>>,
    /// When broken garments are tried (ns), and how often that was done.
    broken: Box<[u64]>,
    tried: usize,
    /// Scenes that were handed over.
    pub changes: u64,
    /// Broken garments that were refused, and that were not.
    pub refused: u64,
    /// See above.
    pub accepted: u64,
    /// Why a scene could not be made; the one before stays on.
    pub trouble: Option<String>,
    refusal: Option<[u64; 2]>,
}

impl<C: Clock> Front<C> {
    /// At load; the first scene is on stage already.
    pub fn new(
        ground: Ground<C>,
        company: Company,
        scenes: HandoverSender<FrameScene>,
        readers: HandoverSender<SceneView<()>>,
    ) -> Self {
        let broken = ground.script.faults_of(Kind::BrokenGarment).map(|f| ground.origin_ns + f.from_ns).collect();
        Self {
            ground,
            company,
            scenes,
            readers,
            next: 1,
            made: None,
            reader: None,
            broken,
            tried: 0,
            changes: 0,
            refused: 0,
            accepted: 0,
            trouble: None,
            refusal: None,
        }
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
                let scene = Box::new(SceneChange { scene: FrameScene::new(frame), number, afresh });
                let reader = Box::new(SceneChange { scene: SceneView { reader, outfit: () }, number, afresh });
                self.made = Some((at + MAKING_NS, scene, reader));
            }
            Err(error) => self.trouble = Some(error.to_string()),
        }
    }

    /// Hands over what is ready, and drops what came back.
    fn hand_over(&mut self, now: u64) {
        drop(self.scenes.returned());
        drop(self.readers.returned());
        if self.reader.is_none()
            && let Some((_, scene, reader)) = self.made.take_if(|(at, ..)| *at <= now)
        {
            match self.scenes.give(scene) {
                Ok(()) => {
                    self.changes += 1;
                    self.reader = Some(reader);
                }
                Err(scene) => self.made = Some((now, scene, reader)),
            }
        }
        self.reader = self.reader.take().and_then(|reader| self.readers.give(reader).err());
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
