"""Pauses Python's search for reference cycles while a program makes what it keeps."""

import gc
from collections.abc import Iterator
from contextlib import contextmanager


@contextmanager
def collection_paused() -> Iterator[None]:
    """Pause the cyclic garbage collector of this process, unless it is already off.

    Imports and models make a hundred thousand objects that stay. Python would look through them
    after every few hundred, in vain, for a tenth of the time that it takes to make them.
    """
    enabled = gc.isenabled()
    gc.disable()
    try:
        yield
    finally:
        if enabled:
            gc.enable()


@contextmanager
def imports_kept() -> Iterator[None]:
    """Pause the collector during imports, and then count all objects as old ones.

    Python looks through young objects soon, all at once after a pause, and through old ones rarely.
    """
    with collection_paused():
        yield
        # What the program itself has frozen must stay so.
        if not gc.get_freeze_count():
            gc.freeze()
            gc.unfreeze()
