//! Whether stated probabilities are true: of the sizes said to be right with 70 %, seven of ten must be right.
//!
//! Real people's girths are measured again with errors of a known sigma, and the size recommended is compared with the one
//! that their true girths get.

use toile_assets::sizes::{GarmentKind, SizeError, SizeTable};
use toile_base::body::Sex;
use toile_base::numeric::random::SplitMix64;
use toile_track::estimate::Estimate;
use toile_track::measure::{Measurements, Source};
use toile_track::measures::Measures;
use toile_track::recommend::{EaseRange, MadeSize, Offer, RecommendError, Recommendation, Zone, ZoneGirth, recommend};

/// Chest, waist and hip girth of one person (m).
pub type Girths = [f32; 3];

/// Lower ends of the bins of stated probability; the last one ends at 1.
pub const BINS: [f32; 6] = [0.0, 0.4, 0.5, 0.6, 0.7, 0.85];

/// What was stated and what was right, of the people in one bin.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct ReliabilityBin {
    /// Number of people in the bin.
    pub people: u32,
    /// Sum of the stated probabilities.
    pub stated: f32,
    /// People for whom the size was right.
    pub right: u32,
}

impl ReliabilityBin {
    fn add(&mut self, stated: f32, right: bool) {
        self.people += 1;
        self.stated += stated;
        self.right += u32::from(right);
    }

    /// Mean stated probability, share of right ones, and its standard error.
    pub fn rates(&self) -> [f32; 3] {
        let n = self.people.max(1) as f32;
        let share = self.right as f32 / n;
        [self.stated / n, share, (share * (1.0 - share) / n).sqrt()]
    }
}

/// How reliable recommendations are at one error of the measures.
#[derive(Debug, Clone, PartialEq)]
pub struct Reliability {
    /// Standard deviation of the error of every girth (m).
    pub sigma: f32,
    /// Figures by stated probability `[BINS]`.
    pub bins: [ReliabilityBin; BINS.len()],
    /// All people, whatever was stated.
    pub all: ReliabilityBin,
    /// People advised to take a girth by tape: the promised probability, and how often the size was right with it.
    pub taped: ReliabilityBin,
    /// The same people before.
    pub untaped: ReliabilityBin,
}

/// Reads the girths of a table of ANSUR II: `;` between columns, millimetres. `None` if it is not one.
pub fn ansur(text: &str) -> Option<Vec<Girths>> {
    let mut lines = text.lines();
    let heads: Vec<&str> = lines.next()?.split(';').collect();
    let names = ["chestcircumference", "waistcircumference", "buttockcircumference"];
    let columns = names.map(|name| heads.iter().position(|h| *h == name));
    let [Some(chest), Some(waist), Some(hip)] = columns else { return None };
    let read = |line: &str| {
        let cells: Vec<&str> = line.split(';').collect();
        let girth = |i: usize| Some(cells.get(i)?.trim().parse::<f32>().ok()? / 1000.0);
        Some([girth(chest)?, girth(waist)?, girth(hip)?])
    };
    lines.filter(|l| !l.trim().is_empty()).map(read).collect()
}

/// Measurements of known girths with known errors.
fn measured(girths: Girths, sigmas: Girths) -> Measurements {
    let at = |i: usize| Some(Estimate::new(girths[i], sigmas[i]));
    let measures = Measures { chest_girth: at(0), waist_girth: at(1), hip_girth: at(2), ..Measures::default() };
    Measurements { measures, valid_pixels: 1, people: 1, frames: 1, source: Source::Depth, notes: Vec::new() }
}

/// Recommends to each person twice: by their true girths, and by girths with errors of `sigma` (m).
///
/// # Errors
/// Those of [`recommend`].
fn reliability(people: &[Girths], offer: &Offer, sigma: f32, seed: u64) -> Result<Reliability, RecommendError> {
    let mut rng = SplitMix64::new(seed);
    let none = ReliabilityBin::default();
    let mut found = Reliability { sigma, bins: [none; BINS.len()], all: none, taped: none, untaped: none };
    for truth in people {
        let seen = truth.map(|g| g + sigma * rng.gaussian());
        let best = recommend(&measured(*truth, [0.0; 3]), offer)?.size;
        let given = recommend(&measured(seen, [sigma; 3]), offer)?;
        let right = given.size == best;
        let bin = BINS.iter().rposition(|low| given.probability >= *low).unwrap_or(0);
        found.bins[bin].add(given.probability, right);
        found.all.add(given.probability, right);
        if let Some(advice) = &given.girth_to_take {
            let after = taped(*truth, seen, sigma, advice.zone, offer)?;
            found.untaped.add(given.probability, right);
            found.taped.add(advice.probability, after.size == best);
        }
    }
    Ok(found)
}

