"""A temporary folder for the whole build.

pip builds in the source tree, and files left there would get into the next build, perhaps by
another Python version. So nothing is written there.
"""

import functools
import tempfile
from pathlib import Path


def scratch_folder(name: str) -> Path:
    """Return a folder of this name, which is deleted when this process ends."""
    folder = Path(_temporary_directory().name) / name
    folder.mkdir(exist_ok=True)
    return folder


@functools.cache
def _temporary_directory() -> tempfile.TemporaryDirectory[str]:
    """Create the folder in TMPDIR on first use."""
    return tempfile.TemporaryDirectory(prefix="arm_interfaces_")
