//! How far the work is: a bar on a terminal; in a pipe nothing, or a line now and then for those who ask.

use crate::numbers::{in_words, percent, three_digits, time, with_prefix};
use crate::terminal;
use indicatif::{ProgressBar, ProgressStyle};
use isolux_core::solvers::Progress;
use std::io::IsTerminal;
use std::time::{Duration, Instant};

/// Time between two looks at a bar, and between two lines.
const REDRAW: Duration = Duration::from_millis(100);
const LINE_EVERY: Duration = Duration::from_secs(10);
/// Steps of a full bar.
const STEPS: u64 = 1000;

/// Shows progress in one of three ways.
pub enum Display {
    Bar(ProgressBar),
    Lines,
    Hidden,
}

/// Whether progress is shown.
#[derive(Clone, Copy, Debug, clap::Args)]
pub struct ProgressArguments {
    /// Show progress even where stderr is no terminal: a line every 10 seconds
    #[arg(long, conflicts_with = "no_progress")]
    progress: bool,

    /// Show no progress bar
    #[arg(long)]
    no_progress: bool,
}

impl ProgressArguments {
    pub fn display(self, quiet: bool) -> Display {
        match std::io::stderr().is_terminal() {
            _ if self.no_progress || quiet => Display::Hidden,
            true => Display::Bar(spinner()),
            false if self.progress => Display::Lines,
            false => Display::Hidden,
        }
    }
}

fn style(template: &str) -> ProgressStyle {
    let style = ProgressStyle::with_template(template).unwrap_or_else(|_| ProgressStyle::default_bar());
    style.progress_chars("━╸─").tick_chars("⠋⠙⠹⠸⠼⠴⠦⠧⠇⠏ ")
}

fn spinner() -> ProgressBar {
    let bar = ProgressBar::new(STEPS).with_style(style("{spinner:.cyan} {msg}"));
    bar.enable_steady_tick(REDRAW);
    bar
}

impl Display {
    /// Says what is being done where nothing can be counted.
    pub fn stage(&mut self, what: &str) {
        if let Display::Bar(bar) = self {
            bar.set_style(style("{spinner:.cyan} {msg}"));
            bar.set_message(terminal::harmless(what));
        }
    }

    /// Shows how far work has come that is no solver's; `what` is asked for only if it is shown.
    pub fn work(&mut self, share: f64, next: &mut Duration, start: Instant, what: impl Fn() -> String) {
        if start.elapsed() < *next {
            return;
        }
        match self {
            Display::Bar(bar) => {
                bar.set_style(style("{spinner:.cyan} {bar:20.cyan/dim} {msg}"));
                bar.set_position((share * STEPS as f64) as u64);
                bar.set_message(what());
                *next = start.elapsed() + REDRAW;
            }
            Display::Lines => {
                terminal::say(&format!("{:3.0} % · {}", 100.0 * share, what()));
                *next = start.elapsed() + LINE_EVERY;
            }
            Display::Hidden => {}
        }
    }

    /// Says something between the pictures of the bar.
    pub fn say(&self, what: &str) {
        match self {
            Display::Bar(bar) => bar.suspend(|| terminal::note(what)),
            _ => terminal::note(what),
        }
    }

    /// Takes the bar away.
    pub fn clear(&mut self) {
        if let Display::Bar(bar) = self {
            bar.finish_and_clear();
        }
    }
}

/// Watches a solver.
pub struct Watch<'a> {
    display: &'a mut Display,
    start: Instant,
    next: Duration,
    /// When it will be stopped.
    limit: Option<Duration>,
}

impl Watch<'_> {
    pub fn new(display: &mut Display, start: Instant, limit: Option<Duration>) -> Watch<'_> {
        if let Display::Bar(bar) = display {
            bar.set_style(style("{spinner:.cyan} {bar:20.cyan/dim} {msg}"));
        }
        Watch { display, start, next: Duration::ZERO, limit }
    }

    /// Says something between the pictures of the bar.
    pub fn say(&self, what: &str) {
        self.display.say(what);
    }

    /// Shows `progress`, if it is time to.
    pub fn show(&mut self, progress: &Progress) {
        let elapsed = self.start.elapsed();
        if elapsed < self.next {
            return;
        }
        let share = match (self.limit, progress.rays_in_all) {
            (Some(limit), _) => elapsed.as_secs_f64() / limit.as_secs_f64(),
            (None, Some(all)) => progress.rays as f64 / all as f64,
            (None, None) => 0.0,
        };
        let share = share.clamp(0.0, 1.0);
        match self.display {
            Display::Bar(bar) => {
                bar.set_position((share * STEPS as f64) as u64);
                bar.set_message(in_short(progress, share, elapsed));
                self.next = elapsed + REDRAW;
            }
            Display::Lines => {
                if elapsed >= LINE_EVERY {
                    terminal::say(&format!("{:3.0} % · {}", 100.0 * share, in_short(progress, share, elapsed)));
                }
                self.next = elapsed + LINE_EVERY;
            }
            Display::Hidden => self.next = Duration::MAX,
        }
    }
}

/// `12 s left · error 0.84 % · unshot 12.3 % · 4.5M rays/s · gathering`: a narrow terminal cuts off what matters least.
fn in_short(progress: &Progress, share: f64, elapsed: Duration) -> String {
    let elapsed = elapsed.as_secs_f64();
    let rate = progress.rays as f64 / elapsed.max(1e-3);
    let error = progress.rms_error.filter(|e| e.is_finite()).map_or("unknown yet".to_owned(), percent);
    let error = match progress.excess.filter(|excess| excess.is_finite()) {
        Some(excess) => format!("{error}, {} times what is asked", three_digits(excess)),
        None => error,
    };
    let left = if share < 0.01 || elapsed < 0.5 {
        "estimating time".to_owned()
    } else {
        match (elapsed * (1.0 - share) / share).ceil() {
            seconds if seconds < 100.0 => format!("{seconds:.0} s left"),
            seconds => format!("{} left", time(seconds)),
        }
    };
    let (unshot, rays) = (percent(progress.unshot), with_prefix(rate));
    format!("{left} · error {error} · unshot {unshot} · {rays} rays/s · {}", progress.stage)
}

/// `4.56 million rays in 12.3 s (371 thousand/s)`
pub fn rays_in_words(rays: u64, seconds: f64) -> String {
    let rate = rays as f64 / seconds.max(1e-6);
    format!("{} rays in {} ({}/s)", in_words(rays as f64), time(seconds), in_words(rate))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_glance_says_stage_speed_unshot_error_and_time_left() {
        let progress = Progress {
            stage: "gathering",
            rays: 5_000_000,
            rays_in_all: Some(10_000_000),
            unshot: 0.25,
            rms_error: Some(0.0123),
            asked: None,
            bias: None,
            excess: None,
        };
        let text = in_short(&progress, 0.5, Duration::from_secs(4));
        assert_eq!(text, "4 s left · error 1.23 % · unshot 25.0 % · 1.25M rays/s · gathering");
        let text = in_short(&Progress { rms_error: None, ..progress }, 0.0, Duration::from_secs(1));
        assert!(text.contains("error unknown yet") && text.starts_with("estimating time"));
    }
}
