//! Clothes sizes after EN 13402: which body girths a size is made for, and which girth decides for which garment.
//!
//! Besides stand the bodies that FreeSewing's patterns are drafted on, as tables of their own.
//!
//! Part 2 of the standard names the primary and secondary measures of each kind of garment, part 3 tabulates them. The
//! tables are data (`data/sizes/*.toml`, centimetres as on a tape); here everything is in metres.

use serde::{Deserialize, Serialize};

use toile_base::body::{Measures, Sex};

toile_base::named! {
    /// The kind of a garment for sizing (EN 13402-2).
    #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Deserialize, Serialize)]
    pub enum GarmentKind {
        /// A dress.
        #[serde(rename = "dress")]
        Dress = "dress",
        /// A T-shirt.
        #[serde(rename = "t-shirt")]
        Tshirt = "t-shirt",
        /// A jacket.
        #[serde(rename = "jacket")]
        Jacket = "jacket",
        /// Trousers.
        #[serde(rename = "trousers")]
        Trousers = "trousers",
        /// A skirt.
        #[serde(rename = "skirt")]
        Skirt = "skirt",
    }
}

toile_base::named! {
    /// A girth of the body that designates sizes (EN 13402-1), from the top down.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Deserialize)]
    #[serde(rename_all = "lowercase")]
    pub enum Girth {
        /// Bust girth of a woman, chest girth of a man: horizontal, under the armpits, over the bust points.
        Chest = "chest",
        /// At the natural waistline, midway between the lowest rib and the top of the hip bone.
        Waist = "waist",
        /// At the greatest protrusion of the buttocks.
        Hip = "hip",
    }
}

impl GarmentKind {
    /// The ease that wearers of such a garment find good, at the girths that matter, least and most (m). A skirt sits on the
    /// waist as trousers do.
    pub const fn comfort(self) -> &'static [(Girth, [f32; 2])] {
        match self {
            Self::Dress => &[(Girth::Chest, [0.015, 0.08]), (Girth::Waist, [0.012, 0.075]), (Girth::Hip, [0.06, 0.4])],
            Self::Tshirt => &[(Girth::Chest, [0.01, 0.13]), (Girth::Hip, [0.0, 0.16])],
            Self::Jacket => &[(Girth::Chest, [0.08, 0.26]), (Girth::Hip, [0.06, 0.3])],
            Self::Trousers | Self::Skirt => &[(Girth::Waist, [0.0, 0.045]), (Girth::Hip, [0.025, 0.14])],
        }
    }
}

impl Girth {
    /// This girth of a body (m).
    pub const fn of(self, body: &Measures) -> f32 {
        match self {
            Self::Chest => body.chest_girth,
            Self::Waist => body.waist_girth,
            Self::Hip => body.hip_girth,
        }
    }
}

/// Whose bodies a table describes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Population {
    /// Women's bodies.
    Women,
    /// Men's bodies.
    Men,
    /// Both sexes: garments in unisex sizes, shoppers of unknown sex.
    Mixed,
}

impl From<Option<Sex>> for Population {
    /// Where a shopper's sex is unknown: the proportions of both together.
    fn from(sex: Option<Sex>) -> Self {
        match sex {
            Some(Sex::Female) => Self::Women,
            Some(Sex::Male) => Self::Men,
            None => Self::Mixed,
        }
    }
}

/// Girths that decide the size of one kind of garment (EN 13402-2).
#[derive(Debug, Clone, PartialEq, Eq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Designation {
    /// The kind of garment.
    pub garment: GarmentKind,
    /// Girths that the size is chosen by.
    pub primary: Vec<Girth>,
    /// Girths that the size also promises to fit.
    pub secondary: Vec<Girth>,
}

/// One size: the bodies that it is made for, as ranges (m), the upper end belonging to the next size.
#[derive(Debug, Clone, PartialEq)]
pub struct Size {
    /// Code of the size, as on the label.
    pub code: String,
    /// Chest or bust girth (m).
    pub chest: [f32; 2],
    /// Waist girth (m).
    pub waist: [f32; 2],
    /// Hip girth (m).
    pub hip: [f32; 2],
    /// Stature (m).
    pub stature: [f32; 2],
}

impl Size {
    /// The range of one girth (m).
    pub const fn range(&self, girth: Girth) -> [f32; 2] {
        match girth {
            Girth::Chest => self.chest,
            Girth::Waist => self.waist,
            Girth::Hip => self.hip,
        }
    }
}

