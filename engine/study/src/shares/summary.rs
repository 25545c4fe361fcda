//! The summary of a study's rows.

use std::path::Path;

use serde::Serialize;
use toile_base::numeric::statistics::{median, quantile};

use super::grading::{self, GradingStep, best, judge};
use super::interval::{Bootstrap, Share};
use super::typical::typical;
use super::wearers::{self, Wearer, Wearers, ZONES, note};
use crate::error::{Result, StudyError};

/// Typical people of a garment.
const TYPICAL: usize = 10;

/// People of a map: more dots hide each other.
const MAPPED: usize = 2_000;

/// Numbers of people whose share is looked at on the way to all of them.
const ON_THE_WAY: [usize; 11] = [50, 100, 200, 500, 1_000, 2_000, 5_000, 10_000, 20_000, 50_000, 100_000];

/// What a study comes to.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Summary {
    /// What the study is called.
    pub name: String,
    /// Version of the program that made the rows.
    pub version: String,
    /// SHA-256 of the study and all that it names.
    pub study_sha256: String,
    /// Number of people.
    pub people: u64,
    /// Number of rows.
    pub rows: u64,
    /// Errors with which measures were seen (standard deviations, mm).
    pub sensor_sigma_mm: serde_json::Value,
    /// The garments.
    pub garments: Vec<GarmentSummary>,
}

/// What it comes to for one garment.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct GarmentSummary {
    /// Its name.
    pub name: String,
    /// The girth that its size is designated by.
    pub primary: String,
    /// The zones by which it is judged.
    pub zones: Vec<String>,
    /// People whom it is made for.
    pub people: usize,
    /// Share of these whom the size that is recommended to their true measures fits at every zone.
    pub fitted: Share,
    /// The same in the size that is recommended to the measures as seen.
    pub fitted_as_seen: Share,
    /// Share who get another size by what is seen than by what is true.
    pub other_size_as_seen: Share,
    /// Share who are fitted in the size of the table's ranges; who is in none is not.
    pub fitted_by_table: Share,
    /// Share whose size in the table is the one recommended.
    pub table_agrees: Share,
    /// Its sizes, smallest first.
    pub sizes: Vec<SizeSummary>,
    /// Steps between sizes, the most helpful change first.
    pub steps: Vec<GradingStep>,
    /// The share of people fitted, with fewer of them.
    pub convergence: Vec<Convergence>,
    /// Typical people.
    pub typical: Vec<SummaryWearer>,
    /// People for a map.
    pub map: Vec<SummaryWearer>,
    /// What physics says; none where nothing was draped.
    pub draped: Option<DrapedFigures>,
}

/// A size.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct SizeSummary {
    /// Its code.
    pub size: String,
    /// Share of people to whom it is recommended.
    pub recommended: Share,
    /// Share of people to whom it is recommended and whom it fits.
    pub fitted: Share,
    /// Share of all people whom it would fit.
    pub would_fit: Share,
    /// Where it fails those to whom it is recommended.
    pub failures: Vec<ZoneFailure>,
}

/// How often a size fails at a zone those to whom it is recommended.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ZoneFailure {
    /// The zone.
    pub zone: String,
    /// Share of them for whom it is too tight there.
    pub tight: Share,
    /// Share of them for whom it is too loose there.
    pub loose: Share,
}

/// The share fitted among the first so many people.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Convergence {
    /// Number of people.
    pub people: usize,
    /// The share of them.
    pub fitted: Share,
}

/// A person of a garment's people.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct SummaryWearer {
    /// Number of the person.
    pub person: i64,
    /// Share of people for whom they stand.
    pub share: f64,
    /// Stature (mm).
    pub stature_mm: f64,
    /// Chest, waist and hip girth (mm).
    pub girths_mm: [f64; 3],
    /// The size recommended to their true measures.
    pub size: String,
    /// Whether it fits them.
    pub fits: bool,
}

