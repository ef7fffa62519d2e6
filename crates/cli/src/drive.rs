//! Drives a solver: shows how far it is, on a page too, writes drafts and checkpoints, and ends it in time, or when somebody asks for that.

use crate::checkpoints::Checkpoints;
use crate::drafts::Drafts;
use crate::failure::Failure;
use crate::interrupt::Interrupt;
use crate::live::Live;
use crate::progress::{Display, Watch};
use crate::summary::Ended;
use isolux_core::run;
use isolux_core::solvers::Solver;
use isolux_core::{Problem, Solution};
use std::ops::ControlFlow;
use std::time::{Duration, Instant};

/// All that happens while a solver runs.
pub struct Drive<'a, 'b> {
    pub start: Instant,
    /// Time that is left, if it is limited.
    pub left: Option<Duration>,
    pub drafts: Option<Drafts<'a>>,
    pub live: Option<&'a mut Live>,
    pub checkpoints: Option<&'a mut Checkpoints<'b>>,
    pub interrupt: &'a Interrupt,
}

impl Drive<'_, '_> {
    /// Runs `solver` to its end, or until it is stopped; the best solution it has, and why it ended. The last checkpoint is written.
    pub fn run(self, solver: &mut dyn Solver, problem: &Problem, display: &mut Display) -> (Solution, Ended) {
        let Drive { start, left, mut drafts, mut live, mut checkpoints, interrupt } = self;
        let mut watch = Watch::new(display, start, left);
        let mut ended = why_to_end(start, left, interrupt);
        let mut solution = match ended {
            Ended::Complete => run::watch(solver, problem, |solver| {
                watch.show(&solver.progress());
                if let Some(drafts) = drafts.as_mut().filter(|_| !interrupt.is_asked()) {
                    drafts.write(solver, problem);
                }
                if let Some(live) = live.as_mut().filter(|_| !interrupt.is_asked()) {
                    live.show(solver, problem);
                }
                if let Some(checkpoints) = &mut checkpoints {
                    tell(&watch, checkpoints.write_in_time(solver, problem));
                }
                ended = why_to_end(start, left, interrupt);
                if ended == Ended::Complete { ControlFlow::Continue(()) } else { ControlFlow::Break(()) }
            }),
            _ => solver.solution(problem),
        };
        if let Some(checkpoints) = checkpoints {
            tell(&watch, checkpoints.write_last(solver, problem, ended == Ended::Interrupted));
        }
        if let Some(failure) = drafts.and_then(|drafts| drafts.failure) {
            watch.say(&format!("drafts ended early: {failure}"));
        }
        let stopped = match ended {
            Ended::Complete => return (solution, ended),
            Ended::TimeLimit => "by the time limit",
            Ended::Interrupted => {
                watch.say("interrupted: writing the best result so far. Ctrl-C again stops at once.");
                "by the user"
            }
        };
        // The files say, too, that these are not the rays the other parameters ask for.
        solution.provenance.parameters.push(("stopped".to_owned(), stopped.to_owned()));
        (solution, ended)
    }
}

/// Why the work has to end now; [`Ended::Complete`] if nothing but its own end is in sight.
fn why_to_end(start: Instant, left: Option<Duration>, interrupt: &Interrupt) -> Ended {
    match left {
        _ if interrupt.is_asked() => Ended::Interrupted,
        Some(left) if start.elapsed() >= left => Ended::TimeLimit,
        _ => Ended::Complete,
    }
}

fn tell(watch: &Watch, written: Result<(), Failure>) {
    if let Err(failure) = written {
        watch.say(&format!("no checkpoint: {}; the solve goes on, and an earlier checkpoint stays", failure.what));
    }
}
