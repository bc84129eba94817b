//! Systems that release into fields, followed through a step: at which rates they do so meanwhile.

use super::super::model::Model;
use super::super::state::State;
use super::super::trouble::Trouble;
use super::super::workspace::Workspace;
use super::advance::advance_system;
use super::carry::carry_releases;
use super::links::{Control, Link, Owner, Target};
use super::released::{Cut, Released};
use super::scratch::ChemistryScratch;

/// By how much parabolas may bend away from lines: what lines in their stead would leave out of the amount that all cells release of a substance
/// in a step, over that amount. Where rates are smooth parabolas then leave out less by far, and where they jump less than half of it.
const BENT: f64 = 0.02;

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
    let owns = |link: &Link| matches!(link.owner, Owner::Reactor(owner) if owner == reactor);
    model.chemistry.links.iter().any(|link| owns(link) && is_followed(model, link))
}

/// Moves the systems that release by themselves through a step, all others having been moved, and finds the rates meanwhile.
///
/// # Errors
/// A system that fails, or a rate that cannot be.
pub fn follow(
    model: &Model,
    step: (f64, f64),
    from: &State,
    to: &mut State,
    ws: &mut Workspace,
) -> Result<(), Trouble> {
    let mut released = std::mem::take(&mut ws.chemistry.released);
    let done = released.find(model, step, from, to, &mut ws.chemistry);
    ws.chemistry.released = released;
    done
}

impl Released {
    fn find(
        &mut self,
        model: &Model,
        (start, dt): (f64, f64),
        from: &State,
        to: &mut State,
        scratch: &mut ChemistryScratch,
    ) -> Result<(), Trouble> {
        carry_releases(model, start + dt, to, scratch, |link| !is_followed(model, link))?;
        self.at_end.clear();
        self.at_end.extend(to.chemistry.controls.secretion.iter().flatten());
        self.width = self.at_end.len();
        if !(0..model.chemistry.reactors.len()).any(|reactor| is_releasing(model, reactor)) {
            self.pieces.clear();
            self.pieces.push([0.0, 1.0]);
            self.rates.clear();
            let before = || from.chemistry.controls.secretion.iter().flatten();
            self.rates.extend(before());
            self.rates.extend(before().zip(&self.at_end).map(|(begin, end)| 0.5 * (begin + end)));
            self.rates.extend_from_slice(&self.at_end);
            return Ok(());
        }
        self.find_switches(model, (start, dt), scratch);
        let mut pieces = 1;
        loop {
            self.cut((start, dt), pieces);
            let own_steps = self.go(model, (start, dt), from, to, scratch)?;
            let wanted = (0.5 * own_steps / OWN_STEPS).ceil().min(f64::from(MOST)) as u32;
            if pieces >= MOST || (pieces >= wanted && self.bent(to.chemistry.controls.secretion.len()) <= BENT) {
                break;
            }
            pieces = wanted.max(2 * pieces).min(MOST);
        }
        if pieces > 1 && self.misses_as_one(to.chemistry.controls.secretion.len()) <= COARSER {
            self.join();
        }
        let lists = to.chemistry.controls.secretion.iter_mut().flatten();
        lists.zip(&self.at_end).for_each(|(now, end)| *now = if now.is_nan() { *end } else { *now });
        Ok(())
    }

    /// When the clock switches something in the systems that release; nothing where that is too often.
    fn find_switches(&mut self, model: &Model, (start, dt): (f64, f64), scratch: &mut ChemistryScratch) {
        self.switches.clear();
        let end = start + dt;
        self.last_look = end;
        for (number, reactor) in model.chemistry.reactors.iter().enumerate() {
            if !is_releasing(model, number) {
                continue;
            }
            let (seconds, mut before) = (reactor.seconds, [start; 2]);
            let window = (start / seconds, end / seconds);
            scratch.populations[number].each_piece(&reactor.program, window, |piece| {
                if piece.begin > window.0 && piece.begin * seconds < end && self.switches.len() <= MOST as usize {
                    self.switches.push([before[0], before[1], piece.begin * seconds]);
                }
                before = [piece.end * seconds, piece.until * seconds];
            });
            self.last_look = self.last_look.min(before[0]);
        }
        if self.switches.len() > MOST as usize {
            self.switches.clear();
        }
        self.switches.sort_by(|a, b| a[1].total_cmp(&b[1]));
        // The same one of two systems, but for its last bits.
        self.switches.dedup_by(|b, a| b[0] <= a[2]);
    }

