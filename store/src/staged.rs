//! Writing of a directory of files completely or not at all.

use std::collections::BTreeSet;
use std::fs;
use std::io;
use std::path::{Component, Path, PathBuf};
use std::time::Duration;

use tempfile::TempDir;

use crate::lock::{Lock, LockTerms};
use crate::manifest::{MANIFEST, Manifest, written_files};
use crate::scratch::{remove_leftovers, temporary_in};
use crate::write::{WriteError, parent_of};

/// Time limits of the lock of a directory while its files are replaced.
const TERMS: LockTerms = LockTerms { wait: Duration::from_secs(10), abandoned_after: Duration::from_secs(24 * 3600) };

/// Files that will be moved to a directory together. They are first written to a hidden directory, and
/// [`StagedDir::commit`] moves them. If the value is dropped before that, no file remains.
#[derive(Debug)]
pub struct StagedDir {
    target: PathBuf,
    /// Temporary directory with the new files in `new` and, during the commit, backups of replaced files in `old`.
    holder: TempDir,
    /// Files in the order in which they were written.
    files: Vec<PathBuf>,
    /// Names of `files` as a set, to find a file that was written twice.
    names: BTreeSet<PathBuf>,
    /// Parents of the target that were created. This field follows `holder`, because the folders must be empty when they
    /// are removed.
    made: CreatedFolders,
    /// True to write a manifest with the files.
    manifest: bool,
}

/// Created folders, outermost first, which are removed if nothing is committed.
#[derive(Debug, Default)]
struct CreatedFolders(Vec<PathBuf>);

impl Drop for CreatedFolders {
    fn drop(&mut self) {
        for path in self.0.iter().rev() {
            // A folder that is not empty is in use by another process.
            let _ = fs::remove_dir(path);
        }
    }
}

impl StagedDir {
    /// Prepares output to `target`. The target and its parents need not exist.
    ///
    /// # Errors
    /// When `target` is a file, or when no temporary directory can be created in it or, if it does not exist, next to
    /// it.
    pub fn new(target: impl Into<PathBuf>) -> Result<Self, WriteError> {
        let target = target.into();
        let (holder, made) = prepare(&target).map_err(|source| WriteError::new(&target, source))?;
        Ok(Self { target, holder, files: Vec::new(), names: BTreeSet::new(), made, manifest: true })
    }

    /// Turns the manifest off, for directories whose files are listed in another file.
    #[must_use]
    pub fn without_manifest(mut self) -> Self {
        self.manifest = false;
        self
    }

    /// Returns the directory to which the files will be moved.
    #[must_use]
    pub fn target(&self) -> &Path {
        &self.target
    }

    /// Adds a file. `name` is relative to the directory and may contain subdirectories.
    ///
    /// # Errors
    /// When `name` leads out of the directory or the file cannot be written.
    pub fn write(&mut self, name: impl AsRef<Path>, bytes: impl AsRef<[u8]>) -> Result<(), WriteError> {
        self.write_with(name, |out| io::Write::write_all(out, bytes.as_ref()))
    }

    /// Adds a file whose content `fill` writes in parts, for content that is too large for memory.
    ///
    /// # Errors
    /// When `name` leads out of the directory, `fill` fails, or the file cannot be written.
    pub fn write_with<F>(&mut self, name: impl AsRef<Path>, fill: F) -> Result<(), WriteError>
    where
        F: FnOnce(&mut io::BufWriter<fs::File>) -> io::Result<()>,
    {
        let name = name.as_ref();
        let shown = self.target.join(name);
        let write = || -> io::Result<()> {
            if !is_inside(name) || name.as_os_str().is_empty() {
                return Err(io::Error::new(io::ErrorKind::InvalidInput, "the path leads out of the output directory"));
            }
            let path = self.holder.path().join("new").join(name);
            fs::create_dir_all(parent_of(&path))?;
            let mut out = io::BufWriter::new(fs::File::create(path)?);
            fill(&mut out)?;
            io::Write::flush(&mut out)
        };
        write().map_err(|source| WriteError::new(shown, source))?;
        if self.names.insert(name.to_path_buf()) {
            self.files.push(name.to_path_buf());
        }
        Ok(())
    }

