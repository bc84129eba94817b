//! Where the picture is seen from and how µm become pixels.

use crate::Vec3;

/// A camera that looks from `eye` to `target`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Camera {
    /// Where it stands, µm.
    pub eye: [f64; 3],
    /// What it looks at, µm; the scale bar holds at this depth.
    pub target: [f64; 3],
    /// Which direction is up in the picture (need not be at a right angle to the view).
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

/// Margins that stay free around the fitted scene, each as a share of the picture's height.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Insets {
    /// Left and right.
    pub sides: f64,
    /// On the right besides.
    pub right: f64,
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
    /// the opposite of `direction` (from the scene towards the camera) with `up` upwards. The height of an orthographic
    /// projection is chosen by the fit; the angle of a perspective one is kept.
    pub fn fit(
        points: &[[f64; 3]],
        direction: [f64; 3],
        up: [f64; 3],
        projection: Projection,
        aspect: f64,
        insets: Insets,
    ) -> Self {
        let bounds = Bounds::around(points).unwrap_or(Bounds { low: [-1.0; 3], high: [1.0; 3] });
        let radius = (0.5 * bounds.diagonal()).max(1e-6);
        let [right, up, forward] = basis(-Vec3::from(direction), Vec3::from(up));
        let (half_x, half_y) = (
            (0.5 * aspect - insets.sides - 0.5 * insets.right).max(0.05),
            (0.5 - 0.5 * (insets.top + insets.bottom)).max(0.05),
        );
        let middle = 0.5 * (insets.bottom - insets.top);
        let mut target = Vec3::from(bounds.centre());
        let mut camera = Self {
            eye: (target - forward * (3.0 * radius)).into(),
            target: target.into(),
            up: up.into(),
            projection,
            shift: [-0.5 * insets.right, middle],
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

    /// The same camera with everything larger by a factor, about its target.
    pub fn zoomed(mut self, factor: f64) -> Self {
        match &mut self.projection {
            Projection::Orthographic { height } => *height /= factor,
            Projection::Perspective { angle } => *angle = 2.0 * ((0.5 * *angle).tan() / factor).atan(),
        }
        self
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
pub(in crate::picture) fn basis(forward: Vec3, up: Vec3) -> [Vec3; 3] {
    let forward = forward.try_normalize(1e-300).unwrap_or(-Vec3::z());
    let right = forward.cross(&up).try_normalize(1e-6).unwrap_or_else(|| {
        let helper = if forward.y.abs() < 0.9 { Vec3::y() } else { Vec3::x() };
        forward.cross(&helper).normalize()
    });
    [right, right.cross(&forward), forward]
}
