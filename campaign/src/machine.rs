//! The machine that works: its name, and how busy it is.

use std::fs;

/// What others call it.
#[must_use]
pub fn name() -> String {
    let name = fs::read_to_string("/proc/sys/kernel/hostname").ok();
    let name = name.or_else(|| std::env::var("HOSTNAME").ok()).unwrap_or_default();
    let plain: String =
        name.trim().chars().map(|c| if c.is_ascii_alphanumeric() || c == '.' { c } else { '-' }).collect();
    // Nodes of a batch system may share a machine.
    match std::env::var("SLURMD_NODENAME") {
        Ok(node) if node != plain && !node.is_empty() => {
            format!("{plain}-{}", node.replace(|c: char| !c.is_alphanumeric(), "-"))
        }
        _ if plain.is_empty() => "unknown".to_owned(),
        _ => plain,
    }
}

/// Programs that want a core, on average over the last minute; none where the system does not tell.
#[must_use]
pub fn load() -> Option<f64> {
    fs::read_to_string("/proc/loadavg").ok()?.split(' ').next()?.parse().ok()
}

/// Whether a process of this machine is there; none where the system does not tell.
#[must_use]
pub fn runs(process: u32) -> Option<bool> {
    std::path::Path::new("/proc/self").exists().then(|| std::path::Path::new(&format!("/proc/{process}")).exists())
}
