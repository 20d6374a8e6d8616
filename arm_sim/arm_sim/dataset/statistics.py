"""Statistics of the features of a dataset, with which LeRobot normalises the inputs of policies.

Those of the whole dataset are of all its frames. LeRobot 0.6 averages the quantiles of episodes,
which lie too far inside where the episodes differ (huggingface/lerobot, issue 4156).
"""

from collections.abc import Mapping, Sequence
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Statistics: TypeAlias = Mapping[str, Array]
QUANTILES = {"q01": 0.01, "q10": 0.1, "q50": 0.5, "q90": 0.9, "q99": 0.99}
MOST_IMAGES, FEWEST_IMAGES = 10_000, 100
LARGE_PX, WANTED_PX = 300, 150


def statistics_of(values: NDArray[np.generic]) -> dict[str, Array]:
    """Return the statistics of rows, shape (m, n), each of shape (n,), `count` of shape (1,)."""
    rows = np.asarray(values, dtype=np.float64)
    found = {
        "min": rows.min(axis=0),
        "max": rows.max(axis=0),
        "mean": rows.mean(axis=0),
        "std": rows.std(axis=0),
        "count": np.array([len(rows)]),
    }
    for name, share in QUANTILES.items():
        found[name] = np.quantile(rows, share, axis=0)
    return found


def images_to_sample(count: int) -> NDArray[np.int64]:
    """Return the indices of the images that an episode's statistics use, evenly spread."""
    wanted = max(min(FEWEST_IMAGES, count), min(int(count**0.75), MOST_IMAGES))
    return np.unique(np.round(np.linspace(0, count - 1, wanted)).astype(np.int64))


class ImageCounts:
    """How often each value occurs in each channel of images; the sum of two is that of both."""

    def __init__(self, images: Sequence[NDArray[np.uint8]]) -> None:
        """Count the values of images of shape (h, w, 3), of large ones a part of the pixels."""
        size = max(images[0].shape[:2])
        stride = max(1, size // WANTED_PX) if size >= LARGE_PX else 1
        channels = np.concatenate([image[::stride, ::stride].reshape(-1, 3) for image in images]).T
        self._images = len(images)
        self._counts = np.array([np.bincount(channel, minlength=256) for channel in channels])

    def add(self, other: "ImageCounts") -> None:
        """Count the images of another one, too."""
        self._images += other._images
        self._counts = self._counts + other._counts

    def statistics(self) -> dict[str, Array]:
        """Return the statistics by channel, scaled to 0..1, shape (3, 1, 1)."""
        each = [_statistics_of_bytes(channel) for channel in self._counts]
        found = {name: np.array([one[name] for one in each]).reshape(-1, 1, 1) for name in each[0]}
        found["count"] = np.array([self._images])
        return found


def _statistics_of_bytes(counts: NDArray[np.int64]) -> dict[str, float]:
    """Return the statistics of values k / 255 from how often each k occurs, shape (256,)."""
    values, total, until = np.arange(256) / 255.0, int(counts.sum()), np.cumsum(counts)
    mean = float(counts @ values) / total
    found = {
        "min": float(values[counts > 0][0]),
        "max": float(values[counts > 0][-1]),
        "mean": mean,
        "std": float(np.sqrt(counts @ (values - mean) ** 2 / total)),
    }
    for name, share in QUANTILES.items():
        # Between the two values nearest to the place, as numpy's quantile.
        place = share * (total - 1)
        low, high = np.searchsorted(until, [int(place), int(np.ceil(place))], side="right")
        found[name] = float(values[low] + (place - int(place)) * (values[high] - values[low]))
    return found
