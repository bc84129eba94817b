//! Links and what they read and set, as the Model holds them.

use crate::cell::ends::{AtomReading, PodSetting, Reading, Sense};
use crate::equations::tree::{Expr, QuantityId};

/// A link: a number goes from one end through the transfer to the other at each exchange.
#[derive(Debug, Clone)]
pub struct Link {
    /// The document's own words for it, for messages.
    pub text: String,
    /// Whose link it is.
    pub owner: Owner,
    /// Where the number comes from.
    pub from: Source,
    /// Where it goes.
    pub to: Target,
    /// What becomes of it: an expression of the owner's quantities and of the value.
    pub transfer: Expr,
    /// Quantities of the owner that the transfer uses.
    pub uses: Vec<QuantityId>,
    /// Quantities of the owner on which the number depends: those, and what is worked out at atoms.
    pub needs: Vec<QuantityId>,
    /// Factor of the transfer.
    pub gain: f64,
    /// Whether what it sets changes the rates of a system without events, or of fields, directly: then the system is told the mean of a step.
    pub drives: bool,
}

impl Link {
    /// Whether a system lets a cell or atoms release something by what it knows itself.
    pub fn is_own_release(&self) -> bool {
        let releases =
            matches!(self.to, Target::Cell(_, Control::Secretion(_) | Control::Atoms(AtomControl::Secretion(_))));
        releases && matches!(self.from, Source::Own(_) | Source::Time | Source::Atoms(AtAtoms::Shown(_)))
    }
}

/// Whose link it is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Owner {
    /// A system.
    Reactor(usize),
    /// A document of fields.
    Field(usize),
}

/// Which cells an end names.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Whose {
    /// The cell that has the system.
    Own,
    /// The cell with this id.
    Cell(u64),
    /// All cells of a kind: their mean where it is read, each of them where it is set.
    Kind(usize),
}

/// Where a number comes from.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Source {
    /// A quantity of the owner.
    Own(QuantityId),
    /// Simulated time, s.
    Time,
    /// A measure of a cell.
    Cell(Whose, Reading),
    /// A field as a cell senses it: the mean over its atoms of a channel of [`Chemistry::sensed`].
    Sensed(Whose, usize, Sense),
    /// A field at an atom: (whose, atom, field, species, what).
    AtAtom(Whose, usize, usize, usize, Sense),
    /// A number of a whole field: (field, species, what).
    Whole(usize, usize, Whole),
    /// A quantity of another system: (reactor, quantity, whose copy); the scene's only one for systems of the scene.
    Other(usize, QuantityId, Whose),
    /// A number of the cells that the cell touches which has the system.
    Neighbours(NeighbourReading),
    /// A number of each atom of the cell that has the system, for what differs from atom to atom.
    Atoms(AtAtoms),
}

/// Where numbers of atoms come from.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum AtAtoms {
    /// An expression that the membrane of the owner shows, transfer included.
    Shown(usize),
    /// The shape of the cell and what it touches.
    Read(AtomReading),
    /// A field: (field, species, what).
    Sensed(usize, usize, Sense),
}

impl Source {
    /// The cells that it names; none where it names none.
    pub fn whose(&self) -> Option<Whose> {
        match *self {
            Self::Cell(whose, _) | Self::Sensed(whose, ..) | Self::AtAtom(whose, ..) | Self::Other(.., whose) => {
                Some(whose)
            }
            Self::Own(_) | Self::Time | Self::Whole(..) | Self::Neighbours(_) | Self::Atoms(_) => None,
        }
    }

    /// The system and the quantity of it that is read, where it may be another one than the owner.
    pub fn quantity_of_other(&self) -> Option<(usize, QuantityId)> {
        match *self {
            Self::Other(number, quantity, _) => Some((number, quantity)),
            Self::Neighbours(NeighbourReading { number: NeighbourNumber::Quantity(number, quantity), .. }) => {
                Some((number, quantity))
            }
            _ => None,
        }
    }
}

/// What is read of the cells that a cell touches.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct NeighbourReading {
    /// The kind of those that are meant; none for all.
    pub of_kind: Option<usize>,
    /// What each of them has.
    pub number: NeighbourNumber,
    /// How these become one number.
    pub taken: Taken,
}

/// A number of a neighbour.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum NeighbourNumber {
    /// 1: how many there are.
    Count,
    /// The area that it shares with the cell, µm².
    Area,
    /// A measure of it.
    Cell(Reading),
    /// A quantity of a system that it has.
    Quantity(usize, QuantityId),
}

/// How numbers of neighbours become one.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Taken {
    /// Their mean.
    Mean,
    /// Their sum.
    Sum,
    /// Their mean with the areas that are shared as weights.
    AreaMean,
    /// Their sum with these weights, µm².
    AreaSum,
    /// The largest.
    Largest,
    /// The smallest.
    Smallest,
}

/// What links read, each thing once: however many links and members read it, it is observed once an exchange.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Observations {
    /// Quantities of systems: (reactor, quantity), for all members.
    pub quantities: Vec<(usize, QuantityId)>,
    /// Sources that give all members of a system the same number.
    pub shared: Vec<Source>,
    /// What each link reads of these.
    pub links: Vec<LinkObservations>,
}

