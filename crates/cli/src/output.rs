//! The files a command writes: opened before the work, so that nothing fails at its end that could have failed at its
//! start, and put into their places one by one when they are whole.

use crate::failure::Failure;
use crate::interrupt::Interrupt;
use crate::numbers;
use crate::progress::Display;
use isolux_core::view::VertexField;
use isolux_core::{Problem, Solution};
use isolux_io::export::{self, ExportOptions, Exporter, LitScene};
use isolux_io::files::OutputFile;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

/// Files that are open and not yet finished; shared with whoever may have to drop them.
#[derive(Clone, Debug, Default)]
pub struct OpenFiles(Arc<Mutex<Files>>);

#[derive(Debug, Default)]
struct Files {
    open: Vec<Option<OutputFile>>,
    /// No file is opened any more.
    are_dropped: bool,
}

impl OpenFiles {
    /// Opens a file for each of `paths`, in their order, and none if they were dropped already.
    ///
    /// # Errors
    /// A failure if one cannot be opened, is named twice, or is one of the `inputs`.
    pub fn open(&self, paths: &[PathBuf], inputs: &[&Path]) -> Result<(), Failure> {
        let mut known: Vec<PathBuf> = inputs.iter().filter(|path| path.exists()).map(|path| real(path)).collect();
        let input_count = known.len();
        for path in paths {
            let real = real(path);
            if let Some(k) = known.iter().position(|other| *other == real) {
                let what = if k < input_count { "it would replace the input" } else { "it is named twice" };
                return Err(Failure::usage(format!("{}: {what}", path.display())).with_help("choose another name"));
            }
            known.push(real);
        }
        let mut files = self.lock();
        if !files.are_dropped {
            files.open = paths.iter().map(|path| OutputFile::create(path).map(Some)).collect::<Result<_, _>>()?;
        }
        Ok(())
    }

    fn lock(&self) -> MutexGuard<'_, Files> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Puts file number `k` into its place, with `bytes` in it. Nothing happens if the files were dropped.
    ///
    /// # Errors
    /// A failure if it cannot be written.
    pub fn finish(&self, k: usize, bytes: &[u8]) -> Result<(), Failure> {
        let file = self.lock().open.get_mut(k).and_then(Option::take);
        file.map_or(Ok(()), |file| file.finish(bytes).map_err(|error| Failure::after_the_work(&error)))
    }

    /// Puts `bytes` into the place of file number `k`, which stays open: it will be written again. Nothing happens if the files were
    /// dropped, and nobody can drop them meanwhile.
    ///
    /// # Errors
    /// A failure if it cannot be written.
    pub fn rewrite(&self, k: usize, bytes: &[u8]) -> Result<(), Failure> {
        let mut files = self.lock();
        let Some(slot) = files.open.get_mut(k) else { return Ok(()) };
        let Some(file) = slot.as_ref() else { return Ok(()) };
        let again = OutputFile::create(file.path())?;
        let file = slot.replace(again);
        file.map_or(Ok(()), |file| file.finish(bytes)).map_err(|error| Failure::after_the_work(&error))
    }

    /// Drops all unfinished files: older files of their names stay as they were.
    pub fn drop_all(&self) {
        *self.lock() = Files { open: Vec::new(), are_dropped: true };
    }
}

/// The file that `path` leads to, as far as it exists.
fn real(path: &Path) -> PathBuf {
    path.canonicalize().unwrap_or_else(|_| {
        let folder = path.parent().filter(|p| !p.as_os_str().is_empty()).unwrap_or(Path::new("."));
        folder.canonicalize().unwrap_or_else(|_| folder.to_owned()).join(path.file_name().unwrap_or_default())
    })
}

