"""Whatever happens in whatever order: what says active moves when commanded, all else refuses.

The page docs/explanation/states.md has the table that is walked here.
"""

import re
from contextlib import suppress
from pathlib import Path

import numpy as np
import pytest
from hypothesis import Phase, settings
from hypothesis import strategies as st
from hypothesis.stateful import RuleBasedStateMachine, invariant, precondition, rule
from robots import box, link, robot

from arm_control.errors import ArmControlError, ControllerManagerError, StateError
from arm_control.lifecycle import LifecycleState
from arm_control.manager.switch_planner import Strictness, SwitchRequest
from arm_sim import Simulation
from arm_sim.errors import ArmSimError

PAGE = Path(__file__).parents[2] / "docs" / "explanation" / "states.md"

JOINTS = {"a": "arm", "b": "arm", "g": "tool"}
"""The component of each joint."""


def links() -> str:
    """Return turntables side by side: gravity does not move them, so only commands do."""
    moment = '<inertia ixx="0.01" iyy="0.01" izz="0.01" ixy="0" ixz="0" iyz="0"/>'
    parts = ['<link name="world"/>']
    for index, name in enumerate(JOINTS):
        parts.append(
            f'<link name="{name}l"><inertial><mass value="1"/>{moment}</inertial></link>'
            f'<joint name="{name}" type="revolute"><parent link="world"/><child link="{name}l"/>'
            f'<origin xyz="{index} 0 1"/><axis xyz="0 0 1"/><dynamics damping="0.2"/>'
            '<limit lower="-3" upper="3" effort="20" velocity="6"/></joint>'
        )
    return "".join(parts)


def component(name: str) -> str:
    kinds = ("position", "velocity", "effort")
    each = "".join(f'<command_interface name="{kind}"/>' for kind in kinds) + "".join(
        f'<state_interface name="{kind}"/>' for kind in kinds
    )
    joints = "".join(f'<joint name="{j}">{each}</joint>' for j, c in JOINTS.items() if c == name)
    return (
        f'<ros2_control name="{name}" type="system"><hardware><plugin>'
        f"gz_ros2_control/GazeboSimSystem</plugin></hardware>{joints}</ros2_control>"
    )


URDF = f'<robot name="walk">{links()}{component("arm")}{component("tool")}</robot>'

CONTROLLERS = {
    "states": ("joint_state_broadcaster/JointStateBroadcaster", {}),
    "places": ("position_controllers/JointGroupPositionController", {"joints": ["a", "b"]}),
    "speeds": ("velocity_controllers/JointGroupVelocityController", {"joints": ["a"]}),
    "pushes": ("effort_controllers/JointGroupEffortController", {"joints": ["b"]}),
    "path": (
        "joint_trajectory_controller/JointTrajectoryController",
        {
            "joints": ["a", "b"],
            "command_interfaces": ["position"],
            "state_interfaces": ["position", "velocity"],
        },
    ),
    "grip": ("parallel_gripper_action_controller/GripperActionController", {"joint": "g"}),
    "both": (
        "forward_command_controller/ForwardCommandController",
        {"joints": ["b", "g"], "interface_name": "position"},
    ),
    "pid": (
        "pid_controller/PidController",
        {
            "dof_names": ["g"],
            "command_interface": "velocity",
            "reference_and_state_interfaces": ["position"],
            "gains": {"g": {"p": 8.0}},
        },
    ),
    "lead": (
        "forward_command_controller/ForwardCommandController",
        {"joints": ["pid/g"], "interface_name": "position"},
    ),
}
FALLBACKS = {"speeds": ["places"]}

COMPONENTS_OF = {
    "states": set(),
    "places": {"arm"},
    "speeds": {"arm"},
    "pushes": {"arm"},
    "path": {"arm"},
    "grip": {"tool"},
    "both": {"arm", "tool"},
    "pid": {"tool"},
    "lead": {"tool"},
}
PARAMETERS = {
    "controller_manager": {
        "ros__parameters": {
            "update_rate": 50,
            **{
                name: {"type": kind, "fallback_controllers": FALLBACKS.get(name, [])}
                for name, (kind, _) in CONTROLLERS.items()
            },
        }
    },
    **{name: {"ros__parameters": values} for name, (_, values) in CONTROLLERS.items()},
}

