"""Which devices MuJoCo Warp can use, and what its errors mean, in one sentence each."""

import re
from collections.abc import Iterator
from contextlib import contextmanager
from importlib import import_module
from typing import Any

from arm_gazebo.errors import BatchError, MissingWarpError

GPU, HOST_COMPILED = "cuda", "cpu"
DEVICE = re.compile(rf"{HOST_COMPILED}|{GPU}(:\d+)?")
GIGABYTE = 1e9


def check_device(name: str) -> None:
    """Check that MuJoCo Warp can use a device.

    Args:
        name: "cuda", "cuda:1" or another GPU's number; or "cpu", which compares but is slow.

    Raises:
        BatchError: it is not the name of a device, MuJoCo Warp is not installed, or there is no
            such device.
    """
    if not DEVICE.fullmatch(name):
        raise BatchError(f"no device '{name}'; there are host, cuda, cuda:0, cuda:1 and so on")
    check_installed()
    if name == HOST_COMPILED:
        return
    warp: Any = import_module("warp")
    count = warp.get_cuda_device_count()
    if not count:
        raise BatchError("copies on a GPU need a GPU that CUDA finds, and there is none")
    number = int(name.partition(":")[2] or 0)
    if number >= count:
        existing = ", ".join(f"{GPU}:{each}" for each in range(count))
        raise BatchError(f"no GPU '{name}'; there are {existing}")


def check_installed() -> None:
    """Check that MuJoCo Warp can be imported.

    Raises:
        MissingWarpError: it cannot.
    """
    try:
        import_module("warp")
        import_module("mujoco_warp")
    except ImportError as error:
        raise MissingWarpError(
            f"copies on a GPU need MuJoCo Warp; pip install 'arm-suite[gpu]' ({error})"
        ) from error


@contextmanager
def explained(copies: int, device: str) -> Iterator[None]:
    """Raise what MuJoCo Warp raises on one of its devices as a BatchError that says what it means.

    Raises:
        BatchError: the device has too little memory, or MuJoCo Warp cannot simulate the model.
    """
    try:
        yield
    except (NotImplementedError, ValueError) as error:
        raise BatchError(f"MuJoCo Warp cannot simulate this model: {error}") from error
    except MemoryError as error:
        raise BatchError(f"there is too little memory for {copies} copies: {error}") from error
    except RuntimeError as error:
        if "alloc" not in str(error).lower():
            raise BatchError(f"MuJoCo Warp failed on the device '{device}': {error}") from error
        warp: Any = import_module("warp")
        total = warp.get_device(device).total_memory / GIGABYTE
        raise BatchError(
            f"the device '{device}' has too little memory for {copies} copies; it has {total:.1f} "
            "GB in all"
        ) from error
