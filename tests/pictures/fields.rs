//! Fields in pictures.

use pseudopod::experiment::{Axis, Document, FieldLine, Picture, When};
use pseudopod::output::ResultFile;
use pseudopod::picture::field_plots::kymograph;
use pseudopod::picture::from_file::{check_field, still};
use pseudopod::picture::{ColourMap, Image, Scale};
use pseudopod::units::{Length, Time};
use std::path::Path;

use crate::example;

fn opened(folder: &Path) -> (ResultFile, Document) {
    let path = example::write(folder, "");
    let document = Document::parse("made_up.toml", example::TEXT, folder, &[]).unwrap();
    (ResultFile::open(&path).unwrap(), document)
}

/// The picture from straight above, where pixels are places.
fn from_above(field: &str) -> Picture {
    let mut picture = Picture {
        field: Some(field.into()),
        field_range: Some([0.0, 1.0]),
        width: 400,
        height: 300,
        ..Picture::default()
    };
    picture.time = When::At(Time::new(5.0));
    picture.view.from = [0.0, 0.0, 1.0];
    picture
}

/// How many pixels have nearly this colour.
fn count(image: &Image, colour: [u8; 3]) -> usize {
    let near = |pixel: &[u8]| (0..3).all(|k| pixel[k].abs_diff(colour[k]) < 12);
    image.rgb.chunks(3).filter(|pixel| near(pixel)).count()
}

#[test]
fn a_field_of_the_substrate_lies_under_the_cells() {
    let folder = tempfile::tempdir().unwrap();
    let (result, document) = opened(folder.path());
    let with = still(&result, &document, &from_above("attractant")).unwrap();
    let without = still(&result, &document, &from_above("none")).unwrap();
    let [dark, light] = [1.0, 0.0].map(|share| ColourMap::Ink.at(share).0);
    // What the front has reached is dark, what it has not is light; the camera looks at both.
    assert!(count(&with, dark) > 50, "{}", count(&with, dark));
    assert!(count(&without, light) == 0 && count(&with, light) > 50, "{}", count(&with, light));
    let default = still(&result, &document, &Picture { field: None, ..from_above("") }).unwrap();
    assert!(default == with, "the first field is shown if none is named");
    let other = still(&result, &document, &from_above("attractant.inhibitor")).unwrap();
    assert!(other != with);
}

#[test]
fn a_field_of_the_medium_is_cut_at_a_height() {
    let folder = tempfile::tempdir().unwrap();
    let (result, document) = opened(folder.path());
    let mut picture = Picture { field_range: Some([0.0, 300.0]), ..from_above("medium") };
    let middle = still(&result, &document, &picture).unwrap();
    picture.field_height = Some(Length::new(5.0));
    assert!(still(&result, &document, &picture).unwrap() == middle, "the cells' mean height is 5 um");
    picture.field_height = Some(Length::new(14.0));
    let high = still(&result, &document, &picture).unwrap();
    let light = |image: &Image| image.rgb.iter().map(|byte| u64::from(*byte)).sum::<u64>();
    assert!(light(&high) > light(&middle), "the medium fades upwards, so its colours become lighter");
}

#[test]
fn a_field_that_is_not_there_is_told() {
    let folder = tempfile::tempdir().unwrap();
    let (result, _) = opened(folder.path());
    let text = |name: &str| check_field(&result, &from_above(name)).unwrap_err().to_string();
    assert!(text("atractant").contains("has no field `atractant`"), "{}", text("atractant"));
}

#[test]
fn colours_that_count_in_powers_of_ten_show_what_linear_ones_do_not() {
    let folder = tempfile::tempdir().unwrap();
    let (result, document) = opened(folder.path());
    let picture = Picture { field_range: None, field_log: true, ..from_above("attractant") };
    let image = still(&result, &document, &picture).unwrap();
    let linear = still(&result, &document, &Picture { field_log: false, ..picture.clone() }).unwrap();
    // The front fades to some 10⁻⁵ of its height: there a linear scale has its first colour, decades do not.
    let first = ColourMap::Ink.at(0.0).0;
    assert!(2 * count(&image, first) < count(&linear, first), "{} {}", count(&image, first), count(&linear, first));
    // 0.1 is in the middle of three decades below 1 and more.
    let ranged = Picture { field_range: Some([1e-2, 1.0]), ..picture.clone() };
    check_field(&result, &ranged).unwrap();
    let text = check_field(&result, &Picture { field_range: Some([0.0, 1.0]), ..picture }).unwrap_err().to_string();
    assert!(text.contains("never reach 0"), "{text}");
}

#[test]
fn a_kymograph_may_count_in_powers_of_ten() {
    let folder = tempfile::tempdir().unwrap();
    let (result, _) = opened(folder.path());
    let line = FieldLine { field: Some("attractant".into()), along: Axis::X, through: None };
    let heat = |range, scale| kymograph(&result, &line, range, scale).map(|chart| chart.heat.unwrap());
    let found = heat(None, Scale::Log).unwrap();
    let least = found.values.iter().copied().filter(|value| *value > 0.0).fold(f64::INFINITY, f64::min);
    assert!(found.range[0] > 0.0 && found.range[0] <= least * 1.01 && found.scale == Scale::Log, "{:?}", found.range);
    assert!(heat(Some([-1.0, 1.0]), Scale::Linear).is_ok());
    assert!(heat(Some([-1.0, 1.0]), Scale::Log).unwrap_err().to_string().contains("powers of ten"));
}

#[test]
#[ignore = "gallery: writes pictures for a person to judge into PICTURES or the temporary folder"]
fn gallery_of_fields() {
    let out = std::env::var_os("PICTURES").map_or_else(std::env::temp_dir, std::path::PathBuf::from);
    let folder = tempfile::tempdir().unwrap();
    let (result, document) = opened(folder.path());
    let shown = |name: &str, picture: &Picture| {
        still(&result, &document, picture).unwrap().save_png(&out.join(name)).unwrap();
    };
    let at = |picture: Picture| Picture { time: When::At(Time::new(5.0)), width: 800, height: 600, ..picture };
    let plain = at(Picture::default());
    shown("field_flat.png", &plain);
    shown("field_keys.png", &Picture { colour_by: "volume".into(), ..plain.clone() });
    shown("field_wide.png", &Picture { width: 1280, height: 720, colour_by: "clock.U".into(), ..plain.clone() });
    shown("field_above.png", &at(from_above("attractant.inhibitor")));
    shown("field_medium.png", &at(Picture { field: Some("medium".into()), ..Picture::default() }));
}
