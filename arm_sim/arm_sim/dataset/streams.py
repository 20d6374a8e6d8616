"""The recorded streams of one episode: numbers and images, each with its own stamps."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from arm_sim.errors import CallError

Stamps = NDArray[np.int64]
Images: TypeAlias = "Iterator[NDArray[np.uint8]]"


@dataclass(frozen=True, slots=True)
class Samples:
    """Numbers with their stamps.

    Attributes:
        name: the feature, such as observation.state.
        stamps_ns: strictly increasing, shape (m,).
        values: shape (m, n).
        names: name of each of the n values.
    """

    name: str
    stamps_ns: Stamps
    values: NDArray[np.float32]
    names: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class CameraStream:
    """Images with their stamps.

    Attributes:
        name: the feature, such as observation.images.front.
        stamps_ns: strictly increasing, shape (m,).
        height: in pixels, even.
        width: in pixels, even.
        images: yields the m images in their order, RGB, shape (height, width, 3).
    """

    name: str
    stamps_ns: Stamps
    height: int
    width: int
    images: Callable[[], Images]


Stream: TypeAlias = Samples | CameraStream


def stamp_feature(stream: str) -> str:
    """Return the name of the feature that holds a stream's own stamps.

    Its name contains neither `observation`, because policies take every such feature as an input,
    nor `image`, because the statistics of such features have another shape.
    """
    return f"stamp_ns.{stream.rpartition('.')[2]}"


def check_stream(stream: Stream) -> None:
    """Check a stream.

    Raises:
        CallError: it is empty, its stamps do not increase, or its values are not finite.
    """
    stamps = stream.stamps_ns
    if not len(stamps):
        raise CallError(f"{stream.name} has no messages")
    if (np.diff(stamps) <= 0).any():
        raise CallError(f"the stamps of {stream.name} do not increase")
    if isinstance(stream, Samples):
        if stream.values.shape != (len(stamps), len(stream.names)):
            raise CallError(
                f"{stream.name} has values of the shape {stream.values.shape}, for "
                f"{len(stamps)} stamps and {len(stream.names)} names"
            )
        if not np.isfinite(stream.values).all():
            raise CallError(f"{stream.name} has values that are not finite")
    elif stream.height % 2 or stream.width % 2:
        raise CallError(
            f"{stream.name} is {stream.width} x {stream.height}; video needs even numbers"
        )
