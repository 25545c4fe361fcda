//! `toile bench gestures`: what is missed, what is false, and what a frame costs.

use std::hint::black_box;
use std::time::Instant;

use clap::value_parser;
use toile_base::numeric::statistics::median_of;
use toile_perf::gestures::{Act, GestureConditions, GestureCount, GestureStudy, held_up, sequence};
use toile_track::gesture::{Gestures, HandSegmenter};

use super::gestures_report::GesturesReport;
use crate::exit::AppError;
use crate::report::Document;
use crate::terminal::{self, Words};

/// Most sequences of a cell: 70 cells of a millisecond each make it a quarter of an hour.
const MAX_SEQUENCES: i64 = 10_000;

/// Report how many gestures are missed, how many are seen where there are none, and what a frame costs.
///
/// Lets synthetic shoppers of many sizes, distances and speeds swipe, hold a hand out, open and close it, and do what people
/// do before a mirror that is no gesture, seen by a sensor with noise and lost frames. Counts gestures missed and false
/// events, and times the recogniser.
#[derive(Debug, Clone, PartialEq, Eq, clap::Args)]
#[command(after_help = "Example: the tables of docs/gestures.md\n  toile bench gestures --sequences 200 --table")]
pub struct GesturesArgs {
    /// Sequences of each gesture under each condition
    #[arg(long, value_name = "N", value_parser = value_parser!(u32).range(1..=MAX_SEQUENCES), default_value = "100")]
    sequences: u32,
    /// Seed of the first sequence
    #[arg(long, value_name = "N", default_value = "1")]
    seed: u64,
    /// Print all tables in Markdown
    #[arg(long)]
    table: bool,
    /// Print one JSON object, and nothing else, on stdout
    #[arg(long)]
    json: bool,
}

/// Runs that the median time is taken of.
const RUNS: usize = 25;

/// Distance at which one hand is timed (m).
const TIMED_AT: f32 = 2.0;

/// Runs `toile bench gestures`.
///
/// # Errors
/// Where stdout cannot be written.
pub fn run(args: &GesturesArgs) -> Result<(), AppError> {
    let words = Words::new(args.json);
    let study = GestureStudy::run(args.sequences, args.seed, &mut |case| words.print_line(case));
    let times = [joints_us(), hand_us()];
    if args.json {
        return terminal::print_json(&Document::new("bench-gestures", GesturesReport::new(&study, times)));
    }
    let cost = format!("A frame of joints takes {:.2} us, a hand in a depth frame {:.0} us.\n", times[0], times[1]);
    if args.table {
        return terminal::print(&format!("{}\n{cost}", study.markdown()));
    }
    terminal::print(&format!("{}{cost}", summary(&study)))
}

fn summary(study: &GestureStudy) -> String {
    let mut text = String::new();
    for act in Act::GESTURES {
        let own = study.gestures.iter().filter(|(a, c, _)| *a == act && *c == GestureConditions::default());
        let all = own.fold(GestureCount::default(), |sum, (_, _, count)| sum.and(*count));
        text.push_str(&format!("{:12} {:4.1} % missed at 2 m and 30 Hz\n", act.name(), 100.0 * all.miss_rate()));
    }
    let others = study.others.iter().fold(GestureCount::default(), |sum, (_, count)| sum.and(*count));
    let [frames, wrong, unseen] =
        study.grips.iter().fold([0, 0, 0], |s, r| [s[0] + r.frames, s[1] + r.wrong, s[2] + r.unseen]);
    let percent = 100.0 * (wrong + unseen) as f32 / frames.max(1) as f32;
    text.push_str(&format!("false events {:4.2} a minute of what is no gesture\n", others.wrong_per_minute()));
    text.push_str(&format!(
        "hands        {percent:4.1} % of the frames classified wrongly or not at all, 1.2 to 3.5 m\n"
    ));
    text
}

/// Median time of a frame of joints (us).
fn joints_us() -> f64 {
    let frames = sequence(Act::Talk, &GestureConditions::default(), 1);
    let each = frames.len().max(1) as f64;
    median(|| {
        let mut gestures = Gestures::new();
        let start = Instant::now();
        for frame in &frames {
            black_box(gestures.push(black_box(frame), None));
        }
        start.elapsed().as_secs_f64() * 1e6 / each
    })
}

/// Median time of one hand in a depth frame (us).
fn hand_us() -> f64 {
    let (frame, sight) = held_up(TIMED_AT, 1);
    let mut segmenter = HandSegmenter::new();
    median(|| {
        let start = Instant::now();
        black_box(segmenter.shape(black_box(&frame), &sight));
        start.elapsed().as_secs_f64() * 1e6
    })
}

fn median(mut once: impl FnMut() -> f64) -> f64 {
    once();
    median_of((0..RUNS).map(|_| once())).unwrap_or(0.0)
}