    /// Adds a file that exists on the same disk, as a hard link if the disk supports links, otherwise as a copy. The
    /// file must not change afterwards.
    ///
    /// # Errors
    /// When `name` leads out of the directory or the file cannot be linked or copied.
    pub fn link(&mut self, name: impl AsRef<Path>, from: &Path) -> Result<(), WriteError> {
        let name = name.as_ref();
        self.write(name, "")?;
        let place = || -> io::Result<()> {
            let path = self.holder.path().join("new").join(name);
            fs::remove_file(&path)?;
            fs::hard_link(from, &path).or_else(|_| fs::copy(from, &path).map(drop))
        };
        place().map_err(|source| WriteError::new(self.target.join(name), source))
    }

    /// Moves all files to the directory. Files of the same name are replaced. Files of an earlier run that the manifest
    /// lists are removed. Other files stay unchanged.
    ///
    /// If a file cannot be moved, the directory is restored. During the commit the manifest states that the directory
    /// contains files of two runs. A lock excludes other processes meanwhile.
    ///
    /// # Errors
    /// When a file cannot be moved, or when it would replace a file of another program. All files are then unchanged.
    pub fn commit(self) -> Result<(), WriteError> {
        self.put_in_place(false, &mut || {})
    }

    /// Moves all files to the directory. Files of an earlier run with other names are kept and stay in the manifest.
    ///
    /// # Errors
    /// When a file cannot be moved, or when it would replace a file of another program. All files are then unchanged.
    pub fn commit_beside(self) -> Result<(), WriteError> {
        self.put_in_place(true, &mut || {})
    }

    /// Moves all files to the directory. If `keep` is true, files of an earlier run are kept. `after` is called after
    /// each operation on the disk; tests end the process there.
    fn put_in_place(mut self, keep: bool, after: &mut dyn FnMut()) -> Result<(), WriteError> {
        let holder = self.holder.path();
        let at_target = |source| WriteError::new(&self.target, source);
        let mut manifest = Manifest { whole: true, files: self.files.clone() };
        if !self.target.exists() {
            if self.manifest {
                manifest.write(&holder.join("new")).map_err(at_target)?;
            }
            match fs::rename(holder.join("new"), &self.target) {
                // Another process may have created the directory in the meantime.
                Err(_) if self.target.is_dir() => {}
                done => {
                    after();
                    self.made.0.clear();
                    return done.map_err(at_target);
                }
            }
        }
        self.refuse_others()?;
        let _lock = Lock::acquire(&self.target, TERMS).map_err(at_target)?;
        after();
        let mut moves = Moves { target: &self.target, holder, done: Vec::new() };
        if !self.manifest {
            moves.undone_by_error(|moves| moves.replace_all(&self.files, after))?;
            self.made.0.clear();
            return Ok(());
        }
        let stood = written_files(&self.target);
        let stale: Vec<PathBuf> = stood.iter().filter(|name| !self.names.contains(*name)).cloned().collect();
        if keep {
            manifest.files.extend(stale.iter().cloned());
        }
        let both = stood.iter().chain(&self.files).cloned().collect();
        // Both manifests are written before files are moved, because the disk may be full later.
        let [mixed, whole] = ["mixed", "whole"].map(|name| holder.join(name));
        for (folder, manifest) in [(&mixed, &Manifest { whole: false, files: both }), (&whole, &manifest)] {
            fs::create_dir(folder).and_then(|()| manifest.write(folder)).map_err(at_target)?;
        }
        moves.undone_by_error(|moves| {
            moves.replace(&mixed.join(MANIFEST), Path::new(MANIFEST), after)?;
            moves.replace_all(&self.files, after)?;
            for name in stale.iter().filter(|_| !keep) {
                moves.remove(name, after)?;
            }
            fs::rename(whole.join(MANIFEST), self.target.join(MANIFEST)).map_err(at_target)
        })?;
        after();
        stale.iter().filter(|_| !keep).for_each(|name| remove_empty_folders(&self.target, name));
        self.made.0.clear();
        Ok(())
    }

