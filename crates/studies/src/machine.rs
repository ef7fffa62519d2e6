//! On what a study was run.

/// Processor and number of threads, in words: seconds mean little without.
pub fn description() -> String {
    let threads = rayon::current_num_threads();
    format!("{} with {threads} thread{}", processor(), if threads == 1 { "" } else { "s" })
}

/// The processor's name where the system tells it, else its architecture.
pub fn processor() -> String {
    let info = std::fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
    let name = info.lines().find_map(|line| line.strip_prefix("model name")?.split_once(':'));
    name.map_or_else(|| std::env::consts::ARCH.to_owned(), |(_, name)| name.trim().to_owned())
}
