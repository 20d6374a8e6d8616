"""A file that a user drops on the page: checked by `arm check` before the simulation sees it.

Nothing of it is trusted: its name only names the thing, it is read in a process of its own with
limited time and memory, and the simulation receives a text without xacro.
"""

import re
import subprocess
import sys
import threading
from dataclasses import dataclass
from pathlib import Path

from arm_viewer.errors import DroppedFileError
from arm_viewer.world.new_thing import mesh_thing

MAX_BYTES = 16_000_000
MESH, TEXTS = ".stl", (".urdf", ".sdf")
TIMEOUT_S, MEMORY_MB = 30, 1000
START_S = 30.0
"""What the check's process may take beside the check itself, on a busy machine."""
MAX_REPORT = 4000


@dataclass(frozen=True, slots=True)
class DroppedFile:
    """A file as a browser sent it.

    Attributes:
        name: its name in the user's folder.
        data: its content.
        metres: length of the unit of a mesh.
    """

    name: str
    data: bytes
    metres: float = 1.0


@dataclass(frozen=True, slots=True)
class CheckedFile:
    """A file that can be spawned.

    Attributes:
        name: for the thing.
        text: URDF or SDF.
        report: what `arm check` says.
    """

    name: str
    text: str
    report: str


def check_size(name: str, size: int) -> None:
    """Refuse a file by its name or size.

    Raises:
        DroppedFileError: it is of another kind, empty or too large.
    """
    if not name.lower().endswith((MESH, *TEXTS)):
        raise DroppedFileError(f"{name} is not a URDF, SDF or STL file (.urdf, .sdf, .stl)")
    if not 0 < size <= MAX_BYTES:
        raise DroppedFileError(
            f"{name} has {size:,} bytes; a file takes 1 to {MAX_BYTES:,} bytes here"
        )


def check_file(file: DroppedFile, folder: Path) -> CheckedFile:
    """Return a file as the simulation takes it.

    The folder is empty; a mesh must stay there as long as the simulation runs.

    Raises:
        DroppedFileError: it cannot be simulated; the message has what `arm check` says.
    """
    check_size(file.name, len(file.data))
    stem, _, suffix = file.name.rpartition(".")
    name = re.sub(r"[^A-Za-z0-9_.\-]", "_", stem)[-80:] or "thing"
    if f".{suffix.lower()}" == MESH:
        mesh = folder / f"mesh{MESH}"
        mesh.write_bytes(file.data)
        text, suffix = mesh_thing(name, mesh, file.metres), "sdf"
    else:
        try:
            text = file.data.decode()
        except UnicodeDecodeError as error:
            raise DroppedFileError(f"{file.name} is not text in UTF-8: {error.reason}") from error
        if "<xacro:" in text:
            raise DroppedFileError(
                f"{file.name} is xacro, which is a program: add what `arm check --urdf` prints"
            )
    model = folder / f"model.{suffix.lower()}"
    model.write_text(text)
    return CheckedFile(name, text, _report(file.name, model))


def _report(name: str, model: Path) -> str:
    words = ("check", "--strict", "--timeout", f"{TIMEOUT_S}", "--memory-limit", f"{MEMORY_MB}")
    try:
        done = subprocess.run(
            [sys.executable, "-P", "-m", "arm_cli", *words, str(model)],
            stdin=subprocess.DEVNULL,
            capture_output=True,
            cwd=model.parent,
            timeout=TIMEOUT_S + START_S,
            check=False,
        )
    except subprocess.TimeoutExpired as error:
        raise DroppedFileError(f"{name}: the check took more than {TIMEOUT_S} s") from error
    said = (done.stdout or done.stderr).decode(errors="replace")
    report = said.replace(f"{model.parent}/", "").strip()[:MAX_REPORT]
    if done.returncode:
        raise DroppedFileError(f"{name} cannot be simulated:\n{report}")
    return report


class FileCheck:
    """Checks a file in a thread of its own.

    Attributes:
        file: the file.
        checked: the file as the simulation takes it, once that is known.
        problem: why it cannot be simulated.
    """

    def __init__(self, file: DroppedFile, folder: Path) -> None:
        """Begin; see `check_file`."""
        self.file = file
        self.checked: CheckedFile | None = None
        self.problem = ""
        self._thread = threading.Thread(target=self._run, args=(folder,), daemon=True)
        self._thread.start()

    @property
    def is_over(self) -> bool:
        """Whether one of `checked` and `problem` is known."""
        return not self._thread.is_alive()

    def _run(self, folder: Path) -> None:
        try:
            self.checked = check_file(self.file, folder)
        except (DroppedFileError, OSError) as error:
            self.problem = str(error)
