//! Fields and systems of chemistry: what is written comes back, in order, and survives a resume.

use std::path::Path;

use pseudopod::output::{
    Along, FieldLayout, Frame, Kept, Layout, Overwrite, ResultFile, ResultWriter, SystemLayout, SystemScope, describe,
    field_view_path, to_json,
};

use crate::example::{self, cells};

pub use crate::example::{frame_with_fields as frame, layout_with_fields as layout, stored};

fn write(path: &Path, number: u32, frames: usize) -> ResultWriter {
    let mut writer = ResultWriter::create(path, &example::header(), &layout(), Overwrite::Refuse).unwrap();
    (0..frames).for_each(|index| writer.append(&frame(&cells(number), index)).unwrap());
    writer
}

#[test]
fn fields_come_back_with_seven_digits() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("run.vtkhdf");
    let layout = layout();
    write(&path, 3, 12).finish(1.0).unwrap();
    let result = ResultFile::open(&path).unwrap();
    assert_eq!(*result.layout(), layout);
    for number in [0, 5, 11] {
        let expected = frame(&cells(3), number);
        for (field, values) in layout.fields.iter().zip(&expected.fields) {
            for ((name, _), values) in field.species.iter().zip(values) {
                assert_eq!(result.field_frame(&field.name, name, number).unwrap(), stored(values), "{name}");
            }
        }
    }
}

#[test]
fn quantities_come_back_exactly_and_are_series_like_others() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("run.vtkhdf");
    write(&path, 3, 300).finish(1.0).unwrap();
    let result = ResultFile::open(&path).unwrap();
    let series = result.cell_series("brain.cells").unwrap();
    assert_eq!(series.dim(), (300, 3));
    assert!(series.column(1).iter().all(|value| value.is_nan()), "cell 1 has no brain");
    let expected = frame(&cells(3), 299);
    let of_brain = &expected.systems[0][1];
    assert_eq!([series[[299, 0]], series[[299, 2]]], [of_brain[0], of_brain[2]]);
    assert_eq!(result.scene_series("clock.tick").unwrap()[299], expected.systems[1][0][0]);
    assert_eq!(result.units("brain.U").unwrap(), "uM");
    let text = result.cell_series("brain.V").unwrap_err().to_string();
    assert!(text.contains("no series `brain.V`"), "{text}");
    assert!(result.series_names().contains(&"brain.U".to_string()));
    assert!(!result.series_names().contains(&"clock.tick".to_string()));
    let table = pseudopod::output::table_text(&result, &pseudopod::output::Table::Series(Vec::new())).unwrap();
    assert!(table.lines().next().unwrap().contains("brain.U (uM)"), "{table}");
}

#[test]
fn tractions_come_back_exactly_and_their_sums_are_series() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("run.vtkhdf");
    write(&path, 3, 40).finish(1.0).unwrap();
    let result = ResultFile::open(&path).unwrap();
    for number in [0, 17, 39] {
        assert_eq!(result.tractions(number).unwrap(), Some(frame(&cells(3), number).tractions));
    }
    let series = |name: &str| result.cell_series(name).unwrap()[[39, 2]];
    assert_eq!(["traction_total", "traction_dipole", "traction_moment_1"].map(series), [49.0, -2.0, -2.0]);
    assert_eq!(result.units("traction_dipole").unwrap(), "pN um");
    // A run without them has neither.
    let plain = folder.path().join("plain.vtkhdf");
    example::write(&plain, 3, 4).finish(1.0).unwrap();
    let plain = ResultFile::open(&plain).unwrap();
    assert_eq!(plain.tractions(0).unwrap(), None);
    assert!(plain.cell_series("traction_total").is_err() && plain.units("traction_total").is_err());
    assert!(!plain.series_names().iter().any(|name| name.starts_with("traction")));
}

