//! The only place that opens a file.
//!
//! An [`OutputFile`] is created before the work whose result it will hold, so that a missing folder or a read-only place
//! is known at once. The result then replaces the old file in one step: nobody ever sees half of it.

use crate::Error;
use std::fs::Metadata;
use std::io::{self, ErrorKind, Read, Write};
use std::path::{Path, PathBuf};
use tempfile::NamedTempFile;

/// No input file may be larger [bytes].
pub const LARGEST_INPUT: u64 = 4 << 30;

/// The content of a file.
///
/// # Errors
/// [`Error::File`] if it cannot be read or is larger than 4 GiB.
pub fn read(path: &Path) -> Result<Vec<u8>, Error> {
    read_up_to(path, LARGEST_INPUT).map_err(|source| Error::File { path: path.to_owned(), action: "read", source })
}

fn read_up_to(path: &Path, limit: u64) -> io::Result<Vec<u8>> {
    let file = std::fs::File::open(path)?;
    let metadata = file.metadata()?;
    if metadata.is_dir() {
        return Err(io::Error::new(ErrorKind::IsADirectory, "it is a folder, not a file"));
    }
    let mut bytes = Vec::new();
    if metadata.len() <= limit {
        bytes.reserve_exact(metadata.len() as usize);
        file.take(limit + 1).read_to_end(&mut bytes)?;
    }
    if metadata.len().max(bytes.len() as u64) > limit {
        return Err(io::Error::new(ErrorKind::FileTooLarge, format!("it is larger than {limit} bytes")));
    }
    Ok(bytes)
}

/// Removes a file that is of no more use.
///
/// # Errors
/// [`Error::File`] if it is not there, or its folder is read-only.
pub fn remove(path: &Path) -> Result<(), Error> {
    std::fs::remove_file(path).map_err(|source| Error::File { path: path.to_owned(), action: "remove", source })
}

/// A file that will be there, whole, once [`finish`](OutputFile::finish) was called, and not before. Dropped unfinished it
/// leaves nothing behind and an older file of the same name as it was.
#[derive(Debug)]
pub struct OutputFile {
    /// As the caller named it, for messages.
    path: PathBuf,
    /// Where the bytes go: `path`, or what it links to.
    target: PathBuf,
    temporary: NamedTempFile,
    /// Of the file that will be replaced.
    old: Option<Metadata>,
}

impl OutputFile {
    /// Prepares to write `path`: opens a temporary file in the same folder.
    ///
    /// Symbolic links are followed; the mode of an existing file is kept, a new one gets what the umask allows.
    ///
    /// # Errors
    /// [`Error::File`] if the folder does not exist or cannot be written, or if `path` is a folder, a device or read-only.
    pub fn create(path: &Path) -> Result<OutputFile, Error> {
        let prepare = || {
            let target = follow_links(path)?;
            let old = existing_file(&target)?;
            let temporary = temporary_beside(&target)?;
            Ok(OutputFile { path: path.to_owned(), target, temporary, old })
        };
        prepare().map_err(|source| Error::File { path: path.to_owned(), action: "write", source })
    }

    /// The path, as it was asked for.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Writes `bytes` and puts the file in its place.
    ///
    /// # Errors
    /// [`Error::File`], say if the disk is full; the old file is then as it was.
    pub fn finish(mut self, bytes: &[u8]) -> Result<(), Error> {
        let write = || {
            self.temporary.write_all(bytes)?;
            if let Some(old) = &self.old {
                self.temporary.as_file().set_permissions(old.permissions())?;
            }
            self.temporary.as_file().sync_all()?;
            self.temporary.persist(&self.target).map_err(|e| e.error)?;
            Ok(())
        };
        write().map_err(|source| Error::File { path: self.path, action: "write", source })
    }
}

/// Where writing to `path` would end, through symbolic links.
fn follow_links(path: &Path) -> io::Result<PathBuf> {
    /// As many as Linux follows.
    const MOST_LINKS: usize = 40;
    let mut target = path.to_owned();
    for _ in 0..MOST_LINKS {
        let Ok(link) = target.read_link() else { return Ok(target) };
        target = folder_of(&target).join(link);
    }
    Err(io::Error::other("the symbolic links lead round in a circle"))
}

/// What is at `target` now. An error if that cannot be replaced by a file.
fn existing_file(target: &Path) -> io::Result<Option<Metadata>> {
    let Ok(metadata) = target.metadata() else { return Ok(None) };
    if metadata.is_dir() {
        return Err(io::Error::new(ErrorKind::IsADirectory, "it is a folder; give the name of a file in it"));
    }
    if !metadata.is_file() {
        return Err(io::Error::other("it is not an ordinary file"));
    }
    // A file that cannot be written should not be replaced either, although the folder would allow it.
    std::fs::OpenOptions::new().write(true).open(target)?;
    Ok(Some(metadata))
}

