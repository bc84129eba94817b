//! Makes pictures out of what a run records: cells coloured by type or by any stored quantity, on their planes.
//!
//! [`Framing`] looks at all frames that will be drawn and fixes what must not jump between them (camera, floor, range
//! of colours); [`picture_of`] then draws any one of them.

use std::collections::HashSet;

use super::Image;
use super::colour::{Colour, ColourMap, scale_of};
use super::render::{
    Background, Bounds, Camera, ClockUnit, Edges, FieldBar, Floor, Insets, Key, Overlay, Pane, Projection, ScaleBar,
    Scene, Sheet, Surface, SurfaceColour, basis, draw, time_text,
};
use super::ticks::nice_above;
use super::tools::add_tool;
use crate::Vec3;
use crate::output::{Cell, CellType, Layout, Obstacle};

/// The colour of fibres: a dark red, as stained actomyosin is often shown.
const FIBRE: Colour = Colour([0xa8, 0x1d, 0x2d]);

/// One recorded instant.
#[derive(Debug, Clone, Copy)]
pub struct Snapshot<'a> {
    /// Types of cells with their meshes, and planes.
    pub layout: &'a Layout,
    /// The cells that there are.
    pub cells: &'a [Cell],
    /// Positions of all atoms, µm.
    pub positions: &'a [[f64; 3]],
    /// Simulated time, s.
    pub time: f64,
    /// What colours show.
    pub values: Values<'a>,
    /// Arrows over the cells, from tail to tip (µm): loads, velocities.
    pub arrows: &'a [[[f64; 3]; 2]],
    /// Fibres inside the cells: their ends (µm) and what they pull with (pN); none where they are not shown in any frame.
    pub fibres: Option<&'a [DrawnFibre]>,
    /// A field under or between the cells; the look says its colours.
    pub field: Option<&'a Sheet>,
    /// Positions of the atoms of a cell of each type, µm, from which its edges are known; those behind the last have those of now.
    pub rest: &'a [Vec<[f64; 3]>],
    /// How far obstacles have gone, µm, in the order of the layout; those behind the last have not.
    pub gone: &'a [Vec3],
}

/// The ends of a fibre (µm) and what it pulls with (pN).
pub type DrawnFibre = ([[f64; 3]; 2], f64);

