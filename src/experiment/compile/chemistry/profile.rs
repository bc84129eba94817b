//! Profiles that fields start from: images and datasets of HDF5 files, brought onto the grid.

use std::path::{Path, PathBuf};

use crate::equations::eml::Profile;
use crate::error::{Error, Fault, Location, Result};
use crate::field::Grid;

/// Values of a profile that a file gives, one for each box of the grid in the order of its memory. The picture covers
/// the whole grid, its first row at the top (the largest y); values between its points are interpolated linearly. Paths start
/// from the folder of `document`.
///
/// # Errors
/// A file that cannot be read, or is not of the grid's dimension.
pub fn load(document: &Path, profile: &Profile, grid: &Grid) -> Result<Vec<f64>> {
    let folder = document.parent().unwrap_or(Path::new("."));
    match profile {
        Profile::Expression(_) => Ok(Vec::new()),
        Profile::Image { file, scale, location } => {
            let table = image(&folder.join(file)).map_err(|message| refuse(location, &message))?;
            if !grid.is_flat() {
                return Err(refuse(location, "an image has two dimensions, the grid has three"));
            }
            Ok(table.onto(grid).into_iter().map(|value| value * scale).collect())
        }
        Profile::Dataset { file, dataset, scale, location } => {
            let table = table(&folder.join(file), dataset).map_err(|message| refuse(location, &message))?;
            if grid.is_flat() != (table.size[2] == 1) {
                return Err(refuse(location, "the dataset and the grid have different numbers of dimensions"));
            }
            let values: Vec<f64> = table.onto(grid).into_iter().map(|value| value * scale).collect();
            if values.iter().any(|value| !value.is_finite()) {
                return Err(refuse(location, "the dataset has values that are not finite"));
            }
            Ok(values)
        }
    }
}

fn refuse(location: &Location, message: &str) -> Error {
    let help = "give a PNG image, or FILE.h5:/DATASET with numbers [y][x] or [z][y][x]";
    Error::input(Fault::new(message).at(location.clone()).help(help))
}

/// Numbers on a regular grid, x running fastest, the first row at the smallest y.
struct Table {
    size: [usize; 3],
    values: Vec<f64>,
}

impl Table {
    /// Values at the centres of a grid's boxes that covers the same region.
    fn onto(&self, grid: &Grid) -> Vec<f64> {
        // The two points of the table on either side of a box's centre, and the share of the second.
        let along = |axis: usize| -> Vec<(usize, usize, f64)> {
            let (n, boxes) = (self.size[axis], grid.cells[axis]);
            let location = |b: usize| ((b as f64 + 0.5) / boxes as f64 * n as f64 - 0.5).clamp(0.0, n as f64 - 1.0);
            (0..boxes).map(location).map(|p| (p as usize, (p as usize + 1).min(n - 1), p.fract())).collect()
        };
        let (xs, ys, zs) = (along(0), along(1), along(2));
        let at = |x: usize, y: usize, z: usize| self.values[(z * self.size[1] + y) * self.size[0] + x];
        let mut found = Vec::with_capacity(grid.len());
        for &(z0, z1, w) in &zs {
            for &(y0, y1, v) in &ys {
                for &(x0, x1, u) in &xs {
                    let row = |y, z| (1.0 - u) * at(x0, y, z) + u * at(x1, y, z);
                    let level = |z| (1.0 - v) * row(y0, z) + v * row(y1, z);
                    found.push((1.0 - w) * level(z0) + w * level(z1));
                }
            }
        }
        found
    }
}

/// The brightness of an image, 0 black to 1 white.
fn image(path: &PathBuf) -> std::result::Result<Table, String> {
    let name = path.display();
    let file = std::fs::File::open(path).map_err(|error| format!("{name} cannot be read: {error}"))?;
    let mut decoder = png::Decoder::new(std::io::BufReader::new(file));
    decoder.set_transformations(png::Transformations::normalize_to_color8());
    let mut reader = decoder.read_info().map_err(|error| format!("{name} is no PNG image: {error}"))?;
    let size = reader.output_buffer_size().ok_or_else(|| format!("{name} is too large"))?;
    let mut bytes = vec![0; size];
    let info = reader.next_frame(&mut bytes).map_err(|error| format!("{name} is damaged: {error}"))?;
    let samples = info.color_type.samples();
    let (width, height) = (info.width as usize, info.height as usize);
    let brightness = |pixel: &[u8]| {
        let grey = |c: &u8| f64::from(*c) / 255.0;
        // Luma of ITU-R BT.709 for colours; alpha does not count.
        if samples >= 3 {
            0.2126 * grey(&pixel[0]) + 0.7152 * grey(&pixel[1]) + 0.0722 * grey(&pixel[2])
        } else {
            grey(&pixel[0])
        }
    };
    let rows: Vec<Vec<f64>> = bytes
        .chunks_exact(info.line_size)
        .take(height)
        .map(|row| row.chunks_exact(samples).take(width).map(brightness).collect())
        .collect();
    Ok(Table { size: [width, height, 1], values: rows.into_iter().rev().flatten().collect() })
}

/// A dataset `[y][x]` or `[z][y][x]`.
fn table(path: &PathBuf, dataset: &str) -> std::result::Result<Table, String> {
    let name = path.display();
    let file = hdf5::File::open(path).map_err(|error| format!("{name} cannot be read: {error}"))?;
    let data = file.dataset(dataset).map_err(|_| format!("{name} has no dataset {dataset}"))?;
    let shape = data.shape();
    let size = match shape[..] {
        [y, x] => [x, y, 1],
        [z, y, x] => [x, y, z],
        _ => return Err(format!("{dataset} has {} dimensions; 2 or 3 were expected", shape.len())),
    };
    if size.contains(&0) {
        return Err(format!("{dataset} is empty"));
    }
    let values = data.read_raw::<f64>().map_err(|error| format!("{dataset} holds no numbers: {error}"))?;
    Ok(Table { size, values })
}
