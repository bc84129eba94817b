//! Tables of numbers as functions of one argument: rows in the document or in a file beside it.

use super::context::Context;
use super::xml::Element;
use crate::equations::expression::{Function, Node, NodeKind, parse};
use crate::error::{Fault, Location, Source};
use std::ops::Range;
use std::sync::Arc;

/// The most rows of a table: what calls it goes through them one after the other.
const MOST_ROWS: usize = 1000;
/// The largest file that is read, bytes.
pub(super) const LARGEST_FILE: u64 = 4 << 20;
/// The name of the argument in the function that a table is.
const ARGUMENT: &str = "x";

/// How values between rows are found.
#[derive(Clone, Copy, PartialEq)]
enum Interpolation {
    Linear,
    Step,
    Cubic,
}

/// The function that a table is; `units` are those of argument and value, as they are written, where the document has units.
pub(super) fn table(context: &mut Context, element: &Element, units: Option<[&str; 2]>) -> Option<Function> {
    let interpolation = match element.word("interpolation").as_str() {
        "" | "linear" => Interpolation::Linear,
        "step" => Interpolation::Step,
        "cubic" => Interpolation::Cubic,
        other => {
            let message = format!("`interpolation` cannot be \"{other}\"");
            let help = "write \"linear\", \"step\" or \"cubic\"";
            context.fault(element.location("interpolation"), &message, "unknown word", help);
            return None;
        }
    };
    let rows = match element.attribute("file") {
        Some(_) => from_file(context, element),
        None => from_text(context, element),
    }?;
    Some(Function { arguments: vec![ARGUMENT.to_owned()], body: body(&rows, interpolation, units) })
}

/// What is wrong with a table: its bytes, what was found, a few words beside them, what to do.
type Misread = (Range<usize>, String, &'static str, &'static str);

/// Rows of a text with where they stand in it: two numbers each.
type Cells<'t> = Vec<[(&'t str, Range<usize>); 2]>;

/// The numbers of rows.
fn numbers(cells: &Cells) -> Result<Vec<[f64; 2]>, Misread> {
    let mut rows: Vec<[f64; 2]> = Vec::with_capacity(cells.len());
    for row in cells {
        let mut read = [0.0; 2];
        for (value, (word, at)) in read.iter_mut().zip(row) {
            *value = word.parse().ok().filter(|value: &f64| value.is_finite()).ok_or_else(|| {
                (at.clone(), format!("\"{word}\" is not a number"), "in the table", "write numbers such as 0.5 or 1e-3")
            })?;
        }
        if let Some([before, _]) = rows.last().filter(|[before, _]| *before >= read[0]) {
            let message = format!("the rows of the table are not in order: {} comes after {before}", read[0]);
            let help = "sort the rows by their argument, which has one value each";
            return Err((row[0].1.clone(), message, "not above the one before", help));
        }
        if rows.len() == MOST_ROWS {
            let help = "leave rows out: an expression goes through them one after the other";
            return Err((row[0].1.clone(), format!("the table has more than {MOST_ROWS} rows"), "one too many", help));
        }
        rows.push(read);
    }
    Ok(rows)
}

/// Rows in the document: two numbers a line.
fn from_text(context: &mut Context, element: &Element) -> Option<Vec<[f64; 2]>> {
    for name in ["argument", "value"].into_iter().filter(|name| element.attribute(name).is_some()) {
        let message = format!("`{name}` names a column of a file, and the table has none");
        context.fault(element.location(name), &message, "which file?", "write file=\"…\", or remove it");
    }
    let text = &element.text;
    let mut cells = Cells::new();
    for (at, line) in lines(&text.text) {
        let words = words(line, |c| c.is_whitespace() || c == ',' || c == ';');
        if let [a, b] = words[..] {
            cells.push([a, b].map(|(start, word)| (word, at + start..at + start + word.len())));
        } else {
            let message = format!("a row of the table has {} numbers; 2 were expected", words.len());
            let help = "write a line for each row: the argument, a blank and the value";
            context.fault(text.location(&(at..at + line.len())), &message, "this row", help);
            return None;
        }
    }
    if cells.len() < 2 {
        let help = "write two rows or more, or file=\"…\" with argument=\"…\" and value=\"…\"";
        context.fault(element.location("id"), "the table has less than two rows", "of what?", help);
        return None;
    }
    match numbers(&cells) {
        Ok(rows) => Some(rows),
        Err((at, message, label, help)) => {
            context.fault(text.location(&at), &message, label, help);
            None
        }
    }
}