/// What colours show.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub enum Values<'a> {
    /// The type of the cell.
    #[default]
    Type,
    /// One number per atom, in the order of the positions.
    Atoms(&'a [f64]),
    /// One number per cell, in the order of the cells.
    Cells(&'a [f64]),
}

/// How the pictures of a run look.
#[derive(Debug, Clone, PartialEq)]
pub struct Look {
    /// Top left; empty for none.
    pub title: String,
    /// Colours of the types; a missing one comes from the palette.
    pub type_colours: Vec<Colour>,
    /// Colours of numbers.
    pub map: ColourMap,
    /// Lowest and highest number of the colour bar; `None` takes them from the frames that were included.
    pub range: Option<[f64; 2]>,
    /// The least difference between numbers that is more than round-off, besides a millionth of their size.
    pub least: f64,
    /// Name of the numbers with unit.
    pub label: String,
    /// Colours of a field.
    pub field_map: ColourMap,
    /// Lowest and highest number of the field's colour bar; `None` takes them from the frames that were included.
    pub field_range: Option<[f64; 2]>,
    /// Name of the field with unit.
    pub field_label: String,
    /// The unit of times; that which suits the run when absent.
    pub clock: Option<ClockUnit>,
    /// Whether the edges of facets are drawn.
    pub edges: Edges,
    /// How much skins hide, 0 to 1; `None` lets them be translucent where there are links inside.
    pub opacity: Option<f32>,
    /// How far before the middle of the cells things are cut off, µm; `None` for not at all.
    pub cut: Option<f64>,
    /// From the scene towards the camera; only the direction counts.
    pub direction: [f64; 3],
    /// The direction that is up in the picture.
    pub up: [f64; 3],
    /// Parallel or perspective; the height of a parallel projection is fitted.
    pub projection: Projection,
    /// The scale bar.
    pub scale_bar: ScaleBar,
    /// Whether the time is written.
    pub time: bool,
    /// How much larger things are than where all of them just fit in.
    pub zoom: f64,
    /// What is behind everything.
    pub background: Background,
    /// Numbers of types that have no entry in the legend.
    pub unnamed: Vec<usize>,
}

impl Default for Look {
    fn default() -> Self {
        Self {
            title: String::new(),
            type_colours: Vec::new(),
            map: ColourMap::default(),
            range: None,
            least: 0.0,
            label: String::new(),
            field_map: ColourMap::Ink,
            field_range: None,
            field_label: String::new(),
            clock: None,
            edges: Edges::Hidden,
            opacity: None,
            cut: None,
            direction: [0.35, -1.0, 0.75],
            up: [0.0, 0.0, 1.0],
            projection: Projection::Orthographic { height: 1.0 },
            scale_bar: ScaleBar::Auto,
            time: true,
            zoom: 1.0,
            background: Background::default(),
            unnamed: Vec::new(),
        }
    }
}

/// What stays the same in all pictures of a run.
#[derive(Debug, Clone, PartialEq)]
pub struct Framing {
    axes: [Vec3; 3],
    /// For each of a set of directions seen by the camera the outermost point so far.
    outermost: Vec<(Vec3, f64, [f64; 3])>,
    bounds: Option<Bounds>,
    /// Corners of the panes, which are to be seen whole.
    pane_corners: Vec<[f64; 3]>,
    /// Corners of the part of the field around the cells, which is to be seen whole.
    field_corners: Vec<[f64; 3]>,
    range: [f64; 2],
    field_range: [f64; 2],
    /// What the strongest fibre pulls with, pN.
    strongest: f64,
    longest: f64,
}

impl Framing {
    /// Nothing seen yet, for pictures with this look.
    pub fn new(look: &Look) -> Self {
        let back = Vec3::from(look.direction).try_normalize(1e-300).unwrap_or(Vec3::z());
        let [right, up, forward] = basis(-back, Vec3::from(look.up));
        let axes = [right, up, -forward];
        let mut outermost = Vec::new();
        for n in 0..27 {
            let signs = [n % 3, n / 3 % 3, n / 9].map(|k| f64::from(k) - 1.0);
            let direction = axes[0] * signs[0] + axes[1] * signs[1] + axes[2] * signs[2];
            if n != 13 {
                outermost.push((direction, f64::NEG_INFINITY, [0.0; 3]));
            }
        }
        Self {
            axes,
            outermost,
            bounds: None,
            pane_corners: Vec::new(),
            field_corners: Vec::new(),
            range: [f64::INFINITY, f64::NEG_INFINITY],
            field_range: [f64::INFINITY, f64::NEG_INFINITY],
            strongest: 0.0,
            longest: 0.0,
        }
    }

    /// For pictures of a run that lasts at least so long, s: all their times have the unit that suits this one.
    pub fn lasting(mut self, time: f64) -> Self {
        self.longest = self.longest.max(time);
        self
    }

    /// Fits the view to a frame that will be drawn.
    pub fn include(&mut self, snapshot: &Snapshot) {
        let points = || snapshot.positions.iter().chain(snapshot.arrows.iter().flatten());
        for point in points().filter(|point| point.iter().all(|v| v.is_finite())) {
            let at = Vec3::from(*point);
            for (direction, far, outermost) in &mut self.outermost {
                let along = direction.dot(&at);
                if along > *far {
                    (*far, *outermost) = (along, *point);
                }
            }
        }
        if let Some(bounds) = Bounds::around(points()) {
            let bounds = self.bounds.map_or(bounds, |before| before.joined(bounds));
            self.bounds = Some(bounds);
            let mut planes = Scene::default();
            add_planes(&mut planes, snapshot.layout, &bounds, 1.0);
            self.pane_corners = planes.panes.iter().flat_map(corners).collect();
        }
        if let Values::Atoms(values) | Values::Cells(values) = snapshot.values {
            for value in values.iter().filter(|value| value.is_finite()) {
                self.range = [self.range[0].min(*value), self.range[1].max(*value)];
            }
        }
        if let Some(sheet) = snapshot.field {
            for value in sheet.values.iter().filter(|value| value.is_finite()) {
                self.field_range = [self.field_range[0].min(*value), self.field_range[1].max(*value)];
            }
            self.field_corners = corners_near(sheet, self.bounds.as_ref());
        }
        let pulls = snapshot.fibres.into_iter().flatten().map(|(_, tension)| *tension);
        self.strongest = pulls.fold(self.strongest, f64::max);
        self.longest = self.longest.max(snapshot.time);
    }

    /// The camera that shows everything included.
    pub fn camera(&self, look: &Look, aspect: f64, insets: Insets) -> Camera {
        let mut points: Vec<[f64; 3]> = self.outermost.iter().filter(|o| o.1.is_finite()).map(|o| o.2).collect();
        points.extend(&self.pane_corners);
        points.extend(&self.field_corners);
        let fitted = Camera::fit(&points, self.axes[2].into(), self.axes[1].into(), look.projection, aspect, insets);
        fitted.zoomed(look.zoom)
    }

    /// The numbers at the ends of the colour bar.
    fn ends(&self, look: &Look) -> [f64; 2] {
        look.range.unwrap_or_else(|| scale_of(self.range, look.least))
    }

    /// The numbers at the ends of the field's colour bar.
    fn field_ends(&self, look: &Look) -> [f64; 2] {
        // A field that comes close to nothing is shown from nothing on.
        let [low, high] = self.field_range;
        let from_zero = if (0.0..0.25 * high).contains(&low) { 0.0 } else { low };
        look.field_range.unwrap_or_else(|| scale_of([from_zero, high], 0.0))
    }
}

/// The corners of what a picture should show of a sheet: no more than a wide margin around the cells, so that a few
/// cells in a wide field do not become specks. Without cells it is the whole sheet.
fn corners_near(sheet: &Sheet, bounds: Option<&Bounds>) -> Vec<[f64; 3]> {
    let reach = |axis: usize| {
        let (start, end) = (sheet.corner[axis], sheet.corner[axis] + sheet.side_u[axis] + sheet.side_v[axis]);
        let Some(bounds) = bounds else { return (start, end) };
        let margin = 1.5 * bounds.diagonal();
        (start.max(bounds.low[axis] - margin), end.min(bounds.high[axis] + margin))
    };
    let (x, y) = (reach(0), reach(1));
    if x.0 > x.1 || y.0 > y.1 {
        return Vec::new();
    }
    let z = sheet.corner[2];
    vec![[x.0, y.0, z], [x.1, y.0, z], [x.0, y.1, z], [x.1, y.1, z]]
}

/// Draws one recorded instant.
///
/// # Panics
/// When there are fewer positions than the cells have atoms; result files are checked when they are read.
pub fn picture_of(snapshot: &Snapshot, look: &Look, framing: &Framing, width: usize, height: usize) -> Image {
    let overlay = overlay_of(snapshot, look, framing);
    let camera = framing.camera(look, width as f64 / height.max(1) as f64, overlay.insets());
    draw(&scene_of(snapshot, look, framing), &camera, &overlay, width, height)
}

/// The lettering for one recorded instant.
pub fn overlay_of(snapshot: &Snapshot, look: &Look, framing: &Framing) -> Overlay {
    let [low, high] = framing.ends(look);
    let key = match snapshot.values {
        Values::Type if snapshot.layout.types.len() < 2 => Key::None,
        Values::Type => {
            let named = |(kind, known): (usize, &CellType)| (known.name.clone(), type_colour(look, kind));
            let types = snapshot.layout.types.iter().enumerate().filter(|(kind, _)| !look.unnamed.contains(kind));
            Key::Names(types.map(named).collect())
        }
        _ => Key::Bar { map: look.map, low, high, label: look.label.clone() },
    };
    let time = if look.time { time_text(snapshot.time, framing.longest, look.clock) } else { String::new() };
    let bar = || FieldBar { map: look.field_map, range: framing.field_ends(look), label: look.field_label.clone() };
    let field = snapshot.field.map(|_| bar());
    Overlay { title: look.title.clone(), time, scale_bar: look.scale_bar, key, field }
}

/// Cells, links, arrows and planes of one recorded instant.
///
/// # Panics
/// As [`picture_of`].
pub fn scene_of(snapshot: &Snapshot, look: &Look, framing: &Framing) -> Scene {
    let (layout, positions) = (snapshot.layout, snapshot.positions);
    let ends = framing.ends(look);
    let number_colour = |value: f64| look.map.of_value(value, ends);
    let has_links = snapshot.cells.iter().any(|cell| !layout.types[cell.kind as usize].links.is_empty());
    // Skins are as translucent in frames without fibres as in those with them.
    let shows_inside = has_links || snapshot.fibres.is_some();
    let opacity = look.opacity.unwrap_or(if shows_inside { 0.35 } else { 1.0 });
    let mut scene = Scene { background: look.background, ..Scene::default() };
    let mut sizes = Vec::with_capacity(snapshot.cells.len());
    for (number, (cell, atoms)) in snapshot.cells.iter().zip(layout.atoms_of(snapshot.cells)).enumerate() {
        let facets = layout.types[cell.kind as usize].facets.clone();
        let colour = match snapshot.values {
            Values::Type => SurfaceColour::Uniform(type_colour(look, cell.kind as usize)),
            Values::Cells(values) => {
                SurfaceColour::Uniform(number_colour(values.get(number).copied().unwrap_or(f64::NAN)))
            }
            Values::Atoms(values) => SurfaceColour::PerAtom(
                atoms.clone().map(|atom| number_colour(values.get(atom).copied().unwrap_or(f64::NAN))).collect(),
            ),
        };
        let own = positions[atoms].to_vec();
        sizes.extend(Bounds::around(&own).map(|bounds| bounds.diagonal()));
        scene.surfaces.push(Surface {
            positions: own,
            rest: snapshot.rest.get(cell.kind as usize).cloned().unwrap_or_default(),
            is_solid: look.cut.is_some() && is_closed(&facets),
            facets,
            colour,
            edges: look.edges,
            is_outlined: true,
            opacity,
            ..Surface::default()
        });
    }
    sizes.sort_unstable_by(f64::total_cmp);
    let typical = sizes.get(sizes.len() / 2).copied().unwrap_or(1.0);
    let dark = Colour([0x3a, 0x40, 0x4a]);
    for (cell, atoms) in snapshot.cells.iter().zip(layout.atoms_of(snapshot.cells)) {
        for [a, b] in &layout.types[cell.kind as usize].links {
            scene.add_line(
                positions[atoms.start + *a as usize],
                positions[atoms.start + *b as usize],
                0.004 * typical,
                dark,
            );
        }
    }
    for ([from, to], tension) in snapshot.fibres.into_iter().flatten().filter(|(_, tension)| *tension > 0.0) {
        // A bundle's cross-section goes with what it pulls with.
        let share = (tension / framing.strongest.max(*tension)).sqrt();
        scene.add_line(*from, *to, (0.002 + 0.003 * share) * typical, FIBRE);
    }
    for [tail, tip] in snapshot.arrows {
        scene.add_arrow(*tail, *tip, 0.011 * typical, dark);
    }
    for (number, tool) in layout.obstacles.iter().enumerate().filter(|(_, obstacle)| !obstacle.profile.is_empty()) {
        add_tool(&mut scene, tool, snapshot.gone.get(number).copied().unwrap_or_else(Vec3::zeros));
    }
    if let Some(bounds) = framing.bounds.or_else(|| Bounds::around(positions)) {
        add_planes(&mut scene, layout, &bounds, typical);
        let before = |cut: f64| Vec3::from(bounds.centre()) + cut * framing.axes[2];
        scene.cut = look.cut.map(|cut| before(cut).into());
    }
    let coloured = |sheet: &Sheet| Sheet { map: look.field_map, range: framing.field_ends(look), ..sheet.clone() };
    scene.sheet = snapshot.field.map(coloured);
    scene
}

/// Whether every side of a facet is one of another, which runs along it the other way.
fn is_closed(facets: &[[u32; 3]]) -> bool {
    let sides = || facets.iter().flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]]);
    let known: HashSet<[u32; 2]> = sides().collect();
    sides().all(|[from, to]| known.contains(&[to, from]))
}

