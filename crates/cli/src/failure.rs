//! Why a command failed: one line that says what, perhaps one that says what to do, and the exit code.

use crate::terminal::harmless;
use std::fmt;

/// Exit code of bad input or bad usage.
pub const USAGE: u8 = 2;
/// Exit code of everything else.
pub const OTHER: u8 = 1;
/// Exit code of an interrupted command, as shells have it: 128 + SIGINT.
pub const INTERRUPTED: u8 = 130;

#[derive(Debug)]
pub struct Failure {
    pub code: u8,
    pub what: String,
    /// What to do about it.
    pub help: Option<String>,
}

impl Failure {
    /// Bad input or bad usage.
    pub fn usage(what: impl Into<String>) -> Failure {
        Failure { code: USAGE, what: what.into(), help: None }
    }

    /// Neither the input nor the usage is to blame.
    pub fn other(what: impl Into<String>) -> Failure {
        Failure { code: OTHER, what: what.into(), help: None }
    }

    pub fn with_help(self, help: impl Into<String>) -> Failure {
        Failure { help: Some(help.into()), ..self }
    }

    /// A failure after the work was done: whatever it is, input and usage had been checked before.
    pub fn after_the_work(error: &isolux_io::Error) -> Failure {
        Failure::other(error.to_string())
    }
}

impl From<isolux_io::Error> for Failure {
    fn from(error: isolux_io::Error) -> Failure {
        Failure::usage(error.to_string())
    }
}

impl From<isolux_core::Error> for Failure {
    fn from(error: isolux_core::Error) -> Failure {
        match error {
            isolux_core::Error::Unused { method, option, why } => {
                Failure::usage(format!("{method} has no use for --{option}")).with_help(why)
            }
            error => Failure::usage(error.to_string()),
        }
    }
}

impl fmt::Display for Failure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "\x1b[1;31merror:\x1b[0m {}", harmless(&self.what))?;
        match &self.help {
            Some(help) => write!(f, "\n\x1b[1;32mhelp:\x1b[0m {}", harmless(help)),
            None => Ok(()),
        }
    }
}
