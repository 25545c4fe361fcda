//! Fit by zone, why, and two sizes beside each other.

use toile_assets::sizes::Girth;

use super::super::fitting::{Basis, Part, ZoneFit};
use super::super::screen::Block;
use super::super::words::{Key, Value};
use super::Teller;

/// Centimetres of metres.
fn cm(m: f32) -> f32 {
    m * 100.0
}

/// An error as it is said (cm): a whole one at least, for nobody's tape is better.
fn said(sigma_m: f32) -> Value<'static> {
    Value::Number(cm(sigma_m).max(1.0), 0)
}

fn whole(m: f32) -> Value<'static> {
    Value::Number(cm(m), 0)
}

impl Teller<'_> {
    pub(super) fn zones_heading(&self) -> String {
        let size = self.model.visit.fit.as_ref().map_or("", |fit| self.size(fit.size));
        self.tell(Key::ZonesHeading, &[("size", Value::Text(size))])
    }

    pub(super) fn zones(&self) -> Vec<Block> {
        let visit = &self.model.visit;
        let mut blocks: Vec<Block> =
            visit.fit.iter().flat_map(|fit| &fit.zones).map(|zone| self.fit_block(zone)).collect();
        if let Some(item) = self.item() {
            blocks.push(Block::Text(self.tell(Key::ZonesHeld, &[("level", Value::Text(item.held.name()))])));
        }
        if visit.fit_map {
            blocks.push(Block::Legend { ends: [self.say(Key::LegendLoose), self.say(Key::LegendTight)] });
        }
        blocks
    }

    /// The fit at a zone as one line.
    pub(super) fn fit_block(&self, zone: &ZoneFit) -> Block {
        let (name, feel) = (self.zone_name(zone.zone), self.say(zone.feel.word()));
        // What is rounded to nothing is no lack.
        let (key, ease) = match cm(zone.ease.value).round() {
            e if e < 0.0 => (Key::FitLack, -zone.ease.value),
            _ => (Key::FitEase, zone.ease.value),
        };
        let values = [
            ("zone", Value::Text(&name)),
            ("feel", Value::Text(&feel)),
            ("ease", whole(ease)),
            ("sigma", said(zone.ease.sigma)),
        ];
        let fit = self.tell(key, &values);
        let text = match zone.perhaps {
            Some(other) => {
                let feel = self.say(other.word());
                self.tell(Key::FitPerhaps, &[("fit", Value::Text(&fit)), ("feel", Value::Text(&feel))])
            }
            None => fit,
        };
        Block::Fit { text, tightness: zone.tightness }
    }

    pub(super) fn zone_label(&self, place: usize) -> (String, Option<String>) {
        let zone = self.model.visit.fit.as_ref().and_then(|fit| fit.zones.get(place));
        let Some(zone) = zone else { return Default::default() };
        (self.zone_name(zone.zone), Some(self.say(zone.feel.word())))
    }

    /// The zone that is asked about.
    fn asked(&self) -> Option<&ZoneFit> {
        let visit = &self.model.visit;
        visit.fit.as_ref().and_then(|fit| fit.zones.get(visit.zone))
    }

    pub(super) fn zone_heading(&self) -> String {
        let name = self.asked().map(|zone| self.zone_name(zone.zone)).unwrap_or_default();
        self.tell(Key::ZoneHeading, &[("zone", Value::Text(&name))])
    }

    /// Body, garment, comfortable range, how sure, and what would make it surer.
    pub(super) fn zone(&self) -> Vec<Block> {
        let (Some(zone), Some(known)) = (self.asked(), &self.model.visit.known) else { return Vec::new() };
        let part = self.part(zone.zone);
        let [least, most] = zone.comfort_m;
        let (range, least) =
            if cm(least).round() < 0.0 { (Key::ZoneStretch, -least) } else { (Key::ZoneComfort, least) };
        let basis = known.basis(zone.zone);
        let mut blocks = vec![
            self.fit_block(zone),
            Block::Text(self.tell(
                Key::ZoneBody,
                &[("zone", Value::Text(&part)), ("body", whole(zone.body.value)), ("sigma", said(zone.body.sigma))],
            )),
            Block::Text(self.tell(Key::ZoneGarment, &[("garment", whole(zone.garment_m))])),
            Block::Text(self.tell(range, &[("least", whole(least)), ("most", whole(most))])),
        ];
        if zone.primary {
            blocks.push(self.text(Key::ZonePrimary));
        }
        let (why, cure) = match basis {
            Basis::Seen => (Key::ZoneSeen, Key::ZoneSurerAgain),
            Basis::Bones => (Key::ZoneBones, Key::ZoneSurerTape),
            Basis::Guessed => (Key::ZoneGuessed, Key::ZoneSurerTape),
        };
        blocks.extend([self.text(why), self.text(cure)]);
        blocks
    }

    pub(super) fn compare_heading(&self) -> String {
        let worn = self.model.worn().map_or("", |w| self.size(w.size));
        let other = self.model.visit.pair.as_ref().map_or("", |pair| self.size(pair.other.size));
        self.tell(Key::CompareHeading, &[("left", Value::Text(worn)), ("right", Value::Text(other))])
    }

    /// Both sizes zone by zone.
    pub(super) fn compare(&self) -> Vec<Block> {
        let visit = &self.model.visit;
        let (Some(fit), Some(pair)) = (&visit.fit, &visit.pair) else { return Vec::new() };
        let mut blocks = Vec::new();
        if pair.asked.is_some() {
            blocks.push(Block::Progress { share: 0.5, label: self.say(Key::CompareDraping) });
        } else if pair.refused {
            blocks.push(self.text(Key::CompareRefused));
        }
        let [left, right] = [fit.size, pair.other.size].map(|size| self.size(size));
        for (a, b) in fit.zones.iter().zip(&pair.other.zones) {
            let zone = self.zone_name(a.zone);
            let [a, b] = [a, b].map(|z| self.say(z.feel.word()));
            blocks.push(Block::Text(if a == b {
                self.tell(Key::CompareSame, &[("zone", Value::Text(&zone)), ("feel", Value::Text(&a))])
            } else {
                let values = [
                    ("zone", Value::Text(&zone)),
                    ("left", Value::Text(left)),
                    ("left-feel", Value::Text(&a)),
                    ("right", Value::Text(right)),
                    ("right-feel", Value::Text(&b)),
                ];
                self.tell(Key::CompareZone, &values)
            }));
        }
        blocks
    }

    /// A zone as it stands alone.
    fn zone_name(&self, zone: Girth) -> String {
        self.say(match zone {
            Girth::Chest => Key::ZoneChest,
            Girth::Waist => Key::ZoneWaist,
            Girth::Hip => Key::ZoneHip,
        })
    }

    /// A zone within a sentence.
    pub(super) fn part(&self, zone: Girth) -> String {
        self.say(Part::from(zone).word())
    }
}