/// The plane that looks up most becomes the floor, the others panes around the cells.
fn add_planes(scene: &mut Scene, layout: &Layout, bounds: &Bounds, typical: f64) {
    let up = |plane: &Obstacle| Vec3::from(plane.normal).try_normalize(1e-300).map_or(0.0, |n| n.z);
    let planes = || layout.obstacles.iter().filter(|obstacle| obstacle.profile.is_empty());
    let floor = planes().filter(|plane| up(plane) > 0.7).max_by(|a, b| up(a).total_cmp(&up(b)));
    let centre = Vec3::from(bounds.centre());
    for plane in planes() {
        let Some(n) = Vec3::from(plane.normal).try_normalize(1e-300) else { continue };
        let below = centre - n * (centre - Vec3::from(plane.point)).dot(&n);
        if floor.is_some_and(|floor| std::ptr::eq(floor, plane)) {
            // Grid lines lie at whole multiples of their distance, so that they can be read as a ruler.
            let grid = nice_above(0.8 * typical);
            let snapped = below - Vec3::new(below.x % (5.0 * grid), below.y % (5.0 * grid), 0.0);
            let middle = if n.z > 0.999 { snapped } else { below };
            let radius = 2.2 * bounds.diagonal().max(2.0 * typical);
            scene.floor = Some(Floor { point: middle.into(), normal: n.into(), grid, radius });
        } else {
            let v = n.cross(&if n.x.abs() < 0.9 { Vec3::x() } else { Vec3::y() }).normalize();
            let u = v.cross(&n);
            // As large as the cells' box along both sides and a little more.
            let reach = |side: &Vec3| {
                let offsets = bounds.corners().map(|corner| (Vec3::from(corner) - centre).dot(side).abs());
                side * (1.08 * offsets.into_iter().fold(0.0, f64::max))
            };
            let (half_u, half_v) = (reach(&u).into(), reach(&v).into());
            scene.panes.push(Pane { centre: below.into(), half_u, half_v, colour: Colour([0x7f, 0x98, 0xb0]) });
        }
    }
}

