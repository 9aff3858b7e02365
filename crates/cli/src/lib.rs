//! The `shadowgraph` program, for those who add techniques and nodes of their own to it.
//!
//! Exit codes: 0 done, 1 the input or a setting is wrong, 2 usage, 3 nothing to draw with: no usable adapter, or no display. Whatever is wrong
//! is told in one line on standard error that starts with `error:`.

mod args;
mod bench;
mod commands;
mod console;
mod dump;
mod failure;
mod measure;
mod nodes;
mod progress;
mod report;
#[cfg(feature = "view")]
mod view;

use args::{Cli, Command};
use clap::{CommandFactory, Parser};
use failure::Failure;
use shadowgraph::Registry;
#[cfg(unix)]
use std::process::Command as Process;
use std::process::ExitCode;

/// Does what the command line says, with these techniques and nodes to choose from: the whole `main` of a program.
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
    runtime_folder();
    let done = match Cli::try_parse() {
        Ok(Cli { command: None }) => console::print(&Cli::command().render_help().to_string()),
        Ok(Cli { command: Some(Command::Render(args)) }) => commands::render(&args, registry),
        Ok(Cli { command: Some(Command::Dump(args)) }) => dump::dump(&args, registry),
        Ok(Cli { command: Some(Command::Explain(args)) }) => dump::explain(&args, registry),
        #[cfg(feature = "view")]
        Ok(Cli { command: Some(Command::View(args)) }) => view::view(&args, registry),
        Ok(Cli { command: Some(Command::Bench(args)) }) => bench::bench(&args, registry),
        Ok(Cli { command: Some(Command::Nodes(args)) }) => nodes::nodes(&args, registry),
        Ok(Cli { command: Some(Command::Measure(args)) }) => measure::measure_command(&args, registry),
        Err(usage) => return tell_usage(&usage),
    };
    match done {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => {
            console::error(&failure.message);
            ExitCode::from(failure.code)
        }
    }
}

/// Without a runtime folder, as in a container, a library under some Vulkan drivers prints lines that begin with
/// `error:` though nothing is wrong. Then the program starts once more, with one.
#[cfg(unix)]
fn runtime_folder() {
    use std::os::unix::process::CommandExt as _;
    const VARIABLE: &str = "XDG_RUNTIME_DIR";
    if std::env::var_os(VARIABLE).is_some() {
        return;
    }
    if let Ok(program) = std::env::current_exe() {
        let arguments = std::env::args_os().skip(1);
        // Returns only where it cannot be done, and then those lines do no harm.
        let _failed = Process::new(program).args(arguments).env(VARIABLE, std::env::temp_dir()).exec();
    }
}

/// Help and version go to standard output with code 0, wrong usage to standard error with code 2.
fn tell_usage(usage: &clap::Error) -> ExitCode {
    if usage.use_stderr() {
        console::error(&wrong_usage(usage));
        return ExitCode::from(Failure::USAGE);
    }
    // Nobody may be left to read it.
    let _unread = usage.print();
    ExitCode::SUCCESS
}

/// What is wrong and what may be meant, without the paragraphs on how the command is used.
fn wrong_usage(usage: &clap::Error) -> String {
    let words = usage.render().to_string();
    let wrong = ["\n\nUsage:", "\n\nFor more information"]
        .into_iter()
        .fold(&*words, |words, end| words.split(end).next().unwrap_or_default());
    format!("{}\n--help tells all", wrong.trim_start_matches("error: "))
}

#[cfg(doctest)]
#[doc = include_str!("../README.md")]
mod readme {}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "tests")]
    use super::*;

    #[test]
    fn wrong_usage_is_one_line_with_what_may_be_meant() {
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
            let told = console::one_line(&wrong_usage(&Cli::try_parse_from(words).unwrap_err()));
            assert!(told.starts_with(expected) && told.ends_with("; --help tells all"), "{told}");
        }
    }
}
