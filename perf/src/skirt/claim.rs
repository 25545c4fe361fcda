//! A row of the table: what was asked of a case, what it gave, and whether that is enough.

use serde::Serialize;

/// One figure and the most that it may be.
#[derive(Debug, Clone, PartialEq)]
pub struct Claim {
    what: String,
    got: f64,
    most: f64,
    unit: &'static str,
}

impl Claim {
    /// A figure in a unit; an infinite `most` only reports it. NaN is never enough.
    pub fn most(what: &str, got: f64, most: f64, unit: &'static str) -> Self {
        Self { what: what.into(), got, most, unit }
    }

    /// A part of 1, reported and bounded in per cent.
    pub fn percent(what: &str, got: f64, most: f64) -> Self {
        Self::most(what, got * 100.0, most, " %")
    }

    /// Something that must not be there at all.
    pub fn count(what: &str, got: u64) -> Self {
        Self::most(what, got as f64, 0.0, "")
    }

    fn met(&self) -> bool {
        self.got <= self.most || self.most == f64::INFINITY
    }
}

/// A target of one case and what was got.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct TargetRow {
    /// Name of the case.
    pub case: String,
    /// The target, in words.
    pub target: String,
    /// What was got, or why nothing was.
    pub got: String,
    /// Whether every part of the target was met.
    pub met: bool,
    /// What the peers reach.
    pub peers: String,
}

impl TargetRow {
    /// The row of a case's claims, or of the reason why there are none.
    pub fn new(case: &str, peers: &str, claims: Result<Vec<Claim>, &String>) -> Self {
        let (target, got, met) = match claims {
            Ok(claims) => {
                (joined(&claims, bound), joined(&claims, |c| figure(c.got, c.unit)), claims.iter().all(Claim::met))
            }
            Err(reason) => (String::new(), format!("not measured: {reason}"), false),
        };
        Self { case: case.into(), target, got, met, peers: peers.into() }
    }
}

fn joined(claims: &[Claim], value: impl Fn(&Claim) -> String) -> String {
    claims.iter().map(|c| format!("{} {}", c.what, value(c))).collect::<Vec<_>>().join(", ")
}

fn bound(claim: &Claim) -> String {
    if claim.most == f64::INFINITY { "reported".into() } else { format!("<= {}{}", claim.most, claim.unit) }
}

/// Three digits that count, and no more.
fn figure(x: f64, unit: &str) -> String {
    let digits = if x == 0.0 || !x.is_finite() { 0 } else { (2 - x.abs().log10().floor() as i32).clamp(0, 6) };
    let text = format!("{x:.*}", digits as usize);
    let text = if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.') } else { &text };
    format!("{text}{unit}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_row_is_met_when_each_claim_is() {
        let claims = |y: f64| Ok(vec![Claim::most("time", y, 0.7, " Y"), Claim::percent("strain", 0.0014, 0.2)]);
        let row = TargetRow::new("walk", "NvCloth", claims(0.58));
        assert!(row.met);
        assert_eq!(row.target, "time <= 0.7 Y, strain <= 0.2 %");
        assert_eq!(row.got, "time 0.58 Y, strain 0.14 %");
        assert!(!TargetRow::new("walk", "", claims(0.71)).met);
        assert!(!TargetRow::new("walk", "", claims(f64::NAN)).met, "what was not measured is not met");
        assert!(!TargetRow::new("walk", "", Err(&"no wind".into())).met);
        assert!(!TargetRow::new("walk", "", Ok(vec![Claim::count("wrong", 1)])).met);
        assert!(
            TargetRow::new("walk", "", Ok(vec![Claim::percent("strain", 9.0, f64::INFINITY)])).met,
            "only reported"
        );
    }

    #[test]
    fn figures_have_three_digits_that_count() {
        let texts = [0.0, 0.001_234_5, 0.5, 12.345, 1_234.5].map(|x| figure(x, ""));
        assert_eq!(texts, ["0", "0.00123", "0.5", "12.3", "1234"].map(String::from));
    }
}
