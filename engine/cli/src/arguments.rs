//! Options that several programs share, and parsers of values.

use std::ops::RangeBounds;

use clap::builder::{PossibleValuesParser, RangedU64ValueParser, TypedValueParser};
use toile_engine::cloth::Quality;
use toile_engine::workers::SHARES;
use toile_fitting::dress::measured::ShopperFacts;
use toile_fitting::dress::try_on::TryOn;
use toile_track::tape_readings::TapeReadings;

use crate::exit::AppError;
use crate::terminal::Words;

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
    /// Words that are no measure, a length outside of people's range, or measures that no person has together.
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
    pub fn request(&self) -> Result<TryOn, AppError> {
        let shopper = ShopperFacts { tape: self.tape.readings()?, ..ShopperFacts::default() };
        Ok(TryOn::of_shopper(&self.garments, self.size.as_deref(), shopper).in_quality(self.quality))
    }
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
