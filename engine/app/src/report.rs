//! The JSON of the commands. Its keys are a contract: keys may be added, none renamed.

use std::path::PathBuf;

use serde::Serialize;
use toile_assets::adapt::MeshReport;
use toile_cli::document::{DefinedMeasure, MeasuredLength};
use toile_fitting::scene::StepTimes;
use toile_fitting::scene::contact::ContactReport;
use toile_fitting::wearing::PosePulls;

mod body;
mod colliders;
pub mod measures;
mod run;

pub use body::{BodyReport, Influences, JointFound, Named, SurfaceReport};
pub use colliders::Followed;
pub use run::{KineticEnergy, RunGarment, RunPenetration, RunReport};

/// The measures of one shopper.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize)]
pub struct ShopperMeasures {
    /// Stature: crown to floor.
    pub stature_mm: MeasuredLength,
    /// Between the shoulder points.
    pub shoulder_breadth_mm: MeasuredLength,
    /// Around the fullest part of the chest.
    pub chest_girth_mm: MeasuredLength,
    /// Girth of the waist.
    pub waist_girth_mm: MeasuredLength,
    /// Around the fullest part of the hips.
    pub hip_girth_mm: MeasuredLength,
}

/// The session that was watched.
#[derive(Debug, Clone, Default, PartialEq, Serialize)]
pub struct SessionReport {
    /// File name, or the name of the embedded one.
    pub name: String,
    /// Joint or depth frames read.
    pub frames: u64,
    /// From the first frame to the last (s).
    pub seconds: f64,
    /// What was found wrong with it and how it was mended, one sentence each.
    pub notes: Vec<String>,
}

/// How one zone of a garment fits.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ZoneFitReport {
    /// Name of the zone, such as `waist`.
    pub zone: String,
    /// Garment's girth less the body's (mm).
    pub ease_mm: f64,
    /// Standard uncertainty of the ease (mm).
    pub sigma_mm: f64,
    /// `tight`, `good` or `loose`.
    pub verdict: String,
    /// How it feels, from `too tight` to `too loose`; none where the body was not seen there.
    pub feel: Option<String>,
    /// The same for a person to read.
    pub sentence: String,
}

/// A size with its probability.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct SizeChance {
    /// Code of the size.
    pub size: String,
    /// How likely it is the best one (0..1).
    pub probability: f64,
}

/// The measure to take by tape.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct TapeMeasure {
    /// Name of the girth to take.
    pub zone: String,
    /// How likely the likeliest size is to be the best once it is known, on average (0..1).
    pub probability: f64,
    /// The same for a person to read.
    pub sentence: String,
}

/// The size that fits, and how.
#[derive(Debug, Clone, Default, PartialEq, Serialize)]
pub struct RecommendationReport {
    /// The garment's name.
    pub garment: String,
    /// Code of its size.
    pub size: String,
    /// How likely this size is the best one, given how well the shopper could be measured (0..1).
    pub probability: f64,
    /// How each zone of it fits.
    pub zones: Vec<ZoneFitReport>,
    /// Every size that is made with its probability, smallest first; they sum to 1.
    pub sizes: Vec<SizeChance>,
    /// Whether no size is sure.
    pub uncertain: bool,
    /// The measure to take by tape, where no size is sure and a tape would help.
    pub tape: Option<TapeMeasure>,
    /// The whole in words.
    pub verdict: String,
    /// The next best size, where it may be the better one.
    pub runner_up: Option<String>,
    /// Set where no size is made for this shopper, or guesses stand for measures.
    pub note: Option<String>,
}

/// How far edges are stretched, as a part of their rest length (0.01 is 1 %).
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize)]
pub struct StrainReport {
    /// Mean over edges and steps.
    pub mean: f64,
    /// 99th percentile over edges (1).
    pub p99: f64,
    /// The worst edge at the worst step.
    pub max: f64,
}

/// How deep cloth was inside the body after contact.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize)]
pub struct Penetration {
    /// The deepest particle (mm).
    pub max: f64,
}

/// Edges of garments that pass through faces, of another garment or their own.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize)]
pub struct CrossingReport {
    /// Moments that were looked at, one every tenth step.
    pub frames: u64,
    /// Moments with any crossing.
    pub frames_with: u64,
    /// Most edges at one moment.
    pub max: u64,
    /// Most of them between garments.
    pub max_between: u64,
    /// The longest time without a moment free of them (s).
    pub longest_s: f64,
    /// When there were most, from the start (s); none where there never were any.
    pub worst_s: Option<f64>,
}

