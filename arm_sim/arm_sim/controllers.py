"""The controllers of the simulation as a program commands them."""

from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, Any

from arm_control.controllers.controller import Controller
from arm_control.errors import ControllerManagerError
from arm_control.lifecycle import LifecycleState, Transition
from arm_control.manager.controller_creation import ControllerStarter
from arm_control.manager.controller_manager import ControllerManager
from arm_control.manager.switch_planner import Strictness, SwitchRequest
from arm_sim.errors import CallError, GoalError, UnknownNameError
from arm_sim.goals import Goal, RunningGoals
from arm_sim.user_traceback import ends_at_the_caller

if TYPE_CHECKING:
    from arm_control.controllers.gripper.goals import GripperResult
    from arm_control.controllers.joint_trajectory.goals import GoalResult, JointTolerance
    from arm_sim.trajectory import AnyTrajectory


@ends_at_the_caller
class ControllerHandle:
    """One loaded controller.

    Attributes:
        core: the controller itself, for what this class does not offer.
        state: its life-cycle state.
        goals: its running goals; None for a controller without goals.
        deliver: passes each command to the controller; a fault may replace it.
    """

    def __init__(self, core: Controller[Any]) -> None:
        """Take a controller that is not active yet."""
        self.core = core
        self.deliver: Callable[[Sequence[float]], None] = core.take_command
        self.state = LifecycleState.UNCONFIGURED
        # Only a core that serves goals has this method.
        goal_controller: Any = core if hasattr(core, "submit_goal") else None
        self.goals = RunningGoals(goal_controller) if goal_controller is not None else None

    @property
    def name(self) -> str:
        """Its name."""
        return self.core.name

    @property
    def is_active(self) -> bool:
        """Whether it is being updated."""
        return self.state is LifecycleState.ACTIVE

    def command(self, values: Sequence[float]) -> None:
        """Command it from the next tick on, as a message on its topic does.

        Args:
            values: one for each interface of a forwarding controller; forward velocity and yaw
                rate of a diff drive; a reference for each degree of freedom of a PID controller.

        Raises:
            ControllerError: the controller refuses the values.
            CallError: it is not active, it is halted, or another controller commands it.
        """
        if not self.is_active:
            raise CallError(f"controller '{self.name}' is {self.state.label} and takes no commands")
        if reason := self.core.idle_reason:
            raise CallError(f"controller '{self.name}' takes no commands: {reason}")
        self.deliver(values)

    def follow(
        self,
        trajectory: "AnyTrajectory",
        *,
        path_tolerance: Sequence["JointTolerance"] = (),
        goal_tolerance: Sequence["JointTolerance"] = (),
        goal_time_tolerance_s: float = 0.0,
    ) -> "Goal[GoalResult]":
        """Start a trajectory as a goal of ~/follow_joint_trajectory; it advances in later ticks.

        Args:
            trajectory: the waypoints; it replaces a running one.
            path_tolerance: allowed errors on the way; () for the controller's.
            goal_tolerance: allowed errors at the end; () for the controller's.
            goal_time_tolerance_s: how late the end may be reached; 0 for the controller's
                tolerance, -1 for any time.

        Raises:
            GoalError: the controller rejects it, with the code and text of the action.
            CallError: this is not a trajectory, or not a controller that follows one.
        """
        from arm_control.controllers.joint_trajectory.controller import JointTrajectoryController
        from arm_control.controllers.joint_trajectory.goals import GoalRequest
        from arm_sim.trajectory import trajectory_request

        core = self.core
        if not isinstance(core, JointTrajectoryController) or self.goals is None:
            raise CallError(
                f"controller '{self.name}' is a {_type(core)}, which does not follow trajectories"
            )
        joints = core.state_layout.joints if self.is_active else ()
        request = trajectory_request(trajectory, joints)
        refusal = core.check_goal(request)
        if refusal is not None:
            raise GoalError(refusal.message, code=refusal.code)
        return self.goals.start(
            lambda number: GoalRequest(
                number, request, path_tolerance, goal_tolerance, goal_time_tolerance_s
            )
        )

    def grip(self, position: float, max_effort: float | None = None) -> "Goal[GripperResult]":
        """Move a gripper as a goal of ~/gripper_cmd; it advances in later ticks.

        Args:
            position: where to move the joint, in rad or m.
            max_effort: effort limit in N m or N; None for the controller's parameter.

        Raises:
            GoalError: the controller rejects it.
            CallError: this is not a gripper controller.
        """
        from arm_control.controllers.gripper.controller import GripperController
        from arm_control.controllers.gripper.goals import GripperRequest

        core = self.core
        if not isinstance(core, GripperController) or self.goals is None:
            raise CallError(
                f"controller '{self.name}' is a {_type(core)}, which does not move a gripper"
            )
        efforts = () if max_effort is None else (max_effort,)
        refusal = core.check_goal(GripperRequest(0, (position,), efforts))
        if refusal:
            raise GoalError(refusal)
        return self.goals.start(lambda number: GripperRequest(number, (position,), efforts))


