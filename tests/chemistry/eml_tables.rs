//! Tables as functions: values at and between rows, courses that follow them across their kinks, files.

use pseudopod::equations::tree::{Expr, Role, System};
use pseudopod::equations::{self, Files, eml};
use pseudopod::error::{Paint, Source, render};
use pseudopod::ode::{Method, Scheme, SolveOptions, solve};
use std::path::Path;
use std::sync::Arc;

fn read_in(text: &str, folder: Option<&Path>) -> Result<eml::Document, String> {
    let source = Source { name: "test".to_owned(), text: text.to_owned() };
    equations::read_in(Arc::new(source), Files::of_folder(folder))
        .map(|read| read.document)
        .map_err(|error| render(&error, Paint::Plain))
}

fn read(text: &str) -> eml::Document {
    read_in(text, None).unwrap_or_else(|message| panic!("{message}"))
}

/// The definition `d` of a document, as a function of time.
fn defined(system: &System) -> impl Fn(f64) -> f64 + use<> {
    let number = system.find("d").expect("d") as usize;
    let Role::Defined { rule } = system.quantities[number].role.clone() else { panic!("a definition") };
    move |time| Expr::evaluate(&rule, time, &|_| f64::NAN)
}

fn table(interpolation: &str, rows: &[[f64; 2]]) -> impl Fn(f64) -> f64 {
    let rows: String = rows.iter().map(|[t, v]| format!("{t} {v}\n")).collect();
    defined(&read(&format!(
        r#"<eml name="m"><table id="f" interpolation="{interpolation}">{rows}</table><define id="d">f(time)</define></eml>"#
    )).system)
}

const ROWS: [[f64; 2]; 5] = [[-1.0, 0.5], [0.5, 2.0], [2.0, 2.0], [3.0, -1.0], [7.0, 0.1]];

#[test]
fn rows_are_met_and_what_lies_between_is_as_it_is_called() {
    for interpolation in ["linear", "step", "cubic"] {
        let f = table(interpolation, &ROWS);
        for [t, v] in ROWS {
            assert!((f(t) - v).abs() < 1e-15, "{interpolation} at {t}: {}", f(t));
        }
        assert_eq!([f(-10.0), f(100.0)], [0.5, 0.1], "{interpolation} stays at its ends");
    }
    let (linear, step) = (table("linear", &ROWS), table("step", &ROWS));
    assert!((linear(2.25) - 1.25).abs() < 1e-15 && (linear(5.0) + 0.45).abs() < 1e-15);
    assert_eq!([step(0.4999), step(0.5), step(2.9), step(3.1)], [0.5, 2.0, 2.0, -1.0]);
}

#[test]
fn cubic_pieces_neither_overshoot_nor_bend_lines_and_come_near_a_course_with_the_third_power_of_the_distance() {
    let f = table("cubic", &ROWS);
    for pair in ROWS.windows(2) {
        let mut last = pair[0][1];
        for part in 1..=100 {
            let value = f(pair[0][0] + (pair[1][0] - pair[0][0]) * f64::from(part) / 100.0);
            assert!((value - last) * (pair[1][1] - pair[0][1]) >= -1e-15, "it goes from row to row and not back");
            last = value;
        }
    }
    let line = table("cubic", &[[0.0, 1.0], [1.0, 3.0], [1.5, 4.0], [4.0, 9.0]]);
    assert!([0.3, 1.2, 3.0].into_iter().all(|t| (line(t) - (1.0 + 2.0 * t)).abs() < 1e-14));
    // A course that rises throughout.
    let error = |count: u32| -> f64 {
        let rows: Vec<[f64; 2]> =
            (0..=count).map(|row| f64::from(row) / f64::from(count)).map(|t| [t, t.exp()]).collect();
        let f = table("cubic", &rows);
        (0..1000).map(|part| f64::from(part) / 1000.0).map(|t| (f(t) - t.exp()).abs()).fold(0.0, f64::max)
    };
    let orders = [10, 20, 40].map(|count| (error(count) / error(2 * count)).log2());
    assert!(orders.iter().all(|order| *order > 2.8), "{orders:?}");
}

#[test]
fn a_course_follows_a_table_across_its_kinks_and_steps_to_the_last_digits() {
    // Rows that no step of a solver would meet by itself: a pulse of a thousandth.
    let rows = "0 0\n 1 2\n 5.3 2\n 5.301 50\n 5.302 2\n 8 0.25";
    let exact = |step: bool| -> f64 {
        let rows = [[0.0, 0.0], [1.0, 2.0], [5.3, 2.0], [5.301, 50.0], [5.302, 2.0], [8.0, 0.25]];
        let piece = |pair: &[[f64; 2]]| {
            let mean = if step { pair[0][1] } else { 0.5 * (pair[0][1] + pair[1][1]) };
            mean * (pair[1][0] - pair[0][0])
        };
        rows.windows(2).map(piece).sum::<f64>() + 2.0 * 0.25
    };
    for interpolation in ["linear", "step"] {
        let text = format!(
            r#"<eml name="m" time_unit="h"><table id="f" unit="uM/h" interpolation="{interpolation}">
            # hours and rates
            {rows}</table><variable id="x" unit="uM" initial="0" rate="f(time)"/></eml>"#
        );
        let system = read(&text).system;
        for method in [Method::Rosenbrock, Method::Rk45, Method::Rk65] {
            let options = SolveOptions { scheme: Scheme::OneStep(method), ..SolveOptions::default() };
            let x = solve(&system, 0.0, 10.0, &[10.0], &options).expect("a course").values[0][0];
            let expected = exact(interpolation == "step");
            assert!((x - expected).abs() < 1e-11, "{interpolation} {method:?}: {x}, not {expected}");
        }
    }
}

#[test]
fn columns_of_a_file_are_found_by_name_and_written_out_with_the_document() {
    let folder = tempfile::tempdir().expect("a folder");
    let written = "time (h);dose;\"rate\"\n# first\n0;9; 1.5\n\n2;9;-3e-1\r\n4;9;0\n";
    std::fs::write(folder.path().join("doses.csv"), written).expect("a file");
    let text = r#"<eml name="m"><table id="f" file="doses.csv" argument="time (h)" value="rate"/><define id="d">f(2*time)</define></eml>"#;
    let document = read_in(text, Some(folder.path())).unwrap_or_else(|message| panic!("{message}"));
    let d = defined(&document.system);
    assert_eq!([d(0.0), d(1.0), d(1.5), d(9.0)], [1.5, -0.3, -0.15, 0.0]);
    // What is written holds the numbers, so that it needs no file.
    assert_eq!(read(&eml::write(&document, "").text).system, document.system);
    let refused = |file: &str, part: &str| {
        std::fs::write(folder.path().join("doses.csv"), file).expect("a file");
        let message = read_in(text, Some(folder.path())).expect_err(part);
        assert!(message.contains(part), "{message}");
    };
    refused("time (h),rat\n0,1\n1,2\n", "no column \"rate\"");
    refused("time (h),rate\n0,1\n1,two\n", "doses.csv:3:3");
    refused("time (h),rate\n0,1\n0,2\n", "0 comes after 0");
    refused("time (h),rate\n0,1\n1\n", "a row has 1 columns; 2 were expected");
    refused("time (h),rate\n0,1\n", "less than two rows");
    refused("time (h),rate\n0,1\n1,inf\n", "not a number");
    std::fs::remove_file(folder.path().join("doses.csv")).expect("removed");
    assert!(read_in(text, Some(folder.path())).expect_err("no file").contains("cannot be read"));
    assert!(read_in(text, None).expect_err("no folder").contains("read from no folder"));
}
