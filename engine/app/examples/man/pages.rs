//! Pages: the grammar's contents, and beside it exit codes, files and further reading.

use std::io;

use clap::{Arg, Command};
use clap_mangen::Man;
use clap_mangen::roff::{Roff, bold, roman};
use toile_cli::exit::Code;

/// One page, as its file is named and as `man` reads it.
pub struct Page {
    pub name: String,
    pub text: Vec<u8>,
}

/// Meaning of each exit code.
const CODES: [(Code, &str); 7] = [
    (Code::Ok, "The work was done."),
    (Code::Usage, "The command line was not understood."),
    (Code::Threshold, "The work was done, but a figure missed its threshold."),
    (Code::BadInput, "A file, an asset or a folder cannot be used."),
    (Code::Device, "A device, a port or a right that was asked for is not available."),
    (Code::Diverged, "A replay did not give the bits that were recorded."),
    (Code::Internal, "Toile itself is at fault."),
];

/// Codes that any command may end with.
const COMMON: [Code; 4] = [Code::Ok, Code::Usage, Code::BadInput, Code::Internal];

/// What only a page itself tells: further exit codes, files, the guide to read on in.
#[derive(Default)]
struct More {
    codes: &'static [Code],
    files: &'static [(&'static str, &'static str)],
    guide: Option<&'static str>,
}

/// Files of the kiosk as the package installs them.
const KIOSK_FILES: [(&str, &str); 6] = [
    (
        "/etc/toile/kiosk.toml",
        "The configuration that the service reads; `toile kiosk --print-config` explains all keys.",
    ),
    ("/lib/systemd/system/toile.service", "The service; it is started when an administrator enables it."),
    (
        "/usr/share/doc/toile/examples/loopback.conf",
        "Opens the loopback interface to the service; install it as /etc/systemd/system/toile.service.d/loopback.conf.",
    ),
    (
        "/usr/share/doc/toile/examples/camera.conf",
        "Opens depth cameras to the service; install it as /etc/systemd/system/toile.service.d/camera.conf.",
    ),
    (
        "/usr/share/doc/toile/examples/link.conf",
        "Lets the service offer pictures on the shop's own network; install it as /etc/systemd/system/toile.service.d/link.conf.",
    ),
    ("/usr/share/doc/toile/shop.md", "The guide for a shop."),
];

/// Files that a try-on writes.
const TRY_ON_FILES: [(&str, &str); 5] = [
    ("look.png", "Front, side and back at the end, in the fabric's colours."),
    ("fit.png", "The same as a fit map, from loose to tight."),
    ("contact-sheet.png", "Twelve moments of the session."),
    ("session.png", "The whole session, an animated PNG."),
    ("report.json", "Measures with their errors, size, ease by zone, step times, strain, state hash."),
];

fn more(name: &str) -> More {
    let guide = |guide| More { guide: Some(guide), ..More::default() };
    let judged = |guide| More { codes: &[Code::Threshold], guide: Some(guide), ..More::default() };
    match name {
        "toile" => {
            More { codes: &[Code::Threshold, Code::Device, Code::Diverged], guide: Some("integrator"), files: &[] }
        }
        "toile-try-on" => More { files: &TRY_ON_FILES, guide: Some("measuring"), ..More::default() },
        "toile-kiosk" => More { codes: &[Code::Device], files: &KIOSK_FILES, guide: Some("kiosk") },
        "toile-latency" => judged("loop"),
        "toile-replay" => More { codes: &[Code::Diverged], ..guide("loop") },
        "toile-soak" => More { codes: &[Code::Threshold, Code::Device], ..guide("soak") },
        "toile-validate" => judged("validate"),
        "toile-torture" => judged("torture"),
        "toile-capture" => guide("capture"),
        "toile-study" => guide("study"),
        "toile-bench" => More { codes: &[Code::Threshold, Code::Device], ..More::default() },
        "toile-plan" => judged("plan"),
        "toile-body" => judged("avatars"),
        "toile-convert" => guide("depth"),
        "toile-measure" | "toile-record" => guide("measuring"),
        "toile-run" | "toile-bake" => guide("scene"),
        "toile-pareto" => guide("pareto"),
        _ => More::default(),
    }
}

/// All pages, a command's before those of its subcommands.
pub fn all() -> io::Result<Vec<Page>> {
    // No page of its own for `help`, nor for one of the commands below it.
    let mut root = toile::cli::command().disable_help_subcommand(true);
    root.build();
    let mut pages = Vec::new();
    add(&root, None, &mut pages)?;
    Ok(pages)
}

