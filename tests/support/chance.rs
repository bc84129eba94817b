//! Random numbers of tests: what one number stands for is the same on every machine and each time.

use pseudopod::random::philox;

/// A stream of random numbers.
pub struct Chance {
    key: [u32; 2],
    drawn: u32,
}

impl Chance {
    /// The stream of a number, one for each purpose.
    pub fn new(number: u32, purpose: u32) -> Self {
        Self { key: [number, purpose], drawn: 0 }
    }

    fn bits(&mut self) -> u32 {
        self.drawn += 1;
        philox([self.drawn, 0, 0, 0], self.key)[0]
    }

    /// A whole number below another; 0 below 0.
    pub fn below(&mut self, most: usize) -> usize {
        self.bits() as usize % most.max(1)
    }

    /// A number from 0 up to 1.
    pub fn share(&mut self) -> f64 {
        f64::from(self.bits()) / 4_294_967_296.0
    }
}
