//! Sheets of measured values, as laboratories hand them out, become the text of a fabric's file.
//!
//! A sheet has a line a value: its name, then one figure, or that of the warp and that of the weft, parted by commas, semicolons,
//! tabs or spaces; what follows `#` is passed over. The names are those of the Kawabata system (KES: `LT WT RT EMT B 2HB G 2HG 2HG5 LC
//! WC RC T W MIU MMD SMD`), of FAST (`E5 E20 E100 C B G W T2 T100`) and of Cusick's drape test (`DC`), each in its own system's units.

use std::collections::BTreeMap;

use thiserror::Error;

use toile_base::fabric::stretch_curve::StretchCurve;

/// uN m of a gf cm2/cm.
const RIGIDITY: f64 = 98.066_5;

/// mN of a gf cm/cm.
const MOMENT: f64 = 9.806_65;

/// N/m of a gf/cm.
const FORCE: f64 = 0.980_665;

/// N/m a radian of a gf/(cm deg).
const SHEAR: f64 = FORCE * 180.0 / std::f64::consts::PI;

/// Force at which the Kawabata system's tensile test turns (gf/cm).
const KES_MOST: f64 = 500.0;

/// Force of FAST's largest extension (gf/cm).
const FAST_MOST: f64 = 100.0;

/// Names of the Kawabata system's values: tension, bending, shear, compression, surface, thickness and weight.
const KES: [&str; 18] =
    ["LT", "WT", "RT", "EMT", "EM", "B", "2HB", "G", "2HG", "2HG5", "LC", "WC", "RC", "T", "W", "MIU", "MMD", "SMD"];

/// Names of FAST's.
const FAST: [&str; 9] = ["E5", "E20", "E100", "C", "B", "G", "W", "T2", "T100"];

/// Which system a sheet is of.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SheetKind {
    /// Kawabata Evaluation System.
    Kawabata,
    /// Fabric Assurance by Simple Testing.
    Fast,
    /// Cusick's drape test alone.
    Cusick,
}

impl SheetKind {
    /// Its name in a sentence.
    pub fn name(self) -> &'static str {
        match self {
            Self::Kawabata => "KES",
            Self::Fast => "FAST",
            Self::Cusick => "Cusick",
        }
    }
}

/// Why a sheet is none.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum SheetError {
    /// A line that has no figure.
    #[error(
        "line {line} of the sheet, \"{text}\", is no name with one figure or two; write for example `B, 0.118, 0.102`"
    )]
    Line {
        /// Number of the line, from 1.
        line: usize,
        /// What stands there.
        text: String,
    },
    /// A name of no system.
    #[error("line {line} of the sheet names {name}, which none of KES, FAST and Cusick measures; take the line out")]
    Name {
        /// Number of the line, from 1.
        line: usize,
        /// Name of the value as the sheet has it.
        name: String,
    },
    /// Nothing by which to tell what it is.
    #[error("the sheet has no value by which it is one of KES (2HB, LT, WT), FAST (E100) or Cusick (DC)")]
    Kind,
}

/// A sheet as it was read: each value along the warp and the weft.
#[derive(Debug, Clone, PartialEq)]
pub struct MeasuredSheet {
    /// Which system it is of.
    pub kind: SheetKind,
    /// Values by name, warp and weft, in the units of the system.
    pub values: BTreeMap<String, [f64; 2]>,
}

/// One figure of a fabric's file.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FileFigure {
    /// Its key; of `[hysteresis]` behind a dot.
    pub key: &'static str,
    /// Its value, in the unit that the key says.
    pub value: f64,
    /// What it is made of.
    pub from: &'static str,
}

impl MeasuredSheet {
    /// Reads a sheet.
    ///
    /// # Errors
    /// A line that is no value, a name of no system.
    pub fn parse(text: &str) -> Result<Self, SheetError> {
        let mut values = BTreeMap::new();
        for (number, line) in (1..).zip(text.lines()) {
            let line = line.split('#').next().unwrap_or_default().trim();
            if line.is_empty() {
                continue;
            }
            let parts: Vec<&str> = line.split([',', ';', '\t', ' ']).filter(|p| !p.is_empty()).collect();
            let figures: Option<Vec<f64>> =
                parts[1..].iter().map(|p| p.parse().ok().filter(|v: &f64| v.is_finite())).collect();
            let [warp, weft] = match figures.as_deref() {
                Some([both]) => [*both; 2],
                Some([warp, weft]) => [*warp, *weft],
                _ => return Err(SheetError::Line { line: number, text: line.into() }),
            };
            let name = parts[0].trim_end_matches(':').to_ascii_uppercase().replace("B-", "B");
            if !KES.contains(&&*name) && !FAST.contains(&&*name) && name != "DC" {
                return Err(SheetError::Name { line: number, name });
            }
            values.insert(name, [warp, weft]);
        }
        let has = |names: &[&str]| names.iter().any(|n| values.contains_key(*n));
        let kind = if has(&["2HB", "LT", "WT", "2HG", "MIU"]) {
            SheetKind::Kawabata
        } else if has(&["E100", "E20", "E5", "C"]) {
            SheetKind::Fast
        } else if has(&["DC"]) {
            SheetKind::Cusick
        } else {
            return Err(SheetError::Kind);
        };
        Ok(Self { kind, values })
    }

