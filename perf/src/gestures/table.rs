//! The tables of the study.

use super::{Act, GestureConditions, GestureCount, GripRow, count, grips};
use toile_assets::put_line;

/// Distances of the tables (m).
const DISTANCES: [f32; 4] = [1.2, 2.0, 2.8, 3.5];

/// Rates and drops of the second table (frames a second, part of the frames lost).
const RATES: [[f32; 2]; 4] = [[30.0, 0.03], [20.0, 0.03], [15.0, 0.03], [15.0, 0.2]];

/// Sizes next to a grown-up.
const SCALES: [f32; 3] = [0.7, 1.0, 1.2];

/// The study of gestures: all tables.
#[derive(Debug, Clone, PartialEq)]
pub struct GestureStudy {
    /// Sequences a cell.
    pub sequences: u32,
    /// Seed that all sequences are drawn from.
    pub seed: u64,
    /// Gestures under the conditions of each column of each table.
    pub gestures: Vec<(Act, GestureConditions, GestureCount)>,
    /// What is no gesture, over all distances.
    pub others: Vec<(Act, GestureCount)>,
    /// Hands open and closed.
    pub grips: Vec<GripRow>,
}

/// Conditions of all columns, in the order of the tables.
fn columns() -> Vec<GestureConditions> {
    let usual = GestureConditions::default();
    let distances = DISTANCES.map(|distance| GestureConditions { distance, ..usual });
    let rates = RATES.map(|[rate, dropped]| GestureConditions { rate, dropped, ..usual });
    let scales = SCALES.map(|scale| GestureConditions { scale, ..usual });
    [&distances[..], &rates, &scales].concat()
}

impl GestureStudy {
    /// Runs everything; `say` is given what is being done.
    pub fn run(sequences: u32, seed: u64, progress: &mut dyn FnMut(&str)) -> Self {
        let mut gestures = Vec::new();
        for act in Act::GESTURES {
            progress(act.name());
            let row = columns().into_iter().map(|c| (act, c, count(act, &c, sequences, seed)));
            gestures.extend(row);
        }
        let mut others = Vec::new();
        for act in Act::OTHERS {
            progress(act.name());
            let at =
                |distance| count(act, &GestureConditions { distance, ..GestureConditions::default() }, sequences, seed);
            others.push((act, DISTANCES.map(at).into_iter().fold(GestureCount::default(), GestureCount::and)));
        }
        progress("hands");
        let grips = grips(&DISTANCES, sequences.div_ceil(4), seed);
        Self { sequences, seed, gestures, others, grips }
    }

    /// The tables in Markdown.
    pub fn markdown(&self) -> String {
        let mut text = String::new();
        self.gesture_table(&mut text);
        self.other_table(&mut text);
        self.grip_table(&mut text);
        text
    }

    fn gesture_table(&self, text: &mut String) {
        let percent = |c: &GestureCount| format!("{:.1}", 100.0 * c.miss_rate());
        let distances = DISTANCES.map(|d| format!("{d} m"));
        let rates = RATES.map(|[rate, dropped]| format!("{rate} Hz, {:.0} % lost", 100.0 * dropped));
        let scales = SCALES.map(|s| format!("size {s}"));
        let heads = [&distances[..], &rates, &scales].concat();
        row(text, "missed, %", heads.iter().map(String::as_str).chain(["wrong events"]));
        row(text, "---", vec!["---"; heads.len() + 1].into_iter());
        for act in Act::GESTURES {
            let own: Vec<_> = self.gestures.iter().filter(|(a, ..)| *a == act).collect();
            let mut cells: Vec<String> = own.iter().map(|(_, _, c)| percent(c)).collect();
            let all = own.iter().fold(GestureCount::default(), |sum, (_, _, c)| sum.and(*c));
            cells.push(format!("{} in {}", all.wrong, all.sequences));
            row(text, act.name(), cells.iter().map(String::as_str));
        }
    }

    fn other_table(&self, text: &mut String) {
        text.push('\n');
        row(text, "no gesture", ["sequences", "minutes", "false events", "a minute"].into_iter());
        row(text, "---", ["---"; 4].into_iter());
        let all = self.others.iter().fold(GestureCount::default(), |sum, (_, c)| sum.and(*c));
        for (name, c) in self.others.iter().map(|(act, c)| (act.name(), c)).chain([("**all**", &all)]) {
            let cells = [
                c.sequences.to_string(),
                format!("{:.1}", c.seconds / 60.0),
                c.wrong.to_string(),
                format!("{:.2}", c.wrong_per_minute()),
            ];
            row(text, name, cells.iter().map(String::as_str));
        }
    }

    fn grip_table(&self, text: &mut String) {
        text.push('\n');
        let heads = ["distance", "frames", "wrong, %", "not seen, %", "by the gap alone, %", "by solidity alone, %"];
        let more = ["changes", "missed", "false", "solidity", "spread", "gap"];
        row(text, "hand", heads.into_iter().chain(more));
        row(text, "---", vec!["---"; heads.len() + more.len()].into_iter());
        for r in &self.grips {
            let percent = |part: u32| format!("{:.1}", 100.0 * part as f32 / r.frames.max(1) as f32);
            let mut cells = vec![format!("{} m", r.distance), r.frames.to_string()];
            cells.extend([r.wrong, r.unseen, r.wrong_by_gap, r.wrong_by_solidity].map(percent));
            cells.extend([r.changes, r.missed, r.false_events].map(|n| n.to_string()));
            cells.extend(r.features.map(|[mean, sd]| format!("{mean:.2} +- {sd:.2}")));
            row(text, r.pose.name(), cells.iter().map(String::as_str));
        }
    }
}

fn row<'a>(text: &mut String, first: &str, cells: impl Iterator<Item = &'a str>) {
    let cells: Vec<&str> = cells.collect();
    put_line!(text, "| {first} | {} |", cells.join(" | "));
}
