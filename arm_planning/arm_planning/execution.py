"""The controllers for a trajectory, chosen by MoveIt's rules, and the settings of execution."""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from enum import Enum
from itertools import combinations

from arm_node.names import describe_known, listing
from arm_planning.errors import ControlError
from arm_planning.setting_values import number, switch
from arm_planning.trajectory import TimedTrajectory

EXECUTION = "trajectory_execution"
"""What the names of these parameters begin with."""
MONITORING = "execution_duration_monitoring"


class ControllerKind(Enum):
    """What a controller's action is, by the type in moveit_controllers.yaml."""

    FOLLOW_JOINT_TRAJECTORY = "FollowJointTrajectory"
    GRIPPER_COMMAND = "GripperCommand"
    PARALLEL_GRIPPER_COMMAND = "ParallelGripperCommand"


@dataclass(frozen=True, slots=True)
class TrajectoryController:
    """A controller with an action that takes a trajectory or its end.

    Attributes:
        name: its name.
        action: name of its action below the controller's name.
        kind: its action's type.
        joints: the joints that it drives.
        is_default: whether it is preferred to others of the same joints.
        max_effort: effort for a gripper's goals, N or N m.
        stall_is_success: whether a gripper that is stopped by a thing has reached its goal.
        duration_scaling: how many times its planned duration a motion may take.
        duration_margin_s: and how much longer.
    """

    name: str
    action: str
    kind: ControllerKind
    joints: tuple[str, ...]
    is_default: bool = False
    max_effort: float = 0.0
    stall_is_success: bool = False
    duration_scaling: float | None = None
    duration_margin_s: float | None = None

    @property
    def action_name(self) -> str:
        """The action's name, relative to the namespace."""
        return f"{self.name}/{self.action}" if self.action else self.name


@dataclass(frozen=True, slots=True)
class ExecutionSettings:
    """The values below `trajectory_execution`, with MoveIt's defaults.

    Attributes:
        duration_scaling: how many times its planned duration a motion may take.
        duration_margin_s: and how much longer, in the robot's time.
        start_tolerance: how far each joint may be from the first point, rad or m; 0 switches the
            check off.
        monitors_duration: whether a motion that takes longer is stopped.
    """

    duration_scaling: float = 1.1
    duration_margin_s: float = 0.5
    start_tolerance: float = 0.01
    monitors_duration: bool = True

    @classmethod
    def read(cls, values: Mapping[str, object]) -> "ExecutionSettings":
        """Return the settings of parameters named as in MoveIt; missing ones have defaults.

        Raises:
            SettingError: a value has the wrong type or sign.
        """
        default = cls()

        def least_0(name: str, otherwise: float) -> float:
            return number(f"{EXECUTION}.{name}", values.get(name, otherwise), least=0.0)

        return cls(
            least_0("allowed_execution_duration_scaling", default.duration_scaling),
            least_0("allowed_goal_duration_margin", default.duration_margin_s),
            least_0("allowed_start_tolerance", default.start_tolerance),
            switch(f"{EXECUTION}.{MONITORING}", values.get(MONITORING, default.monitors_duration)),
        )

    def longest_s(self, duration_s: float, controller: TrajectoryController) -> float:
        """Return how long a controller may take for a motion of a duration, in s."""
        scaling, margin_s = controller.duration_scaling, controller.duration_margin_s
        scaling = self.duration_scaling if scaling is None else scaling
        return duration_s * scaling + (self.duration_margin_s if margin_s is None else margin_s)


def controllers_of_settings(settings: Mapping[str, object]) -> list[TrajectoryController]:
    """Return the controllers of moveit_controllers.yaml.

    Args:
        settings: the values below moveit_simple_controller_manager, with dotted names.

    Raises:
        PlanningError: a controller has no joints or an unknown type, or a value cannot be used.
    """
    names = settings.get("controller_names", ())
    if isinstance(names, str) or not isinstance(names, Sequence):
        raise ControlError(
            "moveit_simple_controller_manager.controller_names is not a list of names"
        )
    return [_controller(str(name), settings) for name in names]


