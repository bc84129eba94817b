//! How much memory an experiment may take.

use crate::error::{Error, Fault, Result};

/// Units of `--memory`, in bytes.
const UNITS: [(&str, f64); 9] = [
    ("B", 1.0),
    ("kB", 1e3),
    ("MB", 1e6),
    ("GB", 1e9),
    ("TB", 1e12),
    ("KiB", 1024.0),
    ("MiB", 1048576.0),
    ("GiB", 1073741824.0),
    ("TiB", 1099511627776.0),
];

/// Bytes of memory that `--memory` allows; without it those that the machine has, and any number where it does not tell.
///
/// # Errors
/// [`Error::Input`] where it is no size.
pub fn allowed(given: Option<&str>) -> Result<Option<u64>> {
    given.map_or(Ok(machine()), |given| bytes_of("--memory", given).map(Some))
}

/// The bytes that an option asks for, as in "8 GB".
///
/// # Errors
/// [`Error::Input`] where it is no size.
pub fn bytes_of(option: &str, given: &str) -> Result<u64> {
    let text = given.trim();
    let (number, unit) = text.split_at(text.find(|c: char| c.is_alphabetic()).unwrap_or(text.len()));
    let unit = unit.trim();
    let size = UNITS.iter().find(|(name, _)| name.eq_ignore_ascii_case(unit)).map(|(_, size)| size);
    let number = number.trim().parse::<f64>().ok().filter(|number| number.is_finite() && *number > 0.0);
    match (number, size) {
        (Some(number), Some(size)) => Ok((number * size) as u64),
        _ => {
            let fault = Fault::new(format!("{option} is \"{given}\"; a size was expected"));
            let help = format!(
                "write a number above 0 and a unit, such as {option} \"8 GB\"; units are B, kB, MB, GB, TB and KiB, MiB, GiB, TiB"
            );
            Err(Error::input(fault.help(help)))
        }
    }
}

/// Bytes of memory that the machine has for this program: its own, or what a container or `ulimit -v` leaves of it. Linux tells; others do not.
fn machine() -> Option<u64> {
    let read = |path: &str| std::fs::read_to_string(path).unwrap_or_default();
    let all = field(&read("/proc/meminfo"), "MemTotal:").map(|kilobytes| kilobytes.saturating_mul(1024));
    let container = read("/sys/fs/cgroup/memory.max").trim().parse().ok();
    let own = field(&read("/proc/self/limits"), "Max address space");
    [all, container, own].into_iter().flatten().min()
}

/// The first number behind a name at the beginning of a line; none where a word stands there.
fn field(text: &str, name: &str) -> Option<u64> {
    text.lines().find_map(|line| line.strip_prefix(name))?.split_whitespace().next()?.parse().ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sizes_are_read_with_their_units() {
        let read = |text: &str| allowed(Some(text)).ok().flatten();
        assert_eq!(["8 GB", "1.5GiB", "700 b"].map(read), [Some(8_000_000_000), Some(1_610_612_736), Some(700)]);
        assert_eq!(["8", "GB", "-1 GB", "1e400 GB", "8 apples"].map(read), [None; 5]);
    }

    #[test]
    fn what_the_system_tells_is_found() {
        let limits =
            "Max cpu time  unlimited  unlimited  seconds\nMax address space   4096000000   unlimited   bytes\n";
        assert_eq!(field(limits, "Max address space"), Some(4_096_000_000));
        assert_eq!([field(limits, "Max cpu time"), field("MemTotal:  24 kB", "MemTotal:")], [None, Some(24)]);
    }
}
