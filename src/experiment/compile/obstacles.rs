//! Planes and tools.

use super::super::{Document, ToolSurface};
use super::lathe::{corners_of, profile_fault};
use super::{course, unit, vector};
use crate::error::{Error, Fault, Result, short};
use crate::geometry::{self, Profile, Turned};
use crate::sim::{Going, Kind, Obstacle};

/// All that cells cannot pass: planes, then tools.
///
/// # Errors
/// Every profile of a tool that makes no body.
pub fn obstacles(document: &Document) -> Result<Vec<Obstacle>> {
    let experiment = &document.experiment;
    let mut obstacles: Vec<Obstacle> = (experiment.planes.iter())
        .map(|plane| Obstacle::plane(&plane.name, vector(plane.point.map(|x| x.value())), unit(plane.normal)))
        .collect();
    let mut faults = Vec::new();
    for (number, tool) in experiment.tools.iter().enumerate() {
        let point = vector(tool.point.map(|x| x.value()));
        let body = match &tool.surface {
            ToolSurface::Ball { radius } => Turned::ball(radius.value(), point),
            ToolSurface::Lathe { profile, rounding } => {
                let key = format!("tools[{number}].surface");
                let Some(corners) = corners_of(document, &key, profile, &mut faults) else { continue };
                let profile = Profile { corners: &corners, rounding: rounding.value(), around: 0 };
                match Turned::new(&profile, point, unit(tool.axis)) {
                    Ok(body) => body,
                    Err(why) => {
                        faults.push(profile_fault(document, &key, (&corners, rounding.value()), why));
                        continue;
                    }
                }
            }
        };
        let going = tool.displacement.as_ref().map(|displacement| Going {
            direction: unit(tool.direction.unwrap_or(tool.axis)),
            displacement: course(displacement.points()),
        });
        obstacles.push(Obstacle { name: tool.name.clone(), surface: geometry::Obstacle::Turned(body.into()), going });
    }
    if faults.is_empty() { Ok(obstacles) } else { Err(Error::Input(faults)) }
}

/// Refuses tools that are thinner than the edges of cells, through whose facets they would fall, eq. (planes.3).
///
/// # Errors
/// Every such tool.
pub fn check_thickness(document: &Document, kinds: &[Kind], obstacles: &[Obstacle]) -> Result<()> {
    let planes = document.experiment.planes.len();
    let Some(coarsest) = kinds.iter().max_by(|one, other| one.edge.total_cmp(&other.edge)) else { return Ok(()) };
    let tools = obstacles[planes..].iter().enumerate().filter_map(|(number, tool)| match &tool.surface {
        geometry::Obstacle::Turned(body) => Some((number, &tool.name, body.thinnest())),
        geometry::Obstacle::Plane { .. } => None,
    });
    let faults = tools.filter(|(.., thinnest)| *thinnest < coarsest.edge).map(|(number, name, thinnest)| {
        let what = match thinnest {
            0.0 => "has a sharp tip".to_owned(),
            _ => format!("is {} um from its axis where it is thinnest", short(thinnest)),
        };
        let (kind, edge) = (&coarsest.name, short(coarsest.edge));
        let message = format!("the tool `{name}` {what}, and edges of cells of type `{kind}` are {edge} um long");
        let help = "cells lie on tools by their atoms and edges, and a thinner one would fall through a facet: make the mesh finer or the tool wider; a tip is flat, with a rounded rim";
        let location = document.location(&format!("tools[{number}].surface"), "thinner than an edge");
        location.into_iter().fold(Fault::new(message).help(help), Fault::at)
    });
    let faults: Vec<Fault> = faults.collect();
    if faults.is_empty() { Ok(()) } else { Err(Error::Input(faults)) }
}
