//! The pages of coming, being measured and leaving, the picture and the settings.

use super::super::actions::PositionHint;
use super::super::body_turn::{BodyTurn, TurnState};
use super::super::screen::Block;
use super::super::texts::{TextKey, TextValue};
use super::super::visit::MeasureProgress;
use super::PageWriter;

const SECOND_NS: u64 = 1_000_000_000;

/// How long the mirror shows one of the things that it can do (ns).
const TURN_NS: u64 = 5 * SECOND_NS;

/// How long the figure that shows how to stand takes to go round (ns).
const POSE_NS: u64 = 4 * SECOND_NS;

/// How long the arrow that shows how to turn takes to go round (ns): as slowly as is best.
const TURNED_NS: u64 = 6 * SECOND_NS;

/// Where that arrow rests where nothing moves by itself (share of its way).
const RESTING: f32 = 0.25;

/// Share of the way to a dressed body that taking the measures is.
const MEASURED: f32 = 0.5;

/// What dressing takes, about: half of what is left of the way is gone after it (ns).
const DRESSING_NS: f32 = 1.5e9;

/// Whole seconds that are left, the last one included.
fn seconds(ns: u64) -> u32 {
    u32::try_from(ns.div_ceil(SECOND_NS)).unwrap_or(u32::MAX)
}