    /// Moves the systems through the step and notes the rates. Returns how many steps of its own a system made, in the mean over its cells: that of
    /// which it is most.
    fn go(
        &mut self,
        model: &Model,
        (start, dt): (f64, f64),
        from: &State,
        to: &mut State,
        scratch: &mut ChemistryScratch,
    ) -> Result<f64, Trouble> {
        let releasing = || (0..model.chemistry.reactors.len()).filter(|reactor| is_releasing(model, *reactor));
        for number in releasing() {
            to.chemistry.take_system(&from.chemistry, number);
            scratch.own_steps[number] = 0;
        }
        self.pieces.clear();
        self.rates.clear();
        let cuts = std::mem::take(&mut self.cuts);
        let (mut done, mut begin) = (Ok(()), 0.0);
        for halves in cuts.chunks_exact(2) {
            done = self.go_through(model, (start, dt), [&halves[0], &halves[1]], &mut begin, from, to, scratch);
            if done.is_err() {
                break;
            }
        }
        self.cuts = cuts;
        done?;
        let steps = releasing().map(|number| {
            let cells = to.chemistry.populations[number].cells();
            scratch.own_steps[number] as f64 / cells.max(1) as f64
        });
        Ok(steps.fold(0.0, f64::max))
    }

    /// Moves them through the halves of a piece that begins at a share of the step, which becomes that of its end.
    fn go_through(
        &mut self,
        model: &Model,
        (start, dt): (f64, f64),
        halves: [&Cut; 2],
        share: &mut f64,
        from: &State,
        to: &mut State,
        scratch: &mut ChemistryScratch,
    ) -> Result<(), Trouble> {
        let begin = *share;
        match (halves[0].is_switched, self.rates.is_empty()) {
            (true, _) => self.look(model, (halves[0].looks[0], begin), from, to, scratch)?,
            (false, true) => self.rates.extend(from.chemistry.controls.secretion.iter().flatten()),
            (false, false) => self.rates.extend_from_within(self.rates.len() - self.width..),
        }
        for half in halves {
            for number in (0..model.chemistry.reactors.len()).filter(|reactor| is_releasing(model, *reactor)) {
                let work = advance_system(model, number, half.until, from, to, scratch)?;
                scratch.own_steps[number] += work.steps;
            }
            *share = if half.until >= start + dt { 1.0 } else { (half.until - start) / dt };
            self.look(model, (half.looks[1], *share), from, to, scratch)?;
        }
        self.pieces.push([begin, *share]);
        Ok(())
    }

    /// Notes the rates as the systems are now, at a share of the step, by the clock at a time that may be a little before or after; those that are not
    /// followed go on a line through the step.
    fn look(
        &mut self,
        model: &Model,
        (time, share): (f64, f64),
        from: &State,
        to: &mut State,
        scratch: &mut ChemistryScratch,
    ) -> Result<(), Trouble> {
        to.chemistry.controls.secretion.iter_mut().for_each(|list| list.fill(f64::NAN));
        // What is observed is what the clock of its system shows; those of all that are followed have come as far.
        let set_clocks = |to: &mut State, time: f64| {
            let followed = (0..model.chemistry.reactors.len()).filter(|reactor| is_releasing(model, *reactor));
            followed.fold(time, |_, number| std::mem::replace(&mut to.chemistry.times[number], time))
        };
        let reached = set_clocks(to, time);
        let carried = carry_releases(model, time, to, scratch, |link| is_followed(model, link));
        set_clocks(to, reached);
        carried?;
        let now = to.chemistry.controls.secretion.iter().flatten();
        let before = from.chemistry.controls.secretion.iter().flatten();
        let rates = now.zip(before.zip(&self.at_end));
        let rate =
            |(now, (begin, end)): (&f64, (&f64, &f64))| if now.is_nan() { begin + share * (end - begin) } else { *now };
        self.rates.extend(rates.map(rate));
        Ok(())
    }
}
