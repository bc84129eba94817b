//! Systems that release into fields, followed through a step: at which rates they do so meanwhile.

use super::super::model::Model;
use super::super::state::State;
use super::super::trouble::Trouble;
use super::super::workspace::Workspace;
use super::advance::advance_system;
use super::carry::carry_releases;
use super::correct::tell_means;
use super::links::{Control, Link, Owner, Target};
use super::released::{Cut, Released};
use super::scratch::ChemistryScratch;

/// By how much parabolas may bend away from lines: what lines in their stead would leave out of the amount that all cells release of a substance
/// in a step, over that amount. Where rates are smooth parabolas leave out far less. Where a rate jumps at a share x of a piece, up to a half, they are
/// off by x - 1/6 of what it jumps, and lines differ from them by 1/3: never by less.
const BENT: f64 = 0.01;

/// A step is cut into so many pieces at most; twice as many from one attempt to the next.
const MOST: u32 = 32;

/// What parabolas over all of the time between two switches may leave out where they stand in the stead of shorter ones, over the amount.
const COARSER: f64 = 5e-3;

/// So many steps of its own a system makes in half a piece at most, in the mean over the cells: it may turn as often.
const OWN_STEPS: f64 = 4.0;

/// Whether the systems of a link are followed: what they let cells release they know themselves, all the time, and go on by the same course
/// whatever instants of it are looked at.
fn is_followed(model: &Model, link: &Link) -> bool {
    let Owner::Reactor(owner) = link.owner else { return false };
    let of_cells = matches!(link.to, Target::Cell(_, Control::Secretion(_)));
    of_cells && link.is_own_release() && may_be_followed(model, owner)
}

fn may_be_followed(model: &Model, reactor: usize) -> bool {
    let reactor = &model.chemistry.reactors[reactor];
    reactor.exchange.is_none() && reactor.membrane.is_none() && reactor.noise.is_none()
}

/// Whether a system is moved through a step with [`follow`].
pub fn is_releasing(model: &Model, reactor: usize) -> bool {
    if !model.chemistry.reactors[reactor].is_moved_alone() {
        return false;
    }
    let owns = |link: &Link| matches!(link.owner, Owner::Reactor(owner) if owner == reactor);
    model.chemistry.links.iter().any(|link| owns(link) && is_followed(model, link))
}

/// Moves the systems that release by themselves through a step, all others having been moved, and finds the rates meanwhile.
///
/// # Errors
/// A system that fails, or a rate that cannot be.
pub fn follow(
    model: &Model,
    (start, dt): (f64, f64),
    from: &State,
    to: &mut State,
    ws: &mut Workspace,
) -> Result<(), Trouble> {
    let scratch = &mut ws.chemistry;
    let released = std::mem::take(&mut scratch.released);
    let mut step = Followed { model, start, dt, from, to, scratch, released };
    let done = step.find();
    let released = step.released;
    ws.chemistry.released = released;
    done
}

/// A step whose systems are followed.
struct Followed<'a> {
    model: &'a Model,
    start: f64,
    dt: f64,
    from: &'a State,
    to: &'a mut State,
    scratch: &'a mut ChemistryScratch,
    released: Released,
}

