//! What a program sets of single cells, in the words that links use.

use super::error::SimulationError;
use super::id::CellId;
use super::stepping::Simulation;
use crate::cell::ends::{PodSetting, Setting, settable, setting, word_of};
use crate::equations::eml::{Step, read_end};
use crate::equations::tree::System;
use crate::geometry;
use crate::sim::chemistry::{Control, Target, Whose, missed, set_control};
use crate::sim::{Kind, VolumeRule};

impl Simulation {
    /// Sets what mechanics reads of one cell, from the next step on, until it is set again. A link of the document that sets the
    /// same writes over it whenever it carries its number.
    ///
    /// | `what` | is | unit |
    /// |---|---|---|
    /// | `fibre[NAME]` | activation of fibres, 0 to 1, in place of their course | 1 |
    /// | `load[NAME]` | factor of a load | 1 |
    /// | `motility.speed` | speed of the Brownian walk | µm/s |
    /// | `motility.bias.x`, `.y`, `.z` | a velocity added to the walk | µm/s |
    /// | `pseudopods.cue.x`, `.y`, `.z` | what makes directions of new pseudopods likelier | 1 |
    /// | `pseudopods.protrusion`, `pseudopods.retraction` | how much they push and draw, 0 to 1, in place of their times | 1 |
    /// | `stiffness` | factor of all elastic forces | 1 |
    /// | `adhesion` | factor of the strength with which the cell sticks | 1 |
    /// | `rest_volume`, `rest_volume_ratio` | volume at rest, also over that of the mesh | µm³, 1 |
    /// | `secretion[FIELD]` | amount released each second, negative: taken up | of the field |
    ///
    /// ```
    /// # use pseudopod::simulation::{Simulation, EXAMPLE};
    /// let mut simulation = Simulation::from_text("example", EXAMPLE)?;
    /// let cell = simulation.types().nth(1).unwrap().cells().next().unwrap();
    /// while simulation.time() < 2.0 {
    ///     simulation.set(cell, "fibre[belt]", 0.5 * (1.0 - simulation.time().cos()))?;
    ///     simulation.step()?;
    /// }
    /// # Ok::<(), pseudopod::simulation::SimulationError>(())
    /// ```
    ///
    /// # Errors
    /// [`SimulationError::Unknown`] and [`SimulationError::NoSuchCell`] for what is not there,
    /// [`SimulationError::NotSettable`] for what this cell does not have, [`SimulationError::Value`] for a number that it cannot
    /// be. Nothing has changed then.
    pub fn set(&mut self, cell: CellId, what: &str, value: f64) -> Result<(), SimulationError> {
        let (kind, _) = self.kind_and_number(cell)?;
        let control = self.control(cell, &self.model.kinds[kind], what)?;
        if let Some(expected) = missed(Target::Cell(Whose::Own, control), value) {
            return Err(SimulationError::Value { what: of_cell(what, cell), value, expected });
        }
        let (number, cells) = (self.position_of(cell)?, self.state.cells());
        self.state.chemistry.controls.admit(control, cells);
        match control {
            Control::Bias(_) => self.state.kinds[kind].is_biased = !self.model.kinds[kind].is_biased(),
            Control::Secretion(channel) if channel == self.secreted().count() => {
                let species = self.species(what);
                self.state.chemistry.controls.secreted.extend(species);
            }
            _ => {}
        }
        let (control, value) = match control {
            Control::RestVolumeRatio => (Control::RestVolume, value * geometry::volume(&self.model.kinds[kind].rest)),
            other => (other, value),
        };
        set_control(&self.model, number, control, value, &mut self.state);
        Ok(())
    }

    /// The meaning of a word for a cell of a kind.
    fn control(&self, cell: CellId, kind: &Kind, what: &str) -> Result<Control, SimulationError> {
        let Some(setting) = setting(&path(what)) else {
            let known = settable().into_iter().filter(|word| !word.starts_with("atom")).collect();
            return Err(SimulationError::Unknown { what: "setting", name: what.to_owned(), known });
        };
        let lacks = |why: &str, help| {
            let why = format!("type `{}` {why}", kind.name);
            Err(SimulationError::NotSettable { what: of_cell(what, cell), why, help })
        };
        let unknown = |what, name: &str, known| Err(SimulationError::Unknown { what, name: name.to_owned(), known });
        match setting {
            Setting::MotilitySpeed if !kind.has_speed() => {
                lacks("has no Brownian motility", "give it one, or set motility.bias.x")
            }
            Setting::Pseudopods(_) if !kind.has_pseudopods() => {
                lacks("has no pseudopods", "add `pseudopods = { … }` to the type")
            }
            Setting::Pseudopods(PodSetting::Protrusion | PodSetting::Retraction) if kind.has_several_pseudopods() => {
                lacks(
                    "has several pseudopods at once, which have times of their own",
                    "set their cue, or let `most` be 1",
                )
            }
            Setting::Adhesion if self.model.contact.is_none() => {
                lacks("touches nothing in this experiment", "add a [contact] table with a strength")
            }
            Setting::RestVolume | Setting::RestVolumeRatio if kind.volume == VolumeRule::Free => {
                lacks("has no volume that is kept", "give it a closed mesh and the volume rule exact or compressible")
            }
            Setting::Atom(..) => lacks(
                "has atoms that move by forces",
                "pull them by a load or by fibres; positions are imposed by a link of the document",
            ),
            Setting::Atoms(_) => lacks("has atoms of which only chemistry sets it", "let a link of a document set it"),
            Setting::MotilitySpeed => Ok(Control::MotilitySpeed),
            Setting::Bias(axis) => Ok(Control::Bias(axis)),
            Setting::Pseudopods(what) => Ok(Control::Pseudopods(what)),
            Setting::Stiffness => Ok(Control::Stiffness),
            Setting::Adhesion => Ok(Control::Adhesion),
            Setting::RestVolume => Ok(Control::RestVolume),
            Setting::RestVolumeRatio => Ok(Control::RestVolumeRatio),
            Setting::Force(handle, name) => match kind.controlled(handle).position(|known| known == name) {
                Some(number) => Ok(Control::Force(handle, number)),
                None => unknown(word_of(handle), &name, kind.controlled(handle).map(str::to_owned).collect()),
            },
            Setting::Secretion(name) => match self.species(what) {
                Some(channel) => {
                    let known = self.secreted().position(|known| *known == channel);
                    Ok(Control::Secretion(known.unwrap_or(self.secreted().count())))
                }
                None => {
                    let known = self.fields().flat_map(|field| field.species().map(str::to_owned)).collect();
                    unknown("field", &name, known)
                }
            },
        }
    }

    /// What is secreted, field and species: by links of the document, or since a program set it.
    fn secreted(&self) -> impl Iterator<Item = &(usize, usize)> {
        self.model.chemistry.secreted.iter().chain(&self.state.chemistry.controls.secreted)
    }

    /// The species that a word such as `secretion[cAMP]` names: field and species.
    fn species(&self, what: &str) -> Option<(usize, usize)> {
        let Some(Setting::Secretion(name)) = setting(&path(what)) else { return None };
        let mut fields = self.model.chemistry.fields.iter().enumerate();
        fields.find_map(|(number, field)| field.system.species_number(&name).map(|species| (number, species)))
    }
}

/// A word as links write it behind `cell.`, taken apart; empty where it is none.
fn path(what: &str) -> Vec<Step> {
    read_end(&format!("cell.{what}"), &System::default()).map(|(_, path)| path).unwrap_or_default()
}

fn of_cell(what: &str, cell: CellId) -> String {
    format!("{what} of cell {cell}")
}
