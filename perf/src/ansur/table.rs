//! The table of correlations of the survey's measures, as `toile_assets::body` embeds it.

use super::survey::{Survey, SurveyError};

/// The measures that the table holds.
const COLUMNS: [&str; 23] = [
    "stature",
    "cervicaleheight",
    "waistheightomphalion",
    "crotchheight",
    "kneeheightmidpatella",
    "neckcircumference",
    "neckcircumferencebase",
    "chestcircumference",
    "waistcircumference",
    "buttockcircumference",
    "thighcircumference",
    "calfcircumference",
    "bicepscircumferenceflexed",
    "wristcircumference",
    "biacromialbreadth",
    "chestbreadth",
    "chestdepth",
    "waistbreadth",
    "waistdepth",
    "hipbreadth",
    "buttockdepth",
    "sleevelengthspinewrist",
    "waistbacklength",
];

/// One sex's part of the table, as TOML.
///
/// # Errors
/// A column that the survey lacks.
pub fn table(sex: &str, survey: &Survey) -> Result<String, SurveyError> {
    let mean = |name: &str| survey.column(name).map(|c| average(&c));
    let straight = mean("acromionradialelength")? + mean("radialestylionlength")?;
    let bent = mean("shoulderelbowlength")? + mean("forearmhandlength")? - mean("handlength")?;
    let sleeve = mean("sleevelengthspinewrist")? - 0.5 * mean("biacromialbreadth")?;
    let mut text = format!(
        "[{sex}]\npeople = {}\narm_bend = {:.1}\nsleeve_pose = {:.1}\n",
        survey.people(),
        bent - straight,
        sleeve - straight
    );
    let columns: Vec<Vec<f64>> = COLUMNS.iter().map(|n| survey.column(n)).collect::<Result<_, _>>()?;
    for (i, (name, column)) in COLUMNS.iter().zip(&columns).enumerate() {
        let with: Vec<String> = columns[..i].iter().map(|c| format!("{:.3}", correlation(column, c))).collect();
        text += &format!(
            "\n[[{sex}.column]]\nname = \"{name}\"\nmean = {:.1}\nsd = {:.1}\nwith = [{}]\n",
            average(column),
            deviation(column),
            with.join(", ")
        );
    }
    Ok(text)
}

fn average(x: &[f64]) -> f64 {
    x.iter().sum::<f64>() / x.len().max(1) as f64
}

fn deviation(x: &[f64]) -> f64 {
    let mean = average(x);
    average(&x.iter().map(|v| (v - mean).powi(2)).collect::<Vec<_>>()).sqrt()
}

fn correlation(x: &[f64], y: &[f64]) -> f64 {
    let (mx, my) = (average(x), average(y));
    let both: Vec<f64> = x.iter().zip(y).map(|(a, b)| (a - mx) * (b - my)).collect();
    average(&both) / (deviation(x) * deviation(y))
}