impl<'a> Followed<'a> {
    /// The numbers of the systems that are followed.
    fn systems(&self) -> impl Iterator<Item = usize> + use<'a> {
        let model = self.model;
        (0..model.chemistry.reactors.len()).filter(move |reactor| is_releasing(model, *reactor))
    }

    /// The rates of all cells where the step begins.
    fn at_begin(&self) -> impl Iterator<Item = &'a f64> + Clone + use<'a> {
        self.from.chemistry.controls.secretion.iter().flatten()
    }

    /// How many lists of rates there are.
    fn channels(&self) -> usize {
        self.from.chemistry.controls.secretion.len()
    }

    fn find(&mut self) -> Result<(), Trouble> {
        let model = self.model;
        carry_releases(model, self.start + self.dt, self.to, self.scratch, |link| !is_followed(model, link))?;
        let released = &mut self.released;
        released.at_end.clear();
        released.at_end.extend(self.to.chemistry.controls.secretion.iter().flatten());
        released.width = released.at_end.len();
        if self.systems().next().is_none() {
            let begin = self.at_begin();
            self.released.set_line(begin);
            return Ok(());
        }
        self.find_switches();
        let mut pieces = 1;
        loop {
            self.released.cut((self.start, self.dt), pieces);
            let own_steps = self.go()?;
            let wanted = (0.5 * own_steps / OWN_STEPS).ceil().min(f64::from(MOST)) as u32;
            if pieces >= MOST || (pieces >= wanted && self.released.bent(self.channels()) <= BENT) {
                break;
            }
            pieces = wanted.max(2 * pieces).min(MOST);
        }
        if pieces > 1 && self.released.misses_as_one(self.channels()) <= COARSER {
            self.released.join();
        }
        let lists = self.to.chemistry.controls.secretion.iter_mut().flatten();
        lists.zip(&self.released.at_end).for_each(|(now, end)| *now = if now.is_nan() { *end } else { *now });
        Ok(())
    }

    /// When the clock switches something in the systems; nothing where that is too often.
    fn find_switches(&mut self) {
        let (start, end) = (self.start, self.start + self.dt);
        let systems = self.systems();
        let Released { switches, last_look, .. } = &mut self.released;
        switches.clear();
        *last_look = end;
        for number in systems {
            let reactor = &self.model.chemistry.reactors[number];
            let (seconds, mut before) = (reactor.seconds, [start; 2]);
            let window = (start / seconds, end / seconds);
            self.scratch.populations[number].each_piece(&reactor.program, window, |piece| {
                if piece.begin > window.0 && piece.begin * seconds < end && switches.len() <= MOST as usize {
                    switches.push([before[0], before[1], piece.begin * seconds]);
                }
                before = [piece.end * seconds, piece.until * seconds];
            });
            *last_look = last_look.min(before[0]);
        }
        if switches.len() > MOST as usize {
            switches.clear();
        }
        switches.sort_by(|a, b| a[1].total_cmp(&b[1]));
        // The same one of two systems, but for its last bits.
        switches.dedup_by(|b, a| b[0] <= a[2]);
    }

    /// Moves the systems from where they were through the step and notes the rates. Returns how many steps of its own a system made, in the mean
    /// over its cells: that of which it is most.
    fn go(&mut self) -> Result<f64, Trouble> {
        for number in self.systems() {
            self.to.chemistry.take_system(&self.from.chemistry, number);
            self.scratch.own_steps[number] = 0;
        }
        if self.to.chemistry.told_means {
            // They begin with what they are told in this step.
            let Self { model, scratch, to, .. } = self;
            tell_means(&model.chemistry, &scratch.means, &mut to.chemistry);
        }
        self.released.pieces.clear();
        self.released.rates.clear();
        let mut share = 0.0;
        for piece in 0..self.released.cuts.len() / 2 {
            let begin = share;
            self.look_at_begin(self.released.cuts[2 * piece], begin)?;
            for half in [self.released.cuts[2 * piece], self.released.cuts[2 * piece + 1]] {
                for number in self.systems() {
                    let work = advance_system(self.model, number, half.until, self.from, self.to, self.scratch)?;
                    self.scratch.own_steps[number] += work.steps;
                }
                let is_last = half.until >= self.start + self.dt;
                share = if is_last { 1.0 } else { (half.until - self.start) / self.dt };
                self.look(half.looks[1], share)?;
            }
            self.released.pieces.push([begin, share]);
        }
        let of_system = |number: usize| {
            let cells = self.to.chemistry.populations[number].cells();
            self.scratch.own_steps[number] as f64 / cells.max(1) as f64
        };
        Ok(self.systems().map(of_system).fold(0.0, f64::max))
    }

    /// Notes the rates where a piece begins: those where the one before ended, unless something is switched between the two.
    fn look_at_begin(&mut self, first: Cut, share: f64) -> Result<(), Trouble> {
        if first.is_switched {
            return self.look(first.looks[0], share);
        }
        let begin = self.at_begin();
        let Released { rates, width, .. } = &mut self.released;
        match rates.len().checked_sub(*width) {
            Some(last) if !rates.is_empty() => rates.extend_from_within(last..),
            _ => rates.extend(begin),
        }
        Ok(())
    }

    /// Notes the rates as the systems are now, at a share of the step, by the clock at a time that may be a little before or after; those that are not
    /// followed go on a line through the step.
    fn look(&mut self, time: f64, share: f64) -> Result<(), Trouble> {
        let model = self.model;
        self.to.chemistry.controls.secretion.iter_mut().for_each(|list| list.fill(f64::NAN));
        // What is observed is what the clock of its system shows; those of all that are followed have come as far.
        let reached = self.set_clocks(time);
        let carried = carry_releases(model, time, self.to, self.scratch, |link| is_followed(model, link));
        self.set_clocks(reached);
        carried?;
        let begin = self.at_begin();
        let Released { rates, at_end, .. } = &mut self.released;
        let now = self.to.chemistry.controls.secretion.iter().flatten().zip(begin.zip(at_end));
        rates.extend(now.map(|(now, (begin, end))| if now.is_nan() { begin + share * (*end - begin) } else { *now }));
        Ok(())
    }

    /// Sets the clocks of all systems that are followed, and returns what they showed.
    fn set_clocks(&mut self, time: f64) -> f64 {
        let times = &mut self.to.chemistry.times;
        let systems = (0..times.len()).filter(|reactor| is_releasing(self.model, *reactor));
        systems.fold(time, |_, number| std::mem::replace(&mut times[number], time))
    }
}
