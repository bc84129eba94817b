//! What a chart promises.

use super::*;

fn walk(seed: u32, steps: usize) -> Vec<[f64; 2]> {
    // A small generator is enough for a picture that has to look the same every time.
    let mut state = u64::from(seed).wrapping_mul(0x9e37_79b9_7f4a_7c15) | 1;
    let mut uniform = || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 33) as f64 / (1u64 << 31) as f64
    };
    let (mut at, mut angle) = ([0.0, 0.0], std::f64::consts::TAU * uniform());
    (0..steps)
        .map(|_| {
            angle += 0.9 * (uniform() - 0.5);
            at = [at[0] + 0.5 * angle.cos(), at[1] + 0.5 * angle.sin()];
            at
        })
        .collect()
}

fn tweezers() -> Chart {
    let force: Vec<f64> = (0..=96).map(|k| 2.0 * f64::from(k)).collect();
    let axial = |f: f64| 7.8 + 8.4 * (1.0 - (-f / 95.0).exp());
    let across = |f: f64| 7.8 - 3.1 * (1.0 - (-f / 80.0).exp());
    let points = |value: &dyn Fn(f64) -> f64| -> Vec<[f64; 2]> {
        [0.0, 16.0, 34.0, 47.0, 67.0, 88.0, 108.0, 130.0, 150.0, 172.0, 192.0]
            .iter()
            .map(|f| [*f, value(*f) + 0.25 * (f * 0.7).sin()])
            .collect()
    };
    let bars = |points: &[[f64; 2]]| points.iter().map(|p| [p[1] - 0.9, p[1] + 0.9]).collect::<Vec<_>>();
    let (up, down) = (points(&axial), points(&across));
    let (up_bars, down_bars) = (bars(&up), bars(&down));
    Chart {
        title: "Red cell stretched by optical tweezers".into(),
        x: Axis::linear("Force (pN)").range(Range::FromZero),
        y: Axis::linear("Diameter (µm)").range(Range::FromZero),
        series: vec![
            Series::line("axial, simulated", force.iter().map(|f| [*f, axial(*f)]).collect()),
            Series::line("across, simulated", force.iter().map(|f| [*f, across(*f)]).collect()),
            Series::measured("axial, Mills et al. 2004", up, up_bars).coloured(Colour::of_palette(0)),
            Series::measured("across, Mills et al. 2004", down, down_bars)
                .coloured(Colour::of_palette(1))
                .marked(Marker::Circle),
        ],
        ..Chart::default()
    }
}

fn msd() -> Chart {
    let times: Vec<f64> = (0..40).map(|k| 10f64.powf(-1.0 + 0.1 * f64::from(k))).collect();
    let furth = |t: f64| 2.0 * 25.0 * 4.0 * (t - 4.0 * (1.0 - (-t / 4.0).exp()));
    Chart {
        title: "Mean squared displacement of 2 000 walkers".into(),
        x: Axis::log("Time lag (min)"),
        y: Axis::log("MSD (µm²)"),
        series: vec![
            Series::band("simulated ± 3 s.e.", times.iter().map(|t| [*t, 0.8 * furth(*t), 1.25 * furth(*t)]).collect()),
            Series::line(
                "simulated ± 3 s.e.",
                times.iter().map(|t| [*t, furth(*t) * (1.0 + 0.04 * (9.0 * t).sin())]).collect(),
            ),
            Series::dashed("Fürth", times.iter().map(|t| [*t, furth(*t)]).collect()),
        ],
        ..Chart::default()
    }
}

fn tracks(number: u32, steps: usize) -> Chart {
    Chart {
        title: format!("{number} cells, 10 h"),
        x: Axis::linear("x (µm)"),
        y: Axis::linear("y (µm)"),
        series: vec![Series::tracks((0..number).map(|seed| walk(seed, steps)).collect())],
        aspect: Aspect::Equal,
        ..Chart::default()
    }
}

#[test]
fn every_chart_is_well_formed_svg() {
    let mut nasty = tweezers();
    nasty.title = "<&\"\u{1}µ".into();
    nasty.series.push(Series::line("a < b", vec![]));
    for chart in [tweezers(), msd(), tracks(5, 10), Chart::default(), nasty] {
        for (width, height) in [(720.0, 480.0), (10.0, 10.0)] {
            let svg = to_svg(&chart, width, height);
            roxmltree::Document::parse(&svg).unwrap();
            assert!(!svg.contains("NaN") && !svg.contains("inf"), "{svg}");
        }
    }
}

