"""A manager with a joint trajectory controller, and a client of its action."""

import threading
from collections.abc import Callable, Iterator, Sequence
from typing import Any

import pytest

TIMEOUT_S = 30.0
NAME = "joint_trajectory_controller"
JOINTS = ("j0", "j1", "j2", "j3")

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
    """Return a function that makes a message from pairs of time and the joints' positions."""
    from builtin_interfaces.msg import Duration
    from trajectory_msgs.msg import JointTrajectory, JointTrajectoryPoint

    def make(*points: tuple[float, Sequence[float]], joints: Sequence[str] = JOINTS) -> Any:
        return JointTrajectory(
            joint_names=list(joints),
            points=[
                JointTrajectoryPoint(
                    positions=[float(position) for position in positions],
                    time_from_start=Duration(sec=int(time_s), nanosec=round(time_s % 1 * 1e9)),
                )
                for time_s, positions in points
            ],
        )

    return make


class Feedback:
    """A goal's feedback as it arrives."""

    def __init__(self) -> None:
        self.messages: list[Any] = []
        self.come = threading.Event()

    def __call__(self, message: Any) -> None:
        self.messages.append(message.feedback)
        self.come.set()


class Goal:
    """A goal from the sight of its client."""

    def __init__(self, handle: Any, feedback: Feedback) -> None:
        self.feedback = feedback
        self.accepted = handle.accepted
        self._handle = handle
        if handle.accepted:
            self._ended = handle.get_result_async()

    def result(self) -> tuple[int, int, str]:
        """Wait for the end; return status, error code and error string."""
        answer = wait(self._ended)
        return answer.status, answer.result.error_code, answer.result.error_string

    def wait_until_running(self) -> None:
        """Wait for the first feedback: the client hears of its acceptance before the controller."""
        if not self.feedback.come.wait(TIMEOUT_S):
            pytest.fail(f"no feedback within {TIMEOUT_S} s")

    def ended(self) -> bool:
        """Return whether there is a result."""
        return self._ended.done()

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
def send(client: Any, trajectory: Any) -> Iterator[Callable[..., Goal]]:
    """Return a function that sends a goal, given as the points of its trajectory."""
    from control_msgs.action import FollowJointTrajectory
    from rclpy.action.client import ActionClient

    action = ActionClient(client.node, FollowJointTrajectory, f"/{NAME}/follow_joint_trajectory")

    def connect() -> None:
        client.wait_until(action.server_is_ready, "the action")
        # The server may not know of its client yet, and an answer would be lost.
        threading.Event().wait(0.2)

    def send_goal(
        *points: tuple[float, Sequence[float]],
        joints: Sequence[str] = JOINTS,
        **fields: Any,
    ) -> Goal:
        if not action.server_is_ready():
            connect()
        message = FollowJointTrajectory.Goal(trajectory=trajectory(*points, joints=joints))
        for name, value in fields.items():
            setattr(message, name, value)
        feedback = Feedback()
        return Goal(wait(action.send_goal_async(message, feedback)), feedback)

    yield send_goal
    client.executor.create_task(action.destroy)


@pytest.fixture
def active(control: Any) -> Any:
    """Start the controller; return the manager's client."""
    control.start(NAME)
    return control


@pytest.fixture
def states(client: Any) -> Any:
    """Return the controller's states as they are published."""
    from control_msgs.msg import JointTrajectoryControllerState
    from rclpy.qos import DurabilityPolicy, QoSProfile

    latched = QoSProfile(depth=10, durability=DurabilityPolicy.TRANSIENT_LOCAL)
    return client.subscribe(JointTrajectoryControllerState, f"/{NAME}/controller_state", latched)