    fn mean(&self, name: &str) -> Option<f64> {
        self.values.get(name).map(|[warp, weft]| 0.5 * (warp + weft))
    }

    /// What of a fabric's file the sheet says, in SI units.
    pub fn figures(&self) -> Vec<FileFigure> {
        let mut out = Vec::new();
        match self.kind {
            SheetKind::Kawabata => self.kawabata(&mut out),
            SheetKind::Fast => self.fast(&mut out),
            SheetKind::Cusick => {}
        }
        let of = |key| out.iter().find(|f: &&FileFigure| f.key == key).map(|f| f.value);
        let bias = of("bend_warp_un_m").zip(of("bend_weft_un_m")).and_then(|(warp, weft)| usual_bias([warp, weft]));
        let mut add = |key, value: Option<f64>, from| out.extend(value.map(|value| FileFigure { key, value, from }));
        add("bend_bias_un_m", bias, "not on the sheet: what cloth of such a B usually has at 45 degrees");
        add("drape_percent", self.mean("DC"), "DC");
        out
    }

    /// Extension at the largest force of the tensile test, of each way (1): as measured, or from work and linearity, LT = WT / (F
    /// EMT / 2).
    fn extension(&self, way: usize) -> Option<f64> {
        let at = |name: &str| self.values.get(name).map(|v| v[way]);
        let measured = at("EMT").or(at("EM")).map(|percent| percent / 100.0);
        measured.or_else(|| Some(2.0 * at("WT")? / (at("LT")? * KES_MOST))).filter(|e| *e > 0.0)
    }

    fn kawabata(&self, out: &mut Vec<FileFigure>) {
        let way = |name: &str, way: usize, unit: f64| self.values.get(name).map(|v| v[way] * unit);
        let secant = |way| Some(KES_MOST * FORCE / self.extension(way)?);
        let mut add = |key, value: Option<f64>, from| out.extend(value.map(|value| FileFigure { key, value, from }));
        add("density_kg_m2", self.mean("W").map(|mg_cm2| 0.01 * mg_cm2), "W");
        add("stretch_warp_n_m", secant(0), "the secant at 500 gf/cm: EMT, or WT and LT");
        add("stretch_weft_n_m", secant(1), "the secant at 500 gf/cm: EMT, or WT and LT");
        add("shear_n_m", self.mean("G").map(|g| g * SHEAR), "G");
        add("bend_warp_un_m", way("B", 0, RIGIDITY), "B");
        add("bend_weft_un_m", way("B", 1, RIGIDITY), "B");
        add("thickness_mm", self.mean("T"), "T");
        add("friction", self.mean("MIU"), "MIU, on steel wires");
        add("hysteresis.bend_warp_mn", way("2HB", 0, MOMENT), "2HB");
        add("hysteresis.bend_weft_mn", way("2HB", 1, MOMENT), "2HB");
        add("hysteresis.shear_n_m", self.mean("2HG").map(|g| g * FORCE), "2HG");
    }

    fn fast(&self, out: &mut Vec<FileFigure>) {
        let at = |name: &str, way: usize| self.values.get(name).map(|v| v[way]);
        let weight = self.mean("W").map(|g_m2| 1e-3 * g_m2);
        let secant = |way| Some(FAST_MOST * FORCE / (at("E100", way)? / 100.0)).filter(|e: &f64| e.is_finite());
        // B = W c^3 g with the bending length c in mm gives uN m of g/m2: 9.81e-6 of both.
        let bend = |way| at("B", way).or_else(|| Some(9.81e-6 * self.mean("W")? * at("C", way)?.powi(3)));
        let mut add = |key, value: Option<f64>, from| out.extend(value.map(|value| FileFigure { key, value, from }));
        add("density_kg_m2", weight, "W");
        add("stretch_warp_n_m", secant(0), "the secant at 100 gf/cm: E100");
        add("stretch_weft_n_m", secant(1), "the secant at 100 gf/cm: E100");
        add("shear_n_m", self.mean("G"), "G");
        add("bend_warp_un_m", bend(0), "B, or C and W");
        add("bend_weft_un_m", bend(1), "B, or C and W");
        add("thickness_mm", self.mean("T2"), "T2");
    }

