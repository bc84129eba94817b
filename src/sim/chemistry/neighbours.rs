//! Who touches whom, for links that read what neighbours have, eq. (coupling.6).

use super::super::contact::near_cell;
use super::super::model::Model;
use super::super::state::{State, vector};
use super::census::member_of_cell;
use super::links::{NeighbourNumber, NeighbourReading, Taken};
use super::measure::CellNumbers;
use super::observed::Observed;
use super::surface::AtomShapes;
use crate::Vec3;
use crate::contact::{AtomContact, Scene};

/// The cells that each cell touches.
#[derive(Debug, Clone, Default)]
pub(super) struct Neighbours {
    /// Two cells that touch and the area that they share, µm², in the order of both; each pair from either side.
    pairs: Vec<(u32, u32, f64)>,
    shapes: AtomShapes,
    positions: Vec<Vec3>,
}

impl Neighbours {
    /// Finds them, from what touches: that was found last, under adhesives where the step ended, and else where it began. A cell has of another
    /// the area of its atoms that are near it; both share the larger of what either has.
    pub fn find(&mut self, model: &Model, state: &State, contact: Option<(&Scene, &[AtomContact])>) {
        let Self { pairs, shapes, positions } = self;
        pairs.clear();
        let Some((scene, found)) = contact else { return };
        for (kind, now) in model.kinds.iter().zip(&state.kinds) {
            for cell in 0..now.cells() {
                let (first, near) = near_cell(kind, now, found, cell);
                let own = (now.first_cell + cell) as u32;
                let touches = |contact: &AtomContact| contact.body(scene) != own && scene.reach.touches(contact.gap);
                if !near.iter().any(touches) {
                    continue;
                }
                positions.clear();
                positions.extend((0..kind.atoms()).map(|atom| vector(kind, &now.positions, cell, atom)));
                shapes.take(&kind.rest.facets, positions);
                let begin = pairs.len();
                for of_atom in near.chunk_by(|one, next| one.atom == next.atom) {
                    let area = shapes.areas[(of_atom[0].atom - first) as usize];
                    let others = of_atom.iter().filter(|contact| touches(contact)).map(|contact| contact.body(scene));
                    for (at, other) in others.clone().enumerate() {
                        // An atom that is near several facets of a cell has its area once.
                        if others.clone().take(at).all(|before| before != other) {
                            match pairs[begin..].iter_mut().find(|pair| pair.1 == other) {
                                Some(pair) => pair.2 += area,
                                None => pairs.push((own, other, area)),
                            }
                        }
                    }
                }
            }
        }
        let seen = pairs.len();
        for pair in 0..seen {
            let (own, other, area) = pairs[pair];
            pairs.push((other, own, area));
        }
        pairs.sort_unstable_by(|a, b| (a.0, a.1).cmp(&(b.0, b.1)).then(b.2.total_cmp(&a.2)));
        pairs.dedup_by(|next, first| (next.0, next.1) == (first.0, first.1));
    }

    /// The cells that a cell touches, with the areas.
    fn of(&self, cell: usize) -> &[(u32, u32, f64)] {
        let [begin, end] = [cell, cell + 1].map(|cell| self.pairs.partition_point(|pair| (pair.0 as usize) < cell));
        &self.pairs[begin..end]
    }

    /// What a link reads of the neighbours of a cell, with the quantity that it reads of systems at this position of what is observed. Those that
    /// have not the system are passed over; of no neighbours all is 0.
    pub fn read(
        &self,
        model: &Model,
        state: &State,
        (reading, slot): (NeighbourReading, Option<usize>),
        cell: usize,
        (observed, cells): (&Observed, &[CellNumbers]),
    ) -> f64 {
        let meant = self
            .of(cell)
            .iter()
            .filter(|pair| reading.of_kind.is_none_or(|kind| state.kind_of(pair.1 as usize).0 == kind));
        let value = |other: usize| match reading.number {
            NeighbourNumber::Count | NeighbourNumber::Area => Some(1.0),
            NeighbourNumber::Cell(reading) => Some(cells[other].read(reading)),
            NeighbourNumber::Quantity(number, _) => {
                let member = member_of_cell(&state.kinds, &model.chemistry.reactors[number].members, other);
                slot.zip(member).map(|(slot, member)| observed.quantity(slot, member))
            }
        };
        let values = meant.filter_map(|pair| Some((value(pair.1 as usize)?, pair.2)));
        let mean = |sum: f64, of: f64| if of > 0.0 { sum / of } else { 0.0 };
        let sums = |weight: fn(f64) -> f64| {
            values.clone().fold((0.0, 0.0), |(sum, of), (value, area)| (sum + weight(area) * value, of + weight(area)))
        };
        let (by_count, by_area) = (|| sums(|_| 1.0), || sums(|area| area));
        let extreme = |which: fn(f64, f64) -> f64| values.clone().map(|(value, _)| value).reduce(which).unwrap_or(0.0);
        match (reading.number, reading.taken) {
            (NeighbourNumber::Area, _) | (_, Taken::AreaSum) => by_area().0,
            (NeighbourNumber::Count, _) | (_, Taken::Sum) => by_count().0,
            (_, Taken::Mean) => mean(by_count().0, by_count().1),
            (_, Taken::AreaMean) => mean(by_area().0, by_area().1),
            (_, Taken::Largest) => extreme(f64::max),
            (_, Taken::Smallest) => extreme(f64::min),
        }
    }
}
