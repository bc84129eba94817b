//! Bad files and full disks: what is wrong, and what to do.

use std::path::Path;

use pseudopod::error::{Error, Fault};
use pseudopod::output::{Overwrite, ResultFile, ResultWriter, checkpoint_path, frames_path};

use crate::example::{cells, frame, header, layout, write};

/// The only fault of an input error.
fn fault<T>(outcome: pseudopod::error::Result<T>) -> Fault {
    match outcome.err().expect("this must fail") {
        Error::Input(faults) => {
            assert_eq!(faults.len(), 1, "{faults:?}");
            assert!(faults[0].help.is_some(), "{faults:?} does not say what to do");
            faults[0].clone()
        }
        other => panic!("expected bad input, found {other:?}"),
    }
}

fn assert_refused(path: &Path, words: &str) {
    let message = fault(ResultFile::open(path).map(|_| ())).message;
    assert!(message.contains(words), "expected `{words}` in `{message}`");
    assert!(message.contains(&path.display().to_string()), "`{message}` does not name the file");
}

#[test]
fn files_that_are_no_results_are_refused_with_the_reason() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name);
    assert_refused(&path("missing.h5"), "there is no file");
    assert_refused(folder.path(), "is a folder");
    std::fs::write(path("empty.h5"), b"").unwrap();
    assert_refused(&path("empty.h5"), "is empty");
    std::fs::write(path("text.h5"), b"title = 'no result'").unwrap();
    assert_refused(&path("text.h5"), "is not an HDF5 file");
    hdf5::File::create(path("foreign.h5")).unwrap().close().unwrap();
    assert_refused(&path("foreign.h5"), "not a result of pseudopod");
    drop(write(&path("early.h5"), 1, 0));
    assert_refused(&path("early.h5"), "holds no frame");
}

#[test]
fn a_file_cut_anywhere_is_refused_or_read_but_never_crashes() {
    let folder = tempfile::tempdir().unwrap();
    let whole = folder.path().join("run.h5");
    write(&whole, 40, 50).finish(1.0).unwrap();
    let bytes = std::fs::read(&whole).unwrap();
    for tenth in 1..10 {
        let path = folder.path().join(format!("cut-{tenth}.h5"));
        std::fs::write(&path, &bytes[..bytes.len() * tenth / 10]).unwrap();
        assert_refused(&path, "is truncated: its end is missing");
    }
}

#[test]
fn wrong_bytes_in_the_middle_never_crash() {
    let folder = tempfile::tempdir().unwrap();
    let whole = folder.path().join("run.h5");
    write(&whole, 4, 6).finish(1.0).unwrap();
    let bytes = std::fs::read(&whole).unwrap();
    let mut refused = 0;
    for part in 1..40 {
        let path = folder.path().join("wrong.h5");
        let mut wrong = bytes.clone();
        let start = bytes.len() * part / 40;
        wrong[start..start + bytes.len() / 40].fill(0xa5);
        std::fs::write(&path, wrong).unwrap();
        let read = ResultFile::open(&path).and_then(|result| {
            result.series_names().iter().try_for_each(|name| result.cell_series(name).map(|_| ()))?;
            (0..result.frames()).try_for_each(|frame| result.positions(frame).map(|_| ()))
        });
        refused += usize::from(read.is_err());
    }
    assert!(refused > 0, "a fortieth of the file wrong must show somewhere");
}

#[test]
fn a_result_is_not_overwritten_without_being_asked() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("run.h5");
    let mut writer = write(&path, 1, 2);
    writer.save_checkpoint(10, 0.25, b"state").unwrap();
    drop(writer);
    let create = |overwrite| ResultWriter::create(&path, &header(), &layout(), overwrite);
    let found = fault(create(Overwrite::Refuse));
    assert!(found.message.ends_with("exists") && found.help.unwrap().contains("--force"), "{}", found.message);
    assert_eq!(ResultFile::open(&path).unwrap().frames(), 2, "the file is untouched");

    std::fs::remove_file(&path).unwrap();
    let found = fault(create(Overwrite::Refuse));
    assert!(found.message.contains("the checkpoint of a run that can be resumed"), "{}", found.message);

    create(Overwrite::Replace).unwrap().append(&frame(&cells(1), 0)).unwrap();
    assert_eq!(ResultFile::open(&path).unwrap().frames(), 1);
    assert!(!checkpoint_path(&path).exists(), "the old checkpoint does not belong to the new run");
}

#[test]
fn a_path_that_cannot_be_written_is_named() {
    let folder = tempfile::tempdir().unwrap();
    let create = |path: &Path| ResultWriter::create(path, &header(), &layout(), Overwrite::Replace);
    let found = fault(create(&folder.path().join("no/such/run.h5")));
    assert!(found.message.contains("its folder does not exist"), "{}", found.message);
    let found = fault(create(folder.path()));
    assert!(found.message.contains("is a folder"), "{}", found.message);
    let found = fault(ResultWriter::create(
        &folder.path().join("run.h5"),
        &header(),
        &pseudopod::output::Layout::default(),
        Overwrite::Refuse,
    ));
    assert!(found.message.contains("nothing to record"), "{}", found.message);
}

/// Needs a small disk: `mkdir /tmp/small && sudo mount -t tmpfs -o size=2m tmpfs /tmp/small`, then
/// `PSEUDOPOD_SMALL_DISK=/tmp/small cargo test --release --test result_file -- --ignored full_disk`.
#[test]
#[ignore = "slow: needs a small disk in PSEUDOPOD_SMALL_DISK"]
fn a_full_disk_is_reported_and_keeps_the_frames_before() {
    let disk = std::env::var("PSEUDOPOD_SMALL_DISK").expect("PSEUDOPOD_SMALL_DISK names a small disk");
    for number in [50, 2000] {
        let path = Path::new(&disk).join(format!("{number}.h5"));
        let cells = cells(number);
        let mut writer = ResultWriter::create(&path, &header(), &layout(), Overwrite::Replace).unwrap();
        writer.set_least_interval(std::time::Duration::ZERO);
        let mut appended = 0;
        let error = loop {
            match writer.append(&frame(&cells, appended)) {
                Ok(()) => appended += 1,
                Err(error) => break error,
            }
        };
        assert!(error.to_string().ends_with("no space left on device"), "{error}");
        assert_eq!(error.exit_code(), 1);
        assert!(writer.append(&frame(&cells, appended)).is_err(), "nothing more is written");
        drop(writer);
        // Read elsewhere, where there is space to take in what waits in the log.
        let folder = tempfile::tempdir().unwrap();
        let copy = folder.path().join("run.h5");
        for (from, to) in [(path.clone(), copy.clone()), (frames_path(&path), frames_path(&copy))] {
            std::fs::rename(&from, &to)
                .or_else(|_| std::fs::copy(&from, to).and_then(|_| std::fs::remove_file(from)))
                .unwrap();
        }
        let result = ResultFile::open(&copy).unwrap();
        assert_eq!(result.frames(), appended);
        assert_eq!(result.positions(appended - 1).unwrap(), frame(&cells, appended - 1).positions);
    }
}
