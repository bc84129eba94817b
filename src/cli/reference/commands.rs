//! The reference page of the command line, from the definitions that read it.

use clap::{Arg, Command};
use std::fmt::Write as _;

/// The page: a section for each command, with what it takes.
pub(super) fn page(introduction: &str, program: &Command) -> String {
    let mut text = format!("# Commands\n\n{introduction}\n");
    for command in program.get_subcommands() {
        write_command(&mut text, program.get_name(), command);
    }
    text
}

fn write_command(text: &mut String, before: &str, command: &Command) {
    let name = format!("{before} {}", command.get_name());
    let arguments = || command.get_arguments().filter(|argument| !argument.is_hide_set());
    if command.get_subcommands().next().is_none() {
        let files: String =
            arguments().filter(|one| one.is_positional()).map(|one| format!(" {}", positional(one))).collect();
        let _ = write!(text, "\n## `{name}`\n\n{}\n\n    {name}{files} [OPTIONS]\n", about(command));
        let rows: Vec<&Arg> = arguments().collect();
        if !rows.is_empty() {
            text.push_str("\n| option | meaning |\n|---|---|\n");
        }
        for argument in rows {
            let _ = writeln!(text, "| {} | {} |", written(argument), meaning(argument));
        }
    }
    for inner in command.get_subcommands() {
        write_command(text, &name, inner);
    }
}

fn about(command: &Command) -> String {
    let about = command.get_long_about().or_else(|| command.get_about());
    about.map_or_else(String::new, |words| paragraphs(&words.to_string()))
}

/// A file or word without an option before it, in brackets where it may be left out.
fn positional(argument: &Arg) -> String {
    let name = value_names(argument);
    if argument.is_required_set() { name } else { format!("[{name}]") }
}

/// An option as it is written: `-o, --output FILE`.
fn written(argument: &Arg) -> String {
    if argument.is_positional() {
        return format!("`{}`", value_names(argument));
    }
    let short = argument.get_short().map(|letter| format!("-{letter}"));
    let long = argument.get_long().map(|word| format!("--{word}"));
    let names: Vec<String> = short.into_iter().chain(long).collect();
    let takes = argument.get_action().takes_values();
    let value = if takes { format!(" {}", value_names(argument)) } else { String::new() };
    format!("`{}{value}`", names.join(", "))
}

fn value_names(argument: &Arg) -> String {
    match argument.get_value_names() {
        Some(names) => names.iter().map(ToString::to_string).collect::<Vec<_>>().join(" "),
        None => argument.get_id().as_str().to_uppercase(),
    }
}

/// What an option means, the values that it knows, and the one that stands when it is absent.
fn meaning(argument: &Arg) -> String {
    let help = argument.get_long_help().or_else(|| argument.get_help());
    let mut text =
        help.map_or_else(String::new, |words| words.to_string().split_whitespace().collect::<Vec<_>>().join(" "));
    if !text.ends_with(['.', ')', ':']) {
        text.push('.');
    }
    let takes = argument.get_action().takes_values();
    let known = argument.get_possible_values();
    if takes && !known.is_empty() {
        let words: Vec<String> = known
            .iter()
            .filter(|value| !value.is_hide_set())
            .map(|value| match value.get_help() {
                Some(help) => format!("`{}` ({help})", value.get_name()),
                None => format!("`{}`", value.get_name()),
            })
            .collect();
        let _ = write!(text, " One of: {}.", words.join(", "));
    }
    let absent: Vec<String> =
        argument.get_default_values().iter().map(|value| format!("`{}`", value.to_string_lossy())).collect();
    if takes && !absent.is_empty() && !argument.is_hide_default_value_set() {
        let _ = write!(text, " When absent: {}.", absent.join(", "));
    }
    text.replace('|', "\\|").replace('<', "&lt;")
}

/// A text with its paragraphs, as Markdown.
fn paragraphs(text: &str) -> String {
    let lines: Vec<&str> = text.lines().map(str::trim_end).collect();
    let end = if text.ends_with(['.', ':']) { "" } else { "." };
    format!("{}{end}", lines.join("\n").replace('<', "&lt;"))
}
