//! What a document says beyond its language, kept so that it is written back.

/// Attributes in the order of the document: their names as they stand there, prefixes and declarations of namespaces
/// among them, and their values.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Attributes(Box<[(Box<str>, Box<str>)]>);

impl Attributes {
    /// The value of the attribute with a name.
    pub fn get(&self, name: &str) -> Option<&str> {
        self.iter().find(|(own, _)| *own == name).map(|(_, value)| value)
    }

    /// Names and values.
    pub fn iter(&self) -> impl Iterator<Item = (&str, &str)> {
        self.0.iter().map(|(name, value)| (&**name, &**value))
    }

    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }
}

impl<N: Into<Box<str>>, V: Into<Box<str>>> FromIterator<(N, V)> for Attributes {
    fn from_iter<I: IntoIterator<Item = (N, V)>>(list: I) -> Self {
        Self(list.into_iter().map(|(name, value)| (name.into(), value.into())).collect())
    }
}

/// An element that the language does not know: its text from the first tag to the last.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Foreign(pub(super) Box<str>);

impl Foreign {
    /// The text, which is well-formed XML but for prefixes that are declared around it.
    pub fn text(&self) -> &str {
        &self.0
    }
}
