"""The simulation as a library: the robot in its world with its controllers, without ROS."""

import logging
import math
from collections.abc import Callable, Collection, Sequence
from contextlib import AbstractContextManager, ExitStack
from functools import cached_property
from os import fspath
from pathlib import Path
from typing import TYPE_CHECKING, Any, Self

import numpy as np

from arm_node.collection import collection_paused
from arm_sim.arguments import SimulationArguments, takes, with_settings
from arm_sim.controllers import ControllerHandle, Controllers
from arm_sim.errors import CallError, GoalError
from arm_sim.goals import Goal, ResultT
from arm_sim.joints import Joints, Sensors, States
from arm_sim.pose import AnyPose, Matrix, pose_matrix
from arm_sim.robots import AnyPath
from arm_sim.snapshots import SavedState, Snapshots
from arm_sim.user_traceback import ends_at_the_caller, warn_caller

if TYPE_CHECKING:
    from arm_control.controllers.gripper.goals import GripperResult
    from arm_control.controllers.joint_trajectory.goals import GoalResult
    from arm_gazebo.run.run import SimulationRun
    from arm_gazebo.world.contacts import Contact
    from arm_gazebo.world.entity_properties import EntityProperties
    from arm_sim.cameras import Camera, RobotCameras
    from arm_sim.planning import MotionGoal, MotionPlanning
    from arm_sim.trajectory import AnyTrajectory, JointTrajectory

GOAL_TIMEOUT_S = 60.0
ROUNDING = 1e-6  # of a duration, in control periods

logger = logging.getLogger("arm_sim")


