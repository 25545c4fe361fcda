//! Commands that other programs run: the program, its place, and the way to get it.

use std::convert::Infallible;
use std::env;
use std::ffi::OsString;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use toile_cli::exit::AppError;

/// A command of another program.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct OtherCommand {
    /// Name of the command.
    pub name: &'static str,
    /// Program and crate that it belongs to.
    pub program: &'static str,
    /// One line of help.
    pub about: &'static str,
    /// Example of its use: a sentence and a line to type.
    pub example: [&'static str; 2],
}

/// All of them, in the order of the help.
pub static OTHER_COMMANDS: [OtherCommand; 8] = [
    OtherCommand {
        name: "bench",
        program: "toile-perf",
        about: "Time one part of the frame, with the error at that speed",
        example: ["the cost of a step of cloth, with its strain", "toile bench skirt --motion walk"],
    },
    OtherCommand {
        name: "validate",
        program: "toile-perf",
        about: "Compare the cloth with exact solutions",
        example: ["every case", "toile validate"],
    },
    OtherCommand {
        name: "pareto",
        program: "toile-perf",
        about: "Plot speed against error over the cloth's settings",
        example: ["see which settings of the skirt are worth their time", "toile pareto skirt --out plots"],
    },
    OtherCommand {
        name: "torture",
        program: "toile-perf",
        about: "Put the cloth into states that it should never meet, and see whether it comes back",
        example: ["run one seed of a case once more", "toile torture squeeze --seed 7"],
    },
    OtherCommand {
        name: "latency",
        program: "toile-perf",
        about: "Time the live loop stage by stage, from the sensor to the picture",
        example: ["ten seconds", "toile latency --seconds 10"],
    },
    OtherCommand {
        name: "soak",
        program: "toile-perf",
        about: "Run the whole loop for hours, with shoppers, garments and faults, and check it while it runs",
        example: ["eight hours and a thousand faults in some minutes", "toile soak --hours 8 --faults 1000"],
    },
    OtherCommand {
        name: "study",
        program: "toile-study",
        about: "Find out how many people each size of a garment fits",
        example: ["a study of a population", "toile study study.toml --out tee"],
    },
    OtherCommand {
        name: "capture",
        program: "toile-capture",
        about: "Turn the pictures of several calibrated cameras into motion, a pose, a body or a face",
        example: [
            "a body measured from the silhouettes of four cameras",
            "toile capture body masks --calibration cameras.toml --out fitted",
        ],
    },
];

impl OtherCommand {
    /// The command of this name, if another program runs it.
    pub fn named(name: &str) -> Option<&'static Self> {
        OTHER_COMMANDS.iter().find(|command| command.name == name)
    }

    /// Its entry in the help, in completions and in the manual. Its own program parses its options.
    pub fn grammar(&self) -> clap::Command {
        let (program, name) = (self.program, self.name);
        let options = clap::Arg::new("options")
            .help(format!("Options of `{program} {name}`; `toile {name} --help` lists them"))
            .num_args(0..)
            .trailing_var_arg(true)
            .allow_hyphen_values(true);
        clap::Command::new(name)
            .about(self.about)
            .long_about(format!("{}. The program `{program}` runs this command.", self.about))
            .after_help(format!("Example: {}\n  {}", self.example[0], self.example[1]))
            .arg(options)
    }
}

impl OtherCommand {
    /// The arguments of its program: those of this one, less the name where the program has it already.
    pub fn arguments(&self, args: &[OsString]) -> Vec<OsString> {
        let own = self.program.strip_prefix("toile-") == Some(self.name);
        args[usize::from(own)..].to_vec()
    }
}

/// Runs another program in place of this one and never returns: its exit code is that of the process.
///
/// # Errors
/// [`AppError::Usage`] where the program is missing or of another version, with the way to get it.
pub fn hand_over(program: &str, args: &[OsString]) -> Result<Infallible, AppError> {
    let mut other = None;
    for path in places(program) {
        match version(&path) {
            Some(found) if found == env!("CARGO_PKG_VERSION") => return become_program(&path, args),
            Some(found) => other = other.or(Some((path, found))),
            None => {}
        }
    }
    let cure = format!(
        "build it with `cargo build --release -p {program}` in the sources, or install the package `toile` of this version"
    );
    Err(AppError::Usage(match other {
        Some((path, found)) => format!(
            "{} is of version {found}, and this program of {}; {cure}",
            path.display(),
            env!("CARGO_PKG_VERSION")
        ),
        None => format!("this needs the program {program}, which is neither beside toile nor on the PATH; {cure}"),
    }))
}

/// Where a program may lie: beside this one, then in the folders of the PATH.
fn places(program: &str) -> Vec<PathBuf> {
    let beside = env::current_exe().ok().and_then(|own| own.parent().map(Path::to_path_buf));
    let path = env::var_os("PATH").unwrap_or_default();
    let name = format!("{program}{}", env::consts::EXE_SUFFIX);
    let all = beside.into_iter().chain(env::split_paths(&path)).map(|folder| folder.join(&name));
    all.filter(|place| place.is_file()).collect()
}

/// The version that a program says it has; none where it cannot be run.
fn version(program: &Path) -> Option<String> {
    let output = Command::new(program).arg("--version").stdin(Stdio::null()).stderr(Stdio::null()).output().ok()?;
    let said = String::from_utf8(output.stdout).ok()?;
    said.split_whitespace().nth(1).map(str::to_owned)
}

#[cfg(unix)]
fn become_program(path: &Path, args: &[OsString]) -> Result<Infallible, AppError> {
    use std::os::unix::process::CommandExt;
    let error = Command::new(path).args(args).exec();
    Err(AppError::Usage(format!("{} cannot be run ({error}); install it again", path.display())))
}

#[cfg(not(unix))]
fn become_program(path: &Path, args: &[OsString]) -> Result<Infallible, AppError> {
    match Command::new(path).args(args).status() {
        Ok(status) => std::process::exit(status.code().unwrap_or(toile_cli::exit::Code::Internal as i32)),
        Err(error) => Err(AppError::Usage(format!("{} cannot be run ({error}); install it again", path.display()))),
    }
}
