//! `grainbench reference fetch`: installs the data of cases and stored runs, which only a source tree contains.

use super::exit::{Fault, Outcome, check_writable, print};
use grainbench::reference::data::{installed, unpack};
use grainbench::store::{StagedDir, temporary_in};
use std::io;
use std::path::{Path, PathBuf};
use std::process::Command;

#[derive(clap::Args)]
pub(crate) struct Fetch {
    /// ZIP archive of the data for this version: a file, or an `https://` address that `curl` downloads.
    #[arg(value_name = "URL|FILE")]
    source: String,
    /// Directory for the data; name it in GRAINBENCH_DATA. Default: the directory of this user and version.
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
}

pub(crate) fn fetch(arguments: &Fetch) -> Outcome {
    arguments.out.as_deref().map(check_writable).transpose()?;
    let none = || Fault::Input("--out: expected a directory for the data, found no home directory".to_owned());
    let target = arguments.out.clone().or_else(installed).ok_or_else(none)?;
    let mut out = StagedDir::new(&target)?.without_manifest();
    let scratch = temporary_in(&std::env::temp_dir())?;
    let archive = if arguments.source.starts_with("https://") {
        let file = scratch.path().join("data.zip");
        download(&arguments.source, &file)?;
        file
    } else {
        PathBuf::from(&arguments.source)
    };
    let count = unpack(&archive, |name, bytes| out.write(name, bytes).map_err(io::Error::other));
    let count = count.map_err(Fault::input)?;
    out.commit()?;
    print(&format!("{count} files in {}\n", target.display()))
}

fn download(address: &str, file: &Path) -> Result<(), Fault> {
    let words = ["--fail", "--location", "--silent", "--show-error", "--output"];
    let done = Command::new("curl").args(words).arg(file).arg(address).output();
    let done =
        done.map_err(|error| Fault::Input(format!("curl: expected the program for the download, found {error}")))?;
    if done.status.success() {
        return Ok(());
    }
    let found = String::from_utf8_lossy(&done.stderr).trim().to_owned();
    Err(Fault::Input(format!("{address}: expected the archive of the data, found {found}")))
}