/// The body in the middle of a size: what a garment of that size is cut for, all in metres.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SizeBody {
    /// Stature (m).
    pub stature: f32,
    /// Shoulder breadth between the acromions (m).
    pub shoulder_breadth: f32,
    /// Chest or bust girth (m).
    pub chest_girth: f32,
    /// Waist girth (m).
    pub waist_girth: f32,
    /// Hip girth (m).
    pub hip_girth: f32,
}

impl From<SizeBody> for Measures {
    fn from(b: SizeBody) -> Self {
        Self {
            stature: b.stature,
            shoulder_breadth: b.shoulder_breadth,
            chest_girth: b.chest_girth,
            waist_girth: b.waist_girth,
            hip_girth: b.hip_girth,
        }
    }
}

/// A table of sizes, smallest first.
#[derive(Debug, Clone, PartialEq)]
pub struct SizeTable {
    /// Name by which garments ask for it.
    pub name: String,
    /// Whose bodies it describes.
    pub population: Population,
    /// Source of the numbers.
    pub source: String,
    /// Deciding girths, by kind of garment.
    pub designations: Vec<Designation>,
    /// The sizes, each range starting where or after the one before it starts.
    pub sizes: Vec<Size>,
}

/// Why a size table cannot be used; each message says what, where, and the cure.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum SizeError {
    /// The text is no size table.
    #[error("size table {table}: line {line}: {reason}; compare it with the embedded table women.toml.")]
    Text {
        /// Name or file of the table.
        table: String,
        /// Line of the text, from 1.
        line: usize,
        /// Error of the parser.
        reason: String,
    },
    /// A table without sizes or without garments.
    #[error("size table {table}: it has no {what}; give it at least one.")]
    Empty {
        /// Name of the table.
        table: String,
        /// `[[sizes]]`, `[[designations]]` or the primary measures of one.
        what: &'static str,
    },
    /// A range that is empty, reversed, not finite or not of a human body.
    #[error("size table {table}: size {code}: {measure} must be two rising lengths between 20 and 250 cm; correct it.")]
    Range {
        /// Name of the table.
        table: String,
        /// Code of the size.
        code: String,
        /// Name of the measure.
        measure: &'static str,
    },
    /// Sizes out of order, or the same code twice.
    #[error(
        "size table {table}: size {code} repeats an earlier code or is not larger than the size before it; put the \
         sizes in rising order."
    )]
    Order {
        /// Name of the table.
        table: String,
        /// Code of the size.
        code: String,
    },
    /// A size that the table does not have.
    #[error("size {code} is not in the size table {table}; choose one of {codes}.")]
    UnknownSize {
        /// Name of the table.
        table: String,
        /// Code that was asked for.
        code: String,
        /// Codes of the sizes that there are.
        codes: String,
    },
    /// A table that was not embedded.
    #[error("there is no size table {name}; choose one of {names}.")]
    UnknownTable {
        /// Name that was asked for.
        name: String,
        /// Names of the tables that there are.
        names: String,
    },
}

/// The embedded tables: name and text.
const EMBEDDED: [(&str, &str); 7] = [
    ("women", include_str!("../data/sizes/women.toml")),
    ("women-letters", include_str!("../data/sizes/women-letters.toml")),
    ("men", include_str!("../data/sizes/men.toml")),
    ("men-trousers", include_str!("../data/sizes/men-trousers.toml")),
    ("unisex", include_str!("../data/sizes/unisex.toml")),
    ("freesewing-women", include_str!("../data/sizes/freesewing-women.toml")),
    ("freesewing-men", include_str!("../data/sizes/freesewing-men.toml")),
];

/// Shoulder breadth (m) = a + b stature + c chest girth, least squares over ANSUR II (biacromial breadth; public
/// domain): 1,986 women, residual 14.9 mm; 4,082 men, 14.3 mm; as many women as men, 17.3 mm.
const SHOULDER_WOMEN: [f32; 3] = [0.089_24, 0.149_93, 0.033_75];
const SHOULDER_MEN: [f32; 3] = [0.109_13, 0.120_18, 0.090_20];
const SHOULDER_MIXED: [f32; 3] = [-0.065_98, 0.211_44, 0.098_29];

/// Lengths outside of this (m) are a slip of the pen, not a body.
const PLAUSIBLE: [f32; 2] = [0.2, 2.5];

impl SizeTable {
    /// An embedded table by its name: `women`, `women-letters`, `men`, `men-trousers` or `unisex` after EN 13402, or
    /// `freesewing-women` or `freesewing-men`.
    pub fn embedded(name: &str) -> Result<Self, SizeError> {
        match EMBEDDED.iter().find(|(known, _)| *known == name) {
            Some((known, text)) => Self::parse(known, text),
            None => Err(SizeError::UnknownTable { name: name.to_owned(), names: Self::embedded_names().join(", ") }),
        }
    }

