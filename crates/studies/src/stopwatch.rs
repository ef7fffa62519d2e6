//! A thread of its own to work on, and how long it has worked.
//!
//! Time is processor time where the system tells it, for others may use the machine: a thread that is pushed off its processor has
//! none meanwhile. Elsewhere it is the time of the clock while there was work.

use crate::Error;
use rayon::{ThreadPool, ThreadPoolBuilder};
use std::time::Instant;

pub struct Stopwatch {
    thread: ThreadPool,
    /// Processor time [s] that the thread had at the start.
    start: Option<f64>,
    /// Time [s] of the clock while there was work.
    elapsed: f64,
}

impl Stopwatch {
    /// # Errors
    /// [`Error::Thread`] if the system gives none.
    pub fn new() -> Result<Stopwatch, Error> {
        let thread = ThreadPoolBuilder::new().num_threads(1).build()?;
        let start = thread.install(processor_seconds);
        Ok(Stopwatch { thread, start, elapsed: 0.0 })
    }

    /// Does `work` on the thread.
    pub fn time<T: Send>(&mut self, work: impl FnOnce() -> T + Send) -> T {
        let start = Instant::now();
        let done = self.thread.install(work);
        self.elapsed += start.elapsed().as_secs_f64();
        done
    }

    /// Seconds of all work so far.
    pub fn seconds(&self) -> f64 {
        let now = self.thread.install(processor_seconds);
        self.start.zip(now).map_or(self.elapsed, |(start, now)| now - start)
    }
}

/// Processor time [s] of this thread since it began, if the system tells it.
///
/// Linux brings it up to date a few hundred times a second and when the thread goes to sleep, so differences over single short
/// pieces of work would be lost: only the time since the start is of use.
fn processor_seconds() -> Option<f64> {
    // Nanoseconds on a processor, nanoseconds waiting for one, and how often.
    let text = std::fs::read_to_string("/proc/thread-self/schedstat").ok()?;
    text.split(' ').next()?.parse::<u64>().ok().map(|nanoseconds| nanoseconds as f64 * 1e-9)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn work_is_done_on_one_thread_and_takes_time() {
        let mut stopwatch = Stopwatch::new().unwrap();
        assert_eq!(stopwatch.time(rayon::current_num_threads), 1);
        let mut last = stopwatch.seconds();
        while stopwatch.seconds() < 0.01 {
            stopwatch.time(|| std::hint::black_box((0..100_000u64).sum::<u64>()));
            assert!(stopwatch.seconds() >= last);
            last = stopwatch.seconds();
        }
    }
}
