"""Add one robot to a model, which it may share with other robots."""

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import field
from pathlib import Path
from typing import Literal

import mujoco
import numpy as np
from numpy.typing import NDArray

from arm_control.hardware.info import HardwareInfo
from arm_description.resources import ResourceFinder
from arm_description.transforms import wxyz_from_rpy
from arm_description.urdf.robot import Joint, Mimic, Pose, Robot
from arm_gazebo.build_report import BuildReport
from arm_gazebo.errors import ModelError
from arm_gazebo.mesh.cache import MeshCache
from arm_gazebo.mesh.library import MeshLibrary
from arm_gazebo.mjcf.memory_limit import WORLD_LIMIT, MemoryLimit
from arm_gazebo.physics_timing import MAX_STEP_S
from arm_gazebo.robot.actuation import Drive, RobotJoint, add_actuators, drives
from arm_gazebo.robot.body_tree import WORLD_LINK, BodyTree, TreeOptions
from arm_gazebo.robot.collision_policy import (
    CollisionLayer,
    exclude_neighbour_contacts,
    report_overlaps,
)
from arm_gazebo.robot.floor_contact import FloorContact
from arm_gazebo.robot.gazebo_tags import GazeboTags
from arm_gazebo.robot.link_geometry import LinkGeometry
from arm_gazebo.robot.mimic_joints import add_equalities, mimic_rules, without_independent_mimics
from arm_gazebo.robot.rollers import add_rollers
from arm_gazebo.robot.wheels import set_up_wheels
from arm_gazebo.sensors.camera import CameraSensor
from arm_gazebo.sensors.contact import ContactSensor
from arm_gazebo.sensors.link_sensor import LinkSensor
from arm_node.frozen import frozen

Base = Literal["fixed", "free"]


@frozen
class BuildOptions:
    """Choices for `build_model`.

    Attributes:
        step_s: physics step; see `physics_timing`.
        base: whether a root link other than `world` is bolted down or stands free.
        spawn: pose of the robot's root in the world. By default a fixed base is at the world's
            origin, and a free base is at the height at which it stands on the floor.
        on_floor: whether a free base is at that height at the pose `spawn`, too.
        self_collide: whether links of the robot collide with each other; off by default, as in
            Gazebo.
        strict: whether an unavailable mesh is an error instead of a box and a warning.
        resources: finds the files that the description names.
        mesh_cache: folder of the mesh cache; None for no cache.
        memory_limit: limit on the memory of a world's MJCF.
    """

    step_s: float = MAX_STEP_S
    base: Base = "fixed"
    spawn: Pose | None = None
    on_floor: bool = False
    self_collide: bool = False
    strict: bool = False
    resources: ResourceFinder = field(default_factory=ResourceFinder)
    mesh_cache: Path | None = None
    memory_limit: MemoryLimit = WORLD_LIMIT


DEFAULT_OPTIONS = BuildOptions()
NO_TAGS = GazeboTags()


@frozen
class RobotInWorld:
    """A robot to add to a world.

    Attributes:
        robot: the parsed description.
        hardware: the components, which give the commanded joints and their initial values.
        cameras: the cameras, which keep their names in the model.
        options: the user's choices.
        tags: the content of the description's <gazebo> elements.
        sensors: the sensors to add to the model.
    """

    robot: Robot
    hardware: Sequence[HardwareInfo]
    cameras: Sequence[CameraSensor] = ()
    options: BuildOptions = DEFAULT_OPTIONS
    tags: GazeboTags = NO_TAGS
    sensors: Sequence[LinkSensor] = ()

    @property
    def self_collides(self) -> bool:
        """Whether some links of the robot collide with each other."""
        tags = self.tags
        some = tags.self_collide or any(link.self_collide for link in tags.links.values())
        return self.options.self_collide or some