BOX = robot(link("box", box("collision")), name="box")
FAR_AWAY = (9.0, 9.0, 0.05)

STILL = 2e-3
"""Largest way of a joint that nobody commands, in rad."""
NEAR = 0.02
"""Largest distance of a joint from where it was commanded, in rad."""


def table() -> dict[tuple[str, str, str], tuple[bool, str]]:
    """Return the manual's table.

    For a controller's state, its hardware's and the stop's: whether its interfaces are claimed, and
    how it refuses; "" if it moves.
    """
    rows = [
        [cell.strip() for cell in line.strip().strip("|").split("|")]
        for line in PAGE.read_text().splitlines()
        if re.match(r"\| (active|unconfigured|inactive)", line)
    ]
    found = {}
    for controllers, hardware, stop, claims, answer in rows:
        refusal = re.search("`(.*)`", answer)
        for controller in controllers.split(", "):
            for component_ in hardware.replace("any", "active, inactive").split(", "):
                for stopped in stop.replace("any", "released, engaged").split(", "):
                    key = controller, component_, stopped
                    found[key] = (claims == "claimed", refusal.group(1) if refusal else "")
    return found


TABLE = table()


def some(names: tuple[str, ...]) -> st.SearchStrategy[tuple[str, ...]]:
    return st.lists(st.sampled_from(names), unique=True, max_size=3).map(tuple)


