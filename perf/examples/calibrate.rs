//! Fits the section models of `toile_track::anthropometry::SilhouetteModel` on random subjects and prints the constants:
//! `cargo run --release -p toile-perf --example calibrate -- SUBJECTS FRAMES SEED`.

use std::process::ExitCode;

use glam::{DMat4, DVec4};
use toile_assets::sizes::Population;
use toile_base::body::Sex;
use toile_base::numeric::random::SplitMix64;
use toile_perf::agreement::Mannequin;
use toile_track::anthropometry::LEVELS;
use toile_track::estimate::temporal_mean;
use toile_track::point_cloud::{PersonCloud, PersonFinder};
use toile_track::section::TorsoSection;
use toile_track::silhouette::{SilhouetteReading, read};

/// What one subject shows: stature, outline of the shoulders, and three sections; and what is true.
struct SubjectRow {
    sex: Sex,
    seen: [f32; 2],
    sections: [Option<TorsoSection>; 3],
    truth: [f32; 5],
}

fn row(sex: Sex, frames: usize, rng: &mut SplitMix64) -> Option<SubjectRow> {
    let subject = Mannequin::new(sex, rng).ok()?;
    let mut finder = PersonFinder::default();
    let readings: Vec<SilhouetteReading> = subject
        .seen(frames, rng)
        .iter()
        .filter_map(|f| read(&PersonCloud::of(&finder.push(f).alone?)?, &LEVELS, Population::Mixed))
        .collect();
    let mean = |parameter: &dyn Fn(&SilhouetteReading) -> Option<f32>| {
        temporal_mean(&readings.iter().filter_map(parameter).collect::<Vec<_>>()).map(|e| e.value)
    };
    let section = |which: fn(&SilhouetteReading) -> Option<TorsoSection>| {
        Some(TorsoSection {
            breadth: mean(&|r| Some(which(r)?.breadth))?,
            front: mean(&|r| Some(which(r)?.front))?,
            arc: mean(&|r| Some(which(r)?.arc))?,
        })
    };
    let sections = [section(|r| r.chest), section(|r| r.waist), section(|r| r.hip)];
    let seen = [mean(&|r| r.stature)?, mean(&|r| r.shoulders)?];
    Some(SubjectRow { sex, seen, sections, truth: subject.truth() })
}

/// Least squares of a length on up to three others and a constant; prints factors and the residual's deviation.
fn fit(name: &str, samples: &[(DVec4, f64)]) {
    let (mut normal, mut moment) = (DMat4::ZERO, DVec4::ZERO);
    for (x, y) in samples {
        normal += DMat4::from_cols(*x * x.x, *x * x.y, *x * x.z, *x * x.w);
        moment += *x * *y;
    }
    // Unused columns are zero; a tiny ridge keeps the matrix regular and their factors 0.
    let factors = (normal + DMat4::IDENTITY * 1e-9).inverse() * moment;
    let sum: f64 = samples.iter().map(|(x, y)| (y - factors.dot(*x)).powi(2)).sum();
    let residual = (sum / (samples.len() as f64 - 4.0)).sqrt();
    println!("  {name:9} {factors:.4} residual {residual:.4} of {}", samples.len());
}

fn report(name: &str, rows: &[&SubjectRow]) {
    println!("{name}");
    let one = |x: f32| DVec4::new(1.0, f64::from(x), 0.0, 0.0);
    let offset = |r: &&SubjectRow| (DVec4::X, f64::from(r.truth[0] - r.seen[0]));
    fit("stature", &rows.iter().map(offset).collect::<Vec<_>>());
    fit("shoulder", &rows.iter().map(|r| (one(r.seen[1]), f64::from(r.truth[1]))).collect::<Vec<_>>());
    for (k, name) in ["chest", "waist", "hip"].into_iter().enumerate() {
        let sample = |r: &&SubjectRow| {
            let s = r.sections[k]?;
            Some((DVec4::new(1.0, s.breadth.into(), s.arc.into(), s.front.into()), f64::from(r.truth[2 + k])))
        };
        fit(name, &rows.iter().filter_map(sample).collect::<Vec<_>>());
        let mut fronts: Vec<f32> = rows.iter().filter_map(|r| Some(r.sections[k]?.front)).collect();
        fronts.sort_by(f32::total_cmp);
        if let ([least, ..], [.., most]) = (&fronts[fronts.len() / 40..], &fronts[..fronts.len() - fronts.len() / 40]) {
            println!("  {name:9} fronts of 19 of 20 are {least:.3} to {most:.3}");
        }
    }
}

fn main() -> ExitCode {
    let numbers: Vec<u64> = std::env::args().skip(1).filter_map(|a| a.parse().ok()).collect();
    let &[subjects, frames, seed] = &numbers[..] else {
        eprintln!("give three numbers: subjects of each sex, frames, seed");
        return ExitCode::from(2);
    };
    let all: Vec<SubjectRow> = (0..subjects)
        .flat_map(|i| [(i, Sex::Female), (i, Sex::Male)])
        .filter_map(|(i, sex)| {
            row(sex, frames as usize, &mut SplitMix64::new(seed + 2 * i + u64::from(sex == Sex::Male)))
        })
        .collect();
    let of = |sex: Option<Sex>| all.iter().filter(|r| sex.is_none_or(|s| s == r.sex)).collect::<Vec<_>>();
    report("women", &of(Some(Sex::Female)));
    report("men", &of(Some(Sex::Male)));
    report("mixed", &of(None));
    ExitCode::SUCCESS
}
