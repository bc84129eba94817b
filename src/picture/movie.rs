//! Strings pictures together: animated GIF or PNG, MP4 or WebM by ffmpeg, or numbered PNG files.

use std::fs::File;
use std::io::{BufWriter, Read, Write};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};

use super::Image;
use super::image::unwritable;
use crate::error::{Error, Fault, Result};

mod apng;
mod gif_frames;
mod kept;

use kept::Kept;

/// A movie that is being written, frame by frame.
pub struct Movie {
    path: PathBuf,
    fps: f64,
    size: Option<[usize; 2]>,
    frames: usize,
    kind: Kind,
}

/// What became of a movie.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Written {
    /// The file, or the folder of numbered files.
    pub path: PathBuf,
    /// Number of frames.
    pub frames: usize,
}

enum Kind {
    /// Written once all frames are there.
    Whole { format: Format, file: BufWriter<File>, frames: Kept },
    /// The encoder is started with the first frame, which tells the size.
    Ffmpeg { program: PathBuf, child: Option<Child> },
    /// Numbered files in a folder.
    Folder,
    /// A file for one picture, else numbered files in a folder; the first picture waits until it is known whether it stays alone.
    Sequence { folder: PathBuf, waiting: Option<Image> },
}

/// A film that is one file which we write.
#[derive(Clone, Copy)]
enum Format {
    Gif,
    AnimatedPng,
}

impl Format {
    /// How long the frame of this number, counted from 1, stays, in parts of a second that the format counts in.
    fn delay(self, frame: usize, fps: f64) -> u16 {
        match self {
            // Viewers play delays below 2 as 10, hence the lower limit.
            Self::Gif => delay(frame, fps, gif_frames::PER_SECOND).clamp(2, 6000),
            Self::AnimatedPng => delay(frame, fps, apng::PER_SECOND).max(1),
        }
    }

    fn write(self, frames: &Kept, file: &mut impl Write) -> std::io::Result<()> {
        match self {
            Self::Gif => gif_frames::write(frames, file),
            Self::AnimatedPng => apng::write(frames, file),
        }
    }
}

impl Movie {
    /// Begins a movie with `fps` pictures a second at a path whose ending says the kind: `.gif` or `.apng`; `.mp4` or
    /// `.webm`, which need the program ffmpeg on the PATH; none for a folder of numbered files; `.png`, one file for one picture and such a
    /// folder for more. GIF and animated PNG are written once all pictures are there, which wait in memory, packed.
    ///
    /// # Errors
    /// [`Error::Machine`] without ffmpeg where it is needed. When the ending or `fps` is none of these, or the file cannot be written.
    pub fn create(path: &Path, fps: f64) -> Result<Self> {
        Self::create_with(path, fps, on_path("ffmpeg"))
    }

    /// As [`Movie::create`], with the ffmpeg to use, if any.
    ///
    /// # Errors
    /// As [`Movie::create`].
    pub fn create_with(path: &Path, fps: f64, ffmpeg: Option<PathBuf>) -> Result<Self> {
        if !(fps > 0.0 && fps <= 1000.0) {
            let fault = Fault::new(format!("a movie cannot have {fps} pictures a second"));
            return Err(Error::input(fault.help("choose a number between 0.1 and 100, for example 20")));
        }
        let ending = path.extension().map(|e| e.to_string_lossy().to_lowercase()).unwrap_or_default();
        let folder = path.with_extension("");
        let kind = match (ending.as_str(), ffmpeg) {
            ("gif" | "apng", _) => {
                let file = BufWriter::new(File::create(path).map_err(|error| unwritable(path, &error))?);
                let format = if ending == "gif" { Format::Gif } else { Format::AnimatedPng };
                Kind::Whole { format, file, frames: Kept::default() }
            }
            ("mp4" | "webm", Some(program)) => {
                // ffmpeg's own words for a path it cannot write come late and long.
                File::create(path).map_err(|error| unwritable(path, &error))?;
                Kind::Ffmpeg { program, child: None }
            }
            ("mp4" | "webm", None) => {
                return Err(Error::Machine {
                    message: format!("{} cannot be made: the program ffmpeg is not there", path.display()),
                    help: "install ffmpeg (with apt, dnf or Homebrew), or let the name end in .gif or .apng; one without an ending is a folder of numbered \
                           pictures"
                        .into(),
                });
            }
            ("", _) => Kind::Folder,
            ("png", _) => Kind::Sequence { folder, waiting: None },
            _ => {
                let fault = Fault::new(format!("cannot tell from its name what kind of picture {} is", path.display()));
                return Err(Error::input(fault.help("let the name end in .gif, .apng, .mp4 or .webm; in .png for one instant; one without an ending is a folder")));
            }
        };
        Ok(Self { path: path.into(), fps, size: None, frames: 0, kind })
    }

