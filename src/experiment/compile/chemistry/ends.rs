//! The meaning of a link's ends in this experiment: which cells, which atom, which field.

use super::{Part, within};
use crate::cell::ends::{self, AtomReading, AtomSetting, PodSetting, Reading, Sense, Setting};
use crate::equations::eml::{Endpoint, Index, LinkDescription, Root, Step};
use crate::equations::tree::QuantityId;
use crate::error::words;
use crate::error::{Fault, short};
use crate::mechanics::CONTROLLED;
use crate::mechanics::control::Handle;
use crate::sim::Kind;
use crate::sim::chemistry::{AtAtoms, AtomControl, Chemistry, Control, Source, Target, Whole, Whose};

/// Which end of a link is looked at.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Side {
    /// Where the number comes from.
    From,
    /// Where it goes.
    To,
}

/// What ends are looked up in: all documents, the one whose link it is, and the model so far.
pub(super) struct Ends<'a, 'b> {
    pub(super) parts: &'a [Part<'a>],
    pub(super) part: &'a Part<'a>,
    pub(super) kinds: &'b [Kind],
    /// How many cells of each kind there are at the start.
    pub(super) counts: &'b [usize],
    pub(super) chemistry: &'b mut Chemistry,
    /// Whether the experiment has contacts.
    pub(super) touching: bool,
    /// The names of the planes.
    pub(super) planes: &'b [&'b str],
}

impl Ends<'_, '_> {
    /// The meaning of an end that is read.
    pub(super) fn read(&mut self, end: &Endpoint, side: Side) -> Result<Source, Fault> {
        match &end.root {
            Root::Scene => self.read_scene(end),
            Root::Field(index) => self.read_field(end, index),
            _ => {
                let whose = self.whose(end, side)?;
                self.read_cell(end, whose)
            }
        }
    }

    fn read_scene(&self, end: &Endpoint) -> Result<Source, Fault> {
        match parts_of(&end.path)[..] {
            [("time", None)] => Ok(Source::Time),
            [("chemistry", Some(Index::Name(name))), (id, None)] => self.other(end, name, id, None),
            _ => {
                let message = format!("the scene has no number `{}`", end.text);
                Err(within(&end.location, "not known", message, "it has scene.time and scene.chemistry[NAME].ID"))
            }
        }
    }

    /// A number of a whole field, or the field as the cell that has the system senses it.
    fn read_field(&mut self, end: &Endpoint, index: &Index) -> Result<Source, Fault> {
        let (field, species) = self.species(end, index)?;
        if let [(word, None)] = parts_of(&end.path)[..] {
            let whole = [
                ("mean", Whole::Mean),
                ("largest", Whole::Largest),
                ("smallest", Whole::Smallest),
                ("amount", Whole::Amount),
            ];
            if let Some((_, what)) = whole.iter().find(|(name, _)| *name == word) {
                return Ok(Source::Whole(field, species, *what));
            }
        }
        let Some(sense) = ends::sense(&end.path) else { return Err(unknown_of_field(end)) };
        let whose = self.whose(end, Side::From)?;
        Ok(self.sensed(whose, field, species, sense))
    }

    fn sensed(&mut self, whose: Whose, field: usize, species: usize, sense: Sense) -> Source {
        let sensed = &mut self.chemistry.sensed;
        let known = sensed.iter().position(|channel| *channel == (field, species));
        let channel = known.unwrap_or_else(|| {
            sensed.push((field, species));
            sensed.len() - 1
        });
        Source::Sensed(whose, channel, sense)
    }

