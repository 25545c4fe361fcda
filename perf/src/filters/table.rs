//! The tables: filters on the same motions, and feet.

use std::path::Path;
use toile_assets::put_line;

use serde::Serialize;
use toile_assets::scene;
use toile_sensors::source::{OpenOptions, Session, open};

use super::{FilterRow, FiltersError, FootSlide, NAMES, feet, measure, rows};

/// Recordings of a waving hand, in a folder of recordings.
const WAVES: [&str; 2] =
    ["skeleton/labanotation-kinect2/Ges01_wavehand.csv", "skeleton/kinectron-kinect2/recorded_skeleton.json"];

/// Recordings of feet: a walk, jumps, jumping jacks with bends and squats, and a person who waves and stands.
const FEET: [&str; 4] = [
    "mocap/animated-drawings/zombie.bvh",
    "mocap/animated-drawings/jumping.bvh",
    "mocap/cmu/14_14.bvh",
    "mocap/animated-drawings/wave_hello.bvh",
];

/// REFERENCES, section 7: hold jitter (mm), lag (ms), overshoot (mm) on the same reach.
const REFERENCE: [(&str, [f64; 3]); 5] = [
    ("none", [4.99, 0.0, 12.0]),
    ("Holt .5/.5/.5", [3.93, -10.0, 25.0]),
    ("Holt .7/.3/0", [2.75, 25.0, 62.0]),
    ("One Euro 1, 10", [1.95, 14.0, 5.0]),
    ("One Euro .5, 10", [1.69, 14.0, 5.0]),
];

/// The figures of all filters, and of feet.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct FilterTable {
    /// Figures of each filter.
    pub rows: Vec<FilterRow>,
    /// Feet; none without a folder of recordings.
    pub feet: Vec<FootSlide>,
}

/// Measures all filters, or only the default, and the feet of the recordings, if there is a folder of them; `progress` is given
/// what is being run.
///
/// # Errors
/// Where the scene's shopper cannot be built, or a recording cannot be read.
pub fn run(data: Option<&Path>, all: bool, progress: &mut dyn FnMut(&str)) -> Result<FilterTable, FiltersError> {
    let body = toile_assets::body::build(scene::SHOPPER.0, &scene::SHOPPER.1)?.skeleton;
    let sessions = |files: &[&str]| -> Result<Vec<Session>, FiltersError> {
        let Some(data) = data else { return Ok(Vec::new()) };
        files.iter().map(|file| Ok(open(&data.join(file), &OpenOptions::default())?)).collect()
    };
    let waves = sessions(&WAVES)?;
    let mut found = Vec::new();
    for name in NAMES.into_iter().filter(|name| all || *name == rows::DEFAULT) {
        progress(name);
        found.push(measure::row(name, &body, &waves));
    }
    let mut slides = Vec::new();
    for session in sessions(&FEET)? {
        progress(&session.name);
        slides.push(feet::slide(&session, &body));
    }
    Ok(FilterTable { rows: found, feet: slides })
}

impl FilterTable {
    /// The tables as Markdown.
    pub fn markdown(&self) -> String {
        let mut text = String::new();
        self.filters(&mut text);
        if !self.feet.is_empty() {
            self.slides(&mut text);
        }
        text
    }

    fn filters(&self, text: &mut String) {
        let recordings: Vec<&str> =
            self.rows.first().map_or(Vec::new(), |r| r.recorded.iter().map(|r| &*r.name).collect());
        let columns: String = recordings.iter().map(|name| format!(" {name}: jitter, lag |")).collect();
        put_line!(
            text,
            "| filter | still: jitter | reach: lag, overshoot | reference: jitter, lag, overshoot | wave: lag, p99 error | \
                 forearm's length |{columns} us |"
        );
        put_line!(text, "|---|---|---|---|---|---|{}---|", "---|".repeat(recordings.len()));
        for row in &self.rows {
            let reference = REFERENCE.iter().find(|(name, _)| *name == row.name);
            let reference =
                reference.map_or("-".to_owned(), |(_, [j, l, o])| format!("{j:.2} mm, {l:.0} ms, {o:.0} mm"));
            let recorded: String =
                row.recorded.iter().map(|r| format!(" {:.2} mm, {:.0} ms |", r.jitter_mm, r.lag_ms)).collect();
            put_line!(
                text,
                "| {} | {:.2} mm | {:.0} ms, {:.0} mm | {reference} | {:.0} ms, {:.0} mm | {:.1} mm |{recorded} {:.1} |",
                row.name,
                row.still_jitter_mm,
                row.step_lag_ms,
                row.step_overshoot_mm,
                row.wave_lag_ms,
                row.wave_error_mm,
                row.bone_mm,
                row.us,
            );
        }
    }

    fn slides(&self, text: &mut String) {
        put_line!(
            text,
            "\n| recording | planted | slide a planted second: truth | filtered joints | posed | posed, feet kept | in the air \
             | glued | rise: true, ours |"
        );
        put_line!(text, "|---|---|---|---|---|---|---|---|---|");
        for s in &self.feet {
            put_line!(
                text,
                "| {} | {:.1} s | {:.0} mm | {:.0} mm | {:.0} mm | **{:.0} mm** | {:.2} s | {:.0} % | {:.0}, {:.0} mm |",
                s.name,
                s.planted_s,
                s.truth_mm_s,
                s.filtered_mm_s,
                s.posed_mm_s,
                s.kept_mm_s,
                s.air_s,
                s.glued_share * 100.0,
                s.true_rise_mm,
                s.rise_mm,
            );
        }
    }
}
