//! What a run may take of the memory that the machine has left: it is counted before anything is allocated, for an
//! allocation that fails ends the program.

use std::fs;

/// Memory that is taken to be there where the machine does not say (B).
const UNTOLD: u64 = 8 << 30;

/// Memory that a run may take (B): what the machine has left, `MemAvailable` of `/proc/meminfo`, or 8 GiB where there is
/// none; less where this process may not have as much (`ulimit -v`, as queues set it).
#[must_use]
pub fn available() -> u64 {
    let told = fs::read_to_string("/proc/meminfo").ok();
    told.as_deref().and_then(told_by).unwrap_or(UNTOLD).min(allowed().unwrap_or(u64::MAX))
}

/// What is left of the limit on this process's addresses (B); none where there is no limit.
fn allowed() -> Option<u64> {
    let limits = fs::read_to_string("/proc/self/limits").ok()?;
    let limit = limit_of(&limits)?;
    let status = fs::read_to_string("/proc/self/status").ok()?;
    let taken = status.lines().find_map(|line| line.strip_prefix("VmSize:"))?;
    Some(limit.saturating_sub(in_kilobytes(taken)?))
}

/// The limit on addresses (B) that `/proc/self/limits` tells, where there is one.
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

/// What is wrong with so many of something, of so many bytes each: more than the machine has left. None where they fit.
#[must_use]
pub fn beyond(count: f64, what: &str, bytes_each: f64) -> Option<String> {
    let (wanted, available) = (count * bytes_each, available() as f64);
    // What is not a number fits nowhere.
    if wanted <= available {
        return None;
    }
    let gigabytes = |bytes: f64| bytes / 1e9;
    Some(format!(
        "{count:.3e} {what}, about {:.3e} GB where {:.1} GB are left",
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
