//! Writing a directory of files whole or not at all.

use std::fs;
use std::io;
use std::path::{Component, Path, PathBuf};

use tempfile::TempDir;

use crate::manifest::{MANIFEST, Manifest};
use crate::scratch::{Lock, sweep, temporary_in};
use crate::write::{WriteError, parent_of};

/// Files on their way into a directory. They gather in a hidden sibling and move into place at
/// [`StagedDir::commit`]; dropped before that, nothing of them remains.
#[derive(Debug)]
pub struct StagedDir {
    target: PathBuf,
    /// Holds `new`, the content, and during the commit `old`, what it replaces.
    holder: Option<TempDir>,
    /// In the order in which they were written.
    files: Vec<PathBuf>,
    /// Missing parents of the target that had to be made, outermost first; they go when nothing is committed.
    made: Vec<PathBuf>,
    /// Whether a manifest stands with the files.
    manifest: bool,
}

impl StagedDir {
    /// Prepares output for `target`, which need not exist yet, nor its parents.
    ///
    /// # Errors
    /// When `target` is a file, or nothing can be written beside it.
    pub fn new(target: impl Into<PathBuf>) -> Result<Self, WriteError> {
        let target = target.into();
        let mut staged = Self { target, holder: None, files: Vec::new(), made: Vec::new(), manifest: true };
        staged.prepare().map_err(|source| WriteError::new(&staged.target, source))?;
        Ok(staged)
    }

    fn prepare(&mut self) -> io::Result<()> {
        if self.target.exists() && !self.target.is_dir() {
            return Err(io::Error::new(io::ErrorKind::NotADirectory, "a file of this name is in the way"));
        }
        // An existing directory may stand in a read-only one, or be `.`: then the files gather inside it.
        let parent = if self.target.is_dir() { self.target.as_path() } else { parent_of(&self.target) };
        let mut missing: Vec<_> = parent
            .ancestors()
            .filter(|path| !path.as_os_str().is_empty() && !path.exists())
            .map(Path::to_path_buf)
            .collect();
        missing.reverse();
        for path in missing {
            fs::create_dir(&path)?;
            self.made.push(path);
        }
        // What a process that was ended has left goes: beside the directory, if it was new then, or in it. What cannot be
        // looked through is not swept, and is no reason not to write.
        let _ = sweep(parent_of(&self.target));
        let _ = sweep(parent);
        let holder = temporary_in(parent)?;
        fs::create_dir(holder.path().join("new"))?;
        self.holder = Some(holder);
        Ok(())
    }

    /// The same without a manifest, for directories whose files are listed elsewhere.
    #[must_use]
    pub fn without_manifest(mut self) -> Self {
        self.manifest = false;
        self
    }

    /// The directory that the files will stand in.
    #[must_use]
    pub fn target(&self) -> &Path {
        &self.target
    }

    /// Adds a file; `name` is relative to the directory and may have subdirectories.
    ///
    /// # Errors
    /// When `name` leads out of the directory, or the disk refuses.
    pub fn write(&mut self, name: impl AsRef<Path>, bytes: impl AsRef<[u8]>) -> Result<(), WriteError> {
        self.write_with(name, |out| io::Write::write_all(out, bytes.as_ref()))
    }

    /// Adds a file that `fill` writes piece by piece, for what is too long to hold in memory.
    ///
    /// # Errors
    /// When `name` leads out of the directory, `fill` fails, or the disk refuses.
    pub fn write_with<F>(&mut self, name: impl AsRef<Path>, fill: F) -> Result<(), WriteError>
    where
        F: FnOnce(&mut io::BufWriter<fs::File>) -> io::Result<()>,
    {
        let name = name.as_ref();
        let shown = self.target.join(name);
        let write = || -> io::Result<()> {
            let inside = name.components().all(|part| matches!(part, Component::Normal(_)));
            if !inside || name.as_os_str().is_empty() {
                return Err(io::Error::new(io::ErrorKind::InvalidInput, "the name leads out of the output directory"));
            }
            let path = self.staging()?.join("new").join(name);
            fs::create_dir_all(parent_of(&path))?;
            let mut out = io::BufWriter::new(fs::File::create(path)?);
            fill(&mut out)?;
            io::Write::flush(&mut out)
        };
        write().map_err(|source| WriteError::new(shown, source))?;
        if !self.files.iter().any(|known| known == name) {
            self.files.push(name.to_path_buf());
        }
        Ok(())
    }