/// The four corners of a pane.
fn corners(pane: &Pane) -> [[f64; 3]; 4] {
    let (centre, u, v) = (Vec3::from(pane.centre), Vec3::from(pane.half_u), Vec3::from(pane.half_v));
    [centre + u + v, centre + u - v, centre - u + v, centre - u - v].map(Into::into)
}

fn type_colour(look: &Look, kind: usize) -> Colour {
    look.type_colours.get(kind).copied().unwrap_or_else(|| Colour::of_palette(kind))
}

#[cfg(test)]
mod tests {
    use super::*;

    const CELLS: [Cell; 2] = [Cell { id: 0, kind: 0, parent: None }, Cell { id: 1, kind: 1, parent: None }];

    fn two_cells() -> (Layout, Vec<[f64; 3]>) {
        let (mut layout, mut positions) = (Layout::default(), Vec::new());
        for (kind, name) in [(0_u32, "round"), (1, "square")] {
            let cell = crate::picture::render::tests::sphere([12.0 * f64::from(kind), 0.0, 5.0], 5.0, 2);
            let (atoms, facets) = (cell.positions.len() as u32, cell.facets);
            layout.types.push(CellType { name: name.into(), atoms, facets, links: Vec::new() });
            positions.extend(cell.positions);
        }
        let plane = |name: &str, height: f64, up: f64| Obstacle {
            name: name.into(),
            point: [0.0, 0.0, height],
            normal: [0.0, 0.0, up],
            ..Obstacle::default()
        };
        layout.obstacles = vec![plane("ground", 0.0, 1.0), plane("lid", 10.0, -1.0)];
        (layout, positions)
    }

