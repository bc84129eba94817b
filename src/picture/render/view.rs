//! A camera at work on one picture: where points and planes appear.

use super::camera::{Camera, Projection, basis};
use crate::Vec3;

/// A camera made ready for a picture of a certain size. Positions are taken relative to the target.
pub(super) struct View {
    pub height: usize,
    pub target: Vec3,
    pub right: Vec3,
    pub up: Vec3,
    pub forward: Vec3,
    /// From eye to target, µm.
    distance: f64,
    /// Pixels per µm (orthographic), or pixels per unit slope (perspective).
    scale: f64,
    pub is_perspective: bool,
    /// Pixel of the target.
    centre: [f64; 2],
}

impl View {
    pub fn new(camera: &Camera, width: usize, height: usize) -> Self {
        let (eye, target) = (Vec3::from(camera.eye), Vec3::from(camera.target));
        let [right, up, forward] = basis(target - eye, Vec3::from(camera.up));
        let pixels = height as f64;
        let (scale, is_perspective) = match camera.projection {
            Projection::Orthographic { height } => (pixels / height, false),
            Projection::Perspective { angle } => (0.5 * pixels / (0.5 * angle).tan(), true),
        };
        let centre = [0.5 * width as f64 + camera.shift[0] * pixels, 0.5 * pixels - camera.shift[1] * pixels];
        let distance = (target - eye).norm();
        Self { height, target, right, up, forward, distance, scale, is_perspective, centre }
    }

    /// The pixel of a point relative to the target, a nearness that changes linearly across the picture and grows
    /// towards the camera, and the weight that makes interpolation true to perspective. `None` behind the camera.
    pub fn project(&self, point: &Vec3) -> Option<([f32; 3], f32)> {
        let (x, y, z) = (self.right.dot(point), self.up.dot(point), self.forward.dot(point) + self.distance);
        if !self.is_perspective {
            let at = [self.centre[0] + x * self.scale, self.centre[1] - y * self.scale, -self.forward.dot(point)];
            return Some((at.map(|v| v as f32), 1.0));
        }
        if z.is_nan() || z <= 1e-3 * self.distance {
            return None;
        }
        let at = [self.centre[0] + x * self.scale / z, self.centre[1] - y * self.scale / z, self.distance / z];
        Some((at.map(|v| v as f32), (self.distance / z) as f32))
    }

    /// Pixels that one µm takes at a point relative to the target; none behind the camera.
    pub fn pixels_per_micron(&self, point: &Vec3) -> f64 {
        let depth = self.forward.dot(point) + self.distance;
        match self.is_perspective {
            true if depth > 1e-3 * self.distance => self.scale / depth,
            true => 0.0,
            false => self.scale,
        }
    }

    /// The nearness of a point, µm; `None` behind the camera.
    pub fn nearness(&self, point: [f64; 3]) -> Option<f32> {
        self.project(&(Vec3::from(point) - self.target)).map(|([_, _, near], _)| near)
    }

    /// The line of sight through a point in the picture: a point on it, relative to the target, and its direction,
    /// which has length 1 along the camera's axis.
    fn ray(&self, x: f64, y: f64) -> (Vec3, Vec3) {
        let (a, b) = ((x - self.centre[0]) / self.scale, (self.centre[1] - y) / self.scale);
        if self.is_perspective {
            (-self.forward * self.distance, self.forward + self.right * a + self.up * b)
        } else {
            (self.right * a + self.up * b - self.forward * self.distance, self.forward)
        }
    }

    /// Whether the camera sees the side of a plane that its normal points to.
    pub fn is_above(&self, point: &Vec3, normal: &Vec3) -> bool {
        if self.is_perspective {
            normal.dot(&(-self.forward * self.distance - point)) > 1e-9 * self.distance
        } else {
            normal.dot(&self.forward) < -1e-9
        }
    }

    /// Unit vector from a point (relative to the target) towards the viewer.
    pub fn towards_viewer(&self, point: &nalgebra::Vector3<f32>) -> nalgebra::Vector3<f32> {
        if self.is_perspective {
            (-self.forward * self.distance).cast::<f32>() - point
        } else {
            -self.forward.cast::<f32>()
        }
        .normalize()
    }
}

/// A plane as the camera sees it: how near it is and which of its points is seen at every pixel.
///
/// With x and y in pixels, nearness is an affine function of them and the plane's own coordinates are quotients of
/// affine functions; each is kept as three factors, for x, y and 1.
pub(super) struct PlaneOnScreen {
    nearness: [f64; 3],
    u: [f64; 3],
    v: [f64; 3],
    w: [f64; 3],
}

impl PlaneOnScreen {
    /// A plane through `point` (relative to the target) with unit vectors `u` and `v` in it.
    pub fn new(view: &View, point: &Vec3, u: &Vec3, v: &Vec3) -> Self {
        let normal = u.cross(v);
        let affine = |value: &dyn Fn(Vec3, Vec3) -> f64| {
            let at = |x: f64, y: f64| {
                let (start, direction) = view.ray(x, y);
                value(start, direction)
            };
            let origin = at(0.0, 0.0);
            // A long base keeps digits that neighbouring pixels would lose.
            [(at(1e3, 0.0) - origin) * 1e-3, (at(0.0, 1e3) - origin) * 1e-3, origin]
        };
        // A line of sight meets the plane `height / fall` along itself; multiplied by `fall` everything is affine.
        let height = |start: Vec3| normal.dot(&(point - start));
        let fall = |direction: Vec3| normal.dot(&direction);
        let coordinate = |axis: &Vec3, start: Vec3, direction: Vec3| {
            axis.dot(&(start - point)) * fall(direction) + axis.dot(&direction) * height(start)
        };
        Self {
            nearness: affine(&|start, direction| {
                if view.is_perspective {
                    view.distance * fall(direction) / height(start)
                } else {
                    view.distance - height(start) / fall(direction)
                }
            }),
            u: affine(&|start, direction| coordinate(u, start, direction)),
            v: affine(&|start, direction| coordinate(v, start, direction)),
            w: affine(&|_, direction| fall(direction)),
        }
    }

    /// Nearness, as [`View::project`] has it, along a row: how much it grows a pixel, and its value at x = 0.
    pub fn nearness_along_row(&self, y: f64) -> [f64; 2] {
        [self.nearness[0], self.nearness[1] * y + self.nearness[2]]
    }

    /// The plane's own coordinates (µm from its point) at a pixel, and how far a pixel reaches along each.
    pub fn meet(&self, x: f64, y: f64) -> ([f64; 2], [f64; 2]) {
        let value = |factors: &[f64; 3]| factors[0] * x + factors[1] * y + factors[2];
        let inverse = 1.0 / value(&self.w);
        let (mut at, mut pixel) = ([0.0; 2], [0.0; 2]);
        for (k, axis) in [&self.u, &self.v].into_iter().enumerate() {
            at[k] = value(axis) * inverse;
            let slope = |n: usize| (axis[n] - at[k] * self.w[n]) * inverse;
            pixel[k] = (slope(0) * slope(0) + slope(1) * slope(1)).sqrt();
        }
        (at, pixel)
    }
}
