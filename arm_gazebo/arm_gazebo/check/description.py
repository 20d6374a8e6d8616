"""Read a robot description as the simulation would, and report all findings."""

import re
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field
from typing import Generic, TypeVar

import mujoco

from arm_control.errors import ArmControlError
from arm_control.hardware.info import HardwareInfo, parse_hardware_info
from arm_description.errors import DescriptionError, XmlError
from arm_description.package_search import PackagePlace
from arm_description.urdf.description import RobotDescription
from arm_description.urdf.element import Remark
from arm_description.urdf.parser import parse_urdf
from arm_description.urdf.robot import Mesh, Robot
from arm_gazebo.build_report import BuildOutcome, BuildReport, Finding
from arm_gazebo.check.plausibility import mesh_sizes, other_units
from arm_gazebo.check.unread_elements import refused_by_ros, unread_elements
from arm_gazebo.drives.braking_law import slow_joints
from arm_gazebo.drives.servo_tuning import tune, weak_drives
from arm_gazebo.errors import GazeboError
from arm_gazebo.hardware.simulated_gpios import SimulatedGpios
from arm_gazebo.hardware.simulated_hardware import MAX_EFFORT, STATES
from arm_gazebo.launching.default_control import commandable_joints, with_hardware
from arm_gazebo.model.builder import build_model
from arm_gazebo.model.built_model import BuiltModel
from arm_gazebo.robot.gazebo_tags import GazeboTags, parse_gazebo_tags
from arm_gazebo.robot.mimic_joints import without_independent_mimics
from arm_gazebo.robot.part import DEFAULT_OPTIONS, BuildOptions
from arm_gazebo.sensors.camera import CameraSensor
from arm_gazebo.sensors.camera_reader import parse_cameras
from arm_gazebo.sensors.link_sensor import LinkSensor
from arm_gazebo.sensors.reader import parse_link_sensors

PERIOD_S = 0.01
JOINT_INTERFACES = (*STATES, MAX_EFFORT)
_LINE = re.compile(r"\bline (\d+)")


@dataclass(frozen=True, slots=True)
class RobotSummary:
    """A summary of a robot.

    Attributes:
        name: name of the robot.
        root: name of its root link.
        links: number of links.
        joints: number of joints of each type.
        driven: names of the commanded joints.
        mimicking: names of the mimic joints.
        cameras: names of the cameras.
        sensors: types and names of the other sensors.
        meshes: number of mesh files.
        triangles: number of triangles of all meshes in the model.
        mass_kg: total mass, after repairs.
    """

    name: str
    root: str
    links: int
    joints: dict[str, int]
    driven: tuple[str, ...]
    mimicking: tuple[str, ...]
    cameras: tuple[str, ...]
    sensors: tuple[str, ...]
    meshes: int
    triangles: int
    mass_kg: float

    def __str__(self) -> str:
        parts = [counted(self.links, "link"), counted(sum(self.joints.values()), "joint")]
        if self.joints:
            types = ", ".join(f"{count} {kind}" for kind, count in self.joints.items())
            parts[-1] += f" ({types})"
        parts += [f"{len(self.driven)} driven"] if self.driven else []
        parts += [f"{len(self.mimicking)} mimicking"] if self.mimicking else []
        parts.append(f"{self.mass_kg:.4g} kg")
        if self.meshes:
            triangles = counted(self.triangles, "triangle")
            parts.append(f"{counted(self.meshes, 'mesh', 'meshes')} of {triangles}")
        parts += [f"camera {name}" for name in self.cameras]
        parts += self.sensors
        return f"robot '{self.name}', root '{self.root}': {', '.join(parts)}"


def counted(number: int, one: str, many: str = "") -> str:
    """Return a number with its noun; the plural is the noun and an s unless given."""
    return f"{number} {one if number == 1 else many or one + 's'}"


SummaryT = TypeVar("SummaryT")


@dataclass(frozen=True, slots=True)
class CheckResult(Generic[SummaryT]):
    """The result of a check.

    Attributes:
        summary: summary of the robot or the world; None if no model could be built.
        findings: the findings.
        packages: the places of the packages that a robot's description names.
    """

    summary: SummaryT | None
    findings: tuple[Finding, ...]
    packages: Mapping[str, tuple[PackagePlace, ...]] = field(
        default_factory=dict[str, tuple[PackagePlace, ...]]
    )

    @property
    def is_usable(self) -> bool:
        """Whether the robot or the world can be simulated."""
        return not any(finding.outcome is BuildOutcome.FAILED for finding in self.findings)