    #[test]
    fn types_and_numbers_colour_the_cells() {
        let (layout, positions) = two_cells();
        let mut snapshot = Snapshot {
            layout: &layout,
            cells: &CELLS,
            positions: &positions,
            time: 3.0,
            values: Values::Type,
            arrows: &[],
            fibres: None,
            field: None,
            rest: &[],
            gone: &[],
        };
        let look = Look::default();
        let mut framing = Framing::new(&look);
        framing.include(&snapshot);
        let scene = scene_of(&snapshot, &look, &framing);
        assert_eq!(scene.surfaces[1].colour, SurfaceColour::Uniform(Colour::of_palette(1)));
        assert!(scene.floor.is_some() && scene.panes.len() == 1);
        assert!(matches!(overlay_of(&snapshot, &look, &framing).key, Key::Names(names) if names.len() == 2));
        snapshot.values = Values::Cells(&[-1.0, 4.0]);
        framing.include(&snapshot);
        let scene = scene_of(&snapshot, &look, &framing);
        assert_eq!(scene.surfaces[0].colour, SurfaceColour::Uniform(ColourMap::Viridis.at(0.0)));
        assert_eq!(scene.surfaces[1].colour, SurfaceColour::Uniform(ColourMap::Viridis.at(1.0)));
        let key = overlay_of(&snapshot, &look, &framing).key;
        assert!(matches!(key, Key::Bar { low, high, .. } if low == -1.0 && high == 4.0));
        // Exact volumes differ by round-off, which is neither a range nor two colours.
        snapshot.values = Values::Cells(&[523.598_775_598_3, 523.598_775_598_2]);
        let mut framing = Framing::new(&look);
        framing.include(&snapshot);
        let scene = scene_of(&snapshot, &look, &framing);
        assert_eq!(scene.surfaces[0].colour, scene.surfaces[1].colour);
        let key = overlay_of(&snapshot, &look, &framing).key;
        assert!(matches!(key, Key::Bar { low, high, .. } if low == high));
    }

