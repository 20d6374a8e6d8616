"""The readers that are fuzzed: what each reads, and which errors are its own."""

import argparse
import random
import shlex
import warnings
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import mutation
import seeds

from arm_cli.errors import ArmCliError
from arm_control.errors import ArmControlError
from arm_controller.pose import PoseFileError
from arm_description.errors import DescriptionError
from arm_gazebo.errors import GazeboError
from arm_planning.errors import PlanningError
from launch_py.errors import LaunchError

LONGEST_ARGUMENT = 131_072
"""What Linux takes as one word of a command line, in bytes."""
OWN_ERRORS = (
    *(ArmCliError, ArmControlError, DescriptionError, GazeboError, LaunchError, PoseFileError),
    PlanningError,
)


@dataclass(frozen=True, slots=True)
class Target:
    """One reader.

    Attributes:
        make: the input of a number, and what it is called.
        read: reads it in a folder; returns whether it found nothing to refuse.
    """

    make: Callable[[random.Random], tuple[str, bytes]]
    read: Callable[[Path, str, bytes], bool]


def _xml(name: str, *texts: str) -> Callable[[random.Random], tuple[str, bytes]]:
    files = tuple(text.encode() for text in texts)
    return lambda chance: (name, mutation.mutant(files, chance, is_xml=True))


def _text(name: str, *texts: str) -> Callable[[random.Random], tuple[str, bytes]]:
    files = tuple(text.encode() for text in texts)
    return lambda chance: (name, mutation.mutant(files, chance, is_xml=False))


def _read_urdf(folder: Path, name: str, data: bytes) -> bool:
    from arm_description.xacro.expansion import expand_xacro_file
    from arm_gazebo.check.description import check_description

    path = seeds.write(folder, name, data)
    return check_description(expand_xacro_file(path).text, str(path)).is_usable


def _read_xacro(folder: Path, name: str, data: bytes) -> bool:
    from arm_description.urdf.parser import parse_urdf
    from arm_description.xacro.expansion import expand_xacro_file

    parse_urdf(expand_xacro_file(seeds.write(folder, name, data)).text)
    return True


def _read_srdf(_folder: Path, name: str, data: bytes) -> bool:
    from arm_description.urdf.parser import parse_urdf
    from arm_planning.robot.build import planning_model
    from arm_planning.robot.srdf import parse_srdf, srdf_text

    robot = parse_urdf(seeds.URDF, remark=lambda _: None)
    text = data.decode("utf-8", "surrogateescape")
    srdf = parse_srdf(text, robot, name, lambda _: None)
    planning_model(robot, srdf, warn=lambda _: None)
    assert parse_srdf(srdf_text(srdf), robot, remark=lambda _: None) == srdf
    return True


def _read_planning_texts(_folder: Path, name: str, data: bytes) -> bool:
    """Read a text as limits of joints and as a .scene file."""
    from arm_description.urdf.parser import parse_urdf
    from arm_planning.robot.build import planning_model
    from arm_planning.robot.limits import read_joint_limits
    from arm_planning.robot.srdf import Srdf
    from arm_planning.scene.frames import LinkPoses
    from arm_planning.scene.scene import PlanningScene
    from arm_planning.scene.scene_file import with_scene_file

    robot = parse_urdf(seeds.URDF, remark=lambda _: None)
    text = data.decode("utf-8", "surrogateescape")

    def read_limits() -> object:
        limits = read_joint_limits(text, name, lambda _: None)
        return planning_model(robot, Srdf("r"), limits, lambda _: None)

    model = planning_model(robot, Srdf("r"), warn=lambda _: None)
    scene, links = PlanningScene({"j0": 0.0}), LinkPoses(model, {})
    return _succeeds(read_limits) | _succeeds(lambda: with_scene_file(scene, links, text, name))


def _read_world(folder: Path, name: str, data: bytes) -> bool:
    from arm_gazebo.model.world_file import check_world

    check_world(seeds.write(folder, name, data))
    return True


_sources: list[object] = []


def _read_mjcf(folder: Path, name: str, data: bytes) -> bool:
    from arm_gazebo.world.spawn_model import ModelSource

    if not _sources:
        _sources.append(ModelSource(0.002))
    source = _sources[0]
    assert isinstance(source, ModelSource)
    source.read(str(seeds.write(folder, name, data)), "")
    return True


def _mesh_maker() -> Callable[[random.Random], tuple[str, bytes]]:
    kinds = seeds.meshes()

    def make(chance: random.Random) -> tuple[str, bytes]:
        suffix = chance.choice(list(kinds))
        if suffix in (".glb", ".3mf") or (suffix == ".stl" and chance.random() < 0.5):
            return f"a{suffix}", mutation.mutant_of_bytes(kinds[suffix], chance)
        return f"a{suffix}", mutation.mutant(kinds[suffix], chance, suffix == ".dae")

    return make