    /// Names of the embedded tables.
    pub fn embedded_names() -> Vec<&'static str> {
        EMBEDDED.iter().map(|(name, _)| *name).collect()
    }

    /// Reads a table from TOML; `origin` (a file name) stands in the error message.
    pub fn parse(origin: &str, text: &str) -> Result<Self, SizeError> {
        let raw: RawTable = toml::from_str(text).map_err(|e| SizeError::Text {
            table: origin.to_owned(),
            line: e.span().map_or(1, |s| text[..s.start.min(text.len())].matches('\n').count() + 1),
            reason: e.message().lines().next().unwrap_or("it is not TOML").to_owned(),
        })?;
        let stature = raw.stature_cm;
        let table = Self {
            name: raw.name,
            population: raw.population,
            source: raw.source,
            designations: raw.designations,
            sizes: raw.sizes.into_iter().map(|s| s.in_metres(stature)).collect(),
        };
        table.check()?;
        Ok(table)
    }

    /// Girths that decide the size of a garment; `None` if the table is not made for its kind.
    pub fn designation(&self, garment: GarmentKind) -> Option<&Designation> {
        self.designations.iter().find(|d| d.garment == garment)
    }

    /// Finds a size by its code.
    pub fn size(&self, code: &str) -> Result<&Size, SizeError> {
        self.sizes.iter().find(|s| s.code == code).ok_or_else(|| SizeError::UnknownSize {
            table: self.name.clone(),
            code: code.to_owned(),
            codes: self.codes().join(", "),
        })
    }

    /// The codes, smallest size first.
    pub fn codes(&self) -> Vec<&str> {
        self.sizes.iter().map(|s| s.code.as_str()).collect()
    }

    /// The body in the middle of a size. Girths and stature are the middles of the size's ranges; the shoulder breadth,
    /// which no size promises, is what ANSUR II bodies of that stature and chest have on average.
    pub fn size_body(&self, code: &str) -> Result<SizeBody, SizeError> {
        let size = self.size(code)?;
        let middle = |r: [f32; 2]| (r[0] + r[1]) * 0.5;
        let [a, b, c] = match self.population {
            Population::Women => SHOULDER_WOMEN,
            Population::Men => SHOULDER_MEN,
            Population::Mixed => SHOULDER_MIXED,
        };
        let (stature, chest_girth) = (middle(size.stature), middle(size.chest));
        Ok(SizeBody {
            stature,
            shoulder_breadth: a + b * stature + c * chest_girth,
            chest_girth,
            waist_girth: middle(size.waist),
            hip_girth: middle(size.hip),
        })
    }

    fn check(&self) -> Result<(), SizeError> {
        let empty = |what| Err(SizeError::Empty { table: self.name.clone(), what });
        if self.sizes.is_empty() {
            return empty("[[sizes]]");
        }
        if self.designations.is_empty() {
            return empty("[[designations]]");
        }
        if self.designations.iter().any(|d| d.primary.is_empty()) {
            return empty("primary measure in a designation");
        }
        for (i, size) in self.sizes.iter().enumerate() {
            self.check_ranges(size)?;
            let rises = i == 0 || Girth::ALL.iter().all(|&g| size.range(g)[0] > self.sizes[i - 1].range(g)[0]);
            if !rises || self.sizes[..i].iter().any(|s| s.code == size.code) {
                return Err(SizeError::Order { table: self.name.clone(), code: size.code.clone() });
            }
        }
        Ok(())
    }

    fn check_ranges(&self, size: &Size) -> Result<(), SizeError> {
        let ranges =
            [("chest_cm", size.chest), ("waist_cm", size.waist), ("hip_cm", size.hip), ("stature_cm", size.stature)];
        // Written so that NaN, which compares false with everything, is refused.
        let good = |[low, high]: [f32; 2]| low >= PLAUSIBLE[0] && low < high && high <= PLAUSIBLE[1];
        match ranges.into_iter().find(|(_, r)| !good(*r)) {
            Some((measure, _)) => Err(SizeError::Range { table: self.name.clone(), code: size.code.clone(), measure }),
            None => Ok(()),
        }
    }
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct RawTable {
    name: String,
    population: Population,
    source: String,
    stature_cm: [f32; 2],
    designations: Vec<Designation>,
    sizes: Vec<RawSize>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct RawSize {
    code: String,
    chest_cm: [f32; 2],
    waist_cm: [f32; 2],
    hip_cm: [f32; 2],
    /// Where sizes grow in height too; else that of the table.
    stature_cm: Option<[f32; 2]>,
}

impl RawSize {
    fn in_metres(self, stature_cm: [f32; 2]) -> Size {
        let metres = |r: [f32; 2]| r.map(|cm| cm / 100.0);
        Size {
            code: self.code,
            chest: metres(self.chest_cm),
            waist: metres(self.waist_cm),
            hip: metres(self.hip_cm),
            stature: metres(self.stature_cm.unwrap_or(stature_cm)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_embedded_table_reads_and_names_itself() {
        for name in SizeTable::embedded_names() {
            let table = SizeTable::embedded(name).unwrap();
            assert_eq!(table.name, name);
            assert!(table.source.starts_with(if name.contains("freesewing") { "FreeSewing" } else { "EN 13402-3" }));
            for code in table.codes() {
                let body = table.size_body(code).unwrap();
                assert!((0.30..0.50).contains(&body.shoulder_breadth), "{name} {code}: {body:?}");
            }
        }
    }

    #[test]
    fn sizes_leave_no_girth_between_them() {
        for name in SizeTable::embedded_names() {
            let table = SizeTable::embedded(name).unwrap();
            for (pair, girth) in table.sizes.windows(2).flat_map(|p| Girth::ALL.map(|g| (p, g))) {
                assert_eq!(pair[0].range(girth)[1], pair[1].range(girth)[0], "{name} {} {girth:?}", pair[0].code);
            }
        }
    }

    #[test]
    fn size_38_is_the_body_that_the_standard_prints_on_its_pictogram() {
        // 88-72-96 is the dress of EN 13402-1's example label.
        let body = SizeTable::embedded("women").unwrap().size_body("38").unwrap();
        for (got, want) in [(body.chest_girth, 0.88), (body.waist_girth, 0.72), (body.hip_girth, 0.96)] {
            assert!((got - want).abs() < 1e-6, "{body:?}");
        }
    }

    #[test]
    fn primary_measures_follow_part_2() {
        let women = SizeTable::embedded("women").unwrap();
        assert_eq!(women.designation(GarmentKind::Dress).unwrap().primary, [Girth::Chest]);
        assert_eq!(women.designation(GarmentKind::Tshirt).unwrap().primary, [Girth::Chest]);
        assert_eq!(women.designation(GarmentKind::Jacket).unwrap().primary, [Girth::Chest]);
        let trousers = women.designation(GarmentKind::Trousers).unwrap();
        assert_eq!(
            (trousers.primary.as_slice(), trousers.secondary.as_slice()),
            (&[Girth::Waist][..], &[Girth::Hip][..])
        );
        assert!(SizeTable::embedded("men").unwrap().designation(GarmentKind::Dress).is_none());
    }

    #[test]
    fn bad_tables_are_refused_in_one_sentence() {
        let good = EMBEDDED[0].1;
        let bad = [
            (good.replace("chest_cm = [86, 90]", "chest_cm = [90, 86]"), "size 38: chest_cm"),
            (good.replace("chest_cm = [86, 90]", "chest_cm = [nan, 90]"), "size 38: chest_cm"),
            (good.replace("chest_cm = [86, 90]", "chest_cm = [0.86, 0.9]"), "size 38: chest_cm"),
            (good.replace("code = \"40\"", "code = \"38\""), "size 38 repeats"),
            (good.replace("source", "sauce"), "line 7"),
            (good.replace("waist_cm = [70, 74]", "girdle_cm = [70, 74]"), "girdle_cm"),
            (good.replace("primary = [\"waist\"]", "primary = []"), "primary measure"),
            (good[..good.len() - 9].to_owned(), "line"),
            (String::new(), "line 1"),
        ];
        for (text, part) in bad {
            let message = SizeTable::parse("table.toml", &text).unwrap_err().to_string();
            assert!(message.contains(part), "{part}: {message}");
            assert!(message.ends_with('.') && !message.contains('\n'), "{message}");
        }
    }

    #[test]
    fn unknown_sizes_and_tables_name_the_known_ones() {
        let message = SizeTable::embedded("women").unwrap().size("XL").unwrap_err().to_string();
        assert!(message.contains("32, 34, 36"), "{message}");
        let message = SizeTable::embedded("elves").unwrap_err().to_string();
        assert!(message.contains("women-letters"), "{message}");
    }
}
