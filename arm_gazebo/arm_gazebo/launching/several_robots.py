"""The robots of one world: those that a file lists, or copies of one robot on a grid."""

import math
import os
import re
import shlex
from collections.abc import Callable, Mapping
from dataclasses import dataclass, fields, replace
from pathlib import Path
from typing import Any

from arm_description.urdf.parser import ignore_remark, parse_urdf
from arm_gazebo.errors import SimSettingsError
from arm_gazebo.launching.controllers_file import (
    MANAGER,
    PARAMETERS,
    Controllers,
    read_controllers,
    types_of,
)
from arm_gazebo.launching.edited_description import DescriptionCopy, copy_description
from arm_gazebo.launching.robot_setup import SPAWN_AUTO, RobotSetup, set_up_robot
from arm_gazebo.launching.settings_file import parse_yaml, read_text
from arm_node.names import listing
from arm_node.parameter_values import ParameterValueError, read_numbers

TITLE = "the robots' file"
NAMESPACE = re.compile(r"[A-Za-z]\w*", re.ASCII)
LIST_JOINERS: Mapping[str, Callable[[list[str]], str]] = {
    "model_args": shlex.join,
    "spawn": ",".join,
    "package_path": os.pathsep.join,
}
"""The keys that may be lists, and how to join them for sim.launch.py's argument of that name."""


@dataclass(frozen=True, slots=True)
class RobotRequest:
    """One robot of the file; the attributes are named like sim.launch.py's arguments.

    Attributes:
        model: URDF or xacro file.
        model_args: xacro arguments, "a:=1 b:=2".
        controllers: parameter file, "" for the default controllers.
        spawn: controllers to start.
        package_path: folders, separated by colons.
        base: "fixed" or "free".
        pose: x y z roll pitch yaw of the root in the world, in m and rad; () for the default.
        prefix: whether NAMESPACE_ is put before all names of its links and joints.
    """

    model: str
    model_args: str = ""
    controllers: str = ""
    spawn: str = SPAWN_AUTO
    package_path: str = ""
    base: str = "fixed"
    pose: tuple[float, ...] = ()
    prefix: bool = False


def read_robots_file(path: Path | str) -> dict[str, RobotRequest]:
    """Return the robots by namespace; relative paths start in the file's folder.

    Raises:
        SimSettingsError: the file cannot be read, or has an invalid entry.
    """
    file = Path(path).expanduser().absolute()
    content = parse_yaml(read_text(file, TITLE), file, TITLE)
    if not isinstance(content, Mapping) or not content:
        raise SimSettingsError(f"{TITLE} {file} names no robots; it needs NAMESPACE: model:")
    return {str(name): _request(file, str(name), entry) for name, entry in content.items()}


def _request(file: Path, name: str, entry: object) -> RobotRequest:
    where = f"{TITLE} {file}, '{name}'"
    if not NAMESPACE.fullmatch(name):
        raise SimSettingsError(
            f"{where}: this is not a namespace; it takes letters, digits and underscores"
        )
    if not isinstance(entry, Mapping) or not entry.get("model"):
        raise SimSettingsError(f"{where} has no model: FILE")
    known = [field.name for field in fields(RobotRequest)]
    unknown = [str(key) for key in entry if key not in known]
    if unknown:
        raise SimSettingsError(f"{where} has the key '{unknown[0]}'; it takes {listing(known)}")
    # A key without a value counts as missing.
    filled = {key: value for key, value in entry.items() if value is not None}
    pose = _pose(where, filled.pop("pose", []))
    prefix = filled.pop("prefix", False)
    if not isinstance(prefix, bool):
        raise SimSettingsError(
            f"{where}: prefix takes true or false, not {prefix!r}; true puts {name}_ before the "
            "names of links and joints"
        )
    texts = {key: _text(where, key, value) for key, value in filled.items()}
    for key in ("model", "controllers"):
        if texts.get(key) and "://" not in texts[key]:
            texts[key] = str(file.parent / Path(texts[key]).expanduser())
    return RobotRequest(**texts, pose=pose, prefix=prefix)