    /// Adds a picture; all have to have the same size.
    ///
    /// # Errors
    /// When the size differs from the first picture's or the file cannot be written.
    pub fn add(&mut self, image: &Image) -> Result<()> {
        let size = *self.size.get_or_insert([image.width, image.height]);
        if size != [image.width, image.height] {
            let ([w, h], [a, b]) = (size, [image.width, image.height]);
            let fault =
                Fault::new(format!("picture {} of {} is {a}×{b}, not {w}×{h}", self.frames + 1, self.path.display()));
            return Err(Error::input(fault.help("give all pictures of a movie the same size")));
        }
        self.frames += 1;
        match &mut self.kind {
            Kind::Whole { format, frames, .. } => {
                let delay = format.delay(self.frames, self.fps);
                frames.add(image, delay).map_err(|error| unwritable(&self.path, &error))
            }
            Kind::Folder => {
                std::fs::create_dir_all(&self.path).map_err(|error| unwritable(&self.path, &error))?;
                image.save_png(&numbered(&self.path, self.frames))
            }
            Kind::Ffmpeg { program, child } => {
                if child.is_none() {
                    *child = Some(start_ffmpeg(program, &self.path, size, self.fps)?);
                }
                let input = child.as_mut().and_then(|child| child.stdin.as_mut());
                // A broken pipe means that ffmpeg has given up; why is asked in `finish`.
                let written = input.map_or(Ok(()), |input| input.write_all(&image.rgb));
                written.or_else(|_| finish_ffmpeg(child.take(), &self.path))
            }
            Kind::Sequence { folder, waiting } => {
                if self.frames == 1 {
                    *waiting = Some(image.clone());
                    return Ok(());
                }
                std::fs::create_dir_all(&*folder).map_err(|error| unwritable(folder, &error))?;
                if let Some(first) = waiting.take() {
                    first.save_png(&numbered(folder, 1))?;
                }
                image.save_png(&numbered(folder, self.frames))
            }
        }
    }

    /// Completes the files and says what was written. Of a longer film that was in a folder before nothing is left, or it would go on with that.
    ///
    /// # Errors
    /// When the last bytes cannot be written or ffmpeg reports a failure.
    pub fn finish(self) -> Result<Written> {
        let Self { path, frames, kind, .. } = self;
        match kind {
            Kind::Whole { format, mut file, frames } => {
                let written = format.write(&frames, &mut file).and_then(|()| file.flush());
                written.map_err(|error| unwritable(&path, &error))?;
            }
            Kind::Folder => remove_after(&path, frames)?,
            Kind::Ffmpeg { child, .. } => finish_ffmpeg(child, &path)?,
            Kind::Sequence { waiting: Some(only), .. } => only.save_png(&path)?,
            Kind::Sequence { folder, .. } => {
                remove_after(&folder, frames)?;
                return Ok(Written { path: folder, frames });
            }
        }
        Ok(Written { path, frames })
    }
}

/// The file of the frame of this number, counted from 1.
fn numbered(folder: &Path, frame: usize) -> PathBuf {
    folder.join(format!("{frame:05}.png"))
}

/// Removes the frames of an earlier film that follow on the last of this one.
fn remove_after(folder: &Path, last: usize) -> Result<()> {
    let mut rest = (last + 1..).map(|frame| numbered(folder, frame)).take_while(|path| path.is_file());
    rest.try_for_each(|path| std::fs::remove_file(&path).map_err(|error| unwritable(&path, &error)))
}

/// How long the frame of this number, counted from 1, stays, in parts of a second; what is rounded off it goes to the next.
fn delay(frame: usize, fps: f64, per_second: f64) -> u16 {
    let end = |frame: usize| (frame as f64 * per_second / fps).round() as u64;
    u16::try_from(end(frame) - end(frame - 1)).unwrap_or(u16::MAX)
}

/// The program of that name in the folders of PATH.
fn on_path(name: &str) -> Option<PathBuf> {
    let folders = std::env::var_os("PATH")?;
    std::env::split_paths(&folders).map(|folder| folder.join(name)).find(|program| program.is_file())
}

fn start_ffmpeg(program: &Path, path: &Path, [width, height]: [usize; 2], fps: f64) -> Result<Child> {
    let mut command = Command::new(program);
    command.args(["-y", "-loglevel", "error", "-f", "rawvideo", "-pix_fmt", "rgb24"]);
    command.args(["-s", &format!("{width}x{height}"), "-r", &fps.to_string(), "-i", "-"]);
    // Video formats want even sides; a missing row is filled with white.
    command.args(["-vf", "pad=ceil(iw/2)*2:ceil(ih/2)*2:color=white", "-pix_fmt", "yuv420p"]);
    if path.extension().is_some_and(|e| e.eq_ignore_ascii_case("webm")) {
        command.args(["-c:v", "libvpx-vp9", "-crf", "28", "-b:v", "0"]);
    } else {
        command.args(["-c:v", "libx264", "-crf", "18", "-movflags", "+faststart"]);
    }
    command.arg(path).stdin(Stdio::piped()).stdout(Stdio::null()).stderr(Stdio::piped());
    command.spawn().map_err(|error| Error::Machine {
        message: format!("cannot start {}: {error}", program.display()),
        help: "repair the installation of ffmpeg, or ask for a .gif or an .apng".into(),
    })
}

/// Waits for ffmpeg and turns its complaint into an error.
fn finish_ffmpeg(child: Option<Child>, path: &Path) -> Result<()> {
    let Some(mut child) = child else { return Ok(()) };
    drop(child.stdin.take());
    let mut complaint = String::new();
    if let Some(mut words) = child.stderr.take() {
        let _ = words.read_to_string(&mut complaint);
    }
    match child.wait() {
        Ok(status) if status.success() => Ok(()),
        outcome => {
            let outcome = outcome.map_or_else(|error| error.to_string(), |status| status.to_string());
            Err(Error::Machine {
                message: format!("ffmpeg could not write {}: {outcome}; {}", path.display(), complaint.trim()),
                help:
                    "check that the disk is not full and that ffmpeg knows H.264 or VP9, or ask for a .gif or an .apng"
                        .into(),
            })
        }
    }
}

#[cfg(test)]
pub(super) mod tests;
