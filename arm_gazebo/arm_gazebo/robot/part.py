"""One robot on its way into a model that it may share with others."""

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass

import mujoco
import numpy as np
from numpy.typing import NDArray

from arm_control.hardware_info import HardwareInfo
from arm_description.robot import Pose, Robot
from arm_gazebo.build_report import BuildReport
from arm_gazebo.errors import ModelError
from arm_gazebo.mesh.cache import MeshCache
from arm_gazebo.mesh.library import MeshLibrary
from arm_gazebo.robot.actuation import Drive, add_actuators, drives
from arm_gazebo.robot.body_tree import WORLD_LINK, BodyTree, TreeOptions
from arm_gazebo.robot.build_options import BuildOptions
from arm_gazebo.robot.camera_mount import add_cameras
from arm_gazebo.robot.collision_policy import CollisionLayer, leave_out_neighbours
from arm_gazebo.robot.footing import Footing
from arm_gazebo.robot.gazebo_tags import GazeboTags
from arm_gazebo.robot.initial_state import initial_positions
from arm_gazebo.robot.joint import RobotJoint
from arm_gazebo.robot.link_geometry import LinkGeometry
from arm_gazebo.robot.mimic_joints import add_equalities, followings, without_released
from arm_gazebo.sensors.camera import CameraSensor
from arm_gazebo.sensors.contact import ContactSensor
from arm_gazebo.sensors.link_sensor import LinkSensor

DEFAULT_OPTIONS = BuildOptions()
NO_TAGS = GazeboTags()


@dataclass(frozen=True, slots=True)
class RobotInWorld:
    """A robot and what is wanted of it.

    Attributes:
        robot: the description.
        hardware: says which joints are commanded and where they start.
        cameras: become cameras of the model, of the same names.
        options: the user's choices.
        tags: what the description's <gazebo> elements say.
        sensors: become sensors of the model.
    """

    robot: Robot
    hardware: Sequence[HardwareInfo]
    cameras: Sequence[CameraSensor] = ()
    options: BuildOptions = DEFAULT_OPTIONS
    tags: GazeboTags = NO_TAGS
    sensors: Sequence[LinkSensor] = ()

    @property
    def self_collides(self) -> bool:
        """Whether some links of the robot touch each other."""
        tags = self.tags
        some = tags.self_collide or any(link.self_collide for link in tags.links.values())
        return self.options.self_collide or some


class RobotPart:
    """Adds one robot to a specification, and knows it again in the compiled model.

    Args:
        spec: the world; gets links, joints, actuators and cameras.
        entry: the robot.
        layer: tells its shapes from those of other robots.
        report: gets what is repaired or left out.

    Raises:
        ModelError: the robot cannot be simulated as described; MeshError for its meshes.
    """

    def __init__(
        self,
        spec: mujoco.MjSpec,
        entry: RobotInWorld,
        layer: CollisionLayer,
        report: BuildReport,
    ) -> None:
        _check_names(spec, entry.robot)
        self._spec = spec
        self._entry = entry
        self._report = report
        robot, options = without_released(entry.robot, entry.hardware), entry.options
        self._free = options.base == "free" and robot.root != WORLD_LINK
        self._bodies = self._add_links(layer)
        self._follow = followings(robot, report)
        add_equalities(spec, robot, self._follow, options.step_s, report)
        self._drives = drives(robot, entry.hardware, self._follow, report)
        add_actuators(spec, self._drives, mujoco.MjSpec().default)
        add_cameras(spec, self._bodies, entry.cameras)
        for sensor in entry.sensors:
            sensor.add_to(spec, self._bodies)
            if isinstance(sensor, ContactSensor) and not robot.link(sensor.link).collisions:
                nothing = f"link '{sensor.link}' has no collision shape: nothing can touch it"
                report.warn(f"contact sensor '{sensor.name}'", nothing)
        self._start = initial_positions(robot, entry.hardware, self._follow, report)

    def place(self, model: mujoco.MjModel, qpos: NDArray[np.float64]) -> None:
        """Write where the robot starts into the positions of the whole model."""
        for name, position in self._start.items():
            qpos[model.joint(name).qposadr[0]] = position
        if self._free:
            root, spawn = self._entry.robot.root, self._entry.options.spawn
            _stand(model, qpos, root, spawn, self._report)

    def leave_out_neighbours(self, model: mujoco.MjModel, qpos: NDArray[np.float64]) -> None:
        """Exclude contacts within the robot that are there from the start."""
        links = [body.name for body in self._bodies.values() if body.name != WORLD_LINK]
        leave_out_neighbours(self._spec, model, qpos, links, self._report)

    def joints(self, model: mujoco.MjModel) -> dict[str, RobotJoint]:
        """Return the joints with one degree of freedom, by name, in the URDF's order."""
        return _joints(model, self._start, self._drives)

    def bodies(self, model: mujoco.MjModel) -> dict[str, int]:
        """Return the ids of the links, by name."""
        return {name: model.body(body.id).id for name, body in self._bodies.items()}

    def _add_links(self, layer: CollisionLayer) -> dict[str, mujoco.MjsBody]:
        entry, options = self._entry, self._entry.options
        # Values of what is not set: the world file's own defaults are meant for the world.
        default = mujoco.MjSpec().default
        cache = None if options.mesh_cache is None else MeshCache(options.mesh_cache)
        meshes = MeshLibrary(self._spec, options.package_path, cache)
        masks = layer.masks(options.self_collide or entry.tags.self_collide)
        geometry = LinkGeometry(meshes, default, entry.tags, masks, options.strict, self._report)
        tree = TreeOptions(options.step_s, default, self._free, options.spawn or Pose())
        return BodyTree(self._spec, entry.robot, geometry, tree, self._report).add()


def _check_names(spec: mujoco.MjSpec, robot: Robot) -> None:
    bodies = {body.name for body in spec.bodies} - {WORLD_LINK}
    joints = {joint.name for joint in spec.joints}
    for kind, taken, names in (
        ("link", bodies, [link.name for link in robot.links]),
        ("joint", joints, [joint.name for joint in robot.joints]),
    ):
        for name in names:
            if name in taken:
                raise ModelError(
                    f"the world, or a robot in it, already has a "
                    f"{'body' if kind == 'link' else kind} '{name}', and the {kind} of that name "
                    f"of robot '{robot.name}' cannot join it; rename one of them, with a prefix "
                    "where the description takes one"
                )


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
            velocity_limit=drive.velocity_limit if drive else math.inf,
            effort=drive.effort if drive else math.inf,
            initial=initial,
            linear=joint.type[0] == mujoco.mjtJoint.mjJNT_SLIDE,
        )
    return joints