    fn read_cell(&mut self, end: &Endpoint, whose: Whose) -> Result<Source, Fault> {
        match parts_of(&end.path)[..] {
            [("atoms", None), ..] => return self.read_atoms(end, whose),
            [("neighbours", _), ..] => return self.read_neighbours(end, whose),
            [("field", Some(index)), ..] => {
                let (field, species) = self.species(end, index)?;
                let sense = ends::sense(&end.path[1..]).ok_or_else(|| unknown_of_field(end))?;
                return Ok(self.sensed(whose, field, species, sense));
            }
            [("atom", Some(Index::Number(atom))), ("field", Some(index)), ..] => {
                let (atom, index) = (*atom, index.clone());
                self.check_atom(end, whose, atom)?;
                let (field, species) = self.species(end, &index)?;
                let sense = ends::sense(&end.path[2..]).ok_or_else(|| unknown_of_field(end))?;
                return Ok(Source::AtAtom(whose, atom, field, species, sense));
            }
            [("chemistry", Some(Index::Name(name))), (id, None)] => return self.other(end, name, id, Some(whose)),
            _ => {}
        }
        let Some(reading) = ends::reading(&end.path) else {
            let message = format!("a cell has nothing to read that is called `{}`", end.text);
            let help = format!("it has {}", words::all_of(ends::READABLE));
            return Err(within(&end.location, &meant(end, ends::READABLE), message, help));
        };
        if let Reading::Atom(atom, _) = reading {
            self.check_atom(end, whose, atom)?;
        }
        let open = self.kinds_of(whose).into_iter().find(|kind| !self.kinds[*kind].closed);
        if let (Some(kind), Reading::Volume | Reading::VolumeStrain) = (open, reading) {
            let message = format!("cells of type `{}` enclose no volume", self.kinds[kind].name);
            return Err(within(&end.location, "no volume", message, "read the area, or give the type a closed mesh"));
        }
        Ok(Source::Cell(whose, reading))
    }

    /// The meaning of an end that is set.
    pub(super) fn set(&mut self, end: &Endpoint) -> Result<Target, Fault> {
        if matches!(end.root, Root::Scene | Root::Field(_)) {
            let message = format!("{} cannot be set", end.text);
            let help = "set an <input> of the field's document from there, or what belongs to a cell or a type";
            return Err(within(&end.location, "cannot be set", message, help));
        }
        let whose = self.whose(end, Side::To)?;
        let Some(setting) = ends::setting(&end.path) else {
            let message = format!("`{}` is nothing that can be set", end.text);
            let known = ends::settable();
            let known = || known.iter().map(String::as_str);
            let help = format!("of a cell can be set {}", words::all_of(known()));
            return Err(within(&end.location, &meant(end, known()), message, help));
        };
        self.check_setting(end, whose, &setting)?;
        let control = match setting {
            Setting::MotilitySpeed => Control::MotilitySpeed,
            Setting::Bias(axis) => Control::Bias(axis),
            Setting::Pseudopods(what) => Control::Pseudopods(what),
            Setting::Stiffness => Control::Stiffness,
            Setting::Adhesion => Control::Adhesion,
            Setting::RestVolume => Control::RestVolume,
            Setting::RestVolumeRatio => Control::RestVolumeRatio,
            Setting::Atom(atom, axis) => Control::Atom(atom, axis),
            Setting::Force(handle, name) => Control::Force(handle, self.numbered(end, whose, handle, &name)?),
            Setting::Secretion(name) => Control::Secretion(self.secreted(end, name)?),
            Setting::Atoms(what) => Control::Atoms(match what {
                AtomSetting::Protrusion => AtomControl::Protrusion,
                AtomSetting::Tension => AtomControl::Tension,
                AtomSetting::Elasticity => AtomControl::Elasticity,
                AtomSetting::Adhesion => AtomControl::Adhesion,
                AtomSetting::Secretion(name) => AtomControl::Secretion(self.secreted(end, name)?),
            }),
        };
        Ok(Target::Cell(whose, control))
    }

    /// The channel into which cells secrete a species.
    fn secreted(&mut self, end: &Endpoint, name: String) -> Result<usize, Fault> {
        let channel = self.species(end, &Index::Name(name))?;
        let secreted = &mut self.chemistry.secreted;
        let known = secreted.iter().position(|one| *one == channel);
        Ok(known.unwrap_or_else(|| {
            secreted.push(channel);
            secreted.len() - 1
        }))
    }

