//! The only place that writes to stdout and stderr. Colours are left out where nobody would see them.

use crate::failure::Failure;
use std::io::{ErrorKind, Write};

/// Writes what was asked for to stdout. A reader that has gone away (`| head`) is no failure.
///
/// # Errors
/// A failure of code 1 if stdout cannot be written, say to a full disk.
pub fn print(text: &str) -> Result<(), Failure> {
    let mut stdout = anstream::stdout().lock();
    match stdout.write_all(text.as_bytes()).and_then(|()| stdout.flush()) {
        Err(error) if error.kind() != ErrorKind::BrokenPipe => {
            Err(Failure::other(format!("cannot write to the standard output: {error}")))
        }
        _ => Ok(()),
    }
}

/// Writes a line about the work to stderr. If that fails there is nobody left to tell.
pub fn say(line: &str) {
    let mut stderr = anstream::stderr().lock();
    let _ = writeln!(stderr, "{line}").and_then(|()| stderr.flush());
}

/// Says what may not be as it was meant.
pub fn warn(what: &str) {
    say(&format!("\x1b[1;33mwarning:\x1b[0m {what}"));
}

/// Says what is good to know.
pub fn note(what: &str) {
    say(&format!("\x1b[1;36mnote:\x1b[0m {what}"));
}

/// `text` without control characters: names come from files, and a terminal obeys what it is sent.
pub fn harmless(text: &str) -> String {
    text.chars().map(|c| if c.is_control() { '\u{fffd}' } else { c }).collect()
}

#[cfg(test)]
mod tests {
    #[test]
    fn names_cannot_command_the_terminal() {
        assert_eq!(super::harmless("wall\x1b[2J\r\nµ"), "wall\u{fffd}[2J\u{fffd}\u{fffd}µ");
    }
}
