"""Each attribute of a controller is part of its snapshots or declared not to be."""

import ast
import inspect
from collections.abc import Iterator
from functools import cache
from textwrap import dedent

import pytest

from arm_control.controllers import controller as base
from arm_control.controllers.controller import ChainableController, Controller
from arm_control.controllers.joint_trajectory.tracking import TrajectoryTracker
from arm_control.manager.registry import controller_class, controller_types

BY_MANAGER = {"references", "exported_states"}
"""The manager saves these of a chainable controller itself; see `ManagerState`."""
DRIVE = {"_command", "_now_s", "_odometry", "_offered"}
FORWARD = {"_age_s", "_is_stale", "_latest"}
GRIPPER = {"_goal_id", "_seen_position", "_target", "_watch"}
STATE = {
    "DiffDriveController": {*DRIVE, "_angular", "_last_angles", "_linear", "_schedule", "_speeds"},
    "EffortGripperController": {*GRIPPER, "_pid"},
    "ForceTorqueSensorBroadcaster": set(),
    "ForwardCommandController": FORWARD,
    "GpioCommandController": set(),
    "ImuSensorBroadcaster": set(),
    "JointGroupEffortController": FORWARD,
    "JointGroupPositionController": FORWARD,
    "JointGroupVelocityController": FORWARD,
    "JointPositionController": FORWARD,
    "JointStateBroadcaster": set(),
    "MecanumDriveController": DRIVE,
    "MultiInterfaceForwardCommandController": FORWARD,
    "ParallelGripperController": GRIPPER,
    "PidController": {"_last_error", "_measured", "_offered", "_pid", "is_feedforward_enabled"},
    "PositionGripperController": GRIPPER,
    "TrajectoryTracker": {"_active", "_commanded", "_goal", "_next", "_state", "_writer", "time_s"},
}
"""What the snapshots of each class contain, beside what is the same for all chainable ones."""


@cache
def assigned_in(kind: type) -> frozenset[str]:
    """The attributes that the methods of a class set on the object, as its source says."""
    tree = ast.parse(dedent(inspect.getsource(kind)))
    stored = (n for n in ast.walk(tree) if isinstance(n, ast.Attribute))
    return frozenset(
        node.attr
        for node in stored
        if isinstance(node.ctx, ast.Store)
        and isinstance(node.value, ast.Name)
        and node.value.id == "self"
    )


def attributes_of(kind: type) -> Iterator[str]:
    for each in kind.__mro__:
        if each.__module__.startswith("arm_control."):
            yield from assigned_in(each)


def left_out_of(kind: type) -> set[str]:
    own = {name for each in kind.__mro__ for name in vars(each).get("transient", ())}
    return own | set(base._SETTINGS)


CLASSES = {kind.__name__: kind for kind in map(controller_class, controller_types())}
BY_ATTRIBUTES = {
    name: kind
    for name, kind in CLASSES.items()
    if kind.__module__.startswith("arm_control.") and name != "JointTrajectoryController"
}


def undeclared(kind: type, left_out: set[str]) -> set[str]:
    """The attributes for which nobody has decided whether snapshots contain them."""
    return set(attributes_of(kind)) - left_out - STATE.get(kind.__name__, set())


@pytest.mark.parametrize("name", sorted(BY_ATTRIBUTES))
def test_every_attribute_is_state_or_declared_transient(name):
    kind = BY_ATTRIBUTES[name]
    shared = {*BY_MANAGER, "is_chained"} if issubclass(kind, ChainableController) else set()
    left_out = left_out_of(kind)
    assert undeclared(kind, left_out) - shared == set(), "state, or add it to `transient`"
    assert left_out & STATE.get(name, set()) == set()


def test_the_trajectory_controller_saves_its_tracker():
    left_out = set(TrajectoryTracker.transient)
    assert undeclared(TrajectoryTracker, left_out) == set()
    assert STATE["TrajectoryTracker"] & left_out == set()


def test_an_attribute_that_nobody_declared_is_named():
    class Forgetful(Controller):  # pyright: ignore
        transient = ("_queue",)

        def on_activate(self) -> None:
            self._queue, self._speed = [], 0.0

    assert assigned_in(Forgetful) - left_out_of(Forgetful) == {"_speed"}
