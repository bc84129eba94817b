//! XML in one pass over the text, for every language of documents that is XML.
//!
//! [`Reader`] gives one [`Event`] after the other: an element begins, a text, an element ends. Names are resolved in
//! their namespaces, references in texts and values are replaced, comments and processing instructions are left out,
//! and everything knows the bytes of the document where it stands. [`Document`] keeps the events as a tree, for
//! languages whose parts are looked up in any order. quick-xml cuts the text into its pieces; what makes a document
//! well-formed is checked here.
//!
//! What only a hostile text has is refused where it stands: a document type, and with it all entities of its own, and
//! what goes beyond [`Limits`]. Nothing takes more than linear time.

mod attributes;
mod blank;
mod characters;
mod document;
mod malformed;
mod names;
mod reader;
mod trouble;

pub use attributes::Attribute;
pub use characters::{Characters, referred};
pub use document::{Document, Node};
pub use names::{Namespace, XML};
pub use reader::{Event, Reader, Start};
pub use trouble::{Trouble, What};

/// How much of a document is read.
#[derive(Debug, Clone, Copy)]
pub struct Limits {
    /// Most bytes; never more than 4 GiB.
    pub bytes: usize,
    /// Most elements open at once.
    pub depth: usize,
    /// Most elements and texts that a [`Document`] keeps; a [`Reader`] keeps none.
    pub nodes: usize,
    /// Most attributes of an element, declarations of namespaces among them.
    pub attributes: usize,
}
