use super::super::motility::Space;
use super::*;
use crate::Vec3;
use crate::cell::choices::CANDIDATES;
use crate::cell::inhibition::Touch;

const PODS: Pseudopods = Pseudopods {
    pressure: 50.0,
    reach: f64::INFINITY,
    least_cosine: 0.7,
    contraction: 10.0,
    fibres: None,
    release: 1.0,
    cycle: Cycle { means: [2.0, 5.0, 3.0], variation: 0.5 },
    turning: Turning { split: 0.7, angle: 1.0, spread: 0.2, alternation: 0.8, space: Space::Plane },
    several: Several::ONE,
    abandon: None,
    inhibition: None,
};

/// The directions of so many pseudopods, with their sides.
fn run(pods: &Pseudopods, told: &Told, count: u32) -> Vec<(Vec3, i8)> {
    let (mut state, mut all) = (pods.start(3, 4), Vec::new());
    while state.number < count {
        let before = state.number;
        pods.advance(3, 4, told, &mut state, 0.1, |_, _| ());
        if state.number > before {
            all.push((Vec3::from(state.last.0), state.last.1));
        }
    }
    all
}

#[test]
fn shares_of_time_are_those_of_the_mean_durations_whatever_the_step() {
    for dt in [0.05, 0.4] {
        let (mut state, mut shares) = (PODS.start(1, 2), [0.0; 2]);
        let steps = (20_000.0 / dt) as u32;
        for _ in 0..steps {
            PODS.advance(1, 2, &Told::NOTHING, &mut state, dt, |_, _| ());
            for did in state.did {
                shares[0] += did.protrusion / f64::from(steps);
                shares[1] += did.retraction / f64::from(steps);
            }
        }
        // 2 000 cycles, durations with a deviation of 0.29 of the mean: three standard errors of a share are below 0.01.
        assert!((shares[0] - 0.5).abs() < 0.01 && (shares[1] - 0.3).abs() < 0.01, "{dt}: {shares:?}");
        assert!((f64::from(state.number) - 2000.0).abs() < 30.0, "{}", state.number);
    }
}

#[test]
fn pseudopods_split_off_at_the_angle_and_to_the_other_side_as_often_as_is_said() {
    let all = run(&PODS, &Told::NOTHING, 10_000);
    let split: Vec<_> = all.windows(2).filter(|pair| pair[1].1 != 0).collect();
    let share = split.len() as f64 / all.len() as f64;
    // Three standard errors of a share of 10 000.
    assert!((share - 0.7).abs() < 0.014, "{share}");
    let angles: Vec<f64> = split.iter().map(|pair| pair[0].0.dot(&pair[1].0).acos()).collect();
    let mean = angles.iter().sum::<f64>() / angles.len() as f64;
    assert!((mean - 1.0).abs() < 3.0 * 0.2 / (angles.len() as f64).sqrt(), "{mean}");
    let known: Vec<_> = split.iter().filter(|pair| pair[0].1 != 0).collect();
    let other = known.iter().filter(|pair| pair[0].1 == -pair[1].1).count() as f64 / known.len() as f64;
    assert!((other - 0.8).abs() < 0.02, "{other}");
}

#[test]
fn a_cue_makes_directions_likelier_by_its_exponential() {
    let pods = Pseudopods { turning: Turning { split: 0.0, ..PODS.turning }, ..PODS };
    let told = Told { cue: [0.5, 0.0, 0.0], ..Told::NOTHING };
    let all = run(&pods, &told, 10_000);
    let mean = all.iter().map(|(direction, _)| direction.x).sum::<f64>() / all.len() as f64;
    // What the chances of eq. (pseudopods.1) make of as many even directions, from numbers of its own.
    let mut stream = Stream::new(9, Purpose::Placement, 0, 0);
    let expected = (0..50_000).map(|_| {
        let cosines = [(); CANDIDATES].map(|()| (std::f64::consts::TAU * stream.uniform_pair()[0]).cos());
        let weights = cosines.map(|cosine| (0.5 * cosine).exp());
        cosines.iter().zip(weights).map(|(cosine, weight)| cosine * weight).sum::<f64>() / weights.iter().sum::<f64>()
    });
    let expected = expected.sum::<f64>() / 50_000.0;
    // A cosine deviates by 0.7: three standard errors of the mean of 10 000 are 0.021, those of the expectation 0.004.
    assert!((mean - expected).abs() < 0.022, "{mean} for {expected}");
    assert!(expected > 0.15, "the cue is seen: {expected}");
    let none = run(&pods, &Told::NOTHING, 10_000);
    // x + y deviates by 1.
    let mean = none.iter().map(|(direction, _)| direction.sum()).sum::<f64>() / none.len() as f64;
    assert!(mean.abs() < 0.03, "{mean}");
}