def _text(where: str, key: str, value: Any) -> str:
    if isinstance(value, list) and key in LIST_JOINERS:
        return LIST_JOINERS[key]([str(word) for word in value])
    if isinstance(value, (list, Mapping)):
        raise SimSettingsError(f"{where}: {key} takes a text, not {value!r}")
    return str(value)


def _pose(where: str, value: Any) -> tuple[float, ...]:
    try:
        pose = tuple(map(float, value if isinstance(value, list) else [value]))
    except (OverflowError, TypeError, ValueError):
        pose = (math.nan,)
    if len(pose) not in (0, 6) or not all(map(math.isfinite, pose)):
        raise SimSettingsError(f"{where}: pose takes x y z roll pitch yaw, not {value!r}")
    return pose


SEPARATORS = re.compile(r"([./])")
"""What stands between the parts of an interface's or a parameter's name."""
BASE_FRAME, ODOMETRY_FRAME = "base_frame_id", "odom_frame_id"
"""Parameters of controllers of wheels."""
DIFF_DRIVE = "diff_drive_controller/DiffDriveController"
AT_ORIGIN = (0.0,) * 6


@dataclass(frozen=True, slots=True)
class PlacedRobot:
    """A robot and its place in the world.

    Attributes:
        setup: the robot with its controllers.
        base: "fixed" or "free".
        pose: x y z roll pitch yaw of the root in the world, in m and rad; () for the default.
        on_floor: whether a free robot stands on the floor at this pose, whatever its z.
    """

    setup: RobotSetup
    base: str
    pose: tuple[float, ...] = ()
    on_floor: bool = False

    def parameters(self) -> dict[str, Any]:
        """Return the simulation node's parameters for the robot."""
        parameters: dict[str, Any] = {**self.setup.parameters(), "base": self.base}
        if self.base == "free" and self.pose:
            parameters |= {"pose": list(self.pose), "on_floor": self.on_floor}
        return parameters


