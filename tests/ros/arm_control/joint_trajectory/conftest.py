"""A manager with a joint trajectory controller, and a client of its action."""

import threading
from collections.abc import Callable, Iterator, Sequence
from typing import Any

import pytest
import yaml

TIMEOUT_S = 30.0
NAME = "joint_trajectory_controller"
JOINTS = ("j0", "j1", "j2", "j3")
FIELDS = ("positions", "velocities", "accelerations")

Point = tuple[Any, ...]

CYCLE_S = 0.005
"""Of the simulated arm."""

DECELERATION = 1.0
EFFORT_GAINS = {"j0": (10.0, 0.6), "j1": (10.0, 0.6), "j2": (4.0, 0.2), "j3": (1.0, 0.05)}
"""Proportional and derivative, by the inertia that each joint moves."""

GAINS = {
    "velocity_commands": {j: {"p": 10.0, "ff_velocity_scale": 1.0} for j in JOINTS},
    "effort_commands": {j: {"p": p, "d": d, "i": p} for j, (p, d) in EFFORT_GAINS.items()},
}
COMMANDS = {
    "position_commands": ["position"],
    "velocity_commands": ["velocity"],
    "effort_commands": ["effort"],
    "position_and_effort_commands": ["position", "effort"],
}

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
    from builtin_interfaces.msg import Duration
    from trajectory_msgs.msg import JointTrajectory, JointTrajectoryPoint

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


class Sender:
    """Sends goals, given as the points of their trajectory, to one controller."""

    def __init__(self, client: Any, make_trajectory: Callable[..., Any], name: str) -> None:
        from control_msgs.action import FollowJointTrajectory
        from rclpy.action.client import ActionClient

        self._client = client
        self._make_trajectory = make_trajectory
        self._type = FollowJointTrajectory
        self._is_connected = False
        self._action = ActionClient(client.node, self._type, f"/{name}/follow_joint_trajectory")

    def __call__(
        self,
        *points: Point,
        joints: Sequence[str] = JOINTS,
        **fields: Any,
    ) -> Goal:
        if not self._is_connected:
            self._connect()
        goal = self._type.Goal(trajectory=self._make_trajectory(*points, joints=joints))
        for name, value in fields.items():
            setattr(goal, name, value)
        feedback = Feedback()
        return Goal(wait(self._action.send_goal_async(goal, feedback)), feedback)

    def send_and_forget(self, *points: Point) -> None:
        """Send a goal and wait for nothing; on the thread of the client's executor."""
        goal = self._type.Goal(trajectory=self._make_trajectory(*points, joints=JOINTS))
        self._action.send_goal_async(goal)

    def close(self) -> None:
        self._client.executor.create_task(self._action.destroy)

    def _connect(self) -> None:
        self._is_connected = True
        self._client.wait_until(self._action.server_is_ready, "the action")
        # The server may not know of its client yet, and an answer would be lost.
        threading.Event().wait(0.2)


@pytest.fixture
def sender_to(client: Any, trajectory: Any) -> Iterator[Callable[[str], Sender]]:
    """Return a function that makes a sender of goals to a controller."""
    senders: list[Sender] = []

    def make(name: str) -> Sender:
        senders.append(Sender(client, trajectory, name))
        return senders[-1]

    yield make
    for sender in senders:
        sender.close()


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
    from control_msgs.msg import JointTrajectoryControllerState
    from rclpy.qos import DurabilityPolicy, QoSProfile

    latched = QoSProfile(depth=10, durability=DurabilityPolicy.TRANSIENT_LOCAL)
    return client.subscribe(JointTrajectoryControllerState, f"/{NAME}/controller_state", latched)


def parameters_of(name: str) -> dict[str, Any]:
    limits: dict[str, Any] = {j: {"goal": 0.02, "trajectory": 0.8} for j in JOINTS}
    for limit in limits.values():
        limit["max_deceleration_on_cancel"] = DECELERATION
    return {
        "joints": list(JOINTS),
        "command_interfaces": COMMANDS[name],
        "state_interfaces": ["position", "velocity"],
        "allow_partial_joints_goal": True,
        "gains": GAINS.get(name, {j: {"p": 0.0} for j in JOINTS}),  # rcl reads no empty map
        "constraints": {
            **limits,
            "goal_time": 20.0,
            "stopped_velocity_tolerance": 0.05,
            "decelerate_on_cancel": name == "position_commands",
        },
    }


@pytest.fixture(scope="module")
def simulate(run: Any, tmp_path_factory: pytest.TempPathFactory) -> Callable[[float], Any]:
    """Return a function that starts the arm at a real-time factor, with all the controllers."""
    kind = "joint_trajectory_controller/JointTrajectoryController"
    file = tmp_path_factory.mktemp("parameters") / "controllers.yaml"
    manager = {"update_rate": round(1 / CYCLE_S), **{name: {"type": kind} for name in COMMANDS}}
    nodes = {"controller_manager": manager, **{name: parameters_of(name) for name in COMMANDS}}
    content = {node: {"ros__parameters": parameters} for node, parameters in nodes.items()}
    file.write_text(yaml.dump(content, Dumper=_NoAliases))

    def start(factor: float) -> Any:
        launched = run(
            *("-m", "arm_cli", "launch", "arm_gazebo", "arm_world.launch.py", "camera:=none"),
            *(f"controllers:={file}", f"real_time_factor:={factor}"),
        )
        launched.wait_for_line("arm_gazebo_node is ready")
        return launched

    return start


class _NoAliases(yaml.SafeDumper):
    """rcl reads no YAML aliases."""

    def ignore_aliases(self, data: object) -> bool:
        return True
