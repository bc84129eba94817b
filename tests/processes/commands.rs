//! What the commands make of fields, and what they say when there is no such field.

use pseudopod::physical_model::pml::{Atom, CellType, PhysicalModel};
use std::path::Path;
use std::process::Command;

use crate::fields_example as example;
use crate::turns::take_turn;

/// Runs the program in a folder; what it printed, and how it ended if not well.
fn pseudopod(folder: &Path, arguments: &[&str]) -> String {
    let out = Command::new(env!("CARGO_BIN_EXE_pseudopod")).args(arguments).current_dir(folder).output().unwrap();
    let mut text = String::from_utf8_lossy(&out.stdout).into_owned() + &String::from_utf8_lossy(&out.stderr);
    if !out.status.success() {
        text.push_str(&format!("exit {}\n", out.status.code().unwrap_or(-1)));
    }
    text
}

#[test]
fn fields_that_are_not_there_are_told_with_what_may_be_meant() {
    let _turn = take_turn();
    let folder = tempfile::tempdir().unwrap();
    example::write(folder.path(), "");
    let say = |arguments: &[&str]| pseudopod(folder.path(), arguments);
    insta::assert_snapshot!(say(&["render", "made_up.vtkhdf", "--field", "atractant"]), @r#"
  × made_up.vtkhdf has no field `atractant`
  help: did you mean `attractant`? there are: attractant, attractant.inhibitor, medium, medium.oxygen

1 fault
exit 2
"#);
    insta::assert_snapshot!(say(&["render", "made_up.vtkhdf", "-o", "a.gif", "--field", "glucose"]), @r#"
  × made_up.vtkhdf has no field `glucose`
  help: there are: attractant, attractant.inhibitor, medium, medium.oxygen

1 fault
exit 2
"#);
    insta::assert_snapshot!(say(&["plot", "made_up.vtkhdf", "--profile", "attractant.inhibitr"]), @r#"
  × made_up.vtkhdf has no field `attractant.inhibitr`
  help: did you mean `attractant.inhibitor`? there are: attractant, attractant.inhibitor, medium,
        medium.oxygen

1 fault
exit 2
"#);
    insta::assert_snapshot!(say(&["plot", "made_up.vtkhdf", "--kymograph", "oxigen", "--along", "z"]), @r#"
  × made_up.vtkhdf has no field `oxigen`
  help: did you mean `oxygen`? there are: attractant, attractant.inhibitor, medium, medium.oxygen

1 fault
exit 2
"#);
    insta::assert_snapshot!(say(&["plot", "made_up.vtkhdf", "--y", "clock.W"]), @r#"
  × made_up.vtkhdf has no series `clock.W`
  help: did you mean `clock.U`? there are: position_x, position_y, position_z, velocity_x, velocity_y,
        velocity_z, volume, volume_error, area, energy, size_x, size_y, size_z, principal_1, principal_2,
        principal_3, smallest_facet, smallest_cosine, contact_share, aggregate, speed, aspect_ratio,
        clock.U, clock.V, bath.level

1 fault
exit 2
"#);
    insta::assert_snapshot!(say(&["export", "made_up.vtkhdf", "-o", "a.vti", "--field", "medium.nitrogen"]), @r#"
  × made_up.vtkhdf has no field `medium.nitrogen`
  help: there are: attractant, attractant.inhibitor, medium, medium.oxygen

1 fault
exit 2
"#);
    insta::assert_snapshot!(say(&["export", "made_up.vtkhdf", "-o", "a.obj", "--field", "medium"]), @r#"
  × --field has no meaning for a.obj
  help: --frame and --time belong to one frame of a mesh (.obj, .ply, .stl, .vtu, .pml) or of a field
        (.vti, .ome.tiff, or .csv with --field), --every to all frames (.pvd, .ome.tiff), --cell to a mesh,
        --field to a field, --table and --series to a table (.csv), --displacements to a map (.csv, .txt),
        --pixel to one in pixels (.txt)

1 fault
exit 2
"#);
    insta::assert_snapshot!(say(&["plot", "made_up.vtkhdf", "--along", "z"]), @r#"
  × --along and --through belong to a field
  help: add --profile FIELD or --kymograph FIELD

1 fault
exit 2
"#);
    insta::assert_snapshot!(say(&["plot", "made_up.vtkhdf", "--profile", "medium", "--times", "soon"]), @r#"
error: invalid value 'soon' for '--times <TIME>': "soon" does not begin with a number; write first, last, or a time such as "12 s"

For more information, try '--help'.
exit 2
"#);
}

#[test]
fn the_commands_make_what_they_are_asked_for() {
    let _turn = take_turn();
    let folder = tempfile::tempdir().unwrap();
    let path = example::write(folder.path(), "");
    let say = |arguments: &[&str]| pseudopod(folder.path(), arguments);
    let render = ["render", "made_up.vtkhdf", "--field", "medium", "--field-range", "0,300", "--field-height", "2"];
    say(&[&render[..], &["--width", "160", "--height", "120"]].concat());
    say(&["plot", "made_up.vtkhdf", "--kymograph", "attractant.inhibitor", "--along", "y"]);
    say(&[
        "plot",
        "made_up.vtkhdf",
        "--profile",
        "oxygen",
        "--along",
        "z",
        "--through",
        "10,10,0",
        "--times",
        "0 s,last",
    ]);
    say(&["plot", "made_up.vtkhdf", "--y", "clock.U", "--each-cell"]);
    say(&["export", "made_up.vtkhdf", "-o", "flat.csv", "--field", "attractant", "--time", "first"]);
    say(&["export", "made_up.vtkhdf", "-o", "medium.vti", "--field", "oxygen"]);
    say(&["export", "made_up.vtkhdf", "-o", "medium.OME.tif", "--every", "5"]);
    say(&["export", "made_up.vtkhdf", "-o", "series.pvd", "--every", "5", "--field", "attractant.inhibitor"]);
    let made = |name: &str| folder.path().join(name);
    for name in ["medium.OME.tif", "series.pvd", "series/series_000010.vti"] {
        assert!(made(name).exists(), "{name}");
    }
    for name in ["made_up.png", "made_up.kymograph-attractant-inhibitor.svg", "made_up.profile-oxygen.png"] {
        assert!(made(name).exists() || path.with_extension("").join(name).exists(), "{name}");
    }
    say(&["export", "made_up.vtkhdf", "--pml", "cells.pml", "-o", "cells.obj"]);
    let model = PhysicalModel::open(&made("cells.pml")).unwrap().document;
    let vertices = |atom: &Atom| format!("v {} {} {}", atom.position[0], atom.position[1], atom.position[2]);
    let obj = std::fs::read_to_string(made("cells.obj")).unwrap();
    let expected: Vec<&str> = obj.lines().filter(|line| line.starts_with("v ")).collect();
    assert_eq!(model.all_atoms().map(vertices).collect::<Vec<_>>(), expected, "the same atoms with all digits");
    let facets = model
        .structural_components()
        .into_iter()
        .flat_map(|own| &own.cells)
        .filter(|own| own.kind == CellType::Triangle);
    let facets = facets
        .map(|own| own.references.atoms.iter().fold("f".to_owned(), |line, atom| line + &format!(" {}", atom + 1)));
    let expected: Vec<&str> = obj.lines().filter(|line| line.starts_with("f ")).collect();
    assert!(!expected.is_empty() && facets.eq(expected), "the same facets");
    let table = std::fs::read_to_string(made("flat.csv")).unwrap();
    let mut lines = table.lines();
    assert_eq!(lines.next(), Some("x (um),y (um),attractant (uM),inhibitor (1/um^2)"));
    let row: Vec<f64> = lines.next().unwrap().split(',').map(|number| number.parse().unwrap()).collect();
    assert_eq!(row[..2], [1.0, 1.0]);
    assert!((row[2] - example::attractant(1.0, 1.0, 0.0)).abs() < 1e-6, "{row:?}");
    assert_eq!(table.lines().count(), 1 + 30 * 22);
    let image = std::fs::read_to_string(made("medium.vti")).unwrap();
    assert!(image.contains(r#"WholeExtent="0 15 0 11 0 6""#) && image.contains(r#"Name="oxygen""#));
    let info = say(&["info", "made_up.vtkhdf"]);
    assert!(info.contains("medium: oxygen (nM); 15 x 11 x 6 boxes of 4 x 4 x 3 um"), "{info}");
}
