//! Fabrics in physical units, from TOML.

use serde::Deserialize;
use thiserror::Error;

/// One fabric, as its file states it. Stiffnesses are per unit width of cloth, so that they do not depend on any mesh.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Fabric {
    /// The name by which garment files call it.
    pub name: String,
    /// Name for shoppers.
    pub title: String,
    /// Mass per area (kg/m2).
    pub density_kg_m2: f32,
    /// Tensile stiffness along the warp (N/m); infinite is inextensible.
    pub stretch_warp_n_m: f32,
    /// Tensile stiffness along the weft (N/m); infinite is inextensible.
    pub stretch_weft_n_m: f32,
    /// Shear stiffness (N/m per radian).
    pub shear_n_m: f32,
    /// Bending rigidity along the warp (uN m).
    pub bend_warp_un_m: f32,
    /// Bending rigidity along the weft (uN m).
    pub bend_weft_un_m: f32,
    /// Bending rigidity along the bias (uN m). Cloth without it bends as two families of threads that know nothing of
    /// each other: along the bias a quarter of what warp and weft have together.
    pub bend_bias_un_m: Option<f32>,
    /// Coulomb friction coefficient against the body.
    pub friction: f32,
    /// Rate at which motion through the air is damped (1/s).
    pub damping_per_s: f32,
    /// Gap kept between the cloth's middle surface and a collider (mm): half the thickness and the pile.
    pub contact_offset_mm: f32,
    /// Thickness of the cloth as it lies on other cloth, with its pile (mm): layers keep half of both apart.
    #[serde(default = "usual_thickness")]
    pub thickness_mm: f32,
    /// Stretch that a wearer still finds comfortable (1): the fit map's full scale.
    pub comfortable_stretch: f32,
    /// Base colour of the cloth, sRGB 0..1.
    pub colour: [f32; 3],
    /// How its threads run, as pictures show them.
    #[serde(default)]
    pub weave: Weave,
    /// Threads in a centimetre along the weft and along the warp; of a knit, columns and rows of stitches (1/cm).
    #[serde(default = "usual_threads")]
    pub threads_per_cm: [f32; 2],
    /// Strength of the sheen at the most grazing angle, as pictures show it (0..1).
    #[serde(default = "usual_sheen")]
    pub sheen: f32,
}

/// How threads run.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Weave {
    /// Each weft thread over one warp thread and under the next.
    #[default]
    Plain,
    /// Over two and under two, each row one thread further: a diagonal rib.
    Twill,
    /// Weft knit, the right side: columns of V-shaped stitches.
    Knit,
}

/// Threads of a shirting, where a file does not say (1/cm).
pub const USUAL_THREADS: [f32; 2] = [24.0; 2];

/// Sheen of matt cotton, where a file does not say.
pub const USUAL_SHEEN: f32 = 0.35;

/// Thickness of a shirting with its pile, where a file does not say (mm).
pub const USUAL_THICKNESS_MM: f32 = 3.0;

fn usual_thickness() -> f32 {
    USUAL_THICKNESS_MM
}

fn usual_threads() -> [f32; 2] {
    USUAL_THREADS
}

fn usual_sheen() -> f32 {
    USUAL_SHEEN
}

/// What can be wrong with a fabric file.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum FabricError {
    /// Not a fabric file.
    #[error("fabric {name}: {reason}; compare it with a fabric that is built in")]
    Syntax {
        /// The file or the embedded fabric.
        name: String,
        /// What the parser says, on one line.
        reason: String,
    },
    /// A figure outside of what cloth can have.
    #[error("fabric {name}: {key} is {value}, which no cloth has; give a value between {low} and {high}")]
    Range {
        /// Name of the fabric.
        name: String,
        /// Name of the key that is wrong.
        key: &'static str,
        /// Value of the key, in its unit.
        value: f32,
        /// Lowest accepted value.
        low: f32,
        /// Highest accepted value.
        high: f32,
    },
    /// No fabric of that name.
    #[error("there is no fabric named {name}; built in are {known}")]
    Unknown {
        /// The name asked for.
        name: String,
        /// The names there are.
        known: String,
    },
}

