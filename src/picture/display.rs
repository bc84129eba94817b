//! What a person may want of a picture beside what its document says: each is about the look, none about what was simulated.

use crate::error::{Error, Fault, Result};

/// How a picture is shown.
#[derive(Debug, Clone, PartialEq)]
pub struct Display {
    /// The title, in place of the experiment's; empty for none.
    pub title: Option<String>,
    /// What is written beside the colour bar of the cells, in place of the quantity and its unit.
    pub label: Option<String>,
    /// How much larger things are than where all of them just fit in, about the middle of what is seen.
    pub zoom: f64,
    /// Types of cells that are not shown.
    pub hidden: Vec<String>,
    /// Whether there is a scale bar.
    pub scale_bar: bool,
    /// Whether the time is written.
    pub time: bool,
    /// Whether it is shown which way x, y and z go.
    pub axes: bool,
    /// Whether the edges of facets are drawn.
    pub edges: bool,
}

impl Default for Display {
    fn default() -> Self {
        Self {
            title: None,
            label: None,
            zoom: 1.0,
            hidden: Vec::new(),
            scale_bar: true,
            time: true,
            axes: true,
            edges: false,
        }
    }
}

impl Display {
    /// Which of these types are shown.
    ///
    /// # Errors
    /// [`Error::Input`] for a hidden type that is none of them.
    pub fn shown(&self, types: &[String]) -> Result<Vec<bool>> {
        self.hidden.iter().try_for_each(|name| known(name, types))?;
        Ok(types.iter().map(|name| !self.hidden.contains(name)).collect())
    }
}

/// Makes sure that there is a type of this name.
///
/// # Errors
/// [`Error::Input`] that lists what there is.
pub fn known(name: &str, types: &[String]) -> Result<()> {
    if types.iter().any(|known| known == name) {
        return Ok(());
    }
    let near = types.iter().map(|other| (strsim::damerau_levenshtein(name, other), other)).min();
    let meant = near.filter(|(apart, _)| *apart <= 2).map(|(_, other)| format!("did you mean `{other}`? "));
    let fault = Fault::new(format!("no cells are of the type `{name}`"));
    Err(Error::input(fault.help(format!("{}there are: {}", meant.unwrap_or_default(), types.join(", ")))))
}
