//! `pseudopod render`: pictures and movies of a result file.

use crate::error::{Error, Fault, Result};
use crate::experiment::When;
use crate::output::ResultFile;
use crate::picture::Movie;
use crate::picture::from_file::{beside, film, still};
use std::path::{Path, PathBuf};

/// Makes a picture, or a movie of all frames.
#[derive(Debug, Clone, clap::Args)]
pub struct RenderArgs {
    /// The result file.
    pub result: PathBuf,
    /// A .png for one instant; .gif, .mp4, .webm or a folder for all frames. By default a .png beside the result.
    #[arg(short, long, value_name = "FILE")]
    pub output: Option<PathBuf>,
    /// The instant: first, last, or a time such as "12 s".
    #[arg(long, value_name = "TIME")]
    pub time: Option<String>,
    /// What colours show: type, or a series of the cells such as volume.
    #[arg(long, value_name = "SERIES")]
    pub colour_by: Option<String>,
    /// Width in pixels.
    #[arg(long)]
    pub width: Option<u32>,
    /// Height in pixels.
    #[arg(long)]
    pub height: Option<u32>,
    /// Frames a second in a movie.
    #[arg(long, default_value_t = 20.0)]
    pub fps: f64,
    /// Replaces a file that is there.
    #[arg(long)]
    pub force: bool,
}

/// Runs the command.
///
/// # Errors
/// A result or series that is not there, a file that exists or cannot be written.
pub fn run(args: &RenderArgs) -> Result<()> {
    let result = ResultFile::open(&args.result)?;
    let document = crate::run::document_of(result.header(), &args.result)?;
    let mut picture = document.experiment.picture.clone();
    if let Some(time) = &args.time {
        picture.time =
            time.parse::<When>().map_err(|fault| Error::input(Fault::new(fault.message).help(fault.help)))?;
    }
    args.colour_by.iter().for_each(|series| picture.colour_by.clone_from(series));
    picture.width = args.width.unwrap_or(picture.width);
    picture.height = args.height.unwrap_or(picture.height);
    let output = args.output.clone().unwrap_or_else(|| beside(&args.result, "png"));
    refuse_existing(&output, args.force)?;
    if output.extension().is_some_and(|ending| ending == "png") {
        still(&result, &document, &picture)?.save_png(&output)?;
        println!("{}", output.display());
        return Ok(());
    }
    let mut movie = Movie::create(&output, args.fps)?;
    let frames: Vec<usize> = (0..result.frames()).collect();
    film(&result, &document, &picture, &frames, |image| movie.add(image))?;
    let written = movie.finish()?;
    written.notice.iter().for_each(|notice| eprintln!("{notice}"));
    println!("{}: {} frames", written.path.display(), written.frames);
    Ok(())
}

/// Nothing is overwritten unless asked for.
pub fn refuse_existing(path: &Path, force: bool) -> Result<()> {
    if force || !path.exists() {
        return Ok(());
    }
    let fault = Fault::new(format!("{} exists", path.display())).help("name another file with -o, or use --force");
    Err(Error::input(fault))
}
