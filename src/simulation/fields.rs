//! The fields of a simulation: grids and values.

use std::sync::Arc;

use super::error::SimulationError;
use super::stepping::Simulation;
use crate::sim::chemistry::{FieldReactor, FieldState};

/// The fields of one document of equations, which share a grid.
#[derive(Debug, Clone, Copy)]
pub struct FieldView<'a> {
    reactor: &'a FieldReactor,
    now: &'a FieldState,
}

impl<'a> FieldView<'a> {
    /// The name of the document in the experiment's `[chemistry]`.
    pub fn name(&self) -> &'a str {
        &self.reactor.name
    }

    /// Number of boxes along x, y and z; one along z where the field lies on the substrate.
    pub fn boxes(&self) -> [usize; 3] {
        self.reactor.system.grid().cells
    }

    /// Size of a box along each axis, µm.
    pub fn spacing(&self) -> [f64; 3] {
        self.reactor.system.grid().spacing
    }

    /// The corner of the first box, µm.
    pub fn origin(&self) -> [f64; 3] {
        self.reactor.system.grid().origin.into()
    }

    /// Names of its species.
    pub fn species(&self) -> impl ExactSizeIterator<Item = &'a str> + use<'a> {
        self.reactor.system.species().iter().map(|species| species.name.as_str())
    }

    /// The unit of a species as its document writes it, empty where it has none.
    ///
    /// # Errors
    /// [`SimulationError::Unknown`] for a species that the field does not have.
    pub fn unit(&self, species: &str) -> Result<&'a str, SimulationError> {
        Ok(&self.reactor.system.units()[self.number(species)?])
    }

    /// The values of a species, one a box, x fastest, then y, then z, in its unit, without a copy.
    ///
    /// # Errors
    /// [`SimulationError::Unknown`] for a species that the field does not have.
    pub fn values(&self, species: &str) -> Result<&'a [f64], SimulationError> {
        let (number, length) = (self.number(species)?, self.reactor.system.grid().len());
        Ok(&self.now.values[number * length..(number + 1) * length])
    }

    /// The values of all species, one species after the other, each as [`FieldView::values`] has it: without a copy, to be held on to.
    /// They stay what they are while the simulation goes on, which takes memory of its own for what comes.
    ///
    /// ```
    /// # use pseudopod::simulation::{Simulation, EXAMPLE};
    /// let text = format!("{EXAMPLE}[chemistry.medium]\ndocument = \"medium.eml\"");
    /// let medium = r#"<eml name="medium"><grid dimension="2" spacing="5" origin="-20 -20" size="40 40"/>
    ///     <field id="food" decay="0.1" initial="1"/></eml>"#;
    /// let mut simulation = Simulation::builder().equations("medium.eml", medium).text("example", &text)?;
    /// let before = simulation.field("medium")?.share();
    /// simulation.run_until(1.0)?;
    /// assert!(before.iter().all(|value| *value == 1.0));
    /// assert!(simulation.field("medium")?.values("food")?.iter().all(|value| *value < 0.91));
    /// # Ok::<(), pseudopod::simulation::SimulationError>(())
    /// ```
    pub fn share(&self) -> Arc<Vec<f64>> {
        self.now.values.share()
    }

    fn number(&self, species: &str) -> Result<usize, SimulationError> {
        self.reactor.system.species_number(species).ok_or_else(|| SimulationError::Unknown {
            what: "species",
            name: species.to_owned(),
            known: self.species().map(str::to_owned).collect(),
        })
    }
}

impl Simulation {
    /// All fields, in the order of the document.
    pub fn fields(&self) -> impl ExactSizeIterator<Item = FieldView<'_>> {
        let now = &self.state.chemistry.fields;
        self.model.chemistry.fields.iter().zip(now).map(|(reactor, now)| FieldView { reactor, now })
    }

    /// The fields of a document, by its name in the experiment.
    ///
    /// # Errors
    /// [`SimulationError::Unknown`] for a name that is not there.
    pub fn field(&self, name: &str) -> Result<FieldView<'_>, SimulationError> {
        self.fields().find(|field| field.name() == name).ok_or_else(|| SimulationError::Unknown {
            what: "field",
            name: name.to_owned(),
            known: self.fields().map(|field| field.name().to_owned()).collect(),
        })
    }
}
