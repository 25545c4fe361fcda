//! The configuration file (TOML), the only thing that a kiosk keeps. Unknown keys are refused.

use std::net::SocketAddr;
use std::ops::RangeInclusive;
use std::path::{Path, PathBuf};

use serde::Deserialize;
use toile_assets::file::{self, FileKind};
use toile_base::body::Sex;
use toile_engine::cloth::Quality;
use toile_engine::workers::SHARES;

use super::config_keys;
use super::picture_config::{OwnPictureUse, PictureConfig};
use super::session::SessionTimes;
use crate::error::KioskError;
use toile_fitting::dress::measured::ShopperFacts;
use toile_fitting::dress::try_on::{TryOn, shown_first};
use toile_sensors::source::live::{CameraError, CameraName};
use toile_track::tape_readings::TapeReadings;
use toile_view::figure::{Appearance, Hair, SkinTone};

/// The default configuration with all keys explained.
pub const EXAMPLE: &str = include_str!("../../systemd/kiosk.toml");

/// A configuration: a page or two of text.
const CONFIGURATION: FileKind = FileKind {
    name: "a configuration like `toile kiosk --print-config` prints",
    max_bytes: 1 << 20,
    cure: "shorten it",
};

/// Everything that can be set.
#[derive(Debug, Clone, PartialEq, Default, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Config {
    /// Garments and sizes that are worn.
    pub wear: WearConfig,
    /// What is known of every shopper.
    pub shopper: ShopperConfig,
    /// Where frames come from.
    pub sensor: SensorConfig,
    /// Times of a session.
    pub session: SessionConfig,
    /// The health line.
    pub health: HealthConfig,
    /// What is asked of the machine.
    pub machine: MachineConfig,
    /// The display, where there is one.
    pub display: DisplayConfig,
    /// The picture that a shopper takes away.
    pub picture: PictureConfig,
    /// Figures for Prometheus.
    pub metrics: MetricsConfig,
    /// What is kept of a crash.
    pub crash: CrashConfig,
}

/// Garments and sizes that are worn.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct WearConfig {
    /// What is worn first, inner first: garments of the wardrobe, files of patterns, packages or meshes, article numbers of
    /// the catalogue.
    pub garments: Vec<String>,
    /// A folder of garment packages that hang in place of the built-in wardrobe.
    pub catalogue: Option<PathBuf>,
    /// A size for every shopper.
    pub size: Option<String>,
    /// Tested settings of the cloth.
    pub quality: String,
    /// Whether the file says what is worn first.
    #[serde(skip)]
    pub is_named: bool,
}

/// What is known of every shopper before they are measured.
#[derive(Debug, Clone, PartialEq, Default, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct ShopperConfig {
    /// Whose proportions apply: female or male; none is found from what is seen.
    pub sex: Option<String>,
    /// Whether every shopper is an adult, or a child: `adult` or `child`; none is estimated.
    pub age: Option<String>,
    /// Measures taken by tape, such as `chest=912`: for a fitting by appointment, or a demonstration.
    pub measures: Vec<String>,
}

impl ShopperConfig {
    /// The same as the measuring takes it.
    ///
    /// # Errors
    /// The first word that means nothing, with the cure.
    pub fn facts(&self) -> Result<ShopperFacts, String> {
        let sex = match self.sex.as_deref() {
            None => None,
            Some("female") => Some(Sex::Female),
            Some("male") => Some(Sex::Male),
            Some(other) => return Err(format!("shopper.sex = {other} is not female or male; correct it")),
        };
        let child = match self.age.as_deref() {
            None => None,
            Some("child") => Some(true),
            Some("adult") => Some(false),
            Some(other) => return Err(format!("shopper.age = {other} is not adult or child; correct it")),
        };
        let tape = TapeReadings::of(&self.measures).map_err(|why| format!("shopper.measures: {why}"))?;
        Ok(ShopperFacts { sex, child, tape, ..ShopperFacts::default() })
    }
}

/// Where frames come from.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct SensorConfig {
    /// The kind of sensor.
    pub source: SensorSource,
    /// The recording; none is the embedded one.
    pub session: Option<PathBuf>,
    /// Time between two rounds of a recording (s).
    pub pause_s: f64,
    /// Where VMC messages arrive.
    pub vmc: SocketAddr,
    /// A live camera, by its kind; it takes the place of `source`.
    pub camera: Option<String>,
    /// Which camera of that kind: its serial number, or a recording of it.
    pub device: Option<String>,
    /// By how much its images are turned clockwise to be upright (degrees): 0, 90, 180 or 270.
    pub turned_degrees: u32,
    /// Height of a webcam above the floor (mm), so that it says how tall a person is.
    pub camera_height_mm: Option<f64>,
    /// By how much a webcam looks down (degrees).
    pub camera_tilt_degrees: f64,
}

