"""A manager with a joint trajectory controller, and a client of its action."""

from collections.abc import Callable, Sequence
from typing import Any

import pytest
import yaml

NAME = "joint_trajectory_controller"
JOINTS = ("j0", "j1", "j2", "j3")
FIELDS = ("positions", "velocities", "accelerations")

Point = tuple[Any, ...]

CYCLE_S = 0.002
"""Of the simulated arm: its links are so light that gains on efforts are unstable at 200 Hz."""

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
    from control_msgs.action import FollowJointTrajectory

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
    from control_msgs.msg import JointTrajectoryControllerState
    from rclpy.qos import DurabilityPolicy, QoSProfile

    # So deep that an executor which is held up misses none.
    latched = QoSProfile(depth=1000, durability=DurabilityPolicy.TRANSIENT_LOCAL)
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
            *("hold_joints:=true", f"controllers:={file}", f"real_time_factor:={factor}"),
        )
        launched.wait_for_line("arm_gazebo_node is ready")
        return launched

    return start


class _NoAliases(yaml.SafeDumper):
    """rcl reads no YAML aliases."""

    def ignore_aliases(self, data: object) -> bool:
        return True