    /// The text of a fabric's file: what the sheet says, all else as the built-in fabric `base` has it.
    pub fn file(&self, name: &str, title: &str, base: &str, source: &str) -> String {
        let quoted = |text: &str| text.replace(['"', '\\', '\n', '\r'], " ");
        let mut text = format!(
            "# From a sheet of {}; what it does not say is that of {base}.\nname = \"{}\"\ntitle = \"{}\"\nbase = \
             \"{base}\"\nsource = \"{}\"\n",
            self.kind.name(),
            quoted(name),
            quoted(title),
            quoted(source)
        );
        let figures = self.figures();
        let curves: String = [("warp", 0), ("weft", 1)]
            .into_iter()
            .filter_map(|(name, way)| {
                let c = self.curve(way)?;
                let [knee, load, beyond, width] = c.figures();
                Some(format!(
                    "\n[stretch.{name}]\n# {}\nknee_percent = {knee:.4}\nknee_n_m = {load:.3}\nbeyond_n_m = {beyond:.1}\n\
                     hysteresis_n_m = {width:.3}\n",
                    self.curve_words()
                ))
            })
            .collect();
        let (loops, plain): (Vec<_>, Vec<_>) = figures.iter().partition(|f| f.key.starts_with("hysteresis."));
        plain.iter().for_each(|f| text += &line(f, f.key));
        if !loops.is_empty() {
            text += "\n[hysteresis]\n";
        }
        loops.iter().for_each(|f| text += &line(f, f.key.trim_start_matches("hysteresis.")));
        text + &curves
    }

    /// Stretch along a way (warp 0, weft 1) as a curve of two slopes, where the sheet says enough: KES's LT, RT and WT or EMT; FAST's
    /// three extensions, as long as they rise.
    fn curve(&self, way: usize) -> Option<StretchCurve> {
        let at = |name: &str| self.values.get(name).map(|v| v[way]);
        let curve = match self.kind {
            SheetKind::Kawabata => {
                let (linearity, resilience) = (at("LT")?, at("RT").unwrap_or(100.0) / 100.0);
                StretchCurve::of_kes(linearity, resilience, self.extension(way)?, KES_MOST * FORCE)
            }
            SheetKind::Fast => {
                let loads = [5.0, 20.0, 100.0].map(|gf| gf * FORCE);
                let [a, b, c] = [at("E5")?, at("E20")?, at("E100")?];
                // Three points say of two slopes only that the knee lies at the second of them.
                let knee = StretchCurve {
                    knee_percent: b as f32,
                    knee_n_m: loads[1] as f32,
                    beyond_n_m: (100.0 * (loads[2] - loads[1]) / (c - b)) as f32,
                    hysteresis_n_m: 0.0,
                };
                Some(knee).filter(|_| 0.0 < a && a < b && b < c)?
            }
            SheetKind::Cusick => return None,
        };
        // A curve that is straight, or bends down, is the one slope that the file has besides.
        let stiffens = curve.beyond_n_m > 1.05 * curve.below_n_m();
        (stiffens && curve.figures().iter().all(|f| f.is_finite())).then_some(curve)
    }

    fn curve_words(&self) -> &'static str {
        match self.kind {
            SheetKind::Kawabata => "LT, WT or EMT, RT: the knee on the line between (EMT, 0) and (0, 500 gf/cm)",
            _ => "E20 and E100",
        }
    }
}

/// Bending rigidity at 45 degrees that cloth of a rigidity along warp and weft usually has: 1 / sqrt(B) is the mean of both, which is Peirce's
/// rule (1930, "The handle of cloth as a measurable quantity"). Of the 251 distinct fabrics of Feng et al. 2022 the median is .99 of
/// it, and half lie between .70 and 1.37; of threads that know nothing of each other, (B_warp + B_weft) / 4, it is 1.8.
pub fn usual_bias(rigidities: [f64; 2]) -> Option<f64> {
    let [warp, weft] = rigidities.map(|b| b.sqrt().recip());
    let bias = 4.0 / (warp + weft).powi(2);
    (bias > 0.0 && bias.is_finite()).then_some(bias)
}

/// A figure with what it is made of: five digits, and its point, without which TOML takes it for no f64.
fn line(figure: &FileFigure, key: &str) -> String {
    let digits = (5 - figure.value.abs().max(1e-9).log10().ceil() as i32).clamp(1, 9) as usize;
    format!("# {}\n{key} = {:.digits$}\n", figure.from, figure.value)
}