/// What physics says of the try-ons that were simulated.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct DrapedFigures {
    /// Try-ons that were simulated.
    pub try_ons: u64,
    /// Greatest 99th percentile of the strain among them (1).
    pub worst_strain_p99: f64,
    /// Median of it (1).
    pub strain_p99: f64,
    /// Zones with the mean of worn ease less ease by girths and its standard deviation (mm).
    pub worn_less_girths_mm: Vec<(String, [f64; 2])>,
    /// People of whom a size without a pull was found.
    pub judged: usize,
    /// Share of these whose smallest size without a pull is the one recommended by girths.
    pub agrees: Share,
    /// Share for whom physics takes a smaller size.
    pub smaller: Share,
    /// Share for whom it takes a larger one.
    pub larger: Share,
    /// Share of people for whom something pulls in the recommended size.
    pub pulls: Share,
    /// Try-ons that were compared with fully settled ones.
    pub compared: u64,
    /// Of these, the median of the mean distance that was left, of its 99th percentile, and of the change of ease (mm).
    pub unsettled_mm: [f64; 3],
    /// Of these, how many pull at other zones once they have settled.
    pub verdicts_changed: u64,
    /// Garments that could not be laid on a person.
    pub troubles: usize,
}

impl Summary {
    /// Reads the file of a study's rows.
    ///
    /// # Errors
    /// A file that is none of ours.
    pub fn read(path: &Path) -> Result<Self> {
        let (notes, found) = wearers::read(path)?;
        let number = |name: &str| note(&notes, name)?.parse::<u64>().map_err(StudyError::input);
        let seed = number("toile.seed")?;
        Ok(Self {
            name: note(&notes, "toile.name")?.to_owned(),
            version: note(&notes, "toile.version")?.to_owned(),
            study_sha256: note(&notes, "toile.study_sha256")?.to_owned(),
            people: number("toile.people")?,
            rows: number("toile.rows")?,
            sensor_sigma_mm: serde_json::from_str(note(&notes, "toile.sensor_sigma_mm")?).map_err(StudyError::input)?,
            garments: found.iter().map(|wearers| garment(wearers, seed)).collect(),
        })
    }
}

/// One garment's wearers with what counts them again.
struct Counted<'w> {
    wearers: &'w Wearers,
    bootstrap: Bootstrap,
}

impl Counted<'_> {
    /// The share of those of whom something is so among those of whom something else is.
    fn share(&self, is: impl Fn(&Wearer) -> bool, among: impl Fn(&Wearer) -> bool) -> Share {
        let counted = |w: &Wearer| {
            let weight = if among(w) { w.weight } else { 0.0 };
            (if weight > 0.0 && is(w) { weight } else { 0.0 }, weight)
        };
        self.bootstrap.mean(self.wearers.all.iter().map(counted))
    }

    /// Whether a size fits a person at every zone.
    fn fits(&self, wearer: &Wearer, size: Option<usize>) -> bool {
        size.is_some_and(|size| judge(&self.wearers.note, size, wearer.girths, |_| 0.0).fits())
    }
}

fn garment(wearers: &Wearers, seed: u64) -> GarmentSummary {
    let counted = Counted { wearers, bootstrap: Bootstrap::new(wearers.all.len(), seed) };
    let all_wearers = |_: &Wearer| true;
    let note = &wearers.note;
    let shown = |w: &Wearer, share: f64| SummaryWearer {
        person: w.person,
        share,
        stature_mm: w.stature,
        girths_mm: w.girths,
        size: w.best.map_or_else(String::new, |size| note.sizes[size].0.clone()),
        fits: counted.fits(w, w.best),
    };
    let every = wearers.all.len().div_ceil(MAPPED).max(1);
    GarmentSummary {
        name: note.name.clone(),
        primary: note.primary.clone(),
        zones: note.comfort_mm.iter().map(|(zone, _)| zone.clone()).collect(),
        people: wearers.all.len(),
        fitted: counted.share(|w| counted.fits(w, w.best), all_wearers),
        fitted_as_seen: counted.share(|w| counted.fits(w, w.seen), all_wearers),
        other_size_as_seen: counted.share(|w| w.seen != w.best, all_wearers),
        fitted_by_table: counted.share(|w| counted.fits(w, w.by_table), all_wearers),
        table_agrees: counted.share(|w| w.by_table == w.best, all_wearers),
        sizes: (0..note.sizes.len()).map(|size| of_size(&counted, size)).collect(),
        steps: grading::steps(wearers, &counted.bootstrap),
        convergence: convergence(wearers, seed),
        typical: typical(&wearers.all, TYPICAL).into_iter().map(|(i, share)| shown(&wearers.all[i], share)).collect(),
        map: wearers.all.iter().step_by(every).map(|w| shown(w, w.weight)).collect(),
        draped: (wearers.draped_rows > 0).then(|| draped(&counted)),
    }
}

