"""Trajectories of the simulated arm, by every kind of command, as fast as they can be simulated."""

from collections.abc import Callable
from typing import Any

import pytest
import yaml
from control_msgs.srv import QueryTrajectoryState

STILL = (0.0, 0.0, 0.0, 0.0)
HOME = (0.0, 0.0, 0.0, 0.0)
THERE = (0.4, 0.3, 0.2, 0.3)
REACHED = (4, 0, "Goal successfully reached!")
JOINTS = ("j0", "j1", "j2", "j3")
CYCLE_S = 0.002
"""Of the simulated arm: its links are so light that gains on efforts are unstable at 200 Hz."""

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


def parameters_of(name: str) -> dict[str, Any]:
    limits = {joint: {"goal": 0.02, "trajectory": 0.8} for joint in JOINTS}
    return {
        "joints": list(JOINTS),
        "command_interfaces": COMMANDS[name],
        "state_interfaces": ["position", "velocity"],
        "gains": GAINS.get(name, {j: {"p": 0.0} for j in JOINTS}),  # rcl reads no empty map
        "constraints": {**limits, "goal_time": 20.0, "stopped_velocity_tolerance": 0.05},
    }


class _NoAliases(yaml.SafeDumper):
    """rcl reads no YAML aliases."""

    def ignore_aliases(self, data: object) -> bool:
        return True


def seconds(time: Any) -> float:
    return time.sec + time.nanosec * 1e-9


@pytest.fixture(scope="module")
def manager(run, tmp_path_factory):
    """Return the simulated arm as fast as it can be, with all the controllers."""
    kind = "joint_trajectory_controller/JointTrajectoryController"
    file = tmp_path_factory.mktemp("parameters") / "controllers.yaml"
    manager = {"update_rate": round(1 / CYCLE_S), **{name: {"type": kind} for name in COMMANDS}}
    nodes = {"controller_manager": manager, **{name: parameters_of(name) for name in COMMANDS}}
    content = {node: {"ros__parameters": parameters} for node, parameters in nodes.items()}
    file.write_text(yaml.dump(content, Dumper=_NoAliases))
    launched = run(
        *("-m", "arm_cli", "launch", "arm_gazebo", "arm_world.launch.py", "camera:=none"),
        *("hold_joints:=true", f"controllers:={file}", "real_time_factor:=0.0"),
    )
    launched.wait_for_line("arm_gazebo_node is ready")
    return launched


@pytest.fixture
def measured(client) -> Callable[[str], list[float]]:
    """Return a function that asks a controller where the joints are."""

    def ask(name: str) -> list[float]:
        service = f"/{name}/query_state"
        # There is no trajectory at time 0, and the answer then tells where the joints are.
        answer = client.call(QueryTrajectoryState, service, QueryTrajectoryState.Request())
        return list(answer.position)

    return ask


@pytest.mark.parametrize("name", COMMANDS)
def test_a_goal_is_reached(control, sender_to, measured, name):
    control.start(name)
    send = sender_to(name)
    for target in (THERE, HOME):
        assert send((1.0, target, STILL, STILL)).result() == REACHED
        assert measured(name) == pytest.approx(list(target), abs=0.05)


def test_feedback_follows_simulation_time(control, sender_to):
    control.start("position_commands")
    goal = sender_to("position_commands")((1.0, THERE), (10.0, HOME))
    assert goal.result() == REACHED
    messages = goal.feedback.wait_for(1)
    ages = [seconds(m.header.stamp) - seconds(m.desired.time_from_start) for m in messages]
    assert ages == pytest.approx([ages[0]] * len(ages), abs=1e-6)
    assert seconds(messages[-1].desired.time_from_start) <= 10.0 + 1e-6
