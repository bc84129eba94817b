//! The loop: steps, records, checkpoints, progress, stop and resume.