    /// What differs from atom to atom, for a system that has a number for each.
    fn read_atoms(&mut self, end: &Endpoint, whose: Whose) -> Result<Source, Fault> {
        if whose != Whose::Own || self.part.document.membrane.is_none() {
            let message =
                format!("{} has a number for each atom, which only a membrane of the cell takes up", end.text);
            let help = "link it to an <input level=\"membrane\"> of a document of level=\"membrane\" that the type has";
            return Err(within(&end.location, "of atoms", message, help));
        }
        if let [_, ("field", Some(index)), ..] = parts_of(&end.path)[..] {
            let index = index.clone();
            let (field, species) = self.species(end, &index)?;
            let sense = ends::sense(&end.path[2..]).ok_or_else(|| unknown_of_field(end))?;
            return Ok(Source::Atoms(AtAtoms::Sensed(field, species, sense)));
        }
        let named = match parts_of(&end.path)[1..] {
            [("in_contact", Some(index))] => {
                Some(AtomReading::InContact(Some(self.numbered_type(end, index, "in_contact[TYPE]")?)))
            }
            [("on_plane", Some(index))] => Some(AtomReading::OnPlane(Some(self.numbered_plane(end, index)?))),
            _ => None,
        };
        let Some(reading) = named.or_else(|| ends::atom_reading(&end.path[1..])) else {
            let known = || ends::READABLE.into_iter().filter(|word| word.starts_with("atoms."));
            let message = format!("atoms have nothing to read that is called `{}`", end.text);
            let help = format!("there is {}", words::all_of(known()));
            return Err(within(&end.location, &meant(end, known()), message, help));
        };
        Ok(Source::Atoms(AtAtoms::Read(reading)))
    }

    /// Whether all cells concerned have what is set.
    fn check_setting(&self, end: &Endpoint, whose: Whose, setting: &Setting) -> Result<(), Fault> {
        for number in self.kinds_of(whose) {
            let kind = &self.kinds[number];
            let free = kind.volume == crate::sim::VolumeRule::Free;
            let (lacking, help) = match setting {
                Setting::MotilitySpeed if !kind.has_speed() => {
                    ("has no Brownian motility", "add `motility = { brownian = … }`, or set motility.bias")
                }
                Setting::Pseudopods(_) if !kind.has_pseudopods() => {
                    ("has no pseudopods", "add `pseudopods = { … }` to the type")
                }
                Setting::Pseudopods(PodSetting::Protrusion | PodSetting::Retraction)
                    if kind.has_several_pseudopods() =>
                {
                    (
                        "has several pseudopods at once, which have times of their own",
                        "remove `most` and `beside` from its pseudopods, or link their cue only",
                    )
                }
                Setting::Atoms(_) if kind.rest.facets.is_empty() => {
                    ("has no surface", "give the type a mesh with facets")
                }
                Setting::Atoms(AtomSetting::Elasticity) if !kind.has_membrane() => (
                    "has no membrane whose moduli could differ from atom to atom",
                    "give it `membrane` in its mechanics, or set cell.stiffness",
                ),
                Setting::Adhesion | Setting::Atoms(AtomSetting::Adhesion) if !self.touching => {
                    ("touches nothing in this experiment", "add a [contact] table with a strength")
                }
                Setting::RestVolume | Setting::RestVolumeRatio if free => {
                    ("has no volume that is kept", "give it a closed mesh and the volume rule exact or compressible")
                }
                Setting::Atom(..) if matches!(whose, Whose::Cell(_)) && self.counts[number] > 1 => {
                    ("has other cells whose atom would be held with it", "make the cell a type of its own")
                }
                Setting::Atom(..) if kind.rigid.is_some() => {
                    ("is rigid, so that its atoms move only together", "set an atom of a cell that deforms")
                }
                Setting::Atom(atom, _) if kind.moved.iter().any(|moved| moved.atoms.contains(&(*atom as u32))) => {
                    ("moves that atom on a course", "leave the atom out of `moved`, or set another one")
                }
                _ => continue,
            };
            let message = format!("{} cannot be set: type `{}` {lacking}", end.text, kind.name);
            return Err(within(&end.location, "cannot be set", message, help));
        }
        if let Setting::Atom(atom, _) = setting {
            self.check_atom(end, whose, *atom)?;
        }
        Ok(())
    }

