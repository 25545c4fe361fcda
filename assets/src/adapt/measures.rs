//! A mesh's own measures: a TOML file of the same name beside it says for whom it is made, of what, and in which sizes.

use serde::Deserialize;

use super::error::AdaptError;
use super::unit::UNITS;
use crate::sizes::{GarmentKind, Girth, Population, SizeBody, SizeTable};
use toile_base::body::{Measures, Sex};

/// Lengths of a body outside of these (mm) are in another unit.
const PLAUSIBLE_MM: [f32; 2] = [200.0, 2500.0];

/// The file. Every key may be left out; `kind`, `table` and `made_in` go together.
#[derive(Debug, Clone, Default, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct GarmentMeasures {
    /// Name by which it is shown.
    pub name: Option<String>,
    /// Name of a fabric that is built in.
    pub fabric: Option<String>,
    /// Its layer, as garments of the wardrobe have it.
    pub layer: Option<u8>,
    /// Unit of the mesh's numbers.
    pub unit: Option<String>,
    /// Its kind; decides its primary measures.
    pub kind: Option<GarmentKind>,
    /// Name of the size table.
    pub table: Option<String>,
    /// The size of that table in which the mesh is made.
    pub made_in: Option<String>,
    /// Girths of the finished garment in that size (mm); what is left out is measured on the mesh.
    #[serde(default)]
    pub finished_mm: ZoneLengths,
    /// The ease that a wearer finds good, least and most (mm).
    #[serde(default)]
    pub comfort_mm: ZoneRanges,
    /// The body that it is made for, where no table has it.
    pub made_for: Option<MadeForMeasures>,
}

/// A length for each zone (mm).
#[derive(Debug, Clone, Copy, Default, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ZoneLengths {
    /// At the chest.
    pub chest: Option<f32>,
    /// At the waist.
    pub waist: Option<f32>,
    /// At the hip.
    pub hip: Option<f32>,
}

/// A range for each zone (mm).
#[derive(Debug, Clone, Copy, Default, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ZoneRanges {
    /// At the chest.
    pub chest: Option<[f32; 2]>,
    /// At the waist.
    pub waist: Option<[f32; 2]>,
    /// At the hip.
    pub hip: Option<[f32; 2]>,
}

/// A body by its measures; what is left out is the average of its sex.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct MadeForMeasures {
    /// `female` or `male`.
    pub sex: BodySex,
    /// Stature (mm).
    pub stature_mm: Option<f32>,
    /// Girth of chest or bust (mm).
    pub chest_mm: Option<f32>,
    /// Girth of the waist (mm).
    pub waist_mm: Option<f32>,
    /// Girth of the hip (mm).
    pub hip_mm: Option<f32>,
}

/// A sex by its word.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum BodySex {
    /// A woman's body.
    Female,
    /// A man's body.
    Male,
}

impl From<BodySex> for Sex {
    fn from(sex: BodySex) -> Self {
        match sex {
            BodySex::Female => Self::Female,
            BodySex::Male => Self::Male,
        }
    }
}

impl ZoneLengths {
    /// The length at a zone (mm).
    pub const fn at(&self, zone: Girth) -> Option<f32> {
        match zone {
            Girth::Chest => self.chest,
            Girth::Waist => self.waist,
            Girth::Hip => self.hip,
        }
    }
}

impl ZoneRanges {
    /// The range at a zone (m).
    pub fn at(&self, zone: Girth) -> Option<[f32; 2]> {
        let range = match zone {
            Girth::Chest => self.chest,
            Girth::Waist => self.waist,
            Girth::Hip => self.hip,
        };
        range.map(|r| r.map(|mm| mm * 1e-3))
    }
}

impl MadeForMeasures {
    /// The measures of the body (m).
    pub fn measures(&self) -> Measures {
        let average = Measures::average(self.sex.into());
        let or = |mm: Option<f32>, m: f32| mm.map_or(m, |mm| mm * 1e-3);
        Measures {
            stature: or(self.stature_mm, average.stature),
            shoulder_breadth: average.shoulder_breadth * or(self.stature_mm, average.stature) / average.stature,
            chest_girth: or(self.chest_mm, average.chest_girth),
            waist_girth: or(self.waist_mm, average.waist_girth),
            hip_girth: or(self.hip_mm, average.hip_girth),
        }
    }
}

/// The sizes of a mesh that says in which one it is made.
#[derive(Debug, Clone, PartialEq)]
pub struct MeshSizes {
    /// The size table.
    pub table: SizeTable,
    /// The kind of garment.
    pub kind: GarmentKind,
    /// The size in which the mesh is made.
    pub made_in: String,
    /// The body of that size.
    pub body: SizeBody,
}

impl MeshSizes {
    /// Whose body a size is cut for.
    pub fn sex(&self) -> Sex {
        if self.table.population == Population::Men { Sex::Male } else { Sex::Female }
    }
}

