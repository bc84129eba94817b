//! Words about pictures, and files too large for plain TIFF.

use super::*;
use crate::output::{Overwrite, ResultWriter, example};
use tiff::decoder::{Decoder, DecodingResult};

#[test]
fn intervals_are_told_where_they_are_equal_and_signs_beyond_ascii_are_references() {
    assert_eq!(interval_of(&[1.0, 1.5, 2.0]), Some(0.5));
    assert_eq!((interval_of(&[1.0, 1.5, 2.5]), interval_of(&[3.0]), interval_of(&[])), (None, None, None));
    assert_eq!(in_ascii("1 \u{b5}m"), "1 &#181;m");
}

#[test]
fn a_stack_of_any_size_has_the_same_pictures() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("run.vtkhdf");
    let layout = example::layout_with_fields();
    let mut writer = ResultWriter::create(&path, &example::header(), &layout, Overwrite::Refuse).unwrap();
    (0..3).for_each(|number| writer.append(&example::frame_with_fields(&example::cells(2), number)).unwrap());
    writer.finish(1.0).unwrap();
    let result = ResultFile::open(&path).unwrap();
    let stack =
        Stack { result: &result, field: &layout.fields[1], species: &[0], frames: &[0, 1, 2], words: "x".into() };
    for (largest_plain, version) in [(u64::MAX, 42), (0, 43)] {
        let path = folder.path().join("stack.tiff");
        stack.write_all(File::create(&path).unwrap(), largest_plain).ok().unwrap();
        assert_eq!(u16::from_ne_bytes(std::fs::read(&path).unwrap()[2..4].try_into().unwrap()), version);
        let mut decoder = Decoder::new(File::open(&path).unwrap()).unwrap();
        for frame in 0..3 {
            let wanted = result.field_frame("medium", "oxygen", frame).unwrap();
            for layer in wanted.chunks(16) {
                let DecodingResult::F32(found) = decoder.read_image().unwrap() else { panic!("not of four bytes") };
                assert!(found.iter().map(|value| f64::from(*value)).eq(layer.iter().copied()));
                assert_eq!(decoder.more_images(), (frame, layer) != (2, &wanted[48..]));
                if decoder.more_images() {
                    decoder.next_image().unwrap();
                }
            }
        }
    }
}