@ends_at_the_caller
@with_settings
class Simulation:
    """A robot in a world with its controllers; time passes only in `step` and `run`.

    It runs the classes of the simulation node in the same order, as fast as possible, in the
    thread that calls it; use it from one thread. Use it as a context manager, or call `close`.

    Attributes:
        joints: the states of the joints: arrays in their order, or one joint by its name.
        states: the state interfaces of the hardware by full name, such as 'j0/position'.
        sensors: the present readings of the robot's sensors: `sim.sensors["imu"]` is a mapping.
        controllers: the loaded controllers by name; `sim["NAME"]` is one of them.
        parts: the run behind it, for what this class does not offer.

    Args:
        description: URDF or xacro file, as a path or a package:// URI; the text of a URDF; or
            "arm" for the 4-DOF arm, "mycobot" for the myCobot 280, with controllers and world.
        world: a shipped world's name, or a MuJoCo XML or SDF file; default the named robot's,
            or "empty".
        controllers: parameter file of the controller manager and its controllers, or its content;
            default the named robot's, or a position controller for every joint.
        arguments: xacro arguments.
        spawn: controllers to start; default the named robot's, or all of the file whose
            joints are not claimed yet.
        base: "fixed" or "free", how a root link other than `world` is attached.
        pose: x y z roll pitch yaw of the robot's root in the world, in m and rad.
        package_path: folders searched for package:// and model://.
        record: file to record the run to, for `arm sim replay`; it must not exist.
    """

    @takes(SimulationArguments)
    def __init__(self, arguments: SimulationArguments) -> None:
        """Build the simulation and start its controllers.

        Raises:
            DescriptionError: the description does not exist, or is not a robot.
            GazeboError: the world or the robot cannot be simulated.
            ArmControlError: a parameter is wrong, or a controller that `spawn` names cannot start.
            RecordingError: the recording cannot be written.
            ParameterValueError: another argument is wrong.
        """
        with collection_paused():
            # Imported here, because it takes long, and a program may never build a simulation.
            from arm_sim.set_up import set_up

            setup = set_up(arguments)
            for remark in setup.remarks:
                logger.info("%s", remark)
            if setup.left_out:
                warn_caller(setup.left_out)
            self.parts, starter = setup.build()
            self._physics, self._tick = self.parts.physics, self.parts.tick
            self._render_backend = setup.settings.render_backend
            self._moveit_config = setup.moveit_config
            self._ending = ExitStack()
            self._closed = False
            self.joints = Joints(self._physics)
            self.parts.holders.append(self.joints)
            self.states = States(self.parts.robot.manager.resources)
            self.sensors = Sensors(self.parts.sensors)
            self.controllers = Controllers(self.parts.robot.manager, starter)
            self._start(arguments.record)

    def _start(self, record: AnyPath | None) -> None:
        """Begin the recording, then start the controllers."""
        with ExitStack() as failing:
            failing.callback(self.close)
            self._ending.callback(self.parts.close)
            if record is not None:
                self._ending.enter_context(self.record(record))
            self.parts.robot.start_controllers(self.controllers.start, logger)
            failing.pop_all()
        self._snapshots = Snapshots(self.parts, self.controllers, self._reseed)

    # Time

    @property
    def time_s(self) -> float:
        """Simulation time."""
        return self._physics.time_s

    @property
    def period_s(self) -> float:
        """The control period: how far `step` advances."""
        return self._physics.timing.period_s

    def step(self) -> None:
        """Advance by one control period.

        Raises:
            UnhandledFailureError: a controller or component raised, and the parameter
                `handle_exceptions` is false. Otherwise only that one is stopped, which is logged.
        """
        run = self._open
        self._tick()
        run.log_findings(logger)

    def run(self, seconds: float) -> None:
        """Advance by simulated seconds, to the first tick at or after their end.

        Raises:
            CallError: `seconds` is not a duration; other errors as in `step`.
        """
        run = self._open
        for _ in range(self._periods_in(seconds)):
            self._tick()
        run.log_findings(logger)

    def run_until(self, condition: Callable[[], bool], timeout_s: float) -> bool:
        """Advance until a condition holds after a tick; return whether it did in time.

        Args:
            condition: called before the first tick and after each.
            timeout_s: how long to run at most, in simulated seconds.
        """
        remaining = self._periods_in(timeout_s)
        while not condition():
            if not remaining:
                return False
            remaining -= 1
            self.step()
        return True

    def _periods_in(self, seconds: float) -> int:
        if not 0.0 <= seconds < math.inf:
            raise CallError(f"the simulation cannot run for {seconds} s")
        return math.ceil(seconds / self.period_s - ROUNDING)

    # Controllers

    def __getitem__(self, controller: str) -> ControllerHandle:
        """Return a loaded controller.

        Raises:
            UnknownNameError: there is none of that name.
        """
        return self.controllers[controller]

    def plan(
        self,
        goal: "MotionGoal",
        group: str = "",
        *,
        link: str = "",
        speed: float = 1.0,
        allowed_time_s: float = 5.0,
        seed: int = 0,
    ) -> "JointTrajectory":
        """Return a motion of the robot from where it is to a goal, around what is in the world.

        Every state of it is proved free, see `arm_planning`. What the motion must touch, such as a
        thing to pick up, is in the way, too. `follow` runs the motion.

        Args:
            goal: positions of joints by name, in rad or m, where others stay; the name of a
                state, such as "home"; or a pose of the link in the world, see `AnyPose`.
            group: the group of joints that moves; "" for the first chain.
            link: the link of a pose; "" for the group's tip.
            speed: fraction of the joints' velocity limits.
            allowed_time_s: when planning gives up, in s of wall time.
            seed: the same goal, state and seed give the same motion.

        Raises:
            PlanningError: there is no such motion; the message says why.
            CallError: the goal is not a goal, or an option is not usable.
        """
        return self._planning.plan(
            goal, group, link=link, speed=speed, allowed_time_s=allowed_time_s, seed=seed
        )

    def collision_check(
        self, joints: Sequence[str], ignored: Collection[str] = ()
    ) -> Callable[[np.ndarray], bool]:
        """Return a function that tells whether the robot touches nothing with joints at positions.

        It knows the present world, and takes positions of the joints in their order, shape (n,); it
        is for the time until the next plan.

        Args:
            joints: names of the joints; others stay where they are now.
            ignored: entities that may be touched.
        """
        return self._planning.collision_check(joints, ignored)

    @cached_property
    def _planning(self) -> "MotionPlanning":
        from arm_sim.planning import MotionPlanning

        return MotionPlanning(self._open, self.joints, self.pose, self._moveit_config)

    def follow(
        self,
        controller: "str | AnyTrajectory",
        trajectory: "AnyTrajectory | None" = None,
        *,
        timeout_s: float = GOAL_TIMEOUT_S,
    ) -> "GoalResult":
        """Run until a trajectory controller has followed a trajectory; return the result.

        Args:
            controller: name of the controller; a trajectory that names its joints, such as a plan,
                may stand alone: the active controller of these joints follows it.
            trajectory: the waypoints; see `ControllerHandle.follow`, which does not run.
            timeout_s: how long to run at most, in simulated seconds; then the goal is cancelled.

        Raises:
            GoalError: it was rejected, aborted or cancelled, or did not end in time.
            CallError: no active controller follows trajectories of these joints.
        """
        if trajectory is not None:
            return self._finished(self[str(controller)].follow(trajectory), timeout_s)
        if isinstance(controller, str):
            raise CallError(f"follow('{controller}') lacks the trajectory")
        name = self.controllers.following(controller)
        return self._finished(self[name].follow(controller), timeout_s)

    def grip(
        self,
        controller: str,
        position: float,
        max_effort: float | None = None,
        *,
        timeout_s: float = GOAL_TIMEOUT_S,
    ) -> "GripperResult":
        """Run until a gripper has reached a position, or has stalled on an object.

        Args:
            controller: name of the controller.
            position: where to move the joint, in rad or m.
            max_effort: effort limit in N m or N; None for the controller's parameter.
            timeout_s: how long to run at most, in simulated seconds; then the goal is cancelled.

        Raises:
            GoalError: see `follow`.
        """
        return self._finished(self[controller].grip(position, max_effort), timeout_s)

    def _finished(self, goal: Goal[ResultT], timeout_s: float) -> ResultT:
        if not self.run_until(lambda: goal.done, timeout_s):
            goal.cancel()
            raise GoalError(f"the goal of '{goal.controller}' has not ended after {timeout_s:g} s")
        return goal.result

    # The world

    @property
    def entities(self) -> tuple[str, ...]:
        """Names of the entities: robots, parts of the world, spawned models."""
        return tuple(entity.name for entity in self._open.editor.entities)

    def spawn(
        self, model: AnyPath, *, name: str = "", pose: AnyPose = None, frame: str = ""
    ) -> str:
        """Spawn a model; return its name.

        Args:
            model: URDF, SDF or MJCF: a file as a path or URI, or the text itself.
            name: name of the entity; "" for the model's name, with a number if that is taken.
            pose: its pose in `frame`, see `AnyPose`.
            frame: an entity or a link; "" for the world.

        Raises:
            RequestError: it cannot be spawned; the world is unchanged.
        """
        from arm_gazebo.world.editor import SpawnRequest

        text = fspath(model)
        uri, text = ("", text) if text.lstrip().startswith("<") else (text, "")
        matrix, allow_renaming = pose_matrix(pose), not name
        request = SpawnRequest(name, uri, text, matrix, frame, allow_renaming=allow_renaming)
        return self._open.editor.spawn(request)

    def delete(self, name: str) -> None:
        """Delete an entity of the world that is not a robot with controllers.

        Raises:
            RequestError: it cannot be deleted.
        """
        self._open.editor.delete(name)

    def place(self, name: str, pose: AnyPose, frame: str = "") -> None:
        """Move an entity, which is at rest afterwards.

        Args:
            name: name of the entity.
            pose: its pose in `frame`, see `AnyPose`.
            frame: an entity or a link; "" for the world.

        Raises:
            RequestError: it cannot be moved.
        """
        self._open.editor.place(name, pose_matrix(pose), frame, None)

    def pose(self, name: str, frame: str = "") -> Matrix:
        """Return the pose of an entity or a link, shape (4, 4).

        Args:
            name: the entity or link.
            frame: the entity or link to see it from; "" for the world.

        Raises:
            RequestError: there is none of that name.
        """
        in_world = self._open.editor.in_world
        seen = in_world(np.eye(4), name)
        return np.linalg.inv(in_world(np.eye(4), frame)) @ seen if frame else seen

    @property
    def gravity(self) -> np.ndarray:
        """The present gravity in the world, m/s2, shape (3,)."""
        return np.array(self._open.properties.gravity)

    def set_gravity(self, gravity: Sequence[float]) -> None:
        """Set the gravity, m/s2, shape (3,); drives hold and plan under the new one.

        Raises:
            RequestError: it is not three numbers within ±100 m/s2.
        """
        self._open.properties.set_gravity(gravity)

    def properties(self, name: str) -> "EntityProperties":
        """Return the mass and friction of an entity that is not a robot.

        Raises:
            RequestError: there is none of that name, or it is a robot.
        """
        return self._open.properties.of(name)

    def set_properties(
        self, name: str, *, mass_kg: float | None = None, friction: float | None = None
    ) -> None:
        """Set mass or friction of an entity that is not a robot; `reset` puts its own back.

        Args:
            name: name of the entity.
            mass_kg: its mass; it becomes evenly denser or lighter. None to leave it.
            friction: coefficient of sliding friction of all its shapes; None to leave it. Of two
                shapes in contact the lower one counts; of two above 1, the higher one.

        Raises:
            RequestError: it has no such property, or cannot have this value.
        """
        self._open.properties.change(name, mass_kg, friction)

    def contacts(self, name: str | None = None) -> "tuple[Contact, ...]":
        """Return the contacts of an entity or a link in the present state.

        Args:
            name: the entity or link; None for all contacts.

        Raises:
            RequestError: there is none of that name.
        """
        from arm_gazebo.world.contacts import contacts_of

        run = self._open
        return contacts_of(name, self._physics.model, self._physics.observe(), run.editor.entities)

    # Cameras

    @property
    def cameras(self) -> tuple[str, ...]:
        """Names of the robot's cameras."""
        return tuple(sensor.name for sensor in self.parts.cameras)

    def camera(self, name: str) -> "Camera":
        """Return a camera by its name or one of its topics; it draws on request.

        Raises:
            UnknownNameError: the robot has none of that name.
        """
        self._check_open()
        return self._drawn_cameras.find(name)

    @cached_property
    def _drawn_cameras(self) -> "RobotCameras":
        from arm_sim.cameras import RobotCameras

        run = self.parts
        cameras = RobotCameras(run.physics, run.cameras, self._render_backend, run.seed)
        self._ending.callback(cameras.close)
        return cameras

    # States

    def save(self, path: AnyPath | None = None) -> SavedState:
        """Return the complete state: physics, drives, controllers, goals, entities, noise, time.

        Args:
            path: also write it to this file, as `arm sim save` does.

        Raises:
            StateError, RequestError: a controller cannot be saved, or the file cannot be written.
        """
        self._check_open()
        return self._snapshots.save(path)

    def restore(self, snapshot: SavedState | AnyPath) -> None:
        """Go back to a state of this simulation, and continue from there bit for bit.

        Goals that the state does not have are aborted. Parameters are settings and stay.

        Args:
            snapshot: the state; or a file of `save` or `arm sim save` of this robot and world.

        Raises:
            StateError, RequestError: the state does not fit, or the file cannot be read.
            CallError: another simulation saved it, or the run is recorded and keeps its seed.
        """
        self._check_open()
        self._snapshots.restore(snapshot)

    def reset(self, seed: int | None = None) -> None:
        """Go back to the start, as if the simulation had just been made.

        Args:
            seed: seed of the noise from now on; None for the present one.

        Raises:
            StateError: a controller cannot be saved.
            CallError: the run is recorded and would get another seed.
        """
        self._check_open()
        self._snapshots.reset(seed)

    def _reseed(self, seed: int) -> None:
        self.parts.reseed(seed)
        if "_drawn_cameras" in self.__dict__:
            self._drawn_cameras.reseed(seed)

    def record(self, path: AnyPath) -> AbstractContextManager[None]:
        """Record the run from now on, for `arm sim replay`, until the returned context ends.

        Raises:
            RecordingError: the file exists or cannot be written, or a controller cannot be saved.
        """
        from arm_gazebo.recording.recorder import recording

        return recording(self._open, Path(path))

    # The end

    def close(self) -> None:
        """End the recording, controllers and components; may be called again."""
        self._closed = True
        self._ending.close()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *raised: Any) -> None:
        self._closed = True
        self._ending.__exit__(*raised)

    def _check_open(self) -> None:
        if self._closed:
            raise CallError("the simulation is closed")

    @property
    def _open(self) -> "SimulationRun":
        """The run, unless the simulation is closed."""
        self._check_open()
        return self.parts