    #[test]
    fn every_frame_of_a_run_has_its_time_in_the_same_unit() {
        let (layout, positions) = two_cells();
        let look = Look::default();
        let stamp = |time: f64| {
            let (positions, values) = (&positions, Values::Type);
            let snapshot = Snapshot {
                layout: &layout,
                cells: &CELLS,
                positions,
                time,
                values,
                arrows: &[],
                fibres: None,
                field: None,
                rest: &[],
                gone: &[],
            };
            // A picture of one frame alone: the others have not been seen.
            let mut framing = Framing::new(&look).lasting(600.0);
            framing.include(&snapshot);
            overlay_of(&snapshot, &look, &framing).time
        };
        let stamps = [0.0, 1.5, 600.0].map(stamp);
        assert!(stamps.iter().all(|stamp| stamp.ends_with(" min")), "{stamps:?}");
    }

    #[test]
    fn the_camera_shows_all_frames() {
        let (layout, positions) = two_cells();
        let moved: Vec<[f64; 3]> = positions.iter().map(|p| [p[0] + 40.0, p[1], p[2]]).collect();
        let look = Look::default();
        let still = |positions| Snapshot {
            layout: &layout,
            cells: &CELLS,
            positions,
            time: 0.0,
            values: Values::Type,
            arrows: &[],
            fibres: None,
            field: None,
            rest: &[],
            gone: &[],
        };
        let (mut one, mut both) = (Framing::new(&look), Framing::new(&look));
        one.include(&still(&positions));
        both.include(&still(&positions));
        both.include(&still(&moved));
        let across =
            |framing: &Framing| 720.0 / framing.camera(&look, 16.0 / 9.0, Insets::default()).pixels_per_micron(720);
        assert!(across(&both) > 2.0 * across(&one), "{} {}", across(&both), across(&one));
    }

    #[test]
    #[ignore = "gallery: writes pictures for a person to judge into PICTURES or the temporary folder"]
    fn gallery_of_frames() {
        let folder = std::env::var_os("PICTURES").map_or_else(std::env::temp_dir, std::path::PathBuf::from);
        let (layout, positions) = two_cells();
        let look = Look { title: "Two cells approach".into(), label: "height (µm)".into(), ..Look::default() };
        let frames: Vec<Vec<[f64; 3]>> = (0..20)
            .map(|k| {
                positions.iter().map(|p| [p[0] + 0.2 * f64::from(k) * (6.0 - p[0]).signum(), p[1], p[2]]).collect()
            })
            .collect();
        let heights: Vec<f64> = positions.iter().map(|p| p[2]).collect();
        let snapshot = |k: usize| Snapshot {
            layout: &layout,
            cells: &CELLS,
            positions: &frames[k],
            time: k as f64,
            values: Values::Atoms(&heights),
            arrows: &[],
            fibres: None,
            field: None,
            rest: &[],
            gone: &[],
        };
        let mut framing = Framing::new(&look);
        (0..20).for_each(|k| framing.include(&snapshot(k)));
        let mut movie = crate::picture::Movie::create(&folder.join("approach.gif"), 10.0).unwrap();
        let start = std::time::Instant::now();
        for k in 0..20 {
            let image = picture_of(&snapshot(k), &look, &framing, 960, 540);
            if k == 12 {
                image.save_png(&folder.join("approach.png")).unwrap();
            }
            movie.add(&image).unwrap();
        }
        let written = movie.finish().unwrap();
        let (shown, _) = crate::picture::movie::tests::played(&written.path);
        shown[12].save_png(&folder.join("approach_from_gif.png")).unwrap();
        println!("{:?} in {:?}, {} bytes", written, start.elapsed(), written.path.metadata().unwrap().len());
    }
}
