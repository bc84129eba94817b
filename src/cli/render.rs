//! `pseudopod render`: pictures and movies of a result file.

use super::files::{Named, refuse_existing, refuse_same};
use super::frames::FrameArgs;
use super::report::Report;
use super::show::ShowArgs;
use crate::error::{Error, Fault, Result};
use crate::experiment::{OneOrMany, When};
use crate::output::ResultFile;
use crate::picture::Movie;
use crate::picture::from_file::{beside, check_colour, check_field, cut_out, film_as, still_as};
use crate::units::{Length, Time};
use std::path::PathBuf;

/// What a picture may measure along a side: from an icon to the largest that fits in memory with ease.
const PIXELS: std::ops::RangeInclusive<i64> = 16..=16_384;

/// Makes a picture, or a movie of all frames.
#[derive(Debug, Clone, clap::Args)]
pub struct RenderArgs {
    /// The result file.
    pub result: PathBuf,
    /// A .png for one instant; .gif, .apng, .mp4, .webm, or a folder (no ending) for all frames. By default a .png beside the result.
    #[arg(short, long, value_name = "FILE")]
    pub output: Option<PathBuf>,
    /// Which frame.
    #[command(flatten)]
    pub frame: FrameArgs,
    /// What colours show: type, a series of the cells such as volume, or height, displacement, curvature, force or traction of the
    /// atoms.
    #[arg(long, value_name = "QUANTITY")]
    pub colour_by: Option<String>,
    /// The numbers at the ends of the colour bar, in the units that it shows; those of the frames when absent.
    #[arg(long, value_name = "LOW,HIGH", value_parser = ends, allow_hyphen_values = true)]
    pub range: Option<[f64; 2]>,
    /// The field that is shown: its name, FIELD.SPECIES, or none; the first field when absent.
    #[arg(long, value_name = "FIELD")]
    pub field: Option<String>,
    /// The numbers at the ends of the field's colour bar; those of the frames when absent.
    #[arg(long, value_name = "LOW,HIGH", value_parser = ends, allow_hyphen_values = true)]
    pub field_range: Option<[f64; 2]>,
    /// Lets the field's colours count in powers of ten, for one over decades.
    #[arg(long)]
    pub field_log: bool,
    /// The height at which a field of the medium is cut, in um; the mean height of the cells when absent.
    #[arg(long, value_name = "Z", value_parser = finite, allow_hyphen_values = true)]
    pub field_height: Option<f64>,
    /// Takes away what is nearer to the eye than the middle of the cells by more than this, in um: 0 cuts through it.
    #[arg(long, value_name = "LENGTH", value_parser = finite, allow_hyphen_values = true)]
    pub cut: Option<f64>,
    /// Shows the loads as arrows.
    #[arg(long)]
    pub loads: bool,
    /// Leaves out the fibres that were made at run time, and cells are solid.
    #[arg(long)]
    pub no_fibres: bool,
    /// Shows the dynamic links between cells, from centre to centre, and cells are seen through.
    #[arg(long)]
    pub links: bool,
    /// Types of cells that are painted in two tones, so that they are seen to turn, by commas; where colours show types.
    #[arg(long, value_delimiter = ',', value_name = "TYPE")]
    pub marks: Vec<String>,
    /// How it is shown.
    #[command(flatten)]
    pub show: ShowArgs,
    /// Width in pixels.
    #[arg(long, value_parser = clap::value_parser!(u32).range(PIXELS))]
    pub width: Option<u32>,
    /// Height in pixels.
    #[arg(long, value_parser = clap::value_parser!(u32).range(PIXELS))]
    pub height: Option<u32>,
    /// Frames a second in a movie.
    #[arg(long, default_value_t = 20.0)]
    pub fps: f64,
    /// Replaces a file that is there.
    #[arg(long)]
    pub force: bool,
    /// Prints what was made as JSON.
    #[arg(long)]
    pub json: bool,
}

/// Runs the command.
///
/// # Errors
/// A result or series that is not there, a file that exists or cannot be written.
pub fn run(args: &RenderArgs) -> Result<Report> {
    let result = ResultFile::open(&args.result)?;
    let document = crate::run::recorded_document_of(result.header(), &args.result)?;
    let mut picture = document.experiment.picture.clone();
    args.colour_by.iter().for_each(|series| picture.colour_by.clone_from(series));
    picture.colour_range = args.range.or(picture.colour_range);
    args.field.iter().for_each(|field| picture.field = Some(field.clone()));
    picture.field_range = args.field_range.or(picture.field_range);
    picture.field_log |= args.field_log;
    picture.field_height = args.field_height.map(Length::new).or(picture.field_height);
    picture.cut = args.cut.map(Length::new).or(picture.cut);
    picture.loads |= args.loads;
    picture.fibres &= !args.no_fibres;
    picture.links |= args.links;
    if !args.marks.is_empty() {
        picture.marks = Some(OneOrMany::Many(args.marks.clone()));
    }
    if args.links && !result.layout().linked {
        let fault = Fault::new(format!("--links: no dynamic links are in {}", args.result.display()));
        return Err(Error::input(fault.help(
            "links between cells come from [contact] with model = \"links\"; links within cells are always shown",
        )));
    }
    picture.width = args.width.unwrap_or(picture.width);
    picture.height = args.height.unwrap_or(picture.height);
    picture.view = args.show.view()?.unwrap_or(picture.view);
    let display = args.show.display(&result, &picture)?;
    let frame = args.frame.of(&result, picture.time)?;
    picture.time = When::At(Time::new(result.times()?[frame]));
    let named = if args.output.is_some() { Named::ByUser } else { Named::ByItself };
    let output = args.output.clone().unwrap_or_else(|| beside(&args.result, "png"));
    refuse_same(&[&args.result, &output])?;
    refuse_existing(&output, args.force, named)?;
    if output.extension().is_some_and(|ending| ending == "png") {
        if args.show.transparent {
            cut_out(&result, &document, &picture, &display)?.save_png(&output)?;
        } else {
            still_as(&result, &document, &picture, &display)?.save_png(&output)?;
        }
        return Ok(Report::of_files(&args.result, &[output]).fact("frames", 1));
    }
    if args.show.transparent {
        let fault =
            Fault::new(format!("--transparent: {} shows all frames, which have a background", output.display()));
        return Err(Error::input(fault.help("name a .png, which shows one instant, after -o")));
    }
    // What is not there is told before the movie's file is made.
    check_colour(&result, &picture.colour_by)?;
    check_field(&result, &picture)?;
    let mut movie = Movie::create(&output, args.fps)?;
    let frames: Vec<usize> = (0..result.frames()).collect();
    film_as(&result, &document, (&picture, &display), &frames, |image| movie.add(image))?;
    let written = movie.finish()?;
    let mut report = Report::of_files(&args.result, &[written.path]).fact("frames", written.frames);
    report.words = format!("{}: {} frames\n", report.words.trim_end(), written.frames);
    Ok(report)
}

fn finite(text: &str) -> std::result::Result<f64, String> {
    text.trim().parse().ok().filter(|number: &f64| number.is_finite()).ok_or_else(|| "give a number in um".to_owned())
}

/// Two numbers, the second larger.
pub(super) fn ends(text: &str) -> std::result::Result<[f64; 2], String> {
    let numbers: Vec<f64> = text.split(',').filter_map(|part| part.trim().parse().ok()).collect();
    match numbers[..] {
        [low, high] if low < high && low.is_finite() && high.is_finite() => Ok([low, high]),
        _ => Err("give two numbers, the smaller first, as in 0,2.5".to_owned()),
    }
}
