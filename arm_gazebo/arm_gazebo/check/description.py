"""Reads a robot description as the simulation would, without starting it, and tells all."""

import re
from collections import Counter
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass

import mujoco

from arm_control.errors import ArmControlError
from arm_control.hardware_info import HardwareInfo, parse_hardware_info
from arm_description.errors import DescriptionError
from arm_description.robot import Mesh, Robot
from arm_description.urdf import parse_urdf
from arm_description.urdf_element import Remark
from arm_gazebo.build_report import BuildReport, Finding, Outcome
from arm_gazebo.check.leftovers import leftovers
from arm_gazebo.drives.servo_tuning import too_weak, tune
from arm_gazebo.errors import GazeboError
from arm_gazebo.hardware.simulated_hardware import MAX_EFFORT, STATES
from arm_gazebo.launching.default_control import commandable_joints, with_hardware
from arm_gazebo.model.builder import build_model
from arm_gazebo.model.built_model import BuiltModel
from arm_gazebo.robot.build_options import BuildOptions
from arm_gazebo.robot.gazebo_tags import GazeboTags, parse_gazebo_tags
from arm_gazebo.robot.mimic_joints import without_released
from arm_gazebo.robot.part import DEFAULT_OPTIONS
from arm_gazebo.sensors.camera import CameraSensor
from arm_gazebo.sensors.camera_reader import parse_cameras
from arm_gazebo.sensors.link_sensor import LinkSensor
from arm_gazebo.sensors.reader import parse_link_sensors

PERIOD_S = 0.01
JOINT_INTERFACES = (*STATES, MAX_EFFORT)
_LINE = re.compile(r"\bline (\d+)")


@dataclass(frozen=True, slots=True)
class RobotSummary:
    """What was read of a robot.

    Attributes:
        name: of the robot.
        root: its root link.
        links: how many.
        joints: how many of each type.
        driven: joints that are commanded.
        mimicking: joints that follow others.
        cameras: names of the cameras.
        sensors: types and names of the other sensors.
        meshes: mesh files used.
        triangles: of all meshes in the model.
        mass_kg: of all links, repaired ones as repaired.
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
        parts = [_counted(self.links, "link"), _counted(sum(self.joints.values()), "joint")]
        if self.joints:
            types = ", ".join(f"{count} {kind}" for kind, count in self.joints.items())
            parts[-1] += f" ({types})"
        parts += [f"{len(self.driven)} driven"] if self.driven else []
        parts += [f"{len(self.mimicking)} mimicking"] if self.mimicking else []
        parts.append(f"{self.mass_kg:.4g} kg")
        if self.meshes:
            triangles = _counted(self.triangles, "triangle")
            parts.append(f"{_counted(self.meshes, 'mesh', 'meshes')} of {triangles}")
        parts += [f"camera {name}" for name in self.cameras]
        parts += self.sensors
        return f"robot '{self.name}', root '{self.root}': {', '.join(parts)}"


def _counted(number: int, one: str, many: str = "") -> str:
    return f"{number} {one if number == 1 else many or one + 's'}"


@dataclass(frozen=True, slots=True)
class DescriptionCheck:
    """The result: `robot` is None where there is no model."""

    robot: RobotSummary | None
    findings: tuple[Finding, ...]

    @property
    def is_usable(self) -> bool:
        """Whether the robot can be simulated."""
        return not any(finding.outcome is Outcome.FAILED for finding in self.findings)


def check_description(
    urdf: str, source: str, options: BuildOptions = DEFAULT_OPTIONS
) -> DescriptionCheck:
    """Return what becomes of a description.

    Args:
        urdf: the text, xacro expanded.
        source: what the text is called in messages.
        options: for the model; `strict` makes a mesh that cannot be had an error.
    """
    report = BuildReport()
    robot: Robot | None = None
    hardware: tuple[HardwareInfo, ...] = ()
    cameras: tuple[CameraSensor, ...] = ()
    sensors: tuple[LinkSensor, ...] = ()
    tags = GazeboTags()

    def note(remark: Remark) -> None:
        report.repair(remark.element, remark.problem, remark.line)

    with _failures(report, source):
        report.add(*leftovers(urdf, source))
    if report.findings and report.findings[-1].outcome is Outcome.FAILED:
        # What is not XML says nothing to anybody else either.
        return DescriptionCheck(None, report.findings)
    with _failures(report, source):
        robot = parse_urdf(urdf, source, note)
    with _failures(report, source):
        cameras = parse_cameras(urdf)
        tags = parse_gazebo_tags(urdf)
    if robot is not None:
        with _failures(report, source):
            sensors = parse_link_sensors(urdf, robot)
    with _failures(report, source):
        hardware = parse_hardware_info(urdf)
        if not hardware and robot is not None:
            hardware = _made_up(urdf, robot, report)
        _check_interfaces(hardware, sensors, report)
    summary = None
    if robot is not None:
        with _failures(report, source):
            built = build_model(
                robot, hardware, cameras, options=options, tags=tags, sensors=sensors
            )
            report.add(*built.report.findings)
            _check_strength(built, report)
            summary = _summary(without_released(robot, hardware), built, cameras, sensors)
    return DescriptionCheck(summary, _without_repeats(report.findings))


@contextmanager
def _failures(report: BuildReport, source: str) -> Iterator[None]:
    """Turn an error into a finding, so that the other parts are looked at all the same."""
    try:
        yield
    except (DescriptionError, ArmControlError, GazeboError) as error:
        message = str(error).removeprefix(source).removeprefix(", ").removeprefix(" ")
        line = int(found.group(1)) if (found := _LINE.search(message)) else 0
        message = message.removeprefix(f"line {line}: ")
        report.add(Finding(Outcome.FAILED, source, message, line))


def _made_up(urdf: str, robot: Robot, report: BuildReport) -> tuple[HardwareInfo, ...]:
    joints = commandable_joints(robot)
    report.inform(
        f"robot '{robot.name}'",
        "it has no <ros2_control> block; sim.launch.py makes one up that commands "
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
        }
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
                f"{unread[0]}{others}: no number, so no limit",
                component.line,
            )


def _check_strength(built: BuiltModel, report: BuildReport) -> None:
    driven = [joint for joint in built.joints.values() if joint.actuator is not None]
    tuning = tune(built.model, driven, built.qpos, PERIOD_S)
    for name, problem in too_weak(built.model, driven, tuning):
        report.warn(f"joint '{name}'", problem)


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
        joints=dict(Counter(joint.type for joint in robot.joints)),
        driven=tuple(name for name, j in built.joints.items() if j.actuator is not None),
        mimicking=tuple(joint.name for joint in robot.joints if joint.mimic is not None),
        cameras=tuple(camera.name for camera in cameras),
        sensors=tuple(f"{sensor.type} {sensor.name}" for sensor in sensors),
        meshes=len({shape.uri for shape in shapes if isinstance(shape, Mesh)}),
        triangles=sum(int(built.model.mesh_facenum[mesh]) for mesh in drawn),
        mass_kg=float(built.model.body_mass[list(built.bodies.values())].sum()),
    )


def _without_repeats(findings: Sequence[Finding]) -> tuple[Finding, ...]:
    return tuple(dict.fromkeys(findings))
