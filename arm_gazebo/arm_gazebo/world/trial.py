"""Check an untrusted MJCF, and try it in a process with limited memory and time.

With an untrusted model MuJoCo may use all memory, never return, or crash the process. None of this
may happen in the process of the control loop. The other one, `python -m arm_gazebo.world.trial`,
loads MuJoCo once and forks for each request, so that it survives a crash of the fork.
"""

import json
import os
import resource
import subprocess
import sys
import tempfile
import weakref
from contextlib import suppress
from pathlib import Path
from typing import Any, cast

import mujoco
import numpy as np

from arm_gazebo.errors import Refusal, RequestError
from arm_gazebo.feed.child_process import describe_exit
from arm_gazebo.mjcf.memory_limit import MemoryLimit
from arm_gazebo.mjcf.references import check_readable, references

MODULE = "arm_gazebo.world.trial"
END_TIMEOUT_S = 5.0
HEADROOM = 2.0
"""Compiling needs more memory than the compiled model."""
SPAWN_PROCESSOR_S = 8
WORLD_PROCESSOR_S = 60
"""A world may be larger than a spawned model, and the simulation pauses for it anyway."""


class MjcfTrial:
    """Compiles an MJCF and takes some steps, in a process that starts with the first trial.

    Call it from one thread at a time. The process ends with this object or with its owner.
    """

    def __init__(self) -> None:
        self._process: subprocess.Popen[bytes] | None = None

    def problem(
        self,
        text: str,
        path: Path | None,
        limit: MemoryLimit,
        processor_s: int = SPAWN_PROCESSOR_S,
    ) -> str:
        """Return why a model cannot be simulated, "" if it can.

        A file is read instead of the text. `processor_s` limits the processor time.
        """
        request = {
            "text": text,
            "path": path and str(path.absolute()),
            "limit_mb": HEADROOM * limit.mb,
            "processor_s": processor_s,
        }
        for _ in range(2):
            answer = self._ask(json.dumps(request).encode() + b"\n")
            if answer:
                return _problem(json.loads(answer), limit)
            # The process was ended between two trials.
            self._process = None
        return "the process that tries models does not answer"

    def _ask(self, request: bytes) -> bytes:
        process = self._process or self._start()
        assert process.stdin is not None
        assert process.stdout is not None
        with suppress(BrokenPipeError):
            process.stdin.write(request)
            process.stdin.flush()
        return process.stdout.readline()

    def _start(self) -> subprocess.Popen[bytes]:
        # MuJoCo writes a log file into the working folder.
        folder = tempfile.TemporaryDirectory(prefix="arm-trial-")
        process = subprocess.Popen(
            [sys.executable, "-P", "-m", MODULE],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.DEVNULL,
            cwd=folder.name,
            # Its own group shields it from Ctrl-C, so that it ends with the simulation.
            process_group=0,
        )
        self._process = process
        weakref.finalize(self, _end, process, folder, os.getpid())
        return process


def _end(
    process: subprocess.Popen[bytes], folder: tempfile.TemporaryDirectory[str], owner: int
) -> None:
    """End a process by closing its stdin, and remove its folder; do nothing in a fork."""
    if os.getpid() != owner:
        return
    for stream in (process.stdin, process.stdout):
        if stream is not None:
            with suppress(BrokenPipeError):
                stream.close()
    try:
        process.wait(END_TIMEOUT_S)
    except subprocess.TimeoutExpired:
        process.kill()
        process.wait()
    folder.cleanup()


def _problem(answer: dict[str, object], limit: MemoryLimit) -> str:
    """Return the problem that a trial found, in words."""
    code = answer.get("exit")
    if isinstance(code, int):
        return f"MuJoCo cannot compile it: its process ended {describe_exit(code)}"
    if answer.get("out_of_memory"):
        return f"it needs more than {limit.mb:.0f} MB (parameter {limit.parameter})"
    return str(answer["problem"])