/// What a link reads.
#[derive(Debug, Clone, PartialEq)]
pub struct LinkObservations {
    /// Where the quantities stand in [`Observations::quantities`]: first those that the transfer uses, in the order of [`Link::uses`].
    pub quantities: Vec<usize>,
    /// Where the number that is carried is found.
    pub from: Observation,
}

/// Where the number that a link carries is found.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Observation {
    /// The member's own quantity at this position of [`Observations::quantities`].
    Own(usize),
    /// The same of another system that the member's cell has.
    OfOwnCell(usize),
    /// The number at this position of [`Observations::shared`], the same for all members.
    Shared(usize),
    /// Read from the member's cell.
    Cell,
    /// Read from its neighbours, with the position of what is observed of their systems.
    OfNeighbours(Option<usize>),
}

impl Observations {
    /// What some links read; `of_cells` says whether a system is one of cells.
    pub fn of(links: &[Link], of_cells: impl Fn(usize) -> bool) -> Self {
        let mut all = Self::default();
        for link in links {
            let quantity = |all: &mut Self, number, quantity| position_of(&mut all.quantities, (number, quantity));
            let mut quantities: Vec<usize> = match link.owner {
                Owner::Reactor(number) => link.uses.iter().map(|&used| quantity(&mut all, number, used)).collect(),
                Owner::Field(_) => Vec::new(),
            };
            let from = match (link.from, link.owner) {
                (Source::Own(own), Owner::Reactor(number)) => Observation::Own(quantity(&mut all, number, own)),
                (Source::Other(number, other, whose), _) => {
                    let slot = quantity(&mut all, number, other);
                    quantities.push(slot);
                    match whose == Whose::Own && of_cells(number) {
                        true => Observation::OfOwnCell(slot),
                        false => Observation::Shared(position_of(&mut all.shared, link.from)),
                    }
                }
                (Source::Cell(Whose::Own, _) | Source::Sensed(Whose::Own, ..) | Source::AtAtom(Whose::Own, ..), _) => {
                    Observation::Cell
                }
                (Source::Atoms(_), _) => Observation::Cell,
                (Source::Neighbours(_), _) => {
                    let slot = link.from.quantity_of_other().map(|(number, own)| quantity(&mut all, number, own));
                    quantities.extend(slot);
                    Observation::OfNeighbours(slot)
                }
                _ => Observation::Shared(position_of(&mut all.shared, link.from)),
            };
            all.links.push(LinkObservations { quantities, from });
        }
        all
    }
}

/// Where a thing stands in a list of different things, in which it is put if it is not there.
fn position_of<T: PartialEq>(list: &mut Vec<T>, thing: T) -> usize {
    list.iter().position(|known| *known == thing).unwrap_or_else(|| {
        list.push(thing);
        list.len() - 1
    })
}

/// A number of a whole field.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Whole {
    /// Mean value.
    Mean,
    /// Largest value.
    Largest,
    /// Smallest value.
    Smallest,
    /// Amount on the grid.
    Amount,
}

/// Where a number goes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Target {
    /// An open quantity of the owner: its index among the inputs.
    Own(usize),
    /// An input of the owner that differs from atom to atom: its number among these.
    Given(usize),
    /// Something that mechanics reads of a cell.
    Cell(Whose, Control),
}

impl Target {
    /// What it sets of cells; none where it sets a quantity of its owner.
    pub fn control(&self) -> Option<Control> {
        match *self {
            Self::Own(_) | Self::Given(_) => None,
            Self::Cell(_, control) => Some(control),
        }
    }

    /// Whether it has a number for each atom.
    pub fn is_at_atoms(&self) -> bool {
        matches!(self, Self::Given(_) | Self::Cell(_, Control::Atoms(_)))
    }
}

/// What mechanics reads of a cell.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Control {
    /// Speed of the walk, µm/s.
    MotilitySpeed,
    /// A component of the velocity added to the walk, µm/s.
    Bias(usize),
    /// What pseudopods are told.
    Pseudopods(PodSetting),
    /// Factor of elastic forces.
    Stiffness,
    /// Factor of the strength of contacts.
    Adhesion,
    /// Rest volume, µm³.
    RestVolume,
    /// Rest volume over that of the mesh at rest.
    RestVolumeRatio,
    /// What may be set of a force: the number of its handle in [`CONTROLLED`](crate::mechanics::CONTROLLED), and its own among those
    /// of the kind that have this handle.
    Force(usize, usize),
    /// A component of an atom's position, µm.
    Atom(usize, usize),
    /// Amount released per second into a channel of [`Chemistry::secreted`].
    Secretion(usize),
    /// Something of every atom.
    Atoms(AtomControl),
}

/// What mechanics reads of atoms.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum AtomControl {
    /// Pressure along the outward normal, pN/µm².
    Protrusion,
    /// Tension of the surface, beside that of the type, pN/µm.
    Tension,
    /// Factor of the moduli of the membrane.
    Elasticity,
    /// Factor of the strength of contacts.
    Adhesion,
    /// Amount released per second and µm² into a channel of [`Chemistry::secreted`].
    Secretion(usize),
}