/// The recommendation once the girth of a zone has been taken by tape.
fn taped(truth: Girths, seen: Girths, sigma: f32, zone: Zone, offer: &Offer) -> Result<Recommendation, RecommendError> {
    let known = Zone::ALL.iter().position(|z| *z == zone).unwrap_or(0);
    let (mut girths, mut sigmas) = (seen, [sigma; 3]);
    (girths[known], sigmas[known]) = (truth[known], 0.0);
    recommend(&measured(girths, sigmas), offer)
}

/// A dress with this much ease over the body of each size (m): chest, waist, hip.
const MADE_EASE: [f32; 3] = [0.06, 0.08, 0.10];

/// Ease that feels right, least and most (m).
const RIGHT_EASE: [[f32; 2]; 3] = [[0.03, 0.09], [0.03, 0.15], [0.05, 0.20]];

/// The reliability of the recommendations of a dress in women's sizes.
///
/// # Errors
/// Those of [`recommend`], and a table of sizes that cannot be read.
pub fn of_dress(people: &[Girths], sigma: f32, seed: u64) -> Result<Reliability, RecommendError> {
    let table = SizeTable::embedded("women")?;
    let (sizes, ease) = made(&table)?;
    let offer = Offer { garment: "dress", kind: GarmentKind::Dress, table: &table, sizes: &sizes, ease: &ease };
    reliability(people, &offer, sigma, seed)
}

/// The sizes of a table as they are made, and the ease that feels right.
fn made(table: &SizeTable) -> Result<(Vec<MadeSize>, [EaseRange; 3]), SizeError> {
    let made = |code: &str| {
        let body = table.size_body(code)?;
        let girths = [body.chest_girth, body.waist_girth, body.hip_girth];
        let zones = [0, 1, 2].map(|i| ZoneGirth { zone: Zone::ALL[i], girth_m: girths[i] + MADE_EASE[i] });
        Ok(MadeSize { code: code.to_owned(), zones: zones.to_vec() })
    };
    let sizes = table.codes().into_iter().map(made).collect::<Result<Vec<_>, SizeError>>()?;
    let ease = [0, 1, 2].map(|i| EaseRange { zone: Zone::ALL[i], least: RIGHT_EASE[i][0], most: RIGHT_EASE[i][1] });
    Ok((sizes, ease))
}

/// A person's recommended size, compared with the size by their true girths.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SizeCheck {
    /// How probable it was stated to be the best one.
    pub stated: f32,
    /// Whether it is.
    pub right: bool,
    /// How far the true chest girth lies from the nearest border between two sizes (m).
    pub from_border: f32,
}

/// Recommends a dress to a woman and a T-shirt to a man, by true girths and by measured ones (chest, waist, hip).
///
/// # Errors
/// Those of [`recommend`], and a table of sizes that cannot be read.
pub fn check_size(sex: Sex, truth: Girths, seen: [Estimate; 3]) -> Result<SizeCheck, RecommendError> {
    let (name, kind) = if sex == Sex::Female { ("women", GarmentKind::Dress) } else { ("men", GarmentKind::Tshirt) };
    let table = SizeTable::embedded(name)?;
    let (sizes, ease) = made(&table)?;
    let offer = Offer { garment: kind.name(), kind, table: &table, sizes: &sizes, ease: &ease };
    let best = recommend(&measured(truth, [0.0; 3]), &offer)?.size;
    let given = recommend(&measured(seen.map(|e| e.value), seen.map(|e| e.sigma)), &offer)?;
    let mut from_border = f32::MAX;
    for code in table.codes() {
        for border in table.size(code)?.chest {
            from_border = from_border.min((truth[0] - border).abs());
        }
    }
    Ok(SizeCheck { stated: given.probability, right: given.size == best, from_border })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_are_found_by_name_and_a_broken_row_is_refused() {
        let text = "id;waistcircumference;x;chestcircumference;buttockcircumference\r\n1;800;9;950;1000\r\n";
        assert_eq!(ansur(text), Some(vec![[0.95, 0.8, 1.0]]));
        assert_eq!(ansur("id;waistcircumference\n1;800"), None);
        assert_eq!(ansur(&format!("{text}2;eight;9;950;1000")), None);
    }
}
