//! The planes of a result in its pictures: a floor and panes of glass.

use super::colour::Colour;
use super::render::{Bounds, Floor, Pane, Scene};
use super::ticks::nice_above;
use crate::Vec3;
use crate::output::{Layout, Obstacle};

/// The plane that looks up most becomes the floor, the others panes around the cells.
pub(super) fn add_planes(scene: &mut Scene, layout: &Layout, bounds: &Bounds, typical: f64) {
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
pub(super) fn corners(pane: &Pane) -> [[f64; 3]; 4] {
    let (centre, u, v) = (Vec3::from(pane.centre), Vec3::from(pane.half_u), Vec3::from(pane.half_v));
    [centre + u + v, centre + u - v, centre - u + v, centre - u - v].map(Into::into)
}
