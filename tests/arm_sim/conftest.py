"""A light simulated arm."""

from collections.abc import Iterator

import pytest

from arm_sim import Simulation


@pytest.fixture
def sim() -> Iterator[Simulation]:
    with Simulation("arm", arguments={"camera": "none"}) as simulation:
        yield simulation
