//! Memory available to a run. It is checked before large allocations, because a failed allocation ends the program.

use std::fs;

/// Memory that is assumed if the machine reports none (B).
const UNTOLD: u64 = 8 << 30;

/// Returns the memory that a run may use (B): `MemAvailable` of `/proc/meminfo`, or 8 GiB without this file. The result
/// is at most the unused part of the address-space limit of this process (`ulimit -v`, as set by batch queues).
#[must_use]
pub fn available() -> u64 {
    let meminfo = fs::read_to_string("/proc/meminfo").ok();
    meminfo.as_deref().and_then(told_by).unwrap_or(UNTOLD).min(allowed().unwrap_or(u64::MAX))
}

/// Returns the part of the address-space limit that this process does not use yet (B); `None` without a limit.
fn allowed() -> Option<u64> {
    let limits = fs::read_to_string("/proc/self/limits").ok()?;
    let limit = limit_of(&limits)?;
    let status = fs::read_to_string("/proc/self/status").ok()?;
    let taken = status.lines().find_map(|line| line.strip_prefix("VmSize:"))?;
    Some(limit.saturating_sub(in_kilobytes(taken)?))
}

/// Reads the address-space limit (B) from `/proc/self/limits`; `None` without a limit.
fn limit_of(limits: &str) -> Option<u64> {
    let line = limits.lines().find_map(|line| line.strip_prefix("Max address space"))?;
    line.split_whitespace().next()?.parse().ok()
}

fn told_by(meminfo: &str) -> Option<u64> {
    let line = meminfo.lines().find_map(|line| line.strip_prefix("MemAvailable:"))?;
    in_kilobytes(line)
}

fn in_kilobytes(words: &str) -> Option<u64> {
    words.trim().strip_suffix("kB")?.trim().parse::<u64>().ok()?.checked_mul(1024)
}

/// Returns a description of a request of `count` items of `bytes_each` (B) that exceeds the available memory; `None` if
/// the items fit.
#[must_use]
pub fn beyond(count: f64, what: &str, bytes_each: f64) -> Option<String> {
    let (wanted, available) = (count * bytes_each, available() as f64);
    // This comparison is false for NaN, so NaN does not fit.
    if wanted <= available {
        return None;
    }
    let gigabytes = |bytes: f64| bytes / 1e9;
    Some(format!(
        "{count:.3e} {what}, about {:.3e} GB, with only {:.1} GB available",
        gigabytes(wanted),
        gigabytes(available)
    ))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_does_not_fit_is_told() {
        assert_eq!(told_by("MemTotal: 9 kB\nMemAvailable:    1024 kB\n"), Some(1 << 20));
        assert_eq!(told_by("MemTotal: 9 kB\n"), None);
        let limits = |limit: &str| format!("Max pending\nMax address space         {limit}   unlimited   bytes\n");
        assert_eq!((limit_of(&limits("4096")), limit_of(&limits("unlimited"))), (Some(4096), None));
        assert!(beyond(1e3, "grains", 1e3).is_none());
        assert!([1e12, f64::NAN, f64::INFINITY].iter().all(|&count| beyond(count, "grains", 1e3).is_some()));
    }
}
