"""Ctrl-C, answered when it suits: between two parts of the work, not in the middle of one."""

from __future__ import annotations

import signal
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any


class Flag:
    """Whether Ctrl-C was pressed."""

    is_set = False


@contextmanager
def deferred() -> Iterator[Flag]:
    """Lets Ctrl-C set a flag, and nothing more; a second one is answered as always. Only the main thread can ask for that."""
    flag = Flag()
    if threading.current_thread() is not threading.main_thread():
        yield flag
        return
    before = signal.getsignal(signal.SIGINT)

    def note(number: int, frame: Any) -> None:
        flag.is_set = True
        signal.signal(signal.SIGINT, before)

    signal.signal(signal.SIGINT, note)
    try:
        yield flag
    finally:
        signal.signal(signal.SIGINT, before)
