"""Images as messages bring them: the colours to show, and the value of a pixel."""

import math
from typing import Any

import cv2
import numpy as np
from numpy.typing import NDArray

from arm_viewer.errors import PictureError
from arm_viewer.snapshot import Picture

_CHANNELS = {
    "rgb8": (np.uint8, 3),
    "bgr8": (np.uint8, 3),
    "rgba8": (np.uint8, 4),
    "bgra8": (np.uint8, 4),
    "mono8": (np.uint8, 1),
    "8UC1": (np.uint8, 1),
    "mono16": (np.uint16, 1),
    "16UC1": (np.uint16, 1),
    "32FC1": (np.float32, 1),
}
"""Type and number of a pixel's values, by encoding."""
_METRES = {"16UC1": 1e-3, "32FC1": 1.0}
"""Unit of depth images (REP 118), by encoding. Near points are red, far points blue, unknown ones
black."""
SCALE_STEPS = 12


def colours(picture: Picture, widest: int | None = None) -> NDArray[np.uint8]:
    """Return the image (h, w, 3), each n-th pixel if it is wider than `widest`.

    Raises:
        PictureError: the encoding is unknown, or there is too little data.
    """
    pixels = _pixels(picture)
    if widest is not None:
        every = -(-picture.width // widest)
        pixels = pixels[::every, ::every]
    encoding = picture.encoding
    if encoding in _METRES:
        return _distance_colours(pixels[:, :, 0].astype(np.float64))
    if encoding == "mono16":
        pixels = (pixels >> 8).astype(np.uint8)
    if encoding.startswith("bgr"):
        pixels = pixels[:, :, 2::-1]
    elif pixels.shape[2] == 1:
        pixels = np.repeat(pixels, 3, axis=2)
    return np.ascontiguousarray(pixels[:, :, :3])


def depth_range(picture: Picture) -> tuple[float, float] | None:
    """Return the smallest and the largest distance in m; None without one, or without depth.

    Raises:
        PictureError: there is too little data.
    """
    if picture.encoding not in _METRES:
        return None
    distances = _pixels(picture)[:, :, 0].astype(np.float64)
    known = distances[_is_known(distances)]
    if not len(known):
        return None
    unit_m = _METRES[picture.encoding]
    return float(known.min()) * unit_m, float(known.max()) * unit_m


def value_at(picture: Picture, column: int, row: int) -> str:
    """Return what a pixel says, in words; empty outside of the picture.

    Raises:
        PictureError: the encoding is unknown, or there is too little data.
    """
    if not (0 <= column < picture.width and 0 <= row < picture.height):
        return ""
    values = _pixels(picture)[row, column].tolist()
    encoding = picture.encoding
    if encoding in _METRES:
        distance = values[0] * _METRES[encoding]
        if math.isinf(distance):
            # REP 117: beyond what the sensor reaches, or too near for it.
            return "too far" if distance > 0.0 else "too near"
        return f"{distance:.3f} m" if distance > 0.0 else "unknown"
    if len(values) == 1:
        return f"grey {values[0]}"
    if encoding.startswith("bgr"):
        values[:3] = values[2::-1]
    return " ".join(f"{name} {value}" for name, value in zip("RGBA", values, strict=False))


def depth_scale() -> list[str]:
    """Return the colours of depth images from near to far, as CSS has them."""
    ramp = np.linspace(1.0, 2.0, SCALE_STEPS)[None, :]
    return [f"rgb({r} {g} {b})" for r, g, b in _distance_colours(ramp)[0].tolist()]


def _is_known(distances: NDArray[np.float64]) -> NDArray[np.bool_]:
    return np.isfinite(distances) & (distances > 0.0)


def _pixels(picture: Picture) -> NDArray[Any]:
    if picture.encoding not in _CHANNELS:
        known = ", ".join(_CHANNELS)
        raise PictureError(f"cannot show the encoding '{picture.encoding}'; known: {known}")
    kind, channels = _CHANNELS[picture.encoding]
    kind = np.dtype(kind).newbyteorder(">" if picture.is_bigendian else "<")
    row = picture.width * channels * kind.itemsize
    if not 0 < row <= picture.step or not picture.height:
        raise PictureError(
            f"an image of {picture.width}x{picture.height} pixels of {picture.encoding} cannot "
            f"have rows of {picture.step} bytes"
        )
    if picture.data.size < picture.height * picture.step:
        raise PictureError(
            f"an image with {picture.height} rows of {picture.step} bytes has only "
            f"{picture.data.size} bytes"
        )
    rows = picture.data[: picture.height * picture.step].reshape(picture.height, picture.step)
    values = np.ascontiguousarray(rows[:, :row]).view(kind)
    return values.reshape(picture.height, picture.width, channels)


def _distance_colours(distances: NDArray[np.float64]) -> NDArray[np.uint8]:
    known = _is_known(distances)
    if not known.any():
        return np.zeros((*distances.shape, 3), dtype=np.uint8)
    nearest, farthest = distances[known].min(), distances[known].max()
    seen = np.where(known, distances, farthest)
    share = (farthest - seen) / max(farthest - nearest, 1e-6)
    coloured = cv2.applyColorMap((share * 255.0).astype(np.uint8), cv2.COLORMAP_TURBO)
    coloured[~known] = 0
    return np.ascontiguousarray(coloured[:, :, ::-1], dtype=np.uint8)