def check_description(
    urdf: str, source: str, options: BuildOptions = DEFAULT_OPTIONS
) -> CheckResult[RobotSummary]:
    """Check the text of a URDF, with xacro expanded; messages call it `source`.

    `options.strict` makes an unavailable mesh an error.
    """
    report = BuildReport()
    try:
        description = RobotDescription(urdf, source)
    except XmlError as error:
        # Without XML no other check is possible.
        return CheckResult(None, (_failure(error, source),), options.resources.used)
    report.add(*unread_elements(description), *refused_by_ros(description))
    robot: Robot | None = None
    hardware: tuple[HardwareInfo, ...] = ()
    cameras: tuple[CameraSensor, ...] = ()
    sensors: tuple[LinkSensor, ...] = ()
    tags = GazeboTags()

    def note(remark: Remark) -> None:
        report.repair(remark.element, remark.problem, remark.line)

    with failures(report, source):
        robot = parse_urdf(description, source, note)
    with failures(report, source):
        cameras = parse_cameras(description, report.add)
        tags = parse_gazebo_tags(description)
    if robot is not None:
        with failures(report, source):
            sensors = parse_link_sensors(description, robot, report.add)
    with failures(report, source):
        hardware = parse_hardware_info(description)
        if not hardware and robot is not None:
            hardware = _default_hardware(urdf, robot, report)
        _check_interfaces(hardware, sensors, report)
    summary = None
    if robot is not None:
        with failures(report, source):
            built = build_model(
                robot, hardware, cameras, options=options, tags=tags, sensors=sensors
            )
            report.add(*built.report.findings)
            _check_strength(built, report)
            report.add(*mesh_sizes(robot, built), *other_units(robot, built))
            summary = _summary(without_independent_mimics(robot, hardware), built, cameras, sensors)
    findings = tuple(dict.fromkeys(report.findings))
    return CheckResult(summary, findings, options.resources.used)


@contextmanager
def failures(report: BuildReport, source: str) -> Iterator[None]:
    """Turn an error into a finding, so that the remaining checks still run."""
    try:
        yield
    except (DescriptionError, ArmControlError, GazeboError) as error:
        report.add(_failure(error, source))


def _failure(error: Exception, source: str) -> Finding:
    message = str(error).removeprefix(source).removeprefix(", ").removeprefix(" ")
    line = int(found.group(1)) if (found := _LINE.search(message)) else 0
    return Finding(BuildOutcome.FAILED, source, message.removeprefix(f"line {line}: "), line)


def _default_hardware(urdf: str, robot: Robot, report: BuildReport) -> tuple[HardwareInfo, ...]:
    joints = commandable_joints(robot)
    report.inform(
        f"robot '{robot.name}'",
        "it has no <ros2_control> block; sim.launch.py adds a default one that commands "
        f"{', '.join(joints) or 'nothing'}",
    )
    return parse_hardware_info(with_hardware(urdf, robot))


def _check_interfaces(
    hardware: Sequence[HardwareInfo], sensors: Sequence[LinkSensor], report: BuildReport
) -> None:
    for component in hardware:
        offered = {
            *(f"{joint.name}/{name}" for joint in component.joints for name in JOINT_INTERFACES),
            *(f"{sensor.name}/{channel}" for sensor in sensors for channel in sensor.channels),
            *(gpios := SimulatedGpios(component)).states,
            *gpios.commands,
        }
        if gpios.unset:
            report.inform(
                f"<ros2_control name='{component.name}'>",
                f"nothing sets {', '.join(gpios.unset)}, and no initial_value is given: NaN",
                component.line,
            )
        every = (*component.command_interface_names, *component.state_interface_names)
        left_out = [name for name in dict.fromkeys(every) if name not in offered]
        if left_out:
            report.drop(
                f"<ros2_control name='{component.name}'>",
                f"not simulated: {', '.join(left_out)}",
                component.line,
            )
        unread = [
            f"{key}='{interface.parameters[key]}' of {joint.name}/{interface.name}"
            for joint in component.joints
            for interface in joint.command_interfaces
            for key in interface.unread_limits
        ]
        if unread:
            others = f" and {len(unread) - 1} more" if len(unread) > 1 else ""
            report.drop(
                f"<ros2_control name='{component.name}'>",
                f"{unread[0]}{others}: not a number, so there is no limit",
                component.line,
            )


def _check_strength(built: BuiltModel, report: BuildReport) -> None:
    driven = [joint for joint in built.joints.values() if joint.actuator is not None]
    tuning = tune(built.model, driven, built.qpos, PERIOD_S)
    for name, problem in weak_drives(built.model, driven, tuning):
        report.warn(f"joint '{name}'", problem)
    for name, problem in slow_joints(built.model, driven, tuning, built.qpos):
        report.inform(f"joint '{name}'", problem)


def _summary(
    robot: Robot,
    built: BuiltModel,
    cameras: Sequence[CameraSensor],
    sensors: Sequence[LinkSensor],
) -> RobotSummary:
    shapes = [s.geometry for link in robot.links for s in (*link.visuals, *link.collisions)]
    drawn = {
        int(built.model.geom_dataid[geom])
        for geom in range(built.model.ngeom)
        if built.model.geom_type[geom] == mujoco.mjtGeom.mjGEOM_MESH
    }
    return RobotSummary(
        name=robot.name,
        root=robot.root,
        links=len(robot.links),
        joints=dict(Counter(joint.type.value for joint in robot.joints)),
        driven=tuple(name for name, j in built.joints.items() if j.actuator is not None),
        mimicking=tuple(joint.name for joint in robot.joints if joint.mimic is not None),
        cameras=tuple(camera.name for camera in cameras),
        sensors=tuple(f"{sensor.type} {sensor.name}" for sensor in sensors),
        meshes=len({shape.uri for shape in shapes if isinstance(shape, Mesh)}),
        triangles=sum(int(built.model.mesh_facenum[mesh]) for mesh in drawn),
        mass_kg=float(built.model.body_mass[list(built.bodies.values())].sum()),
    )
