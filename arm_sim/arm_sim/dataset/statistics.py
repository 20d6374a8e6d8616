"""Statistics of features, with which LeRobot normalises the inputs of policies."""

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


def image_statistics(images: Sequence[NDArray[np.uint8]]) -> dict[str, Array]:
    """Return the statistics of images (h, w, 3) by channel, scaled to 0..1, shape (3, 1, 1)."""
    size = max(images[0].shape[:2])
    stride = max(1, size // WANTED_PX) if size >= LARGE_PX else 1
    pixels = np.concatenate([image[::stride, ::stride].reshape(-1, 3) for image in images]) / 255.0
    found = {name: values.reshape(-1, 1, 1) for name, values in statistics_of(pixels).items()}
    found["count"] = np.array([len(images)])
    return found


def merged(episodes: Sequence[Statistics]) -> dict[str, Array]:
    """Return the statistics of several episodes; quantiles are averaged, as in LeRobot."""
    counts = np.array([float(one["count"][0]) for one in episodes])
    shares = counts / counts.sum()

    def mean(values: Sequence[Array]) -> Array:
        return sum((share * one for share, one in zip(shares, values, strict=True)), np.zeros(()))

    overall = mean([one["mean"] for one in episodes])
    spread = mean([one["std"] ** 2 + (one["mean"] - overall) ** 2 for one in episodes])
    return {
        "min": np.min([one["min"] for one in episodes], axis=0),
        "max": np.max([one["max"] for one in episodes], axis=0),
        "mean": overall,
        "std": np.sqrt(spread),
        "count": np.array([int(counts.sum())]),
        **{name: mean([one[name] for one in episodes]) for name in QUANTILES},
    }
