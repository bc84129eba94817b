//! Runs that must come to the same bits whatever the threads, the scratch and the checkpoints in between.

use pseudopod::sim::{Model, State, Workspace, step};

/// So many steps with so many threads, each from scratch that holds nothing of use.
pub fn go_on(model: &Model, state: &mut State, threads: usize, steps: usize) {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
    let mut ws = Workspace::new(model);
    pool.install(|| {
        for _ in 0..steps {
            ws.poison(model);
            step(model, state, &mut ws).unwrap();
        }
    });
}

/// What a checkpoint makes of a state.
pub fn through_a_checkpoint(state: &State) -> State {
    postcard::from_bytes(&postcard::to_stdvec(state).unwrap()).unwrap()
}
