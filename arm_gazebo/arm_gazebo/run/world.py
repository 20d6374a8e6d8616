"""The robots in their world: one simulation, and what spawns, moves and reloads in it."""

import logging
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from arm_gazebo.errors import SimSettingsError
from arm_gazebo.launching.world_path import find_world
from arm_gazebo.mesh.cache import cache_folder
from arm_gazebo.mjcf.memory_limit import MemoryLimit
from arm_gazebo.model.builder import build_world
from arm_gazebo.physics.physics import Physics
from arm_gazebo.physics_timing import PhysicsTiming, physics_timing
from arm_gazebo.robot.part import BuildOptions, RobotInWorld
from arm_gazebo.run.robot import AssembledRobot
from arm_gazebo.run.settings import SimulationSettings
from arm_gazebo.world.loading import NamedWorld, named_world
from arm_gazebo.world.spawn_model import ModelSource


@dataclass(frozen=True, slots=True)
class AssembledWorld:
    """The robots in their world.

    Attributes:
        simulation: the physics.
        entries: the robots as they were built.
        named: name and description of the world.
        left_out: the parts of the world that are not simulated, "" for none.
    """

    simulation: Physics
    entries: tuple[RobotInWorld, ...]
    named: NamedWorld
    left_out: str

    def model_source(self, spawn_limit: MemoryLimit) -> ModelSource:
        """Return the reader of models that are spawned into this world.

        Args:
            spawn_limit: limit on the memory of a spawned MJCF.
        """
        options = self.entries[0].options
        folders = tuple(dict.fromkeys(f for e in self.entries for f in e.options.resources.folders))
        return ModelSource(options.step_s, folders, options.mesh_cache, spawn_limit)


def assemble_world(
    robots: Sequence[AssembledRobot], settings: SimulationSettings, rates_hz: Mapping[str, int]
) -> AssembledWorld:
    """Build the world with its robots, and log what is repaired or left out.

    Args:
        robots: the robots, at least one.
        settings: the user's settings.
        rates_hz: the update rate of each controller manager by its fully qualified name.

    Raises:
        GazeboError: the world or a robot cannot be simulated.
    """
    timing = _shared_timing(rates_hz, settings.physics_step_s)
    options = BuildOptions(
        step_s=timing.step_s,
        self_collide=settings.self_collide,
        strict=settings.strict,
        mesh_cache=cache_folder(),
        memory_limit=settings.world_limit,
    )
    entries = tuple(robot.in_world(options) for robot in robots)
    built = build_world(entries, settings.world)
    built.report.log(logging.getLogger("arm_gazebo"))
    named = named_world(find_world(settings.world), built.report)
    simulation = Physics(built, timing, settings.hold_joints, settings.position_proportional_gain)
    return AssembledWorld(simulation, entries, named, built.report.left_out)


def _shared_timing(rates_hz: Mapping[str, int], physics_step_s: float | None) -> PhysicsTiming:
    """Return period and step of the one loop that all robots share."""
    by_rate = {rate: name for name, rate in rates_hz.items()}
    if len(by_rate) > 1:
        each = ", ".join(f"{name} {rate} Hz" for rate, name in by_rate.items())
        raise SimSettingsError(f"all robots in one world need the same update_rate: {each}")
    return physics_timing(next(iter(by_rate)), physics_step_s)
