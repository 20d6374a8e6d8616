"""Goals and commands while the hardware is set inactive, and after it is active again."""

import pytest

from arm_control.controllers.goals import GoalOutcome
from arm_control.lifecycle import LifecycleState
from arm_sim import Simulation
from arm_sim.errors import CallError, GoalError

ARM = {
    "controller_manager": {
        "ros__parameters": {
            "path": {"type": "joint_trajectory_controller/JointTrajectoryController"},
            "grip": {"type": "parallel_gripper_action_controller/GripperActionController"},
        }
    },
    "path": {
        "ros__parameters": {
            "joints": ["j0", "j1", "j2"],
            "command_interfaces": ["position"],
            "state_interfaces": ["position", "velocity"],
        }
    },
    "grip": {"ros__parameters": {"joint": "j3", "allow_stalling": True}},
}


@pytest.fixture
def sim():
    with Simulation("arm", arguments={"camera": "none"}, controllers=ARM) as simulation:
        yield simulation


def set_hardware(sim: Simulation, state: LifecycleState) -> str:
    manager = sim.parts.robot.manager
    [component] = manager.list_hardware_components()
    manager.set_hardware_component_state(component.name, state)
    return component.name


def test_goals_end_with_the_reason_and_later_ones_are_reached(sim):
    path = sim["path"].follow({"times_s": [1.0], "positions": [[0.6, 0.4, 0.2]]})
    grip = sim["grip"].grip(0.5)
    sim.run(0.1)
    name = set_hardware(sim, LifecycleState.INACTIVE)
    reason = f"hardware component '{name}' is inactive"
    for goal in (path, grip):
        assert goal.end.outcome is GoalOutcome.ABORTED
        assert goal.end.message == f"Goal aborted: {reason}."
    assert not grip.end.stalled
    sim.run(1.0)
    before = sim.joints.position.tolist()
    with pytest.raises(GoalError, match=reason):
        sim.follow("path", {"times_s": [1.0], "positions": [[0.6, 0.4, 0.2]]})
    with pytest.raises(GoalError, match=reason):
        sim.grip("grip", 0.5)
    set_hardware(sim, LifecycleState.ACTIVE)
    sim.run(0.5)
    assert sim.joints.position.tolist() == pytest.approx(before, abs=2e-3)
    sim.follow("path", {"times_s": [1.0], "positions": [[0.6, 0.4, 0.2]]})
    assert sim.grip("grip", 0.5).reached_goal
    assert sim.joints.position.tolist() == pytest.approx([0.6, 0.4, 0.2, 0.5], abs=0.02)


def test_a_command_meanwhile_is_refused_and_the_next_one_is_obeyed():
    with Simulation("arm", arguments={"camera": "none"}) as sim:
        name = set_hardware(sim, LifecycleState.INACTIVE)
        with pytest.raises(CallError, match=f"hardware component '{name}' is inactive"):
            sim["position_controller"].command([0.3] * 4)
        set_hardware(sim, LifecycleState.ACTIVE)
        sim["position_controller"].command([0.3] * 4)
        sim.run(1.0)
        assert sim.joints.position.tolist() == pytest.approx([0.3] * 4, abs=1e-3)
