"""`arm check`: reads a robot or a world as the simulation does, and reports what it finds."""

import argparse
import json
import math
import os
import subprocess
import sys
from collections.abc import Iterator, Mapping, Sequence
from typing import Any

from arm_cli.arguments import Argument, Exclusive, Flag, positive_number, verb
from arm_cli.errors import ArmCliError, CommandUsageError
from arm_cli.output import say, say_document

MODULE = "arm_cli.check_process"
TIMEOUT_S = 60.0
MEMORY_LIMIT_MB = 2000.0
TOLERANCE_RAD = math.radians(1.0)
"""By which an arm may stop earlier than its description says."""


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
    Argument(
        "--port",
        metavar="PORT",
        help="compare the limits of the joints with those that a real arm on this port holds",
    ),
    Argument(
        "--hardware",
        metavar="NAME",
        default="feetech",
        help="the arm on the port: feetech or mycobot_280 (default: %(default)s)",
    ),
    Argument(
        "--calibration", metavar="FILE", default="", help="calibration file of the arm on the port"
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
    if options.port is not None and not answer["code"]:
        given = {"port": options.port, "calibration": options.calibration}
        parameters = {name: value for name, value in given.items() if value}
        about = (options.file, options.arguments, options.package_path)
        say(*compare_limits(*about, options.hardware, parameters))
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


def compare_limits(
    file: str,
    arguments: Sequence[str],
    package_path: str,
    hardware: str,
    parameters: Mapping[str, str],
) -> Iterator[str]:
    """Yield one line for each joint: the ranges of the description and of a real arm on a port.

    Nothing moves.

    Args:
        file: URDF or xacro file.
        arguments: of a xacro file, NAME:=VALUE.
        package_path: folders, separated by colons.
        hardware: as the launch argument of that name.
        parameters: of the hardware, such as its port.

    Raises:
        ArmCliError: the description or the arm cannot be read.
    """
    # Imported here, because a check of a file alone needs none of it.
    from arm_control.errors import ArmControlError
    from arm_control.hardware.info import parse_hardware_info
    from arm_control.manager.registry import create_hardware
    from arm_description.errors import DescriptionError
    from arm_description.urdf.parser import ignore_remark, parse_urdf
    from arm_drivers.errors import DriverError
    from arm_drivers.serial_arm import SerialArm
    from arm_gazebo.errors import GazeboError
    from arm_gazebo.launching.real_hardware import on_hardware
    from arm_gazebo.launching.robot_setup import set_up_robot

    try:
        setup = set_up_robot(file, " ".join(arguments), package_path=package_path)
        text = on_hardware(setup.description, hardware, parameters)
        driver = create_hardware(parse_hardware_info(text)[0])
        if not isinstance(driver, SerialArm):
            raise ArmCliError(f"hardware '{hardware}' holds no limits to compare")
        device = driver.open_device()
        try:
            device.start()
        finally:
            device.close()
    except (ArmControlError, DescriptionError, DriverError, GazeboError) as error:
        raise ArmCliError(str(error)) from error
    limits = {joint.name: joint.limit for joint in parse_urdf(text, remark=ignore_remark).joints}
    for joint, low, high in zip(driver.driven, device.lower, device.upper, strict=True):
        own = limits[joint.name]
        wanted = (-math.inf, math.inf) if own is None else (own.lower, own.upper)
        fits = low <= wanted[0] + TOLERANCE_RAD and high >= wanted[1] - TOLERANCE_RAD
        yield (
            f"{joint.name}: the description has {wanted[0]:.3f} to {wanted[1]:.3f} rad, the arm "
            f"{low:.3f} to {high:.3f} rad{'' if fits else ': it stops earlier'}"
        )
