//! Builds the surface of a type of cells.

use super::super::{CellType, Document, Mesh, VolumeRule};
use super::builder::{Built, Inside};
use super::far;
use super::lathe;
use super::model::{self, is_model};
use super::numbers::unit;
use crate::Vec3;
use crate::error::{Error, Fault};
use crate::geometry::solid::{self, Grading, Solid};
use crate::geometry::{self, SolidFault, Surface, SurfaceRules};
use nalgebra::{Unit, UnitQuaternion};

/// A fault at a key of the mesh.
fn refused(document: &Document, key: &str, label: &str, message: String, help: &str) -> Fault {
    document.location(key, label).into_iter().fold(Fault::new(message).help(help), Fault::at)
}

/// The surface of a type, or nothing and a fault.
pub fn surface(document: &Document, name: &str, cell: &CellType, faults: &mut Vec<Fault>) -> Option<Built> {
    let (mut from_model, mut inside) = (None, None);
    let mut filled = |solid: Solid| {
        let Solid { surface, tetrahedra, cells, edges } = solid;
        inside = Some(Inside { tetrahedra, cells, edges });
        surface
    };
    let mut plain = match &cell.mesh {
        Mesh::RedCell { diameter, level } => geometry::red_cell(diameter.value(), u32::from(*level)),
        Mesh::Icosphere { radius, level, finest } => {
            let mut sphere = geometry::icosphere(radius.value(), u32::from(*level));
            if let Some(finest) = finest {
                let at = Vec3::from(finest.at.map(|x| x.value()));
                if at.norm() == 0.0 {
                    let message = format!("the facets of `cells.{name}.mesh` cannot be finest at its centre");
                    let help = "give a point of its surface, from its centre: the nearest is meant";
                    let key = format!("cells.{name}.mesh.finest.at");
                    faults.push(refused(document, &key, "the centre of the sphere", message, help));
                    return None;
                }
                if finest.even.value() > 0.0 {
                    let message = format!("the facets of `cells.{name}.mesh` grow from one point of the sphere on");
                    let key = format!("cells.{name}.mesh.finest.even");
                    faults.push(refused(document, &key, "for blocks", message, "leave it out"));
                    return None;
                }
                geometry::grade_sphere(&mut sphere.positions, &at, finest.ratio);
            }
            sphere
        }
        Mesh::Octasphere { radius, divisions } => geometry::octasphere(radius.value(), *divisions),
        Mesh::Box { size, divisions } => geometry::box_surface(size.map(|x| x.value()), *divisions),
        Mesh::Sheet { size, divisions } => {
            geometry::sheet(size[0].value(), size[1].value(), divisions[0], divisions[1])
        }
        Mesh::Triangle { side } => triangle(side.value()),
        Mesh::Lathe { profile, rounding, around } => {
            lathe::surface(document, &format!("cells.{name}.mesh"), (profile, *rounding, *around), faults)?
        }
        Mesh::Block { size, divisions, finest } => {
            let size = size.map(|x| x.value());
            let at = finest.map_or([0.0; 3], |finest| finest.at.map(|x| x.value()));
            let grading = finest.map_or(Grading { ratio: 1.0, even: 0.0 }, |finest| Grading {
                ratio: finest.ratio,
                even: finest.even.value(),
            });
            if (0..3).any(|axis| at[axis].abs() > 0.5 * size[axis]) {
                let message = format!("the parts of `cells.{name}.mesh` are finest at a point that is not within it");
                let help = "give a point within the block: it is centred on [0, 0, 0] and reaches half of its size to both sides";
                faults.push(refused(
                    document,
                    &format!("cells.{name}.mesh.finest.at"),
                    "not in the block",
                    message,
                    help,
                ));
                return None;
            }
            let made = solid::graded_block(size, *divisions, at, grading);
            filled(sound(document, name, made, faults)?)
        }
        Mesh::Rod { radius, length, middle, rings, layers } => {
            let radii = [radius.value(), middle.unwrap_or(*radius).value()];
            if (radii[1] - radii[0]).abs() > 0.5 * length.value() {
                let wide = middle.unwrap_or(*radius);
                let message = format!("no arc of a circle goes from {radius} at the ends to {wide} in the middle");
                let help = "let it be at most half of the length away from the radius, or take a longer rod";
                faults.push(refused(
                    document,
                    &format!("cells.{name}.mesh.middle"),
                    "too far from the radius",
                    message,
                    help,
                ));
                return None;
            }
            let made = solid::rod(radii, length.value(), *rings, *layers);
            filled(sound(document, name, made, faults)?)
        }
        Mesh::File { path, unit, component, filled: is_filled } => {
            let free = cell.mechanics.volume.rule == Some(VolumeRule::Free);
            let rules = if free { &SurfaceRules::SHEET } else { &SurfaceRules::CELL };
            let key = format!("cells.{name}.mesh");
            let file = document.resolve(path);
            let of_models =
                [("component", component.is_some(), "components"), ("filled", *is_filled, "cells that fill a body")];
            if let Some((own, _, what)) = of_models.into_iter().find(|(_, there, _)| *there).filter(|_| !is_model(path))
            {
                let message = format!("`{key}.{own}` has no meaning for `{}`", path.display());
                let help = format!("only PML files, which end in .pml, have {what}: leave it out");
                faults.push(refused(document, &format!("{key}.{own}"), "not of this file", message, &help));
                return None;
            }
            let told = document.says(&format!("{key}.unit")).then_some(*unit);
            let outcome = if *is_filled {
                model::solid(&file, told, component.as_ref()).map(|(solid, read)| {
                    from_model = Some(read);
                    filled(solid)
                })
            } else if is_model(path) {
                model::surface(&file, told, component.as_ref(), rules).map(|(surface, read)| {
                    from_model = Some(read);
                    surface
                })
            } else {
                geometry::read_checked_surface(&file, unit.micrometres(), rules)
            };
            match outcome {
                Ok(surface) => surface,
                Err(Error::Input(found)) => {
                    let key = format!("{key}.path");
                    let located = |fault: Fault| match (&fault.location, document.location(&key, "this file")) {
                        (None, Some(location)) => fault.at(location),
                        _ => fault,
                    };
                    faults.extend(found.into_iter().map(located));
                    return None;
                }
                Err(other) => {
                    faults.push(Fault::new(other.to_string()));
                    return None;
                }
            }
        }
    };
    if let Some(stretch) = cell.stretch {
        plain.positions.iter_mut().for_each(|x| x.component_mul_assign(&Vec3::from(stretch)));
    }
    let before = faults.len();
    far::check_width(document, &format!("cells.{name}"), &cell.mesh, &plain, faults);
    if faults.len() > before {
        return None;
    }
    let mut turned = plain.clone();
    if let Some(orientation) = &cell.orientation {
        let axis = Unit::new_unchecked(unit(orientation.axis));
        geometry::rotate(&mut turned, &UnitQuaternion::from_axis_angle(&axis, orientation.angle.value()));
    }
    Some(Built { plain, turned, inside, model: from_model })
}

/// A body that was made, or nothing and the first of its faults.
fn sound(
    document: &Document,
    name: &str,
    made: Result<Solid, Vec<SolidFault>>,
    faults: &mut Vec<Fault>,
) -> Option<Solid> {
    made.map_err(|found| {
        let fault = Fault::new(format!("the body of `cells.{name}`: {}", found[0]))
            .help("let its parts be about as long along all axes: divide more along the longer ones");
        let location = document.location(&format!("cells.{name}.mesh"), "makes flat tetrahedra");
        faults.push(location.into_iter().fold(fault, Fault::at));
    })
    .ok()
}

/// One equilateral facet in the plane z = 0: atoms 0 and 1 on its base, atom 2 above it along y.
fn triangle(side: f64) -> Surface {
    let height = side * 0.75f64.sqrt();
    let positions =
        vec![Vec3::new(-0.5 * side, 0.0, 0.0), Vec3::new(0.5 * side, 0.0, 0.0), Vec3::new(0.0, height, 0.0)];
    Surface { positions, facets: vec![[0, 1, 2]] }
}
