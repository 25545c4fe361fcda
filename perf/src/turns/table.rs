//! All cases, turn by turn, and their results.

use std::fmt::Write;
use std::path::{Path, PathBuf};

use serde::Serialize;
use toile_base::numeric::statistics::median;
use toile_engine::cloth::step::program::METERED_STAGES;

use super::case::TurnCase;
use super::error::TurnsError;
use super::reading::TurnReading;

/// What a case showed.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct TurnRow {
    /// Its name.
    pub case: String,
    /// By this program: the last turn's report, with the median time of all turns.
    pub own: Option<TurnReading>,
    /// By the other one.
    pub other: Option<TurnReading>,
    /// Own time over the other's, over the turns.
    pub ratio: Option<TurnRatio>,
    /// Why one of them has no figures.
    pub refused: Option<String>,
}

/// Own time over the other's.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct TurnRatio {
    /// Median of the turns.
    pub p50: f64,
    /// The least.
    pub min: f64,
    /// The greatest.
    pub max: f64,
}

impl TurnRatio {
    fn of(own: &[TurnReading], other: &[TurnReading]) -> Option<Self> {
        let mut ratios: Vec<f64> = own.iter().zip(other).map(|(a, b)| a.step_us.p50 / b.step_us.p50).collect();
        let (min, max) = (ratios.iter().copied().fold(f64::MAX, f64::min), ratios.iter().copied().fold(0.0, f64::max));
        Some(Self { p50: median(&mut ratios)?, min, max })
    }
}

/// The cases in turn.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct TurnTable {
    /// The program that this one is held against.
    pub against: Option<PathBuf>,
    /// Turns of each.
    pub turns: usize,
    /// Steps of each run.
    pub steps: usize,
    /// A row a case.
    pub rows: Vec<TurnRow>,
}

/// Runs cases by this program and, where one is given, by another build, one after the other in each turn; `progress` is
/// told what comes.
///
/// # Errors
/// Where a program does not start.
pub fn run(
    cases: &[TurnCase],
    against: Option<&Path>,
    [turns, steps]: [usize; 2],
    progress: &mut dyn FnMut(&str),
) -> Result<TurnTable, TurnsError> {
    let own = std::env::current_exe().map_err(TurnsError::Own)?;
    let mut rows = Vec::new();
    for case in cases {
        progress(&case.name);
        let (mut mine, mut theirs, mut refused) = (Vec::new(), Vec::new(), None);
        for _ in 0..turns.max(1) {
            for (program, readings) in [(Some(&*own), &mut mine), (against, &mut theirs)] {
                let Some(program) = program.filter(|_| refused.is_none()) else { continue };
                match TurnReading::take(program, case, steps)? {
                    Ok(reading) => readings.push(reading),
                    Err(words) => refused = Some(format!("{}: {words}", program.display())),
                }
            }
        }
        let ratio = TurnRatio::of(&mine, &theirs);
        rows.push(TurnRow { case: case.name.clone(), own: whole(mine), other: whole(theirs), ratio, refused });
    }
    Ok(TurnTable { against: against.map(Path::to_owned), turns, steps, rows })
}

/// One case as a report of its own: its stages, and how they stand to the other's.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct TurnReport {
    /// What this program showed.
    #[serde(flatten)]
    pub own: TurnReading,
    /// What the other one did, where one was given.
    pub other: Option<TurnReading>,
    /// Own time over the other's.
    pub ratio: Option<TurnRatio>,
    /// Turns of each.
    pub turns: usize,
    /// Steps of each run.
    pub steps: usize,
}

impl TurnTable {
    /// The only case of the table, or why it has no figures.
    ///
    /// # Errors
    /// What the program that refused it said.
    pub fn only(self) -> Result<TurnReport, String> {
        let Self { turns, steps, rows, .. } = self;
        let row = rows.into_iter().next().ok_or("no case was asked for")?;
        match (row.own, row.refused) {
            (Some(own), None) => Ok(TurnReport { own, other: row.other, ratio: row.ratio, turns, steps }),
            (_, refused) => Err(refused.unwrap_or_else(|| "nothing was measured".to_owned())),
        }
    }
}

