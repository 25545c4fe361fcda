//! The garment on the shopper's own picture, against the truth: the same person who really wears it, drawn by other code.

mod error;
mod follower;
mod kept_picture;
mod motion;
mod outline;
mod truth;

use std::collections::BTreeMap;
use std::path::Path;

use serde::Serialize;
use toile_assets::put_line;
use toile_base::numeric::statistics::quantile_of;
use toile_view::image::Image;

use follower::{Follower, Seer};
use outline::Outline;
use truth::{Actor, TruthMoment};

pub use error::OwnPictureError;
pub use motion::OwnMotion;

/// Steps between two pictures: 30 Hz.
const EVERY: u64 = 4;

/// Pictures in which the shopper stands and is measured.
const STANDING: u64 = 36;

/// Pictures in which they begin to move, which do not count; and those that do.
const BEGINNING: u64 = 24;
const MEASURED: u64 = 45;

/// Index of the picture that is kept: a walking shopper is in the middle then.
const KEPT: u64 = 6;

/// Errors that are asked for (px of 1080 rows).
pub const TARGETS: [(OwnMotion, f32); 2] = [(OwnMotion::Rest, 8.0), (OwnMotion::Walk, 16.0)];

/// How the garment is brought together with the picture.
pub const WAYS: [&str; 3] =
    ["brought to the picture's moment", "the newest step as it is", "the step of the picture's stamp"];

/// One motion, seen by one sensor.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct OwnPictureRow {
    /// What they do.
    pub motion: &'static str,
    /// What sees them.
    pub seer: &'static str,
    /// Error of the outline (px of 1080 rows), median and 95th percentile, by each way.
    pub outline_px: [[f32; 2]; 3],
    /// What is asked for (px), where something is.
    pub target_px: Option<f32>,
    /// Share of the pictures on which the garment is drawn, and why it is not on the others.
    pub shown: f64,
    /// Pictures that are plain, by reason.
    pub plain: BTreeMap<String, u64>,
    /// Cloth that is drawn where the truth has an arm or nothing, and cloth that is missing, as shares of the true cloth.
    pub area: [f32; 2],
    /// Brightness of the cloth against that of the true one.
    pub brightness: f32,
}

/// What was found.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct OwnPictureTable {
    /// The rows.
    pub rows: Vec<OwnPictureRow>,
    /// Time of a picture of the mirror (ms), median and 99th percentile.
    pub draw_ms: [f64; 2],
    /// Rows of the mirror (pixels).
    pub size: [u32; 2],
}

/// A picture that was kept: what it shows, and camera, mirror and truth beside each other.
pub struct KeptPicture {
    /// Motion and seer.
    pub name: String,
    /// The picture.
    pub image: Image,
}

/// What is measured of one seer in one motion.
#[derive(Default)]
struct Record {
    errors: [Vec<f32>; 3],
    pictures: u64,
    shown: u64,
    plain: BTreeMap<String, u64>,
    area: [f64; 3],
    light: [f64; 2],
    draw_ms: Vec<f64>,
}

/// Runs all motions in a garment. With the network's folder a webcam sees them too; `progress` is given what begins.
///
/// # Errors
/// A garment that does not exist, a shopper who cannot be measured, a network that cannot be used.
pub fn run(
    garment: &str,
    network: Option<&Path>,
    progress: &mut dyn FnMut(&str),
    keep: &mut dyn FnMut(KeptPicture),
) -> Result<OwnPictureTable, OwnPictureError> {
    let (mut rows, mut draw_ms) = (Vec::new(), Vec::new());
    for motion in OwnMotion::ALL {
        progress(motion.name());
        for (seer, record) in one(garment, motion, network, keep)? {
            draw_ms.extend_from_slice(&record.draw_ms);
            rows.push(record.row(motion, seer));
        }
    }
    let of = |share: f64| quantile_of(draw_ms.iter().copied(), share).unwrap_or(f64::NAN);
    Ok(OwnPictureTable { rows, draw_ms: [of(0.5), of(0.99)], size: outline::SIZE })
}

