//! Options that several commands share: the look of the mannequin, and exports.

use std::path::Path;

use toile_assets::export::ExportFormat;
use toile_base::limits::STEP_HZ;
use toile_cli::arguments::one_of;
use toile_cli::exit::AppError;
use toile_view::figure::{Appearance, Hair, SkinTone};

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