    /// Adds a file that stands elsewhere on the same disk, without a copy where the disk can do that: it must not change any
    /// more.
    ///
    /// # Errors
    /// As of [`StagedDir::write`].
    pub fn link(&mut self, name: impl AsRef<Path>, from: &Path) -> Result<(), WriteError> {
        let name = name.as_ref();
        self.write(name, "")?;
        let place = || -> io::Result<()> {
            let path = self.staging()?.join("new").join(name);
            fs::remove_file(&path)?;
            fs::hard_link(from, &path).or_else(|_| fs::copy(from, &path).map(drop))
        };
        place().map_err(|source| WriteError::new(self.target.join(name), source))
    }

    /// Moves all files into place. Files of the same name are replaced, files that an earlier run left go, and other files
    /// are left alone; when one cannot be moved, those already moved go back. Until all is done the manifest says that
    /// the directory is mixed; one process at a time is at it.
    ///
    /// # Errors
    /// When a file cannot be put in place; all files are then as they were.
    pub fn commit(self) -> Result<(), WriteError> {
        self.put_in_place(false, &mut || {})
    }

    /// The same, but that files that an earlier run left stay: what is added belongs to them.
    ///
    /// # Errors
    /// As of [`StagedDir::commit`].
    pub fn commit_beside(self) -> Result<(), WriteError> {
        self.put_in_place(true, &mut || {})
    }

    /// Puts all files in place; `after` is called after each thing that is done to the disk, for tests that end the
    /// process there.
    fn put_in_place(mut self, keep: bool, after: &mut dyn FnMut()) -> Result<(), WriteError> {
        let holder = self.staging().map_err(|source| WriteError::new(&self.target, source))?.to_path_buf();
        let at_target = |source| WriteError::new(&self.target, source);
        let mut manifest = Manifest { whole: true, files: self.files.clone() };
        if !self.target.exists() {
            if self.manifest {
                manifest.write(&holder.join("new")).map_err(at_target)?;
            }
            match fs::rename(holder.join("new"), &self.target) {
                // Another may have been quicker.
                Err(_) if self.target.is_dir() => {}
                done => {
                    after();
                    self.made.clear();
                    return done.map_err(at_target);
                }
            }
        }
        let _lock = Lock::of(&self.target).map_err(at_target)?;
        after();
        if !self.manifest {
            self.replace_files(&holder, after)?;
            self.made.clear();
            return Ok(());
        }
        let before = Manifest::read(&self.target);
        let stood = before.as_ref().map(|of| of.files.clone()).unwrap_or_default();
        let both = stood.iter().chain(&self.files).cloned().collect();
        Manifest { whole: false, files: both }.write(&self.target).map_err(at_target)?;
        after();
        if let Err(error) = self.replace_files(&holder, after) {
            let _ = match before {
                Some(before) => before.write(&self.target),
                None => fs::remove_file(self.target.join(MANIFEST)),
            };
            return Err(error);
        }
        for left in stood.iter().filter(|name| !self.files.contains(name)) {
            if keep {
                manifest.files.push(left.clone());
            } else {
                remove_within(&self.target, left);
                after();
            }
        }
        manifest.write(&self.target).map_err(at_target)?;
        after();
        self.made.clear();
        Ok(())
    }

    fn staging(&self) -> io::Result<&Path> {
        self.holder.as_ref().map(TempDir::path).ok_or_else(|| io::Error::other("the output directory was not prepared"))
    }

    fn replace_files(&self, holder: &Path, after: &mut dyn FnMut()) -> Result<(), WriteError> {
        // (place, where the file that stood there waits)
        let mut done: Vec<(PathBuf, Option<PathBuf>)> = Vec::new();
        for name in &self.files {
            let place = self.target.join(name);
            match replace(&holder.join("new").join(name), &place, &holder.join("old").join(name), after) {
                Ok(old) => done.push((place, old)),
                Err(source) => {
                    for (place, old) in done.into_iter().rev() {
                        // Nothing better can be done about a disk that refuses to undo.
                        let _ = match old {
                            Some(old) => fs::rename(old, place),
                            None => fs::remove_file(place),
                        };
                    }
                    return Err(WriteError::new(place, source));
                }
            }
        }
        Ok(())
    }
}

/// Takes away a file of an earlier run, and folders that are empty then. A manifest that names something outside is not
/// heeded.
fn remove_within(directory: &Path, name: &Path) {
    if !name.components().all(|part| matches!(part, Component::Normal(_))) {
        return;
    }
    let _ = fs::remove_file(directory.join(name));
    for folder in name.ancestors().skip(1).filter(|folder| !folder.as_os_str().is_empty()) {
        let _ = fs::remove_dir(directory.join(folder));
    }
}