class Walk(RuleBasedStateMachine):
    """A robot of two components and nine controllers, and whatever may happen to them."""

    def __init__(self) -> None:
        super().__init__()
        self.sim = Simulation(URDF, controllers=PARAMETERS, spawn=())
        self.manager = self.sim.parts.robot.manager
        self.saved = None
        self.boxes: list[str] = []
        self.goals = []
        self.sign = 1.0
        for name in CONTROLLERS:
            self.sim.controllers.load(name)
        self.manager.switch_controller(SwitchRequest(("states", "path", "grip")))

    def teardown(self) -> None:
        self.sim.close()

    # What there is

    def states(self) -> dict[str, str]:
        return {status.name: status.state.label for status in self.manager.list_controllers()}

    def components(self) -> dict[str, str]:
        return {c.name: c.state.label for c in self.manager.list_hardware_components()}

    def loaded(self) -> tuple[str, ...]:
        return tuple(self.states())

    # What happens

    @rule(name=st.sampled_from(tuple(CONTROLLERS)))
    def load(self, name: str) -> None:
        if name in self.loaded():
            with pytest.raises(ArmControlError, match="already loaded"):
                self.sim.controllers.load(name)
        else:
            self.sim.controllers.load(name)

    @rule(name=st.sampled_from(tuple(CONTROLLERS)), step=st.sampled_from(("up", "down", "away")))
    def transit(self, name: str, step: str) -> None:
        if name not in self.loaded():
            return
        parameters = self.sim[name].core.configured_with
        make = {
            "up": lambda: self.manager.configure_controller(name, parameters),
            "down": lambda: self.manager.cleanup_controller(name),
            "away": lambda: self.manager.unload_controller(name),
        }[step]
        if self.states()[name] == "active":
            with pytest.raises(ControllerManagerError, match="active"):
                make()
        else:
            make()

    @rule(
        activate=some(tuple(CONTROLLERS)),
        deactivate=some(tuple(CONTROLLERS)),
        strictness=st.sampled_from((Strictness.STRICT, Strictness.BEST_EFFORT)),
    )
    def switch(self, activate, deactivate, strictness) -> None:
        before = self.states()
        result = self.manager.switch_controller(SwitchRequest(activate, deactivate, strictness))
        if not result.ok:
            assert result.message
            assert self.states() == before

    @rule(name=st.sampled_from(tuple(CONTROLLERS)))
    def activate(self, name: str) -> None:
        self.switch((name,), (), Strictness.STRICT)

    @rule(name=st.sampled_from(tuple(CONTROLLERS)))
    def take_over(self, name: str) -> None:
        """Activate a controller in place of those that hold its interfaces."""
        rivals = {"a": {"places", "speeds", "path"}, "b": {"places", "pushes", "path", "both"}}
        rivals["g"] = {"grip", "both", "pid", "lead"}
        others = {o for group in rivals.values() if name in group for o in group} - {name}
        active = [o for o in sorted(others) if self.states().get(o) == "active"]
        self.switch((name,), tuple(active), Strictness.BEST_EFFORT)

    @rule(
        name=st.sampled_from(("arm", "tool")),
        state=st.sampled_from(
            (*[LifecycleState.ACTIVE] * 3, LifecycleState.INACTIVE, LifecycleState.UNCONFIGURED)
        ),
    )
    def set_hardware(self, name: str, state: LifecycleState) -> None:
        if self.components()[name] == "finalized":
            with pytest.raises(ControllerManagerError, match="finalized"):
                self.manager.set_hardware_component_state(name, state)
        else:
            self.manager.set_hardware_component_state(name, state)
            assert self.components()[name] == state.label

    @precondition(lambda self: self.saved is not None and self.boxes)
    @rule()
    def finalize_hardware(self) -> None:
        self.manager.set_hardware_component_state("tool", LifecycleState.FINALIZED)

    @rule(engaged=st.sampled_from((True, False, False)))
    def stop(self, engaged: bool) -> None:
        self.manager.set_emergency_stop(engaged)
        assert self.manager.emergency_stopped == engaged

    @rule(clock=st.booleans())
    def reset(self, clock: bool) -> None:
        before = self.states()
        self.sim.parts.state.reset(clock)
        assert self.states() == before
        assert self.positions() == pytest.approx(0.0, abs=1e-6)

    @rule()
    def save(self) -> None:
        if self.manager.emergency_stopped:
            with pytest.raises(ArmControlError, match="emergency stop"):
                self.sim.save()
        else:
            self.saved = self.sim.save(), self.states(), self.components()

    @precondition(lambda self: self.saved is not None)
    @rule()
    def restore(self) -> None:
        snapshot, states, components = self.saved
        before = self.states(), self.components()
        with suppress(StateError):
            self.sim.restore(snapshot)
            assert self.components() == components
            assert {name: s for name, s in self.states().items() if name in states} == {
                name: s if s in ("active", "inactive") else before[0][name]
                for name, s in states.items()
            }
            self.boxes = [name for name in self.boxes if name in self.sim.entities]
            return
        assert (self.states(), self.components()) == before

    @rule()
    def spawn(self) -> None:
        x, y, z = FAR_AWAY
        self.boxes.append(self.sim.spawn(BOX, pose=(x + len(self.boxes), y, z)))

    @precondition(lambda self: self.boxes)
    @rule()
    def delete(self) -> None:
        self.sim.delete(self.boxes.pop())

    @rule(name=st.sampled_from(tuple(CONTROLLERS)))
    def fail(self, name: str) -> None:
        if self.states().get(name) == "active":
            self.manager.fail_controller(name, "as asked")
            assert self.states()[name] != "active"

    @rule(where=st.floats(-1.0, 1.0), seconds=st.sampled_from((0.05, 0.2)))
    def begin(self, where: float, seconds: float) -> None:
        """Leave goals running, so that the next happens in the middle of a motion."""
        for status in self.manager.list_controllers():
            name = status.name
            if name in ("path", "grip") and not self.refusal(status):
                start = self.follow if name == "path" else self.grip
                self.goals.append((start(where), where, "ab" if name == "path" else "g"))
        self.sim.run(seconds)

    # What must hold after each of them

    @invariant()
    def agrees(self) -> None:
        self.goals_end_truly()
        self.claims_agree()
        self.nothing_moves_uncommanded()
        self.active_moves_and_all_else_refuses()

    def goals_end_truly(self) -> None:
        """A goal succeeds only where it was to go, and any other end has a reason."""
        for goal, target, joints in self.goals:
            assert self.sim.run_until(lambda goal=goal: goal.done, 5.0)
            if goal.end.outcome.value == "succeeded":
                for joint in joints:
                    assert self.sim.joints[joint].position == pytest.approx(target, abs=NEAR)
            else:
                assert goal.end.message
        self.goals.clear()

    def claims_agree(self) -> None:
        claimed = {name for s in self.manager.list_controllers() for name in s.claimed_interfaces}
        listed = {i.name for i in self.manager.list_hardware_interfaces()[0] if i.is_claimed}
        assert listed == claimed
        available = {i.name for i in self.manager.list_hardware_interfaces()[0] if i.is_available}
        assert claimed <= available

    def nothing_moves_uncommanded(self) -> None:
        self.sim.run(0.4)
        before = self.positions()
        self.sim.run(0.2)
        assert self.positions() == pytest.approx(before, abs=STILL)

    def active_moves_and_all_else_refuses(self) -> None:
        statuses = {s.name: s for s in self.manager.list_controllers() if s.name != "states"}
        refusals = {name: self.refusal(status) for name, status in statuses.items()}
        before = self.positions()
        for name, refusal in refusals.items():
            if refusal:
                self.check_refused(name, refusal)
        self.sim.run(0.2)
        assert self.positions() == pytest.approx(before, abs=STILL)
        for name, refusal in refusals.items():
            if not refusal:
                self.check_moves(name)

    def refusal(self, status) -> str:
        """Return how a controller must refuse commands according to the table; "" if it moves."""
        hardware = self.components()
        states = {hardware[c] for c in COMPONENTS_OF[status.name]}
        stop = "engaged" if self.manager.emergency_stopped else "released"
        if status.state is LifecycleState.ACTIVE:
            assert states <= {"active", "inactive"}
        component_ = "inactive" if "inactive" in states else "active"
        claims, refusal = TABLE[status.state.label, component_, stop]
        assert claims == bool(status.claimed_interfaces)
        if status.is_chained and not refusal:
            return "another controller commands this one"
        return refusal.replace("NAME", "(arm|tool)")

    def check_refused(self, name: str, refusal: str) -> None:
        words = "inactive|unconfigured|finalized|not running"
        pattern = words if refusal == "not active" else refusal
        with pytest.raises((ArmSimError, ArmControlError), match=pattern):
            self.command(name, 0.3)

    def check_moves(self, name: str) -> None:
        self.sim.run(0.3)  # What another controller has moved comes to rest.
        before = self.positions()
        joint = {"speeds": 0, "pushes": 1}.get(name)
        # Speeds and efforts go back to the middle, so that no joint ends at its limit.
        self.sign = -self.sign if joint is None else -float(np.sign(before[joint] or 1.0))
        target = 0.3 * self.sign
        self.command(name, target)
        if name == "speeds":
            self.sim.run(0.3)
            assert (self.positions()[0] - before[0]) * self.sign > 0.02
            self.sim["speeds"].command([0.0])
        elif name == "pushes":
            self.sim.run(0.3)
            assert (self.positions()[1] - before[1]) * self.sign > 0.005
            self.sim["pushes"].command([0.0])
            self.sim.run(1.0)
        elif name in ("path", "grip"):
            assert self.goals[-1][0].result
            self.goals.clear()
            where = [0, 1] if name == "path" else [2]
            assert self.positions()[where] == pytest.approx(target, abs=NEAR)
        else:
            self.sim.run(0.8)
            where = {"places": [0, 1], "both": [1, 2], "pid": [2], "lead": [2]}[name]
            assert self.positions()[where] == pytest.approx(target, abs=NEAR), name

    def command(self, name: str, target: float) -> None:
        if name == "path":
            goal = self.follow(target)
        elif name == "grip":
            goal = self.grip(target)
        else:
            self.sim[name].command([target] * (2 if name in ("places", "both") else 1))
            return
        assert self.sim.run_until(lambda: goal.done, 5.0)
        self.goals.append((goal, target, ""))

    def follow(self, target: float):
        return self.sim["path"].follow({"times_s": [0.5], "positions": [[target] * 2]})

    def grip(self, target: float):
        return self.sim["grip"].grip(target)

    def positions(self) -> np.ndarray:
        return np.array([self.sim.joints[name].position for name in JOINTS])


# Not shrunk: a step takes a second of simulated time, and shrinking thousands of steps.
Walk.TestCase.settings = settings(
    max_examples=8, stateful_step_count=20, phases=(Phase.explicit, Phase.generate)
)
TestWalk = Walk.TestCase