#[test]
fn what_chemistry_tells_takes_the_place_of_the_times() {
    let mut state = PODS.start(1, 2);
    let told = |protrusion: f64, retraction: f64| Told { cue: [0.0; 3], protrusion, retraction };
    for (said, phase, number) in [
        (told(0.0, 0.0), Phase::Pause, 0),
        (told(0.3, f64::NAN), Phase::Protrusion, 1),
        (told(0.6, 0.0), Phase::Protrusion, 1),
        (told(0.0, 0.4), Phase::Retraction, 1),
        (told(0.1, 0.0), Phase::Protrusion, 2),
    ] {
        PODS.advance(1, 2, &said, &mut state, 7.0, |_, _| ());
        assert_eq!((state.pod.phase, state.number), (phase, number), "{said:?}");
        let [did, other, ..] = state.did;
        let expected = said.activities().expect("both are told");
        assert_eq!([did.protrusion, did.retraction], expected);
        assert_eq!([other.protrusion, other.retraction], [0.0; 2]);
        let front = Vec3::from(state.pod.direction);
        assert_eq!(state.releases(&said).collect::<Vec<_>>(), [(front, expected[1])]);
    }
}

#[test]
fn directions_in_space_are_unit_vectors_at_the_angle() {
    let turning = Turning { spread: 0.0, split: 1.0, space: Space::Volume, ..PODS.turning };
    let pods = Pseudopods { turning, ..PODS };
    let all = run(&pods, &Told::NOTHING, 200);
    for pair in all.windows(2) {
        assert!((pair[1].0.norm() - 1.0).abs() < 1e-12);
        assert!((pair[0].0.dot(&pair[1].0) - 1.0_f64.cos()).abs() < 1e-12);
    }
    assert!(all.iter().any(|(direction, _)| direction.z.abs() > 0.5));
}

#[test]
fn every_pseudopod_that_ends_is_told_with_its_time_and_its_turn_whatever_the_step() {
    let told = |dt: f64| {
        let (mut state, mut all, mut pushed) = (PODS.start(1, 2), Vec::new(), 0.0);
        for step in 0..(400.0 / dt) as u32 {
            let begin = f64::from(step) * dt;
            PODS.advance(1, 2, &Told::NOTHING, &mut state, dt, |pod, offset| all.push((begin + offset, pod)));
            pushed += state.did.iter().map(|did| did.protrusion * dt).sum::<f64>();
        }
        let lasted = all.iter().map(|(_, pod)| pod.lifetime).sum::<f64>() + state.pod.age;
        assert!((lasted - pushed).abs() < 1e-9, "{lasted} and {pushed}");
        assert_eq!(all.len(), state.number as usize - usize::from(state.pod.phase == Phase::Protrusion));
        all
    };
    let (fine, coarse) = (told(0.125), told(0.5));
    assert_eq!(fine.len(), coarse.len());
    assert!(fine.len() > 30);
    for (one, other) in fine.iter().zip(&coarse) {
        assert!((one.0 - other.0).abs() < 1e-9 && (one.1.lifetime - other.1.lifetime).abs() < 1e-9);
        assert_eq!((one.1.direction, one.1.side), (other.1.direction, other.1.side));
    }
    assert_eq!(fine[0].1.turn, None);
    for pair in fine.windows(2) {
        let angle = Vec3::from(pair[0].1.direction).angle(&Vec3::from(pair[1].1.direction));
        assert!((pair[1].1.turn.unwrap() - angle).abs() < 1e-6);
    }
}

#[test]
fn a_pseudopod_that_chemistry_pushes_is_told_when_chemistry_lets_it_go() {
    let (mut state, mut all) = (PODS.start(1, 2), Vec::new());
    for (step, protrusion) in [0.0, 0.5, 1.0, 0.5, 0.0, 0.0, 1.0, 0.0].into_iter().enumerate() {
        let said = Told { protrusion, ..Told::NOTHING };
        PODS.advance(1, 2, &said, &mut state, 2.0, |pod, offset| all.push((2.0 * step as f64 + offset, pod.lifetime)));
    }
    assert_eq!(all, [(8.0, 6.0), (14.0, 2.0)]);
}