/// Rows of two columns of a file with a line of names.
fn from_file(context: &mut Context, element: &Element) -> Option<Vec<[f64; 2]>> {
    let name = element.word("file");
    let at = element.location("file");
    if !element.text.text.trim().is_empty() {
        context.fault(element.at.clone(), "the table has a file and rows", "which?", "remove one of the two");
    }
    let Some(folder) = context.files.folder.clone() else {
        let help = "write the rows between <table …> and </table>";
        context.fault(at, "this document is read from no folder, and names a file", "where?", help);
        return None;
    };
    let path = folder.join(context.path(at.start, &name));
    let text = match context.files.text(&path, LARGEST_FILE) {
        Ok(text) => text,
        Err(error) if error.kind() == std::io::ErrorKind::FileTooLarge => {
            let message = format!("{name} cannot be a table: {error}");
            context.fault(at, &message, "this file", "leave columns and rows out");
            return None;
        }
        Err(error) => {
            let message = format!("{name} cannot be read: {error}");
            let help = format!("paths are those from the document: {} was looked for", path.display());
            context.fault(at, &message, "this file", &help);
            return None;
        }
    };
    let source = Arc::new(Source { name: path.display().to_string(), text });
    match columns(&source.text, element).and_then(|cells| match cells.len() {
        0 | 1 => Err((0..0, "the table has less than two rows".into(), "of what?", "write two rows or more")),
        _ => numbers(&cells),
    }) {
        Ok(rows) => Some(rows),
        Err((at, message, label, help)) => {
            let location = Location { source, start: at.start, length: at.len(), label: label.to_owned() };
            context.fault_elsewhere(Fault::new(message).at(location).help(help));
            None
        }
    }
}

/// The cells of the two columns that a table names, of its file.
fn columns<'t>(text: &'t str, element: &Element) -> Result<Cells<'t>, Misread> {
    let mut lines = lines(text);
    let (start, head) = lines.next().unwrap_or((0, ""));
    let sign = [';', '\t'].into_iter().find(|sign| head.contains(*sign)).unwrap_or(',');
    let names = cells(head, sign);
    let mut chosen = [0, 1];
    for (column, name) in
        chosen.iter_mut().zip(["argument", "value"]).filter(|(_, name)| element.attribute(name).is_some())
    {
        let wanted = element.word(name);
        *column = names.iter().position(|(_, word)| *word == wanted).ok_or_else(|| {
            let message = format!("the file has no column \"{wanted}\", which is the `{name}` of the table");
            (start..start + head.len(), message, "the names of its columns", "the first line of a file has their names")
        })?;
    }
    let mut found = Cells::new();
    for (at, line) in lines {
        let row = cells(line, sign);
        let cell = |column: usize| {
            let (start, word) = row.get(column).copied().ok_or_else(|| {
                let message = format!("a row has {} columns; {} were expected", row.len(), column + 1);
                (at..at + line.len(), message, "this row", "give each row as many columns as the first line has")
            })?;
            Ok((word, at + start..at + start + word.len()))
        };
        found.push([cell(chosen[0])?, cell(chosen[1])?]);
    }
    Ok(found)
}

/// Lines that hold something and are no remarks, with where they begin.
fn lines(text: &str) -> impl Iterator<Item = (usize, &str)> {
    let all = text.split('\n').scan(0, |start, line| {
        let at = *start;
        *start += line.len() + 1;
        Some((at, line.trim_end_matches('\r')))
    });
    all.filter(|(_, line)| !line.trim().is_empty() && !line.trim_start().starts_with('#'))
}

/// Words of a line between separators, with where they begin.
fn words(line: &str, parts: impl Fn(char) -> bool) -> Vec<(usize, &str)> {
    let begin = |word: &str| word.as_ptr() as usize - line.as_ptr() as usize;
    line.split(parts).filter(|word| !word.is_empty()).map(|word| (begin(word), word)).collect()
}