impl SensorConfig {
    /// The camera that is configured, if one is.
    ///
    /// # Errors
    /// An unknown kind.
    pub fn camera(&self) -> Result<Option<CameraName>, CameraError> {
        let Some(kind) = &self.camera else { return Ok(None) };
        let name = self.device.as_ref().map_or_else(|| kind.clone(), |device| format!("{kind}:{device}"));
        name.parse().map(Some)
    }

    /// The first value that cannot be, with the cure.
    fn fault(&self) -> Option<String> {
        let degrees = self.turned_degrees;
        if !(degrees.is_multiple_of(90) && degrees < 360) {
            return Some(format!("sensor.turned_degrees = {degrees} is not 0, 90, 180 or 270; correct it"));
        }
        if let Some(mm) = self.camera_height_mm.filter(|mm| !(200.0..=4_000.0).contains(mm)) {
            return Some(format!("sensor.camera_height_mm = {mm} is not within 200 to 4000; correct it"));
        }
        let tilt = self.camera_tilt_degrees;
        if !(-45.0..=60.0).contains(&tilt) {
            return Some(format!("sensor.camera_tilt_degrees = {tilt} is not within -45 to 60; correct it"));
        }
        self.camera().err().map(|why| format!("sensor.camera: {why}"))
    }
}

/// A kind of sensor.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum SensorSource {
    /// A recorded session, played again and again.
    Session,
    /// Virtual Motion Capture over UDP.
    Vmc,
}

/// Times of a session (s).
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct SessionConfig {
    /// Being seen until one has stepped in.
    pub step_in_s: f64,
    /// Being measured (s).
    pub measure_s: f64,
    /// Being unseen until one has left.
    pub step_out_s: f64,
    /// From then until everything is wiped.
    pub wipe_s: f64,
}

/// The health line.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct HealthConfig {
    /// Time between two (s); 0 is never.
    pub every_s: f64,
}

/// What is asked of the machine.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct MachineConfig {
    /// Workers of a step; none is as many as there are cores.
    pub workers: Option<usize>,
    /// Whether all memory is kept resident.
    pub lock_memory: bool,
}

/// Languages of the pages, by their tags (BCP 47).
pub const LANGUAGES: [&str; 6] = ["en", "de", "fr", "es", "tr", "ja"];

/// The display, and how every visit begins on it.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct DisplayConfig {
    /// From the floor to the picture's lower edge (mm).
    pub lower_edge_mm: f32,
    /// Height of the picture (mm).
    pub height_mm: f32,
    /// The language before the visitor chooses one.
    pub language: String,
    /// Whether type is large before the visitor chooses.
    pub large_type: bool,
    /// Whether anything moves by itself: a mannequin that turns.
    pub motion: bool,
    /// How long a picture that was asked for is kept.
    pub picture_minutes: f64,
    /// Where the mark is on the floor, in the sensor's world (x and z, m).
    pub mark_m: Option<[f32; 2]>,
    /// Tone of the skin of every body.
    pub skin: String,
    /// Moulded hair of every body.
    pub hair: String,
    /// Whether shoppers may see the camera's own picture of them with the clothes on it.
    pub own_picture: OwnPictureUse,
    /// Whether shoppers may have their own face put on the mannequin.
    pub face: bool,
}

/// Figures for Prometheus.
#[derive(Debug, Clone, PartialEq, Default, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct MetricsConfig {
    /// Port on 127.0.0.1 that figures are served at.
    pub port: Option<u16>,
}

/// What is kept of a crash.
#[derive(Debug, Clone, PartialEq, Default, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct CrashConfig {
    /// Where the last ten seconds are written; none writes nothing.
    pub recording: Option<PathBuf>,
}

impl Default for WearConfig {
    fn default() -> Self {
        Self {
            garments: shown_first(None).iter().map(|&name| name.to_owned()).collect(),
            catalogue: None,
            size: None,
            quality: Quality::default().name().into(),
            is_named: false,
        }
    }
}

impl Default for SensorConfig {
    fn default() -> Self {
        let vmc = SocketAddr::from(([127, 0, 0, 1], toile_sensors::source::vmc::PORT));
        Self {
            source: SensorSource::Session,
            session: None,
            pause_s: 12.0,
            vmc,
            camera: None,
            device: None,
            turned_degrees: 0,
            camera_height_mm: None,
            camera_tilt_degrees: 0.0,
        }
    }
}

