"""The process that tries models: `python -m arm_gazebo.world.trial_process`; see `trial`.

It loads MuJoCo once and forks for each request, so that it survives a crash of the fork.
"""

import json
import os
import resource
import sys
from pathlib import Path
from typing import Any, cast

import mujoco

from arm_gazebo.world.trial import can_be_simulated

NICENESS = 5
"""The control loop has precedence on the processor."""
MAX_PROBLEM_LENGTH = 2000


def main() -> None:
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
        return {"problem": _problem(request["text"], request["path"])}
    except (mujoco.FatalError, ValueError) as error:
        problem = " ".join(str(error).split()) or type(error).__name__
        return {"problem": problem[:MAX_PROBLEM_LENGTH], "out_of_memory": "allocate" in problem}
    # MuJoCo's bindings turn std::bad_alloc into an anonymous RuntimeError.
    except (MemoryError, RuntimeError):
        return {"out_of_memory": True}


def _problem(text: str, path: str | None) -> str:
    """Return why a model that MuJoCo compiles cannot be simulated."""
    spec = mujoco.MjSpec.from_string(text) if path is None else mujoco.MjSpec.from_file(path)
    return "" if can_be_simulated(spec.compile()) else "its numbers cannot be simulated"


def _data_bytes() -> int:
    for line in Path("/proc/self/status").read_text(encoding="ascii").splitlines():
        if line.startswith("VmData:"):
            return int(line.split()[1]) * 1024
    return 0


if __name__ == "__main__":
    main()