/// The fabrics that are built in.
const BUILT_IN: [&str; 4] = [
    include_str!("../data/fabrics/cotton-lawn.toml"),
    include_str!("../data/fabrics/cotton-jersey.toml"),
    include_str!("../data/fabrics/linen-twill.toml"),
    include_str!("../data/fabrics/wool-suiting.toml"),
];

impl Fabric {
    /// Reads one fabric from TOML; `name` says in errors where the text came from.
    pub fn parse(name: &str, text: &str) -> Result<Self, FabricError> {
        let fabric: Self = toml::from_str(text)
            .map_err(|e| FabricError::Syntax { name: name.into(), reason: e.message().replace('\n', " ") })?;
        fabric.check()?;
        Ok(fabric)
    }

    /// The built-in fabric of that name.
    pub fn built_in(name: &str) -> Result<Self, FabricError> {
        let all = Self::all()?;
        let known = all.iter().map(|f| f.name.as_str()).collect::<Vec<_>>().join(", ");
        all.into_iter().find(|f| f.name == name).ok_or(FabricError::Unknown { name: name.into(), known })
    }

    /// Every built-in fabric.
    pub fn all() -> Result<Vec<Self>, FabricError> {
        BUILT_IN.iter().map(|text| Self::parse("built in", text)).collect()
    }

