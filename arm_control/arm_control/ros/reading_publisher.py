"""Publishes numbers of a sensor as a stamped message, for whoever listens."""

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray
from rclpy.publisher import Publisher

from arm_node.message_template import MessageTemplate


class ReadingPublisher:
    """Writes readings into one serialised message. Loop thread.

    Args:
        publisher: of the message's type.
        message: has its final frame and covariances.
        paths: fields that the numbers of a reading go to, in their order.
        first: how many numbers at a reading's start have no place in the message.
    """

    def __init__(
        self, publisher: Publisher, message: Any, paths: Sequence[str], first: int = 0
    ) -> None:
        self._publisher = publisher
        self._template = MessageTemplate(message)
        self._where = np.concatenate([self._template.indices(path) for path in paths])
        self._shown = slice(first, first + len(self._where))

    def wanted(self) -> bool:
        """Return whether anybody subscribes now; about 1 us."""
        return self._publisher.get_subscription_count() > 0

    def publish(self, time_s: float, reading: NDArray[np.float64]) -> None:
        """Publish a reading, shape (n,), stamped with the time of its state."""
        self._template.set_stamps(round(time_s * 1e9))
        self._template.float64[self._where] = reading[self._shown]
        self._template.publish(self._publisher)
