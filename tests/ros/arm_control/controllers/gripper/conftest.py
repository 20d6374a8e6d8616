"""The simulated arm with a wall beside its last joint, which gripper controllers drive."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from sensor_msgs.msg import JointState

CONTROLLERS = """\
controller_manager:
  ros__parameters:
    update_rate: 100
    gripper_controller:
      type: position_controllers/GripperActionController
    effort_gripper:
      type: effort_controllers/GripperActionController
    parallel_gripper:
      type: parallel_gripper_action_controller/GripperActionController
gripper_controller:
  ros__parameters: {joint: j3, stall_timeout: 0.3, max_effort: 100.0}
effort_gripper:
  ros__parameters:
    joint: j3
    goal_tolerance: 0.05
    max_effort: 3.0
    stall_timeout: 0.5
    stall_velocity_threshold: 0.02
    gains:
      j3: {p: 1.5, i: 2.0, d: 0.1, i_clamp: 1.0}
parallel_gripper:
  ros__parameters: {joint: j3, stall_timeout: 0.3}
"""

WORLD = """\
<mujoco>
  <worldbody>
    <light pos="0 0 3"/>
    <geom type="plane" size="2 2 0.1"/>
    <geom name="wall" type="box" size="0.2 0.01 0.1" pos="0 -0.09 0.5"/>
  </worldbody>
</mujoco>
"""
"""The wall stops the fingers when j3 leans forward by about half a radian."""


@pytest.fixture(scope="module")
def manager(run: Any, tmp_path_factory: pytest.TempPathFactory) -> Any:
    """Return the module's simulation; tests leave it without controllers."""
    folder: Path = tmp_path_factory.mktemp("gripper")
    (folder / "controllers.yaml").write_text(CONTROLLERS)
    (folder / "world.xml").write_text(WORLD)
    launched = run(
        "-m",
        "arm_cli",
        "launch",
        "arm_gazebo",
        "arm_world.launch.py",
        "camera:=none",
        "hold_joints:=true",
        f"world:={folder / 'world.xml'}",
        f"controllers:={folder / 'controllers.yaml'}",
    )
    launched.wait_for_line("[launch] stop: Ctrl-C")  # said once all of it is ready
    return launched


@pytest.fixture
def caller_of(action_caller: Any) -> Callable[[str], Any]:
    """Return a function that returns the client of a controller's action."""
    from control_msgs.action import GripperCommand, ParallelGripperCommand

    callers: dict[str, Any] = {}

    def find(controller: str) -> Any:
        if controller not in callers:
            is_parallel = controller == "parallel_gripper"
            action_type = ParallelGripperCommand if is_parallel else GripperCommand
            callers[controller] = action_caller(action_type, f"/{controller}/gripper_cmd")
        return callers[controller]

    return find


@pytest.fixture
def grip(caller_of: Callable[[str], Any]) -> Callable[..., Any]:
    """Return a function that sends a position and an effort."""
    from control_msgs.msg import GripperCommand

    def send(
        position: float, max_effort: float = 0.0, controller: str = "gripper_controller"
    ) -> Any:
        command = GripperCommand(position=position, max_effort=max_effort)
        return caller_of(controller).send(command=command)

    return send


@pytest.fixture
def grip_parallel(caller_of: Callable[[str], Any]) -> Callable[..., Any]:
    """Return a function that sends the fields of a joint state."""

    def send(*positions: float, **fields: Any) -> Any:
        return caller_of("parallel_gripper").send(command=JointState(position=positions, **fields))

    return send