    /// Checks that no page or manifest of another program is replaced, and that no folder of the new files is a
    /// symbolic link.
    fn refuse_others(&self) -> Result<(), WriteError> {
        for (name, is_written) in [(MANIFEST, self.manifest), (PAGE, self.names.contains(Path::new(PAGE)))] {
            if is_written {
                refuse_foreign(&self.target, name)?;
            }
        }
        let folders: BTreeSet<&Path> = self.names.iter().filter_map(|name| name.parent()).collect();
        for folder in folders {
            if let Some(link) = link_on_the_way(&self.target, folder) {
                let source = io::Error::new(io::ErrorKind::NotADirectory, "expected a folder, found a symbolic link");
                return Err(WriteError::new(link, source));
            }
        }
        Ok(())
    }
}

/// Creates the missing parents of a target, and a temporary directory with the folder `new`.
fn prepare(target: &Path) -> io::Result<(TempDir, CreatedFolders)> {
    if target.exists() && !target.is_dir() {
        return Err(io::Error::new(io::ErrorKind::NotADirectory, "a file with this name exists"));
    }
    // If the directory exists, new files are collected inside it, because it may be `.` or have a read-only parent.
    let parent = if target.is_dir() { target } else { parent_of(target) };
    let missing = parent.ancestors().filter(|path| !path.as_os_str().is_empty() && !path.exists());
    let missing: Vec<_> = missing.map(Path::to_path_buf).collect();
    let mut made = CreatedFolders::default();
    for path in missing.into_iter().rev() {
        fs::create_dir(&path)?;
        made.0.push(path);
    }
    // Temporary files of an ended process are next to the directory if the directory was new, otherwise inside it.
    // A failed removal does not prevent writing.
    let _ = remove_leftovers(parent_of(target));
    let _ = remove_leftovers(parent);
    let holder = temporary_in(parent)?;
    fs::create_dir(holder.path().join("new"))?;
    Ok((holder, made))
}

/// Moves of files into and out of a directory, which are undone after an error.
struct Moves<'a> {
    target: &'a Path,
    holder: &'a Path,
    /// Path of each changed file and, if a file was replaced or removed, path of its backup.
    done: Vec<(PathBuf, Option<PathBuf>)>,
}

impl Moves<'_> {
    /// Calls `moves`. If one of its moves fails, undoes all of them in reverse order.
    fn undone_by_error(&mut self, moves: impl FnOnce(&mut Self) -> Result<(), WriteError>) -> Result<(), WriteError> {
        let result = moves(self);
        if result.is_err() {
            for (place, old) in self.done.drain(..).rev() {
                // If the disk rejects the restoration, nothing more can be done.
                let _ = match old {
                    Some(old) => fs::rename(old, place),
                    None => fs::remove_file(place),
                };
            }
        }
        result
    }

    /// Moves the staged files of these names to the directory.
    fn replace_all(&mut self, names: &[PathBuf], after: &mut dyn FnMut()) -> Result<(), WriteError> {
        names.iter().try_for_each(|name| self.replace(&self.holder.join("new").join(name), name, after))
    }

    /// Moves a file to a name in the directory and keeps a backup of the file that it replaces.
    fn replace(&mut self, new: &Path, name: &Path, after: &mut dyn FnMut()) -> Result<(), WriteError> {
        let (place, old) = (self.target.join(name), self.holder.join("old").join(name));
        let is_there = place.is_file();
        let mut moved = || -> io::Result<()> {
            fs::create_dir_all(parent_of(&place))?;
            after();
            if is_there {
                fs::create_dir_all(parent_of(&old))?;
                if fs::hard_link(&place, &old).is_err() {
                    fs::copy(&place, &old)?;
                }
                after();
            }
            fs::rename(new, &place)?;
            after();
            Ok(())
        };
        moved().map_err(|source| WriteError::new(&place, source))?;
        self.done.push((place, is_there.then_some(old)));
        Ok(())
    }

    /// Moves a file of an earlier run out of the directory. Names in a manifest that lead out of the directory are
    /// ignored.
    fn remove(&mut self, name: &Path, after: &mut dyn FnMut()) -> Result<(), WriteError> {
        let (place, old) = (self.target.join(name), self.holder.join("old").join(name));
        if !stays_inside(self.target, name) || !fs::symlink_metadata(&place).is_ok_and(|found| !found.is_dir()) {
            return Ok(());
        }
        let moved = fs::create_dir_all(parent_of(&old)).and_then(|()| fs::rename(&place, &old));
        moved.map_err(|source| WriteError::new(&place, source))?;
        self.done.push((place, Some(old)));
        after();
        Ok(())
    }
}

