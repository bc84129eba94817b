//! The meaning of `cell.neighbours…`: numbers of the cells that a cell touches.

use super::ends::{Ends, parts_of};
use super::within;
use crate::cell::ends::{self, Reading};
use crate::equations::eml::{Endpoint, Index};
use crate::error::{Fault, words};
use crate::sim::chemistry::{NeighbourNumber, NeighbourReading, Source, Taken, Whose};

/// How the numbers of all neighbours become one.
const TAKEN: [(&str, Taken); 6] = [
    ("mean", Taken::Mean),
    ("sum", Taken::Sum),
    ("area_mean", Taken::AreaMean),
    ("area_sum", Taken::AreaSum),
    ("largest", Taken::Largest),
    ("smallest", Taken::Smallest),
];

impl Ends<'_, '_> {
    /// The meaning of an end that begins with the word `neighbours`.
    pub(super) fn read_neighbours(&self, end: &Endpoint, whose: Whose) -> Result<Source, Fault> {
        if whose != Whose::Own {
            let message = format!("{} is of other cells than the one that has the system", end.text);
            let help = "write cell.neighbours… in a system that the cells have, and read that one's quantity";
            return Err(within(&end.location, "not its own", message, help));
        }
        if !self.touching {
            let message = format!("{}: cells touch nothing in this experiment", end.text);
            return Err(within(&end.location, "no contacts", message, "add a [contact] table"));
        }
        let parts = parts_of(&end.path);
        let of_kind = match parts[0].1 {
            Some(index) => Some(self.numbered_type(end, index, "neighbours[TYPE]")?),
            None => None,
        };
        let (number, taken) = match parts[1..] {
            [("count", None)] => (NeighbourNumber::Count, Taken::Sum),
            [("area", None)] => (NeighbourNumber::Area, Taken::Sum),
            [.., (word, None)] if parts.len() > 2 => {
                let Some((_, taken)) = TAKEN.iter().find(|(name, _)| *name == word) else {
                    return Err(unknown(end, word));
                };
                let path = &end.path[1..end.path.len() - 1];
                let number = match parts[1..parts.len() - 1] {
                    [("chemistry", Some(Index::Name(name))), (id, None)] => {
                        self.quantity_of_neighbours(end, name, id, of_kind)?
                    }
                    _ => match ends::reading(path) {
                        Some(reading) if !matches!(reading, Reading::Atom(..)) => NeighbourNumber::Cell(reading),
                        _ => return Err(unknown(end, word)),
                    },
                };
                (number, *taken)
            }
            _ => return Err(unknown(end, parts[parts.len() - 1].0)),
        };
        Ok(Source::Neighbours(NeighbourReading { of_kind, number, taken }))
    }

    /// A quantity of a system that cells of some type have, or those of a type.
    fn quantity_of_neighbours(
        &self,
        end: &Endpoint,
        name: &str,
        id: &str,
        of_kind: Option<usize>,
    ) -> Result<NeighbourNumber, Fault> {
        let (part, quantity) = self.quantity(end, name, id)?;
        let has = match of_kind {
            Some(kind) => part.kinds.contains(&kind),
            None => !part.kinds.is_empty(),
        };
        if !has {
            let message = match of_kind {
                Some(kind) => format!("type `{}` does not have the system `{name}`", self.kinds[kind].name),
                None => format!("no type of cells has the system `{name}`"),
            };
            let help = format!("add \"{name}\" to the `chemistry` of their type");
            return Err(within(&end.location, "no such system there", message, help));
        }
        Ok(NeighbourNumber::Quantity(part.number, quantity))
    }
}

fn unknown(end: &Endpoint, word: &str) -> Fault {
    let known = || TAKEN.iter().map(|(name, _)| *name).chain(["count", "area"]);
    let label = words::meant(word, known()).map(|near| format!("did you mean `{near}`?"));
    let message = format!("neighbours have nothing to read that is called `{}`", end.text);
    let help = "there is neighbours.count, neighbours.area, and of what each of them has, such as neighbours.chemistry[NAME].ID \
                or neighbours.volume, the .mean, .sum, .area_mean, .area_sum, .largest and .smallest; neighbours[TYPE] \
                for those of a type";
    within(&end.location, label.as_deref().unwrap_or("not known"), message, help)
}