def _read_mesh(folder: Path, name: str, data: bytes) -> bool:
    from arm_description.mesh.file import check_mesh_file, read_mesh_file
    from arm_gazebo.mesh.part import MeshPart

    path = seeds.write(folder, name, data)
    check_mesh_file(path)
    for mesh in read_mesh_file(path):
        MeshPart.of(mesh).scaled((1.0, 1.0, 1.0))
    return True


def _read_yaml(folder: Path, name: str, data: bytes) -> bool:
    from arm_control.manager.parameter_file import ControllerParameterFile
    from arm_controller.pose import read_pose_file
    from arm_gazebo.launching import controllers_file, several_robots

    path = seeds.write(folder, name, data)
    readers: tuple[Callable[[], object], ...] = (
        lambda: controllers_file.startable_controllers(
            controllers_file.substitute_arguments(path, {"side": "l"}), frozenset({"x"})
        ),
        lambda: controllers_file.controllers_in_namespace("left", path),
        lambda: ControllerParameterFile(str(path)).lookup("arm", "/left", "joints"),
        lambda: several_robots.read_robots_file(path),
        lambda: read_pose_file(path, ("a", "b")),
    )
    return any([_succeeds(reader) for reader in readers])


def _read_bag(folder: Path, name: str, data: bytes) -> bool:
    from arm_cli.bag_format.reader import BagReader

    with BagReader(seeds.write(folder, name, data)) as bag:
        for _ in bag.messages([topic.name for topic in bag.topics]):
            pass
    return True


def _read_arguments(folder: Path, _: str, data: bytes) -> bool:
    from arm_description.xacro.expansion import arguments_of_text
    from arm_gazebo.launching.gz_arguments import launch_arguments
    from launch_py.command.command_line import parse_request
    from launch_py.ros.parameters import read_yaml
    from launch_py.ros.substitution_parser import parse_substitutions

    # A word of a command line ends at a null.
    data = data[:LONGEST_ARGUMENT].replace(b"\0", b"")
    text = data.decode("utf-8", "surrogateescape")
    try:
        words = shlex.split(text)
    except ValueError:
        words = text.split()
    switches = dict.fromkeys(("show_args", "print_plan", "show_all", "debug"), False)
    asked = argparse.Namespace(words=words, **switches)
    readers: tuple[Callable[[], object], ...] = (
        lambda: parse_request(asked, {}),
        lambda: launch_arguments(text),
        lambda: arguments_of_text(text),
        lambda: read_yaml(text),
        lambda: parse_substitutions(text),
    )
    # Nearly everything is a text without substitutions, and a YAML word.
    return sum([_succeeds(reader) for reader in readers]) > 2


def _succeeds(read: Callable[[], object]) -> bool:
    """Return whether a reader takes what it is given, or refuses it in a sentence."""
    try:
        read()
    except OWN_ERRORS as error:
        _check_sentence(error)
        return False
    return True


def read_input(target: Target, folder: Path, name: str, data: bytes) -> bool:
    """Return whether a target takes an input; False where it refuses it in a sentence."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        try:
            return target.read(folder, name, data)
        except OWN_ERRORS as error:
            _check_sentence(error)
            return False


def _check_sentence(error: Exception) -> None:
    assert str(error).strip(), f"{type(error).__name__} says nothing"


def _request_target() -> Target:
    """Return the target of requests to move_group, whose messages only it imports."""
    import move_group_requests

    desk = move_group_requests.Desk()
    return Target(move_group_requests.make, lambda _, name, data: desk.answer(name, data))


TARGETS: dict[str, Callable[[], Target]] = {
    "urdf": lambda: Target(_xml("a.urdf", seeds.URDF), _read_urdf),
    "xacro": lambda: Target(_xml("a.xacro", seeds.XACRO), _read_xacro),
    "srdf": lambda: Target(_xml("a.srdf", seeds.SRDF), _read_srdf),
    "planning": lambda: Target(
        _text("a.yaml", seeds.JOINT_LIMITS, seeds.SCENE_FILE), _read_planning_texts
    ),
    "sdf": lambda: Target(_xml("a.sdf", seeds.SDF), _read_world),
    "mjcf": lambda: Target(_xml("a.xml", seeds.MJCF), _read_mjcf),
    "meshes": lambda: Target(_mesh_maker(), _read_mesh),
    "yaml": lambda: Target(
        _text("a.yaml", seeds.CONTROLLERS, seeds.ROBOTS, seeds.PARAMETERS), _read_yaml
    ),
    "mcap": lambda: Target(
        lambda chance: ("a.mcap", mutation.mutant_of_bytes(seeds.bags(), chance)), _read_bag
    ),
    "arguments": lambda: Target(_text("", *seeds.ARGUMENTS), _read_arguments),
    "requests": _request_target,
}
