use super::*;

const PODS: Pseudopods = Pseudopods {
    pressure: 50.0,
    reach: f64::INFINITY,
    least_cosine: 0.7,
    contraction: 10.0,
    release: 1.0,
    cycle: Cycle { means: [2.0, 5.0, 3.0], variation: 0.5 },
    turning: Turning { split: 0.7, angle: 1.0, spread: 0.2, alternation: 0.8, space: Space::Plane },
};

/// The directions of so many pseudopods, with their sides.
fn run(pods: &Pseudopods, told: &Told, count: u32) -> Vec<(Vec3, i8)> {
    let (mut state, mut all) = (pods.start(3, 4), Vec::new());
    while state.number < count {
        let before = state.number;
        pods.advance(3, 4, told, &mut state, 0.1, |_, _| ());
        if state.number > before {
            all.push((Vec3::from(state.direction), state.side));
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
        assert_eq!((state.phase, state.number), (phase, number), "{said:?}");
        let [did, other] = state.did;
        let expected = said.activities().expect("both are told");
        assert_eq!([did.protrusion, did.retraction], expected);
        assert_eq!([other.protrusion, other.retraction], [0.0; 2]);
        assert_eq!(state.releases(&said), expected[1]);
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
        let lasted = all.iter().map(|(_, pod)| pod.lifetime).sum::<f64>() + state.age;
        assert!((lasted - pushed).abs() < 1e-9, "{lasted} and {pushed}");
        assert_eq!(all.len(), state.number as usize - usize::from(state.phase == Phase::Protrusion));
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
