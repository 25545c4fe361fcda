//! Fabrics from TOML: those that are built in, those of a shop, and the pictures that they name.

pub mod print;
pub mod sheet;

use std::sync::Arc;

use thiserror::Error;
use toile_base::fabric::Fabric;
use toile_base::fabric::loop_widths::LoopWidths;
use toile_base::fabric::stretch_curve::{ShearLock, StretchCurve};
use toml::{Table, Value};

use crate::texture;
use crate::toml_keys::nearest;

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

/// Reads one fabric from TOML; `name` says in errors where the text came from. A picture that it names is not read.
///
/// # Errors
/// A text that is no fabric, a figure that no cloth has.
pub fn parse(name: &str, text: &str) -> Result<Fabric, FabricError> {
    let wrong = |e: toml::de::Error| FabricError::Syntax { name: name.into(), reason: e.message().replace('\n', " ") };
    let mut fabric: Fabric = match toml::from_str::<Table>(text).map_err(wrong)?.get("base").and_then(Value::as_str) {
        Some(base) => whole(name, base, text)?.try_into().map_err(wrong)?,
        None => toml::from_str(text).map_err(wrong)?,
    };
    check(&fabric)?;
    fabric.tile = fabric.print.as_ref().and_then(print::draw);
    Ok(fabric)
}

/// Reads the picture that its print names, if it names one; `read` gives the bytes of a file beside the fabric's.
///
/// # Errors
/// A picture that is not there, or is none.
pub fn read_picture(
    fabric: &mut Fabric,
    read: impl FnOnce(&str) -> Result<Vec<u8>, String>,
) -> Result<(), FabricError> {
    let Some(picture) = fabric.print.as_ref().and_then(|print| print.picture.as_deref()) else { return Ok(()) };
    let tile = read(picture).and_then(|bytes| texture::decode(&bytes));
    let wrong = |reason| FabricError::Print { name: fabric.name.clone(), reason: format!("{picture}: {reason}") };
    fabric.tile = Some(Arc::new(tile.map_err(wrong)?));
    Ok(())
}

