"""A manager with a joint trajectory controller, and a client of its action."""

from collections.abc import Callable, Sequence
from typing import Any

import pytest
from builtin_interfaces.msg import Duration
from control_msgs.action import FollowJointTrajectory
from control_msgs.msg import JointTrajectoryControllerState
from rclpy.qos import DurabilityPolicy, QoSProfile
from trajectory_msgs.msg import JointTrajectory, JointTrajectoryPoint

NAME = "joint_trajectory_controller"
JOINTS = ("j0", "j1", "j2", "j3")
FIELDS = ("positions", "velocities", "accelerations")

Point = tuple[Any, ...]

PARAMETERS = {
    "controller_manager": {
        "ros__parameters": {
            "update_rate": 100,
            NAME: {"type": "joint_trajectory_controller/JointTrajectoryController"},
            "position_controller": {"type": "position_controllers/JointGroupPositionController"},
        }
    },
    NAME: {
        "ros__parameters": {
            "joints": list(JOINTS),
            "command_interfaces": ["position"],
            "state_interfaces": ["position", "velocity"],
            "constraints": {"goal_time": 0},
        }
    },
    "position_controller": {"ros__parameters": {"joints": list(JOINTS)}},
}


@pytest.fixture(scope="module")
def manager(run_manager: Any) -> Any:
    """Return the module's manager; tests leave it without controllers."""
    return run_manager(parameters=PARAMETERS)


@pytest.fixture
def trajectory() -> Callable[..., Any]:
    """Return a function that makes a message from points.

    A point is a time and the joints' positions, then perhaps velocities, then accelerations.
    """

    def make(*points: Point, joints: Sequence[str] = JOINTS) -> Any:
        return JointTrajectory(
            joint_names=list(joints),
            points=[
                JointTrajectoryPoint(
                    time_from_start=Duration(sec=int(time_s), nanosec=round(time_s % 1 * 1e9)),
                    **{
                        field: [float(value) for value in values]
                        for field, values in zip(FIELDS, rows, strict=False)
                    },
                )
                for time_s, *rows in points
            ],
        )

    return make


class Goal:
    """A goal whose result is a status, an error code and an error string."""

    def __init__(self, goal: Any) -> None:
        self._goal = goal

    def __getattr__(self, name: str) -> Any:
        return getattr(self._goal, name)

    def result(self) -> tuple[int, int, str]:
        """Wait for the end; return status, error code and error string."""
        answer = self._goal.wait()
        return answer.status, answer.result.error_code, answer.result.error_string


class Sender:
    """Sends goals, given as the points of their trajectory, to one controller."""

    def __init__(self, caller: Any, make_trajectory: Callable[..., Any]) -> None:
        self._caller = caller
        self._make_trajectory = make_trajectory
        self.wait_for_server = caller.wait_for_server

    def __call__(self, *points: Point, joints: Sequence[str] = JOINTS, **fields: Any) -> Goal:
        trajectory = self._make_trajectory(*points, joints=joints)
        return Goal(self._caller.send(trajectory=trajectory, **fields))

    def send_and_forget(self, *points: Point) -> None:
        """Send a goal and wait for nothing; on the thread of the client's executor."""
        self._caller.send_and_forget(trajectory=self._make_trajectory(*points, joints=JOINTS))


@pytest.fixture
def sender_to(action_caller: Any, trajectory: Any) -> Callable[[str], Sender]:
    """Return a function that makes a sender of goals to a controller."""

    def make(name: str) -> Sender:
        caller = action_caller(FollowJointTrajectory, f"/{name}/follow_joint_trajectory")
        return Sender(caller, trajectory)

    return make


@pytest.fixture
def send(sender_to: Callable[[str], Sender]) -> Sender:
    """Return a function that sends a goal to the module's controller."""
    return sender_to(NAME)


@pytest.fixture
def active(control: Any) -> Any:
    """Start the controller; return the manager's client."""
    control.start(NAME)
    return control


@pytest.fixture
def states(client: Any) -> Any:
    """Return the controller's states as they are published."""
    # So deep that an executor which is held up misses none.
    latched = QoSProfile(depth=1000, durability=DurabilityPolicy.TRANSIENT_LOCAL)
    return client.subscribe(JointTrajectoryControllerState, f"/{NAME}/controller_state", latched)
