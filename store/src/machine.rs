//! Name and load of the local machine, and the directories of this user on it.

use std::env;
use std::fs;
use std::path::{Path, PathBuf};

/// Returns the host name. The node name of a batch system is appended if it differs.
#[must_use]
pub fn name() -> String {
    let name = fs::read_to_string("/proc/sys/kernel/hostname").ok();
    let name = name.or_else(|| env::var("HOSTNAME").ok()).unwrap_or_default();
    let plain: String =
        name.trim().chars().map(|c| if c.is_ascii_alphanumeric() || c == '.' { c } else { '-' }).collect();
    // Several nodes of a batch system may share one machine.
    match env::var("SLURMD_NODENAME") {
        Ok(node) if node != plain && !node.is_empty() => {
            format!("{plain}-{}", node.replace(|c: char| !c.is_alphanumeric(), "-"))
        }
        _ if plain.is_empty() => "unknown".to_owned(),
        _ => plain,
    }
}

/// Returns the average number of runnable processes in the last minute, or `None` if the system does not report it.
#[must_use]
pub fn load() -> Option<f64> {
    fs::read_to_string("/proc/loadavg").ok()?.split(' ').next()?.parse().ok()
}

/// Returns the directory of this user for the files of this program. It is in `LOCALAPPDATA` on Windows, and in the folder
/// `mac` of the home directory on macOS. On other systems it is in the directory that the environment variable `xdg`
/// contains, or in the folder `unix` of the home directory.
#[must_use]
pub fn user_directory(mac: &str, xdg: &str, unix: &str) -> Option<PathBuf> {
    let path = |name: &str| env::var_os(name).map(PathBuf::from).filter(|path| path.is_absolute());
    let base = if cfg!(windows) {
        path("LOCALAPPDATA")
    } else if cfg!(target_os = "macos") {
        path("HOME").map(|home| home.join(mac))
    } else {
        path(xdg).or_else(|| path("HOME").map(|home| home.join(unix)))
    };
    base.map(|base| base.join("grainbench"))
}

/// Returns true if a process has ended. Returns `None` if it belongs to another machine or the system does not report
/// processes.
#[must_use]
pub fn has_ended(process: u32, host: &str) -> Option<bool> {
    let is_reported = host == name() && Path::new("/proc/self").exists();
    is_reported.then(|| !Path::new(&format!("/proc/{process}")).exists())
}