/// Cells of a line of a file, without blanks and quotes around them.
fn cells(line: &str, sign: char) -> Vec<(usize, &str)> {
    let begin = |word: &str| word.as_ptr() as usize - line.as_ptr() as usize;
    let bare = |word: &'_ str| -> usize {
        word.len() - word.trim_start_matches(|c: char| c.is_whitespace() || c == '"').len()
    };
    line.split(sign)
        .map(|word| {
            let word = &word[bare(word)..];
            let word = word.trim_end_matches(|c: char| c.is_whitespace() || c == '"');
            (begin(word), word)
        })
        .collect()
}

/// The function: one piece after the other; before the first row and after the last one it stays as it is there.
fn body(rows: &[[f64; 2]], interpolation: Interpolation, units: Option<[&str; 2]>) -> Node {
    let unit = |which: usize| units.map_or(String::new(), |units| format!(" [{}]", units[which]));
    let (argument, value) = (unit(0), unit(1));
    let part = |text: String| parse(&text).0;
    let slopes = slopes(rows);
    let mut parts = Vec::with_capacity(2 * rows.len() + 1);
    if interpolation != Interpolation::Step {
        parts.extend([part(format!("{}{value}", rows[0][1])), part(format!("{ARGUMENT} < {}{argument}", rows[0][0]))]);
    }
    for (pair, slope) in rows.windows(2).zip(slopes.windows(2)) {
        let ([[t0, v0], [t1, v1]], [m0, m1]) = ([pair[0], pair[1]], [slope[0], slope[1]]);
        let (length, rise) = (t1 - t0, v1 - v0);
        let share = format!("({ARGUMENT} - ({t0}{argument}))/({length}{argument})");
        parts.push(part(match interpolation {
            Interpolation::Step => format!("{v0}{value}"),
            Interpolation::Linear => format!("{v0}{value} + {share}*({rise}{value})"),
            Interpolation::Cubic => {
                let (first, last) = (m0 * length, m1 * length);
                let (second, third) = (3.0 * rise - 2.0 * first - last, first + last - 2.0 * rise);
                format!("{v0}{value} + {share}*({first}{value} + {share}*({second}{value} + {share}*({third}{value})))")
            }
        }));
        parts.push(part(format!("{ARGUMENT} < {t1}{argument}")));
    }
    parts.push(part(format!("{}{value}", rows[rows.len() - 1][1])));
    Node { kind: NodeKind::Call("piecewise".to_owned(), 0..0, parts), at: 0..0 }
}

/// Slopes at the rows for cubic pieces that rise and fall with the rows and nowhere else (F. N. Fritsch and J. Butland, SIAM Journal on
/// Scientific and Statistical Computing 5 (1984) 300-304).
fn slopes(rows: &[[f64; 2]]) -> Vec<f64> {
    let of = |pair: &[[f64; 2]]| (pair[1][0] - pair[0][0], (pair[1][1] - pair[0][1]) / (pair[1][0] - pair[0][0]));
    let pieces: Vec<(f64, f64)> = rows.windows(2).map(of).collect();
    let end = |(h, d): (f64, f64), next: Option<(f64, f64)>| {
        let Some((h1, d1)) = next else { return d };
        let slope = ((2.0 * h + h1) * d - h * d1) / (h + h1);
        match () {
            () if slope * d <= 0.0 => 0.0,
            () if d * d1 <= 0.0 && slope.abs() > 3.0 * d.abs() => 3.0 * d,
            () => slope,
        }
    };
    let inner = pieces.windows(2).map(|pair| {
        let ((h0, d0), (h1, d1)) = (pair[0], pair[1]);
        if d0 * d1 <= 0.0 {
            return 0.0;
        }
        let (w0, w1) = (2.0 * h1 + h0, h1 + 2.0 * h0);
        (w0 + w1) / (w0 / d0 + w1 / d1)
    });
    let last = pieces.len() - 1;
    let ends = [end(pieces[0], pieces.get(1).copied()), end(pieces[last], last.checked_sub(1).map(|at| pieces[at]))];
    std::iter::once(ends[0]).chain(inner).chain([ends[1]]).collect()
}