fn of_size(counted: &Counted<'_>, size: usize) -> SizeSummary {
    let note = &counted.wearers.note;
    let gets = |w: &Wearer| w.best == Some(size);
    let all_wearers = |_: &Wearer| true;
    // The judged zones that this size has, in their order.
    let zones = note.comfort_mm.iter().enumerate().filter(|(zone, _)| note.sizes[size].1[*zone].is_some());
    let failure = |(place, (_, (zone, _))): (usize, (usize, &(String, [f64; 2])))| {
        let is = |w: &Wearer, verdict: i8| judge(note, size, w.girths, |_| 0.0).verdicts[place] == verdict;
        ZoneFailure {
            zone: zone.clone(),
            tight: counted.share(|w| is(w, -1), gets),
            loose: counted.share(|w| is(w, 1), gets),
        }
    };
    SizeSummary {
        size: note.sizes[size].0.clone(),
        recommended: counted.share(gets, all_wearers),
        fitted: counted.share(|w| gets(w) && counted.fits(w, Some(size)), all_wearers),
        would_fit: counted.share(|w| counted.fits(w, Some(size)), all_wearers),
        failures: zones.enumerate().map(failure).collect(),
    }
}

fn convergence(wearers: &Wearers, seed: u64) -> Vec<Convergence> {
    let all = wearers.all.len();
    let numbers = ON_THE_WAY.into_iter().filter(|n| *n < all).chain([all]);
    let upto = |people: usize| {
        let first = &wearers.all[..people];
        let fits = |w: &Wearer| f64::from(u8::from(best(&wearers.note, w.girths, |_, _| 0.0).1.fits()));
        let fitted = Bootstrap::new(people, seed).mean(first.iter().map(|w| (fits(w) * w.weight, w.weight)));
        Convergence { people, fitted }
    };
    numbers.map(upto).collect()
}

fn draped(counted: &Counted<'_>) -> DrapedFigures {
    let wearers = counted.wearers;
    let found = |w: &Wearer| w.by_physics().is_some() && w.best.is_some();
    let mut strain = wearers.strain_p99.clone();
    let worn_less_girths_mm = ZONES.iter().zip(&wearers.eases).filter(|(_, all)| !all.is_empty()).map(|(zone, all)| {
        let off: Vec<f64> = all.iter().map(|[girths, worn]| worn - girths).collect();
        let mean = off.iter().sum::<f64>() / off.len() as f64;
        let square = off.iter().map(|x| (x - mean).powi(2)).sum::<f64>() / off.len() as f64;
        ((*zone).to_owned(), [mean, square.sqrt()])
    });
    DrapedFigures {
        try_ons: wearers.draped_rows,
        worst_strain_p99: strain.iter().copied().fold(0.0, f64::max),
        strain_p99: median(&mut strain).unwrap_or(0.0),
        worn_less_girths_mm: worn_less_girths_mm.collect(),
        judged: wearers.all.iter().filter(|w| found(w)).count(),
        agrees: counted.share(|w| w.by_physics() == w.best, found),
        smaller: counted.share(|w| w.by_physics() < w.best, found),
        larger: counted.share(|w| w.by_physics() > w.best, found),
        pulls: counted.share(
            |w| w.best.and_then(|best| w.draped.get(&best)) == Some(&true),
            |w| w.best.is_some_and(|best| w.draped.contains_key(&best)),
        ),
        compared: wearers.compared[0],
        unsettled_mm: std::array::from_fn(|k| {
            let mut all: Vec<f64> = wearers.unsettled.iter().map(|u| u[k]).collect();
            quantile(&mut all, 0.5).unwrap_or(0.0)
        }),
        verdicts_changed: wearers.compared[1],
        troubles: wearers.troubles.len(),
    }
}