class RobotPart:
    """Adds one robot to a specification, and finds it in the compiled model.

    Args:
        spec: the world; receives links, joints, actuators and cameras.
        entry: the robot.
        layer: distinguishes its shapes from those of other robots.
        report: receives what is repaired or left out.

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
        robot, options = without_independent_mimics(entry.robot, entry.hardware), entry.options
        self._free = options.base == "free" and robot.root != WORLD_LINK
        self._bodies = self._add_links(layer)
        add_rollers(spec, self._bodies, robot, entry.tags, report)
        self._follow = mimic_rules(robot, report)
        add_equalities(spec, robot, self._follow, options.step_s, report)
        self._drives = drives(robot, entry.hardware, self._follow, report)
        add_actuators(spec, self._drives, mujoco.MjSpec().default)
        add_cameras(spec, self._bodies, entry.cameras)
        for sensor in entry.sensors:
            sensor.add_to(spec, self._bodies)
            if isinstance(sensor, ContactSensor) and not robot.link(sensor.link).collisions:
                problem = f"link '{sensor.link}' has no collision shape: nothing can touch it"
                report.warn(f"contact sensor '{sensor.name}'", problem)
        self._start = initial_positions(robot, entry.hardware, self._follow, report)

    def place(self, model: mujoco.MjModel, qpos: NDArray[np.float64]) -> None:
        """Write the robot's starting positions into the positions of the whole model."""
        for name, position in self._start.items():
            qpos[model.joint(name).qposadr[0]] = position
        if self._free:
            root, options = self._entry.robot.root, self._entry.options
            lower = options.on_floor or options.spawn is None
            _place_on_floor(model, qpos, root, lower, self._report)

    def set_up_wheels(self, model: mujoco.MjModel, qpos: NDArray[np.float64]) -> bool:
        """Make wheels roll and casters slide realistically; return whether there are wheels."""
        return set_up_wheels(self._spec, model, qpos, self.bodies(model), self._report)

    def report_overlaps(self, model: mujoco.MjModel, qpos: NDArray[np.float64]) -> None:
        """Report links that start below the floor, inside something or inside another link."""
        can_be_free = not self._free and self._entry.robot.root != WORLD_LINK
        report_overlaps(
            model,
            qpos,
            self.bodies(model),
            self._entry.self_collides,
            self._report,
            advice="; base:=free lets the robot stand on the floor, and pose:= raises it"
            if can_be_free
            else "",
        )

    def exclude_neighbour_contacts(self, model: mujoco.MjModel, qpos: NDArray[np.float64]) -> None:
        """Exclude contacts between neighbouring links, and those that exist from the start."""
        links = [body.name for body in self._bodies.values() if body.name != WORLD_LINK]
        exclude_neighbour_contacts(self._spec, model, qpos, links, self._report)

    def joints(self, model: mujoco.MjModel) -> dict[str, RobotJoint]:
        """Return the joints with one degree of freedom, by name, in the URDF's order."""
        return _joints(model, self._start, self._drives)

    def bodies(self, model: mujoco.MjModel) -> dict[str, int]:
        """Return the ids of the links, by name."""
        return {name: model.body(body.id).id for name, body in self._bodies.items()}

    def _add_links(self, layer: CollisionLayer) -> dict[str, mujoco.MjsBody]:
        entry, options = self._entry, self._entry.options
        # The world file's own defaults are for the world only.
        default = mujoco.MjSpec().default
        cache = None if options.mesh_cache is None else MeshCache(options.mesh_cache)
        meshes = MeshLibrary(self._spec, options.resources, cache)
        masks = layer.masks(options.self_collide or entry.tags.self_collide)
        geometry = LinkGeometry(meshes, default, entry.tags, masks, options.strict, self._report)
        spawn, weightless = options.spawn or Pose(), entry.tags.weightless
        tree = TreeOptions(options.step_s, default, self._free, spawn, weightless)
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
                    f"{'body' if kind == 'link' else kind} '{name}', so the {kind} of that name "
                    f"in robot '{robot.name}' cannot be added; rename one of them, with a prefix "
                    "if the description takes one, or with prefix: true in a file of robots"
                )


def _place_on_floor(
    model: mujoco.MjModel,
    qpos: NDArray[np.float64],
    root: str,
    lower: bool,
    report: BuildReport,
) -> None:
    """Put a free robot on the floor if it is to be lowered, and warn if it will topple."""
    data = mujoco.MjData(model)
    data.qpos[:] = qpos
    mujoco.mj_kinematics(model, data)
    mujoco.mj_comPos(model, data)
    body = model.body(root)
    floor = FloorContact(model, data, body.id)
    if lower and floor.lowest is not None:
        qpos[model.jnt_qposadr[body.jntadr[0]] + 2] -= floor.lowest
    overhang = floor.overhang()
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


FORWARD_TO_MUJOCO = np.array([0.5, 0.5, -0.5, -0.5])
"""Rotates a ROS camera (looks along x, z up) to MuJoCo's (looks along -z, y up), w x y z."""
PIXEL_M = 1e-6
"""Size of a pixel of a camera with <intrinsics>."""
MIN_BUFFER = 800
"""Smallest side of the off-screen buffer in pixels: a renderer may need more than a camera."""


