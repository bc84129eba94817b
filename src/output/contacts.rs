//! Who touches whom: the pairs of a frame, the clusters they make, how mixed the types are, and the series
//! of the scene that follow from them. The file holds the pairs alone.

use super::changes::Change;
use super::{Cell, Layout};
use crate::recorded::Touch;
use serde::{Deserialize, Serialize};
use std::collections::HashMap;

/// A cell that touches another, or a plane.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct Touching {
    /// Id of the cell; of two the smaller one.
    pub cell: u64,
    /// Id of the other cell, or the plane, by its number in [`Layout::planes`].
    pub other: u64,
    /// Area of contact, µm², eq. (adhesion.8).
    pub area: f64,
}

/// The clusters that pairs join: for each cell the smallest number of those that it is joined with, its own where it
/// is alone.
///
/// # Panics
/// If a pair names a cell that is not there.
pub fn clusters(cells: usize, pairs: impl IntoIterator<Item = [u32; 2]>) -> Vec<u32> {
    let mut first: Vec<u32> = (0..cells as u32).collect();
    for [one, other] in pairs {
        let (one, other) = (root(&mut first, one), root(&mut first, other));
        // The smaller number stays: it names the cluster.
        first[one.max(other) as usize] = one.min(other);
    }
    for cell in 0..cells as u32 {
        first[cell as usize] = root(&mut first, cell);
    }
    first
}

/// The smallest cell known of the cluster of a cell; shortens the path to it.
fn root(first: &mut [u32], mut cell: u32) -> u32 {
    while first[cell as usize] != cell {
        first[cell as usize] = first[first[cell as usize] as usize];
        cell = first[cell as usize];
    }
    cell
}

/// How many pairs of cells are alike, and how many would be if types were dealt at random to the cells that touch
/// another one.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Alike {
    /// Pairs.
    pub pairs: usize,
    /// Pairs of one type.
    pub alike: usize,
    /// Share of pairs of one type to be expected, eq. (analysis.15); NaN for no pair.
    pub expected: f64,
}

impl Alike {
    /// Counts pairs, each once; `types` has the type of every cell.
    ///
    /// # Panics
    /// If a pair names a cell that is not there.
    pub fn of(types: &[u32], pairs: &[[u32; 2]]) -> Self {
        let mut numbers = vec![0_u64; types.iter().max().map_or(0, |most| *most as usize + 1)];
        for cell in touching_cells(pairs) {
            numbers[types[cell as usize] as usize] += 1;
        }
        let twice_the_pairs_of = |number: u64| (number * number.saturating_sub(1)) as f64;
        let expected = numbers.iter().map(|number| twice_the_pairs_of(*number)).sum::<f64>()
            / twice_the_pairs_of(numbers.iter().sum());
        Self { pairs: pairs.len(), alike: count_alike(types, pairs), expected }
    }

    /// The segregation index, eq. (analysis.16), when so many pairs are alike: 1 where no two types touch, 0 where they
    /// touch as often as by chance; NaN where there is no pair or but one type.
    pub fn index(&self, alike: usize) -> f64 {
        (alike as f64 / self.pairs as f64 - self.expected) / (1.0 - self.expected)
    }
}

/// The cells that pairs name, each once, ascending.
pub fn touching_cells(pairs: &[[u32; 2]]) -> Vec<u32> {
    let mut cells: Vec<u32> = pairs.as_flattened().to_vec();
    cells.sort_unstable();
    cells.dedup();
    cells
}

/// How many pairs are of one type.
pub fn count_alike(types: &[u32], pairs: &[[u32; 2]]) -> usize {
    pairs.iter().filter(|[one, other]| types[*one as usize] == types[*other as usize]).count()
}

/// The segregation index, see [`Alike::index`].
pub fn segregation(types: &[u32], pairs: &[[u32; 2]]) -> f64 {
    let found = Alike::of(types, pairs);
    found.index(found.alike)
}

/// The series of a result with contacts that follow from who touches whom, in the order of [`all_series`]; none without.
fn touches(layout: &Layout) -> Vec<Touch> {
    match layout.contacts {
        true => Touch::all(layout.types.len(), layout.obstacles.len()),
        false => Vec::new(),
    }
}

/// Names and units of the series of a result with contacts, in the order of [`all_series`].
pub(super) fn series(layout: &Layout) -> Vec<(String, &'static str)> {
    let (types, planes) = names_of(layout);
    touches(layout).into_iter().map(|series| (series.name(&types, &planes), series.unit())).collect()
}

/// What charts call a series of a result with contacts.
pub(super) fn label(layout: &Layout, name: &str) -> Option<String> {
    let (types, planes) = names_of(layout);
    let found = touches(layout).into_iter().find(|series| series.name(&types, &planes) == name);
    found.map(|series| series.label(&types, &planes))
}

fn names_of(layout: &Layout) -> (Vec<&str>, Vec<&str>) {
    let types = layout.types.iter().map(|kind| kind.name.as_str()).collect();
    (types, layout.obstacles.iter().map(|obstacle| obstacle.name.as_str()).collect())
}