#[cfg(test)]
mod tests {
    use super::*;

    const KES_SHEET: &str = "# cotton broad\nLT, 0.712\nWT, 9.0, 10.0\nRT, 54\nB, 0.118, 0.102\n2HB 0.124 0.11\nG; 0.8\n2HG\t1.5\n\
        2HG5 2.5\nLC .3\nWC .2\nRC 30\nT .6\nW 12.0\nMIU .18\nMMD .02\nSMD 4\nDC 62\n";

    fn figure(sheet: &MeasuredSheet, key: &str) -> f64 {
        sheet.figures().iter().find(|f| f.key == key).unwrap().value
    }

    #[test]
    fn a_kawabata_sheet_becomes_a_fabric() {
        let sheet = MeasuredSheet::parse(KES_SHEET).unwrap();
        assert_eq!(sheet.kind, SheetKind::Kawabata);
        assert!((figure(&sheet, "bend_warp_un_m") - 11.5718).abs() < 1e-3);
        assert!((figure(&sheet, "shear_n_m") - 0.8 * 56.188).abs() < 1e-2);
        // e = 2 WT / (LT F).
        assert!((figure(&sheet, "stretch_warp_n_m") - 490.3325 / (18.0 / (0.712 * 500.0))).abs() < 1e-6);
        let fabric =
            crate::fabric::parse("sheet", &sheet.file("broad", "Broad \"cloth\"", "cotton-lawn", "own laboratory"))
                .unwrap();
        assert!((fabric.hysteresis.bend_warp_mn - 1.21602).abs() < 1e-4 && fabric.drape_percent == Some(62.0));
        assert!((fabric.density_kg_m2 - 0.12).abs() < 1e-6 && (fabric.bend_weft_un_m - 10.0028).abs() < 1e-3);
        let [warp, _] = fabric.hysteresis.residual_curvatures([fabric.bend_warp_un_m, 1.0]);
        assert!((warp - 52.54).abs() < 0.01, "{warp}");
    }

    #[test]
    fn a_fast_sheet_becomes_a_fabric_without_loops() {
        let sheet =
            MeasuredSheet::parse("W 168\nC 15.0 14.5\nE5 1 1\nE20 2 2\nE100 2.5 4\nG 45\nT2 .65\nT100 .5").unwrap();
        assert_eq!(sheet.kind, SheetKind::Fast);
        // A published report of a plain wool: 5.56 and 5.02 uN m of 168 g/m2, 15.0 and 14.5 mm.
        assert!((figure(&sheet, "bend_warp_un_m") - 5.56).abs() < 0.01);
        assert!((figure(&sheet, "bend_weft_un_m") - 5.02).abs() < 0.01);
        assert!((figure(&sheet, "stretch_warp_n_m") - 3922.66).abs() < 0.1);
        let fabric = crate::fabric::parse("sheet", &sheet.file("wool", "Wool", "wool-suiting", "report")).unwrap();
        assert_eq!(fabric.hysteresis, Default::default());
    }

    #[test]
    fn along_the_bias_a_sheet_gives_what_is_usual() {
        assert!((usual_bias([20.0, 20.0]).unwrap() - 20.0).abs() < 1e-12);
        // Between both, nearer to the softer.
        let between = usual_bias([20.0, 5.0]).unwrap();
        assert!(between > 5.0 && between < 10.0, "{between}");
        assert_eq!(usual_bias([0.0, 5.0]), None);
        let sheet = MeasuredSheet::parse(KES_SHEET).unwrap();
        let fabric = crate::fabric::parse("sheet", &sheet.file("broad", "Broad", "cotton-lawn", "own")).unwrap();
        let bias = fabric.bend_bias_un_m.unwrap();
        assert!(bias > fabric.bend_weft_un_m && bias < fabric.bend_warp_un_m, "{bias}");
        assert_eq!(MeasuredSheet::parse("DC 60").unwrap().figures().len(), 1);
    }

    #[test]
    fn what_is_no_sheet_says_where() {
        let wrong = |text: &str| MeasuredSheet::parse(text).unwrap_err().to_string();
        assert!(wrong("B 0.1\n2HB much").contains("line 2"));
        assert!(wrong("B 0.1\nSHINE 3").contains("SHINE"));
        assert!(wrong("B 0.1").contains("2HB") && wrong("").contains("DC"));
        assert!(wrong("B NaN").contains("line 1") && wrong("B 1 2 3").contains("line 1"));
        assert_eq!(MeasuredSheet::parse("DC: 82.9").unwrap().kind, SheetKind::Cusick);
    }
}
