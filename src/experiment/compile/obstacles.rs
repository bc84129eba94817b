//! Planes and tools.

use super::super::{Document, ToolSurface};
use super::lathe::{corners_of, profile_fault};
use super::{course, unit, vector};
use crate::error::{Error, Result};
use crate::geometry::{self, Profile, Turned};
use crate::sim::{Going, Obstacle};

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
