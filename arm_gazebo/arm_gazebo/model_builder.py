"""A robot description, its hardware and its cameras, put into a world: the MuJoCo model.

MuJoCo's own URDF importer drops visuals, cameras and limits and fuses links; this one keeps
them, and reports whatever it cannot keep.
"""

import math
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path

import mujoco
import numpy as np
from numpy.typing import NDArray

from arm_control.hardware_info import HardwareInfo
from arm_description.robot import Pose, Robot
from arm_gazebo.actuation import Drive, add_actuators, drives
from arm_gazebo.body_tree import WORLD_LINK, BodyTree, TreeOptions
from arm_gazebo.build_options import BuildOptions
from arm_gazebo.build_report import BuildReport
from arm_gazebo.built_model import BuiltModel
from arm_gazebo.camera_mount import add_cameras
from arm_gazebo.camera_sensor import CameraSensor
from arm_gazebo.collision_policy import leave_out_neighbours
from arm_gazebo.errors import ModelError
from arm_gazebo.footing import Footing
from arm_gazebo.gazebo_tags import GazeboTags
from arm_gazebo.initial_state import initial_positions
from arm_gazebo.link_geometry import LinkGeometry
from arm_gazebo.mesh_cache import MeshCache
from arm_gazebo.mesh_library import MeshLibrary
from arm_gazebo.mimic_joints import add_equalities, followings
from arm_gazebo.robot_joint import RobotJoint
from arm_gazebo.world_file import check_world, load_world

DEFAULT_OPTIONS = BuildOptions()
NO_TAGS = GazeboTags()


def build_model(
    robot: Robot,
    hardware: Sequence[HardwareInfo],
    cameras: Sequence[CameraSensor] = (),
    world: str | Path = "empty",
    options: BuildOptions = DEFAULT_OPTIONS,
    tags: GazeboTags = NO_TAGS,
) -> BuiltModel:
    """Return the model of a robot in a world.

    Args:
        robot: the description.
        hardware: says which joints are commanded and where they start.
        cameras: become cameras of the model, of the same names.
        world: name of a shipped world or path of a MuJoCo XML file.
        options: the user's choices.
        tags: what the description's <gazebo> elements say.

    Raises:
        WorldError: the world is missing or unusable.
        ModelError: the robot cannot be simulated as described; MeshError for its meshes.
    """
    report = BuildReport()
    report.add(*tags.findings)
    self_collide = options.self_collide or tags.self_collide
    spec = load_world(world)
    _check_names(spec, robot, world)
    free = options.base == "free" and robot.root != WORLD_LINK
    # Values of what is not set: the world file's own defaults are meant for the world.
    plain = mujoco.MjSpec()
    cache = None if options.mesh_cache is None else MeshCache(options.mesh_cache)
    meshes = MeshLibrary(spec, options.package_path, cache)
    geometry = LinkGeometry(meshes, plain.default, tags, self_collide, options.strict, report)
    tree = TreeOptions(options.step_s, plain.default, free, options.spawn or Pose())
    bodies = BodyTree(spec, robot, geometry, tree, report).add()
    follow = followings(robot, report)
    add_equalities(spec, robot, follow, options.step_s, report)
    driven = drives(robot, hardware, follow, report)
    add_actuators(spec, driven, plain.default)
    add_cameras(spec, bodies, cameras)
    _set_physics(spec, options.step_s)
    model = _compile(spec, robot, world)
    start = initial_positions(robot, hardware, follow, report)
    qpos = _initial_qpos(model, start)
    if free:
        _stand(model, qpos, robot.root, options.spawn, report)
    if self_collide or any(link.self_collide for link in tags.links.values()):
        links = [name for name in bodies if name != WORLD_LINK]
        leave_out_neighbours(spec, model, qpos, links, report)
        model = _compile(spec, robot, world)
    _open_clip_planes(model, cameras)
    qpos.setflags(write=False)
    return BuiltModel(
        model,
        spec,
        joints=_joints(model, start, driven),
        bodies={name: model.body(body.id).id for name, body in bodies.items()},
        qpos=qpos,
        report=report,
    )


