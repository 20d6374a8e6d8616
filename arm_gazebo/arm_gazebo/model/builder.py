"""Build the MuJoCo model from a world and robot descriptions, their hardware and their cameras.

MuJoCo's own URDF importer drops visuals, cameras and limits and fuses links. This one keeps
them, and reports what it cannot keep.
"""

import os
from collections.abc import Sequence
from pathlib import Path

import mujoco

from arm_control.hardware.info import HardwareInfo
from arm_description.urdf.robot import Robot
from arm_gazebo.build_report import BuildReport
from arm_gazebo.errors import ModelError
from arm_gazebo.mjcf.names import free_name, name_elements
from arm_gazebo.model.built_model import BuiltModel
from arm_gazebo.model.world_file import check_world, load_world
from arm_gazebo.robot.collision_policy import MAX_LAYERS, CollisionLayer
from arm_gazebo.robot.gazebo_tags import GazeboTags
from arm_gazebo.robot.part import DEFAULT_OPTIONS, NO_TAGS, BuildOptions, RobotInWorld, RobotPart
from arm_gazebo.sensors.camera import CameraSensor
from arm_gazebo.sensors.link_sensor import LinkSensor

TOO_FEW_TO_SHARE = 3
"""Number of processors up to which MuJoCo's compiler has one thread for meshes, or none."""


def build_model(
    robot: Robot,
    hardware: Sequence[HardwareInfo],
    cameras: Sequence[CameraSensor] = (),
    world: str | Path = "empty",
    options: BuildOptions = DEFAULT_OPTIONS,
    tags: GazeboTags = NO_TAGS,
    sensors: Sequence[LinkSensor] = (),
) -> BuiltModel:
    """Return the model of one robot in a world; see `RobotInWorld` and `build_world`."""
    return build_world([RobotInWorld(robot, hardware, cameras, options, tags, sensors)], world)


def build_world(entries: Sequence[RobotInWorld], world: str | Path = "empty") -> BuiltModel:
    """Return the model of robots in a world.

    Args:
        entries: the robots, at least one. Names of links and joints must be unique among all of
            them, and their options must have the same physics step.
        world: name of a shipped world, or path of a MuJoCo XML or SDF file.

    Raises:
        WorldError: the world is missing or invalid.
        ModelError: a robot cannot be simulated as described; MeshError for its meshes.
    """
    if len(entries) > MAX_LAYERS:
        raise ModelError(f"{len(entries)} robots are too many for one world: at most {MAX_LAYERS}")
    report = BuildReport()
    spec = load_world(world, report, entries[0].options.memory_limit)
    name_elements(spec)
    parts = []
    for index, entry in enumerate(entries):
        report.add(*entry.tags.findings)
        layer = CollisionLayer(index, len(entries))
        try:
            parts.append(RobotPart(spec, entry, layer, report))
        except ValueError as error:
            # MuJoCo raises this if two elements of a kind have the same name.
            raise ModelError(f"robot '{entry.robot.name}' cannot be built: {error}") from error
    names = " and ".join(f"robot '{entry.robot.name}'" for entry in entries)
    _set_physics(spec, entries[0].options.step_s)
    model = _compile(spec, names, world)
    qpos = model.qpos0.copy()
    for part in parts:
        part.place(model, qpos)
    touching = [p for p, entry in zip(parts, entries, strict=True) if entry.self_collides]
    for part in touching:
        part.exclude_neighbour_contacts(model, qpos)
    rolling = [part for part in parts if part.set_up_wheels(model, qpos)]
    if touching or rolling:
        model = _compile(spec, names, world)
    for part in parts:
        part.report_overlaps(model, qpos)
    _open_clip_planes(model, [camera for entry in entries for camera in entry.cameras])
    qpos.setflags(write=False)
    return BuiltModel(
        model,
        spec,
        joints={name: joint for part in parts for name, joint in part.joints(model).items()},
        bodies={name: body for part in parts for name, body in part.bodies(model).items()},
        qpos=qpos,
        report=report,
        robots=_robots(model, entries, parts),
    )


def _robots(
    model: mujoco.MjModel, entries: Sequence[RobotInWorld], parts: Sequence[RobotPart]
) -> dict[str, tuple[str, ...]]:
    """Return the top-level bodies of each robot by robot name; equal names get a number."""
    robots: dict[str, tuple[str, ...]] = {}
    for entry, part in zip(entries, parts, strict=True):
        roots = dict.fromkeys(model.body_rootid[body] for body in part.bodies(model).values())
        names = tuple(model.body(root).name for root in roots if root)
        robots[free_name(entry.robot.name, robots)] = names
    return robots


def _set_physics(spec: mujoco.MjSpec, step_s: float) -> None:
    spec.option.timestep = step_s
    # The servos are stiff, and this is the cheapest integrator that treats damping implicitly.
    spec.option.integrator = mujoco.mjtIntegrator.mjINT_IMPLICITFAST
    # Sensors are evaluated on a copy of the state, and only while they have subscribers.
    spec.option.disableflags |= int(mujoco.mjtDisableBit.mjDSBL_SENSOR)
    # Every link keeps its frame, its visuals and its given inertia.
    spec.compiler.fusestatic = False
    spec.compiler.discardvisual = False
    spec.compiler.balanceinertia = False
    spec.compiler.inertiafromgeom = mujoco.mjtInertiaFromGeom.mjINERTIAFROMGEOM_AUTO
    # Meshes are compiled by half as many threads as there are processors. A single one only takes
    # its start and its own memory.
    spec.compiler.usethread = (os.cpu_count() or 1) > TOO_FEW_TO_SHARE


def _compile(spec: mujoco.MjSpec, names: str, world: str | Path) -> mujoco.MjModel:
    try:
        return spec.compile()
    except (ValueError, mujoco.FatalError) as error:
        check_world(world)
        raise ModelError(f"{names} does not compile: {' '.join(str(error).split())}") from error


def _open_clip_planes(model: mujoco.MjModel, cameras: Sequence[CameraSensor]) -> None:
    """Set the clip planes to the range of all cameras; MuJoCo's unit is the model's extent."""
    if cameras:
        model.vis.map.znear = min(camera.near for camera in cameras) / model.stat.extent
        model.vis.map.zfar = max(camera.far for camera in cameras) / model.stat.extent