/// The built-in fabric of that name.
pub fn built_in(name: &str) -> Result<Fabric, FabricError> {
    match BUILT_IN.iter().find(|text| name_in(text) == Some(name)) {
        Some(text) => parse("built in", text),
        None => {
            let near = nearest(name, names().into_iter());
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
pub fn all() -> Result<Vec<Fabric>, FabricError> {
    BUILT_IN.iter().map(|text| parse("built in", text)).collect()
}

fn check(fabric: &Fabric) -> Result<(), FabricError> {
    let checked = |key, value: f32, low: f32, high: f32| match (low..=high).contains(&value) {
        true => Ok(()),
        false => Err(FabricError::Range { name: fabric.name.clone(), key, value, low, high }),
    };
    for (key, low, high) in Fabric::RANGES {
        fabric.figure(key).map_or(Ok(()), |value| checked(key, value, low, high))?;
    }
    for ((key, low, high), width) in LoopWidths::RANGES.into_iter().zip(fabric.hysteresis.figures()) {
        checked(key, width, low, high)?;
    }
    for curve in [fabric.stretch.warp, fabric.stretch.weft].into_iter().flatten() {
        for ((key, low, high), figure) in StretchCurve::RANGES.into_iter().zip(curve.figures()) {
            checked(key, figure, low, high)?;
        }
    }
    if let Some(lock) = fabric.shear_lock {
        for ((key, low, high), figure) in ShearLock::RANGES.into_iter().zip([lock.degrees, lock.beyond_n_m]) {
            checked(key, figure, low, high)?;
        }
    }
    checked("drape_percent", fabric.drape_percent.unwrap_or(50.0), 0.0, 100.0)?;
    checked("comfortable_stretch", fabric.comfortable_stretch, 0.001, 1.0)?;
    fabric.colour.iter().try_for_each(|&part| checked("colour", part, 0.0, 1.0))?;
    fabric.threads_per_cm.iter().try_for_each(|&count| checked("threads_per_cm", count, 1.0, 200.0))?;
    checked("sheen", fabric.sheen, 0.0, 1.0)?;
    checked("opacity", fabric.opacity, 0.05, 1.0)?;
    match fabric.print.as_ref().and_then(print::flaw) {
        Some(reason) => Err(FabricError::Print { name: fabric.name.clone(), reason: reason.into() }),
        None => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use toile_base::fabric::{USUAL_SHEEN, USUAL_THREADS, Weave};

    use super::*;

    #[test]
    fn built_in_fabrics_are_valid_and_found_by_name() {
        for fabric in all().unwrap() {
            assert_eq!(built_in(&fabric.name).unwrap(), fabric);
        }
        let error = built_in("tin").unwrap_err().to_string();
        assert!(error.contains("tin") && error.contains("toile fabric list"), "{error}");
        let error = built_in("coton-lawn").unwrap_err().to_string();
        assert!(error.contains("did you mean \"cotton-lawn\"?"), "{error}");
    }

    #[test]
    fn the_cotton_that_needs_no_file_is_the_built_in_one() {
        assert_eq!(Fabric::cotton_lawn(), built_in("cotton-lawn").unwrap());
    }

    #[test]
    fn threads_are_read_and_have_usual_figures() {
        let text = include_str!("../data/fabrics/linen-twill.toml");
        let twill = parse("twill", text).unwrap();
        assert_eq!((twill.weave, twill.threads_per_cm), (Weave::Twill, [18.0, 16.0]));
        let silent = text.lines().filter(|l| !["weave", "threads", "sheen"].iter().any(|k| l.starts_with(k)));
        let usual = parse("usual", &silent.collect::<Vec<_>>().join("\n")).unwrap();
        assert_eq!((usual.weave, usual.threads_per_cm, usual.sheen), (Weave::Plain, USUAL_THREADS, USUAL_SHEEN));
        let gauze = text.replace("[18.0, 16.0]", "[18.0, 0.0]");
        assert!(parse("gauze", &gauze).unwrap_err().to_string().contains("threads_per_cm"));
        assert!(parse("felt", &text.replace("\"twill\"", "\"felt\"")).is_err());
    }

    #[test]
    fn a_fabric_may_have_a_built_in_one_as_its_base() {
        let text = "name = \"mine\"\ntitle = \"Mine\"\nbase = \"cotton-lawn\"\ncolour = [0.1, 0.2, 0.3]\n";
        let mine = parse("mine", text).unwrap();
        let lawn = built_in("cotton-lawn").unwrap();
        assert_eq!((mine.density_kg_m2, mine.colour, &*mine.name), (lawn.density_kg_m2, [0.1, 0.2, 0.3], "mine"));
        let error = parse("mine", &text.replace("cotton-lawn", "tin")).unwrap_err().to_string();
        assert!(error.contains("tin") && error.contains("linen-twill") && !error.contains("gingham"), "{error}");
        assert!(built_in("lawn-gingham").unwrap().tile.is_some());
    }

    #[test]
    fn a_picture_is_read_where_a_print_names_one() {
        let text = "name = \"mine\"\ntitle = \"Mine\"\nbase = \"cotton-lawn\"\n\
            [print]\npattern = \"picture\"\npicture = \"tile.png\"\nrepeat_mm = [40.0, 40.0]\n";
        let mut mine = parse("mine", text).unwrap();
        assert_eq!(mine.tile, None);
        let error = read_picture(&mut mine, |_| Ok(b"no picture".to_vec())).unwrap_err().to_string();
        assert!(error.contains("tile.png") && error.contains("PNG"), "{error}");
        let unknown = text.replace("picture = ", "image = ");
        assert!(parse("mine", &unknown).is_err());
    }

    #[test]
    fn an_infinite_stiffness_is_inextensible() {
        let text = include_str!("../data/fabrics/cotton-lawn.toml");
        let tape = text.replace("stretch_warp_n_m = 6000.0", "stretch_warp_n_m = inf");
        assert_eq!(parse("tape", &tape).unwrap().stretch_warp_n_m, f32::INFINITY);
        let sheared = text.replace("shear_n_m = 60.0", "shear_n_m = inf");
        assert!(parse("sheared", &sheared).unwrap_err().to_string().contains("shear_n_m"));
    }

    #[test]
    fn every_figure_can_be_changed_and_is_checked() {
        for (key, low, high) in Fabric::RANGES {
            let mut fabric = built_in("cotton-lawn").unwrap();
            fabric.set_figure(key, high);
            assert_eq!((fabric.figure(key), check(&fabric)), (Some(high), Ok(())), "{key}");
            fabric.set_figure(key, low - 1.0);
            assert!(check(&fabric).unwrap_err().to_string().contains(key), "{key}");
        }
    }

    #[test]
    fn nonsense_is_refused_with_key_and_cure() {
        let text = include_str!("../data/fabrics/cotton-lawn.toml");
        let heavy = text.replace("density_kg_m2 = 0.105", "density_kg_m2 = nan");
        assert_ne!(heavy, text);
        assert!(parse("heavy", &heavy).unwrap_err().to_string().contains("density_kg_m2"));
        assert!(parse("odd", &format!("{text}\nstiffness = 0.8\n")).unwrap_err().to_string().contains("stiffness"));
        assert!(matches!(parse("empty", ""), Err(FabricError::Syntax { .. })));
        let bias =
            |value: f32| parse("bias", &text.replace("friction", &format!("bend_bias_un_m = {value:?}\nfriction")));
        assert_eq!(bias(3.0).unwrap().bend_bias_un_m, Some(3.0));
        assert!(bias(-1.0).unwrap_err().to_string().contains("bend_bias_un_m"));
    }
}