/// Names and units of those whose values follow from a frame alone; none in a result without contacts.
pub(super) fn series_of_frame(layout: &Layout) -> Vec<(String, &'static str)> {
    let (types, planes) = names_of(layout);
    let of_frame = touches(layout).into_iter().filter(|series| change_of(*series).is_none());
    of_frame.map(|series| (series.name(&types, &planes), series.unit())).collect()
}

/// The change of aggregates that a series counts.
fn change_of(series: Touch) -> Option<Change> {
    match series {
        Touch::Births => Some(Change::Birth),
        Touch::Merges => Some(Change::Merge),
        Touch::Splits => Some(Change::Split),
        Touch::Deaths => Some(Change::Death),
        _ => None,
    }
}

/// The values of all [`series`] in all frames, by series: of those whose values follow from a frame alone, and of the changes.
pub(super) fn all_series(layout: &Layout, of_frames: Vec<Vec<f64>>, changes: &[Vec<f64>; 4]) -> Vec<Vec<f64>> {
    let mut of_frames = of_frames.into_iter();
    let of = |series: Touch| match change_of(series) {
        Some(change) => changes[change as usize].clone(),
        None => of_frames.next().unwrap_or_default(),
    };
    touches(layout).into_iter().map(of).collect()
}

/// The values of [`series_of_frame`] in a frame in which the cells have this surface, µm².
pub(super) fn values_of_frame(
    layout: &Layout,
    cells: &[Cell],
    surface: f64,
    touching: &[Touching],
    on_planes: &[Touching],
) -> Vec<f64> {
    let touched = Touched::of(layout, cells, surface, touching, on_planes);
    let of_frame = touches(layout).into_iter().filter(|series| change_of(*series).is_none());
    of_frame.map(|series| touched.value(series)).collect()
}

/// What is counted of a frame, by types and planes.
struct Touched {
    types: usize,
    planes: usize,
    /// Surface of all cells, µm².
    surface: f64,
    /// Areas and numbers of pairs, `one * types + other` with the smaller type first.
    areas: Vec<f64>,
    pairs: Vec<u32>,
    /// Areas on planes, `kind * planes + plane`.
    on_planes: Vec<f64>,
    segregation: f64,
    /// Type and size of every cluster.
    clusters: Vec<(usize, u32)>,
}

impl Touched {
    fn of(layout: &Layout, cells: &[Cell], surface: f64, touching: &[Touching], on_planes: &[Touching]) -> Self {
        let kinds: Vec<u32> = cells.iter().map(|cell| cell.kind).collect();
        let (types, planes) = (layout.types.len(), layout.obstacles.len());
        let indices: HashMap<u64, u32> = (0..).zip(cells).map(|(index, cell)| (cell.id, index)).collect();
        let kind = |cell: u32| kinds[cell as usize] as usize;
        let (mut areas, mut counts) = (vec![0.0; types * types], vec![0_u32; types * types]);
        for pair in touching {
            let (one, other) = (kind(indices[&pair.cell]), kind(indices[&pair.other]));
            let index = one.min(other) * types + one.max(other);
            areas[index] += pair.area;
            counts[index] += 1;
        }
        let mut on = vec![0.0; types * planes];
        on_planes.iter().for_each(|touch| on[kind(indices[&touch.cell]) * planes + touch.other as usize] += touch.area);
        let pairs: Vec<[u32; 2]> = touching.iter().map(|pair| [indices[&pair.cell], indices[&pair.other]]).collect();
        let like = pairs.iter().copied().filter(|[one, other]| kind(*one) == kind(*other));
        let mut sizes = vec![0_u32; kinds.len()];
        clusters(kinds.len(), like).iter().for_each(|first| sizes[*first as usize] += 1);
        let of_size = (0..).zip(sizes).filter(|(_, size)| *size > 0);
        Self {
            types,
            planes,
            surface,
            areas,
            pairs: counts,
            on_planes: on,
            segregation: segregation(&kinds, &pairs),
            clusters: of_size.map(|(cell, size)| (kind(cell), size)).collect(),
        }
    }

    /// The value of a series that follows from a frame alone; NaN for changes.
    fn value(&self, series: Touch) -> f64 {
        let whole: f64 = self.areas.iter().sum();
        let alike: f64 = (0..self.types).map(|one| self.areas[one * self.types + one]).sum();
        let sizes =
            |wanted: usize| self.clusters.iter().filter(move |(kind, _)| *kind == wanted).map(|(_, size)| *size);
        match series {
            Touch::Area([one, other]) => self.areas[one * self.types + other],
            Touch::AreaOnPlane(kind, plane) => self.on_planes[kind * self.planes + plane],
            Touch::Pairs([one, other]) => f64::from(self.pairs[one * self.types + other]),
            // An area of contact is one of both cells.
            Touch::AreaShare => 2.0 * whole / self.surface,
            Touch::HeterotypicShare => (whole - alike) / whole,
            Touch::Segregation => self.segregation,
            Touch::Clusters(kind) => sizes(kind).count() as f64,
            Touch::LargestCluster(kind) => f64::from(sizes(kind).max().unwrap_or(0)),
            Touch::Births | Touch::Merges | Touch::Splits | Touch::Deaths => f64::NAN,
        }
    }
}

#[cfg(test)]
#[path = "contacts_tests.rs"]
mod tests;
