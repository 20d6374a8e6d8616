"""`arm check`: reads a robot or a world as the simulation does, and reports what it finds."""

import argparse
import json
import os
import subprocess
import sys
from collections.abc import Mapping, Sequence
from typing import Any

from arm_cli.arguments import Argument, Exclusive, Flag, positive_number, verb
from arm_cli.errors import ArmCliError, CommandUsageError
from arm_cli.output import say_document

MODULE = "arm_cli.check_process"
TIMEOUT_S = 60.0
MEMORY_LIMIT_MB = 2000.0


@verb(
    Argument("file", metavar="FILE", help="URDF, xacro, SDF or MJCF file, or a package:// URI"),
    Argument("arguments", metavar="NAME:=VALUE", nargs="*", help="arguments of a xacro file"),
    Argument(
        "--package-path",
        metavar="DIR:DIR",
        default="",
        help="folders to search for package:// and $(find ...), after the file's own package and "
        "before its neighbours and the installed packages",
    ),
    Flag("--strict", help="treat a mesh that cannot be loaded as an error"),
    Argument(
        "--timeout",
        metavar="S",
        type=positive_number,
        default=TIMEOUT_S,
        help="time limit in seconds, because a xacro file is a program (default: 60)",
    ),
    Argument(
        "--memory-limit",
        metavar="MB",
        type=positive_number,
        default=MEMORY_LIMIT_MB,
        help="memory limit of the check (default: 2000)",
    ),
    Exclusive(
        Flag("--json", help="print the report as JSON"),
        Flag(
            "--urdf", help="print the expanded URDF instead; the report's line numbers refer to it"
        ),
    ),
)
def check(options: argparse.Namespace) -> int:
    """Print the report; return 1 if the robot or world cannot be simulated."""
    words = {
        name: getattr(options, name)
        for name in ("file", "arguments", "package_path", "strict", "json", "urdf", "memory_limit")
    }
    answer = _answer(words, options.timeout)
    say_document(answer["text"])
    return int(answer["code"])


def expanded_urdf(file: str, arguments: Sequence[str], package_path: str) -> str:
    """Return the URDF of a file, expanded within the default limits of `arm check`.

    Raises:
        CommandUsageError: no file is named.
        ArmCliError: the file cannot be read, or takes too much time or memory.
    """
    words = {"file": file, "arguments": list(arguments), "package_path": package_path}
    limits = {"strict": False, "json": False, "urdf": True, "memory_limit": MEMORY_LIMIT_MB}
    return str(_answer({**words, **limits}, TIMEOUT_S)["text"])


def _answer(words: Mapping[str, Any], timeout_s: float) -> dict[str, Any]:
    """Return what the child process says about a file."""
    file, memory_limit = words["file"], words["memory_limit"]
    if not file:
        raise CommandUsageError("FILE is empty")
    os.getcwd()  # Where it is gone, the process of the check could not say so.
    try:
        done = subprocess.run(
            [sys.executable, "-P", "-m", MODULE, json.dumps(words)],
            stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE,
            timeout=timeout_s,
            check=False,
        )
    except subprocess.TimeoutExpired as error:
        raise ArmCliError(
            f"checking {file} takes more than {timeout_s:g} s; --timeout allows more"
        ) from error
    answer = json.loads(done.stdout) if done.stdout else {"error": _describe_end(done.returncode)}
    if "out_of_memory" in answer:
        raise ArmCliError(
            f"checking {file} takes more than {memory_limit:g} MB; --memory-limit allows more"
        )
    if "error" in answer:
        raise ArmCliError(answer["error"])
    return answer


def _describe_end(code: int) -> str:
    how = f"by signal {-code}" if code < 0 else f"with exit code {code}"
    return f"the process of the check ended {how}: a library that reads the file failed"