def _check_names(spec: mujoco.MjSpec, robot: Robot, world: str | Path) -> None:
    bodies = {body.name for body in spec.bodies} - {WORLD_LINK}
    joints = {joint.name for joint in spec.joints}
    for kind, taken, names in (
        ("link", bodies, [link.name for link in robot.links]),
        ("joint", joints, [joint.name for joint in robot.joints]),
    ):
        for name in names:
            if name in taken:
                raise ModelError(
                    f"the world '{world}' already has a "
                    f"{'body' if kind == 'link' else kind} '{name}', and the robot's {kind} of "
                    "that name cannot join it; rename one of them"
                )


def _set_physics(spec: mujoco.MjSpec, step_s: float) -> None:
    spec.option.timestep = step_s
    # The servos are stiff; this integrator is the cheapest that takes their damping implicitly.
    spec.option.integrator = mujoco.mjtIntegrator.mjINT_IMPLICITFAST
    # Every link keeps its frame, its looks and the inertia that it was given.
    spec.compiler.fusestatic = False
    spec.compiler.discardvisual = False
    spec.compiler.balanceinertia = False
    spec.compiler.inertiafromgeom = mujoco.mjtInertiaFromGeom.mjINERTIAFROMGEOM_AUTO


def _compile(spec: mujoco.MjSpec, robot: Robot, world: str | Path) -> mujoco.MjModel:
    try:
        return spec.compile()
    except (ValueError, mujoco.FatalError) as error:
        check_world(world)
        raise ModelError(f"robot '{robot.name}' does not compile: {error}") from error


def _initial_qpos(model: mujoco.MjModel, start: Mapping[str, float]) -> NDArray[np.float64]:
    qpos = model.qpos0.copy()
    for name, position in start.items():
        qpos[model.joint(name).qposadr[0]] = position
    return qpos


def _stand(
    model: mujoco.MjModel,
    qpos: NDArray[np.float64],
    root: str,
    spawn: Pose | None,
    report: BuildReport,
) -> None:
    """Put a free robot on the floor, unless a pose is given, and say if it will topple."""
    data = mujoco.MjData(model)
    data.qpos[:] = qpos
    mujoco.mj_kinematics(model, data)
    mujoco.mj_comPos(model, data)
    body = model.body(root)
    footing = Footing(model, data, body.id)
    if spawn is None and footing.lowest is not None:
        qpos[model.jnt_qposadr[body.jntadr[0]] + 2] -= footing.lowest
    overhang = footing.overhang()
    if overhang > 0:
        report.warn(
            f"link '{root}'",
            f"it stands free, and the centre of mass is {overhang * 1000:.0f} mm outside its "
            "feet: the robot will topple",
        )


def _open_clip_planes(model: mujoco.MjModel, cameras: Sequence[CameraSensor]) -> None:
    """Let the renderer see as near and as far as the cameras; MuJoCo counts in extents."""
    if cameras:
        model.vis.map.znear = min(camera.near for camera in cameras) / model.stat.extent
        model.vis.map.zfar = max(camera.far for camera in cameras) / model.stat.extent


def _joints(
    model: mujoco.MjModel, start: Mapping[str, float], driven: Iterable[Drive]
) -> dict[str, RobotJoint]:
    by_name = {drive.joint: drive for drive in driven}
    joints = {}
    for name, initial in start.items():
        joint, drive = model.joint(name), by_name.get(name)
        limited = bool(model.jnt_limited[joint.id])
        joints[name] = RobotJoint(
            name=name,
            qpos_address=int(joint.qposadr[0]),
            dof_address=int(joint.dofadr[0]),
            actuator=model.actuator(name).id if drive else None,
            lower=float(joint.range[0]) if limited else -math.inf,
            upper=float(joint.range[1]) if limited else math.inf,
            velocity=drive.velocity if drive else math.inf,
            effort=drive.effort if drive else math.inf,
            initial=initial,
            linear=joint.type[0] == mujoco.mjtJoint.mjJNT_SLIDE,
        )
    return joints
