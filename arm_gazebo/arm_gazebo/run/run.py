"""A whole run of the simulation without ROS: robots in a world, their controllers, and time."""

import logging
from collections.abc import Callable, Sequence
from concurrent.futures import Future
from concurrent.futures import TimeoutError as FutureTimeoutError
from functools import cached_property
from typing import TYPE_CHECKING, Protocol, Self, TypeVar

from arm_control.errors import LoopStoppedError
from arm_gazebo.errors import Refusal, RequestError, SimSettingsError
from arm_gazebo.mesh.cache import cache_folder
from arm_gazebo.physics.physics import Physics
from arm_gazebo.physics.tick import ClockPublisher, SilentClock, SimulationTick
from arm_gazebo.physics_timing import PhysicsTiming, physics_timing
from arm_gazebo.robot.part import BuildOptions
from arm_gazebo.run.robot import ManagedRobot, SimulatedRobot
from arm_gazebo.run.settings import SimulationSettings
from arm_gazebo.state.complete_state import CompleteState
from arm_gazebo.world.loading import WorldLoader

if TYPE_CHECKING:
    from arm_gazebo.world.changes import WorldChanges
    from arm_gazebo.world.editor import ModelFeed, ModelHolder, WorldEditor
    from arm_gazebo.world.entity_properties import PropertyEditor

ResultT = TypeVar("ResultT")

LOOP_TIMEOUT_S = 10.0


class OnLoop(Protocol):
    """What runs the ticks."""

    @property
    def is_this_thread(self) -> bool:
        """Whether the caller is on the loop's thread."""
        ...

    def call(self, function: Callable[[], ResultT], /) -> "Future[ResultT]":
        """Run a function between two ticks."""
        ...


class ThisThread:
    """The loop of a program that runs the ticks itself."""

    is_this_thread = True

    def call(self, function: Callable[[], ResultT], /) -> "Future[ResultT]":
        """Run a function now, because no tick is running."""
        future: Future[ResultT] = Future()
        try:
            future.set_result(function())
        except Exception as error:
            # The caller gets the exception from the future, as from a loop in a thread of its own.
            future.set_exception(error)
        return future