impl PageWriter<'_> {
    pub(super) fn attract(&self) -> Vec<Block> {
        const CAN: [TextKey; 3] = [TextKey::AttractMeasure, TextKey::AttractFit, TextKey::AttractCompare];
        let turn = (self.model.now_ns / TURN_NS) as usize % CAN.len();
        vec![self.paragraph(CAN[turn]), self.paragraph(TextKey::AttractPrivate)]
    }

    pub(super) fn guide(&self) -> Vec<Block> {
        let visit = &self.model.visit;
        let phase = (self.model.now_ns % POSE_NS) as f32 / POSE_NS as f32;
        let how = if visit.seated { TextKey::GuidePoseSeated } else { TextKey::GuidePose };
        let hint = match self.model.hint() {
            Some(PositionHint::Unseen) => TextKey::GuideUnseen,
            Some(PositionHint::Alone) => TextKey::GuideAlone,
            Some(PositionHint::Nearer) => TextKey::GuideNearer,
            Some(PositionHint::Farther) => TextKey::GuideFarther,
            Some(PositionHint::Left) => TextKey::GuideLeft,
            Some(PositionHint::Right) => TextKey::GuideRight,
            None => TextKey::GuideSoon,
        };
        let mut blocks =
            vec![Block::PoseGuide { phase, seated: visit.seated }, self.paragraph(how), self.paragraph(hint)];
        if let MeasureProgress::Guide { not_before_ns, .. } = visit.progress
            && not_before_ns > self.model.now_ns
        {
            blocks.push(Block::Countdown { seconds: seconds(not_before_ns - self.model.now_ns) });
        }
        blocks
    }

    pub(super) fn measuring(&self) -> Vec<Block> {
        let since = |ns: u64| self.model.now_ns.saturating_sub(ns);
        // The dressing worker does not report how far it is: the rest of the way is halved again and again.
        let onwards = |from: f32, ns: u64| from + (1.0 - from) * (1.0 - (-(ns as f32) / DRESSING_NS).exp()) * 0.9;
        let whole = self.model.defaults.times.measure_ns.max(1);
        let (share, label) = match self.model.visit.progress {
            MeasureProgress::Measuring(began) if since(began) < whole => {
                (MEASURED * since(began) as f32 / whole as f32, TextKey::MeasuringBody)
            }
            MeasureProgress::Measuring(began) => {
                (onwards(MEASURED, since(began) - whole).min(0.75), TextKey::MeasuringBody)
            }
            MeasureProgress::Dressing(began) => (onwards(0.75, since(began)), TextKey::MeasuringDress),
            MeasureProgress::Turning => (0.75, TextKey::MeasuringBody),
            MeasureProgress::No | MeasureProgress::Guide { .. } | MeasureProgress::Failed => {
                (1.0, TextKey::MeasuringDress)
            }
        };
        let mut blocks = vec![Block::Progress { share, label: self.words(label) }];
        blocks.extend(self.model.visit.turn.iter().flat_map(|turn| self.turn(turn)));
        blocks
    }

    /// The offer of a turn, and how far it has got; nothing once it has ended.
    fn turn(&self, turn: &BodyTurn) -> Vec<Block> {
        let round = (self.model.now_ns % TURNED_NS) as f32 / TURNED_NS as f32;
        let (arrow, key) = match turn.state() {
            TurnState::Offered if self.model.defaults.motion => (Some(round), TextKey::TurnOffer),
            TurnState::Offered => (Some(RESTING), TextKey::TurnOffer),
            TurnState::Turning => (None, TextKey::TurnOn),
            TurnState::Enough => (None, TextKey::TurnEnough),
            TurnState::Ended => return Vec::new(),
        };
        let guide = Block::TurnGuide { seen: *turn.seen(), turned: turn.turned().unwrap_or_default(), arrow };
        vec![guide, self.paragraph(key)]
    }

    pub(super) fn unmeasured(&self) -> Vec<Block> {
        let Some(known) = self.model.visit.known.as_ref().filter(|_| self.is_partly()) else {
            return vec![self.paragraph(TextKey::UnmeasuredWhy), self.paragraph(TextKey::UnmeasuredSeated)];
        };
        let parts = self.parts(&known.missing);
        vec![
            Block::Text(self.format(TextKey::PartlyMissing, &[("parts", TextValue::Text(&parts))])),
            self.paragraph(TextKey::PartlyGuess),
            self.paragraph(TextKey::PartlyCure),
        ]
    }

    pub(super) fn picture(&self) -> Vec<Block> {
        let picture = &self.model.visit.picture;
        if let Some(code) = picture.code() {
            let minutes = (picture.left_ns(self.model.now_ns) / (60 * SECOND_NS)) as u32;
            let how = match picture.link().map(|link| link.network.as_deref()) {
                None => self.paragraph(TextKey::PictureScan),
                Some(None) => self.paragraph(TextKey::PictureServed),
                Some(Some(network)) => {
                    Block::Text(self.format(TextKey::PictureServedIn, &[("network", TextValue::Text(network))]))
                }
            };
            return vec![
                Block::Code { side: code.side, dark: code.dark.clone() },
                how,
                Block::Text(self.format(TextKey::PictureUntil, &[("minutes", TextValue::Count(minutes))])),
            ];
        }
        if self.model.visit.snap_failed {
            return vec![self.paragraph(TextKey::PictureFailed)];
        }
        vec![Block::Progress { share: 0.5, label: self.words(TextKey::PictureTaking) }]
    }

    pub(super) fn settings(&self) -> Vec<Block> {
        let measures = self.model.visit.known.as_ref().map_or(0, |known| known.count);
        vec![
            self.paragraph(TextKey::SettingsStored),
            Block::Text(self.format(TextKey::SettingsKnown, &[("count", TextValue::Count(measures))])),
        ]
    }

    pub(super) fn second(&self) -> Vec<Block> {
        let model = self.model;
        let asked = model.visit.asked_ns.unwrap_or(model.now_ns);
        let left = model.defaults.times.answer_ns.saturating_sub(model.now_ns - asked);
        self.countdown(TextKey::SecondSeconds, left, Some(TextKey::SecondWhy))
    }

    pub(super) fn leaving(&self) -> Vec<Block> {
        let model = self.model;
        let left = model.defaults.times.session.wipe_ns.saturating_sub(model.session.lasted_ns(model.now_ns));
        self.countdown(TextKey::LeavingSeconds, left, None)
    }

    fn countdown(&self, key: TextKey, left_ns: u64, before: Option<TextKey>) -> Vec<Block> {
        let seconds = seconds(left_ns);
        let mut blocks: Vec<Block> = before.map(|key| self.paragraph(key)).into_iter().collect();
        blocks.push(Block::Text(self.format(key, &[("seconds", TextValue::Count(seconds))])));
        blocks.push(Block::Countdown { seconds });
        blocks
    }
}
