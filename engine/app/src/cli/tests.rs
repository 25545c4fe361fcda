//! Tests of the command line.

use std::path::PathBuf;

use toile_cli::program::Asked;

use super::*;

fn parsed(line: &str) -> Result<Command, AppError> {
    let args = with_default_command(line.split_whitespace().map(OsString::from).collect());
    match program::parse::<CommandLine>(&args)? {
        Asked::Command(line) => Ok(line.command),
        Asked::Text(text) => panic!("{text}"),
    }
}

#[test]
fn the_grammar_is_sound() {
    command().debug_assert();
}

#[test]
fn no_command_is_try_on() {
    let plain = parsed("toile").unwrap();
    assert_eq!(plain, parsed("toile try-on").unwrap());
    let Command::TryOn(args) = plain else { panic!("{plain:?}") };
    assert_eq!(args.out, PathBuf::from("out"));
    assert!(args.session.is_none() && args.garments.is_empty() && args.pictures);
    assert_eq!(parsed("toile --json --garment a").unwrap(), parsed("toile try-on --json --garment a").unwrap());
}

#[test]
fn flags_may_stand_before_the_command() {
    assert_eq!(parsed("toile --json doctor").unwrap(), parsed("toile doctor --json").unwrap());
    assert_eq!(parsed("toile -q --json measure f").unwrap(), parsed("toile measure -q --json f").unwrap());
}

#[test]
fn garments_keep_their_order() {
    let Command::TryOn(args) = parsed("toile --garment b --garment a --size 40").unwrap() else { panic!() };
    assert_eq!(args.garments, ["b", "a"]);
    assert_eq!(args.size.as_deref(), Some("40"));
}

#[test]
fn every_help_ends_with_an_example() {
    fn check(command: &clap::Command) {
        let after = command.get_after_help().map(ToString::to_string).unwrap_or_default();
        assert!(after.starts_with("Example: ") && after.contains("\n  toile"), "{}", command.get_name());
        command.get_subcommands().for_each(check);
    }
    check(&command());
}

#[test]
fn every_command_and_option_says_what_it_does() {
    fn check(command: &clap::Command) {
        let about = command.get_about().map(ToString::to_string).unwrap_or_default();
        assert!(about.split(' ').count() >= 4 && !about.starts_with('`'), "{}: {about}", command.get_name());
        for arg in command.get_arguments() {
            let help = arg.get_help().map(ToString::to_string).unwrap_or_default();
            assert!(!help.is_empty() && !help.ends_with('.'), "{} {}: {help}", command.get_name(), arg.get_id());
        }
        command.get_subcommands().for_each(check);
    }
    check(&command());
}

#[test]
fn a_wrong_line_gives_one_sentence_with_its_cure() {
    let lines =
        ["toile --garmet x", "toile mesure", "toile catalogue", "toile measure", "toile record --out f --seed x"];
    for line in lines {
        let error = parsed(line).unwrap_err();
        assert!(matches!(error, AppError::Usage(_)), "{line}");
        let message = error.to_string();
        assert!(message.contains("--help`") && !message.contains('\n'), "{message}");
    }
    let message = parsed("toile --garmet x").unwrap_err().to_string();
    assert!(message.contains("--garmet") && message.contains("'--garment'"), "{message}");
}

#[test]
fn commands_of_other_programs_keep_their_arguments() {
    let of = |line: &str| {
        let args = with_default_command(line.split_whitespace().map(OsString::from).collect());
        let words =
            |args: Vec<OsString>| args.into_iter().map(|a| a.into_string().unwrap()).collect::<Vec<_>>().join(" ");
        of_another_program(&args).map(|(other, args)| (other.program, words(args)))
    };
    assert_eq!(of("toile bench skirt --json"), Some(("toile-perf", "bench skirt --json".into())));
    assert_eq!(of("toile --json study merge tee"), Some(("toile-study", "--json merge tee".into())));
    assert_eq!(of("toile help capture face"), Some(("toile-capture", "face --help".into())));
    assert_eq!(of("toile measure bench"), None);
}
