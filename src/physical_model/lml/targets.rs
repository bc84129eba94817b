//! What a load acts on: atoms by their indices, components and cells by their names.

use std::fmt;

/// What a load acts on.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Target {
    /// An atom.
    Index(u32),
    /// Atoms from one index to another, both included.
    Range(u32, u32),
    /// A component or a cell; it may have blanks in it.
    Name(Box<str>),
}

impl Target {
    /// Reads one of a list. What begins with a digit is an index or a range of them.
    ///
    /// # Errors
    /// A few words of what is expected there.
    pub(super) fn of(text: &str) -> Result<Self, &'static str> {
        let text = text.trim();
        if !text.starts_with(|c: char| c.is_ascii_digit()) {
            return if text.is_empty() {
                Err("nothing stands between two commas")
            } else {
                Ok(Self::Name(text.into()))
            };
        }
        let index = |text: &str| text.trim().parse::<u32>().map_err(|_| "it is no index of an atom");
        match text.split_once('-') {
            None => index(text).map(Self::Index),
            Some((first, last)) => match (index(first)?, index(last)?) {
                (first, last) if first <= last => Ok(Self::Range(first, last)),
                _ => Err("the range ends before it begins"),
            },
        }
    }
}

impl fmt::Display for Target {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self {
            Self::Index(index) => index.fmt(f),
            Self::Range(first, last) => write!(f, "{first}-{last}"),
            Self::Name(name) => f.write_str(name),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn indices_ranges_and_names_with_blanks_are_told_apart() {
        assert_eq!(Target::of(" 24 "), Ok(Target::Index(24)));
        assert_eq!(Target::of("1-10"), Ok(Target::Range(1, 10)));
        assert_eq!(Target::of("another_One_Here 4"), Ok(Target::Name("another_One_Here 4".into())));
        for bad in ["", "3rd", "10-1", "1-", "4294967296"] {
            assert!(Target::of(bad).is_err(), "{bad}");
        }
    }
}