#[test]
fn a_line_breaks_where_a_value_is_missing() {
    let points = vec![[0.0, 1.0], [1.0, 2.0], [2.0, f64::NAN], [3.0, 1.0], [4.0, 2.0], [5.0, f64::INFINITY]];
    let chart = Chart { series: vec![Series::line("", points)], ..Chart::default() };
    let svg = to_svg(&chart, 400.0, 300.0);
    let document = roxmltree::Document::parse(&svg).unwrap();
    let curve = document.descendants().find(|n| n.attribute("stroke-linejoin") == Some("round")).unwrap();
    assert_eq!(curve.attribute("d").unwrap().matches('M').count(), 2);
}

#[test]
fn values_without_a_logarithm_are_left_out() {
    let chart = Chart {
        x: Axis::log("t"),
        y: Axis::log("v"),
        series: vec![Series::line("", vec![[0.0, 1.0], [1.0, -1.0], [1.0, 1.0], [100.0, 1e4]])],
        ..Chart::default()
    };
    let frame = frame::Frame::fit(&chart, 500.0, 400.0, 0.0);
    assert_eq!((frame.x.ticks.low, frame.x.ticks.high), (1.0, 100.0));
    assert!(frame.pixel([0.0, 1.0]).is_none());
}

#[test]
fn equal_aspect_gives_both_axes_the_same_unit() {
    let chart = tracks(20, 50);
    let frame = frame::Frame::fit(&chart, 800.0, 500.0, 0.0);
    let (o, x, y) =
        (frame.pixel([0.0, 0.0]).unwrap(), frame.pixel([1.0, 0.0]).unwrap(), frame.pixel([0.0, 1.0]).unwrap());
    // Rounding of coordinates only: positions are computed in f64 from ranges fixed in two passes.
    assert!(((x[0] - o[0]) - (o[1] - y[1])).abs() < 0.02 * (x[0] - o[0]));
}

#[test]
fn the_legend_covers_no_data() {
    let chart = tweezers();
    let svg = to_svg(&chart, 720.0, 480.0);
    let document = roxmltree::Document::parse(&svg).unwrap();
    let key = document.descendants().find(|n| n.attribute("fill-opacity") == Some("0.86")).unwrap();
    let number = |name: &str| key.attribute(name).unwrap().parse::<f64>().unwrap();
    let (left, top) = (number("x"), number("y"));
    let (right, bottom) = (left + number("width"), top + number("height"));
    for circle in document.descendants().filter(|n| n.has_tag_name("circle")) {
        let at = |name: &str| circle.attribute(name).unwrap().parse::<f64>().unwrap();
        let (x, y) = (at("cx"), at("cy"));
        // The samples inside the legend stand at its left edge, 23 px in.
        let sample = (x - (left + 23.0)).abs() < 0.6;
        assert!(sample || x < left || x > right || y < top || y > bottom, "legend covers ({x}, {y})");
    }
}

#[test]
fn a_chart_is_saved_twice_and_a_bad_folder_is_named() {
    let folder = tempfile::tempdir().unwrap();
    let paths = save_chart(&msd(), &folder.path().join("msd.v1")).unwrap();
    assert!(paths[0].ends_with("msd.v1.svg") && paths[1].ends_with("msd.v1.png"));
    assert!(paths.iter().all(|path| path.metadata().unwrap().len() > 1000));
    let error = save_chart(&msd(), Path::new("/nowhere/msd")).unwrap_err();
    assert!(error.to_string().contains("/nowhere/msd.svg"), "{error}");
}

#[test]
#[ignore = "gallery: writes pictures for a person to judge into PICTURES or the temporary folder"]
fn gallery_of_charts() {
    let folder = std::env::var_os("PICTURES").map_or_else(std::env::temp_dir, PathBuf::from);
    for (name, chart) in
        [("tweezers", tweezers()), ("msd", msd()), ("tracks", tracks(50, 300)), ("many_tracks", tracks(2000, 300))]
    {
        let start = std::time::Instant::now();
        save_chart(&chart, &folder.join(name)).unwrap();
        println!("{name}: {:?}", start.elapsed());
    }
}