@dataclass(frozen=True, slots=True)
class Grid:
    """The places of copies: rows of a square along y, which follow each other along x.

    Attributes:
        count: the number of copies.
        spacing_m: the distance of neighbours.
        pose: pose of the first copy, x y z roll pitch yaw in m and rad; () for the origin.
    """

    count: int
    spacing_m: float
    pose: tuple[float, ...] = ()

    def poses(self) -> list[tuple[float, ...]]:
        """Return the pose of each copy."""
        columns = math.ceil(math.sqrt(self.count))
        x, y, *rest = self.pose or AT_ORIGIN
        return [
            (x + index // columns * self.spacing_m, y + index % columns * self.spacing_m, *rest)
            for index in range(self.count)
        ]


def robots_of_file(path: str) -> dict[str, PlacedRobot]:
    """Return the robots that a file lists, by namespace.

    Raises:
        SimSettingsError: the file or an entry is invalid.
        DescriptionError: a model does not exist, or is not a robot.
    """
    return {
        name: PlacedRobot(_set_up(name, robot), robot.base, robot.pose)
        for name, robot in read_robots_file(path).items()
    }


def _set_up(name: str, robot: RobotRequest) -> RobotSetup:
    setup = set_up_robot(
        robot.model, robot.model_args, robot.controllers, robot.spawn, robot.package_path
    )
    return (
        _with_prefix(setup, name, _content_of(setup.controllers, name)) if robot.prefix else setup
    )


def _with_prefix(setup: RobotSetup, name: str, content: Mapping[str, Any]) -> RobotSetup:
    """Return a robot with NAME_ before the names of links and joints, in its controllers, too."""
    copy = copy_description(setup.description, name)
    return replace(setup, description=copy.text, controllers=_controllers_of(copy, content))


def read_copies(copies: str, limit: int) -> int:
    """Return the number of copies that a launch argument asks for.

    Raises:
        SimSettingsError: it is not a whole number from 1 to `limit`.
    """
    text = copies.strip()
    count = int(text) if re.fullmatch(r"\d{1,9}", text, re.ASCII) else 0
    if not 1 <= count <= limit:
        raise SimSettingsError(
            f"copies:={copies} is not a number of robots that one world can have: "
            f"a whole number from 1 to {limit}"
        )
    return count


def read_grid(copies: int, spacing: str, pose: str) -> Grid:
    """Return the grid of launch arguments: spacing in m, pose of the first copy, "" for the origin.

    Raises:
        SimSettingsError: a value is not a number, or not one that makes sense.
    """
    try:
        (spacing_m,) = read_numbers([float(spacing)])
    except (ParameterValueError, ValueError):
        spacing_m = 0.0
    if spacing_m <= 0:
        raise SimSettingsError(f"copy_spacing:={spacing} is not a distance above 0, in m")
    try:
        place = read_numbers(pose.strip() or [])
    except ParameterValueError as error:
        raise SimSettingsError(f"pose {error}") from error
    if len(place) not in (0, 6):
        raise SimSettingsError(f"pose takes six numbers, x y z roll pitch yaw, not {pose}")
    return Grid(copies, spacing_m, place)


def copies_of(
    setup: RobotSetup, grid: Grid, base: str = "fixed", namespace: str = ""
) -> dict[str, PlacedRobot]:
    """Return copies of a robot by namespace: NAME_0, NAME_1 and so on.

    NAME is the namespace of the original, or without one the robot's name. Links and joints have
    the prefix NAME_0_, and the controllers' parameters name them so.

    Raises:
        SimSettingsError: the controllers' file or the namespace is invalid.
        DescriptionError: the description is not a robot.
    """
    own = namespace.strip("/")
    name = own or _as_namespace(parse_urdf(setup.description, remark=ignore_remark).name)
    if not NAMESPACE.fullmatch(name):
        raise SimSettingsError(
            f"namespace:={namespace} does not name copies; it takes letters, digits and underscores"
        )
    content = _content_of(setup.controllers, own)
    robots: dict[str, PlacedRobot] = {}
    for index, pose in enumerate(grid.poses()):
        copied = _with_prefix(setup, f"{name}_{index}", content)
        if index > 0:
            copied = replace(copied, remarks=())
        robots[f"{name}_{index}"] = PlacedRobot(copied, base, pose, on_floor=not grid.pose)
    return robots


def _as_namespace(name: str) -> str:
    """Return a robot's name with an underscore for each character that a namespace cannot have."""
    text = re.sub(r"\W", "_", name, flags=re.ASCII)
    return text if NAMESPACE.fullmatch(text) else f"robot_{text}"


def _content_of(controllers: Controllers, namespace: str) -> dict[str, Any]:
    """Return a controllers' file with the nodes of the original's namespace outside of it."""
    above = f"/{namespace}/"
    return {
        node.removeprefix(above): entry for node, entry in read_controllers(controllers).items()
    }


def _controllers_of(copy: DescriptionCopy, content: Mapping[str, Any]) -> dict[str, Any]:
    """Return the controllers' parameters with the names of a copy.

    The manager's own parameters name controllers, and no links or joints.
    """
    types = types_of(content)
    renamed: dict[str, Any] = {}
    for node, entry in content.items():
        name = node.rpartition("/")[2]
        if name == MANAGER:
            renamed[node] = entry
            continue
        parameters = _renamed(entry[PARAMETERS], copy.names)
        if BASE_FRAME in parameters:
            odometry = parameters.get(ODOMETRY_FRAME, "odom")
            parameters[ODOMETRY_FRAME] = f"{copy.name}_{odometry}"
        if types.get(name) == DIFF_DRIVE:
            # The names above are unique without the namespace, which it would add.
            parameters["tf_frame_prefix_enable"] = False
        renamed[node] = {PARAMETERS: parameters}
    return renamed


def _renamed(value: Any, names: Mapping[str, str]) -> Any:
    """Return parameters in which keys and values have new names."""
    if isinstance(value, Mapping):
        return {_renamed(key, names): _renamed(entry, names) for key, entry in value.items()}
    if isinstance(value, list):
        return [_renamed(entry, names) for entry in value]
    if not isinstance(value, str) or value.startswith("/"):  # A file, or an absolute name.
        return value
    return "".join(names.get(part, part) for part in SEPARATORS.split(value))