    /// The number of a force by its name among those with a handle, the same in all kinds concerned.
    fn numbered(&self, end: &Endpoint, whose: Whose, handle: usize, name: &str) -> Result<usize, Fault> {
        let Handle { word: one, key: many, .. } = CONTROLLED[handle];
        let mut found = None;
        for kind in self.kinds_of(whose) {
            let kind = &self.kinds[kind];
            let known: Vec<&str> = kind.controlled(handle).collect();
            let Some(number) = known.iter().position(|known| *known == name) else {
                let message = format!("type `{}` has no {one} `{name}`", kind.name);
                let help = match known.is_empty() {
                    true => format!("add [[cells.{}.{many}]] with that name to the experiment", kind.name),
                    false => format!("its {many} are {}", words::all_of(known)),
                };
                return Err(within(&end.location, &format!("no such {one}"), message, help));
            };
            if found.is_some_and(|other| other != number) {
                let message = format!("{one} `{name}` stands at another place in type `{}`", kind.name);
                let help = format!("list the {many} of the types that share the system in the same order");
                return Err(within(&end.location, "not the same", message, help));
            }
            found = Some(number);
        }
        Ok(found.unwrap_or(0))
    }

    /// A quantity of a system, and the document that describes it.
    pub(super) fn quantity(&self, end: &Endpoint, name: &str, id: &str) -> Result<(&Part<'_>, QuantityId), Fault> {
        let systems = || self.parts.iter().filter(|part| !part.is_field());
        let Some(part) = systems().find(|part| part.name == name) else {
            let message = format!("there is no system `{name}`");
            let help = format!("systems here are {}", words::all_of(systems().map(|part| part.name)));
            return Err(within(&end.location, "not known", message, help));
        };
        let Some(quantity) = part.document.system.find(id) else {
            let ids = part.document.system.quantities.iter().map(|q| q.id.as_str());
            let label = words::meant(id, ids).map_or("not known".to_owned(), |near| format!("did you mean `{near}`?"));
            let message = format!("the system `{name}` has no quantity `{id}`");
            return Err(within(&end.location, &label, message, "name a quantity that its document declares"));
        };
        if part.is_local(quantity) {
            return Err(differs(end));
        }
        Ok((part, quantity))
    }

    /// A quantity of another system.
    fn other(&self, end: &Endpoint, name: &str, id: &str, whose: Option<Whose>) -> Result<Source, Fault> {
        let (part, quantity) = self.quantity(end, name, id)?;
        let has = |kind: &usize| part.kinds.contains(kind);
        match whose {
            None if !part.kinds.is_empty() => {
                let message = format!("`{name}` is a system of cells, so that the scene has no single one");
                Err(within(&end.location, "of cells", message, format!("write cell.chemistry[{name}].{id}")))
            }
            Some(whose) if !self.kinds_of(whose).iter().all(has) => {
                let message = format!("not all cells of {} have the system `{name}`", end.text);
                let help = format!("add \"{name}\" to the `chemistry` of their type, or write scene.chemistry[{name}]");
                Err(within(&end.location, "no such system there", message, help))
            }
            _ => Ok(Source::Other(part.number, quantity, whose.unwrap_or(Whose::Own))),
        }
    }

