//! Ctrl-C and SIGTERM.
//!
//! The work runs on a thread of its own and asks now and then whether it should come to an end. The first signal asks for
//! that, if there is a result worth keeping; the second, or the first before there is one, ends the command at once: the
//! work is left where it is and unfinished files are dropped, so that old ones stay as they were.
//!
//! SIGHUP is left alone, so that `nohup isolux ...` outlives its terminal.

use crate::failure::{Failure, INTERRUPTED};
use crate::output::OpenFiles;
use std::io;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Sender, channel};
use std::sync::{Arc, Mutex, Once, PoisonError};

/// What the work knows of interruptions.
#[derive(Clone, Debug, Default)]
pub struct Interrupt {
    worth_keeping: Arc<AtomicBool>,
    asked_to_end: Arc<AtomicBool>,
}

impl Interrupt {
    /// From now on there is a result worth keeping: the first signal only asks to come to an end.
    pub fn keep_result(&self) {
        self.worth_keeping.store(true, Ordering::Relaxed);
    }

    /// Whether somebody asked to come to an end.
    pub fn is_asked(&self) -> bool {
        self.asked_to_end.load(Ordering::Relaxed)
    }
}

enum Event {
    Signal,
    /// The work has ended, or panicked.
    Ended,
}

/// Whom a signal is told to: the command that runs now.
static LISTENER: Mutex<Option<Sender<Event>>> = Mutex::new(None);
static INSTALL: Once = Once::new();

/// Does `work`, and gives what it gives unless it is interrupted for good; the files that it has opened are then dropped unfinished.
///
/// # Errors
/// Those of `work`; a failure of code 130 if it was interrupted for good.
pub fn watch<T: Send + 'static>(
    work: impl FnOnce(&Interrupt, &OpenFiles) -> Result<T, Failure> + Send + 'static,
) -> Result<T, Failure> {
    let (sender, events) = channel();
    *LISTENER.lock().unwrap_or_else(PoisonError::into_inner) = Some(sender.clone());
    INSTALL.call_once(|| {
        // Without a handler a signal ends the program as it does any other.
        let _ = install_handler();
    });
    let interrupt = Interrupt::default();
    let files = OpenFiles::default();
    let (for_work, files_of_work) = (interrupt.clone(), files.clone());
    let worker = std::thread::spawn(move || {
        let _tells = TellsWhenDropped(sender);
        work(&for_work, &files_of_work)
    });
    let mut signals = 0;
    while let Ok(Event::Signal) = events.recv() {
        signals += 1;
        interrupt.asked_to_end.store(true, Ordering::Relaxed);
        if signals > 1 || !interrupt.worth_keeping.load(Ordering::Relaxed) {
            files.drop_all();
            let what = "interrupted; nothing more was written".to_owned();
            return Err(Failure { code: INTERRUPTED, what, help: None });
        }
    }
    worker.join().unwrap_or_else(|_| {
        files.drop_all();
        Err(Failure::other("isolux failed inside; this is a fault of the program, please report it"))
    })
}

/// Says that the work has ended, however it ends.
struct TellsWhenDropped(Sender<Event>);

impl Drop for TellsWhenDropped {
    fn drop(&mut self) {
        let _ = self.0.send(Event::Ended);
    }
}

fn on_signal() {
    if let Some(listener) = LISTENER.lock().unwrap_or_else(PoisonError::into_inner).as_ref() {
        let _ = listener.send(Event::Signal);
    }
}

#[cfg(unix)]
fn install_handler() -> io::Result<()> {
    use signal_hook::consts::{SIGINT, SIGTERM};
    let mut signals = signal_hook::iterator::Signals::new([SIGINT, SIGTERM])?;
    let listen = move || signals.forever().for_each(|_| on_signal());
    std::thread::Builder::new().name("signals".to_owned()).spawn(listen).map(|_| ())
}

#[cfg(not(unix))]
fn install_handler() -> io::Result<()> {
    ctrlc::set_handler(on_signal).map_err(io::Error::other)
}
