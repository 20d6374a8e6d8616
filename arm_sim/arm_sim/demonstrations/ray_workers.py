"""Demonstrations that the processes of a Ray cluster make."""

import math
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from typing import Any

from arm_gazebo.state.made_with import made_with
from arm_sim.demonstrations.pick import Demonstration
from arm_sim.demonstrations.recording import DemonstrationError, make_demonstration
from arm_sim.sweep.ray_head import HeadWatch
from arm_sim.sweep.ray_pool import (
    RayError,
    RayTaskError,
    check_versions,
    join,
    last_line,
    leave,
    ray,
    sentence,
)

POLL_S = 1.0
"""How often the head is looked at while a demonstration is awaited."""


@contextmanager
def ray_workers(
    address: str, most: int | None = None
) -> Iterator[tuple[Callable[[int], "ShownThere"], int]]:
    """Give what starts demonstrations on a cluster, and how many it makes at once.

    Args:
        address: see `RayPool`.
        most: the most at once; None for one on each processor that the cluster has now.

    Raises:
        StudyError: there is no cluster at that address, or it cannot be used.
    """
    head = HeadWatch(join(address, {}))
    try:
        processors = int(min(ray.cluster_resources().get("CPU", 1), most or math.inf))
        # Ray makes a demonstration again if its process is lost.
        make: Any = ray.remote(_make_there).options(num_cpus=1)
        yield lambda seed: ShownThere(make.remote(seed), head), max(1, processors)
    finally:
        leave(head)


class ShownThere:
    """A demonstration that is made on the cluster."""

    def __init__(self, reference: Any, head: HeadWatch) -> None:
        self._answer = reference.future()
        self._head = head

    def result(self) -> Demonstration:
        """Wait for it, and return it.

        Raises:
            DemonstrationError: it cannot be made there; the message says why.
            StudyError: the head of the cluster has gone, or a machine has other versions.
        """
        while True:
            self._head.check()
            try:
                machine, made, shown = self._answer.result(POLL_S)
            except TimeoutError:
                continue
            except RayTaskError as error:
                raise DemonstrationError(
                    f"a process of the Ray cluster cannot demonstrate: {last_line(error)}"
                ) from error
            except RayError as error:
                raise DemonstrationError(
                    f"a process of the Ray cluster was lost: {sentence(error)}"
                ) from error
            check_versions(machine, made)
            return shown


def _make_there(seed: int) -> tuple[str, Mapping[str, str], Demonstration]:
    """Return this machine's address, its versions and the demonstration of a seed."""
    return ray.util.get_node_ip_address(), made_with(), make_demonstration(seed)