def choose_controllers(
    controllers: Sequence[TrajectoryController], joints: Sequence[str], names: Sequence[str] = ()
) -> tuple[TrajectoryController, ...]:
    """Return the fewest controllers that together drive all joints, none of them twice.

    Args:
        controllers: all that there are.
        joints: the joints to drive.
        names: the only controllers to use; empty for any.

    Raises:
        PlanningError: CONTROL_FAILED: a name is unknown, or no controllers drive all joints.
    """
    known = {controller.name: controller for controller in controllers}
    for name in names:
        if name not in known:
            raise ControlError(f"Controller {name} is not known; {describe_known(name, known)}")
    usable = [known[name] for name in names] if names else list(controllers)
    wanted = set(joints)
    relevant = [controller for controller in usable if wanted.intersection(controller.joints)]
    for chosen in _by_preference(relevant):
        driven = [joint for controller in chosen for joint in controller.joints]
        if wanted <= set(driven) and len(driven) == len(set(driven)):
            return chosen
    raise ControlError(_nobody_drives(wanted, controllers))


def part_for(trajectory: TimedTrajectory, controller: TrajectoryController) -> TimedTrajectory:
    """Return the columns of a trajectory that a controller drives, in the trajectory's order."""
    columns = [i for i, joint in enumerate(trajectory.joints) if joint in controller.joints]
    return TimedTrajectory(
        tuple(trajectory.joints[i] for i in columns),
        trajectory.times_s,
        trajectory.positions[:, columns],
        trajectory.velocities[:, columns],
        trajectory.accelerations[:, columns],
    )


def _by_preference(
    controllers: Sequence[TrajectoryController],
) -> Iterator[tuple[TrajectoryController, ...]]:
    ranked = sorted(controllers, key=lambda controller: not controller.is_default)
    for count in range(1, len(ranked) + 1):
        yield from combinations(ranked, count)


def _nobody_drives(wanted: Iterable[str], controllers: Sequence[TrajectoryController]) -> str:
    driven = {joint for controller in controllers for joint in controller.joints}
    missing = sorted(set(wanted) - driven)
    joints = " ".join(sorted(wanted))
    sentence = (
        f"Unable to identify any set of controllers that can actuate the joints: [ {joints} ]"
    )
    if missing:
        sentence += f"; no active controller drives {listing(missing)}"
    known = listing(f"{each.name} ({listing(each.joints)})" for each in controllers)
    return (
        f"{sentence}; the known controllers are {known}: activate one that drives these joints, "
        "such as a joint_trajectory_controller, or name it in moveit_controllers.yaml"
    )


def _controller(name: str, settings: Mapping[str, object]) -> TrajectoryController:
    prefix = f"{name}."
    own = {
        key.removeprefix(prefix): value for key, value in settings.items() if key.startswith(prefix)
    }
    kinds = {kind.value: kind for kind in ControllerKind}
    kind = kinds.get(str(own.get("type", "")))
    if kind is None:
        raise ControlError(
            f"controller '{name}' of moveit_simple_controller_manager has the type "
            f"'{own.get('type', '')}'; there are {listing(kinds)}"
        )
    joints = own.get("joints", ())
    if not isinstance(joints, Sequence) or isinstance(joints, str) or not joints:
        raise ControlError(f"controller '{name}' of moveit_simple_controller_manager has no joints")
    full = f"moveit_simple_controller_manager.{prefix}"
    return TrajectoryController(
        name,
        str(own.get("action_ns", "")),
        kind,
        tuple(map(str, joints)),
        is_default=switch(f"{full}default", own.get("default", False)),
        max_effort=number(f"{full}max_effort", own.get("max_effort", 0.0)),
        stall_is_success=switch(f"{full}allow_failure", own.get("allow_failure", False)),
        duration_scaling=_optional(full, own, "allowed_execution_duration_scaling"),
        duration_margin_s=_optional(full, own, "allowed_goal_duration_margin"),
    )


def _optional(prefix: str, own: Mapping[str, object], key: str) -> float | None:
    return number(prefix + key, own[key], least=0.0) if key in own else None