    /// The cells that an end names.
    fn whose(&self, end: &Endpoint, side: Side) -> Result<Whose, Fault> {
        let shared = self.part.kinds.is_empty();
        let whose = match &end.root {
            Root::Cell(Some(Index::Number(cell))) => {
                let cells = self.counts.iter().sum::<usize>();
                if *cell >= cells {
                    let message = format!("there is no cell {cell}: the experiment has {cells}");
                    return Err(within(&end.location, "no such cell", message, "cells are numbered from 0"));
                }
                Whose::Cell(*cell as u64)
            }
            Root::Cell(Some(Index::Name(name))) => {
                let message = format!("cells have numbers, not names such as `{name}`");
                let help = format!("write cell[0], or type[{name}] for all cells of a type");
                return Err(within(&end.location, "not a number", message, help));
            }
            Root::Type(index) => Whose::Kind(self.numbered_type(end, index, "type[NAME]")?),
            _ if shared => {
                let message = format!("{} is of the cell that has the system, but the scene has it", end.text);
                let help = format!(
                    "add `chemistry = [\"{}\"]` to a type of cells, or name cell[0] or type[NAME]",
                    self.part.name
                );
                return Err(within(&end.location, "which cell?", message, help));
            }
            _ => Whose::Own,
        };
        if side == Side::To && whose != Whose::Own && !shared {
            let message = format!("each cell that has `{}` would set {}", self.part.name, end.text);
            return Err(within(
                &end.location,
                "set by many",
                message,
                "a system of cells sets its own cell: write cell.…",
            ));
        }
        Ok(whose)
    }

    /// The number of the type of cells with a name.
    pub(super) fn numbered_type(&self, end: &Endpoint, index: &Index, written: &str) -> Result<usize, Fault> {
        let Index::Name(name) = index else {
            let message = "types of cells have names, not numbers".to_owned();
            return Err(within(&end.location, "not a name", message, format!("write {written}")));
        };
        let known = || self.kinds.iter().map(|kind| kind.name.as_str());
        known().position(|kind| kind == name).ok_or_else(|| {
            let label = words::meant(name, known()).map(|near| format!("did you mean `{near}`?"));
            let help = format!("types of cells here are {}", words::all_of(known()));
            let message = format!("there is no type of cells `{name}`");
            within(&end.location, label.as_deref().unwrap_or("unknown type"), message, help)
        })
    }

    /// The number of the plane or tool with a name.
    fn numbered_plane(&self, end: &Endpoint, index: &Index) -> Result<usize, Fault> {
        let Index::Name(name) = index else {
            let message = "planes and tools have names, not numbers".to_owned();
            return Err(within(&end.location, "not a name", message, "write on_plane[NAME]"));
        };
        let known = || self.planes.iter().copied();
        known().position(|plane| plane == name).ok_or_else(|| {
            let label = words::meant(name, known()).map(|near| format!("did you mean `{near}`?"));
            let help = match self.planes.is_empty() {
                true => "the experiment has no [[planes]] and no [[tools]]".to_owned(),
                false => format!("planes and tools here are {}", words::all_of(known())),
            };
            let message = format!("there is no plane or tool `{name}`");
            within(&end.location, label.as_deref().unwrap_or("unknown name"), message, help)
        })
    }

    /// The kinds of the cells that an end names.
    fn kinds_of(&self, whose: Whose) -> Vec<usize> {
        match whose {
            Whose::Own => self.part.kinds.clone(),
            Whose::Kind(kind) => vec![kind],
            Whose::Cell(cell) => kind_of_cell(self.counts, cell).into_iter().collect(),
        }
    }

    fn check_atom(&self, end: &Endpoint, whose: Whose, atom: usize) -> Result<(), Fault> {
        for kind in self.kinds_of(whose) {
            let (name, atoms) = (&self.kinds[kind].name, self.kinds[kind].atoms());
            if atom >= atoms {
                let message = format!("cells of type `{name}` have no atom {atom}");
                let help = format!("their atoms are numbered from 0 to {}", atoms - 1);
                return Err(within(&end.location, "no such atom", message, help));
            }
        }
        Ok(())
    }

