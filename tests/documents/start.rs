//! Where cells start that overlap or whose volume is not that at rest, in experiments with contacts.

use pseudopod::Vec3;
use pseudopod::contact::find_overlaps;
use pseudopod::error::{Paint, render};
use pseudopod::experiment::{Compiled, Document, PushedApart, Settling, compile, settle_start, settle_start_told};
use pseudopod::geometry::volume;
use pseudopod::output::ResultFile;
use pseudopod::run::{Quiet, RunOptions, run};
use pseudopod::sim::contact::check_passed;
use pseudopod::sim::{Workspace, step};
use std::path::Path;

/// Cells of 5 µm at these places, with more lines of their type.
fn spheres(positions: &str, more: &str) -> String {
    format!(
        r#"
title = "Spheres"
[run]
until = "0.2 s"
[cells.ball]
mesh = {{ shape = "icosphere", radius = "5 um", level = 1 }}
placement = {positions}
mechanics = {{ drag = "20 pN s/um", shape_memory = {{ shape_modulus = "50 pN/um" }} }}
{more}
[contact]
"#
    )
}

fn document(text: &str) -> Document {
    let read = Document::parse("start.toml", text, Path::new("."), &[]);
    read.unwrap_or_else(|error| panic!("{}", render(&error, Paint::Plain)))
}

/// The experiment before and after its cells were pushed apart, and what was done.
fn settled(text: &str) -> (Compiled, Compiled, PushedApart) {
    let document = document(text);
    let before = compile(&document).expect("a good document");
    let mut after = before.clone();
    let pushed = settle_start(&document, &mut after);
    let pushed = pushed.unwrap_or_else(|error| panic!("{}", render(&error, Paint::Plain)));
    (before, after, pushed)
}

fn refused(text: &str) -> String {
    let document = document(text);
    let error = settle_start(&document, &mut compile(&document).expect("a good document")).expect_err("no way");
    assert_eq!(error.exit_code(), 2, "bad input ends with 2");
    error.to_string()
}

/// Positions of the atoms of all cells, `[cell][atom]`.
fn cells(of: &Compiled) -> Vec<Vec<Vec3>> {
    let kinds = of.model.kinds.iter().zip(&of.state.kinds);
    kinds.flat_map(|(kind, now)| (0..now.cells()).map(|cell| now.cell(kind, cell))).collect()
}

fn centres(of: &Compiled) -> Vec<Vec3> {
    cells(of).iter().map(|atoms| atoms.iter().sum::<Vec3>() / atoms.len() as f64).collect()
}

fn overlaps(of: &Compiled) -> usize {
    let contact = of.model.contact.as_ref().expect("contacts").scene_of(&of.state.kinds);
    find_overlaps(&contact.scene, &cells(of).concat()).len()
}

fn proximity(of: &Compiled) -> f64 {
    of.model.contact.as_ref().expect("contacts").reach.proximity
}

