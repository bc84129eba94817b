//! How large a step an explicit scheme bears.
//!
//! A scheme applied to `m ẍ = −k_a ẋ − λ x` maps (x, v) linearly to the next step; it is stable where that map's
//! spectral radius does not exceed one, for every stiffness λ from the smallest to the largest of the body,
//! eq. (stability.1). Over-damped explicit Euler is stable for `dt ≤ 2 ζ/λ`, eq. (stability.2).

use super::integrator::Method;

/// One atom's inertia and drag and the stiffest direction of its body.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Body {
    /// Mass of an atom, pN·s²/µm.
    pub mass: f64,
    /// Drag of an atom, pN·s/µm.
    pub drag: f64,
    /// Largest eigenvalue of the stiffness, pN/µm.
    pub largest_stiffness: f64,
}

/// Growth allowed to a step map by round-off.
const ROUND_OFF: f64 = 1e-9;

/// The largest modulus of the eigenvalues of the map of one step of size `dt` for one stiffness.
pub fn spectral_radius(method: Method, dt: f64, mass: f64, drag: f64, stiffness: f64) -> f64 {
    if let Method::Explicit = method {
        return (1.0 - dt * stiffness / drag).abs();
    }
    let (w, c) = (stiffness / mass, drag / mass);
    let [[a, b], [d, e]] = match method {
        Method::Implicit { .. } | Method::Explicit => return 0.0,
        Method::Euler => [[1.0, dt], [-dt * w, 1.0 - dt * c]],
        Method::SemiImplicitEuler => [[1.0 - dt * dt * w, dt * (1.0 - dt * c)], [-dt * w, 1.0 - dt * c]],
        Method::Verlet => verlet_map(dt, w, c),
        Method::RungeKutta4 => runge_kutta_map(dt, w, c),
    };
    let (trace, determinant) = (a + e, a * e - b * d);
    let discriminant = 0.25 * trace * trace - determinant;
    if discriminant >= 0.0 { 0.5 * trace.abs() + discriminant.sqrt() } else { determinant.abs().sqrt() }
}

fn verlet_map(dt: f64, w: f64, c: f64) -> [[f64; 2]; 2] {
    let (kick, slow) = (0.5 * dt * w, 1.0 / (1.0 + 0.5 * dt * c));
    // v½ = (v − kick·x)·slow ; x' = x + dt·v½ ; v' = v½ (1 − dt c/2) − kick·x'
    let (hx, hv) = (-kick * slow, slow);
    let (xx, xv) = (1.0 + dt * hx, dt * hv);
    let keep = 1.0 - 0.5 * dt * c;
    [[xx, xv], [keep * hx - kick * xx, keep * hv - kick * xv]]
}

fn runge_kutta_map(dt: f64, w: f64, c: f64) -> [[f64; 2]; 2] {
    let step = nalgebra::Matrix2::new(0.0, dt, -dt * w, -dt * c);
    let square = step * step;
    let map = nalgebra::Matrix2::identity() + step + square / 2.0 + square * step / 6.0 + square * square / 24.0;
    [[map[(0, 0)], map[(0, 1)]], [map[(1, 0)], map[(1, 1)]]]
}

/// Whether a step is stable for all stiffnesses from zero to the body's largest, eq. (stability.1).
pub fn is_stable(method: Method, dt: f64, body: &Body) -> bool {
    // Radii are monotone between a few samples; 64 of them find every window of instability of these schemes.
    (0..=64).all(|i| {
        let stiffness = body.largest_stiffness * f64::from(i) / 64.0;
        spectral_radius(method, dt, body.mass, body.drag, stiffness) <= 1.0 + ROUND_OFF
    })
}

/// The largest stable step of a scheme, s; infinite for the implicit ones and for a body without stiffness or drag.
pub fn largest_stable_step(method: Method, body: &Body) -> f64 {
    if matches!(method, Method::Implicit { .. }) {
        return f64::INFINITY;
    }
    let Body { mass, drag, largest_stiffness: k } = *body;
    let mut high = match method {
        Method::Explicit if k > 0.0 => return 2.0 * drag / k,
        Method::Explicit => return f64::INFINITY,
        _ if k > 0.0 => 4.0 * (mass / k).sqrt(),
        _ if drag > 0.0 => 4.0 * mass / drag,
        _ => return f64::INFINITY,
    };
    if drag > 0.0 {
        high = high.min(4.0 * mass / drag);
    }
    let mut low = 0.0;
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if is_stable(method, middle, body) { low = middle } else { high = middle }
    }
    low
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn limits_agree_with_their_closed_forms() {
        let body = |mass, drag, k| Body { mass, drag, largest_stiffness: k };
        let close = |a: f64, b: f64| assert!((a / b - 1.0).abs() < 1e-6, "{a} {b}"); // bisection and round-off allowance
        close(largest_stable_step(Method::Explicit, &body(0.0, 3.0, 2.0)), 3.0);
        // Undamped: 2/ω for the symplectic schemes, 2√2/ω for Runge–Kutta 4.
        close(largest_stable_step(Method::Verlet, &body(4.0, 0.0, 1.0)), 4.0);
        close(largest_stable_step(Method::SemiImplicitEuler, &body(4.0, 0.0, 1.0)), 4.0);
        assert!((largest_stable_step(Method::RungeKutta4, &body(1.0, 0.0, 1.0)) / 8f64.sqrt() - 1.0).abs() < 1e-3);
        // Explicit Euler: k_a/k where that is the smaller limit.
        close(largest_stable_step(Method::Euler, &body(1.0, 0.5, 1.0)), 0.5);
    }
}
