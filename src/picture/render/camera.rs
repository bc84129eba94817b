//! Where the picture is seen from and how µm become pixels.

use crate::Vec3;

/// A camera that looks from `eye` to `target`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Camera {
    /// Where it stands, µm.
    pub eye: [f64; 3],
    /// What it looks at, µm; the scale bar holds at this depth.
    pub target: [f64; 3],
    /// Which way is up in the picture (need not be at a right angle to the view).
    pub up: [f64; 3],
    /// How depth shows.
    pub projection: Projection,
    /// How far the target lies from the picture's middle, right and up, as a share of the picture's height.
    pub shift: [f64; 2],
}

/// How depth shows.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Projection {
    /// Lengths are true everywhere, as in a micrograph: the picture shows `height` µm from bottom to top.
    Orthographic {
        /// Height of the picture, µm.
        height: f64,
    },
    /// Near things look larger: the picture spans `angle` from bottom to top.
    Perspective {
        /// Opening angle, radians.
        angle: f64,
    },
}

/// Room that stays free around the fitted scene, each as a share of the picture's height.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Insets {
    /// Left and right.
    pub sides: f64,
    /// Above.
    pub top: f64,
    /// Below.
    pub bottom: f64,
}

/// An axis-parallel box around things, µm.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bounds {
    /// Smallest coordinates.
    pub low: [f64; 3],
    /// Largest coordinates.
    pub high: [f64; 3],
}

impl Bounds {
    /// The box around all finite points; `None` when there are none.
    pub fn around<'a>(points: impl IntoIterator<Item = &'a [f64; 3]>) -> Option<Self> {
        let mut bounds = Self { low: [f64::INFINITY; 3], high: [f64::NEG_INFINITY; 3] };
        for point in points {
            if point.iter().all(|v| v.is_finite()) {
                for k in 0..3 {
                    bounds.low[k] = bounds.low[k].min(point[k]);
                    bounds.high[k] = bounds.high[k].max(point[k]);
                }
            }
        }
        (bounds.low[0] <= bounds.high[0]).then_some(bounds)
    }

    /// The box around both.
    pub fn joined(self, other: Self) -> Self {
        Self {
            low: std::array::from_fn(|k| self.low[k].min(other.low[k])),
            high: std::array::from_fn(|k| self.high[k].max(other.high[k])),
        }
    }

    /// Its middle.
    pub fn centre(&self) -> [f64; 3] {
        std::array::from_fn(|k| 0.5 * (self.low[k] + self.high[k]))
    }

    /// Its diagonal, µm.
    pub fn diagonal(&self) -> f64 {
        (Vec3::from(self.high) - Vec3::from(self.low)).norm()
    }

    /// Its eight corners.
    pub fn corners(&self) -> [[f64; 3]; 8] {
        std::array::from_fn(|n| std::array::from_fn(|k| if n >> k & 1 == 1 { self.high[k] } else { self.low[k] }))
    }
}

impl Camera {
    /// A camera that shows all points within the insets of a picture of `aspect` (width over height), looking along
    /// the opposite of `direction` (from the scene towards the camera). The height of an orthographic projection is
    /// chosen by the fit; the angle of a perspective one is kept.
    pub fn fit(points: &[[f64; 3]], direction: [f64; 3], projection: Projection, aspect: f64, insets: Insets) -> Self {
        let bounds = Bounds::around(points).unwrap_or(Bounds { low: [-1.0; 3], high: [1.0; 3] });
        let radius = (0.5 * bounds.diagonal()).max(1e-6);
        let [right, up, forward] = basis(-Vec3::from(direction), Vec3::z());
        let (half_x, half_y) =
            ((0.5 * aspect - insets.sides).max(0.05), (0.5 - 0.5 * (insets.top + insets.bottom)).max(0.05));
        let middle = 0.5 * (insets.bottom - insets.top);
        let mut target = Vec3::from(bounds.centre());
        let mut camera = Self {
            eye: (target - forward * (3.0 * radius)).into(),
            target: target.into(),
            up: up.into(),
            projection,
            shift: [0.0, middle],
        };
        // One round is exact for parallel rays; perspective changes a little with each shift of the target.
        for _ in 0..4 {
            let mut low = [f64::INFINITY; 2];
            let mut high = [f64::NEG_INFINITY; 2];
            let mut distance = 1.05 * radius;
            let focal = match projection {
                Projection::Perspective { angle } => 0.5 / (0.5 * angle.clamp(0.02, 2.5)).tan(),
                Projection::Orthographic { .. } => f64::INFINITY,
            };
            let seen = points.iter().filter(|p| p.iter().all(|v| v.is_finite()));
            let local = seen.map(|p| Vec3::from(*p) - target).map(|d| [right.dot(&d), up.dot(&d), -forward.dot(&d)]);
            let local: Vec<[f64; 3]> = local.collect();
            for [x, y, near] in &local {
                if focal.is_finite() {
                    distance = distance.max(near + focal * (x.abs() / half_x).max(y.abs() / half_y));
                }
            }
            for [x, y, near] in &local {
                let depth = if focal.is_finite() { 1.0 - near / distance } else { 1.0 };
                for (k, v) in [x / depth, y / depth].into_iter().enumerate() {
                    low[k] = low[k].min(v);
                    high[k] = high[k].max(v);
                }
            }
            if local.is_empty() {
                (low, high) = ([-radius; 2], [radius; 2]);
            }
            if let Projection::Orthographic { height } = &mut camera.projection {
                *height = (0.5 * (high[0] - low[0]) / half_x).max(0.5 * (high[1] - low[1]) / half_y).max(1e-6);
                distance = 3.0 * radius;
            }
            target += right * (0.5 * (low[0] + high[0])) + up * (0.5 * (low[1] + high[1]));
            camera.target = target.into();
            camera.eye = (target - forward * distance).into();
        }
        camera
    }

    /// Pixels that one µm takes at the target's depth in a picture of `height` pixels.
    pub fn pixels_per_micron(&self, height: usize) -> f64 {
        let distance = (Vec3::from(self.target) - Vec3::from(self.eye)).norm();
        height as f64
            / match self.projection {
                Projection::Orthographic { height } => height,
                Projection::Perspective { angle } => 2.0 * distance * (0.5 * angle).tan(),
            }
    }
}

/// Right, up and forward unit vectors of a camera; another up is taken when the camera looks along it.
fn basis(forward: Vec3, up: Vec3) -> [Vec3; 3] {
    let forward = forward.try_normalize(1e-300).unwrap_or(-Vec3::z());
    let right = forward.cross(&up).try_normalize(1e-6).unwrap_or_else(|| {
        let helper = if forward.y.abs() < 0.9 { Vec3::y() } else { Vec3::x() };
        forward.cross(&helper).normalize()
    });
    [right, right.cross(&forward), forward]
}

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

    /// The line of sight through a place in the picture: a point on it, relative to the target, and its direction,
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

/// A plane as the camera sees it: how near it is and which of its places is seen at every pixel.
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
        let place = |axis: &Vec3, start: Vec3, direction: Vec3| {
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
            u: affine(&|start, direction| place(u, start, direction)),
            v: affine(&|start, direction| place(v, start, direction)),
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
