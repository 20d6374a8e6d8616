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