/// What pseudopods did in steps of `dt`: of each that ended when, what it was, and whether others were there that were kept.
fn ended(pods: &Pseudopods, told: &Told, dt: f64, until: f64) -> (PodState, Vec<(f64, EndedPseudopod, bool)>, f64) {
    let (mut state, mut all, mut one_was_there) = (pods.start(1, 2), Vec::new(), 0.0);
    for step in 0..(until / dt) as u32 {
        let (begin, before) = (f64::from(step) * dt, state);
        pods.advance(1, 2, told, &mut state, dt, |pod, offset| {
            let rivals = before.there().filter(|other| !other.abandoned && other.direction != pod.direction).count();
            all.push((begin + offset, pod, rivals > 0));
        });
        let there = state.there().count();
        assert!(there <= pods.several.most);
        one_was_there += if there == 1 { dt } else { 0.0 };
    }
    (state, all, one_was_there)
}

const TWO: Pseudopods = Pseudopods { several: Several { most: 2, rate: 0.05 }, ..PODS };

#[test]
fn others_begin_beside_the_first_as_often_as_is_said() {
    let until = 100_000.0;
    let (_, all, exposed) = ended(&TWO, &Told::NOTHING, 0.05, until);
    let beside = all.iter().filter(|(_, pod, _)| !pod.alone).count() as f64;
    let (rate, error) = (beside / exposed, beside.sqrt() / exposed);
    println!("{} of {} began alone; {rate} /s", all.len() as f64 - beside, all.len());
    assert!((rate - 0.05).abs() < 3.0 * error, "{rate} with a standard error of {error}");
    assert!(beside > 1_000.0 && beside < 0.5 * all.len() as f64);
    // Where there is a rate and room for one, there is one at a time.
    let one = Pseudopods { several: Several { most: 1, rate: 0.05 }, ..PODS };
    let (_, all, _) = ended(&one, &Told::NOTHING, 0.5, 1_000.0);
    assert!(all.iter().all(|(_, pod, _)| pod.alone && !pod.abandoned));
}

#[test]
fn so_many_are_given_up_as_is_said_and_half_where_two_are_alike() {
    for abandon in [0.0, 0.3] {
        let pods = Pseudopods { abandon: Some(abandon), ..TWO };
        let (_, all, _) = ended(&pods, &Told::NOTHING, 0.1, 100_000.0);
        for (rivals, chance) in [(false, abandon), (true, 1.0 - 0.5 * (1.0 - abandon))] {
            let own: Vec<_> = all.iter().filter(|(.., rival)| *rival == rivals).collect();
            let share = own.iter().filter(|(_, pod, _)| pod.abandoned).count() as f64 / own.len() as f64;
            let error = (chance * (1.0 - chance) / own.len() as f64).sqrt();
            // Half a per cent for those that end in the same step as another.
            assert!((share - chance).abs() <= 3.0 * error + 0.005, "{rivals}: {share}, expected {chance}");
            assert!(own.len() > 300, "{}", own.len());
        }
    }
}

#[test]
fn of_two_the_one_that_goes_with_the_cue_is_kept() {
    let pods = Pseudopods { abandon: Some(0.0), ..TWO };
    let told = Told { cue: [3.0, 0.0, 0.0], ..Told::NOTHING };
    let (_, all, _) = ended(&pods, &told, 0.1, 50_000.0);
    let mean = |abandoned: bool| {
        let own: Vec<f64> = all
            .iter()
            .filter(|(_, pod, rivals)| *rivals && pod.abandoned == abandoned)
            .map(|(_, pod, _)| pod.direction[0])
            .collect();
        (own.iter().sum::<f64>() / own.len() as f64, own.len() as f64)
    };
    let ((kept, of_kept), (given_up, of_given_up)) = (mean(false), mean(true));
    // A cosine deviates by 0.7 at most.
    let error = 0.7 * (1.0 / of_kept + 1.0 / of_given_up).sqrt();
    assert!(kept > given_up + 4.0 * error, "{kept} and {given_up}, {error}");
}

