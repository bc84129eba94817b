//! Errors as the terminal shows them: the location in the text, what was found, what to do.

use super::excerpt::{Excerpt, shortened};
use super::{Error, Fault};
use miette::{GraphicalReportHandler, GraphicalTheme, LabeledSpan, MietteDiagnostic};

/// The width of messages, in characters; fixed, so that a message looks the same everywhere.
const WIDTH: usize = 110;

/// The most faults that are drawn: nobody reads more at once, and a document can have a hundred thousand.
const MOST_DRAWN: usize = 200;

/// Whether messages are coloured.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Paint {
    /// With the terminal's colours.
    Coloured,
    /// Without.
    Plain,
}

/// An error as text for the terminal: every fault with its line of the source and a caret, then how many there are.
pub fn render(error: &Error, paint: Paint) -> String {
    match error {
        Error::Input(faults) => {
            let drawn = faults.iter().take(MOST_DRAWN);
            let mut text: String = drawn.map(|fault| fault_text(fault, paint) + "\n").collect();
            if faults.len() > MOST_DRAWN {
                text.push_str(&format!("{} more: correct these first\n", faults.len() - MOST_DRAWN));
            }
            text.push_str(&count(faults));
            text
        }
        Error::Numbers { message, help, kept } => {
            let kept = kept.as_ref().map(|path| format!("; the last good state is kept in {}", path.display()));
            plain_text(message, &format!("{help}{}", kept.unwrap_or_default()), paint)
        }
        Error::Interrupted { result, .. } => {
            let help = format!("go on with: pseudopod resume {}", result.display());
            plain_text(&error.to_string(), &help, paint)
        }
        Error::Stopped { message, help } | Error::Machine { message, help } => plain_text(message, help, paint),
    }
}

fn plain_text(message: &str, help: &str, paint: Paint) -> String {
    fault_text(&Fault::new(message).help(help), paint)
}

fn fault_text(fault: &Fault, paint: Paint) -> String {
    let mut diagnostic = MietteDiagnostic::new(shortened(&fault.message));
    diagnostic.help = fault.help.as_deref().map(shortened);
    let theme = match paint {
        Paint::Coloured => GraphicalTheme::unicode(),
        Paint::Plain => GraphicalTheme::unicode_nocolor(),
    };
    let handler = GraphicalReportHandler::new_themed(theme).with_width(WIDTH).with_context_lines(1).with_links(false);
    let mut text = String::new();
    let rendered = match &fault.location {
        Some(location) => {
            let label = (!location.label.is_empty()).then(|| shortened(&location.label));
            let excerpt = Excerpt::around(location);
            let diagnostic = diagnostic.with_label(LabeledSpan::new_primary_with_span(label, excerpt.span()));
            handler.render_report(&mut text, miette::Report::new(diagnostic).with_source_code(excerpt).as_ref())
        }
        None => handler.render_report(&mut text, &diagnostic),
    };
    match rendered {
        Ok(()) => text.lines().map(|line| format!("{}\n", line.trim_end())).collect(),
        Err(_) => format!("{}\n", fault.message),
    }
}

/// "3 faults in experiment.toml".
fn count(faults: &[Fault]) -> String {
    let mut names: Vec<&str> = Vec::new();
    for location in faults.iter().filter_map(|fault| fault.location.as_ref()) {
        let name = if location.source.name.starts_with("--set") { "--set" } else { &location.source.name };
        if !names.contains(&name) {
            names.push(name);
        }
    }
    let number = match faults.len() {
        1 => "1 fault".to_owned(),
        many => format!("{many} faults"),
    };
    if names.is_empty() { format!("{number}\n") } else { format!("{number} in {}\n", names.join(" and ")) }
}

#[cfg(test)]
mod tests {
    use super::super::{Location, Source};
    use super::*;
    use std::sync::Arc;

    #[test]
    fn a_fault_shows_file_line_column_and_caret() {
        let source = Arc::new(Source { name: "a.toml".into(), text: "one\ntwo three\n".into() });
        let location = Location { source, start: 8, length: 5, label: "a number was expected".into() };
        let error = Error::input(Fault::new("`three` is a word").at(location).help("write 3"));
        let text = render(&error, Paint::Plain);
        for part in ["a.toml:2:5", "two three", "──┬──", "a number was expected", "help: write 3", "1 fault in a.toml"]
        {
            assert!(text.contains(part), "{part} in\n{text}");
        }
        assert!(!text.contains('\u{1b}') && render(&error, Paint::Coloured).contains('\u{1b}'));
    }

    #[test]
    fn a_location_beyond_the_text_is_no_reason_to_panic() {
        let source = Arc::new(Source { name: "a.toml".into(), text: String::new() });
        let location = Location { source, start: 8, length: 5, label: "here".into() };
        assert!(render(&Error::input(Fault::new("lost").at(location)), Paint::Plain).contains("lost"));
    }
    #[test]
    fn a_fault_beyond_the_widest_terminal_is_drawn_with_its_place() {
        let source = Arc::new(Source { name: "a.toml".into(), text: format!("{}untl = 1", " ".repeat(70_000)) });
        let location = Location { source, start: 70_000, length: 4, label: "did you mean `until`?".into() };
        let text = render(&Error::input(Fault::new("unknown key").at(location)), Paint::Plain);
        assert!(text.contains("a.toml:1:70001") && text.contains("untl = 1") && text.len() < 2000, "{text}");
    }

    #[test]
    fn many_faults_are_drawn_in_part_and_counted_in_whole() {
        let text = render(&Error::Input(vec![Fault::new("wrong"); 40_000]), Paint::Plain);
        assert_eq!(text.matches("wrong").count(), MOST_DRAWN);
        assert!(text.ends_with("39800 more: correct these first\n40000 faults\n"), "{text}");
    }
}