/// The last reading with the median of all times.
fn whole(readings: Vec<TurnReading>) -> Option<TurnReading> {
    let mut times: Vec<f64> = readings.iter().map(|r| r.step_us.p50).collect();
    let mut last = readings.into_iter().next_back()?;
    last.step_us.p50 = median(&mut times)?;
    Some(last)
}

impl TurnTable {
    /// The table as Markdown: a line a program and case, the other one's first.
    pub fn markdown(&self) -> String {
        let mut text = String::from("| case | us a step | of the other |");
        METERED_STAGES.iter().for_each(|stage| {
            let _ = write!(text, " {stage} |");
        });
        text.push_str(" strain mean / p99 / worst % | MB |\n|---|---|---|");
        text.push_str(&"---|".repeat(METERED_STAGES.len() + 2));
        text.push('\n');
        for row in &self.rows {
            if let Some(other) = &row.other {
                line(&mut text, &format!("{}, the other", row.case), other, None);
            }
            if let Some(own) = &row.own {
                line(&mut text, &row.case, own, row.ratio);
            }
            if let Some(refused) = &row.refused {
                let _ =
                    writeln!(text, "| {} | refused | | {}{refused} |", row.case, "| ".repeat(METERED_STAGES.len() + 1));
            }
        }
        let against = self.against.as_ref().map_or(String::new(), |p| format!(" in turn with {}", p.display()));
        let _ = writeln!(text, "\nMedians of {} turns of {} steps{against}.", self.turns, self.steps);
        text
    }
}

fn line(text: &mut String, case: &str, reading: &TurnReading, ratio: Option<TurnRatio>) {
    let ratio = ratio.map_or(String::new(), |r| format!("{:.3} ({:.3} to {:.3})", r.p50, r.min, r.max));
    let _ = write!(text, "| {case} | {:.1} | {ratio} |", reading.step_us.p50);
    for stage in METERED_STAGES {
        let us = reading.stages_us.get(stage).copied().unwrap_or(0.0);
        let _ = write!(text, " {us:.0} |");
    }
    let [mean, p99, max] = [reading.strain.mean, reading.strain.p99, reading.strain.max].map(|s| s * 100.0);
    let memory = reading.memory_bytes.map_or(String::new(), |b| format!("{:.2}", b as f64 * 1e-6));
    let _ = writeln!(text, " {mean:.3} / {p99:.2} / {max:.1} | {memory} |");
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_row_has_both_programs_and_how_they_stand_to_each_other() {
        let mut own = TurnReading::default();
        own.step_us.p50 = 150.0;
        own.stages_us.insert("bend".into(), 20.0);
        let mut other = own.clone();
        other.step_us.p50 = 300.0;
        let ratio = TurnRatio::of(std::slice::from_ref(&own), std::slice::from_ref(&other));
        let row = TurnRow { case: "grid".into(), own: Some(own), other: Some(other), ratio, refused: None };
        let worn = TurnRow { case: "dress".into(), own: None, other: None, ratio: None, refused: Some("no".into()) };
        let table = TurnTable { against: Some("old".into()), turns: 7, steps: 600, rows: vec![row, worn] };
        let text = table.markdown();
        assert!(
            text.contains("| grid | 150.0 | 0.500 (0.500 to 0.500) |")
                && text.contains("| grid, the other | 300.0 |  |"),
            "{text}"
        );
        assert!(text.contains("Medians of 7 turns of 600 steps in turn with old."), "{text}");
        let columns: Vec<usize> = text.lines().filter(|l| l.starts_with('|')).map(|l| l.matches('|').count()).collect();
        assert!(columns.iter().all(|c| *c == columns[0]), "{columns:?} in {text}");
    }

    #[test]
    fn the_median_of_the_turns_counts() {
        let at = |us: f64| {
            let mut reading = TurnReading::default();
            reading.step_us.p50 = us;
            reading
        };
        assert_eq!(whole(vec![at(5.0), at(1.0), at(3.0)]).unwrap().step_us.p50, 3.0);
        assert_eq!(whole(vec![]), None);
    }
}