@ends_at_the_caller
class Controllers(Mapping[str, ControllerHandle]):
    """The loaded controllers by name. The simulation's thread."""

    def __init__(self, manager: ControllerManager, starter: ControllerStarter) -> None:
        self._manager = manager
        self._starter = starter
        self._handles: dict[str, ControllerHandle] = {}
        manager.add_observer(self)

    def start(self, name: str) -> ControllerHandle:
        """Load, configure and activate a controller of the parameter file.

        Raises:
            ArmControlError: it cannot start; the message says why.
        """
        handle = self.load(name)
        self._starter.activate(name)
        return handle

    def following(self, trajectory: object) -> str:
        """Return the active controller that follows trajectories of a trajectory's joints.

        Raises:
            CallError: there is none, or the trajectory names no joints.
        """
        from arm_control.controllers.joint_trajectory.controller import JointTrajectoryController

        is_mapping = isinstance(trajectory, Mapping)
        names = trajectory.get("joints") if is_mapping else getattr(trajectory, "joints", ())
        if not names:
            raise CallError("follow(TRAJECTORY) needs a trajectory that names its joints")
        wanted = set(names)
        for name, handle in self.items():
            core = handle.core
            if not isinstance(core, JointTrajectoryController) or not handle.is_active:
                continue
            if wanted <= set(core.state_layout.joints):
                return name
        raise CallError(
            f"no active controller follows trajectories of {', '.join(names)}; there are "
            f"{', '.join(self)}"
        )

    def load(self, name: str) -> ControllerHandle:
        """Load and configure a controller of the parameter file; `switch` activates it.

        Raises:
            ArmControlError: it cannot be loaded or configured; the message says why.
        """
        core = self._starter.load(name)
        self._handles[name] = handle = ControllerHandle(core)
        self._starter.configure(core)
        return handle

    def set_parameters(self, controller: str, **values: object) -> None:
        """Change parameters of a controller at once, as `ros2 param set` does.

        Args:
            controller: name of a configured controller.
            values: by name; a name with dots is given as `**{"gains.j0.p": 2.0}`.

        Raises:
            ArmControlError: a parameter is unknown or wrong, or cannot be changed now.
            UnknownNameError: there is no controller of that name.
        """
        self._starter.change(self[controller].core, values)

    def switch(self, activate: Sequence[str] = (), deactivate: Sequence[str] = ()) -> None:
        """Deactivate and activate loaded controllers in one step, all or none.

        Raises:
            ControllerManagerError: they cannot be switched.
        """
        request = SwitchRequest(tuple(activate), tuple(deactivate), Strictness.STRICT)
        result = self._manager.switch_controller(request)
        if not result.ok:
            raise ControllerManagerError(result.message)

    def running_goals(self) -> dict[str, dict[int, Goal[Any]]]:
        """Return the running goals, by controller and number."""
        return {name: book.running for name, book in self._books()}

    def restore_goals(self, running: Mapping[str, Mapping[int, Goal[Any]]]) -> None:
        """Continue with the goals of an earlier time."""
        for name, book in self._books():
            book.restore(running.get(name, {}))

    def _books(self) -> Iterator[tuple[str, RunningGoals]]:
        for name, handle in self._handles.items():
            if handle.goals is not None:
                yield name, handle.goals

    def controller_transitioned(
        self, name: str, transition: Transition, start: LifecycleState, end: LifecycleState
    ) -> None:
        """Store a controller's new state."""
        if name in self._handles:
            self._handles[name].state = end

    def activity_changed(self) -> None:
        """Do nothing: nothing else depends on it."""

    def __getitem__(self, name: str) -> ControllerHandle:
        if name not in self._handles:
            loaded = ", ".join(self._handles) or "none"
            raise UnknownNameError(f"no controller '{name}'; loaded: {loaded}")
        return self._handles[name]

    def __iter__(self) -> Iterator[str]:
        return iter(self._handles)

    def __len__(self) -> int:
        return len(self._handles)


def _type(core: Controller[Any]) -> str:
    return type(core).__name__
