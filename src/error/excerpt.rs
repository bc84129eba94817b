//! The few lines of a text that are drawn with a fault, cut to what a terminal can show.

use super::Location;
use miette::{MietteError, MietteSpanContents, SourceCode, SourceSpan, SpanContents};

/// The longest line, in characters, that is drawn as a whole. Texts that a program wrote may be a single line of megabytes, and no
/// terminal shows, and no library draws, a caret at the column of a million.
const LONGEST_LINE: usize = 240;

/// The characters that are drawn of a longer line.
const WINDOW: usize = 100;

/// Those among them in front of what is marked.
const IN_FRONT: usize = 40;

/// Stands where a line is cut.
const CUT: char = '…';

/// The line in which a fault begins and one on each side of it, with their number in the text: whatever the location, the span lies in
/// the first line, between characters.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Excerpt {
    name: String,
    text: String,
    /// The number of its first line in the whole text, from 0.
    line: usize,
    /// The characters of the whole line before the span.
    column: usize,
    /// First byte of the span in the excerpt, and its number of bytes.
    span: (usize, usize),
}

impl Excerpt {
    /// Of the text around a location. A location beyond its text, or within a character, is moved to where there is one.
    pub(super) fn around(location: &Location) -> Self {
        let (name, text) = (location.source.name.clone(), location.source.text.as_str());
        let start = boundary_before(text, location.start);
        let end = boundary_behind(text, location.start.saturating_add(location.length)).max(start);
        let line_start = text[..start].rfind('\n').map_or(0, |at| at + 1);
        let line_end = text[start..].find('\n').map_or(text.len(), |at| start + at);
        let mut excerpt = Self { name, text: String::new(), line: 0, column: 0, span: (0, 0) };
        excerpt.line = text.as_bytes()[..line_start].iter().filter(|byte| **byte == b'\n').count();
        if let Some(before) = text[..line_start].strip_suffix('\n') {
            excerpt.line -= 1;
            excerpt.add(&before[before.rfind('\n').map_or(0, |at| at + 1)..], 0);
            excerpt.text.push('\n');
        }
        excerpt.add_marked(&text[line_start..line_end], [start - line_start, end.min(line_end) - line_start]);
        if line_end < text.len() {
            let after = &text[line_end + 1..];
            excerpt.text.push('\n');
            excerpt.add(&after[..after.find('\n').unwrap_or(after.len())], 0);
            // The end of a line is what shows that there is an empty one.
            excerpt.text.extend(after.contains('\n').then_some('\n'));
        }
        excerpt
    }

    /// First byte and number of bytes of what is marked.
    pub(super) fn span(&self) -> (usize, usize) {
        self.span
    }

    /// Adds a line from one of its bytes on, cut where it is too long.
    fn add(&mut self, line: &str, from: usize) {
        let cut = from > 0 || line.chars().nth(LONGEST_LINE).is_some();
        if from > 0 {
            self.text.push(CUT);
        }
        let mut rest = line[from..].trim_end_matches('\r').chars();
        self.text.extend(rest.by_ref().take(if cut { WINDOW } else { LONGEST_LINE }).map(shown));
        if rest.next().is_some() {
            self.text.push(CUT);
        }
    }

    /// Adds the line that is marked between two of its bytes.
    fn add_marked(&mut self, line: &str, [start, end]: [usize; 2]) {
        self.column = line[..start].chars().count();
        let is_long = line.chars().nth(LONGEST_LINE).is_some();
        let from = match line[..start].char_indices().rev().nth(IN_FRONT) {
            Some((at, _)) if is_long => at,
            _ => 0,
        };
        let first = self.text.len();
        self.add(line, from);
        let lengths: Vec<usize> = self.text[first..].chars().map(char::len_utf8).collect();
        // In characters, since some are shown as others of another length.
        let begin = line[from..start].chars().count() + usize::from(from > 0);
        let marked = line[start..end].chars().take(if is_long { WINDOW } else { LONGEST_LINE }).count();
        let bytes = |from: usize, to: usize| lengths.iter().take(to).skip(from).sum::<usize>();
        self.span = (first + bytes(0, begin), bytes(begin, begin + marked));
    }
}

/// The last position between characters that is not behind a byte.
fn boundary_before(text: &str, at: usize) -> usize {
    (0..=at.min(text.len())).rev().find(|at| text.is_char_boundary(*at)).unwrap_or(0)
}

