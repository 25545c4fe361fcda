//! The pages of coming, being measured and leaving, the picture and the settings.

use super::super::actions::Hint;
use super::super::screen::Block;
use super::super::visit::Taking;
use super::super::words::{Key, Value};
use super::Teller;

const SECOND_NS: u64 = 1_000_000_000;

/// How long the mirror tells one of the things that it can do (ns).
const TURN_NS: u64 = 5 * SECOND_NS;

/// How long the figure that shows how to stand takes to go round (ns).
const POSE_NS: u64 = 4 * SECOND_NS;

/// Share of the way to a dressed body that taking the measures is.
const MEASURED: f32 = 0.5;

/// What the tailor takes, about: half of what is left of the way is gone after it (ns).
const TAILOR_NS: f32 = 1.5e9;

/// Whole seconds that are left, the last one included.
fn seconds(ns: u64) -> u32 {
    u32::try_from(ns.div_ceil(SECOND_NS)).unwrap_or(u32::MAX)
}

impl Teller<'_> {
    pub(super) fn attract(&self) -> Vec<Block> {
        const CAN: [Key; 3] = [Key::AttractMeasure, Key::AttractFit, Key::AttractCompare];
        let turn = (self.model.now_ns / TURN_NS) as usize % CAN.len();
        vec![self.text(CAN[turn]), self.text(Key::AttractPrivate)]
    }

    pub(super) fn guide(&self) -> Vec<Block> {
        let visit = &self.model.visit;
        let phase = (self.model.now_ns % POSE_NS) as f32 / POSE_NS as f32;
        let how = if visit.seated { Key::GuidePoseSeated } else { Key::GuidePose };
        let hint = match self.model.hint() {
            Some(Hint::Unseen) => Key::GuideUnseen,
            Some(Hint::Alone) => Key::GuideAlone,
            Some(Hint::Nearer) => Key::GuideNearer,
            Some(Hint::Farther) => Key::GuideFarther,
            Some(Hint::Left) => Key::GuideLeft,
            Some(Hint::Right) => Key::GuideRight,
            None => Key::GuideSoon,
        };
        let mut blocks = vec![Block::PoseGuide { phase, seated: visit.seated }, self.text(how), self.text(hint)];
        if let Taking::Guide { not_before_ns, .. } = visit.taking
            && not_before_ns > self.model.now_ns
        {
            blocks.push(Block::Countdown { seconds: seconds(not_before_ns - self.model.now_ns) });
        }
        blocks
    }

    pub(super) fn measuring(&self) -> Vec<Block> {
        let since = |ns: u64| self.model.now_ns.saturating_sub(ns);
        // The tailor does not say how far it is: the rest of the way is halved again and again.
        let onwards = |from: f32, ns: u64| from + (1.0 - from) * (1.0 - (-(ns as f32) / TAILOR_NS).exp()) * 0.9;
        let whole = self.model.house.rules.measure_ns.max(1);
        let (share, label) = match self.model.visit.taking {
            Taking::Measuring(began) if since(began) < whole => {
                (MEASURED * since(began) as f32 / whole as f32, Key::MeasuringBody)
            }
            Taking::Measuring(began) => (onwards(MEASURED, since(began) - whole).min(0.75), Key::MeasuringBody),
            Taking::Dressing(began) => (onwards(0.75, since(began)), Key::MeasuringDress),
            Taking::No | Taking::Guide { .. } | Taking::Failed => (1.0, Key::MeasuringDress),
        };
        vec![Block::Progress { share, label: self.say(label) }]
    }

    pub(super) fn unmeasured(&self) -> Vec<Block> {
        let Some(known) = self.model.visit.known.as_ref().filter(|_| self.is_partly()) else {
            return vec![self.text(Key::UnmeasuredWhy), self.text(Key::UnmeasuredSeated)];
        };
        let parts = self.parts(&known.missing);
        vec![
            Block::Text(self.tell(Key::PartlyMissing, &[("parts", Value::Text(&parts))])),
            self.text(Key::PartlyGuess),
            self.text(Key::PartlyCure),
        ]
    }

    pub(super) fn picture(&self) -> Vec<Block> {
        let vault = &self.model.visit.vault;
        if let Some(code) = vault.code() {
            let minutes = (vault.left_ns(self.model.now_ns) / (60 * SECOND_NS)) as u32;
            return vec![
                Block::Code { side: code.side, dark: code.dark.clone() },
                self.text(Key::PictureScan),
                Block::Text(self.tell(Key::PictureUntil, &[("minutes", Value::Count(minutes))])),
            ];
        }
        if self.model.visit.snap_failed {
            return vec![self.text(Key::PictureFailed)];
        }
        vec![Block::Progress { share: 0.5, label: self.say(Key::PictureTaking) }]
    }

    pub(super) fn settings(&self) -> Vec<Block> {
        let measures = self.model.visit.known.as_ref().map_or(0, |known| known.count);
        vec![
            self.text(Key::SettingsStored),
            Block::Text(self.tell(Key::SettingsKnown, &[("count", Value::Count(measures))])),
        ]
    }

    pub(super) fn second(&self) -> Vec<Block> {
        let model = self.model;
        let asked = model.visit.asked_ns.unwrap_or(model.now_ns);
        let left = model.house.rules.answer_ns.saturating_sub(model.now_ns - asked);
        self.countdown(Key::SecondSeconds, left, Some(Key::SecondWhy))
    }

    pub(super) fn leaving(&self) -> Vec<Block> {
        let model = self.model;
        let left = model.house.rules.session.wipe_ns.saturating_sub(model.session.lasted_ns(model.now_ns));
        self.countdown(Key::LeavingSeconds, left, None)
    }

    fn countdown(&self, key: Key, left_ns: u64, before: Option<Key>) -> Vec<Block> {
        let seconds = seconds(left_ns);
        let mut blocks: Vec<Block> = before.map(|key| self.text(key)).into_iter().collect();
        blocks.push(Block::Text(self.tell(key, &[("seconds", Value::Count(seconds))])));
        blocks.push(Block::Countdown { seconds });
        blocks
    }
}