def check_mjcf_files(text: str, path: Path | None = None) -> None:
    """Refuse an untrusted MJCF that names files outside its own folder, or that are not regular.

    A text without a file may not name any files.

    Raises:
        RequestError: it names a file outside its folder; the message says which.
        ModelError: a file is not a regular one.
        XmlError: the MJCF, or one that it includes, is not XML.
    """
    for reference in references(text, path):
        if reference.source is None:
            problem = "a text has no folder; give a uri instead"
        elif Path(reference.value).is_absolute() or ".." in Path(reference.value).parts:
            problem = "it is outside the folder of the MJCF file"
        else:
            continue
        raise RequestError(
            Refusal.MISSING_ASSETS,
            f"{reference.attribute}='{reference.value}' is not read: {problem}",
        )
    if path is not None:
        check_readable(text, path)


STEPS = 5


def can_be_simulated(model: mujoco.MjModel) -> bool:
    """Return whether the numbers of a compiled model are finite, and stay so in a few steps."""
    data = mujoco.MjData(model)
    mujoco.mj_step(model, data, STEPS)
    numbers = (model.body_mass, model.body_inertia, model.geom_rbound, data.xpos, data.geom_xpos)
    # MuJoCo resets itself when a number is no longer finite.
    was_reset = data.time < (STEPS - 0.5) * model.opt.timestep
    return not was_reset and all(np.isfinite(values).all() for values in numbers)


NICENESS = 5
"""The control loop has precedence on the processor."""
MAX_PROBLEM_LENGTH = 2000


def _answer_requests() -> None:
    """Answer each line of stdin, a request in JSON, with a line on stdout, until stdin ends."""
    os.nice(NICENESS)
    for line in sys.stdin.buffer:
        sys.stdout.write(json.dumps(_answer(json.loads(line))) + "\n")
        sys.stdout.flush()


def _answer(request: dict[str, Any]) -> dict[str, object]:
    reading, writing = os.pipe()
    child = os.fork()
    if not child:
        # The fork must never return to this process's loop.
        try:
            os.close(reading)
            os.write(writing, json.dumps(_trial(request)).encode())
        finally:
            os._exit(0)
    os.close(writing)
    with open(reading, "rb") as stream:
        answer = stream.read()
    code = os.waitstatus_to_exitcode(os.waitpid(child, 0)[1])
    return cast("dict[str, object]", json.loads(answer)) if answer else {"exit": code}


def _trial(request: dict[str, Any]) -> dict[str, object]:
    limit = _data_bytes() + int(request["limit_mb"] * 1e6)
    processor_s = int(request["processor_s"])
    resource.setrlimit(resource.RLIMIT_DATA, (limit, limit))
    resource.setrlimit(resource.RLIMIT_CPU, (processor_s, processor_s + 1))
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
    try:
        return {"problem": _numeric_problem(request["text"], request["path"])}
    except (mujoco.FatalError, ValueError) as error:
        problem = " ".join(str(error).split()) or type(error).__name__
        return {"problem": problem[:MAX_PROBLEM_LENGTH], "out_of_memory": "allocate" in problem}
    # MuJoCo's bindings turn std::bad_alloc into an anonymous RuntimeError.
    except (MemoryError, RuntimeError):
        return {"out_of_memory": True}


def _numeric_problem(text: str, path: str | None) -> str:
    """Return why a model that MuJoCo compiles cannot be simulated."""
    spec = mujoco.MjSpec.from_string(text) if path is None else mujoco.MjSpec.from_file(path)
    return "" if can_be_simulated(spec.compile()) else "its numbers cannot be simulated"


def _data_bytes() -> int:
    for line in Path("/proc/self/status").read_text(encoding="ascii").splitlines():
        if line.startswith("VmData:"):
            return int(line.split()[1]) * 1024
    return 0


if __name__ == "__main__":
    _answer_requests()
