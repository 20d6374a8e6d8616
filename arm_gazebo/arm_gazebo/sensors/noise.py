"""Gaussian noise on sensor readings."""

import zlib

import numpy as np
from numpy.typing import NDArray

from arm_gazebo.sensors.tags import SensorTags
from arm_node.frozen import frozen

BANK_SIZE = 1 << 16
STRIDE = 40503
"""Odd, so that every offset in the bank is used once before any repeats; near the golden ratio."""
TYPES = ("none", "gaussian", "gaussian_quantized")
NUMBERS = (
    *("mean", "stddev", "bias_mean", "bias_stddev", "precision"),
    *("dynamic_bias_stddev", "dynamic_bias_correlation_time"),
)
"""What SDF writes in a noise."""


@frozen
class NoiseModel:
    """The noise of one value as described, in the value's unit.

    Attributes:
        mean: mean of the noise that is drawn for each reading.
        stddev: its standard deviation.
        bias_mean: mean of the bias that is drawn once a run, with a random sign.
        bias_stddev: its standard deviation.
    """

    mean: float = 0.0
    stddev: float = 0.0
    bias_mean: float = 0.0
    bias_stddev: float = 0.0

    @property
    def is_silent(self) -> bool:
        """Whether there is no noise at all."""
        return self == NoiseModel()


SILENT = NoiseModel()


def noise_type(tags: SensorTags, tag: str) -> str:
    """Return the type of the noise at a path below a sensor; SDF allows an attribute as well.

    Raises:
        SensorError: there is no such type.
    """
    kind = tags.attribute(tag, "type") or tags.choice(f"{tag}/type", TYPES)
    if kind not in TYPES:
        raise tags.error(tag, f"type {kind!r} is not one of {', '.join(TYPES)}")
    if kind == "none":
        tags.ignore(*(f"{tag}/{name}" for name in NUMBERS))
    return kind


def read_noise(tags: SensorTags, where: str) -> NoiseModel:
    """Return the noise described at a path below a sensor, such as `angular_velocity/x`.

    Raises:
        SensorError: the noise is invalid.
    """
    tag = f"{where}/noise"
    if noise_type(tags, tag) == "none":
        return SILENT

    def number(name: str, least: float, must_be: str) -> float:
        return tags.number(f"{tag}/{name}", 0.0, lambda v: v >= least, must_be)

    return NoiseModel(
        mean=number("mean", -np.inf, "a number"),
        stddev=number("stddev", 0.0, "at least 0"),
        bias_mean=number("bias_mean", -np.inf, "a number"),
        bias_stddev=number("bias_stddev", 0.0, "at least 0"),
    )


class SensorNoise:
    """The noise of all values of a sensor in one run.

    The noise depends only on the seed, the sensor's name and the number of the state, so the same
    run gives the same readings whoever subscribes.
    """

    def __init__(self, models: tuple[NoiseModel, ...], name: str, seed: int) -> None:
        random = np.random.default_rng((zlib.crc32(name.encode()), seed & (2**64 - 1)))
        count = len(models)
        bias = np.array([model.bias_mean for model in models])
        bias += random.standard_normal(count) * [model.bias_stddev for model in models]
        sign = random.choice([-1.0, 1.0], count)
        self._offset = bias * sign + [model.mean for model in models]
        self._stddev = np.array([model.stddev for model in models])
        self._bank = random.standard_normal(BANK_SIZE + count)

    def add_to(self, values: NDArray[np.float64], state_number: int) -> None:
        """Add the noise of one state to the sensor's values, in place."""
        start = state_number * STRIDE % BANK_SIZE
        values += self._offset + self._stddev * self._bank[start : start + len(values)]