impl Default for SessionConfig {
    fn default() -> Self {
        Self { step_in_s: 0.5, measure_s: 1.0, step_out_s: 2.0, wipe_s: 5.0 }
    }
}

impl Default for HealthConfig {
    fn default() -> Self {
        Self { every_s: 60.0 }
    }
}

impl Default for DisplayConfig {
    fn default() -> Self {
        Self {
            lower_edge_mm: 400.0,
            height_mm: 1210.0,
            language: LANGUAGES[0].into(),
            large_type: false,
            motion: true,
            picture_minutes: 3.0,
            mark_m: None,
            skin: SkinTone::default().name().into(),
            hair: Hair::default().name().into(),
            own_picture: OwnPictureUse::default(),
            face: false,
        }
    }
}

impl Default for MachineConfig {
    fn default() -> Self {
        Self { workers: None, lock_memory: true }
    }
}

impl DisplayConfig {
    /// The first value that cannot be, with the cure. Whether the controls are within reach is looked at where there are any.
    fn fault(&self) -> Option<String> {
        let (minutes, language) = (self.picture_minutes, &self.language);
        let known = LANGUAGES.contains(&language.as_str());
        let lengths = [self.lower_edge_mm, self.height_mm].into_iter().chain(self.mark_m.into_iter().flatten());
        if !(0.1..=30.0).contains(&minutes) {
            Some(format!("display.picture_minutes = {minutes} is not within 0.1 .. 30 minutes; correct it"))
        } else if !known {
            Some(format!("display.language = {language:?} is not spoken; choose one of {}", LANGUAGES.join(", ")))
        } else if !lengths.into_iter().all(f32::is_finite) {
            Some("a length in [display] is not a finite number; correct it".into())
        } else {
            let skin = self.skin.parse::<SkinTone>().err().map(|e| format!("display.skin: {e}"));
            skin.or_else(|| self.hair.parse::<Hair>().err().map(|e| format!("display.hair: {e}")))
        }
    }

    /// How every body looks.
    pub fn appearance(&self) -> Appearance {
        Appearance { skin: self.skin.parse().unwrap_or_default(), hair: self.hair.parse().unwrap_or_default() }
    }
}

impl Config {
    /// Reads a file, or takes the defaults.
    ///
    /// # Errors
    /// A file that cannot be read, an unknown key, a value that cannot be; each names the line.
    pub fn open(path: Option<&Path>) -> Result<Self, KioskError> {
        let Some(path) = path else { return Ok(Self::default()) };
        let text = file::read_text(path, &CONFIGURATION).map_err(KioskError::input)?;
        Self::parse(&path.display().to_string(), &text)
    }

    /// Reads a text; `file` is its name in errors.
    ///
    /// # Errors
    /// As [`Config::open`].
    pub fn parse(file: &str, text: &str) -> Result<Self, KioskError> {
        config_keys::check(file, text)?;
        let mut config: Self = toml::from_str(text).map_err(|e| config_keys::parse_error(file, text, &e))?;
        config.wear.is_named = names_garments(text);
        match config.fault() {
            Some(fault) => Err(KioskError::Input(format!("{file}: {fault}"))),
            None => Ok(config),
        }
    }

    /// The first value that cannot be, with the cure.
    fn fault(&self) -> Option<String> {
        let times = [
            ("sensor.pause_s", self.sensor.pause_s, 0.0..=86_400.0),
            ("session.step_in_s", self.session.step_in_s, 0.0..=60.0),
            ("session.measure_s", self.session.measure_s, 0.5..=60.0),
            ("session.step_out_s", self.session.step_out_s, 0.1..=600.0),
            ("session.wipe_s", self.session.wipe_s, 0.0..=600.0),
            ("health.every_s", self.health.every_s, 0.0..=86_400.0),
        ];
        let outside = |(key, value, range): &(&str, f64, RangeInclusive<f64>)| {
            let (least, most) = (range.start(), range.end());
            (!range.contains(value))
                .then(|| format!("{key} = {value} is not within {least} .. {most} seconds; correct it"))
        };
        let workers = self.machine.workers.filter(|w| !(1..=SHARES).contains(w));
        times
            .iter()
            .find_map(outside)
            .or_else(|| workers.map(|w| format!("machine.workers = {w} is not 1 or {SHARES}; correct it")))
            .or_else(|| self.wear.garments.is_empty().then(|| "wear.garments is empty; name a garment".into()))
            .or_else(|| self.sensor.fault())
            .or_else(|| self.shopper.facts().err())
            .or_else(|| self.display.fault())
            .or_else(|| self.picture.fault())
            .or_else(|| self.wear.quality.parse::<Quality>().err().map(|e| format!("wear.quality: {e}")))
    }

