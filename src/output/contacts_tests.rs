//! What the series of contacts promise, on pairs made by hand.

use super::*;
use crate::output::{Cell, CellType, Obstacle};

/// Two types above a floor.
fn layout() -> Layout {
    let kind = |name: &str| CellType { name: name.into(), atoms: 1, ..CellType::default() };
    Layout {
        types: ["red", "white"].map(kind).to_vec(),
        obstacles: vec![Obstacle { name: "floor".into(), normal: [0.0, 0.0, 1.0], ..Obstacle::default() }],
        contacts: true,
        ..Layout::default()
    }
}

/// Cells of these types with ids from ten on.
fn cells(kinds: &[u32]) -> Vec<Cell> {
    (10..).zip(kinds).map(|(id, kind)| Cell { id, kind: *kind, parent: None }).collect()
}

fn touching(rows: &[(u64, u64, f64)]) -> Vec<Touching> {
    rows.iter().map(|&(cell, other, area)| Touching { cell, other, area }).collect()
}

#[test]
fn areas_pairs_and_clusters_are_counted_by_types() {
    // A row of cells: red red white white, and a red one alone; the first and the third stand on the floor.
    let (layout, cells) = (layout(), cells(&[0, 0, 1, 1, 0]));
    let pairs = touching(&[(10, 11, 4.0), (11, 12, 2.0), (12, 13, 3.0)]);
    let found = values_of_frame(&layout, &cells, 90.0, &pairs, &touching(&[(10, 0, 10.0), (12, 0, 20.0)]));
    let names = series_of_frame(&layout);
    assert_eq!(names.len(), found.len());
    let value = |wanted: &str| {
        let at = names.iter().position(|(name, _)| name == wanted);
        found[at.unwrap_or_else(|| panic!("{wanted} is not among {names:?}"))]
    };
    assert_eq!(value("contact.area.red.red"), 4.0);
    assert_eq!(value("contact.area.red.white"), 2.0);
    assert_eq!(value("contact.area.white.white"), 3.0);
    assert_eq!((value("contact.area.red.floor"), value("contact.area.white.floor")), (10.0, 20.0));
    assert_eq!((value("contact.pairs.red.red"), value("contact.pairs.red.white")), (1.0, 1.0));
    assert_eq!(value("contact.heterotypic_share"), 2.0 / 9.0);
    assert_eq!(value("contact.area_share"), 18.0 / 90.0);
    // Two of three pairs are alike; of four cells, two of each type, a pair is alike with probability 1/3.
    assert!((value("contact.segregation") - 0.5).abs() < 1e-15);
    assert_eq!((value("contact.clusters.red"), value("contact.largest_cluster.red")), (2.0, 2.0));
    assert_eq!((value("contact.clusters.white"), value("contact.largest_cluster.white")), (1.0, 2.0));
    assert_eq!(series(&Layout { contacts: false, ..layout }), []);
}

#[test]
fn without_contacts_shares_are_no_numbers_and_every_cell_is_a_cluster() {
    let layout = layout();
    let found = values_of_frame(&layout, &cells(&[0, 1, 1]), 1.0, &[], &[]);
    let undefined: Vec<String> = series_of_frame(&layout)
        .into_iter()
        .zip(found)
        .filter(|(_, value)| value.is_nan())
        .map(|((name, _), _)| name)
        .collect();
    assert_eq!(undefined, ["contact.heterotypic_share", "contact.segregation"]);
}

#[test]
fn segregation_is_one_between_blocks_apart_and_negative_on_a_checkerboard() {
    // A square lattice of 6 × 6 with neighbours along x and y.
    let pairs: Vec<[u32; 2]> = (0..36_u32)
        .flat_map(|cell| [(cell % 6 < 5).then_some([cell, cell + 1]), (cell < 30).then_some([cell, cell + 6])])
        .flatten()
        .collect();
    assert_eq!(pairs.len(), 60);
    let index =
        |kind: &dyn Fn(u32) -> u32, pairs: &[[u32; 2]]| segregation(&(0..36).map(kind).collect::<Vec<_>>(), pairs);
    // 18 of each type: a pair is alike with probability 17/35.
    let expected = 17.0 / 35.0;
    let halves = |cell: u32| cell / 18;
    assert!((index(&halves, &pairs) - (54.0 / 60.0 - expected) / (1.0 - expected)).abs() < 1e-14);
    let apart: Vec<[u32; 2]> = pairs.iter().copied().filter(|[a, b]| halves(*a) == halves(*b)).collect();
    assert!((index(&halves, &apart) - 1.0).abs() < 1e-14);
    let checkerboard = |cell: u32| (cell % 6 + cell / 6) % 2;
    assert!((index(&checkerboard, &pairs) + expected / (1.0 - expected)).abs() < 1e-14);
    assert!(index(&|_| 0, &pairs).is_nan(), "one type only");
    assert!(index(&halves, &[]).is_nan(), "no pairs");
}

#[test]
fn cells_that_touch_no_other_do_not_count_for_what_is_expected() {
    let pairs = [[0, 1], [1, 2], [2, 3]];
    let few = Alike::of(&[0, 0, 1, 1], &pairs);
    assert_eq!(few, Alike::of(&[0, 0, 1, 1, 1, 1, 0, 1], &pairs));
    assert_eq!((few.alike, few.expected), (2, 1.0 / 3.0));
}

#[test]
fn clusters_are_named_by_their_smallest_cell() {
    assert_eq!(clusters(6, [[4, 5], [1, 3], [3, 4]]), [0, 1, 2, 1, 1, 1]);
    assert_eq!(clusters(2, []), [0, 1]);
}
