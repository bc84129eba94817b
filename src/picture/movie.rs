//! Strings pictures together: animated GIF, MP4 or WebM by ffmpeg, or numbered PNG files.

use std::fs::File;
use std::io::{BufWriter, Read, Write};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};

use super::Image;
use super::image::unwritable;
use crate::error::{Error, Fault, Result};

mod gif_frames;

use gif_frames::GifFrames;

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
    Gif(GifFrames<BufWriter<File>>),
    /// The encoder is started with the first frame, which tells the size.
    Ffmpeg {
        program: PathBuf,
        child: Option<Child>,
    },
    /// Numbered files in a folder; the first picture waits until it is known whether it stays alone.
    Sequence {
        folder: PathBuf,
        waiting: Option<Image>,
    },
}

impl Movie {
    /// Begins a movie with `fps` pictures a second at a path whose ending says the kind: `.gif`; `.mp4` or `.webm`,
    /// which need the program ffmpeg on the PATH; `.png`, one file for one picture and a folder of numbered files for more.
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
            ("gif", _) => {
                let file = File::create(path).map_err(|error| unwritable(path, &error))?;
                Kind::Gif(GifFrames::new(BufWriter::new(file)))
            }
            ("mp4" | "webm", Some(program)) => {
                // ffmpeg's own words for a path it cannot write come late and long.
                File::create(path).map_err(|error| unwritable(path, &error))?;
                Kind::Ffmpeg { program, child: None }
            }
            ("mp4" | "webm", None) => {
                return Err(Error::Machine {
                    message: format!("{} cannot be made: the program ffmpeg is not there", path.display()),
                    help: "install ffmpeg (with apt, dnf or Homebrew), or let the name end in .gif, or in .png for a folder of numbered \
                           pictures"
                        .into(),
                });
            }
            ("png", _) => Kind::Sequence { folder, waiting: None },
            _ => {
                let fault = Fault::new(format!("cannot tell from its name what kind of picture {} is", path.display()));
                return Err(Error::input(fault.help("let the name end in .png, .gif, .mp4 or .webm")));
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
            Kind::Gif(gif) => {
                let hundredths = |frame: usize| (frame as f64 * 100.0 / self.fps).round() as u64;
                // Viewers play delays below 2 as 10, hence the lower limit.
                let delay = (hundredths(self.frames) - hundredths(self.frames - 1)).clamp(2, 6000) as u16;
                gif.add(image, delay).map_err(|error| unwritable(&self.path, &error))
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
                    first.save_png(&folder.join("00001.png"))?;
                }
                image.save_png(&folder.join(format!("{:05}.png", self.frames)))
            }
        }
    }

    /// Completes the files and says what was written.
    ///
    /// # Errors
    /// When the last bytes cannot be written or ffmpeg reports a failure.
    pub fn finish(self) -> Result<Written> {
        let Self { path, frames, kind, .. } = self;
        match kind {
            Kind::Gif(gif) => gif.finish().map_err(|error| unwritable(&path, &error))?,
            Kind::Ffmpeg { child, .. } => finish_ffmpeg(child, &path)?,
            Kind::Sequence { waiting: Some(only), .. } => only.save_png(&path)?,
            Kind::Sequence { folder, .. } => return Ok(Written { path: folder, frames }),
        }
        Ok(Written { path, frames })
    }
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
        help: "repair the installation of ffmpeg, or ask for a .gif".into(),
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
                help: "check that the disk is not full and that ffmpeg knows H.264 or VP9, or ask for a .gif".into(),
            })
        }
    }
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;
    use crate::picture::Colour;

    /// What a viewer of a GIF shows, frame after frame, and how long it plays (hundredths of a second).
    pub(in crate::picture) fn played(path: &Path) -> (Vec<Image>, u32) {
        let mut options = gif::DecodeOptions::new();
        options.set_color_output(gif::ColorOutput::RGBA);
        let mut decoder = options.read_info(File::open(path).unwrap()).unwrap();
        let (width, height) = (usize::from(decoder.width()), usize::from(decoder.height()));
        let mut screen = Image::filled(width, height, Colour([0; 3]));
        let (mut shown, mut hundredths) = (Vec::new(), 0);
        while let Some(frame) = decoder.read_next_frame().unwrap() {
            hundredths += u32::from(frame.delay);
            for (n, pixel) in frame.buffer.chunks_exact(4).enumerate().filter(|(_, pixel)| pixel[3] != 0) {
                let (x, y) = (n % usize::from(frame.width), n / usize::from(frame.width));
                let to = 3 * ((y + usize::from(frame.top)) * width + x + usize::from(frame.left));
                screen.rgb[to..to + 3].copy_from_slice(&pixel[..3]);
            }
            shown.push(screen.clone());
        }
        (shown, hundredths)
    }

    fn moving_square(frame: usize) -> Image {
        let mut image = Image::filled(64, 40, Colour([250, 250, 250]));
        for y in 10..20 {
            for x in 0..10 {
                let at = 3 * (y * 64 + x + 4 * frame);
                image.rgb[at..at + 3].copy_from_slice(&[0, 114, 178]);
            }
        }
        image
    }

    #[test]
    fn a_gif_plays_all_frames_with_their_colours() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("square.gif");
        let mut movie = Movie::create(&path, 12.0).unwrap();
        (0..6).for_each(|frame| movie.add(&moving_square(frame)).unwrap());
        assert_eq!(movie.finish().unwrap(), Written { path: path.clone(), frames: 6 });
        let (shown, hundredths) = played(&path);
        for (frame, screen) in shown.iter().enumerate() {
            let meant = moving_square(frame);
            // Two colours fit a palette exactly; light dithering may move a colour to its neighbour only.
            assert!(screen.rgb.iter().zip(&meant.rgb).all(|(a, b)| a.abs_diff(*b) <= 2), "frame {frame}");
        }
        assert_eq!((shown.len(), hundredths), (6, 50));
    }

    #[test]
    fn one_png_is_a_file_and_several_are_a_folder() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("one.png");
        let mut movie = Movie::create(&path, 10.0).unwrap();
        movie.add(&moving_square(0)).unwrap();
        assert_eq!(movie.finish().unwrap().path, path);
        assert!(path.is_file());
        let mut movie = Movie::create(&folder.path().join("two.png"), 10.0).unwrap();
        movie.add(&moving_square(0)).unwrap();
        movie.add(&moving_square(1)).unwrap();
        let written = movie.finish().unwrap();
        assert!(written.path.join("00001.png").is_file() && written.path.join("00002.png").is_file());
    }

    #[test]
    fn without_ffmpeg_a_film_is_an_error_that_helps_and_leaves_nothing() {
        let folder = tempfile::tempdir().unwrap();
        let error = Movie::create_with(&folder.path().join("cells.mp4"), 10.0, None).err().expect("no film");
        assert_eq!(error.exit_code(), 1);
        assert!(error.to_string().contains("ffmpeg is not there"), "{error}");
        assert_eq!(folder.path().read_dir().unwrap().count(), 0);
    }

    #[test]
    fn what_cannot_become_a_movie_is_an_error_that_helps() {
        assert_eq!(Movie::create(Path::new("cells.avi"), 10.0).err().unwrap().exit_code(), 2);
        assert_eq!(Movie::create(Path::new("cells.gif"), 0.0).err().unwrap().exit_code(), 2);
        let error = Movie::create(Path::new("/nowhere/cells.gif"), 10.0).err().unwrap();
        assert!(error.to_string().contains("/nowhere/cells.gif"));
        let folder = tempfile::tempdir().unwrap();
        let mut movie = Movie::create(&folder.path().join("a.gif"), 10.0).unwrap();
        movie.add(&moving_square(0)).unwrap();
        assert!(movie.add(&Image::filled(3, 3, Colour([0; 3]))).is_err());
    }
}
