//! The `shadowgraph` program, as a library for programs that add their own techniques and nodes.
//!
//! Exit codes: 0 success, 1 invalid input or setting, 2 invalid command line, 3 no usable adapter or no display. An error is one line
//! on standard error that starts with `error:`.

mod ablate;
mod args;
mod bench;
mod commands;
mod console;
mod dump;
mod failure;
mod first_image;
mod fly;
mod frame_files;
mod measure;
mod nodes;
mod noise;
mod pixel;
mod progress;
mod recording;
mod replay;
mod report;
mod stop;
mod values;
#[cfg(feature = "view")]
mod view;

use args::{Cli, Command};
use clap::error::ErrorKind;
use clap::{CommandFactory, Parser};
use failure::Failure;
use shadowgraph::Registry;
#[cfg(unix)]
use std::process::Command as Process;
use std::process::ExitCode;

/// Runs the command line with the techniques and nodes of `registry`: the whole `main` of a program.
///
/// ```no_run
/// use shadowgraph::Registry;
/// use shadowgraph::shadows::{NoShadows, TechniqueKind};
///
/// const MINE: TechniqueKind =
///     TechniqueKind::new("mine", "everything is lit", |_context| Ok(Box::new(NoShadows)));
///
/// let mut registry = Registry::built_in();
/// registry.techniques.register(MINE)?;
/// shadowgraph_cli::run(&registry);
/// # Ok::<(), shadowgraph::shadows::Error>(())
/// ```
pub fn run(registry: &Registry) -> ExitCode {
    #[cfg(unix)]
    runtime_dir();
    let done = match Cli::try_parse() {
        Ok(Cli { command: None }) => console::print(&Cli::command().render_help().to_string()),
        Ok(Cli { command: Some(Command::Render(args)) }) => match (&args.replay.file, &args.stop_at) {
            (Some(file), _) => replay::replay(file, &args, registry),
            (None, Some((texture, version))) => stop::stop_at(texture, *version, &args, registry),
            (None, None) => commands::render(&args, registry),
        },
        Ok(Cli { command: Some(Command::Dump(args)) }) => dump::dump(&args, registry),
        Ok(Cli { command: Some(Command::Explain(args)) }) => dump::explain(&args, registry),
        Ok(Cli { command: Some(Command::Pixel(args)) }) => pixel::pixel(&args, registry),
        #[cfg(feature = "view")]
        Ok(Cli { command: Some(Command::View(args)) }) => view::view(&args, registry),
        Ok(Cli { command: Some(Command::Bench(args)) }) => bench::bench(&args, registry),
        Ok(Cli { command: Some(Command::Nodes(args)) }) => nodes::nodes(&args, registry),
        Ok(Cli { command: Some(Command::Measure(args)) }) if args.noise => {
            noise::noise_command(&args, registry)
        }
        Ok(Cli { command: Some(Command::Measure(args)) }) => measure::measure_command(&args, registry),
        Err(usage) => return print_usage_error(&usage),
    };
    match done {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => {
            console::error(&failure.message);
            ExitCode::from(failure.code)
        }
    }
}

/// Sets a runtime directory if there is none, as in a container, and restarts the program. Without one, a library that
/// some Vulkan drivers use prints lines that begin with `error:` though nothing is wrong.
#[cfg(unix)]
fn runtime_dir() {
    use std::os::unix::process::CommandExt as _;
    const VARIABLE: &str = "XDG_RUNTIME_DIR";
    if std::env::var_os(VARIABLE).is_some() {
        return;
    }
    if let Ok(program) = std::env::current_exe() {
        let arguments = std::env::args_os().skip(1);
        // Returns only on failure, which does no harm.
        let _failed = Process::new(program).args(arguments).env(VARIABLE, std::env::temp_dir()).exec();
    }
}

/// Help and version go to standard output with code 0, wrong usage to standard error with code 2, and so do invalid values of options, with
/// code 1.
fn print_usage_error(usage: &clap::Error) -> ExitCode {
    if usage.use_stderr() {
        console::error(&usage_error(usage));
        let is_value = matches!(usage.kind(), ErrorKind::InvalidValue | ErrorKind::ValueValidation);
        return ExitCode::from(if is_value { Failure::INPUT } else { Failure::USAGE });
    }
    // Standard output may be closed.
    let _unread = usage.print();
    ExitCode::SUCCESS
}

/// Returns the error and a suggestion, without the paragraphs on usage.
fn usage_error(usage: &clap::Error) -> String {
    let text = usage.render().to_string();
    let error = ["\n\nUsage:", "\n\nFor more information"]
        .into_iter()
        .fold(&*text, |text, end| text.split(end).next().unwrap_or_default());
    format!("{}\nsee --help", error.trim_start_matches("error: "))
}

#[cfg(doctest)]
#[doc = include_str!("../README.md")]
mod readme {}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "tests")]
    use super::*;

    #[test]
    fn a_usage_error_is_one_line_with_a_suggestion() {
        for (line, expected) in [
            ("rendr", "unrecognized subcommand 'rendr'; tip: a similar subcommand exists: 'render'"),
            ("render --sise 3", "unexpected argument '--sise' found; tip: a similar argument exists: "),
            (
                "dump --format gif",
                "invalid value 'gif' for '--format <FORMAT>'; [possible values: text, json,",
            ),
            ("explain", "the following required arguments were not provided: <NAME>"),
            ("bench --frames many", "invalid value 'many' for '--frames <N>': "),
        ] {
            let words = std::iter::once("shadowgraph").chain(line.split(' '));
            let error = console::one_line(&usage_error(&Cli::try_parse_from(words).unwrap_err()));
            assert!(error.starts_with(expected) && error.ends_with("; see --help"), "{error}");
        }
    }
}
