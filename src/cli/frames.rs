//! Which frame of a result `render` and `export` mean: by its number, or by an instant.

use crate::error::{Error, Fault, Result, short};
use crate::experiment::When;
use crate::output::ResultFile;

/// Options that name one frame.
#[derive(Debug, Clone, clap::Args)]
pub struct FrameArgs {
    /// The instant: first, last, or a time such as "12 s" (the frame nearest to it).
    #[arg(long, value_name = "TIME", conflicts_with = "frame")]
    pub time: Option<String>,
    /// The number of the frame, from 0.
    #[arg(long, value_name = "NUMBER")]
    pub frame: Option<usize>,
}

impl FrameArgs {
    /// The frame that the options name, or `absent` if they name none.
    ///
    /// # Errors
    /// [`Error::Input`] for a frame that the result does not have, a time outside the run or one that is none.
    pub fn of(&self, result: &ResultFile, absent: When) -> Result<usize> {
        let times = result.times()?;
        let last = times.len() - 1;
        if let Some(frame) = self.frame {
            return if frame <= last { Ok(frame) } else { Err(missing(result, &times, &format!("frame {frame}"))) };
        }
        let when = match &self.time {
            Some(text) => {
                let found = |fault: crate::units::UnitError| format!("--time {text}: {}", fault.message);
                let help = "write first, last, or a time with its unit, such as \"12 s\"";
                text.parse::<When>().map_err(|fault| Error::input(Fault::new(found(fault)).help(help)))?
            }
            None => absent,
        };
        let time = match when {
            When::First => return Ok(0),
            When::Last => return Ok(last),
            When::At(time) => time.value(),
        };
        // Half a frame of slack: a time near the end means the last frame.
        let slack = 0.5 * (times[last] - times[0]) / last.max(1) as f64;
        if self.time.is_some() && (time < times[0] - slack || time > times[last] + slack) {
            return Err(missing(result, &times, &format!("frame at t = {} s", short(time))));
        }
        let away = |frame: &usize| (times[*frame] - time).abs();
        Ok((0..=last).min_by(|a, b| away(a).total_cmp(&away(b))).unwrap_or(last))
    }
}

fn missing(result: &ResultFile, times: &[f64], wanted: &str) -> Error {
    let last = times.len() - 1;
    let fault = Fault::new(format!("{} has no {wanted}", result.path().display())).help(format!(
        "its frames are 0 to {last}, from t = {} s to t = {} s",
        short(times[0]),
        short(times[last])
    ));
    Error::input(fault)
}
