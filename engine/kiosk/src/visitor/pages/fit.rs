//! Fit by zone, why, and two sizes beside each other.

use toile_assets::sizes::Girth;

use super::super::screen::Block;
use super::super::size_fit::{BodyPart, MeasureBasis, ZoneFit, feel_word};
use super::super::texts::{TextKey, TextValue};
use super::PageWriter;

/// Centimetres of metres.
fn cm(m: f32) -> f32 {
    m * 100.0
}

/// An error as shown (cm): at least 1 cm, because no tape is better.
fn rounded_sigma(sigma_m: f32) -> TextValue<'static> {
    TextValue::Number(cm(sigma_m).max(1.0), 0)
}

fn whole(m: f32) -> TextValue<'static> {
    TextValue::Number(cm(m), 0)
}

impl PageWriter<'_> {
    pub(super) fn zones_heading(&self) -> String {
        let size = self.model.visit.fit.as_ref().map_or("", |fit| self.size(fit.size));
        self.format(TextKey::ZonesHeading, &[("size", TextValue::Text(size))])
    }

    pub(super) fn zones(&self) -> Vec<Block> {
        let visit = &self.model.visit;
        let mut blocks: Vec<Block> =
            visit.fit.iter().flat_map(|fit| &fit.zones).map(|zone| self.fit_block(zone)).collect();
        if let Some(item) = self.item() {
            blocks.push(Block::Text(self.format(TextKey::ZonesHeld, &[("level", TextValue::Text(item.held.name()))])));
        }
        if visit.fit_map {
            blocks.push(Block::Legend { ends: [self.words(TextKey::LegendLoose), self.words(TextKey::LegendTight)] });
        }
        blocks
    }

    /// The fit at a zone as one line.
    pub(super) fn fit_block(&self, zone: &ZoneFit) -> Block {
        let name = self.zone_name(zone.zone);
        let Some(feel) = zone.feel else {
            let text = self.format(TextKey::FitUnknown, &[("zone", TextValue::Text(&name))]);
            return Block::Fit { text, tightness: None };
        };
        let feel = self.words(feel_word(feel));
        // What is rounded to nothing is no lack.
        let (key, ease) = match cm(zone.ease.value).round() {
            e if e < 0.0 => (TextKey::FitLack, -zone.ease.value),
            _ => (TextKey::FitEase, zone.ease.value),
        };
        let values = [
            ("zone", TextValue::Text(&name)),
            ("feel", TextValue::Text(&feel)),
            ("ease", whole(ease)),
            ("sigma", rounded_sigma(zone.ease.sigma)),
        ];
        let fit = self.format(key, &values);
        let text = match zone.perhaps {
            Some(other) => {
                let feel = self.words(feel_word(other));
                self.format(TextKey::FitPerhaps, &[("fit", TextValue::Text(&fit)), ("feel", TextValue::Text(&feel))])
            }
            None => fit,
        };
        Block::Fit { text, tightness: zone.tightness }
    }

    pub(super) fn zone_label(&self, place: usize) -> (String, Option<String>) {
        let zone = self.model.visit.fit.as_ref().and_then(|fit| fit.zones.get(place));
        let Some(zone) = zone else { return Default::default() };
        (self.zone_name(zone.zone), Some(self.words(zone.feel.map_or(TextKey::FeelUnknown, feel_word))))
    }

    /// The zone that is asked about.
    fn asked(&self) -> Option<&ZoneFit> {
        let visit = &self.model.visit;
        visit.fit.as_ref().and_then(|fit| fit.zones.get(visit.zone))
    }

    pub(super) fn zone_heading(&self) -> String {
        let name = self.asked().map(|zone| self.zone_name(zone.zone)).unwrap_or_default();
        self.format(TextKey::ZoneHeading, &[("zone", TextValue::Text(&name))])
    }

    /// Body, garment, comfortable range, how sure, and what would make it surer.
    pub(super) fn zone(&self) -> Vec<Block> {
        let (Some(zone), Some(known)) = (self.asked(), &self.model.visit.known) else { return Vec::new() };
        let part = self.part(zone.zone);
        let [least, most] = zone.comfort_m;
        let (range, least) =
            if cm(least).round() < 0.0 { (TextKey::ZoneStretch, -least) } else { (TextKey::ZoneComfort, least) };
        let basis = known.basis(zone.zone);
        let mut blocks = vec![
            self.fit_block(zone),
            Block::Text(self.format(
                TextKey::ZoneBody,
                &[
                    ("zone", TextValue::Text(&part)),
                    ("body", whole(zone.body.value)),
                    ("sigma", rounded_sigma(zone.body.sigma)),
                ],
            )),
            Block::Text(self.format(TextKey::ZoneGarment, &[("garment", whole(zone.garment_m))])),
            Block::Text(self.format(range, &[("least", whole(least)), ("most", whole(most))])),
        ];
        if zone.primary {
            blocks.push(self.paragraph(TextKey::ZonePrimary));
        }
        let (why, cure) = match basis {
            MeasureBasis::Taped => (TextKey::ZoneTaped, None),
            MeasureBasis::Seen => (TextKey::ZoneSeen, Some(TextKey::ZoneSurerAgain)),
            MeasureBasis::Bones => (TextKey::ZoneBones, Some(TextKey::ZoneSurerTape)),
            MeasureBasis::Guessed => (TextKey::ZoneGuessed, Some(TextKey::ZoneSurerTape)),
        };
        blocks.extend([Some(why), cure].into_iter().flatten().map(|key| self.paragraph(key)));
        blocks
    }

    pub(super) fn compare_heading(&self) -> String {
        let worn = self.model.worn().map_or("", |w| self.size(w.size));
        let other = self.model.visit.pair.as_ref().map_or("", |pair| self.size(pair.other.size));
        self.format(TextKey::CompareHeading, &[("left", TextValue::Text(worn)), ("right", TextValue::Text(other))])
    }

    /// Both sizes zone by zone.
    pub(super) fn compare(&self) -> Vec<Block> {
        let visit = &self.model.visit;
        let (Some(fit), Some(pair)) = (&visit.fit, &visit.pair) else { return Vec::new() };
        let mut blocks = Vec::new();
        if pair.asked.is_some() {
            blocks.push(Block::Progress { share: 0.5, label: self.words(TextKey::CompareDraping) });
        } else if pair.refused {
            blocks.push(self.paragraph(TextKey::CompareRefused));
        }
        let [left, right] = [fit.size, pair.other.size].map(|size| self.size(size));
        for (a, b) in fit.zones.iter().zip(&pair.other.zones) {
            let zone = self.zone_name(a.zone);
            let (Some(a), Some(b)) = (a.feel, b.feel) else {
                let values = [("zone", TextValue::Text(&zone))];
                blocks.push(Block::Text(self.format(TextKey::CompareUnknown, &values)));
                continue;
            };
            let [a, b] = [a, b].map(|feel| self.words(feel_word(feel)));
            blocks.push(Block::Text(if a == b {
                self.format(TextKey::CompareSame, &[("zone", TextValue::Text(&zone)), ("feel", TextValue::Text(&a))])
            } else {
                let values = [
                    ("zone", TextValue::Text(&zone)),
                    ("left", TextValue::Text(left)),
                    ("left-feel", TextValue::Text(&a)),
                    ("right", TextValue::Text(right)),
                    ("right-feel", TextValue::Text(&b)),
                ];
                self.format(TextKey::CompareZone, &values)
            }));
        }
        blocks
    }

    /// A zone as it stands alone.
    fn zone_name(&self, zone: Girth) -> String {
        self.words(match zone {
            Girth::Chest => TextKey::ZoneChest,
            Girth::Waist => TextKey::ZoneWaist,
            Girth::Hip => TextKey::ZoneHip,
        })
    }

    /// A zone within a sentence.
    pub(super) fn part(&self, zone: Girth) -> String {
        self.words(BodyPart::from(zone).word())
    }
}