fn temporary_beside(target: &Path) -> io::Result<NamedTempFile> {
    if target.file_name().is_none() {
        return Err(io::Error::new(ErrorKind::InvalidInput, "it has no file name; give the name of a file"));
    }
    let folder = folder_of(target);
    if !folder.is_dir() {
        let what = format!("there is no folder '{}'; make it first, or choose another", folder.display());
        return Err(io::Error::new(ErrorKind::NotFound, what));
    }
    let mut builder = tempfile::Builder::new();
    builder.prefix(".isolux-");
    #[cfg(unix)]
    builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666)); // the umask applies
    builder.tempfile_in(folder).map_err(|e| match e.kind() {
        ErrorKind::PermissionDenied | ErrorKind::ReadOnlyFilesystem => {
            let what = format!("the folder '{}' cannot be written; choose another", folder.display());
            io::Error::new(e.kind(), what)
        }
        _ => e,
    })
}

fn folder_of(path: &Path) -> &Path {
    match path.parent() {
        Some(parent) if !parent.as_os_str().is_empty() => parent,
        _ => Path::new("."),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn names_in(folder: &Path) -> Vec<String> {
        let entries = std::fs::read_dir(folder).unwrap();
        let mut names: Vec<String> = entries.map(|e| e.unwrap().file_name().into_string().unwrap()).collect();
        names.sort();
        names
    }

    #[test]
    fn a_finished_file_replaces_the_old_one_and_an_unfinished_one_leaves_no_trace() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.csv");
        OutputFile::create(&path).unwrap().finish(b"old").unwrap();
        drop(OutputFile::create(&path).unwrap());
        assert_eq!((read(&path).unwrap(), names_in(folder.path())), (b"old".to_vec(), vec!["a.csv".to_owned()]));
        let output = OutputFile::create(&path).unwrap();
        assert_eq!(read(&path).unwrap(), b"old");
        output.finish(b"new").unwrap();
        assert_eq!((read(&path).unwrap(), names_in(folder.path())), (b"new".to_vec(), vec!["a.csv".to_owned()]));
    }

    #[test]
    fn hopeless_targets_are_refused_before_the_work() {
        let folder = tempfile::tempdir().unwrap();
        let message = |path: &Path| OutputFile::create(path).unwrap_err().to_string();
        assert!(message(folder.path()).contains("it is a folder"));
        assert!(message(&folder.path().join("no/a.csv")).contains("make it first"));
        assert!(message(Path::new("/")).contains("folder"));
        assert!(message(&folder.path().join("..")).contains("folder"));
    }

    #[test]
    fn reading_is_limited_and_says_what_is_wrong() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a");
        OutputFile::create(&path).unwrap().finish(&[7; 10]).unwrap();
        assert_eq!(read_up_to(&path, 10).unwrap().len(), 10);
        assert_eq!(read_up_to(&path, 9).unwrap_err().kind(), ErrorKind::FileTooLarge);
        assert!(read(folder.path()).unwrap_err().to_string().contains("folder"));
        assert!(read(&folder.path().join("none")).unwrap_err().to_string().contains("none: cannot read: "));
    }

    #[cfg(unix)]
    #[test]
    fn modes_and_links_are_treated_as_other_programs_do() {
        use std::os::unix::fs::{PermissionsExt, symlink};
        let folder = tempfile::tempdir().unwrap();
        let in_folder = |name: &str| folder.path().join(name);
        let mode = |name: &str| in_folder(name).metadata().unwrap().permissions().mode() & 0o777;

        std::fs::File::create(in_folder("ordinary")).unwrap();
        OutputFile::create(&in_folder("ours")).unwrap().finish(b"1").unwrap();
        assert_eq!(mode("ours"), mode("ordinary"));

        std::fs::set_permissions(in_folder("ours"), PermissionsExt::from_mode(0o640)).unwrap();
        symlink("ours", in_folder("link")).unwrap();
        OutputFile::create(&in_folder("link")).unwrap().finish(b"2").unwrap();
        assert_eq!((read(&in_folder("ours")).unwrap(), mode("ours")), (b"2".to_vec(), 0o640));
        assert!(in_folder("link").is_symlink());

        symlink("round", in_folder("round")).unwrap();
        assert!(OutputFile::create(&in_folder("round")).unwrap_err().to_string().contains("circle"));
        assert!(OutputFile::create(Path::new("/dev/null")).unwrap_err().to_string().contains("ordinary"));
    }
}