/// Settings, times and errors of the physics.
#[derive(Debug, Clone, Default, PartialEq, Serialize)]
pub struct PhysicsReport {
    /// Steps a second of simulated time.
    pub hz: u32,
    /// The tested settings that were used.
    pub quality: &'static str,
    /// Lanes that the kernels ran on.
    pub lanes: usize,
    /// Workers of a step.
    pub workers: usize,
    /// Substeps of a step, which with the fabric decide the strain.
    pub substeps: u32,
    /// Particles of all garments, the skinned ones included.
    pub particles: usize,
    /// Steps that were taken.
    pub steps: u64,
    /// Time a step took.
    pub step_us: StepTimes,
    /// How far edges were stretched.
    pub strain: StrainReport,
    /// How deep cloth was inside the body.
    pub penetration_mm: Penetration,
    /// Steps at which a particle was not finite.
    pub nonfinite: u64,
    /// What the guards and capacities had to say.
    pub warnings: Vec<String>,
}

/// The body of `toile try-on`.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct TryOn {
    /// The session that was watched.
    pub session: SessionReport,
    /// The shopper's measures.
    pub measurements: ShopperMeasures,
    /// The size of the first garment, zone by zone.
    pub recommendation: RecommendationReport,
    /// The sizes of the others, in the order in which they were asked for.
    pub others: Vec<RecommendationReport>,
    /// Settings, times and errors of the physics.
    pub physics: PhysicsReport,
    /// Edges of the garments that passed through faces, by a test of its own.
    pub crossings: CrossingReport,
    /// What contact of cloth with cloth did; none where no garment can meet anything.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub contact: Option<ContactReport>,
    /// What was repaired in meshes of the user's own and what became of their pieces; left out where none is worn.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub meshes: Vec<MeshReport>,
    /// How far skin or inner cloth stood out of what covers it, which the pictures hide; none where there are no pictures.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub hidden_mm: Option<Penetration>,
    /// What the garments do when the wearer raises the arms or sits down; left out where it was not asked for.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub poses: Vec<PosePulls>,
    /// The animation that moved the body; left out where a session did.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub animation: Option<AnimationReport>,
    /// What was written of the motion for other tools; left out where nothing was.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub export: Option<ExportReport>,
    /// Hash of the last state, 16 hexadecimal digits; the same input gives the same.
    pub state_hash: String,
    /// What drew the pictures; nothing where there are none.
    pub renderer: Option<String>,
    /// The files written.
    pub files: Vec<PathBuf>,
}

/// An animation of a body's file, and how far the body's skin as it was moved is from the skin as the file moves it.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct AnimationReport {
    /// Name of the animation.
    pub name: String,
    /// Its length (s).
    pub seconds: f64,
    /// Mean distance of the two skins, over all vertices and 30 frames a second (mm).
    pub skin_mean_mm: f64,
    /// 99th percentile of it (mm).
    pub skin_p99_mm: f64,
    /// Most of any vertex in any frame (mm).
    pub skin_max_mm: f64,
    /// What was found in the file and how it was taken.
    pub notes: Vec<String>,
}

/// What was written of a session's motion.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ExportReport {
    /// Names of the formats.
    pub formats: Vec<&'static str>,
    /// Frames in each file.
    pub frames: usize,
    /// Frames a second.
    pub rate_hz: u32,
}

/// The body of `toile measure`.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct MeasureReport {
    /// The session that was watched.
    pub session: SessionReport,
    /// The shopper's measures.
    pub measurements: ShopperMeasures,
    /// The measures of the method that was used: the body fit, or proportions where no body fits.
    pub methods: Vec<MethodMeasures>,
    /// The fitted body; nothing without depth, or where none fits.
    pub body: Option<FittedBody>,
    /// Depth pixels on the shopper, median over the frames.
    pub valid_pixels: u64,
    /// People in view, median over the frames.
    pub people: u32,
    /// The files written.
    pub files: Vec<PathBuf>,
}

/// What one way of measuring found.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct MethodMeasures {
    /// Name of the method.
    pub method: &'static str,
    /// Measures that it takes.
    pub measures: Vec<DefinedMeasure>,
}

