//! Long work, while Python goes on: the interpreter is let go, and signals are answered several times a second.
//!
//! The work is done on threads of its own and the caller's thread waits, because Python answers signals only there.

use crate::fail::Fail;
use pyo3::prelude::*;
use rayon::ThreadPoolBuilder;
use std::sync::Mutex;
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::time::Duration;

/// How often the waiting thread looks up.
const EVERY: Duration = Duration::from_millis(50);

/// Does `work` on so many threads, one for each core if it is `None`. `look` is called on the caller's thread now and then until the
/// work is done; what it fails with is what this fails with, after the work.
///
/// # Errors
/// The first of `look`; if threads cannot be started.
pub fn in_background<T: Send>(
    py: Python,
    threads: Option<usize>,
    mut look: impl FnMut() -> PyResult<()>,
    work: impl FnOnce() -> T + Send,
) -> Result<T, Fail> {
    let pool = ThreadPoolBuilder::new().num_threads(threads.unwrap_or(0)).build()?;
    std::thread::scope(|scope| {
        let (done, is_done) = channel::<()>();
        let worker = scope.spawn(move || {
            let result = pool.install(work);
            drop(done);
            result
        });
        // Only this thread receives; the lock lets the interpreter be let go meanwhile, as what is shared then must be.
        let is_done = Mutex::new(is_done);
        let wait = || is_done.lock().map_or(Err(RecvTimeoutError::Disconnected), |is_done| is_done.recv_timeout(EVERY));
        let mut failed = Ok(());
        while let Err(RecvTimeoutError::Timeout) = py.detach(wait) {
            let looked = look();
            failed = failed.and(looked);
        }
        // A panic goes on as Python's PanicException.
        let result = py.detach(|| worker.join()).unwrap_or_else(|panic| std::panic::resume_unwind(panic));
        failed.map_err(Fail::from).map(|()| result)
    })
}

/// Does `work` that cannot be broken off; Ctrl-C is answered when it is done.
///
/// # Errors
/// Those of the work; whatever a signal raises.
pub fn to_its_end<T: Send, E: Into<Fail> + Send>(
    py: Python,
    work: impl FnOnce() -> Result<T, E> + Send,
) -> Result<T, Fail> {
    in_background(py, None, || py.check_signals(), work)?.map_err(Into::into)
}