def add_cameras(
    spec: mujoco.MjSpec, bodies: Mapping[str, mujoco.MjsBody], cameras: Sequence[CameraSensor]
) -> None:
    """Add each camera to its link's body under the sensor's name, and enlarge the render buffer.

    Raises:
        ModelError: a camera's link does not exist, or the world already has a camera of that name.
    """
    buffer = spec.visual.global_
    buffer.offwidth = max([MIN_BUFFER, buffer.offwidth, *(c.width for c in cameras)])
    buffer.offheight = max([MIN_BUFFER, buffer.offheight, *(c.height for c in cameras)])
    # Four samples a pixel and a shadow map of 4096 make a frame twenty times slower in software.
    spec.visual.quality.offsamples = 0
    spec.visual.quality.shadowsize = 512
    for camera in cameras:
        if camera.link not in bodies:
            raise ModelError(
                f"camera '{camera.name}' is on link '{camera.link}', which does not exist; "
                f"the robot has {', '.join(bodies)}"
            )
        if spec.camera(camera.name) is not None:
            raise ModelError(f"the world already has a camera '{camera.name}'; rename one of them")
        quaternion = np.zeros(4)
        mujoco.mju_mulQuat(quaternion, wxyz_from_rpy(camera.rpy), FORWARD_TO_MUJOCO)
        mounted = bodies[camera.link].add_camera(
            name=camera.name,
            pos=camera.xyz,
            quat=quaternion,
            resolution=[camera.width, camera.height],
        )
        _apply_lens(mounted, camera)


def _apply_lens(mounted: mujoco.MjsCamera, camera: CameraSensor) -> None:
    """Give a camera of the model the sensor's projection; MuJoCo has no distortion."""
    lens = camera.lens
    if not camera.intrinsics:
        mounted.fovy = math.degrees(2 * math.atan(camera.height / 2 / lens.fy))
        return
    # Only the ratio of the sensor's sides counts, because all lengths are in pixels.
    mounted.sensor_size = [camera.width * PIXEL_M, camera.height * PIXEL_M]
    mounted.focal_pixel = [lens.fx, lens.fy]
    # MuJoCo measures from the principal point to the middle of the picture.
    mounted.principal_pixel = [camera.width / 2 - lens.cx, camera.height / 2 - lens.cy]


def initial_positions(
    robot: Robot,
    hardware: Sequence[HardwareInfo],
    follow: Mapping[str, Mimic],
    report: BuildReport,
) -> dict[str, float]:
    """Return the starting position of every joint with one degree of freedom, in rad or m.

    It is the `initial_value` of the hardware's position interface, clamped to the joint's limits,
    or else 0, clamped to its soft limits, too: nobody plans a motion from outside of them. A mimic
    joint starts where its leader puts it.
    """
    given = _given_positions(hardware)
    positions = {
        joint.name: _within_limits(joint, given, report)
        for joint in robot.joints
        if joint.type.is_scalar
    }
    for name, rule in follow.items():
        positions[name] = rule.position(positions[rule.joint])
    return positions


def _given_positions(hardware: Sequence[HardwareInfo]) -> dict[str, float]:
    return {
        joint.name: interface.initial_value
        for component in hardware
        for joint in component.joints
        # The state interface takes precedence over the command interface.
        for interface in (*joint.command_interfaces, *joint.state_interfaces)
        if interface.name == "position" and interface.initial_value is not None
    }


def _within_limits(joint: Joint, given: Mapping[str, float], report: BuildReport) -> float:
    wanted = given.get(joint.name, 0.0)
    if joint.limit is None or joint.mimic is not None:
        return wanted
    lower, upper = joint.limit.lower, joint.limit.upper
    position = min(max(wanted, lower), upper)
    if not math.isclose(position, wanted, abs_tol=1e-9):
        source = "its initial_value" if joint.name in given else "its zero"
        report.repair(
            f"joint '{joint.name}'",
            f"{source} of {wanted:g} is outside its limits of {lower:g} and {upper:g}; it starts "
            f"at {position:g}",
            joint.line,
        )
    if joint.safety is None or joint.name in given:
        return position
    lower, upper = max(lower, joint.safety.soft_lower), min(upper, joint.safety.soft_upper)
    within = min(max(position, lower), upper)
    if lower > upper or math.isclose(within, position, abs_tol=1e-9):
        return position
    report.inform(
        f"joint '{joint.name}'",
        f"{position:g} is outside its soft limits of {lower:g} and {upper:g}; it starts at "
        f"{within:g}",
        joint.line,
    )
    return within