/// The first position between characters that is not before a byte.
fn boundary_behind(text: &str, at: usize) -> usize {
    (at..text.len()).find(|at| text.is_char_boundary(*at)).unwrap_or(text.len())
}

/// A character as it is drawn: one that would drive the terminal is shown as a stranger.
fn shown(c: char) -> char {
    if c.is_control() && c != '\t' { char::REPLACEMENT_CHARACTER } else { c }
}

impl SourceCode for Excerpt {
    fn read_span<'a>(
        &'a self,
        span: &SourceSpan,
        context_lines_before: usize,
        context_lines_after: usize,
    ) -> Result<Box<dyn SpanContents<'a> + 'a>, MietteError> {
        let part = self.text.as_str().read_span(span, context_lines_before, context_lines_after)?;
        // The place in front of the lines is asked for without any line around the span.
        let column = if context_lines_before == 0 { self.column } else { 0 };
        Ok(Box::new(MietteSpanContents::new_named(
            self.name.clone(),
            part.data(),
            *part.span(),
            self.line + part.line(),
            column,
            part.line_count(),
        )))
    }
}

/// A sentence of a message, cut in its middle where it is longer than anyone reads: what a document says may be a part of it.
pub(super) fn shortened(words: &str) -> String {
    const MOST: usize = 4000;
    if words.len() <= MOST {
        return words.to_owned();
    }
    let (head, tail) = (boundary_before(words, MOST / 2), boundary_behind(words, words.len() - MOST / 4));
    format!("{} {CUT} {}", &words[..head], &words[tail..])
}

#[cfg(test)]
mod tests {
    use super::super::Source;
    use super::*;
    use std::sync::Arc;

    fn excerpt(text: &str, start: usize, length: usize) -> Excerpt {
        let source = Arc::new(Source { name: "a".into(), text: text.into() });
        Excerpt::around(&Location { source, start, length, label: String::new() })
    }

    /// What an excerpt marks.
    fn marked(excerpt: &Excerpt) -> &str {
        &excerpt.text[excerpt.span.0..excerpt.span.0 + excerpt.span.1]
    }

    #[test]
    fn the_line_and_its_neighbours_are_kept() {
        let found = excerpt("one\ntwo\nthree four\r\nfive\nsix\n", 14, 4);
        assert_eq!((found.text.as_str(), found.line, found.column), ("two\nthree four\nfive\n", 1, 6));
        assert_eq!(marked(&found), "four");
        let last = excerpt("one\n", 4, 3);
        assert_eq!((last.text.as_str(), last.line, last.column, last.span), ("one\n", 0, 0, (4, 0)));
    }

    #[test]
    fn a_long_line_is_cut_around_what_is_marked() {
        let line = format!("{}ß = \"wrong\" {}", "é".repeat(70_000), "b".repeat(70_000));
        let found = excerpt(&format!("a\n{line}\n{line}"), line.find("wrong").unwrap() + 2, 5);
        assert_eq!((marked(&found), found.column), ("wrong", 70_005));
        assert!(found.text.lines().all(|line| line.chars().count() <= WINDOW + 2), "{}", found.text);
        assert!(found.text.lines().nth(1).unwrap().starts_with("…é"), "{}", found.text);
        let wide = excerpt(&line, 0, line.len());
        assert_eq!(marked(&wide).chars().count(), WINDOW);
    }

    #[test]
    fn a_span_that_is_nowhere_is_moved() {
        for (text, start, length) in
            [("", 8, 5), ("aß", 2, 1), ("aß\nb", 1, 1), ("ab\ncd", 1, 4), ("a", usize::MAX, usize::MAX)]
        {
            let found = excerpt(text, start, length);
            assert!(found.text.get(found.span.0..found.span.0 + found.span.1).is_some(), "{text} {start}");
        }
        assert_eq!(marked(&excerpt("aß", 2, 1)), "ß");
        assert_eq!(marked(&excerpt("ab\ncd", 1, 4)), "b");
        assert_eq!(excerpt("a\u{1b}[31mb", 7, 1).text, "a\u{fffd}[31mb");
    }

    #[test]
    fn only_what_is_too_long_is_shortened() {
        assert_eq!(shortened("short"), "short");
        let long = shortened(&format!("begin{}end", "ß".repeat(100_000)));
        assert!(long.starts_with("begin") && long.ends_with("end") && long.len() < 4000);
    }
}