class SimulationRun:
    """One run: the simulation's node publishes it, `arm_sim.Simulation` is its face.

    A replay builds one from a file. Time passes in `tick` only. Everything here belongs to the
    thread of `loop`, except `editor`, `properties` and `loader`, which belong to one other thread.

    Attributes:
        robots: the robots, each with its hardware, sensors, cameras and controller manager.
        managers: their controller managers.
        hardware: their hardware components.
        sensors: their sensors.
        cameras: their cameras.
        physics: MuJoCo and the drives.
        tick: advances everything by one control period.
        state: everything that changes in time; it may be saved, restored and reset.
        loader: puts the robots into worlds.
        seed: seed of the noise of sensors and cameras.
        loop: runs the ticks; the calling thread, unless a `ControlLoop` is set.
        holders: look up their indices in each new model of the world; complete before `editor`.
        viewers: show each new model; complete before `editor`.
    """

    def __init__(
        self,
        robots: Sequence[SimulatedRobot],
        physics: Physics,
        loader: WorldLoader,
        seed: int,
        clock: ClockPublisher | None = None,
    ) -> None:
        """Drive the robots in a physics that contains them; see `of`."""
        for robot in robots:
            robot.drive(physics, seed)
        clock = clock or SilentClock()
        self.robots = tuple(robots)
        self.managers = [robot.manager for robot in robots]
        self.hardware = [component for robot in robots for component in robot.hardware]
        self.sensors = [sensor for robot in robots for sensor in robot.sensors]
        self.cameras = [camera for robot in robots for camera in robot.cameras]
        self.physics = physics
        self.tick = SimulationTick(self.managers, physics, clock)
        self.state = CompleteState(physics, self.managers, clock)
        self.loader = loader
        self.seed = seed
        self.loop: OnLoop = ThisThread()
        self.holders: list[ModelHolder] = [*self.hardware]
        self.viewers: list[ModelFeed] = []

    @classmethod
    def of(
        cls,
        settings: SimulationSettings,
        robots: Sequence[ManagedRobot],
        clock: ClockPublisher | None = None,
    ) -> Self:
        """Build the world with its robots, and log what is repaired or left out.

        Raises:
            GazeboError, DescriptionError, ArmControlError: it cannot be built.
        """
        simulated = [SimulatedRobot(robot) for robot in robots]
        timing = _shared_timing(robots, settings.physics_step_s)
        options = BuildOptions(
            step_s=timing.step_s,
            self_collide=settings.self_collide,
            strict=settings.strict,
            mesh_cache=cache_folder(),
            memory_limit=settings.world_limit,
        )
        entries = [robot.in_world(options) for robot in simulated]
        loader = WorldLoader(entries, settings.spawn_limit)
        physics = Physics(
            loader.begin(settings.world),
            timing,
            settings.hold_joints,
            settings.position_proportional_gain,
        )
        return cls(simulated, physics, loader, settings.seed, clock)

    @cached_property
    def editor(self) -> "WorldEditor":
        """Spawns, moves and deletes; it is made, and its module loaded, when it is first used."""
        from arm_gazebo.world.editor import WorldEditor

        source = self.loader.source
        return WorldEditor(self.physics, self.on_loop, self.holders, self.viewers, source)

    @cached_property
    def properties(self) -> "PropertyEditor":
        """Changes gravity, masses and friction; it belongs to the thread of `editor`."""
        from arm_gazebo.world.entity_properties import PropertyEditor

        return PropertyEditor(self.editor, self.physics)

    @property
    def robot(self) -> SimulatedRobot:
        """The robot of a run that has one."""
        return self.robots[0]

    @property
    def changes(self) -> "WorldChanges | None":
        """What was changed in the world; None before anything could change it."""
        return self.editor.changes if "editor" in self.__dict__ else None

    @property
    def world_name(self) -> str:
        """The name of the present world, "" for none."""
        return "" if self.loader.world is None else self.loader.world.name

    def on_loop(self, function: Callable[[], ResultT], /) -> ResultT:
        """Return the result of a function that runs between two ticks; any thread.

        Raises:
            RequestError: the loop has ended, or does not respond; the function does not run then.
        """
        call = self.loop.call(function)
        try:
            return call.result(LOOP_TIMEOUT_S)
        except FutureTimeoutError as error:
            if not call.cancel():
                # The call is running, or has just finished.
                return call.result()
            raise RequestError(
                Refusal.FAILED, f"the simulation did not respond within {LOOP_TIMEOUT_S:g} s"
            ) from error
        except LoopStoppedError as error:
            raise RequestError(Refusal.FAILED, str(error)) from error

    def reseed(self, seed: int) -> None:
        """Give the sensors the noise of another run."""
        self.seed = seed
        for sensor in self.sensors:
            sensor.reseed(seed)
        for component in self.hardware:
            # The states still contain readings with the old noise.
            component.read(self.physics.time_s, self.physics.timing.period_s)

    def close(self) -> None:
        """Deactivate and finalize controllers and components."""
        for manager in self.managers:
            manager.shutdown()

    def log_findings(self, logger: logging.Logger) -> None:
        """Log what a tick itself must not log."""
        for component in self.hardware:
            for warning in component.take_warnings():
                logger.warning("%s", warning)
        for failure in self.physics.take_failures():
            logger.error("%s", failure)


def _shared_timing(robots: Sequence[ManagedRobot], physics_step_s: float | None) -> PhysicsTiming:
    """Return period and step of the one loop that all robots share."""
    by_rate = {robot.manager.update_rate: robot.manager_name for robot in robots}
    if len(by_rate) > 1:
        each = ", ".join(f"{name} {rate} Hz" for rate, name in by_rate.items())
        raise SimSettingsError(f"all robots in one world need the same update_rate: {each}")
    return physics_timing(next(iter(by_rate)), physics_step_s)