/// Name of the page of a report.
const PAGE: &str = "index.html";
/// Start of the title of all pages of this project.
const TITLE: &str = "<title>grainbench";

/// Checks that a directory contains no manifest and none of the named files of another program, which would be replaced.
/// Pages and manifests of this program are recognized by their content, other files by the manifest.
///
/// # Errors
/// When the directory contains such a file of another program.
pub fn refuse_other_programs(directory: &Path, names: &[&str]) -> Result<(), WriteError> {
    std::iter::once(&MANIFEST).chain(names).try_for_each(|name| refuse_foreign(directory, name))
}

fn refuse_foreign(directory: &Path, name: &str) -> Result<(), WriteError> {
    let path = directory.join(name);
    let is_ours = || match name {
        MANIFEST => Manifest::read(directory).is_some(),
        PAGE => fs::read(&path).is_ok_and(|bytes| String::from_utf8_lossy(&bytes).contains(TITLE)),
        _ => written_files(directory).iter().any(|file| file == Path::new(name)),
    };
    if fs::symlink_metadata(&path).is_err() || is_ours() {
        return Ok(());
    }
    let message = format!("expected no file, or a `{name}` that grainbench wrote; found another file");
    Err(WriteError::new(path, io::Error::new(io::ErrorKind::AlreadyExists, message)))
}

/// Returns true if a name has no parts such as `..` and is not absolute.
fn is_inside(name: &Path) -> bool {
    name.components().all(|part| matches!(part, Component::Normal(_)))
}

/// Returns true if a name leads to a file inside a directory, and not through a symbolic link.
fn stays_inside(directory: &Path, name: &Path) -> bool {
    is_inside(name) && name.parent().is_none_or(|folder| link_on_the_way(directory, folder).is_none())
}

/// Returns the first symbolic link on the path from a directory to a folder inside it.
fn link_on_the_way(directory: &Path, folder: &Path) -> Option<PathBuf> {
    let mut parts: Vec<&Path> = folder.ancestors().filter(|part| !part.as_os_str().is_empty()).collect();
    parts.reverse();
    let paths = parts.into_iter().map(|part| directory.join(part));
    paths.into_iter().find(|path| fs::symlink_metadata(path).is_ok_and(|found| found.is_symlink()))
}

