//! Fabrics in physical units, from TOML, and what they look like.
//!
//! Reads: a fabric's file, and the picture that its print names. Writes: an immutable [`Fabric`].
//! Budget: 10 ms a fabric with a print, at load only. Thread: the loading thread.

pub mod friction_element;
pub mod link_law;
pub mod loop_widths;
pub mod print;
pub mod sheet;
pub mod stretch_curve;

use std::sync::Arc;

use serde::Deserialize;
use thiserror::Error;
use toml::{Table, Value};

use crate::texture::Texture;
use crate::toml_keys::nearest;
use loop_widths::LoopWidths;
use print::Print;
use stretch_curve::{ShearLock, StretchCurve, StretchCurves};

/// One fabric, as its file states it. Stiffnesses are per unit width of cloth, so that they do not depend on any mesh.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Fabric {
    /// The name by which garment files call it.
    pub name: String,
    /// Name for shoppers.
    pub title: String,
    /// Where its figures were published or measured.
    #[serde(default)]
    pub source: Option<String>,
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
    /// Share of light that the threads hold back where cloth is seen against the light (0..1): a voile has gaps.
    #[serde(default = "opaque")]
    pub opacity: f32,
    /// Cusick's drape coefficient as measured (%): reported beside the rest, never fitted to.
    #[serde(default)]
    pub drape_percent: Option<f32>,
    /// Widths of its measured loops; none where it was not measured, and then nothing of it costs anything.
    #[serde(default)]
    pub hysteresis: LoopWidths,
    /// Its stretch as curves of two slopes; a way without one has the one slope above.
    #[serde(default)]
    pub stretch: StretchCurves,
    /// Where its shear locks; none where it was not measured.
    pub shear_lock: Option<ShearLock>,
    /// Whether threads that are pushed together give way as arcs between particles, in place of bearing as much as they pull.
    #[serde(default)]
    pub buckling: bool,
    /// What is printed on it or woven into it.
    pub print: Option<Print>,
    /// One repeat of the print, drawn or read.
    #[serde(skip)]
    pub tile: Option<Arc<Texture>>,
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

fn opaque() -> f32 {
    1.0
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
    #[error("there is no fabric named {name}; {hint}`toile fabric list` names those that are built in")]
    Unknown {
        /// The name asked for.
        name: String,
        /// Asks whether a name that is near was meant; empty where none is.
        hint: String,
    },
    /// A print that cannot be drawn.
    #[error("fabric {name}: {reason}; see docs/catalogue.md")]
    Print {
        /// Name of the fabric.
        name: String,
        /// Key and reason.
        reason: String,
    },
}

/// The fabrics that are built in.
const BUILT_IN: [&str; 39] = [
    include_str!("../data/fabrics/cotton-lawn.toml"),
    include_str!("../data/fabrics/cotton-jersey.toml"),
    include_str!("../data/fabrics/linen-twill.toml"),
    include_str!("../data/fabrics/wool-suiting.toml"),
    include_str!("../data/fabrics/cotton-voile.toml"),
    include_str!("../data/fabrics/lawn-gingham.toml"),
    include_str!("../data/fabrics/lawn-flowers.toml"),
    include_str!("../data/fabrics/shirting-stripe.toml"),
    include_str!("../data/fabrics/jersey-breton.toml"),
    include_str!("../data/fabrics/jersey-dots.toml"),
    include_str!("../data/fabrics/linen-stripe.toml"),
    include_str!("../data/fabrics/wool-houndstooth.toml"),
    include_str!("../data/fabrics/wool-herringbone.toml"),
    include_str!("../data/fabrics/wool-windowpane.toml"),
    include_str!("../data/fabrics/interlock.toml"),
    include_str!("../data/fabrics/denim-11oz.toml"),
    include_str!("../data/fabrics/ponte.toml"),
    include_str!("../data/fabrics/rib-knit.toml"),
    include_str!("../data/fabrics/sweat-knit.toml"),
    include_str!("../data/fabrics/blanket-fleece.toml"),
    include_str!("../data/fabrics/cotton-trousering.toml"),
    include_str!("../data/fabrics/jacket-polyester.toml"),
    include_str!("../data/fabrics/table-polyester.toml"),
    include_str!("../data/fabrics/swim-knit.toml"),
    include_str!("../data/fabrics/cotton-broad.toml"),
    include_str!("../data/fabrics/wool-tropical.toml"),
    include_str!("../data/fabrics/polyester-faille.toml"),
    include_str!("../data/fabrics/denim-tropical.toml"),
    include_str!("../data/fabrics/scarf-wool.toml"),
    include_str!("../data/fabrics/scarf-tartan.toml"),
    include_str!("../data/fabrics/scarf-college.toml"),
    include_str!("../data/fabrics/scarf-camel.toml"),
    include_str!("../data/fabrics/fine-lawn.toml"),
    include_str!("../data/fabrics/silk-chiffon.toml"),
    include_str!("../data/fabrics/silk-crepe.toml"),
    include_str!("../data/fabrics/silk-satin.toml"),
    include_str!("../data/fabrics/linen-plain.toml"),
    include_str!("../data/fabrics/wool-flannel.toml"),
    include_str!("../data/fabrics/wool-gabardine.toml"),
];

