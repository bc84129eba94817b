//! Files that somebody made, or that broke: nothing in them is used before it was looked at.

use std::path::{Path, PathBuf};

use hdf5::{Extents, File};
use pseudopod::error::Error;
use pseudopod::output::ResultFile;

use crate::example::{frame_with_fields, header, layout_with_fields};

/// A finished result of which `change` made something else.
fn crafted(folder: &Path, change: impl FnOnce(&File)) -> PathBuf {
    let path = folder.join("crafted.h5");
    let _ = std::fs::remove_file(&path);
    let create = pseudopod::output::Overwrite::Replace;
    let mut writer = pseudopod::output::ResultWriter::create(&path, &header(), &layout_with_fields(), create).unwrap();
    (0..4).for_each(|number| writer.append(&frame_with_fields(&crate::example::cells(3), number)).unwrap());
    writer.finish(1.0).unwrap();
    let file = File::open_rw(&path).unwrap();
    change(&file);
    file.close().unwrap();
    path
}

fn refusal(path: &Path) -> String {
    match ResultFile::open(path) {
        Err(Error::Input(faults)) => faults[0].message.replace(&path.display().to_string(), "crafted.h5"),
        Err(other) => panic!("bad input is told as such, not as {other}"),
        Ok(_) => panic!("it must be refused"),
    }
}

/// Puts another dataset in the place of one.
fn in_place_of(file: &File, path: &str, shape: impl Into<Extents>) {
    file.unlink(path).unwrap();
    file.new_dataset::<f64>().shape(shape).create(path).unwrap();
}

#[test]
fn what_leads_out_of_the_file_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let refused = |change: fn(&File)| refusal(&crafted(folder.path(), change));
    let found = refused(|file| file.link_external("/etc/passwd", "/x", "VTKHDF/stolen").unwrap());
    assert_eq!(found, "crafted.h5 is damaged (/VTKHDF/stolen leads to another file)");
    let found = refused(|file| {
        file.unlink("/time").unwrap();
        file.link_soft("/step", "/time").unwrap();
    });
    assert_eq!(found, "crafted.h5 is damaged (/time is a link by name, which no result has there)");
    let found = refused(|file| {
        file.unlink("/time").unwrap();
        let builder = file.new_dataset::<f64>().with_dcpl(|plan| plan.external("/etc/passwd", 0, 32));
        builder.shape(4).create("/time").unwrap();
    });
    assert_eq!(found, "crafted.h5 is damaged (/time has its numbers in another file)");
}

#[test]
fn results_of_versions_that_did_not_tell_what_holds_atoms_are_read_as_if_nothing_did() {
    let folder = tempfile::tempdir().unwrap();
    let path = crafted(folder.path(), |file| {
        file.unlink("/cells/holding_force").unwrap();
        file.unlink("/VTKHDF/PointData/holding_force").unwrap();
    });
    let result = ResultFile::open(&path).unwrap();
    assert_eq!(result.frames(), 4);
    let tractions = result.tractions(3).unwrap().unwrap();
    assert!(tractions.held.len() == tractions.drag.len() && tractions.held.iter().all(|held| *held == [0.0; 3]));
    assert_eq!(result.cell_values("holding_force_x", 2).unwrap(), [0.0; 3]);
    assert_eq!(result.cell_series("holding_force_z").unwrap().sum(), 0.0);
}

#[test]
fn datasets_of_another_shape_or_type_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let refused = |change: fn(&File)| refusal(&crafted(folder.path(), change));
    let odd = |path: &str| format!("crafted.h5 is damaged ({path} has another type or shape than a result has there)");
    assert_eq!(refused(|file| in_place_of(file, "/time", ())), odd("/time"));
    assert_eq!(refused(|file| in_place_of(file, "/time", (4, 4))), odd("/time"));
    assert_eq!(refused(|file| in_place_of(file, "/step", 4)), odd("/step"));
    assert_eq!(refused(|file| in_place_of(file, "/VTKHDF/Points", (72, 2))), odd("/VTKHDF/Points"));
    assert_eq!(refused(|file| in_place_of(file, "/cells/volume", ())), odd("/cells/volume"));
    assert_eq!(refused(|file| in_place_of(file, "/scene/load.pull", ())), odd("/scene/load.pull"));
    assert_eq!(refused(|file| in_place_of(file, "/cells/type_names", 2)), odd("/cells/type_names"));
}

#[test]
fn claims_beyond_the_bytes_of_a_file_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let huge = crafted(folder.path(), |file| {
        file.dataset("/time").unwrap().resize(1_usize << 40).unwrap();
    });
    assert_eq!(refusal(&huge), "crafted.h5 is damaged (/VTKHDF/Steps/Values claims more numbers than are in the file)");
    let huge = crafted(folder.path(), |file| {
        file.dataset("/VTKHDF/Points").unwrap().resize((1_usize << 33, 3)).unwrap();
    });
    assert_eq!(refusal(&huge), "crafted.h5 is damaged (/VTKHDF/Points claims more numbers than are in the file)");
}

#[test]
fn groups_in_themselves_and_texts_that_are_none_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let round = crafted(folder.path(), |file| file.link_hard("/cells", "/cells/again").unwrap());
    let found = refusal(&round);
    assert!(found.contains("is a group that is there twice, or holds itself"), "{found}");
    let wrong = crafted(folder.path(), |_| {});
    let (mut bytes, title) = (std::fs::read(&wrong).unwrap(), header().title);
    let at = bytes.windows(title.len()).position(|window| window == title.as_bytes()).unwrap();
    bytes[at] = 0xff;
    std::fs::write(&wrong, bytes).unwrap();
    assert_eq!(refusal(&wrong), "crafted.h5 is damaged (a text in it is not UTF-8)");
}