/// Removes the folders that contained a file of an earlier run, if they are empty.
fn remove_empty_folders(directory: &Path, name: &Path) {
    if stays_inside(directory, name) {
        for folder in name.ancestors().skip(1).filter(|folder| !folder.as_os_str().is_empty()) {
            let _ = fs::remove_dir(directory.join(folder));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn appears_whole_at_commit_and_leaves_nothing_when_dropped() {
        let dir = tempfile::tempdir().unwrap();
        drop(staged_files(&dir.path().join("deep/er/out"), &["a.txt"], "a"));
        assert_eq!(fs::read_dir(dir.path()).unwrap().count(), 0);
        let target = dir.path().join("deep/out");
        let staged = staged_files(&target, &["a.txt", "figures/b.svg"], "b");
        assert!(!target.exists());
        staged.commit().unwrap();
        assert_eq!(fs::read_to_string(target.join("figures/b.svg")).unwrap(), "b");
        assert_eq!(fs::read_dir(dir.path().join("deep")).unwrap().count(), 1);
    }

    /// A long run writes one file per snapshot, and a second run replaces all files. If each file were searched among
    /// all names, this test would take minutes.
    #[test]
    fn many_files_are_written_in_proportion() {
        let dir = tempfile::tempdir().unwrap();
        let target = dir.path().join("out");
        for count in [30_000, 10_000] {
            let mut staged = StagedDir::new(&target).unwrap();
            (0..count).for_each(|at| staged.write(format!("{at}.txt"), "").unwrap());
            staged.write("0.txt", "again").unwrap();
            staged.commit().unwrap();
            assert_eq!(Manifest::read(&target).unwrap().files.len(), count);
        }
        assert_eq!(fs::read_dir(&target).unwrap().count(), 10_001);
    }

    #[test]
    fn replaces_its_own_files_and_leaves_others_alone() {
        let dir = tempfile::tempdir().unwrap();
        fs::write(dir.path().join("a.txt"), "old").unwrap();
        fs::write(dir.path().join("mine.txt"), "mine").unwrap();
        staged_files(dir.path(), &["a.txt"], "new").commit().unwrap();
        assert_eq!(fs::read_to_string(dir.path().join("a.txt")).unwrap(), "new");
        assert_eq!(fs::read_to_string(dir.path().join("mine.txt")).unwrap(), "mine");
        assert_eq!(fs::read_dir(dir.path()).unwrap().count(), 3);
    }

    #[test]
    fn what_an_earlier_run_left_goes_and_a_mixed_directory_is_told() {
        let dir = tempfile::tempdir().unwrap();
        let target = dir.path().join("out");
        staged_files(&target, &["a.txt", "frames/1.vtk", "frames/2.vtk"], "x").commit().unwrap();
        fs::write(target.join("mine.txt"), "mine").unwrap();
        staged_files(&target, &["a.txt"], "x").commit().unwrap();
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
        let staged = staged_files(dir.path(), &["a.txt", "b.txt", "c.txt"], "new");
        let message = staged.commit().unwrap_err().to_string();
        assert!(message.contains("c.txt"), "{message}");
        assert_eq!(fs::read_to_string(dir.path().join("a.txt")).unwrap(), "old");
        assert_eq!(fs::read_dir(dir.path()).unwrap().count(), 2);
    }

    /// The last move of a commit fails, as on a full disk. The directory is then unchanged, and the next commit
    /// succeeds.
    #[test]
    fn a_commit_whose_manifest_cannot_be_moved_undoes_itself() {
        let dir = tempfile::tempdir().unwrap();
        let target = dir.path().join("out");
        staged(&target, "old").commit().unwrap();
        let before = Manifest::read(&target);
        let new = staged(&target, "new");
        let prepared = new.holder.path().join("whole");
        let error = new.put_in_place(false, &mut || drop(fs::remove_dir_all(&prepared)));
        assert!(error.is_err());
        assert_eq!((found_in(&target), Manifest::read(&target)), (run_of("old"), before));
        staged(&target, "new").commit().unwrap();
        assert_eq!(found_in(&target), run_of("new"));
        assert!(crate::refuse_mixed(&target).is_ok());
    }

    /// A folder of the user is kept, although the manifest lists its name as a file of this program.
    #[test]
    fn folders_are_not_removed_as_files() {
        let dir = tempfile::tempdir().unwrap();
        fs::create_dir(dir.path().join("mine")).unwrap();
        fs::write(dir.path().join("mine/a.txt"), "").unwrap();
        Manifest { whole: true, files: vec!["mine".into()] }.write(dir.path()).unwrap();
        staged(dir.path(), "new").commit().unwrap();
        assert!(dir.path().join("mine/a.txt").exists());
    }

    #[test]
    fn refuses_names_that_lead_outside_and_targets_that_are_files() {
        let dir = tempfile::tempdir().unwrap();
        let mut staged = StagedDir::new(dir.path().join("out")).unwrap();
        assert!(staged.write("../a.txt", "a").is_err());
        assert!(staged.write("/a.txt", "a").is_err());
        fs::write(dir.path().join("file"), "x").unwrap();
        let message = StagedDir::new(dir.path().join("file")).unwrap_err().to_string();
        assert!(message.contains("a file with this name exists"), "{message}");
    }

    /// Files behind a symbolic link in the directory are neither replaced nor removed.
    #[cfg(unix)]
    #[test]
    fn links_are_not_followed() {
        let dir = tempfile::tempdir().unwrap();
        let (target, other) = (dir.path().join("out"), dir.path().join("other"));
        fs::create_dir_all(other.join("sub")).unwrap();
        fs::create_dir(&target).unwrap();
        fs::write(other.join("sub/precious.txt"), "keep").unwrap();
        std::os::unix::fs::symlink(&other, target.join("link")).unwrap();
        Manifest { whole: true, files: vec!["link/sub/precious.txt".into()] }.write(&target).unwrap();
        staged_files(&target, &["a.txt"], "a").commit().unwrap();
        assert_eq!(fs::read_to_string(other.join("sub/precious.txt")).unwrap(), "keep");
        let staged = staged_files(&target, &["link/sub/precious.txt"], "other");
        let message = staged.commit().unwrap_err().to_string();
        assert!(message.contains("out/link: expected a folder, found a symbolic link"), "{message}");
        assert_eq!(fs::read_to_string(other.join("sub/precious.txt")).unwrap(), "keep");
    }

    #[test]
    fn pages_and_manifests_of_other_programs_stay() {
        for (name, foreign, ours) in [
            ("index.html", "<title>My site</title>", "<title>grainbench · 1 pass</title>"),
            ("manifest.json", "{\"name\": \"my site\"}", "{\"whole\": true, \"files\": []}"),
        ] {
            let dir = tempfile::tempdir().unwrap();
            let place = dir.path().join(name);
            let page = "<title>grainbench · 2 pass</title>";
            let commit = || staged_files(dir.path(), &["index.html"], page).commit();
            fs::write(&place, foreign).unwrap();
            assert!(refuse_other_programs(dir.path(), &[PAGE]).is_err());
            let message = commit().unwrap_err().to_string();
            assert!(message.contains(&format!("a `{name}` that grainbench wrote")), "{message}");
            assert_eq!(fs::read_to_string(&place).unwrap(), foreign);
            fs::write(&place, ours).unwrap();
            assert!(refuse_other_programs(dir.path(), &[PAGE]).is_ok());
            commit().unwrap();
            // Other files are ours if the manifest lists them.
            fs::write(dir.path().join("a.csv"), "").unwrap();
            assert!(refuse_other_programs(dir.path(), &["a.csv"]).is_err());
            staged_files(dir.path(), &["a.csv"], "").commit().unwrap();
            assert!(refuse_other_programs(dir.path(), &["a.csv"]).is_ok());
        }
    }

    /// Returns a staged directory with files of these names and one content.
    fn staged_files(target: &Path, names: &[&str], text: &str) -> StagedDir {
        let mut staged = StagedDir::new(target).unwrap();
        names.iter().for_each(|name| staged.write(name, text).unwrap());
        staged
    }

    /// Returns the file names of the run `word`, `old` or another. The content of each file is `word`.
    fn names_of(word: &str) -> &'static [&'static str] {
        match word {
            "old" => &["a.txt", "figures/1.svg", "figures/2.svg", "frames/1.vtk"],
            _ => &["a.txt", "b.txt", "figures/1.svg"],
        }
    }

    fn run_of(word: &str) -> Vec<(String, String)> {
        names_of(word).iter().map(|name| ((*name).to_owned(), word.to_owned())).collect()
    }

    fn staged(target: &Path, word: &str) -> StagedDir {
        staged_files(target, names_of(word), word)
    }

    /// Returns the files of a directory and their contents, without the manifest, `mine.txt` and hidden files.
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

    /// Environment variable with the output directory for the child process of the test below.
    const PLACE: &str = "GRAINBENCH_TEST_STAGED_PLACE";
    /// Environment variable with the number of operations after which the child process ends.
    const OPERATIONS: &str = "GRAINBENCH_TEST_STAGED_OPERATIONS";

    /// For each disk operation of a commit, a process ends right after it. Its directory is then unchanged, completely
    /// new, or marked as mixed. The next run replaces all files and removes temporary files.
    #[test]
    fn wherever_a_commit_is_cut_off_no_mixed_directory_is_taken_for_whole() {
        if let (Ok(place), Ok(last)) = (std::env::var(PLACE), std::env::var(OPERATIONS)) {
            let (last, mut done) = (last.parse::<u32>().unwrap(), 0);
            let staged = staged(Path::new(&place), "new");
            // `exit` drops no values, so that no temporary file is removed.
            let done = staged.put_in_place(false, &mut || {
                done += 1;
                if done == last {
                    std::process::exit(9);
                }
            });
            return done.unwrap();
        }
        let mut outcomes = [0; 3];
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
                // Files without a manifest do not belong to a run, so they are not removed.
                let foreign = before == "old without a manifest";
                let is_new = |found: &[(String, String)]| {
                    found == run_of("new") || (foreign && run_of("new").iter().all(|file| found.contains(file)))
                };
                let standing = [found == was, is_new(&found), is_mixed];
                assert!(standing.contains(&true), "{before}, {operations}: {found:?}");
                (0..3).filter(|&which| standing[which]).for_each(|which| outcomes[which] += 1);
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
        assert!(outcomes.iter().all(|&times| times > 2), "{outcomes:?}");
    }
}
