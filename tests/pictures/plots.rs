//! Charts of fields and chemistry.

use pseudopod::experiment::{Document, Plot};
use pseudopod::output::{Measure, ResultFile};
use pseudopod::picture::chart::{Chart, Scale, Series};
use pseudopod::picture::plots::chart_of;
use pseudopod::picture::save_chart;
use std::path::Path;

use crate::example;

const PLOTS: &str = r#"
[[plot]]
name = "front"
kind = "profile"
field = "attractant"
along = "x"
through = ["0 um", "1 um", "0 um"]
times = ["0 s", "5 s", "last"]
[[plot]]
name = "depth"
kind = "profile"
field = "medium.oxygen"
along = "z"
times = "first"
[[plot]]
name = "march"
kind = "kymograph"
[[plot]]
name = "march_y"
kind = "kymograph"
field = "attractant.inhibitor"
along = "y"
range = [0, 2]
[[plot]]
name = "clocks"
kind = "series"
y = ["clock.U", "bath.level"]
each_cell = true
[[plot]]
name = "phase"
kind = "curve"
x = "clock.U"
y = "clock.V"
cells = "walker"
[[plot]]
name = "paths"
kind = "tracks"
[[plot]]
name = "volumes"
kind = "series"
y = "volume"
cells = "walker"
[[plot]]
name = "resters"
kind = "series"
y = "volume"
cells = "rester"
each_cell = true
"#;

fn charts(folder: &Path) -> Vec<(Plot, Chart)> {
    let path = example::write(folder, PLOTS);
    let text = format!("{}{PLOTS}", example::TEXT);
    let document = Document::parse("made_up.toml", &text, folder, &[]).unwrap_or_else(|error| panic!("{error}"));
    let result = ResultFile::open(&path).unwrap();
    let made = |plot: &Plot| {
        let chart = chart_of(&result, &document, plot).unwrap_or_else(|error| panic!("{}: {error}", plot.name));
        (plot.clone(), chart)
    };
    document.experiment.plot.iter().map(made).collect()
}

fn named<'a>(charts: &'a [(Plot, Chart)], name: &str) -> &'a Chart {
    &charts.iter().find(|(plot, _)| plot.name == name).unwrap().1
}

fn points(series: &Series) -> &[[f64; 2]] {
    match series {
        Series::Line { points, .. } => points,
        other => panic!("{other:?} is no line"),
    }
}

#[test]
fn a_profile_has_a_curve_for_each_instant() {
    let folder = tempfile::tempdir().unwrap();
    let charts = charts(folder.path());
    let front = named(&charts, "front");
    assert_eq!(front.series.iter().map(Series::label).collect::<Vec<_>>(), ["t = 0 s", "t = 5 s", "t = 10 s"]);
    assert_eq!(front.y.label, "attractant (µM)");
    for (series, time) in front.series.iter().zip([0.0, 5.0, 10.0]) {
        assert_eq!(points(series).len(), 30);
        for [x, value] in points(series) {
            // Seven digits are stored.
            assert!((value - example::attractant(*x, 1.0, time)).abs() < 1e-6, "{x} {value}");
        }
    }
    let depth = points(&named(&charts, "depth").series[0]);
    // The mean over whole layers fades as exp(-z/8), from box to box 3 um higher.
    assert!((depth[1][1] / depth[0][1] - (-3.0f64 / 8.0).exp()).abs() < 1e-6, "{depth:?}");
}

#[test]
fn a_kymograph_shows_time_along_x_and_the_axis_along_y() {
    let folder = tempfile::tempdir().unwrap();
    let charts = charts(folder.path());
    let heat = named(&charts, "march").heat.as_ref().unwrap();
    assert_eq!((heat.x, heat.y), ([0.0, 10.0], [0.0, 60.0]));
    let value = |column: usize, row: usize| heat.values[row * heat.size[0] + column];
    let last = heat.size[0] - 1;
    // The front has passed the middle of the field at the end, but not at the start.
    assert!(value(0, 15) < 0.2 && value(last, 15) > 0.8, "{} {}", value(0, 15), value(last, 15));
    let fixed = named(&charts, "march_y").heat.as_ref().unwrap();
    assert_eq!((fixed.range, fixed.label.as_str()), ([0.0, 2.0], "inhibitor (1/µm²)"));
}

#[test]
fn quantities_of_chemistry_are_series_with_a_line_for_each_cell() {
    let folder = tempfile::tempdir().unwrap();
    let charts = charts(folder.path());
    let clocks = named(&charts, "clocks");
    // Two walkers have a clock; then the mean of theirs, and the bath of all.
    assert_eq!(points(&clocks.series[0])[3], [3.0, 3.0f64.sin()]);
    let mean = clocks.series.iter().find(|series| series.label() == "walker: clock.U (µM), mean").unwrap();
    let expected = 0.5 * (3.0f64.sin() + 4.0f64.sin());
    assert!((points(mean)[3][1] - expected).abs() < 1e-12);
    assert!(!clocks.series.iter().any(|series| series.label() == "rester: clock.U (µM)"), "resters have no clock");
    assert_eq!(clocks.series.iter().filter(|series| series.label() == "bath.level").count(), 1);
    assert_eq!(points(&named(&charts, "phase").series[0]).len(), example::FRAMES);
}