/// Whether two lists hold the same bits.
fn same(one: &[f64], other: &[f64]) -> bool {
    one.iter().map(|value| value.to_bits()).eq(other.iter().map(|value| value.to_bits()))
}

#[test]
fn what_is_on_membranes_comes_back_exactly_whatever_cells_there_are() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("run.vtkhdf");
    let mut writer = ResultWriter::create(&path, &example::header(), &layout(), Overwrite::Refuse).unwrap();
    let lists = example::lineage();
    lists.iter().enumerate().for_each(|(number, cells)| writer.append(&frame(cells, number)).unwrap());
    writer.finish(1.0).unwrap();
    let result = ResultFile::open(&path).unwrap();
    for (number, cells) in lists.iter().enumerate() {
        let expected = frame(cells, number);
        for (name, values) in ["brain.b", "brain.a"].iter().zip(&expected.membranes) {
            assert!(same(&result.membrane(name, number).unwrap().unwrap(), values), "{name} of frame {number}");
        }
    }
    assert_eq!(result.membrane("brain.c", 0).unwrap(), None);
}

#[test]
fn a_resumed_file_goes_on_after_the_checkpoint() {
    let folder = tempfile::tempdir().unwrap();
    let (path, plain) = (folder.path().join("run.vtkhdf"), folder.path().join("plain.vtkhdf"));
    let layout = layout();
    drop(write(&path, 2, 9));
    std::fs::remove_file(field_view_path(&path, "attractant")).unwrap();
    let mut writer = ResultWriter::reopen(&path, &example::header(), &layout, Kept::until(40)).unwrap();
    assert_eq!(writer.frames(), 5);
    (5..12).for_each(|index| writer.append(&frame(&cells(2), index)).unwrap());
    writer.finish(1.0).unwrap();
    write(&plain, 2, 12).finish(1.0).unwrap();
    let (resumed, whole) = (ResultFile::open(&path).unwrap(), ResultFile::open(&plain).unwrap());
    for number in 0..12 {
        for membrane in &layout.membranes {
            let values = |result: &ResultFile| result.membrane(&membrane.name, number).unwrap().unwrap();
            assert!(same(&values(&resumed), &values(&whole)), "frame {number}");
        }
        for field in &layout.fields {
            for (name, _) in &field.species {
                let values = |result: &ResultFile| result.field_frame(&field.name, name, number).unwrap();
                assert_eq!(values(&resumed), values(&whole), "frame {number}");
            }
        }
    }
    for name in ["brain.U", "brain.cells"] {
        let quantity = |result: &ResultFile| result.cell_series(name).unwrap().column(0).to_vec();
        assert_eq!(quantity(&resumed), quantity(&whole));
    }
    assert!(field_view_path(&path, "attractant").exists(), "the small file that was lost is made again");
    let mut other = layout.clone();
    other.fields[0].cells[0] += 1;
    let text = ResultWriter::reopen(&path, &example::header(), &other, Kept::until(40)).err().unwrap().to_string();
    assert!(text.contains("other cells"), "{text}");
}

#[test]
fn large_fields_are_cut_into_pieces_and_large_systems_packed() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("run.vtkhdf");
    let mut layout = example::layout();
    let grid = |name: &str, cells| FieldLayout {
        name: name.into(),
        species: vec![("c".into(), "uM".into())],
        cells,
        spacing: [1.0; 3],
        origin: [0.0; 3],
    };
    // A layer that is cut along y with a rest, and a block that is cut along z with a rest.
    layout.fields = vec![grid("flat", [700, 611, 1]), grid("block", [120, 100, 29])];
    layout.systems = vec![SystemLayout {
        name: "many".into(),
        scope: SystemScope::Cells,
        quantities: vec![("U".into(), "1".into())],
    }];
    let frame = |number: usize| {
        let values = |field: &FieldLayout| (0..field.len()).map(|i| ((i + number) as f64 * 0.37).sin()).collect();
        let fields = layout.fields.iter().map(|field| vec![values(field)]).collect();
        let systems = vec![vec![(0..2000).map(|cell| (cell + number) as f64).collect()]];
        Frame { fields, systems, ..example::frame(&cells(2000), number) }
    };
    let mut writer = ResultWriter::create(&path, &example::header(), &layout, Overwrite::Refuse).unwrap();
    (0..3).for_each(|number| writer.append(&frame(number)).unwrap());
    drop(writer);
    let result = ResultFile::open(&path).unwrap();
    for number in 0..3 {
        let expected = frame(number);
        for (name, values) in ["flat", "block"].iter().zip(&expected.fields) {
            assert_eq!(result.field_frame(name, "c", number).unwrap(), stored(&values[0]), "{name}");
        }
        let row = result.cell_series("many.U").unwrap().row(number).to_vec();
        assert_eq!(row, expected.systems[0][0]);
    }
}