/// How well a body fits the depth.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct FittedBody {
    /// How likely it is a woman's, 0 to 1.
    pub woman: f64,
    /// How likely it is a child's, 0 to 1.
    pub child: f64,
    /// Whether the fit was one-sided, cloth lying outside the skin.
    pub clothed: bool,
    /// Frames that took part.
    pub frames: u64,
    /// Whether the shopper turned, and was seen from all sides.
    pub turned: bool,
    /// Share of the shopper's surface that it explains, 0 to 1.
    pub explained: f64,
    /// Root mean square distance of the surface from the body's (mm).
    pub off_mm: f64,
}

/// The body of `toile record`.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct RecordReport {
    /// The session that was made.
    pub session: SessionReport,
    /// Seed of the noise.
    pub seed: u64,
    /// The files written.
    pub files: Vec<PathBuf>,
}

/// The body of `toile convert`.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ConvertReport {
    /// The session that was written.
    pub session: SessionReport,
    /// Joint frames in it.
    pub joint_frames: u64,
    /// Depth frames in it.
    pub depth_frames: u64,
    /// Depth frames of the recording that are not in it, because they were not asked for.
    pub depth_frames_left_out: u64,
    /// The files written.
    pub files: Vec<PathBuf>,
}

#[cfg(test)]
mod tests {
    use toile_cli::document::{Document, hash_text};

    use super::*;

    fn try_on() -> TryOn {
        let zone = ZoneFitReport {
            zone: "waist".into(),
            ease_mm: 40.0,
            sigma_mm: 8.0,
            verdict: "good".into(),
            feel: Some("right".into()),
            sentence: "The waist is good.".into(),
        };
        let recommendation = RecommendationReport {
            garment: "trousers".into(),
            size: "40".into(),
            zones: vec![zone],
            ..Default::default()
        };
        TryOn {
            renderer: None,
            session: SessionReport::default(),
            measurements: ShopperMeasures::default(),
            recommendation,
            others: Vec::new(),
            meshes: Vec::new(),
            physics: PhysicsReport::default(),
            crossings: CrossingReport { worst_s: Some(0.5), ..CrossingReport::default() },
            contact: Some(ContactReport::default()),
            hidden_mm: Some(Penetration::default()),
            poses: Vec::new(),
            animation: None,
            export: None,
            state_hash: hash_text(10),
            files: vec!["out/front.png".into()],
        }
    }

    #[test]
    fn try_on_keeps_the_contract() {
        let json = serde_json::to_value(Document::new("try-on", try_on())).unwrap();
        let present = [
            "/schema",
            "/version",
            "/machine/cpu",
            "/machine/cores",
            "/machine/lanes",
            "/machine/adapter",
            "/measurements/stature_mm/value",
            "/measurements/shoulder_breadth_mm/sigma",
            "/measurements/chest_girth_mm/value",
            "/measurements/waist_girth_mm/value",
            "/measurements/hip_girth_mm/value",
            "/recommendation/garment",
            "/recommendation/size",
            "/recommendation/zones/0/zone",
            "/recommendation/zones/0/ease_mm",
            "/recommendation/zones/0/sigma_mm",
            "/recommendation/zones/0/verdict",
            "/physics/hz",
            "/physics/steps",
            "/physics/step_us/p50",
            "/physics/step_us/p99",
            "/physics/step_us/p999",
            "/physics/step_us/max",
            "/physics/strain/mean",
            "/physics/strain/p99",
            "/physics/strain/max",
            "/physics/penetration_mm/max",
            "/physics/nonfinite",
            "/physics/warnings",
            "/files/0",
            "/crossings/frames_with",
            "/crossings/max",
            "/crossings/longest_s",
            "/crossings/worst_s",
            "/contact/asked",
            "/contact/contacts_most",
            "/contact/crowded",
            "/contact/left_out",
            "/hidden_mm/max",
            "/state_hash",
            "/session/name",
            "/session/frames",
            "/session/seconds",
            "/session/notes",
        ];
        for key in present {
            assert!(json.pointer(key).is_some(), "{key} is missing");
        }
        assert_eq!(json["schema"], "toile.try-on/1");
        assert_eq!(json["state_hash"], "000000000000000a");
    }
}
