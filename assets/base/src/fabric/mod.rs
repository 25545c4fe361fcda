//! Fabrics as values in physical units, and the curves of one link.

pub mod friction_element;
pub mod link_curve;
pub mod loop_widths;
pub mod print;
pub mod stretch_curve;

use std::sync::Arc;

use crate::texture::Texture;
use loop_widths::LoopWidths;
use print::Print;
use stretch_curve::{ShearLock, StretchCurve, StretchCurves};

/// One fabric, as its file states it. Stiffnesses are per unit width of cloth, so that they do not depend on any mesh.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Deserialize), serde(deny_unknown_fields))]
pub struct Fabric {
    /// The name by which garment files call it.
    pub name: String,
    /// Name for shoppers.
    pub title: String,
    /// Where its figures were published or measured.
    #[cfg_attr(feature = "serde", serde(default))]
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
    #[cfg_attr(feature = "serde", serde(default = "usual_thickness"))]
    pub thickness_mm: f32,
    /// Stretch that a wearer still finds comfortable (1): the fit map's full scale.
    pub comfortable_stretch: f32,
    /// Base colour of the cloth, sRGB 0..1.
    pub colour: [f32; 3],
    /// How its threads run, as pictures show them.
    #[cfg_attr(feature = "serde", serde(default))]
    pub weave: Weave,
    /// Threads in a centimetre along the weft and along the warp; of a knit, columns and rows of stitches (1/cm).
    #[cfg_attr(feature = "serde", serde(default = "usual_threads"))]
    pub threads_per_cm: [f32; 2],
    /// Strength of the sheen at the most grazing angle, as pictures show it (0..1).
    #[cfg_attr(feature = "serde", serde(default = "usual_sheen"))]
    pub sheen: f32,
    /// Share of light that the threads hold back where cloth is seen against the light (0..1): a voile has gaps.
    #[cfg_attr(feature = "serde", serde(default = "opaque"))]
    pub opacity: f32,
    /// Cusick's drape coefficient as measured (%): reported beside the rest, never fitted to.
    #[cfg_attr(feature = "serde", serde(default))]
    pub drape_percent: Option<f32>,
    /// Widths of its measured loops; none where it was not measured, and then nothing of it costs anything.
    #[cfg_attr(feature = "serde", serde(default))]
    pub hysteresis: LoopWidths,
    /// Its stretch as curves of two slopes; a way without one has the one slope above.
    #[cfg_attr(feature = "serde", serde(default))]
    pub stretch: StretchCurves,
    /// Where its shear locks; none where it was not measured.
    pub shear_lock: Option<ShearLock>,
    /// Whether threads that are pushed together give way as arcs between particles, in place of bearing as much as they pull.
    #[cfg_attr(feature = "serde", serde(default))]
    pub buckling: bool,
    /// What is printed on it or woven into it.
    pub print: Option<Print>,
    /// One repeat of the print, drawn or read.
    #[cfg_attr(feature = "serde", serde(skip))]
    pub tile: Option<Arc<Texture>>,
}

/// How threads run.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
#[cfg_attr(feature = "serde", derive(serde::Deserialize), serde(rename_all = "kebab-case"))]
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

#[cfg(feature = "serde")]
fn usual_thickness() -> f32 {
    USUAL_THICKNESS_MM
}

#[cfg(feature = "serde")]
fn usual_threads() -> [f32; 2] {
    USUAL_THREADS
}

#[cfg(feature = "serde")]
fn usual_sheen() -> f32 {
    USUAL_SHEEN
}

#[cfg(feature = "serde")]
fn opaque() -> f32 {
    1.0
}

impl Fabric {
    /// A light, plain-woven summer cotton, for programs that read no fabric files: 105 g/m2, 6,000 and 4,000 N/m along warp
    /// and weft, 60 N/m in shear, 4.5 and 3.5 uN m in bending.
    pub fn cotton_lawn() -> Self {
        Self {
            name: "cotton-lawn".into(),
            title: "Cotton lawn".into(),
            source: None,
            density_kg_m2: 0.105,
            stretch_warp_n_m: 6_000.0,
            stretch_weft_n_m: 4_000.0,
            shear_n_m: 60.0,
            bend_warp_un_m: 4.5,
            bend_weft_un_m: 3.5,
            bend_bias_un_m: None,
            friction: 0.35,
            damping_per_s: 1.05,
            contact_offset_mm: 3.0,
            thickness_mm: USUAL_THICKNESS_MM,
            comfortable_stretch: 0.03,
            colour: [0.80, 0.36, 0.28],
            weave: Weave::Plain,
            threads_per_cm: [38.0, 34.0],
            sheen: USUAL_SHEEN,
            opacity: 1.0,
            drape_percent: None,
            hysteresis: LoopWidths::default(),
            stretch: StretchCurves::default(),
            shear_lock: None,
            buckling: false,
            print: None,
            tile: None,
        }
    }

    /// Accepted figures, lowest and highest: from the thinnest silk to canvas, an order of magnitude wider than the 618
    /// fabrics that were measured for the published bands (REFERENCES: density 0.031 to 0.487 kg/m2, bending rigidity 0.9
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
    pub fn figure(&self, key: &str) -> Option<f32> {
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
    pub fn has_link_curves(&self) -> bool {
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
}

#[cfg(all(test, feature = "serde"))]
mod tests {
    use super::*;

    #[test]
    fn what_a_file_leaves_out_is_that_of_matt_cotton() {
        let fabric: Fabric = toml::from_str(
            "name = \"plain\"\ntitle = \"Plain\"\ndensity_kg_m2 = 0.1\nstretch_warp_n_m = 5000.0\nstretch_weft_n_m = 4000.0\n\
             shear_n_m = 60.0\nbend_warp_un_m = 4.0\nbend_weft_un_m = 3.0\nfriction = 0.3\ndamping_per_s = 1.0\n\
             contact_offset_mm = 2.0\ncomfortable_stretch = 0.04\ncolour = [1.0, 1.0, 1.0]\n",
        )
        .unwrap();
        assert_eq!((fabric.thickness_mm, fabric.threads_per_cm), (USUAL_THICKNESS_MM, USUAL_THREADS));
        assert_eq!((fabric.sheen, fabric.opacity, fabric.weave), (USUAL_SHEEN, 1.0, Weave::Plain));
        assert!(fabric.drape_percent.is_none() && fabric.shear_lock.is_none() && !fabric.buckling);
    }
}
