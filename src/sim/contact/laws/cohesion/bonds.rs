//! The kinetics of the bonds that hold surfaces together: how fast they close, and how fast they open under load.

/// How bonds between two surfaces close and open, eq. (adhesion.22).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BondKinetics {
    /// The most bonds that an area of contact can have, 1/µm².
    pub density: f64,
    /// Rate at which each of those that are open closes, 1/s.
    pub on: f64,
    /// The pathway along which load opens bonds sooner.
    pub slip: Pathway,
    /// The pathway that load shuts.
    pub catch: Pathway,
    /// The share of bonds that is closed in contacts that are there when a run begins.
    pub start: f64,
}

/// A pathway along which bonds open.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pathway {
    /// Rate at which bonds without load open, 1/s.
    pub off: f64,
    /// Load of a bond that changes the rate by a factor of e, pN.
    pub force: f64,
}

impl Pathway {
    /// No bond opens along it.
    pub const NONE: Self = Self { off: 0.0, force: f64::INFINITY };
}

/// The largest exponent of a rate: such bonds open at once in any step.
const MOST_EXPONENT: f64 = 50.0;

impl BondKinetics {
    /// Rate at which bonds open that each bear a load (pN), 1/s, eq. (adhesion.24).
    pub fn off(&self, load: f64) -> f64 {
        let Self { slip, catch, .. } = self;
        slip.off * (load / slip.force).min(MOST_EXPONENT).exp() + catch.off * (-load / catch.force).exp()
    }

    /// The share of bonds that is closed after a time (s) under a load of each (pN), of the share before, eq. (adhesion.25).
    pub fn after(&self, closed: f64, load: f64, dt: f64) -> f64 {
        let off = self.off(load);
        let rate = self.on + off;
        // How long the bonds would take for the same change at the speed of the begin, s.
        let time = if rate > 0.0 { -(-rate * dt).exp_m1() / rate } else { 0.0 };
        (closed + (self.on * (1.0 - closed) - off * closed) * time).clamp(0.0, 1.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SLIP: BondKinetics = BondKinetics {
        density: 100.0,
        on: 0.7,
        slip: Pathway { off: 0.2, force: 4.0 },
        catch: Pathway::NONE,
        start: 0.0,
    };
    const CATCH: BondKinetics = BondKinetics {
        slip: Pathway { off: 0.05, force: 6.0 },
        catch: Pathway { off: 20.0, force: 3.0 },
        on: 0.0,
        ..SLIP
    };

    #[test]
    fn the_share_of_closed_bonds_follows_the_exponential_in_steps_of_any_length_to_its_steady_state() {
        for (bonds, load) in [(SLIP, 0.0), (SLIP, 3.0), (SLIP, 11.0), (CATCH, 5.0)] {
            let rate = bonds.on + bonds.off(load);
            let end = bonds.on / rate;
            for (start, steps) in [(0.0, 1), (0.0, 7), (1.0, 1000), (0.3, 13)] {
                let time = 3.0;
                let closed = (0..steps).fold(start, |closed, _| bonds.after(closed, load, time / f64::from(steps)));
                let exact = end + (start - end) * (-rate * time).exp();
                // A thousand roundings of numbers up to 1.
                assert!((closed - exact).abs() < 1e-13, "{load} pN, {steps} steps: {closed} for {exact}");
            }
            assert!((bonds.after(0.9, load, 1e6) - end).abs() < 1e-15);
        }
    }

    #[test]
    fn bonds_that_neither_close_nor_open_stay_as_they_are_to_the_last_bit() {
        let still = BondKinetics { on: 0.0, slip: Pathway { off: 0.0, force: 1.0 }, ..SLIP };
        for closed in [0.0, 0.1, 1.0 / 3.0, 1.0] {
            assert_eq!(still.after(closed, 5.0, 17.0), closed);
        }
    }

    #[test]
    fn no_load_however_large_makes_a_rate_or_a_share_that_is_no_number() {
        for load in [1e3, 1e6, f64::MAX] {
            for bonds in [SLIP, CATCH] {
                let closed = bonds.after(1.0, load, 1e-3);
                assert!(bonds.off(load).is_finite() && (0.0..1e-9).contains(&closed), "{load}: {closed}");
            }
        }
    }

    /// The load at which most bonds open for each unit of it, of bonds whose load grows at a rate (pN/s), pN, and the mean load at which they
    /// open. Bonds are followed in small steps.
    fn most_open_at(bonds: &BondKinetics, rate: f64) -> (f64, f64) {
        let step = 1e-3 * bonds.slip.force;
        let (mut closed, mut best, mut mean) = (1.0, (0.0, 0.0), 0.0);
        for number in 0..40_000 {
            let load = (f64::from(number) + 0.5) * step;
            let left = bonds.after(closed, load, step / rate);
            if closed - left > best.0 {
                best = (closed - left, load);
            }
            mean += (closed - left) * load;
            closed = left;
        }
        (best.1, mean)
    }

    #[test]
    fn bonds_under_a_growing_load_break_where_bell_and_evans_say() {
        let bonds = BondKinetics { on: 0.0, ..SLIP };
        for rate in [10.0, 100.0, 1000.0, 10_000.0] {
            let Pathway { off, force } = bonds.slip;
            let theory = force * (rate / (off * force)).ln();
            let (found, _) = most_open_at(&bonds, rate);
            // Loads are told apart by a thousandth of the force, and the top is flat.
            assert!((found - theory).abs() < 0.005 * force, "{rate} pN/s: {found} for {theory} pN");
        }
    }

    #[test]
    fn catch_bonds_live_longest_at_the_load_of_two_pathways_and_slip_bonds_ever_shorter() {
        let life = |bonds: &BondKinetics, load: f64| {
            // The mean time to open, by the share that is closed at each time.
            let dt = 1e-3 / bonds.off(load);
            let mut closed = 1.0;
            let mut sum = 0.0;
            for _ in 0..40_000 {
                let next = bonds.after(closed, load, dt);
                sum += 0.5 * (closed + next) * dt;
                closed = next;
            }
            sum
        };
        let loads: Vec<f64> = (0..300).map(|number| 0.1 * f64::from(number)).collect();
        let lives: Vec<f64> = loads.iter().map(|load| life(&CATCH, *load)).collect();
        let longest = (0..300).max_by(|one, other| lives[*one].total_cmp(&lives[*other])).unwrap();
        let Pathway { off, force } = CATCH.catch;
        let theory = force * CATCH.slip.force / (force + CATCH.slip.force)
            * (off * CATCH.slip.force / (CATCH.slip.off * force)).ln();
        assert!((loads[longest] - theory).abs() <= 0.05, "{} for {theory} pN", loads[longest]);
        assert!(lives[..=longest].is_sorted() && lives[longest..].is_sorted_by(|one, next| one >= next));
        let of_slip: Vec<f64> = loads.iter().map(|load| life(&SLIP, *load)).collect();
        assert!(of_slip.is_sorted_by(|one, next| one > next));
    }
}