fn add(command: &Command, parent: Option<&str>, pages: &mut Vec<Page>) -> io::Result<()> {
    let name = command.get_display_name().unwrap_or_else(|| command.get_name()).to_owned();
    pages.push(page(command, &name, parent)?);
    command.get_subcommands().filter(|sub| !sub.is_hide_set()).try_for_each(|sub| add(sub, Some(&name), pages))
}

fn page(command: &Command, name: &str, parent: Option<&str>) -> io::Result<Page> {
    let man = Man::new(command.clone().mut_args(with_values_in_words));
    let mut sections = Vec::new();
    man.render_name_section(&mut sections)?;
    man.render_synopsis_section(&mut sections)?;
    man.render_description_section(&mut sections)?;
    man.render_options_section(&mut sections)?;
    if command.has_subcommands() {
        man.render_subcommands_section(&mut sections)?;
    }
    let more = more(name);
    let mut roff = Roff::default();
    exit_status(&mut roff, more.codes);
    files(&mut roff, more.files);
    examples(&mut roff, command);
    see_also(&mut roff, command, name, parent, more.guide);
    roff.to_writer(&mut sections)?;
    // Each part comes with the definition of the apostrophe, which a page needs once.
    let sections = String::from_utf8_lossy(&sections).replace(APOSTROPHE, "");
    let title = name.to_uppercase();
    // No date: the same sources give the same page on any day.
    let head = format!("{APOSTROPHE}.TH {title} 1 \"\" \"Toile {}\" \"Toile Manual\"\n", env!("CARGO_PKG_VERSION"));
    Ok(Page { name: format!("{name}.1"), text: (head + &sections).into_bytes() })
}

/// What an apostrophe is, with GNU's roff and with others: `roff` writes it before all that it writes.
const APOSTROPHE: &str = ".ie \\n(.g .ds Aq \\(aq\n.el .ds Aq '\n";

/// The values of an option in its sentence: a list of them takes a line each.
fn with_values_in_words(arg: Arg) -> Arg {
    let values: Vec<String> = arg.get_possible_values().iter().map(|v| v.get_name().to_owned()).collect();
    let help = arg.get_help().map(ToString::to_string).unwrap_or_default();
    if values.iter().all(|value| help.contains(value.as_str())) {
        return arg.hide_possible_values(true);
    }
    arg.help(format!("{help}; one of {}", values.join(", "))).hide_possible_values(true)
}

fn exit_status(roff: &mut Roff, more: &[Code]) {
    roff.control("SH", ["EXIT STATUS"]);
    for (code, meaning) in CODES.iter().filter(|(code, _)| COMMON.contains(code) || more.contains(code)) {
        roff.control("TP", []).text([bold((*code as u8).to_string())]).text([roman(*meaning)]);
    }
}

fn files(roff: &mut Roff, files: &[(&str, &str)]) {
    if !files.is_empty() {
        roff.control("SH", ["FILES"]);
    }
    for (file, meaning) in files {
        roff.control("TP", []).text([bold(*file)]).text([roman(*meaning)]);
    }
}

/// The examples of the help: a sentence, then lines to type that are set in from it.
fn examples(roff: &mut Roff, command: &Command) {
    let Some(help) = command.get_after_help().map(ToString::to_string) else { return };
    roff.control("SH", ["EXAMPLES"]);
    let mut typed = false;
    for line in help.lines().filter(|line| !line.trim().is_empty()) {
        if let Some(line) = line.strip_prefix("  ") {
            roff.control(if typed { "br" } else { "IP" }, []).text([bold(line)]);
            typed = true;
        } else {
            let sentence = line.strip_prefix("Example: ").unwrap_or(line);
            if typed {
                roff.control("PP", []);
            }
            roff.text([roman(capital(sentence))]);
            typed = false;
        }
    }
}

/// A sentence with a capital and a colon, as what stands before a line to type.
fn capital(sentence: &str) -> String {
    let mut letters = sentence.chars();
    let first: String = letters.next().into_iter().flat_map(char::to_uppercase).collect();
    format!("{first}{}:", letters.as_str().trim_end_matches(['.', ':']))
}

fn see_also(roff: &mut Roff, command: &Command, name: &str, parent: Option<&str>, guide: Option<&str>) {
    let below = command.get_subcommands().map(|sub| format!("{name}-{}", sub.get_name()));
    let pages: Vec<String> = parent.map(str::to_owned).into_iter().chain(below).collect();
    roff.control("SH", ["SEE ALSO"]);
    for (i, page) in pages.iter().enumerate() {
        let comma = if i + 1 < pages.len() { "," } else { "" };
        roff.text([bold(page.clone()), roman(format!("(1){comma}"))]);
    }
    if let Some(guide) = guide {
        if !pages.is_empty() {
            roff.control("PP", []);
        }
        roff.text([roman(format!("/usr/share/doc/toile/{guide}.md"))]);
    }
}