/// One motion, by all seers.
fn one(
    garment: &str,
    motion: OwnMotion,
    network: Option<&Path>,
    keep: &mut dyn FnMut(KeptPicture),
) -> Result<Vec<(Seer, Record)>, OwnPictureError> {
    // Each sensor measures the shopper in the first second; then the scene begins anew, with the shopper dressed.
    let mut standing = Vec::new();
    let mut bare = Actor::new(motion, &[])?;
    for number in 0..STANDING {
        standing.push(bare.moment_at(number * EVERY, number));
    }
    let seers = Seer::all(network, &standing)?;
    let garments = seers[0].garments(garment)?;
    let mut actor = Actor::new(motion, &garments)?;
    let mut followers = Vec::new();
    for seer in seers {
        followers.push((Follower::new(seer, &garments, &standing)?, Record::default()));
    }
    let mut moment = None;
    for tick in 0..(STANDING + BEGINNING + MEASURED) * EVERY {
        actor.step(tick);
        if tick % EVERY == 0 {
            let taken = actor.moment(tick, tick / EVERY);
            followers.iter_mut().for_each(|(follower, _)| follower.look(&taken));
            moment = Some(taken);
        }
        let Some(moment) = &moment else { continue };
        for (follower, record) in &mut followers {
            if follower.step(tick) {
                let number = moment.number;
                let counts = number >= STANDING + BEGINNING;
                judge(follower, record, &mut actor, moment, counts);
                if number == STANDING + BEGINNING + KEPT {
                    let name = format!("{}-{}", motion.word(), follower.seer.word());
                    keep(KeptPicture { name, image: kept_picture::beside(follower, &mut actor, moment) });
                }
            }
        }
    }
    Ok(followers.into_iter().map(|(follower, record)| (follower.seer, record)).collect())
}

/// Draws a picture in every way, and compares it with the truth.
fn judge(follower: &mut Follower, record: &mut Record, actor: &mut Actor, moment: &TruthMoment, counts: bool) {
    let drawn = follower.draw(moment);
    if !counts {
        return;
    }
    record.pictures += 1;
    record.draw_ms.push(drawn.ms);
    if let Some(plain) = drawn.plain {
        *record.plain.entry(format!("{plain:?}")).or_default() += 1;
        return;
    }
    record.shown += 1;
    let truth = actor.outline(moment);
    for ((way, errors), mask) in (0..).zip(&mut record.errors).zip(&drawn.masks) {
        let own = Outline::of(mask);
        own.errors(truth, errors);
        if way == 0 {
            let [more, less, all] = own.area(truth);
            record.area.iter_mut().zip([more, less, all]).for_each(|(sum, n)| *sum += n);
        }
    }
    let light = actor.brightness(moment, &drawn.rgb);
    record.light.iter_mut().zip(light).for_each(|(sum, n)| *sum += n);
}

impl Record {
    fn row(&self, motion: OwnMotion, seer: Seer) -> OwnPictureRow {
        let of =
            |errors: &Vec<f32>| [0.5, 0.95].map(|share| quantile_of(errors.iter().copied(), share).unwrap_or(f32::NAN));
        let [more, less, all] = self.area;
        OwnPictureRow {
            motion: motion.name(),
            seer: seer.name(),
            outline_px: self.errors.each_ref().map(of),
            target_px: TARGETS.iter().find(|(of, _)| *of == motion).map(|(_, px)| *px),
            shown: self.shown as f64 / self.pictures.max(1) as f64,
            plain: self.plain.clone(),
            area: [(more / all) as f32, (less / all) as f32],
            brightness: (self.light[0] / self.light[1].max(1e-9)) as f32,
        }
    }
}

impl OwnPictureTable {
    /// Whether every target is met.
    pub fn is_met(&self) -> bool {
        self.rows.iter().all(|row| row.target_px.is_none_or(|target| row.outline_px[0][0] <= target))
    }

    /// The table for a person to read.
    pub fn markdown(&self) -> String {
        let mut text = String::new();
        put_line!(text, "Outline of the garment against the truth, px at {} rows, median / 95 %.\n", self.size[1]);
        put_line!(
            text,
            "| motion | seen by | {} | target | pictures with it | cloth too much / too little | brightness |",
            WAYS.join(" | ")
        );
        put_line!(text, "|---|---|---|---|---|---|---|---|---|");
        for row in &self.rows {
            let ways = row.outline_px.map(|[p50, p95]| format!("{p50:.1} / {p95:.1}"));
            let target = row.target_px.map_or_else(|| "-".to_owned(), |px| format!("{px:.0}"));
            let [more, less] = row.area.map(|share| 100.0 * share);
            put_line!(
                text,
                "| {} | {} | {} | {target} | {:.0} % | {more:.1} / {less:.1} % | {:.2} |",
                row.motion,
                row.seer,
                ways.join(" | "),
                100.0 * row.shown,
                row.brightness
            );
        }
        for row in self.rows.iter().filter(|row| !row.plain.is_empty()) {
            let reasons: Vec<String> = row.plain.iter().map(|(why, count)| format!("{why} {count}")).collect();
            put_line!(text, "\n{}, {}: plain pictures by reason: {}.", row.motion, row.seer, reasons.join(", "));
        }
        put_line!(
            text,
            "\nA picture of {} x {}: {:.1} ms (median), {:.1} ms (99 %).",
            self.size[0],
            self.size[1],
            self.draw_ms[0],
            self.draw_ms[1]
        );
        text
    }
}
