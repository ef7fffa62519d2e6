//! On what a study was run, and for how long.

use std::sync::LazyLock;
use std::time::Instant;

/// Processor and number of threads, in words: seconds mean little without.
pub fn description() -> String {
    let threads = rayon::current_num_threads();
    format!("{} with {threads} thread{}", processor(), if threads == 1 { "" } else { "s" })
}

/// Processor time [s] that this thread has had since it began, where the system tells it; else the time since it was first asked for.
///
/// A thread that others push off the processor has had none meanwhile.
pub fn thread_seconds() -> f64 {
    static START: LazyLock<Instant> = LazyLock::new(Instant::now);
    // Linux: nanoseconds on a processor, waiting for one, and how often.
    let told = std::fs::read_to_string("/proc/thread-self/schedstat").ok();
    let nanoseconds = told.and_then(|text| text.split(' ').next()?.parse::<u64>().ok());
    nanoseconds.map_or_else(|| START.elapsed().as_secs_f64(), |ns| ns as f64 * 1e-9)
}

/// The processor's name where the system tells it, else its architecture.
pub fn processor() -> String {
    let info = std::fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
    let name = info.lines().find_map(|line| line.strip_prefix("model name")?.split_once(':'));
    name.map_or_else(|| std::env::consts::ARCH.to_owned(), |(_, name)| name.trim().to_owned())
}