#[test]
fn two_spheres_that_overlap_end_just_touching_where_their_common_centre_was() {
    // Along z the poles meet, so that the meshes touch as spheres do; obliquely they touch a little sooner.
    for (positions, poles) in [
        (r#"{ at = [["0 um", "0 um", "-4.2 um"], ["0 um", "0 um", "4.2 um"]] }"#, true),
        (r#"{ at = [["-3 um", "1 um", "2 um"], ["3.5 um", "-2 um", "0.5 um"]] }"#, false),
    ] {
        let (before, after, pushed) = settled(&spheres(positions, ""));
        assert!(overlaps(&before) == 1 && overlaps(&after) == 0);
        let (was, is, near) = (centres(&before), centres(&after), proximity(&after));
        // Round-off of a few moves by micrometres.
        assert!((was[0] + was[1] - is[0] - is[1]).norm() < 1e-12, "{was:?} {is:?}");
        let apart = is[1] - is[0];
        if poles {
            assert!((apart.norm() - (10.0 + 0.5 * near)).abs() < 1e-12, "{apart}");
        }
        let mut nearer = after.clone();
        nearer.state.kinds[0].shift(&after.model.kinds[0], 1, &(-near * apart.normalize()));
        assert_eq!(overlaps(&nearer), 1, "a proximity nearer they overlap");
        for (was, is) in cells(&before).iter().zip(cells(&after)) {
            let rigid = was.iter().zip(&is).all(|(a, b)| ((a - was[0]) - (b - is[0])).norm() < 1e-12);
            assert!(rigid, "moved as a whole");
        }
        let moved = was.iter().zip(&is).map(|(was, is)| (is - was).norm()).fold(0.0, f64::max);
        assert!(pushed.cells == 2 && (pushed.farthest - moved).abs() < 1e-12, "{pushed:?}");
    }
}

#[test]
fn a_lattice_of_eight_that_overlap_is_spread() {
    let (before, after, pushed) = settled(&spheres(r#"{ grid = [2, 2, 2], spacing = "8 um" }"#, "number = 8"));
    assert!(overlaps(&before) >= 12 && overlaps(&after) == 0 && pushed.cells == 8, "{pushed:?}");
    let (was, is) = (centres(&before), centres(&after));
    assert!((was.iter().sum::<Vec3>() - is.iter().sum::<Vec3>()).norm() < 1e-11, "no drift");
    // Spheres would have 10 µm between centres and move each by √3 µm.
    assert!(pushed.farthest < 1.1 * 3f64.sqrt(), "{pushed:?}");
    assert_eq!(overlaps(&settled(&spheres(r#"{ grid = [2, 2, 2], spacing = "8 um" }"#, "number = 8")).1), 0);
}

#[test]
fn starts_that_do_not_overlap_stay_as_they_are() {
    let (before, after, pushed) = settled(&spheres(r#"{ grid = [3, 3, 1], spacing = "10.01 um" }"#, "number = 9"));
    assert_eq!(pushed, PushedApart::default());
    assert!(before.state == after.state && pushed.notice().is_none());
}

/// A floor, and a ceiling at a height.
fn planes(ceiling: f64) -> String {
    format!(
        r#"
[[planes]]
name = "floor"
point = ["0 um", "0 um", "0 um"]
normal = [0, 0, 1]
[[planes]]
name = "ceiling"
point = ["0 um", "0 um", "{ceiling} um"]
normal = [0, 0, -1]
"#
    )
}

#[test]
fn a_cell_on_a_floor_stays_on_it_and_the_one_above_moves() {
    let stack = spheres(r#"{ at = [["0 um", "0 um", "5 um"], ["0 um", "0 um", "14 um"]] }"#, "");
    let (_, after, _) = settled(&format!("{stack}{}", planes(40.0)));
    let lowest = cells(&after).concat().iter().map(|x| x.z).fold(f64::INFINITY, f64::min);
    assert!(overlaps(&after) == 0 && lowest > -1e-9, "{lowest}");
    // On the floor the first stays.
    assert!((centres(&after)[0].z - 5.0).abs() < 1e-9);
    // Below a ceiling that leaves room for spheres of 9.5 µm only there is no way apart but aside, which nothing shows.
    let words = refused(&format!("{stack}{}", planes(19.0)));
    assert!(words.contains("rounds of pushing have not parted") && words.contains("`ball`"), "{words}");
    let behind = spheres(r#"{ at = [["0 um", "0 um", "3 um"], ["0 um", "0 um", "11 um"]] }"#, "");
    let words = refused(&format!("{behind}{}", planes(40.0)));
    assert!(words.contains("reaches 2 um behind the plane `floor`"), "{words}");
}

#[test]
fn held_cells_stay_and_two_of_them_are_refused() {
    let free = r#"
[cells.free]
mesh = { shape = "icosphere", radius = "5 um", level = 1 }
placement = { at = [["9 um", "0 um", "0 um"]] }
mechanics = { drag = "20 pN s/um" }
"#;
    let held = "fixed = [{ cap = { direction = [0, 0, -1], number = 3 } }]";
    let (before, after, pushed) = settled(&spheres(r#"{ at = [["0 um", "0 um", "0 um"]] }"#, &format!("{held}{free}")));
    assert!(overlaps(&after) == 0 && pushed.cells == 1, "{pushed:?}");
    assert!(cells(&before)[0] == cells(&after)[0] && centres(&after)[1].x > 9.5);
    let words = refused(&spheres(r#"{ at = [["0 um", "0 um", "0 um"], ["9 um", "0 um", "0 um"]] }"#, held));
    assert!(words.contains("that are held"), "{words}");
}

#[test]
fn cells_deep_in_each_other_and_long_moves_are_refused() {
    let words = refused(&spheres(r#"{ at = [["0 um", "0 um", "0 um"], ["4 um", "0 um", "0 um"]] }"#, ""));
    assert!(words.contains("too deep in each other"), "{words}");
    // Nine in a row at 7 µm: those at its ends would have to move by 12 µm.
    let words = refused(&spheres(r#"{ grid = [9, 1, 1], spacing = "7 um" }"#, "number = 9"));
    assert!(words.contains("farther than their radius"), "{words}");
}

#[test]
fn a_cell_that_dips_into_a_sheet_is_put_on_the_side_of_its_centre() {
    for side in [1.0, -1.0] {
        let sheet = r#"
[cells.sheet]
mesh = { shape = "sheet", size = ["60 um", "60 um"], divisions = [12, 12] }
placement = { at = [["12 um", "5 um", "0 um"]] }
mechanics = { drag = "20 pN s/um", springs = { stiffness = "10 pN/um" } }
fixed = [{ all = true }]
"#;
        let positions = format!(r#"{{ at = [["0 um", "0 um", "{} um"]] }}"#, 3.5 * side);
        let (_, after, pushed) = settled(&spheres(&positions, sheet));
        let z = centres(&after)[0].z * side;
        assert!(overlaps(&after) == 0 && pushed.cells == 1 && z > 4.0 && z < 6.0, "{z}");
    }
}

#[test]
fn the_first_frame_shows_cells_where_they_were_pushed_whatever_the_threads() {
    let text = spheres(r#"{ grid = [2, 2, 2], spacing = "8.5 um" }"#, "number = 8");
    let (_, after, pushed) = settled(&text);
    let folder = tempfile::tempdir().expect("a folder");
    let last: Vec<_> = [1, 2]
        .map(|threads| {
            let result = folder.path().join(format!("{threads}.vtkhdf"));
            let options = RunOptions { threads: Some(threads), ..RunOptions::new(&result) };
            let outcome = run(&document(&text), &options, &mut Quiet).expect("a run");
            assert_eq!(outcome.pushed, pushed);
            let file = ResultFile::open(&result).expect("a result");
            let first = file.positions(0).expect("the first frame");
            let same =
                first.iter().zip(cells(&after).concat()).all(|(x, wanted)| (Vec3::from(*x) - wanted).norm() < 1e-5);
            assert!(same, "to the digits that are recorded");
            file.positions(file.frames() - 1).expect("the last frame")
        })
        .into();
    assert_eq!(last[0], last[1]);
}

/// Two cells of which the first begins with another volume than that at rest, 0.1 µm from each other.
fn swollen(ratio: f64, more: &str) -> Compiled {
    let second = r#"
[cells.other]
mesh = { shape = "icosphere", radius = "5 um", level = 1 }
placement = { at = [["0 um", "0 um", "10.1 um"]] }
mechanics = { drag = "20 pN s/um", shape_memory = { shape_modulus = "50 pN/um" } }
"#;
    let text = spheres(r#"{ at = [["0 um", "0 um", "0 um"]] }"#, &format!("{second}{more}"));
    let own = format!("shape_modulus = \"50 pN/um\" }}, volume = {{ ratio = {ratio} }} }}");
    settled(&text.replacen("shape_modulus = \"50 pN/um\" } }", &own, 1)).1
}

#[test]
fn a_volume_that_does_not_begin_at_rest_is_approached_and_then_exact() {
    let fixed = "[run.integrator]\nstep = \"2 ms\"\n";
    for (ratio, more) in [(1.2, ""), (0.8, ""), (0.97, ""), (1.2, fixed)] {
        let Compiled { model, mut state, .. } = swollen(ratio, more);
        let mut ws = Workspace::new(&model);
        let rest = state.kinds[0].rest_volumes[0];
        let measured = |state: &pseudopod::sim::State, kind: usize| {
            let surface = pseudopod::geometry::Surface {
                positions: state.kinds[kind].cell(&model.kinds[kind], 0),
                ..model.kinds[kind].rest.clone()
            };
            volume(&surface)
        };
        let (mut missing, mut steps) = ((rest - ratio * rest).abs(), 0);
        while missing > 1e-10 * rest {
            step(&model, &mut state, &mut ws).unwrap_or_else(|trouble| panic!("{ratio}: {trouble}"));
            let left = (measured(&state, 0) - ratio * rest).abs();
            assert!(left < missing, "{ratio}: it comes nearer in every step, {left} µm³ after {missing} µm³");
            assert!((measured(&state, 1) / rest - 1.0).abs() < 1e-10, "the other keeps its own");
            (missing, steps) = (left, steps + 1);
            assert!(steps < 40, "{ratio}: {left} µm³ are missing");
        }
        check_passed(&model, &state).expect("neither is inside the other");
        // A target that jumps later, as a link may let it, is approached the same way.
        state.kinds[1].rest_volumes.fill(1.15 * rest);
        for _ in 0..40 {
            step(&model, &mut state, &mut ws).unwrap_or_else(|trouble| panic!("{ratio}: {trouble}"));
        }
        assert!(
            (measured(&state, 1) / rest - 1.15).abs() < 1e-10 && (measured(&state, 0) / rest - ratio).abs() < 1e-10
        );
    }
}

#[test]
fn pushing_is_told_round_by_round_until_no_pair_is_left() {
    let document = document(&spheres("{ grid = [3, 2, 2], spacing = \"9 um\" }", "number = 12"));
    let told = std::sync::Mutex::new(Vec::new());
    let tell = |what| told.lock().expect("a list").push(what);
    settle_start_told(&document, &mut compile(&document).expect("a good document"), &tell).expect("a way apart");
    let rounds: Vec<(u32, usize)> = told
        .into_inner()
        .expect("a list")
        .into_iter()
        .filter_map(|what| match what {
            Settling::Pushing { round, pairs, .. } => Some((round, pairs)),
            Settling::Looking(_) => None,
        })
        .collect();
    assert!(rounds.len() > 1 && rounds.iter().zip(1..).all(|((round, _), number)| *round == number), "{rounds:?}");
    assert!(rounds.iter().all(|(_, pairs)| *pairs > 0) && rounds[0].1 > rounds[rounds.len() - 1].1, "{rounds:?}");
}
