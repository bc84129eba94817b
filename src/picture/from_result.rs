//! Makes pictures out of what a run records: cells coloured by type or by any stored quantity, on their planes.
//!
//! [`Framing`] looks at all frames that will be drawn and fixes what must not jump between them (camera, floor, range
//! of colours); [`picture_of`] then draws any one of them.

use std::collections::HashSet;

use super::Image;
use super::colour::Colour;
use super::planes::add_planes;
use super::render::{Bounds, FieldBar, Key, Overlay, Scene, Sheet, Surface, SurfaceColour, draw, time_text};
use super::tools::add_tool;
use crate::Vec3;
use crate::output::CellType;

pub use super::framing::Framing;
pub use super::look::Look;
pub use super::snapshot::{DrawnFibre, Snapshot, Values};

/// The colour of fibres: a dark red, as stained actomyosin is often shown.
const FIBRE: Colour = Colour([0xa8, 0x1d, 0x2d]);

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
    let bar = || FieldBar {
        map: look.field_map,
        range: framing.field_ends(look),
        scale: look.field_scale,
        label: look.field_label.clone(),
    };
    let field = snapshot.field.map(|_| bar());
    Overlay { title: look.title.clone(), time, scale_bar: look.scale_bar, key, field, axes: look.axes }
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
    let shows_inside = has_links || snapshot.fibres.is_some() || snapshot.links.is_some();
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
            is_marked: snapshot.values == Values::Type && look.marked.contains(&(cell.kind as usize)),
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
        let radius = (0.002 + 0.003 * share) * typical;
        let [from, to] = shortened([*from, *to], 2.0 * radius);
        scene.add_line(from, to, radius, FIBRE);
    }
    for ([from, to], number) in snapshot.links.into_iter().flatten() {
        let share = (number / framing.most_links.max(*number)).sqrt();
        scene.add_line(*from, *to, (0.006 + 0.009 * share) * typical, dark);
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
    let (map, range, scale) = (look.field_map, framing.field_ends(look), look.field_scale);
    let coloured = |sheet: &Sheet| Sheet { map, range, scale, ..sheet.clone() };
    scene.sheet = snapshot.field.map(coloured);
    scene
}

/// A line that ends so much before its ends, at most a quarter of it: one that is thick would stand out of the skin that it ends at.
fn shortened([from, to]: [[f64; 3]; 2], by: f64) -> [[f64; 3]; 2] {
    let (a, b) = (Vec3::from(from), Vec3::from(to));
    let share = (by / (b - a).norm().max(1e-300)).min(0.25);
    [(a + share * (b - a)).into(), (b - share * (b - a)).into()]
}

/// Whether every side of a facet is one of another, which runs along it the other way.
fn is_closed(facets: &[[u32; 3]]) -> bool {
    let sides = || facets.iter().flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]]);
    let known: HashSet<[u32; 2]> = sides().collect();
    sides().all(|[from, to]| known.contains(&[to, from]))
}

fn type_colour(look: &Look, kind: usize) -> Colour {
    look.type_colours.get(kind).copied().unwrap_or_else(|| Colour::of_palette(kind))
}

#[cfg(test)]
mod tests;