const MEASURES: &str = r#"
[measure.slow]
kind = "mean_speed"
unit = "um/s"
[measure.fast]
kind = "mean_speed"
unit = "um/s"
[[plot]]
name = "speeds"
kind = "measures"
x = [1, 10]
log_x = true
curves = [{ label = "walkers", y = ["slow", "fast"], low = ["slow", "slow"], high = ["fast", "fast"] }]
"#;

#[test]
fn measures_stand_at_what_they_belong_to_once_a_run_has_ended() {
    let folder = tempfile::tempdir().unwrap();
    let text = format!("{}{MEASURES}", example::TEXT);
    let document = Document::parse("made_up.toml", &text, folder.path(), &[]).unwrap_or_else(|error| panic!("{error}"));
    let chart = |path: &Path| chart_of(&ResultFile::open(path).unwrap(), &document, &document.experiment.plot[0]);
    let unfinished = chart(&example::write(folder.path(), MEASURES)).unwrap_err().to_string();
    assert!(unfinished.contains("the result has no measure \"slow\""), "{unfinished}");
    let measure =
        |name: &str, value| Measure { name: name.into(), value, unit: "um/s".into(), description: String::new() };
    let path = example::write_measured(folder.path(), MEASURES, &[measure("slow", 2.0), measure("fast", 3.0)]);
    let chart = chart(&path).unwrap();
    assert_eq!(points(&chart.series[0]), [[1.0, 2.0], [10.0, 3.0]]);
    let Series::Points { label, points, bars, .. } = &chart.series[1] else { panic!("points on the line") };
    assert_eq!((label.as_str(), points.len(), bars.as_slice()), ("walkers", 2, &[[2.0, 3.0]; 2][..]));
    assert_eq!((chart.y.label.as_str(), chart.x.scale), ("µm/s", Scale::Log));
}

#[test]
fn charts_are_saved_as_drawings_and_pictures() {
    let folder = tempfile::tempdir().unwrap();
    for (plot, chart) in charts(folder.path()) {
        let made = save_chart(&chart, &folder.path().join(&plot.name)).unwrap();
        assert_eq!(made.len(), 2);
        if plot.name == "march" {
            let svg = std::fs::read_to_string(&made[0]).unwrap();
            assert!(svg.contains("data:image/png;base64,") && svg.contains("attractant (µM)"));
        }
    }
}

#[test]
#[ignore = "gallery: writes charts for a person to judge into PICTURES or the temporary folder"]
fn gallery_of_charts() {
    let out = std::env::var_os("PICTURES").map_or_else(std::env::temp_dir, std::path::PathBuf::from);
    let folder = tempfile::tempdir().unwrap();
    for (plot, chart) in charts(folder.path()) {
        save_chart(&chart, &out.join(format!("chart_{}", plot.name))).unwrap();
    }
}

#[test]
fn types_have_the_colours_of_the_pictures() {
    use pseudopod::picture::Colour;
    let folder = tempfile::tempdir().unwrap();
    let charts = charts(folder.path());
    let colours = |name: &str| -> Vec<Option<Colour>> {
        let colour = |series: &Series| match series {
            Series::Line { colour, .. } | Series::Tracks { colour, .. } => *colour,
            other => panic!("{other:?}"),
        };
        named(&charts, name).series.iter().map(colour).collect()
    };
    let of_type = [0, 1].map(Colour::of_palette);
    assert_eq!(colours("paths"), of_type.map(Some));
    let labels: Vec<&str> = named(&charts, "paths").series.iter().map(Series::label).collect();
    assert_eq!(labels, ["walker", "rester"], "one colour for many tracks is told by a name");
    // The second type alone is not in the colour of the first.
    let resters = colours("resters");
    assert_eq!(resters.last(), Some(&Some(of_type[1])));
    assert_eq!(resters[0], Some(of_type[1].mixed(Colour([0xff; 3]), 0.62)));
}

#[test]
fn averages_are_labelled_as_averages() {
    let folder = tempfile::tempdir().unwrap();
    let charts = charts(folder.path());
    // Two walkers, one rester.
    assert_eq!(named(&charts, "volumes").y.label, "mean volume (µm³)");
    assert_eq!(named(&charts, "resters").y.label, "volume (µm³)");
    assert_eq!(named(&charts, "resters").series.last().map(Series::label), Some(""));
    // A series of the scene is none; what cells there are of the other type have no clock.
    let labels = named(&charts, "clocks").series.iter().map(Series::label).filter(|label| !label.is_empty());
    assert_eq!(labels.collect::<Vec<_>>(), ["walker: clock.U (µM), mean", "bath.level"]);
}
