//! What several commands take: options that they share, and parsers of values.

use std::ops::RangeBounds;
use std::path::Path;

use clap::builder::{PossibleValuesParser, RangedU64ValueParser, TypedValueParser};
use toile_assets::export::ExportFormat;
use toile_base::limits::STEP_HZ;
use toile_engine::cloth::Quality;
use toile_engine::lanes::Width;
use toile_engine::workers::SHARES;
use toile_gpu::backend::Backend;
use toile_view::figure::{Appearance, Hair, SkinTone};

use crate::exit::AppError;
use crate::terminal::Words;
use toile_fitting::dress::wish::Wish;
use toile_track::tape_readings::TapeReadings;

/// What a command prints, and where.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, clap::Args)]
pub struct Printing {
    /// Print one JSON object, and nothing else, on stdout
    #[arg(long)]
    pub json: bool,
    /// Print nothing on stderr but errors
    #[arg(long, short)]
    pub quiet: bool,
}

impl Printing {
    /// Words for the person at the terminal: none beside JSON.
    pub fn words(self) -> Words {
        Words::new(self.quiet || self.json)
    }
}

/// The option `--backend`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::Args)]
pub struct BackendArg {
    /// What steps the cloth: cpu; gpu, a graphics device, in a build with `--features gpu`; auto, whichever measures
    /// faster at the start. Where there is no device the processor steps, and a line on stderr says so
    #[arg(
        id = "backend",
        long = "backend",
        value_name = "B",
        value_parser = one_of(Backend::ALL, Backend::name),
        default_value = Backend::Cpu.name()
    )]
    pub choice: Backend,
}

/// The option `--workers`.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, clap::Args)]
pub struct WorkersArg {
    /// Workers of a step, 1 or 2 (default: as many as there are cores)
    #[arg(id = "workers", long = "workers", value_name = "N", value_parser = count(1..=SHARES as u64))]
    choice: Option<usize>,
}

impl WorkersArg {
    /// How many workers step.
    pub fn count(self) -> usize {
        self.choice.unwrap_or_else(|| cores().min(SHARES))
    }
}

/// The option `--crash-after`: every command that keeps its last seconds for a crash can be made to crash.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, clap::Args)]
pub struct CrashArg {
    /// Panic after so many seconds, to see what a crash leaves
    #[arg(id = "crash-after", long = "crash-after", value_name = "S")]
    pub after_s: Option<u64>,
}

/// The option `--skin`.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, clap::Args)]
pub struct SkinArg {
    /// Tone of the body's skin
    #[arg(
        id = "skin",
        long = "skin",
        value_name = "TONE",
        value_parser = one_of(SkinTone::ALL, SkinTone::name),
        default_value = SkinTone::default().name()
    )]
    pub tone: SkinTone,
}

/// How the mannequin looks.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, clap::Args)]
pub struct AppearanceArgs {
    #[command(flatten)]
    skin: SkinArg,
    /// Moulded hair of the mannequin
    #[arg(long, value_name = "CUT", value_parser = one_of(Hair::ALL, Hair::name), default_value = Hair::default().name())]
    hair: Hair,
}

impl AppearanceArgs {
    /// The same as pictures take it.
    pub fn appearance(self) -> Appearance {
        Appearance { skin: self.skin.tone, hair: self.hair }
    }

    /// The same on a body of a file, which keeps its own head.
    ///
    /// # Errors
    /// [`AppError::Usage`] where hair is asked for.
    pub fn on_body_of(self, file: &Path) -> Result<Appearance, AppError> {
        if self.hair == Hair::None {
            return Ok(self.appearance());
        }
        let (hair, file) = (self.hair, file.display());
        Err(AppError::Usage(format!(
            "--hair {hair} is for our own mannequins, and {file} keeps its own head; leave it out"
        )))
    }
}

/// What the shopper or a tape tells.
#[derive(Debug, Clone, Default, PartialEq, clap::Args)]
pub struct TapeArgs {
    /// A measure taken by tape, such as chest=912 (mm), waist=71cm or hips=38in; repeat it for more
    #[arg(long = "measure", value_name = "NAME=VALUE")]
    pub measures: Vec<String>,
}

