//! The simulator: model, state, workspace and the step.