    /// The request that every visitor begins with, as it is configured.
    pub fn request(&self) -> TryOn {
        let shopper = self.shopper.facts().unwrap_or_default();
        let request = TryOn::of_shopper(&self.wear.garments, self.wear.size.as_deref(), shopper);
        request.in_quality(self.wear.quality.parse().unwrap_or_default())
    }

    /// The rules of a session.
    pub fn times(&self) -> SessionTimes {
        let times = &self.session;
        SessionTimes { step_in_ns: ns(times.step_in_s), step_out_ns: ns(times.step_out_s), wipe_ns: ns(times.wipe_s) }
    }
}

/// Whether a configuration says what is worn first.
fn names_garments(text: &str) -> bool {
    text.parse::<toml::Table>().is_ok_and(|table| table.get("wear").is_some_and(|wear| wear.get("garments").is_some()))
}

/// Seconds of the configuration, none of which is negative, as the loop counts them.
pub fn ns(seconds: f64) -> u64 {
    (seconds * 1e9) as u64
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_example_is_the_default_and_explains_every_key() {
        let mut usual = Config::default();
        usual.wear.is_named = true;
        assert_eq!(Config::parse("kiosk.toml", EXAMPLE).unwrap(), usual);
        for (table, names) in config_keys::KEYS {
            assert!(EXAMPLE.contains(&format!("\n[{table}]\n")), "{table}");
            for name in names {
                assert!(
                    EXAMPLE.lines().any(|l| l.trim_start_matches("# ").starts_with(&format!("{name} = "))),
                    "{name}"
                );
            }
        }
        // Every key that is commented out works once it is not.
        let is_key = |line: &str| line.starts_with("# ") && line.contains(" = ");
        let all = EXAMPLE.lines().map(|l| if is_key(l) { &l[2..] } else { l }).collect::<Vec<_>>().join("\n");
        let all = Config::parse("all.toml", &all).unwrap();
        assert_eq!(
            (all.wear.size.as_deref(), all.machine.workers, all.metrics.port),
            (Some("40"), Some(2), Some(9520))
        );
        assert!(all.sensor.session.is_some() && all.crash.recording.is_some());
    }

    #[test]
    fn an_empty_file_is_the_default() {
        assert_eq!(Config::parse("empty.toml", "").unwrap(), Config::default());
    }

    #[test]
    fn values_that_cannot_be_are_named_with_their_key() {
        for (text, key) in [
            ("[session]\nwipe_s = -1.0", "session.wipe_s"),
            ("[session]\nmeasure_s = nan", "session.measure_s"),
            ("[machine]\nworkers = 3", "machine.workers"),
            ("[wear]\ngarments = []", "wear.garments"),
            ("[shopper]\nsex = \"girl\"", "shopper.sex"),
            ("[shopper]\nage = \"12\"", "shopper.age"),
            ("[shopper]\nmeasures = [\"chest=91\"]", "centimetres"),
            ("[wear]\nquality = \"best\"", "wear.quality"),
            ("[sensor]\ncamera = \"cctv\"", "sensor.camera"),
            ("[sensor]\ncamera_height_mm = 12.0", "sensor.camera_height_mm"),
            ("[sensor]\ncamera_tilt_degrees = nan", "sensor.camera_tilt_degrees"),
            ("[sensor]\nturned_degrees = 45", "sensor.turned_degrees"),
            ("[display]\nlanguage = \"tlh\"", "display.language"),
            ("[display]\npicture_minutes = 0.0", "display.picture_minutes"),
            ("[display]\nmark_m = [0.0, nan]", "[display]"),
            ("[display]\nskin = \"sandy\"", "display.skin: no skin tone is called \"sandy\"; did you mean \"sand\"?"),
            ("[display]\nhair = \"mohawk\"", "display.hair: no hair is called \"mohawk\"; choose one of none, short"),
        ] {
            let message = Config::parse("k.toml", text).unwrap_err().to_string();
            assert!(message.starts_with("k.toml: ") && message.contains(key), "{message}");
        }
    }

    #[test]
    fn a_value_of_another_kind_is_named_with_its_line() {
        let message = Config::parse("k.toml", "[wear]\nquality = 3").unwrap_err().to_string();
        assert!(message.starts_with("k.toml:2: ") && !message.contains('\n'), "{message}");
        let message = Config::parse("k.toml", "\n[sensor]\nvmc = \"here\"").unwrap_err().to_string();
        assert!(message.starts_with("k.toml:3: "), "{message}");
        let message = Config::parse("k.toml", "[wear\n").unwrap_err().to_string();
        assert!(message.starts_with("k.toml:1: "), "{message}");
    }
}
