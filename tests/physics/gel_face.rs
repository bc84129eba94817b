//! The face of a gel that a cell presses: its map is that of its atoms, and what pulls at it is what loads the cell.

use std::path::Path;

use pseudopod::analysis::displacement_map::DisplacementMap;
use pseudopod::experiment::Document;
use pseudopod::output::ResultFile;
use pseudopod::run::{Quiet, RunOptions, run};

/// A block with atoms 1 um apart, on which a cell of 42 atoms lies that is pressed down.
const PRESSED: &str = r#"
title = "t"
run = { until = "30 s", integrator = { tolerance = 1e-2 } }

[cells.gel]
mesh = { shape = "block", size = ["6 um", "6 um", "3 um"], divisions = [6, 6, 3] }
placement = { at = [["0 um", "0 um", "-1.5 um"]] }
fixed = [{ cap = { direction = [0, 0, -1], depth = "0.01 um" } }]
mechanics = { drag = "1 pN s/um", solid = { law = "neo_hookean", young = "100 Pa", poisson = 0.3 } }

[cells.ball]
mesh = { shape = "icosphere", radius = "2 um", level = 1 }
placement = { at = [["0.2 um", "0.1 um", "2.1 um"]] }
[cells.ball.mechanics]
drag = "5 pN s/um"
membrane = { law = "skalak", shear = "5 pN/um", area = "20 pN/um", bending = "2 pN um" }
[[cells.ball.loads]]
name = "weight"
all = true
direction = [0, 0, -1]
force = "20 pN"

[contact]
[output]
every = "10 s"
tractions = true
[measure.apart]
kind = "half_space"
cells = "gel"
young = "100 Pa"
poisson = 0.3
[measure.largest]
kind = "half_space"
statistic = "largest"
cells = "gel"
young = "100 Pa"
poisson = 0.3
"#;

#[test]
fn a_map_has_the_displacements_of_atoms_and_all_of_the_load() {
    let document = Document::parse("gel.toml", PRESSED, Path::new("."), &[]).expect("good");
    let scratch = tempfile::tempdir().expect("a folder");
    let result = scratch.path().join("result.h5");
    run(&document, &RunOptions::new(&result), &mut Quiet).expect("a run");
    let file = ResultFile::open(&result).expect("a result");
    let last = file.frames() - 1;
    let (before, now) = (file.positions(0).expect("positions"), file.positions(last).expect("positions"));
    let gel = file.layout().atoms_of(&file.cells(last)).next().expect("a gel");

    // At atoms.
    let map = DisplacementMap::of(&file, "gel", last, Some(1.0)).expect("a map");
    assert_eq!(map.points.len(), 49);
    let mut largest: f64 = 0.0;
    for point in &map.points {
        let is_it = |atom: &usize| {
            let [x, y, z] = before[*atom];
            (x - point.at[0]).abs() < 1e-9 && (y - point.at[1]).abs() < 1e-9 && z.abs() < 1e-9
        };
        let atom = gel.clone().find(is_it).expect("an atom at each point");
        for axis in 0..3 {
            let moved = now[atom][axis] - before[atom][axis];
            assert!((point.moved[axis] - moved).abs() < 1e-9, "{:?}", point.at);
        }
        largest = largest.max(point.moved.norm());
    }
    assert!(largest > 0.05, "{largest}");
    let measures = file.summary().expect("measures");
    let measure = |name: &str| measures.iter().find(|measure| measure.name == name).expect("there").value;
    assert!((measure("largest") - largest).abs() < 1e-9);
    // A thin block on the ground is no half space.
    assert!((0.1..1.0).contains(&measure("apart")), "{}", measure("apart"));

    // Between atoms on straight lines: the mean of both.
    let fine = DisplacementMap::of(&file, "gel", last, Some(0.5)).expect("a map");
    assert_eq!(fine.points.len(), 169);
    let at = |column: usize, row: usize| &fine.points[13 * row + column];
    for (column, row) in (0..12).step_by(2).flat_map(|column| (0..13).step_by(2).map(move |row| (column, row))) {
        let middle = 0.5 * (at(column, row).moved + at(column + 2, row).moved);
        assert!((at(column + 1, row).moved - middle).norm() < 1e-12, "{column} {row}");
    }

    // What the load presses the cell with goes into the gel, but for what moves: the integral over the face, by squares that are small beside facets.
    let finest = DisplacementMap::of(&file, "gel", last, Some(0.1)).expect("a map");
    let sum: f64 = finest.points.iter().map(|point| 0.01 * point.traction.z).sum();
    assert!((sum + 20.0).abs() < 0.1, "{sum}");
    // Two numbers more in the plain rows: no exponents, whole pixels.
    let text = map.in_pixels(0.25);
    let rows: Vec<Vec<&str>> = text.lines().map(|line| line.split(' ').collect()).collect();
    assert_eq!(rows.len(), 49);
    assert_eq!((rows[8][0], rows[8][1]), ("4", "4"));
    let numbers: Vec<f64> = rows[24].iter().map(|word| word.parse().expect("a number")).collect();
    let middle = &map.points[24].moved;
    assert!((numbers[2] - 4.0 * middle.x).abs() < 1e-6 && (numbers[3] - 4.0 * middle.y).abs() < 1e-6);
    assert!((numbers[4] - 4.0 * middle.xy().norm()).abs() < 1e-6);
}
