//! How `render` shows things: from where, how large, which of them and with what written beside.

use crate::error::words::any_of;
use crate::error::{Error, Fault, Result};
use crate::experiment::{Picture, View};
use crate::output::ResultFile;
use crate::picture::Display;
use crate::picture::display::known;

/// Views by name: the eye goes round so far from the front, towards the right, and up so far, degrees.
const VIEWS: [(&str, [f64; 2]); 6] = [
    ("front", [0.0, 0.0]),
    ("right", [90.0, 0.0]),
    ("back", [180.0, 0.0]),
    ("left", [270.0, 0.0]),
    ("top", [0.0, 90.0]),
    ("bottom", [0.0, -90.0]),
];

/// The name of the view that the document has.
const OWN: &str = "document";

/// Options about the look of a picture.
#[derive(Debug, Clone, clap::Args)]
pub struct ShowArgs {
    /// From where: front (against y), back, left, right, top, bottom, or document for what the experiment says, as when absent.
    #[arg(long, value_name = "NAME", conflicts_with = "view_angles")]
    pub view: Option<String>,
    /// From where, in degrees: round from the front towards the right, and up; 90,0 is the right side and 0,90 the top.
    #[arg(long, value_name = "AZIMUTH,ELEVATION", value_parser = angles, allow_hyphen_values = true)]
    pub view_angles: Option<[f64; 2]>,
    /// How much larger than where everything just fits in, about the middle.
    #[arg(long, value_name = "FACTOR", value_parser = factor, allow_hyphen_values = true)]
    pub zoom: Option<f64>,
    /// Types of cells that are left out, by commas.
    #[arg(long, value_delimiter = ',', value_name = "TYPE")]
    pub hide: Vec<String>,
    /// The only types of cells that are shown, by commas.
    #[arg(long, value_delimiter = ',', value_name = "TYPE", conflicts_with = "hide")]
    pub only: Vec<String>,
    /// The title; the experiment's when absent.
    #[arg(long, value_name = "TEXT", conflicts_with = "no_title")]
    pub title: Option<String>,
    /// Leaves out the title.
    #[arg(long)]
    pub no_title: bool,
    /// Leaves out the scale bar.
    #[arg(long)]
    pub no_scale_bar: bool,
    /// Leaves out the time.
    #[arg(long)]
    pub no_time: bool,
    /// Leaves out which way x, y and z go.
    #[arg(long)]
    pub no_axes: bool,
    /// What is written beside the colour bar of the cells; the quantity and its unit when absent.
    #[arg(long, value_name = "TEXT")]
    pub label: Option<String>,
    /// Draws the edges of facets.
    #[arg(long)]
    pub edges: bool,
    /// Leaves out the background: a PNG of one instant that may lie over anything.
    #[arg(long)]
    pub transparent: bool,
}

impl ShowArgs {
    /// The view that is asked for.
    ///
    /// # Errors
    /// [`Error::Input`] for a name that is none, which lists those that there are.
    pub fn view(&self) -> Result<Option<View>> {
        let named = |name: &String| {
            let found = VIEWS.iter().find(|(known, _)| known == name).map(|(_, angles)| *angles);
            found.ok_or_else(|| {
                let names: Vec<&str> = VIEWS.iter().map(|(known, _)| *known).chain([OWN]).collect();
                let fault = Fault::new(format!("--view {name}: there is no such view"));
                Error::input(fault.help(format!("name {}, or say --view-angles AZIMUTH,ELEVATION", any_of(names))))
            })
        };
        let by_name = self.view.as_ref().filter(|name| *name != OWN).map(named).transpose()?;
        Ok(by_name.or(self.view_angles).map(seen_from))
    }

    /// What else is asked for.
    ///
    /// # Errors
    /// [`Error::Input`] for types that the result does not have, and for the label of a bar that is not there.
    pub fn display(&self, result: &ResultFile, picture: &Picture) -> Result<Display> {
        let types = result.layout().type_names();
        self.hide.iter().chain(&self.only).try_for_each(|name| known(name, &types))?;
        let is_hidden = |name: &String| self.hide.contains(name) || !(self.only.is_empty() || self.only.contains(name));
        if self.label.is_some() && picture.colour_by == "type" {
            let fault = Fault::new("--label: colours show types of cells, by their names, and no numbers");
            return Err(Error::input(fault.help("add --colour-by QUANTITY, whose bar has the label")));
        }
        Ok(Display {
            title: if self.no_title { Some(String::new()) } else { self.title.clone() },
            label: self.label.clone(),
            zoom: self.zoom.unwrap_or(1.0),
            hidden: types.iter().filter(|name| is_hidden(name)).cloned().collect(),
            scale_bar: !self.no_scale_bar,
            time: !self.no_time,
            axes: !self.no_axes,
            edges: self.edges,
        })
    }
}

/// The view of an eye that goes round and up by these angles, degrees.
fn seen_from([azimuth, elevation]: [f64; 2]) -> View {
    // Whole quarters are exact, so that what is seen from the front is seen from there to the last digit.
    let sin_cos = |degrees: f64| match degrees.rem_euclid(360.0) {
        0.0 => (0.0, 1.0),
        90.0 => (1.0, 0.0),
        180.0 => (0.0, -1.0),
        270.0 => (-1.0, 0.0),
        other => other.to_radians().sin_cos(),
    };
    let ((sin, cos), (rise, level)) = (sin_cos(azimuth), sin_cos(elevation));
    View { from: [sin * level, -cos * level, rise], up: [-sin * rise, cos * rise, level] }
}

/// Two angles in degrees.
fn angles(text: &str) -> std::result::Result<[f64; 2], String> {
    let numbers: Vec<f64> = text.split(',').filter_map(|part| part.trim().parse().ok()).collect();
    match numbers[..] {
        [azimuth, elevation] if azimuth.abs() <= 360.0 && elevation.abs() <= 90.0 => Ok([azimuth, elevation]),
        _ => Err("give two angles in degrees, as in 30,20: up to 360 round and up to 90 up or, with a minus, down"
            .to_owned()),
    }
}

/// A factor that a picture may be larger or smaller by.
fn factor(text: &str) -> std::result::Result<f64, String> {
    let number = text.trim().parse().ok().filter(|number| (0.01..=1000.0).contains(number));
    number.ok_or_else(|| "give a number from 0.01 to 1000, 2 for twice as large".to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn views_by_name_are_those_by_their_angles() {
        let of = |name: &str| seen_from(VIEWS.iter().find(|(known, _)| *known == name).expect("a view").1);
        assert_eq!(of("front"), View { from: [0.0, -1.0, 0.0], up: [0.0, 0.0, 1.0] });
        assert_eq!(of("right").from, [1.0, 0.0, 0.0]);
        assert_eq!(of("left").from, [-1.0, 0.0, 0.0]);
        assert_eq!(of("top"), View { from: [0.0, 0.0, 1.0], up: [0.0, 1.0, 0.0] });
        assert_eq!(of("bottom").from, [0.0, 0.0, -1.0]);
        let [x, y, z] = seen_from([30.0, 20.0]).from;
        assert!((x * x + y * y + z * z - 1.0).abs() < 1e-15 && x > 0.0 && y < 0.0 && z > 0.3, "{x} {y} {z}");
    }
}