impl TapeArgs {
    /// The same as measures.
    ///
    /// # Errors
    /// Words that are no measure, a length that nobody has, or measures that nobody has together.
    pub fn readings(&self) -> Result<TapeReadings, AppError> {
        TapeReadings::of(&self.measures).map_err(|why| AppError::Usage(format!("--measure: {why}")))
    }
}

/// What the shopper wears.
#[derive(Debug, Clone, Default, PartialEq, clap::Args)]
pub struct WornArgs {
    /// Garment of the wardrobe; repeat it to dress in layers, inner first
    #[arg(long = "garment", value_name = "G")]
    pub garments: Vec<String>,
    /// Size to wear (default: the one that fits)
    #[arg(long, value_name = "S")]
    pub size: Option<String>,
    /// Tested settings of the cloth: draft, shop or fine
    #[arg(long, value_name = "Q", value_parser = quality(), default_value = Quality::default().name())]
    pub quality: Quality,
    /// Measures taken by tape
    #[command(flatten)]
    pub tape: TapeArgs,
}

impl WornArgs {
    /// The same as the scene's maker takes it.
    ///
    /// # Errors
    /// As [`TapeArgs::readings`].
    pub fn wish(&self) -> Result<Wish, AppError> {
        let tape = self.tape.readings()?;
        Ok(Wish {
            garments: self.garments.clone(),
            size: self.size.clone(),
            quality: self.quality,
            sex: None,
            child: None,
            tape,
        })
    }
}

/// What is written of a session for other tools.
#[derive(Debug, Clone, Default, PartialEq, clap::Args)]
pub struct ExportArgs {
    /// Write where the body and the garments are all the time, for other tools: glb, usd, mdd, pc2 or ply; repeat it for more
    #[arg(long = "export", value_name = "FORMAT", value_parser = one_of(ExportFormat::ALL, ExportFormat::name))]
    pub formats: Vec<ExportFormat>,
    /// Frames a second of what is exported; it divides 120
    #[arg(long = "export-rate", value_name = "HZ", value_parser = export_rate, default_value = "30", requires = "formats")]
    pub rate_hz: u32,
}

impl ExportArgs {
    /// Steps from one frame to the next.
    pub fn stride(&self) -> u64 {
        u64::from(STEP_HZ / self.rate_hz.max(1))
    }
}

/// A number of frames a second between which there are whole steps.
fn export_rate(text: &str) -> Result<u32, String> {
    let divides = |hz: &u32| *hz > 0 && STEP_HZ.is_multiple_of(*hz);
    text.parse().ok().filter(divides).ok_or_else(|| {
        let all: Vec<String> = (1..=STEP_HZ).filter(divides).map(|hz| hz.to_string()).collect();
        format!("the engine takes {STEP_HZ} steps a second, so give one of {}", all.join(", "))
    })
}

/// Cores that this process may use; 1 where the system does not say.
pub fn cores() -> usize {
    std::thread::available_parallelism().map_or(1, usize::from)
}

/// A parser of names that stand for values.
pub fn one_of<T, const N: usize>(all: [T; N], name: fn(T) -> &'static str) -> impl TypedValueParser<Value = T>
where
    T: Copy + Send + Sync + 'static,
{
    let value = move |text: String| all.into_iter().find(|value| name(*value) == text).ok_or("it has no such name");
    PossibleValuesParser::new(all.map(name)).try_map(value)
}

/// A parser of the cloth's tested settings.
pub fn quality() -> impl TypedValueParser<Value = Quality> {
    one_of(Quality::ALL, Quality::name)
}

/// A parser of numbers of things.
pub fn count(range: impl RangeBounds<u64>) -> impl TypedValueParser<Value = usize> {
    RangedU64ValueParser::<u64>::new().range(range).try_map(usize::try_from)
}

/// A parser of numbers of lanes.
pub fn lanes() -> impl TypedValueParser<Value = Width> {
    let width = |text: String| text.parse().ok().and_then(Width::of).ok_or("there is no such width");
    PossibleValuesParser::new(["1", "4", "8", "16"]).try_map(width)
}

/// What a line of words says to a command that takes these arguments.
#[cfg(test)]
pub(crate) fn parsed<A: clap::Args>(line: &str) -> Result<A, clap::Error> {
    #[derive(clap::Parser)]
    struct Line<A: clap::Args> {
        #[command(flatten)]
        args: A,
    }
    Ok(<Line<A> as clap::Parser>::try_parse_from(line.split_whitespace())?.args)
}
