//! The frames of a result by their instants.

use crate::error::Result;
use crate::experiment::When;
use crate::output::ResultFile;

/// The frame that an instant means.
pub(super) fn frame_at(result: &ResultFile, when: When) -> Result<usize> {
    let last = result.frames().saturating_sub(1);
    Ok(match when {
        When::First => 0,
        When::Last => last,
        When::At(time) => {
            let away = |t: &f64| (t - time.value()).abs();
            let times = result.times()?;
            (0..times.len()).min_by(|&a, &b| away(&times[a]).total_cmp(&away(&times[b]))).unwrap_or(last)
        }
    })
}