#[test]
fn what_fields_there_are_is_told() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("run.vtkhdf");
    write(&path, 3, 2).finish(1.0).unwrap();
    let result = ResultFile::open(&path).unwrap();
    let page = describe(&result).unwrap();
    assert!(
        page.contains("field       attractant: attractant (uM), inhibitor (uM); 6 x 5 boxes of 2 x 2 um"),
        "{page}"
    );
    assert!(page.contains("chemistry   brain of 2 cells: U (uM), cells"), "{page}");
    let known = to_json(&result).unwrap();
    assert_eq!(known["fields"][1]["boxes"], serde_json::json!([4, 4, 4]));
    assert_eq!(known["chemistry"][1]["quantities"][0]["name"], "tick");
    let (field, species) = result.field_species("attractant.inhibitor").unwrap();
    assert_eq!((field.name.as_str(), species), ("attractant", 1));
    assert_eq!(result.field_species("inhibitor").unwrap().1, 1);
    assert_eq!(result.field_species("medium").unwrap().0.name, "medium");
    let text = |name: &str| result.field_species(name).unwrap_err().to_string();
    insta::assert_snapshot!(
        text("atractant").replace(&folder.path().display().to_string(), "FOLDER"),
        @"FOLDER/run.vtkhdf has no field `atractant`"
    );
    let profile = field.profile(&result.field_frame("attractant", "inhibitor", 0).unwrap(), Along::X, None);
    assert_eq!(profile.len(), 6);
}

#[test]
fn what_the_file_cannot_hold_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("run.vtkhdf");
    let refusal = |change: fn(&mut Layout)| {
        let mut layout = layout();
        change(&mut layout);
        let made = ResultWriter::create(&path, &example::header(), &layout, Overwrite::Refuse);
        made.err().expect("refused").to_string()
    };
    insta::assert_snapshot!(refusal(|layout| layout.fields[0].name = "a/b".into()), @"a field of the result cannot be named `a/b`");
    insta::assert_snapshot!(refusal(|layout| layout.systems[1].name = "brain".into()), @"a system of the result is there twice under the name `brain`");
    insta::assert_snapshot!(refusal(|layout| layout.fields[0].species[0].0.clear()), @"a species of the result cannot be named ``");
    let refused = refusal(|layout| layout.fields[1].cells = [4, 0, 4]);
    insta::assert_snapshot!(refused, @"the field `medium` has no boxes or no species to record");
    assert!(!path.exists(), "nothing was made");
}

#[test]
fn a_small_file_that_is_there_is_kept_unless_it_may_be_replaced() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("run.vtkhdf");
    let layout = layout();
    std::fs::write(field_view_path(&path, "attractant"), b"mine").unwrap();
    let create = |overwrite| ResultWriter::create(&path, &example::header(), &layout, overwrite);
    let text = create(Overwrite::Refuse).err().unwrap().to_string();
    assert!(text.contains("run.attractant.vtkhdf exists"), "{text}");
    assert!(create(Overwrite::Replace).is_ok());
}
