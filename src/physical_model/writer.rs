//! Writes XML: an element a line, each level indented by two blanks more.

use super::kept::{Attributes, Foreign};
use super::number::shortest;
use std::io::{self, Write};

/// The value of an attribute.
pub(super) enum Value<'a> {
    Text(&'a str),
    Number(f64),
    Whole(i64),
}

/// Writes elements one after the other.
pub(super) struct Writer<W: Write> {
    out: W,
    open: Vec<&'static str>,
}

impl<W: Write> Writer<W> {
    /// Begins a document.
    pub fn new(mut out: W) -> io::Result<Self> {
        writeln!(out, "<?xml version=\"1.0\" encoding=\"UTF-8\"?>")?;
        Ok(Self { out, open: Vec::new() })
    }

    /// Begins an element; those of its attributes that are none are left out.
    pub fn begin(&mut self, name: &'static str, own: &[(&str, Option<Value>)], kept: &Attributes) -> io::Result<()> {
        self.tag(name, own, kept)?;
        self.open.push(name);
        writeln!(self.out, ">")
    }

    /// An element without content.
    pub fn empty(&mut self, name: &str, own: &[(&str, Option<Value>)], kept: &Attributes) -> io::Result<()> {
        self.tag(name, own, kept)?;
        writeln!(self.out, "/>")
    }

    /// An element with a text.
    pub fn text(&mut self, name: &str, text: &str) -> io::Result<()> {
        self.tag(name, &[], &Attributes::default())?;
        write!(self.out, ">")?;
        escape(&mut self.out, text)?;
        writeln!(self.out, "</{name}>")
    }

    /// Elements that are kept as they were.
    pub fn foreign(&mut self, list: &[Foreign]) -> io::Result<()> {
        list.iter().try_for_each(|foreign| {
            self.indent()?;
            writeln!(self.out, "{}", foreign.text())
        })
    }

    /// Ends the element that began last.
    pub fn end(&mut self) -> io::Result<()> {
        let name = self.open.pop().unwrap_or_default();
        self.indent()?;
        writeln!(self.out, "</{name}>")
    }

    fn tag(&mut self, name: &str, own: &[(&str, Option<Value>)], kept: &Attributes) -> io::Result<()> {
        self.indent()?;
        write!(self.out, "<{name}")?;
        for (key, value) in own {
            match value {
                None => continue,
                Some(Value::Text(text)) => self.attribute(key, text)?,
                Some(Value::Number(number)) => self.attribute(key, &shortest(*number))?,
                Some(Value::Whole(number)) => write!(self.out, " {key}=\"{number}\"")?,
            }
        }
        // What stands there already is not written twice, which no reader would take.
        let mut more = kept.iter().filter(|(key, _)| !own.iter().any(|(known, value)| known == key && value.is_some()));
        more.try_for_each(|(key, value)| self.attribute(key, value))
    }

    fn attribute(&mut self, key: &str, value: &str) -> io::Result<()> {
        write!(self.out, " {key}=\"")?;
        escape(&mut self.out, value)?;
        write!(self.out, "\"")
    }

    fn indent(&mut self) -> io::Result<()> {
        self.open.iter().try_for_each(|_| write!(self.out, "  "))
    }
}

/// Writes a text so that it reads back the same; characters that XML has not become U+FFFD.
fn escape(out: &mut impl Write, text: &str) -> io::Result<()> {
    for piece in text.split_inclusive(|c: char| c < ' ' || "&<>\"\u{fffe}\u{ffff}".contains(c)) {
        let last = piece.chars().next_back().unwrap_or_default();
        let (plain, special) = piece.split_at(piece.len() - last.len_utf8().min(piece.len()));
        write!(out, "{plain}")?;
        match last {
            '&' => write!(out, "&amp;"),
            '<' => write!(out, "&lt;"),
            '>' => write!(out, "&gt;"),
            '"' => write!(out, "&quot;"),
            '\t' | '\n' | '\r' => write!(out, "&#{};", u32::from(last)),
            '\u{fffe}' | '\u{ffff}' => write!(out, "\u{fffd}"),
            c if c < ' ' => write!(out, "\u{fffd}"),
            _ => write!(out, "{special}"),
        }?;
    }
    Ok(())
}
