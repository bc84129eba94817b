//! The coupled step against the equation that it solves, and its order.

use super::contact::{
    CohesionTable, Cohesive, ContactModel, Law, answer, carry_forces, find_slopes, locate_contacts, pull_contacts,
};
use super::implicit::advance_implicitly;
use super::kind::Kind;
use super::model::Model;
use super::state::{State, vector};
use super::workspace::Workspace;
use crate::Vec3;
use crate::contact::Reach;
use crate::geometry::icosphere;
use crate::mechanics::Force;
use crate::mechanics::integrator::{Integrator, Method, Order, StepSize};
use crate::mechanics::membrane::{Membrane, MembraneLaw};

/// Two cells beside each other that attract each other, in fixed steps of `dt` (s); `own` lets each have a stiffness of its own.
fn pair(order: Order, dt: f64, own: bool) -> (Model, State) {
    let ball = icosphere(5.0, 1);
    let (shear, area) = if own { (0.02, 2.0) } else { (0.1, 0.3) };
    let law = MembraneLaw::Skalak { shear, area };
    let membrane = Force::Membrane(Membrane::new(&ball.positions, &ball.facets, law));
    let mut kind = Kind::new("ball", ball, vec![membrane]);
    kind.drag = 0.5;
    kind.bound_stiffness();
    if own {
        kind.use_tangent(false);
    }
    assert_eq!(kind.tangent.is_some(), own);
    // What says whether steps are coupled: here all are.
    kind.largest_stiffness = f64::MIN;
    let kind = kind.for_cells(2);
    let beside =
        |cell: usize| kind.rest.positions.iter().map(|x| x + Vec3::new(10.2 * cell as f64, 0.1, 0.0)).collect();
    let positions = vec![(0..2).map(beside).collect()];
    let integrator = Integrator { method: Method::Implicit { order }, size: StepSize::Fixed(dt) };
    let mut model = Model::of(vec![kind], integrator, 1.0);
    let mut table = CohesionTable::new(1, 0);
    table.stick(0, 0, Cohesive { strength: 2.0, work: 2.0, ..Cohesive::default() });
    table.resolve(&[model.kinds[0].edge]);
    let mut contact =
        ContactModel::new(&model.kinds, &[], Reach { proximity: 0.1, prediction: 0.1, depth: 0.1, margin: 0.1 });
    contact.law = Law::Cohesion(table);
    model.contact = Some(contact);
    let state = State::new(&model, &positions);
    (model, state)
}

/// Without what couples cells: as if their shapes answered everything.
fn uncoupled(model: &Model) -> Model {
    let mut model = model.clone();
    model.kinds[0].largest_stiffness = f64::MAX;
    model
}

fn positions(model: &Model, state: &State) -> Vec<Vec3> {
    let atoms = model.kinds[0].atoms();
    (0..2 * atoms).map(|atom| vector(&model.kinds[0], &state.kinds[0].positions, atom / atoms, atom % atoms)).collect()
}

fn found(model: &Model, state: &State) -> Workspace {
    let mut ws = Workspace::new(model);
    ws.suit(model, state);
    locate_contacts(model, state, &mut ws);
    carry_forces(model, state, &mut ws);
    ws
}

fn advanced(model: &Model, state: &State, (dt, order): (f64, Order), ws: &mut Workspace) -> State {
    let mut next = state.clone();
    advance_implicitly(model, dt, order, state, &mut next, ws);
    next
}

#[test]
fn increments_are_what_forces_and_slopes_make_of_each_cell_by_itself() {
    for own in [false, true] {
        let (dt, order) = (0.08, Order::First);
        let (model, state) = pair(order, dt, own);
        let mut ws = found(&model, &state);
        let coupled = advanced(&model, &state, (dt, order), &mut ws);
        assert!(ws.kinds[0].coupled.couples());
        // What the slopes do against that, as a force that is carried.
        let from = &state.kinds[0].positions;
        let moved: Vec<f64> = coupled.kinds[0].positions.iter().zip(from).map(|(then, now)| then - now).collect();
        pull_contacts(&model, &state.chemistry.controls, &state.kinds, &mut ws.contact, 0.0);
        find_slopes(&model, &state, &mut ws.contact);
        answer(&model, (1.0, 0.0), &state, [&moved[..]].into_iter(), &mut ws.contact);
        let against = ws.contact.forces.live.clone();
        assert!(against.iter().map(Vec3::norm).fold(0.0, f64::max) > 0.1);
        ws.contact.forces.carried.iter_mut().zip(&against).for_each(|(force, by)| *force += by);
        let alone = advanced(&uncoupled(&model), &state, (dt, order), &mut ws);
        assert!(!ws.kinds[0].coupled.couples());
        let [coupled, alone, from] = [&coupled, &alone, &state].map(|state| positions(&model, state));
        let farthest = coupled.iter().zip(&from).map(|(then, now)| (then - now).norm()).fold(0.0, f64::max);
        for (coupled, alone) in coupled.iter().zip(&alone) {
            // What conjugate gradients leave is 1e-5 of the edge in the mean of squares over a cell, and some atoms have more of it.
            assert!((coupled - alone).norm() < 3e-5 * model.kinds[0].edge, "{coupled} and {alone}");
        }
        assert!(farthest > 0.01, "{farthest}");
    }
}

#[test]
fn coupled_steps_miss_where_short_ones_lead_by_the_square_of_their_length() {
    for own in [false, true] {
        let (order, end) = (Order::Second, 0.16);
        let led = |steps: u32, couples: bool| {
            let dt = end / f64::from(steps);
            let (model, mut state) = pair(order, dt, own);
            let model = if couples { model } else { uncoupled(&model) };
            // The same parts of surfaces attract each other in all steps.
            let mut ws = found(&model, &state);
            for _ in 0..steps {
                state = advanced(&model, &state, (dt, order), &mut ws);
                assert_eq!(ws.kinds[0].coupled.couples(), couples, "{dt} s");
            }
            positions(&model, &state)
        };
        let fine = led(1024, false);
        let missed = |steps: u32| {
            let off = led(steps, true).iter().zip(&fine).map(|(then, fine)| (then - fine).norm_squared()).sum::<f64>();
            (off / fine.len() as f64).sqrt()
        };
        let errors = [32, 64, 128].map(missed);
        // They rise towards 2 as steps become short beside what slopes allow.
        let orders: Vec<f64> = errors.windows(2).map(|pair| (pair[0] / pair[1]).log2()).collect();
        assert!(orders.iter().all(|order| *order > 1.7), "{errors:?} µm: orders {orders:?}");
    }
}