impl GarmentMeasures {
    /// Reads the text of a file; `path` stands in the error messages.
    ///
    /// # Errors
    /// The line and the key at fault.
    pub fn parse(path: &str, text: &str) -> Result<Self, AdaptError> {
        let wrong = |line, reason| AdaptError::Measures { path: path.into(), line, reason };
        let own: Self = toml::from_str(text).map_err(|e| {
            let line = e.span().map_or(1, |s| text[..s.start.min(text.len())].matches('\n').count() + 1);
            wrong(line, e.message().lines().next().unwrap_or("it is not TOML").to_owned())
        })?;
        let line = |key: &str| text.lines().position(|l| l.trim_start().starts_with(key)).map_or(1, |i| i + 1);
        own.check().map_err(|(key, reason)| wrong(line(key), reason))?;
        Ok(own)
    }

    fn check(&self) -> Result<(), (&'static str, String)> {
        if let Some(unit) = &self.unit
            && !UNITS.iter().any(|(_, name)| name == unit)
        {
            let known = UNITS.map(|(_, name)| name).join(", ");
            return Err(("unit", format!("unit is \"{unit}\", which is none of {known}")));
        }
        let given = [self.kind.is_some(), self.table.is_some(), self.made_in.is_some()];
        if given.contains(&true) && given.contains(&false) {
            return Err(("", "of kind, table and made_in some are left out; give all three or none".into()));
        }
        if self.made_for.is_some() && self.table.is_some() {
            return Err(("made_for", "made_for stands beside table, which says it too; give one of them".into()));
        }
        let body = self.made_for.iter().flat_map(|m| [m.stature_mm, m.chest_mm, m.waist_mm, m.hip_mm]);
        let finished = Girth::ALL.map(|z| self.finished_mm.at(z));
        let [low, high] = PLAUSIBLE_MM;
        let wrong = body.chain(finished).flatten().find(|mm| !(low..=high).contains(mm));
        if let Some(mm) = wrong {
            return Err((
                "",
                format!("a length of {mm} mm is none of a body; lengths are millimetres between {low} and {high}"),
            ));
        }
        let falling = |r: [f32; 2]| r[0] > r[1] || !r[0].is_finite() || !r[1].is_finite();
        if Girth::ALL.iter().filter_map(|z| self.comfort_mm.at(*z)).any(falling) {
            return Err(("comfort_mm", "comfort_mm has a range that does not rise".into()));
        }
        Ok(())
    }

    /// The sizes, where the file gives any.
    ///
    /// # Errors
    /// A table or a size that there is not.
    pub fn sizes(&self) -> Result<Option<MeshSizes>, AdaptError> {
        let (Some(kind), Some(table), Some(made_in)) = (self.kind, &self.table, &self.made_in) else { return Ok(None) };
        let table = SizeTable::embedded(table)?;
        let body = table.size_body(made_in)?;
        Ok(Some(MeshSizes { table, kind, made_in: made_in.clone(), body }))
    }

    /// The unit of the mesh, where the file gives it.
    pub fn unit(&self) -> Option<(f32, &'static str)> {
        UNITS.into_iter().find(|(_, name)| self.unit.as_deref() == Some(*name))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const TEXT: &str = "name = \"Shift\"\nkind = \"dress\"\ntable = \"women\"\nmade_in = \"38\"\nunit = \"centimetres\"\n\
        finished_mm = { chest = 940 }\ncomfort_mm = { chest = [20, 90] }\n";

    #[test]
    fn sizes_are_those_of_the_table() {
        let own = GarmentMeasures::parse("a.toml", TEXT).unwrap();
        let sizes = own.sizes().unwrap().unwrap();
        assert_eq!((sizes.made_in.as_str(), sizes.sex()), ("38", Sex::Female));
        assert!((sizes.body.chest_girth - 0.88).abs() < 1e-6);
        assert_eq!(own.unit(), Some((0.01, "centimetres")));
        assert_eq!(GarmentMeasures::parse("a.toml", "").unwrap().sizes().unwrap(), None);
    }

    #[test]
    fn broken_files_are_refused_in_one_sentence_that_names_the_line() {
        for (from, to, expected) in [
            ("made_in = \"38\"\n", "", "give all three"),
            ("\"centimetres\"", "\"ells\"", "line 5: unit is \"ells\""),
            ("chest = 940", "chest = 94", "94 mm"),
            ("[20, 90]", "[90, 20]", "line 7"),
            ("name", "nam", "line 1"),
            ("kind = \"dress\"", "kind = \"hat\"", "line 2"),
            ("unit =", "made_for = { sex = \"female\" }\nunit =", "made_for stands beside table"),
        ] {
            let message = GarmentMeasures::parse("a.toml", &TEXT.replace(from, to)).unwrap_err().to_string();
            assert!(message.contains(expected) && message.contains("; ") && !message.contains('\n'), "{message}");
        }
        let unknown = GarmentMeasures::parse("a.toml", &TEXT.replace("\"38\"", "\"99\"")).unwrap().sizes();
        assert!(unknown.unwrap_err().to_string().contains("99"));
    }
}