    /// Accepted figures, lowest and highest: from the thinnest silk to canvas, an order of magnitude wider than the 618
    /// fabrics that were measured for the published bands (REFERENCES: density .031 to .487 kg/m2, bending rigidity .9
    /// to 109 uN m).
    pub const RANGES: [(&'static str, f32, f32); 11] = [
        ("density_kg_m2", 0.01, 2.0),
        ("stretch_warp_n_m", 10.0, f32::INFINITY),
        ("stretch_weft_n_m", 10.0, f32::INFINITY),
        ("shear_n_m", 1.0, 1e5),
        ("bend_warp_un_m", 0.0, 1e4),
        ("bend_weft_un_m", 0.0, 1e4),
        ("bend_bias_un_m", 0.0, 1e4),
        ("friction", 0.0, 2.0),
        ("damping_per_s", 0.0, 100.0),
        ("contact_offset_mm", 0.1, 20.0),
        ("thickness_mm", 0.1, 40.0),
    ];

    /// One of the figures of [`Self::RANGES`], if it is given.
    fn figure(&self, key: &str) -> Option<f32> {
        Some(match key {
            "density_kg_m2" => self.density_kg_m2,
            "stretch_warp_n_m" => self.stretch_warp_n_m,
            "stretch_weft_n_m" => self.stretch_weft_n_m,
            "shear_n_m" => self.shear_n_m,
            "bend_warp_un_m" => self.bend_warp_un_m,
            "bend_weft_un_m" => self.bend_weft_un_m,
            "bend_bias_un_m" => return self.bend_bias_un_m,
            "friction" => self.friction,
            "damping_per_s" => self.damping_per_s,
            "contact_offset_mm" => self.contact_offset_mm,
            "thickness_mm" => self.thickness_mm,
            _ => return None,
        })
    }

    /// Changes one of the figures of [`Self::RANGES`]; other keys are passed over.
    pub fn set_figure(&mut self, key: &str, value: f32) {
        match key {
            "density_kg_m2" => self.density_kg_m2 = value,
            "stretch_warp_n_m" => self.stretch_warp_n_m = value,
            "stretch_weft_n_m" => self.stretch_weft_n_m = value,
            "shear_n_m" => self.shear_n_m = value,
            "bend_warp_un_m" => self.bend_warp_un_m = value,
            "bend_weft_un_m" => self.bend_weft_un_m = value,
            "bend_bias_un_m" => self.bend_bias_un_m = Some(value),
            "friction" => self.friction = value,
            "damping_per_s" => self.damping_per_s = value,
            "contact_offset_mm" => self.contact_offset_mm = value,
            "thickness_mm" => self.thickness_mm = value,
            _ => {}
        }
    }

    fn check(&self) -> Result<(), FabricError> {
        let checked = |key, value: f32, low: f32, high: f32| match (low..=high).contains(&value) {
            true => Ok(()),
            false => Err(FabricError::Range { name: self.name.clone(), key, value, low, high }),
        };
        for (key, low, high) in Self::RANGES {
            self.figure(key).map_or(Ok(()), |value| checked(key, value, low, high))?;
        }
        checked("comfortable_stretch", self.comfortable_stretch, 0.001, 1.0)?;
        self.colour.iter().try_for_each(|&part| checked("colour", part, 0.0, 1.0))?;
        self.threads_per_cm.iter().try_for_each(|&count| checked("threads_per_cm", count, 1.0, 200.0))?;
        checked("sheen", self.sheen, 0.0, 1.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn built_in_fabrics_are_valid_and_found_by_name() {
        for fabric in Fabric::all().unwrap() {
            assert_eq!(Fabric::built_in(&fabric.name).unwrap(), fabric);
        }
        let error = Fabric::built_in("tin").unwrap_err().to_string();
        assert!(error.contains("tin") && error.contains("cotton-lawn"), "{error}");
    }

    #[test]
    fn threads_are_read_and_have_usual_figures() {
        let text = include_str!("../data/fabrics/linen-twill.toml");
        let twill = Fabric::parse("twill", text).unwrap();
        assert_eq!((twill.weave, twill.threads_per_cm), (Weave::Twill, [18.0, 16.0]));
        let silent = text.lines().filter(|l| !["weave", "threads", "sheen"].iter().any(|k| l.starts_with(k)));
        let usual = Fabric::parse("usual", &silent.collect::<Vec<_>>().join("\n")).unwrap();
        assert_eq!((usual.weave, usual.threads_per_cm, usual.sheen), (Weave::Plain, USUAL_THREADS, USUAL_SHEEN));
        let gauze = text.replace("[18.0, 16.0]", "[18.0, 0.0]");
        assert!(Fabric::parse("gauze", &gauze).unwrap_err().to_string().contains("threads_per_cm"));
        assert!(Fabric::parse("felt", &text.replace("\"twill\"", "\"felt\"")).is_err());
    }

    #[test]
    fn an_infinite_stiffness_is_inextensible() {
        let text = include_str!("../data/fabrics/cotton-lawn.toml");
        let tape = text.replace("stretch_warp_n_m = 6000.0", "stretch_warp_n_m = inf");
        assert_eq!(Fabric::parse("tape", &tape).unwrap().stretch_warp_n_m, f32::INFINITY);
        let sheared = text.replace("shear_n_m = 60.0", "shear_n_m = inf");
        assert!(Fabric::parse("sheared", &sheared).unwrap_err().to_string().contains("shear_n_m"));
    }

    #[test]
    fn every_figure_can_be_changed_and_is_checked() {
        for (key, low, high) in Fabric::RANGES {
            let mut fabric = Fabric::built_in("cotton-lawn").unwrap();
            fabric.set_figure(key, high);
            assert_eq!((fabric.figure(key), fabric.check()), (Some(high), Ok(())), "{key}");
            fabric.set_figure(key, low - 1.0);
            assert!(fabric.check().unwrap_err().to_string().contains(key), "{key}");
        }
    }

    #[test]
    fn nonsense_is_refused_with_key_and_cure() {
        let text = include_str!("../data/fabrics/cotton-lawn.toml");
        let heavy = text.replace("density_kg_m2 = 0.105", "density_kg_m2 = nan");
        assert_ne!(heavy, text);
        assert!(Fabric::parse("heavy", &heavy).unwrap_err().to_string().contains("density_kg_m2"));
        assert!(
            Fabric::parse("odd", &format!("{text}\nstiffness = 0.8\n")).unwrap_err().to_string().contains("stiffness")
        );
        assert!(matches!(Fabric::parse("empty", ""), Err(FabricError::Syntax { .. })));
        let bias = |value: f32| {
            Fabric::parse("bias", &text.replace("friction", &format!("bend_bias_un_m = {value:?}\nfriction")))
        };
        assert_eq!(bias(3.0).unwrap().bend_bias_un_m, Some(3.0));
        assert!(bias(-1.0).unwrap_err().to_string().contains("bend_bias_un_m"));
    }
}
