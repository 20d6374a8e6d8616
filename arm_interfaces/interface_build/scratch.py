"""A temporary folder for the whole build.

pip builds in the source tree, and what a build leaves there would get into the next one, made by
another Python perhaps. So nothing is written there.
"""

import functools
import tempfile
from pathlib import Path


def scratch_folder(name: str) -> Path:
    """Return a folder of that name, which vanishes when this process ends."""
    folder = Path(_temporary_directory().name) / name
    folder.mkdir(exist_ok=True)
    return folder


@functools.cache
def _temporary_directory() -> tempfile.TemporaryDirectory[str]:
    """Create the folder where TMPDIR says, on first use."""
    return tempfile.TemporaryDirectory(prefix="arm_interfaces_")
