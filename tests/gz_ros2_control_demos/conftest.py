"""A demo's robot in the simulation with its controllers, as the launch files set it up; no ROS."""

from collections.abc import Callable

import numpy as np
import pytest

from arm_description.xacro.expansion import arguments_of_text
from arm_sim import Simulation

PACKAGE = "package://gz_ros2_control_demos"


class Demo:
    """One robot, its controllers active, as fast as possible."""

    def __init__(self, model: str, model_args: str, controllers_file: str, base: str) -> None:
        self.sim = Simulation(
            model if "/" in model else f"{PACKAGE}/urdf/{model}",
            controllers=f"{PACKAGE}/config/{controllers_file}",
            arguments=arguments_of_text(model_args),
            base=base,
        )
        self.controllers = {name: handle.core for name, handle in self.sim.controllers.items()}

    def run(self, seconds: float, before_each: Callable[[], object] = lambda: None) -> None:
        """Let time pass; `before_each` is called before each cycle."""
        for _ in range(round(seconds / self.sim.period_s)):
            before_each()
            self.sim.step()

    def position(self, joint: str) -> float:
        """Return where a joint is."""
        return self.sim.joints[joint].position

    def body(self, link: str) -> tuple[np.ndarray, np.ndarray]:
        """Return a link's place in the world, and its rotation matrix."""
        pose = self.sim.pose(link)
        return pose[:3, 3], pose[:3, :3]


@pytest.fixture
def demo() -> type[Demo]:
    return Demo