#[test]
fn several_are_the_same_ones_whatever_the_step() {
    let pods = Pseudopods { several: Several { most: 3, rate: 0.1 }, abandon: Some(0.2), ..PODS };
    let [fine, coarse] = [0.125, 0.5].map(|dt| ended(&pods, &Told::NOTHING, dt, 800.0).1);
    assert!(
        fine.len() > 60 && fine.iter().any(|(_, pod, _)| !pod.alone) && fine.iter().any(|(_, pod, _)| pod.abandoned)
    );
    assert_eq!(fine.len(), coarse.len());
    for (one, other) in fine.iter().zip(&coarse) {
        assert!((one.0 - other.0).abs() < 1e-9 && (one.1.lifetime - other.1.lifetime).abs() < 1e-9);
        let told = |pod: &EndedPseudopod| (pod.direction, pod.side, pod.alone, pod.abandoned);
        assert_eq!(told(&one.1), told(&other.1));
    }
}

#[test]
fn one_that_is_given_up_lets_its_own_front_go() {
    let pods = Pseudopods { abandon: Some(1.0), ..PODS };
    let mut state = pods.start(1, 2);
    let mut seen = 0;
    for _ in 0..400 {
        pods.advance(1, 2, &Told::NOTHING, &mut state, 0.1, |pod, _| assert!(pod.abandoned));
        let (front, amount) = state.releases(&Told::NOTHING).next().unwrap();
        if state.pod.phase == Phase::Retraction {
            assert_eq!((front, amount), (-Vec3::from(state.pod.direction), 1.0));
            seen += 1;
        }
    }
    assert!(seen > 50);
}

/// A cell that is touched from the right, where all of its front touches.
fn touched(pods: &Pseudopods, state: &mut PodState) {
    state.note_touch(Vec3::x(), |direction| if direction.x > 0.0 { 1.0 } else { 0.0 });
    assert!(pods.inhibition.is_some());
}

#[test]
fn a_front_that_meets_others_is_given_up_and_the_next_ones_lead_away() {
    let inhibition = Some(Inhibition { share: 0.5, turn: 6.0, by: Touch::All });
    let pods = Pseudopods { inhibition, ..TWO };
    let (mut state, mut ends) = (pods.start(5, 6), Vec::new());
    for _ in 0..20_000 {
        touched(&pods, &mut state);
        pods.advance(5, 6, &Told::NOTHING, &mut state, 0.1, |pod, _| ends.push(pod));
    }
    assert!(ends.len() > 200, "{}", ends.len());
    // Those that lead to where it is touched are stopped in the step after they begin; the others are not given up.
    for pod in &ends {
        assert_eq!(pod.abandoned, pod.direction[0] > 0.0, "{pod:?}");
        assert_eq!(pod.lifetime < 0.5, pod.abandoned, "{pod:?}");
    }
    let away = ends.iter().filter(|pod| !pod.abandoned).count() as f64 / ends.len() as f64;
    assert!(away > 0.9, "{away} lead away");
    // Without a touch, and without inhibition, half of them do.
    let free = run(&pods, &Told::NOTHING, 2_000).iter().filter(|pod| pod.0.x < 0.0).count() as f64 / 2_000.0;
    assert!((free - 0.5).abs() < 0.1, "{free}");
}

#[test]
fn a_front_that_chemistry_pushes_into_others_is_stopped_and_another_one_begins() {
    let inhibition = Some(Inhibition { share: 0.5, turn: 50.0, by: Touch::All });
    let pods = Pseudopods { inhibition, ..PODS };
    let (mut state, mut ends) = (pods.start(5, 6), Vec::new());
    let told = Told { cue: [100.0, 0.0, 0.0], protrusion: 0.7, retraction: f64::NAN };
    pods.advance(5, 6, &told, &mut state, 0.1, |_, _| panic!("it has just begun"));
    assert!(state.pod.phase == Phase::Protrusion && state.pod.direction[0] > 0.5, "{state:?}");
    touched(&pods, &mut state);
    pods.advance(5, 6, &told, &mut state, 0.1, |pod, offset| ends.push((pod, offset)));
    assert!(ends.len() == 1 && ends[0].0.abandoned && ends[0].1 == 0.0, "{ends:?}");
    assert_eq!(state.did[0].protrusion, 0.0);
    // The touch turns the cue around.
    let told = Told { cue: [10.0, 0.0, 0.0], ..told };
    (0..30).for_each(|_| {
        touched(&pods, &mut state);
        pods.advance(5, 6, &told, &mut state, 0.1, |pod, _| ends.push((pod, 0.0)));
    });
    assert!(state.pod.phase == Phase::Protrusion && state.pod.direction[0] < 0.0, "{:?} {ends:?}", state.pod);
}