/// Files that a solution is written to, each in the format of its extension.
#[derive(Clone, Debug)]
pub struct Outputs {
    files: OpenFiles,
    list: Vec<(PathBuf, &'static Exporter)>,
}

/// A file that was written.
#[derive(Clone, Debug, serde::Serialize)]
pub struct Written {
    pub path: PathBuf,
    pub bytes: usize,
}

impl Outputs {
    /// Opens `files` at `paths`.
    ///
    /// # Errors
    /// A failure for an extension without a format, and those of [`OpenFiles::open`].
    pub fn open(files: &OpenFiles, paths: &[PathBuf], inputs: &[&Path]) -> Result<Outputs, Failure> {
        Outputs::open_with_checkpoint(files, paths, None, inputs)
    }

    /// Opens `files` at `paths`, and one for checkpoints after them.
    ///
    /// # Errors
    /// As [`Outputs::open`].
    pub fn open_with_checkpoint(
        files: &OpenFiles,
        paths: &[PathBuf],
        checkpoint: Option<&Path>,
        inputs: &[&Path],
    ) -> Result<Outputs, Failure> {
        let list: Result<Vec<_>, Failure> =
            paths.iter().map(|path| Ok((path.clone(), export::for_path(path)?))).collect();
        let all: Vec<PathBuf> = paths.iter().cloned().chain(checkpoint.map(Path::to_owned)).collect();
        let list = list?;
        files.open(&all, inputs)?;
        Ok(Outputs { files: files.clone(), list })
    }

    /// Puts `bytes` into the place of the file for checkpoints, as [`OpenFiles::rewrite`] does.
    ///
    /// # Errors
    /// A failure if it cannot be written.
    pub fn write_checkpoint(&self, bytes: &[u8]) -> Result<(), Failure> {
        self.files.rewrite(self.list.len(), bytes)
    }

    /// Writes a draft of all files, which will be written again. The vertices of an `earlier` draft are used once more.
    ///
    /// # Errors
    /// The first failure; the files after it keep what they have.
    pub fn write_draft(
        &self,
        problem: &Problem,
        solution: &Solution,
        options: &ExportOptions,
        earlier: Option<VertexField>,
    ) -> Result<Option<VertexField>, Failure> {
        let lit = LitScene::draft(problem, solution, earlier);
        for (k, (path, format)) in self.list.iter().enumerate() {
            let failed = |error| Failure::other(format!("{}: {error}", path.display()));
            self.files.rewrite(k, &(format.write)(&lit, options).map_err(failed)?)?;
        }
        Ok(lit.into_field())
    }

    /// Writes all files. If one cannot be written the others still are.
    ///
    /// # Errors
    /// The first failure.
    pub fn write(
        &self,
        problem: &Problem,
        solution: &Solution,
        options: &ExportOptions,
        display: &mut Display,
        interrupt: &Interrupt,
    ) -> Result<Vec<Written>, Failure> {
        let lit = LitScene::smoothed(problem, solution, options.smoothing);
        let mut written = Vec::new();
        let mut failed = None;
        let mut told = interrupt.is_asked();
        for (k, (path, format)) in self.list.iter().enumerate() {
            display.stage(&format!("writing {}", path.display()));
            let bytes =
                (format.write)(&lit, options).map_err(|error| Failure::other(format!("{}: {error}", path.display())));
            let done = bytes.and_then(|bytes| self.files.finish(k, &bytes).map(|()| bytes.len()));
            match done {
                Ok(bytes) => written.push(Written { path: path.clone(), bytes }),
                Err(failure) => failed = failed.or(Some(failure)),
            }
            if interrupt.is_asked() && !std::mem::replace(&mut told, true) {
                display.say("interrupted, but the result is there: writing the files. Ctrl-C again stops at once.");
            }
        }
        failed.map_or(Ok(written), Err)
    }
}

/// `room.png (1.2 MB), room.glb (3.4 MB)`
pub fn in_words(written: &[Written]) -> String {
    let one = |w: &Written| format!("{} ({})", w.path.display(), numbers::bytes(w.bytes));
    written.iter().map(one).collect::<Vec<_>>().join(", ")
}