    /// Whether the cells that sense or feed a field are larger than its boxes.
    pub(super) fn check_grid(&self, link: &LinkDescription, from: &Source, to: &Target) -> Result<(), Fault> {
        let (whose, field, location) = match (*from, *to) {
            (Source::Sensed(whose, channel, _), _) => (whose, self.chemistry.sensed[channel].0, &link.from.location),
            (Source::AtAtom(whose, _, field, ..), _) => (whose, field, &link.from.location),
            (Source::Atoms(AtAtoms::Sensed(field, ..)), _) => (Whose::Own, field, &link.from.location),
            (_, Target::Cell(whose, Control::Secretion(channel) | Control::Atoms(AtomControl::Secretion(channel)))) => {
                (whose, self.chemistry.secreted[channel].0, &link.to.location)
            }
            _ => return Ok(()),
        };
        let grid = self.chemistry.fields[field].system.grid();
        let spacing = grid.spacing[0];
        for kind in self.kinds_of(whose) {
            let kind = &self.kinds[kind];
            let size =
                crate::geometry::bounding_box(&kind.rest.positions).map_or(0.0, |(low, high)| (high - low).min());
            // A flat cell, such as a sheet, is measured across.
            let size = if size > 0.0 { size } else { kind.edge };
            if spacing > size {
                let (name, spacing, size) = (&self.chemistry.fields[field].name, short(spacing), short(size));
                let message = format!(
                    "the grid of `{name}` is too coarse for cells of type `{}`: its boxes are {spacing} um wide, the \
                     cells {size} um",
                    kind.name
                );
                let help = format!("give the document's <grid> a spacing of at most {size} um, better half of it");
                return Err(within(location, "here cells and field meet", message, help));
            }
        }
        Ok(())
    }

    /// The field with a name, and its species.
    fn species(&self, end: &Endpoint, index: &Index) -> Result<(usize, usize), Fault> {
        let Index::Name(name) = index else {
            let message = "fields have names, not numbers".to_owned();
            return Err(within(&end.location, "not a name", message, "write field[NAME]"));
        };
        let fields = || self.chemistry.fields.iter().enumerate();
        let found: Vec<(usize, usize)> =
            fields().filter_map(|(n, field)| field.system.species_number(name).map(|species| (n, species))).collect();
        match found[..] {
            [one] => Ok(one),
            [] => {
                let known =
                    || fields().flat_map(|(_, field)| field.system.species()).map(|species| species.name.as_str());
                let label = words::meant(name, known()).map(|near| format!("did you mean `{near}`?"));
                let help = match known().next() {
                    Some(_) => format!("fields here are {}", words::all_of(known())),
                    None => "the experiment has no fields: name a document with <field> in [chemistry]".to_owned(),
                };
                let message = format!("there is no field `{name}`");
                Err(within(&end.location, label.as_deref().unwrap_or("unknown field"), message, help))
            }
            _ => {
                let message = format!("{} documents have a field `{name}`", found.len());
                Err(within(&end.location, "which one?", message, "give fields of different documents different names"))
            }
        }
    }
}

fn unknown_of_field(end: &Endpoint) -> Fault {
    let message = format!("a field has nothing to read that is called `{}`", end.text);
    let help = "cells sense field[NAME], field[NAME].gradient.x and field[NAME].steepness; the whole field has .mean, \
                .largest, .smallest and .amount";
    within(&end.location, "not known", message, help)
}

/// The word that was meant by the path of an end.
fn meant<'a>(end: &Endpoint, known: impl IntoIterator<Item = &'a str>) -> String {
    let path = end.text.split_once('.').map_or("", |(_, path)| path);
    words::meant(path, known).map_or("not known".to_owned(), |near| format!("did you mean `{near}`?"))
}

pub(super) fn parts_of(path: &[Step]) -> Vec<(&str, Option<&Index>)> {
    path.iter().map(|step| (step.name.as_str(), step.index.as_ref())).collect()
}

/// The kind of a cell by its id, where there are so many of each kind at the start.
pub(super) fn kind_of_cell(counts: &[usize], cell: u64) -> Option<usize> {
    let ends = counts.iter().scan(0, |end, count| {
        *end += *count as u64;
        Some(*end)
    });
    ends.enumerate().find(|(_, end)| cell < *end).map(|(kind, _)| kind)
}

/// An end that is another number at each atom.
pub(super) fn differs(end: &Endpoint) -> Fault {
    let message = format!("{} differs from atom to atom, and a link carries one number of a cell", end.text);
    let help = "link from a <mean> or an <integral> of it";
    within(&end.location, "on the membrane", message, help)
}
