//! What a film shows when it is played.

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

/// What a viewer of an animated PNG shows, frame after frame, and how long it plays (s).
fn played_png(path: &Path) -> (Vec<Image>, f64) {
    let mut reader = png::Decoder::new(std::io::BufReader::new(File::open(path).unwrap())).read_info().unwrap();
    let (width, height) = (reader.info().width as usize, reader.info().height as usize);
    let frames = reader.info().animation_control().unwrap().num_frames;
    let mut screen = Image::filled(width, height, Colour([0; 3]));
    let (mut shown, mut seconds) = (Vec::new(), 0.0);
    for _ in 0..frames {
        let mut pixels = vec![0; reader.output_buffer_size().unwrap()];
        reader.next_frame(&mut pixels).unwrap();
        let about = *reader.info().frame_control().unwrap();
        seconds += f64::from(about.delay_num) / f64::from(about.delay_den);
        for (y, row) in pixels.chunks_exact(3 * about.width as usize).take(about.height as usize).enumerate() {
            let to = 3 * ((y + about.y_offset as usize) * width + about.x_offset as usize);
            screen.rgb[to..to + row.len()].copy_from_slice(row);
        }
        shown.push(screen.clone());
    }
    (shown, seconds)
}

/// A shaded ball that moves over a ground with a gradient, and blinks in many colours: more than a GIF has.
fn moving_ball(frame: usize) -> Image {
    let (width, height) = (96, 64);
    let mut image = Image::filled(width, height, Colour([0; 3]));
    for (n, pixel) in image.rgb.chunks_exact_mut(3).enumerate() {
        let (x, y) = (n % width, n / width);
        let (dx, dy) = (x as f64 - 16.0 - 8.0 * frame as f64, y as f64 - 32.0);
        let depth = (144.0 - dx * dx - dy * dy).max(0.0).sqrt() / 12.0;
        let ground = [255 - (y / 5) as u8, 255 - (y / 6) as u8, 255 - (y / 8) as u8];
        let lit = |part: f64| (255.0 * part * (0.3 + 0.7 * depth)) as u8;
        let turn = frame as f64 * 0.7 + dx / 12.0;
        let paint = [0.5 + 0.5 * turn.sin(), 0.5 + 0.5 * (turn + 2.1).sin(), 0.5 + 0.5 * (turn + 4.2).sin()].map(lit);
        pixel.copy_from_slice(if depth > 0.0 { &paint } else { &ground });
    }
    image
}

/// What is shown of a film that is written to a file of this name.
fn film(name: &str, frames: usize) -> (Vec<Image>, Vec<Image>, std::path::PathBuf, tempfile::TempDir) {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join(name);
    let mut movie = Movie::create(&path, 12.0).unwrap();
    // The ball goes on and is back where it was: what changes is small on the right, then wide from the left.
    let meant: Vec<Image> = (0..frames).map(|frame| moving_ball(frame % 5)).collect();
    meant.iter().for_each(|image| movie.add(image).unwrap());
    movie.finish().unwrap();
    (if name.ends_with("gif") { played(&path).0 } else { played_png(&path).0 }, meant, path, folder)
}

#[test]
fn a_gif_has_no_ghosts_and_does_not_flicker() {
    let (shown, meant, ..) = film("ball.gif", 8);
    assert_eq!(shown.len(), meant.len());
    let pixel = |image: &Image, at: usize| <[u8; 3]>::try_from(&image.rgb[3 * at..3 * at + 3]).unwrap();
    for at in 0..96 * 64 {
        for (frame, image) in meant.iter().enumerate() {
            // Where a pixel has the colour again that it had, it looks as it did: nothing is left of what passed it.
            let first = meant.iter().position(|other| pixel(other, at) == pixel(image, at)).unwrap();
            assert_eq!(pixel(&shown[frame], at), pixel(&shown[first], at), "pixel {at} in frames {first} and {frame}");
        }
    }
    for (image, meant) in shown.iter().zip(&meant) {
        let apart = image.rgb.iter().zip(&meant.rgb).map(|(a, b)| u64::from(a.abs_diff(*b)));
        let mean = apart.clone().sum::<u64>() as f64 / image.rgb.len() as f64;
        // 255 colours for some thousand.
        assert!(mean < 2.0 && apart.max().unwrap() < 48, "{mean}");
    }
}

#[test]
fn an_animated_png_shows_the_pictures_themselves() {
    let (shown, meant, path, _folder) = film("ball.apng", 8);
    assert_eq!(shown, meant);
    assert!((played_png(&path).1 - 8.0 / 12.0).abs() < 0.001);
    let (shown, meant, ..) = film("still.apng", 1);
    assert_eq!(shown, meant);
}

#[test]
fn a_name_without_an_ending_is_a_folder() {
    let folder = tempfile::tempdir().unwrap();
    for frames in [1, 3] {
        let path = folder.path().join(format!("frames{frames}"));
        let mut movie = Movie::create(&path, 10.0).unwrap();
        (0..frames).for_each(|frame| movie.add(&moving_square(frame)).unwrap());
        assert_eq!(movie.finish().unwrap(), Written { path: path.clone(), frames });
        assert_eq!(path.read_dir().unwrap().count(), frames);
    }
}

#[test]
fn frames_of_a_longer_film_in_the_same_folder_go_and_nothing_else_does() {
    let folder = tempfile::tempdir().unwrap();
    for name in ["film", "film.png"] {
        let numbered = folder.path().join("film");
        for frames in [5, 2] {
            let mut movie = Movie::create(&folder.path().join(name), 10.0).unwrap();
            (0..frames).for_each(|frame| movie.add(&moving_square(frame)).unwrap());
            movie.finish().unwrap();
            std::fs::write(numbered.join("00009.png"), "another's").unwrap();
            assert_eq!(numbered.read_dir().unwrap().count(), frames + 1);
        }
    }
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