/// The name in the text of a built-in fabric, whose file has it in a line of its own.
fn name_in(text: &'static str) -> Option<&'static str> {
    text.lines().find_map(|line| line.strip_prefix("name = "))?.strip_prefix('"')?.strip_suffix('"')
}

/// A fabric's text with what it leaves out as the built-in fabric `base` has it.
fn whole(name: &str, base: &str, text: &str) -> Result<Table, FabricError> {
    let table = |text: &str| toml::from_str::<Table>(text);
    let all = BUILT_IN.iter().filter_map(|text| table(text).ok());
    let known = all.filter(|t| !t.contains_key("base"));
    let names = known.clone().filter_map(|t| t.get("name")?.as_str().map(str::to_owned));
    let mut whole = known.clone().find(|t| t.get("name").and_then(Value::as_str) == Some(base)).ok_or_else(|| {
        let reason = format!("its base is {base}, which is none of {}", names.collect::<Vec<_>>().join(", "));
        FabricError::Syntax { name: name.into(), reason }
    })?;
    let own = table(text).unwrap_or_default();
    whole.extend(own.into_iter().filter(|(key, _)| key != "base"));
    Ok(whole)
}

impl Fabric {
    /// Reads one fabric from TOML; `name` says in errors where the text came from. A picture that it names is not read.
    ///
    /// # Errors
    /// A text that is no fabric, a figure that no cloth has.
    pub fn parse(name: &str, text: &str) -> Result<Self, FabricError> {
        let wrong =
            |e: toml::de::Error| FabricError::Syntax { name: name.into(), reason: e.message().replace('\n', " ") };
        let mut fabric: Self = match toml::from_str::<Table>(text).map_err(wrong)?.get("base").and_then(Value::as_str) {
            Some(base) => whole(name, base, text)?.try_into().map_err(wrong)?,
            None => toml::from_str(text).map_err(wrong)?,
        };
        fabric.check()?;
        fabric.tile = fabric.print.as_ref().and_then(Print::draw);
        Ok(fabric)
    }

    /// Reads the picture that its print names, if it names one; `read` gives the bytes of a file beside the fabric's.
    ///
    /// # Errors
    /// A picture that is not there, or is none.
    pub fn read_picture(&mut self, read: impl FnOnce(&str) -> Result<Vec<u8>, String>) -> Result<(), FabricError> {
        let Some(picture) = self.print.as_ref().and_then(|print| print.picture.as_deref()) else { return Ok(()) };
        let tile = read(picture).and_then(|bytes| Texture::decode(&bytes));
        let wrong = |reason| FabricError::Print { name: self.name.clone(), reason: format!("{picture}: {reason}") };
        self.tile = Some(Arc::new(tile.map_err(wrong)?));
        Ok(())
    }

    /// The built-in fabric of that name.
    pub fn built_in(name: &str) -> Result<Self, FabricError> {
        match BUILT_IN.iter().find(|text| name_in(text) == Some(name)) {
            Some(text) => Self::parse("built in", text),
            None => {
                let near = nearest(name, Self::names().into_iter());
                let hint = near.map_or_else(String::new, |meant| format!("did you mean \"{meant}\"? "));
                Err(FabricError::Unknown { name: name.into(), hint })
            }
        }
    }

    /// Names of all built-in fabrics.
    pub fn names() -> Vec<&'static str> {
        BUILT_IN.iter().filter_map(|text| name_in(text)).collect()
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

    /// Whether its links have more than one slope, or rub.
    pub fn has_link_laws(&self) -> bool {
        let StretchCurves { warp, weft } = self.stretch;
        warp.is_some()
            || weft.is_some()
            || self.shear_lock.is_some()
            || self.hysteresis.shear_n_m > 0.0
            || self.buckling
    }

    /// Whether its shear or its stretch rubs.
    pub fn rubs_in_links(&self) -> bool {
        let curves = [self.stretch.warp, self.stretch.weft];
        self.hysteresis.shear_n_m > 0.0 || curves.iter().flatten().any(|c| c.hysteresis_n_m > 0.0)
    }

    /// The same with its stretch below the knees (0) or behind them (1).
    pub fn with_slopes(&self, which: usize) -> Self {
        let of = |curve: Option<StretchCurve>, plain: f32| {
            curve.map_or(plain, |c| if which == 0 { c.below_n_m() } else { c.beyond_n_m })
        };
        let StretchCurves { warp, weft } = self.stretch;
        Self {
            stretch_warp_n_m: of(warp, self.stretch_warp_n_m),
            stretch_weft_n_m: of(weft, self.stretch_weft_n_m),
            ..self.clone()
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
        for ((key, low, high), width) in LoopWidths::RANGES.into_iter().zip(self.hysteresis.figures()) {
            checked(key, width, low, high)?;
        }
        for curve in [self.stretch.warp, self.stretch.weft].into_iter().flatten() {
            for ((key, low, high), figure) in StretchCurve::RANGES.into_iter().zip(curve.figures()) {
                checked(key, figure, low, high)?;
            }
        }
        if let Some(lock) = self.shear_lock {
            for ((key, low, high), figure) in ShearLock::RANGES.into_iter().zip([lock.degrees, lock.beyond_n_m]) {
                checked(key, figure, low, high)?;
            }
        }
        checked("drape_percent", self.drape_percent.unwrap_or(50.0), 0.0, 100.0)?;
        checked("comfortable_stretch", self.comfortable_stretch, 0.001, 1.0)?;
        self.colour.iter().try_for_each(|&part| checked("colour", part, 0.0, 1.0))?;
        self.threads_per_cm.iter().try_for_each(|&count| checked("threads_per_cm", count, 1.0, 200.0))?;
        checked("sheen", self.sheen, 0.0, 1.0)?;
        checked("opacity", self.opacity, 0.05, 1.0)?;
        match self.print.as_ref().and_then(Print::flaw) {
            Some(reason) => Err(FabricError::Print { name: self.name.clone(), reason: reason.into() }),
            None => Ok(()),
        }
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
        assert!(error.contains("tin") && error.contains("toile fabric list"), "{error}");
        let error = Fabric::built_in("coton-lawn").unwrap_err().to_string();
        assert!(error.contains("did you mean \"cotton-lawn\"?"), "{error}");
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
    fn a_fabric_may_have_a_built_in_one_as_its_base() {
        let text = "name = \"mine\"\ntitle = \"Mine\"\nbase = \"cotton-lawn\"\ncolour = [0.1, 0.2, 0.3]\n";
        let mine = Fabric::parse("mine", text).unwrap();
        let lawn = Fabric::built_in("cotton-lawn").unwrap();
        assert_eq!((mine.density_kg_m2, mine.colour, &*mine.name), (lawn.density_kg_m2, [0.1, 0.2, 0.3], "mine"));
        let error = Fabric::parse("mine", &text.replace("cotton-lawn", "tin")).unwrap_err().to_string();
        assert!(error.contains("tin") && error.contains("linen-twill") && !error.contains("gingham"), "{error}");
        assert!(Fabric::built_in("lawn-gingham").unwrap().tile.is_some());
    }

    #[test]
    fn a_picture_is_read_where_a_print_names_one() {
        let text = "name = \"mine\"\ntitle = \"Mine\"\nbase = \"cotton-lawn\"\n\
            [print]\npattern = \"picture\"\npicture = \"tile.png\"\nrepeat_mm = [40.0, 40.0]\n";
        let mut mine = Fabric::parse("mine", text).unwrap();
        assert_eq!(mine.tile, None);
        let error = mine.read_picture(|_| Ok(b"no picture".to_vec())).unwrap_err().to_string();
        assert!(error.contains("tile.png") && error.contains("PNG"), "{error}");
        let unknown = text.replace("picture = ", "image = ");
        assert!(Fabric::parse("mine", &unknown).is_err());
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
