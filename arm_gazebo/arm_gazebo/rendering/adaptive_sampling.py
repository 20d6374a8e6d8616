"""Fills a picture from few samples, by looking closely only where something changes.

Samples are taken on a coarse lattice. Half-way between two that look alike lies their mean;
between two that differ a sample is taken. Repeated until every pixel is there, that costs a
fraction of a sample per pixel and keeps the edges sharp. What is thinner than the coarse
lattice's step may be missed.
"""

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

Picture = NDArray[np.uint8]
Sample = Callable[[NDArray[np.intp], NDArray[np.intp]], Picture]
"""Returns the colours (n, 3) of the pixels with these rows and columns, (n,) each."""

ALIKE_MASK = 0xF8
"""Two colours look alike when no channel differs in these bits, so by 8 or more of 255."""


def fill_picture(picture: Picture, step: int, sample: Sample) -> None:
    """Fill a picture (height, width, 3).

    Args:
        picture: overwritten.
        step: distance of the first samples in pixels, a power of two; 1 samples every pixel.
        sample: gives colours; it is also asked for pixels up to `step` beyond the right and the
            lower edge.
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
    """Put a column between every two; rows are still 2 * step apart, columns then step."""
    finer = np.empty((level.shape[0], 2 * level.shape[1] - 1, 3), np.uint8)
    finer[:, ::2] = level
    means, differ = _compare(level[:, :-1], level[:, 1:])
    rows, columns = np.nonzero(differ)
    means[rows, columns] = sample(rows * 2 * step, (2 * columns + 1) * step)
    finer[:, 1::2] = means
    return finer


def _insert_rows(level: Picture, step: int, sample: Sample) -> Picture:
    """Put a row between every two; columns are already step apart."""
    finer = np.empty((2 * level.shape[0] - 1, level.shape[1], 3), np.uint8)
    finer[::2] = level
    means, differ = _compare(level[:-1], level[1:])
    rows, columns = np.nonzero(differ)
    means[rows, columns] = sample((2 * rows + 1) * step, columns * step)
    finer[1::2] = means
    return finer


def _compare(a: Picture, b: Picture) -> tuple[Picture, NDArray[np.bool_]]:
    """Return the means of two arrays of colours, and where they do not look alike."""
    means: Picture = (a >> np.uint8(1)) + (b >> np.uint8(1)) + (a & b & np.uint8(1))
    gap = np.maximum(a, b) - np.minimum(a, b)
    return means, ((gap[..., 0] | gap[..., 1] | gap[..., 2]) & ALIKE_MASK).astype(np.bool_)
