"""Fill an image from few samples, with more samples only where something changes.

Samples are first taken on a coarse lattice. A point between two similar samples gets their mean; a
point between two different samples is sampled. Repeating this until every pixel is filled costs a
fraction of a sample per pixel and keeps edges sharp. Objects thinner than the coarse lattice's step
may be missed.
"""

import math
from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

FIRST_SAMPLES = 45_000
"""Limit on the lattice rays of the first image; later images adapt to the time it took."""
MAX_STEP = 8
AVERAGED_FRAMES = 10
AFFORDABLE = 0.8
"""Fraction of the frame period that rendering may take."""
FINER_COST = 4.0
"""Halving the step multiplies the number of rays by at most this factor."""


class SamplingStep:
    """The step of the coarse lattice in pixels, a power of two, for one camera.

    For a camera with a rate of 0, whose next image nobody waits for, every pixel is cast.

    Attributes:
        step: the step for the next image.
    """

    def __init__(self, width: int, height: int, rate_hz: float) -> None:
        self.step = 1
        self._affordable_s = AFFORDABLE / rate_hz if rate_hz else math.inf
        while rate_hz and self.step < MAX_STEP and width * height > FIRST_SAMPLES * self.step**2:
            self.step *= 2
        self._start_average()

    def note(self, duration_s: float) -> None:
        """Adapt the step to the time in s that an image took to render."""
        self._sum_s += duration_s
        self._count += 1
        if self._count < AVERAGED_FRAMES:
            return
        mean_s = self._sum_s / self._count
        if mean_s > self._affordable_s and self.step < MAX_STEP:
            self.step *= 2
        elif mean_s * FINER_COST < self._affordable_s and self.step > 1:
            self.step //= 2
        self._start_average()

    def _start_average(self) -> None:
        self._sum_s = 0.0
        self._count = 0


Picture = NDArray[np.uint8]
Sample = Callable[[NDArray[np.intp], NDArray[np.intp]], Picture]
"""Returns the colours (n, 3) of the pixels with these rows and columns, (n,) each."""

ALIKE_MASK = 0xF8
"""Two colours are similar if no channel differs in these bits, that is by 8 or more of 255."""


def fill_picture(picture: Picture, step: int, sample: Sample) -> None:
    """Fill an image (height, width, 3).

    Args:
        picture: the image, which is overwritten.
        step: step of the coarse lattice in pixels, a power of two; 1 samples every pixel.
        sample: returns colours; it is also called for pixels up to `step` beyond the right and
            lower edges.
    """
    height, width, _ = picture.shape
    rows, columns = (np.arange(0, size - 1 + step, step) for size in (height, width))
    level = _sample_lattice(rows, columns, sample)
    while step > 1:
        step //= 2
        level = _insert_columns(level, step, sample)
        level = _insert_rows(level, step, sample)
    np.copyto(picture, level[:height, :width])


def _sample_lattice(rows: NDArray[np.intp], columns: NDArray[np.intp], sample: Sample) -> Picture:
    colours = sample(np.repeat(rows, len(columns)), np.tile(columns, len(rows)))
    return colours.reshape(len(rows), len(columns), 3)


def _insert_columns(level: Picture, step: int, sample: Sample) -> Picture:
    """Insert a column between every two; rows stay 2 * step apart, columns become step apart."""
    finer = np.empty((level.shape[0], 2 * level.shape[1] - 1, 3), np.uint8)
    finer[:, ::2] = level
    means, differ = _compare(level[:, :-1], level[:, 1:])
    rows, columns = np.nonzero(differ)
    means[rows, columns] = sample(rows * 2 * step, (2 * columns + 1) * step)
    finer[:, 1::2] = means
    return finer


def _insert_rows(level: Picture, step: int, sample: Sample) -> Picture:
    """Insert a row between every two; columns are already step apart."""
    finer = np.empty((2 * level.shape[0] - 1, level.shape[1], 3), np.uint8)
    finer[::2] = level
    means, differ = _compare(level[:-1], level[1:])
    rows, columns = np.nonzero(differ)
    means[rows, columns] = sample((2 * rows + 1) * step, columns * step)
    finer[1::2] = means
    return finer


def _compare(a: Picture, b: Picture) -> tuple[Picture, NDArray[np.bool_]]:
    """Return the means of two arrays of colours, and a mask of where they are not similar."""
    means: Picture = (a >> np.uint8(1)) + (b >> np.uint8(1)) + (a & b & np.uint8(1))
    gap = np.maximum(a, b) - np.minimum(a, b)
    return means, ((gap[..., 0] | gap[..., 1] | gap[..., 2]) & ALIKE_MASK).astype(np.bool_)
