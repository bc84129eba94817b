//! The tracks that a command is about: those of a result, of a CSV file, or of a package in the layout of biotracks.

use crate::analysis::recording::{POSITION, Recording};
use crate::analysis::tracks::read::Options;
use crate::analysis::tracks::{Tracks, package, read};
use crate::error::{Error, Fault, Result};
use crate::output::ResultFile;
use crate::units::{Length, Time};
use std::path::{Path, PathBuf};

/// Which tracks, and what is known of them.
#[derive(Debug, Clone, clap::Args)]
pub struct TrackArgs {
    /// The tracks: a result file, a CSV file with TRACK_ID, FRAME, POSITION_T, POSITION_X, POSITION_Y, POSITION_Z, or the folder of a biotracks package.
    pub file: PathBuf,
    /// What it does not say by itself.
    #[command(flatten)]
    pub known: Known,
    /// The type of cells; all when absent.
    #[arg(long, value_name = "TYPE")]
    pub cells: Option<String>,
    /// Whether cells move in the plane x, y or in space; in the plane when absent and z changes by less than a hundredth of x and y.
    #[arg(long, value_enum)]
    pub space: Option<SpaceName>,
    /// Begins with the first frame from this time on, as in "10 min".
    #[arg(long, value_name = "TIME", value_parser = time)]
    pub from: Option<f64>,
    /// Ends with the last frame until this time.
    #[arg(long, value_name = "TIME", value_parser = time)]
    pub to: Option<f64>,
}

/// What a file with measured tracks does not say by itself.
#[derive(Debug, Clone, Default, clap::Args)]
pub struct Known {
    /// The columns of a CSV file with the id of the track, the time, x, y and, in space, z.
    #[arg(long, value_delimiter = ',', value_name = "ID,T,X,Y[,Z]")]
    pub columns: Vec<String>,
    /// What a 1 means among times of a file, as in min or "30 s".
    #[arg(long, value_name = "TIME", value_parser = time)]
    pub time_unit: Option<f64>,
    /// What a 1 means among positions of a file, as in um or "0.65 um" for pixels.
    #[arg(long, value_name = "LENGTH", value_parser = length)]
    pub length_unit: Option<f64>,
    /// The time between frames of a file that only numbers them.
    #[arg(long, value_name = "TIME", value_parser = time)]
    pub interval: Option<f64>,
}

/// Where cells move.
#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
pub enum SpaceName {
    /// In the plane x, y.
    Plane,
    /// In space.
    Volume,
}

/// What was read.
pub struct Told {
    /// The tracks.
    pub tracks: Tracks,
    /// What was assumed of the file.
    pub notes: Vec<String>,
    /// Whether they are those of a result.
    pub simulated: bool,
}

impl TrackArgs {
    /// Reads the tracks.
    ///
    /// # Errors
    /// A file that cannot be read as any of these, no tracks of that type, or fewer than two frames.
    pub fn read(&self) -> Result<Told> {
        let (tracks, notes, simulated) = match self.known.read(&self.file)? {
            Some(found) => (found.tracks, found.notes, false),
            None => {
                let result = ResultFile::open(&self.file)?;
                (Tracks::of(&Recording::read(&result, &POSITION)?, None)?, Vec::new(), true)
            }
        };
        let tracks = match &self.cells {
            Some(kind) => tracks.of_type(kind)?,
            None => tracks,
        };
        let axes = match self.space {
            Some(SpaceName::Plane) => 2,
            Some(SpaceName::Volume) => 3,
            None => axes_of(&tracks),
        };
        Ok(Told { tracks: tracks.along(axes).between(self.from, self.to)?, notes, simulated })
    }
}

impl Known {
    /// Reads measured tracks; none if the file is a result.
    ///
    /// # Errors
    /// Wrong options or tracks, and options that say nothing about a result.
    pub fn read(&self, file: &Path) -> Result<Option<read::Read>> {
        if !self.columns.is_empty() && !(4..=5).contains(&self.columns.len()) {
            let fault = Fault::new(format!("--columns names {} columns", self.columns.len()));
            return Err(Error::input(
                fault.help("name those of the track, the time, x, y and, in space, z, as in id,t,x,y"),
            ));
        }
        let columns = (!self.columns.is_empty()).then(|| self.columns.clone());
        let options =
            Options { columns, time_unit: self.time_unit, length_unit: self.length_unit, interval: self.interval };
        if let Some(description) = package::description(file) {
            return package::read(&description, &options).map(Some);
        }
        if is_table(file) {
            return read::read(file, &options).map(Some);
        }
        if options != Options::default() {
            let fault = Fault::new(format!("{} is a result, which knows its columns and units", file.display()));
            return Err(Error::input(fault.help("leave out --columns, --time-unit, --length-unit and --interval")));
        }
        Ok(None)
    }
}

/// Whether a file is a table, by its ending.
pub fn is_table(file: &Path) -> bool {
    let ending = file.extension().map(|ending| ending.to_string_lossy().to_ascii_lowercase());
    matches!(ending.as_deref(), Some("csv" | "txt" | "tsv"))
}

/// Tracks that go less than this part of what they go along x and y along z are taken to be in the plane: round-off, and cells that crawl on one.
const FLAT: f64 = 0.01;

/// 2 where tracks hardly change along z, else 3.
fn axes_of(tracks: &Tracks) -> usize {
    // How far a track at most goes along an axis.
    let extent = |axis: usize| {
        let of = |track: usize| {
            let [low, high] = tracks
                .frames_of(track)
                .map(|frame| tracks.position(frame, track)[axis])
                .fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], part| [low.min(part), high.max(part)]);
            high - low
        };
        (0..tracks.number()).map(of).fold(0.0, f64::max)
    };
    if tracks.axes() < 3 || extent(2) <= FLAT * extent(0).max(extent(1)) { 2 } else { 3 }
}

/// A time, s: a number with its unit, or a unit for one of it.
fn time(text: &str) -> std::result::Result<f64, String> {
    quantity(text, "a time such as \"30 s\" or min", |text| text.parse::<Time>().ok().map(Time::value))
}

/// A length, µm.
fn length(text: &str) -> std::result::Result<f64, String> {
    quantity(text, "a length such as \"0.65 um\" or um", |text| text.parse::<Length>().ok().map(Length::value))
}

fn quantity(text: &str, expected: &str, parse: impl Fn(&str) -> Option<f64>) -> std::result::Result<f64, String> {
    let found = parse(text).or_else(|| parse(&format!("1 {text}")));
    found.filter(|value| *value > 0.0).ok_or_else(|| format!("give {expected}"))
}

/// Two or three numbers.
pub fn vector(text: &str) -> std::result::Result<[f64; 3], String> {
    let numbers: Option<Vec<f64>> = text.split(',').map(|part| part.trim().parse().ok()).collect();
    match numbers.as_deref() {
        Some([x, y]) if x.is_finite() && y.is_finite() => Ok([*x, *y, 0.0]),
        Some([x, y, z]) if x.is_finite() && y.is_finite() && z.is_finite() => Ok([*x, *y, *z]),
        _ => Err("give two or three numbers, as in 1,0 or 0,0,1".to_owned()),
    }
}
