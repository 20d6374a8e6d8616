"""What the bits of a run depend on: versions, processor, mathematical library."""

import os
import platform
from collections.abc import Mapping
from importlib.metadata import PackageNotFoundError, version

import mujoco
import numpy as np


def made_with() -> dict[str, str]:
    """Return what the bits of a run depend on: versions, processor, mathematical library."""
    return {
        "arm-suite": _version("arm-suite"),
        "mujoco": mujoco.__version__,
        "numpy": np.__version__,
        "python": platform.python_version(),
        "machine": platform.machine(),
        "processor": _processor(),
        "libc": " ".join(platform.libc_ver()),
    }


def machine_differences(recorded: Mapping[str, str]) -> list[str]:
    """Return a phrase for each way in which this machine differs from that of a recording."""
    here = made_with()
    return [
        f"{key} {recorded.get(key, 'unknown')} (here {here[key]})"
        for key in here
        if recorded.get(key) != here[key]
    ]


def _version(distribution: str) -> str:
    try:
        return version(distribution)
    except PackageNotFoundError:
        return "unknown"


def _processor() -> str:
    if os.path.exists("/proc/cpuinfo"):
        with open("/proc/cpuinfo", encoding="utf-8") as file:
            for line in file:
                if line.startswith("model name"):
                    return line.partition(":")[2].strip()
    return platform.processor()
