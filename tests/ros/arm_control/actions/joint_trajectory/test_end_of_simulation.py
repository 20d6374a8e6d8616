"""The end of a simulation with a trajectory controller."""

from typing import Any

import pytest

pytestmark = pytest.mark.ros


def test_the_end_of_the_simulation_leaves_no_traceback(run: Any) -> None:
    launched = run(
        *("-m", "arm_cli", "launch", "arm_gazebo", "arm_world.launch.py", "camera:=none"),
        "spawn:=joint_trajectory_controller",
    )
    launched.wait_for_line("[launch] stop: ")  # Everything has started.
    assert launched.stop() == 0
    assert "Traceback" not in launched.output