/// Puts `new` at `place`; returns where the file that stood there waits, if one did.
fn replace(new: &Path, place: &Path, old: &Path, after: &mut dyn FnMut()) -> io::Result<Option<PathBuf>> {
    fs::create_dir_all(parent_of(place))?;
    after();
    let kept = place.is_file();
    if kept {
        fs::create_dir_all(parent_of(old))?;
        if fs::hard_link(place, old).is_err() {
            fs::copy(place, old)?;
        }
        after();
    }
    fs::rename(new, place)?;
    after();
    Ok(kept.then(|| old.to_path_buf()))
}

impl Drop for StagedDir {
    fn drop(&mut self) {
        self.holder = None;
        for path in self.made.iter().rev() {
            // Not empty means that somebody else uses it by now.
            let _ = fs::remove_dir(path);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn appears_whole_at_commit() {
        let dir = tempfile::tempdir().unwrap();
        let target = dir.path().join("deep/out");
        let mut staged = StagedDir::new(&target).unwrap();
        staged.write("a.txt", "a").unwrap();
        staged.write("figures/b.svg", "b").unwrap();
        assert!(!target.exists());
        staged.commit().unwrap();
        assert_eq!(fs::read_to_string(target.join("figures/b.svg")).unwrap(), "b");
        assert_eq!(fs::read_dir(dir.path().join("deep")).unwrap().count(), 1);
    }

    #[test]
    fn leaves_nothing_when_dropped() {
        let dir = tempfile::tempdir().unwrap();
        let mut staged = StagedDir::new(dir.path().join("deep/er/out")).unwrap();
        staged.write("a.txt", "a").unwrap();
        drop(staged);
        assert_eq!(fs::read_dir(dir.path()).unwrap().count(), 0);
    }

    #[test]
    fn replaces_its_own_files_and_leaves_others_alone() {
        let dir = tempfile::tempdir().unwrap();
        fs::write(dir.path().join("a.txt"), "old").unwrap();
        fs::write(dir.path().join("mine.txt"), "mine").unwrap();
        let mut staged = StagedDir::new(dir.path()).unwrap();
        staged.write("a.txt", "new").unwrap();
        staged.commit().unwrap();
        assert_eq!(fs::read_to_string(dir.path().join("a.txt")).unwrap(), "new");
        assert_eq!(fs::read_to_string(dir.path().join("mine.txt")).unwrap(), "mine");
        assert_eq!(fs::read_dir(dir.path()).unwrap().count(), 3);
    }

    #[test]
    fn what_an_earlier_run_left_goes_and_a_mixed_directory_is_told() {
        let dir = tempfile::tempdir().unwrap();
        let target = dir.path().join("out");
        let write = |names: &[&str]| {
            let mut staged = StagedDir::new(&target).unwrap();
            names.iter().for_each(|name| staged.write(name, "x").unwrap());
            staged.commit().unwrap();
        };
        write(&["a.txt", "frames/1.vtk", "frames/2.vtk"]);
        fs::write(target.join("mine.txt"), "mine").unwrap();
        write(&["a.txt"]);
        let left: std::collections::BTreeSet<_> =
            fs::read_dir(&target).unwrap().map(|entry| entry.unwrap().file_name()).collect();
        assert_eq!(left, ["a.txt", "manifest.json", "mine.txt"].map(Into::into).into());
        assert!(crate::refuse_mixed(&target).is_ok());
        Manifest { whole: false, files: Vec::new() }.write(&target).unwrap();
        assert!(crate::refuse_mixed(&target).is_err());
    }

    #[test]
    fn a_commit_that_fails_undoes_itself() {
        let dir = tempfile::tempdir().unwrap();
        fs::write(dir.path().join("a.txt"), "old").unwrap();
        fs::create_dir_all(dir.path().join("c.txt/full")).unwrap();
        let mut staged = StagedDir::new(dir.path()).unwrap();
        for name in ["a.txt", "b.txt", "c.txt"] {
            staged.write(name, "new").unwrap();
        }
        let message = staged.commit().unwrap_err().to_string();
        assert!(message.contains("c.txt"), "{message}");
        assert_eq!(fs::read_to_string(dir.path().join("a.txt")).unwrap(), "old");
        assert_eq!(fs::read_dir(dir.path()).unwrap().count(), 2);
    }

    #[test]
    fn refuses_names_that_lead_outside_and_targets_that_are_files() {
        let dir = tempfile::tempdir().unwrap();
        let mut staged = StagedDir::new(dir.path().join("out")).unwrap();
        assert!(staged.write("../a.txt", "a").is_err());
        assert!(staged.write("/a.txt", "a").is_err());
        fs::write(dir.path().join("file"), "x").unwrap();
        let message = StagedDir::new(dir.path().join("file")).unwrap_err().to_string();
        assert!(message.contains("a file of this name is in the way"), "{message}");
    }

    /// The files of a run, and what they say.
    fn run_of(word: &str) -> Vec<(String, String)> {
        let names: &[&str] = match word {
            "old" => &["a.txt", "figures/1.svg", "figures/2.svg", "frames/1.vtk"],
            _ => &["a.txt", "b.txt", "figures/1.svg"],
        };
        names.iter().map(|name| ((*name).to_owned(), word.to_owned())).collect()
    }

    fn staged(target: &Path, word: &str) -> StagedDir {
        let mut staged = StagedDir::new(target).unwrap();
        run_of(word).iter().for_each(|(name, text)| staged.write(name, text).unwrap());
        staged
    }

    /// The files of ours in a directory, and what they say: not the manifest, and nothing hidden.
    fn found_in(folder: &Path) -> Vec<(String, String)> {
        let (mut found, mut open) = (Vec::new(), vec![folder.to_path_buf()]);
        while let Some(path) = open.pop() {
            let name = path.strip_prefix(folder).unwrap().to_string_lossy().into_owned();
            if name.starts_with('.') || [MANIFEST, "mine.txt"].contains(&&*name) {
                continue;
            }
            if path.is_dir() {
                open.extend(fs::read_dir(&path).unwrap().map(|entry| entry.unwrap().path()));
            } else {
                found.push((name, fs::read_to_string(&path).unwrap()));
            }
        }
        found.sort();
        found
    }

    /// Where a process of the test below puts its files, and after how many operations it ends without a word.
    const PLACE: &str = "GRAINBENCH_TEST_STAGED_PLACE";
    const OPERATIONS: &str = "GRAINBENCH_TEST_STAGED_OPERATIONS";

    /// A process that is ended after each thing that a commit does to the disk: its directory is as it was, whole and
    /// new, or says that it is mixed; and the next run leaves it whole, with nothing beside it.
    #[test]
    fn wherever_a_commit_is_cut_off_no_mixed_directory_is_taken_for_whole() {
        if let (Ok(place), Ok(last)) = (std::env::var(PLACE), std::env::var(OPERATIONS)) {
            let (last, mut done) = (last.parse::<u32>().unwrap(), 0);
            let staged = staged(Path::new(&place), "new");
            // Nothing is dropped at such an end, so that nothing is cleared up.
            let done = staged.put_in_place(false, &mut || {
                done += 1;
                if done == last {
                    std::process::exit(9);
                }
            });
            return done.unwrap();
        }
        let mut told = [0; 3];
        for before in ["nothing", "old", "old without a manifest"] {
            for operations in 1.. {
                let folder = tempfile::tempdir().unwrap();
                let target = folder.path().join("out");
                if before != "nothing" {
                    staged(&target, "old").commit().unwrap();
                    fs::write(target.join("mine.txt"), "mine").unwrap();
                }
                if before == "old without a manifest" {
                    fs::remove_file(target.join(MANIFEST)).unwrap();
                }
                let was = if before == "nothing" { Vec::new() } else { run_of("old") };
                let test = "staged::tests::wherever_a_commit_is_cut_off_no_mixed_directory_is_taken_for_whole";
                let ended = std::process::Command::new(std::env::current_exe().unwrap())
                    .args([test, "--exact"])
                    .env(PLACE, &target)
                    .env(OPERATIONS, operations.to_string())
                    .output()
                    .unwrap();
                let found = if target.exists() { found_in(&target) } else { Vec::new() };
                let is_mixed = crate::refuse_mixed(&target).is_err();
                // What stood there without a manifest is nobody's to take away.
                let foreign = before == "old without a manifest";
                let is_new = |found: &[(String, String)]| {
                    found == run_of("new") || (foreign && run_of("new").iter().all(|file| found.contains(file)))
                };
                let standing = [found == was, is_new(&found), is_mixed];
                assert!(standing.contains(&true), "{before}, {operations}: {found:?}");
                (0..3).filter(|&which| standing[which]).for_each(|which| told[which] += 1);
                if ended.status.success() {
                    assert!(operations > 1 && !is_mixed, "{before}: nothing was cut off");
                    break;
                }
                assert_eq!(ended.status.code(), Some(9), "{before}, {operations}");
                staged(&target, "new").commit().unwrap();
                assert!(is_new(&found_in(&target)), "{before}, {operations}");
                assert!(crate::refuse_mixed(&target).is_ok());
                let hidden = |path: &Path| {
                    let entries = fs::read_dir(path).unwrap().map(|entry| entry.unwrap().file_name());
                    entries.filter(|name| name.to_string_lossy().starts_with('.')).count()
                };
                assert_eq!((hidden(folder.path()), hidden(&target)), (0, 0), "{before}, {operations}: swept");
            }
        }
        assert!(told.iter().all(|&times| times > 2), "{told:?}");
    }
}
