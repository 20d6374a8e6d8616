"""The simulated arm with a wall beside its last joint, which gripper controllers drive."""

import threading
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest

TIMEOUT_S = 30.0

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
"""The wall stands in the way of the fingers when j3 leans forward by about half a radian."""


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
        f"world:={folder / 'world.xml'}",
        f"controllers:={folder / 'controllers.yaml'}",
    )
    launched.wait_for_line("[launch] stop: Ctrl-C")  # said once all of it is ready
    return launched


class Goal:
    """A goal from the sight of its client."""

    def __init__(self, handle: Any) -> None:
        self.accepted = handle.accepted
        self._handle = handle
        self._ended = handle.get_result_async() if handle.accepted else None

    def wait(self) -> Any:
        """Wait for the end; return status and result."""
        return wait(self._ended)

    def cancel(self) -> int:
        """Ask for the end; return how many goals are being cancelled."""
        return len(wait(self._handle.cancel_goal_async()).goals_canceling)


def wait(future: Any) -> Any:
    """Block until the client's executor has completed a future; return its result."""
    done = threading.Event()
    future.add_done_callback(lambda _: done.set())
    if not done.wait(TIMEOUT_S):
        pytest.fail(f"no answer within {TIMEOUT_S} s")
    return future.result()


@pytest.fixture
def send_to(client: Any) -> Iterator[Callable[..., Goal]]:
    """Return a function that sends a goal to a controller's action."""
    from rclpy.action.client import ActionClient

    actions: dict[str, ActionClient] = {}

    def send(controller: str, action_type: Any, command: Any) -> Goal:
        action = actions.get(controller)
        if action is None:
            action = ActionClient(client.node, action_type, f"/{controller}/gripper_cmd")
            actions[controller] = action
            client.wait_until(action.server_is_ready, "the action")
            # The server may not know of its client yet, and an answer would be lost.
            threading.Event().wait(0.2)
        return Goal(wait(action.send_goal_async(action_type.Goal(command=command))))

    yield send
    for action in actions.values():
        client.executor.create_task(action.destroy)


@pytest.fixture
def grip(send_to: Any) -> Callable[..., Goal]:
    """Return a function that sends a position and an effort."""
    from control_msgs.action import GripperCommand
    from control_msgs.msg import GripperCommand as Command

    def send(
        position: float, max_effort: float = 0.0, controller: str = "gripper_controller"
    ) -> Goal:
        command = Command(position=position, max_effort=max_effort)
        return send_to(controller, GripperCommand, command)

    return send


@pytest.fixture
def grip_parallel(send_to: Any) -> Callable[..., Goal]:
    """Return a function that sends the fields of a joint state."""
    from control_msgs.action import ParallelGripperCommand
    from sensor_msgs.msg import JointState

    def send(*positions: float, **fields: Any) -> Goal:
        command = JointState(position=positions, **fields)
        return send_to("parallel_gripper", ParallelGripperCommand, command)

    return send
