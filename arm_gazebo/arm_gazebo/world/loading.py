"""Load another world for a running simulation with its robots."""

import logging
import tempfile
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING

from arm_description.errors import DescriptionError, ResourceNotFoundError, XmlError
from arm_description.resources import resolve_uri
from arm_description.urdf.xml_document import parse_xml
from arm_gazebo.build_report import BuildOutcome, BuildReport
from arm_gazebo.errors import GazeboError, Refusal, RequestError
from arm_gazebo.launching.world_path import find_world, shipped_worlds
from arm_gazebo.mjcf.memory_limit import SPAWN_LIMIT, MemoryLimit
from arm_gazebo.mjcf.references import check_readable
from arm_gazebo.mjcf.size import check_mjcf_size
from arm_gazebo.model.builder import build_world
from arm_gazebo.model.built_model import BuiltModel
from arm_gazebo.model.world_file import SDF_SUFFIXES, load_world
from arm_gazebo.robot.part import RobotInWorld
from arm_node.frozen import frozen
from arm_node.user_file import read_text

if TYPE_CHECKING:
    from arm_gazebo.world.spawn_model import ModelSource

SUFFIXES = (".xml", ".mjcf", *SDF_SUFFIXES)
TEXT_SUFFIXES = {"sdf": ".sdf", "mujoco": ".xml"}
LEFT_OUT = (BuildOutcome.DROPPED, BuildOutcome.LEFT_OUT)
NO_WORLD = "<mujoco model='no_world'/>"

logger = logging.getLogger(__name__)


@frozen
class NamedWorld:
    """A world that can be loaded.

    Attributes:
        name: name for people.
        uri: URI of its file, "" if it was given as text.
        description: text for people.
    """

    name: str
    uri: str = ""
    description: str = ""


class WorldLoader:
    """Puts the robots into worlds. One thread other than the simulation's.

    The first robot's options give the memory limit of a world, `spawn_limit` that of an MJCF which
    is spawned into it.

    Attributes:
        world: the present world; None for none.
    """

    def __init__(
        self, entries: Sequence[RobotInWorld], spawn_limit: MemoryLimit = SPAWN_LIMIT
    ) -> None:
        self.world: NamedWorld | None = None
        self._entries = tuple(entries)
        self._spawn_limit = spawn_limit

    @cached_property
    def source(self) -> "ModelSource":
        """Reads models that are spawned into the world."""
        # Imported here, because most runs spawn nothing.
        from arm_gazebo.world.spawn_model import ModelSource

        each = [entry.options for entry in self._entries]
        folders = tuple(dict.fromkeys(f for options in each for f in options.resources.folders))
        return ModelSource(each[0].step_s, folders, each[0].mesh_cache, self._spawn_limit)

    def begin(self, world: str) -> BuiltModel:
        """Return the first world with the robots in it, and log what is repaired or left out.

        Args:
            world: a shipped world's name, or the path of a MuJoCo XML or SDF file.

        Raises:
            GazeboError: the world or a robot cannot be simulated.
        """
        built = build_world(self._entries, world)
        built.report.log(logging.getLogger("arm_gazebo"))
        self.world = named_world(find_world(world), built.report)
        return built

    def load(self, uri: str, text: str, all_elements: bool) -> tuple[BuiltModel, NamedWorld]:
        """Return a world with the robots in it.

        Args:
            uri: a shipped world's name, a path or a URI; takes precedence over `text`.
            text: SDF or MuJoCo XML.
            all_elements: whether to refuse a world with elements that cannot be simulated.

        Raises:
            RequestError: the world does not exist, or cannot be simulated with the robots.
        """
        if uri.strip():
            path = _find(uri.strip())
            built = self._tried_and_built(path, all_elements)
            return built, named_world(path, built.report)
        if not text.strip():
            raise RequestError(
                Refusal.NO_RESOURCE,
                "no world to load: neither uri nor resource_string is given",
            )
        built = self._build_text(text, all_elements)
        return built, NamedWorld("resource_string", description=built.report.left_out)

    def load_empty(self) -> BuiltModel:
        """Return the robots in an empty world without a floor."""
        with _temporary_file(NO_WORLD, "mujoco") as path:
            return self._build(path, False)

    def _build_text(self, text: str, all_elements: bool) -> BuiltModel:
        try:
            tag = str(parse_xml(text, "resource_string").tag)
        except XmlError as error:
            raise RequestError(Refusal.UNREADABLE, str(error)) from error
        if tag not in TEXT_SUFFIXES:
            raise RequestError(
                Refusal.UNSUPPORTED_FORMAT,
                f"resource_string: <{tag}> is neither <sdf> nor <mujoco>",
            )
        if tag == "mujoco":
            from arm_gazebo.world.trial import check_mjcf_files

            check_mjcf_files(text)
        with _temporary_file(text, tag) as path:
            return self._tried_and_built(path, all_elements)

    def _tried_and_built(self, path: Path, all_elements: bool) -> BuiltModel:
        """Build an untrusted world; an MJCF is first compiled in a separate process."""
        if path.suffix not in SDF_SUFFIXES and path not in shipped_worlds().values():
            self._try(path)
        return self._build(path, all_elements)

    def _try(self, path: Path) -> None:
        # Imported here, because most runs load no world from outside.
        from arm_gazebo.world.trial import WORLD_PROCESSOR_S

        limit = self._entries[0].options.memory_limit
        try:
            text = read_text(path)
            check_readable(text, path)
            check_mjcf_size(text, path.name, path, limit)
        except (GazeboError, DescriptionError, OSError, ValueError) as error:
            raise RequestError(Refusal.UNREADABLE, " ".join(str(error).split())) from error
        problem = self.source.trial.problem("", path, limit, WORLD_PROCESSOR_S)
        if problem:
            raise RequestError(Refusal.UNREADABLE, f"the world {path} is not usable: {problem}")

    def _build(self, path: Path, all_elements: bool) -> BuiltModel:
        try:
            if all_elements:
                report = BuildReport()
                load_world(path, report)
                left_out = [str(f) for f in report.findings if f.outcome in LEFT_OUT]
                if left_out:
                    raise RequestError(Refusal.UNSUPPORTED_ELEMENTS, "; ".join(left_out))
            built = build_world(self._entries, path)
            if built.report.left_out:
                logger.warning("world %s: %s", path.stem, built.report.left_out)
            return built
        except RequestError:
            raise
        except (GazeboError, DescriptionError, OSError, ValueError) as error:
            raise RequestError(Refusal.UNREADABLE, " ".join(str(error).split())) from error


def named_world(path: Path, report: BuildReport | None = None) -> NamedWorld:
    """Return the name and description of a world file."""
    shipped = "shipped" if path in shipped_worlds().values() else ""
    left_out = report.left_out if report else ""
    description = "; ".join(filter(None, (shipped, left_out)))
    return NamedWorld(path.stem, path.absolute().as_uri(), description)


def available_worlds(folders: Sequence[str], go_on: bool = False) -> list[NamedWorld]:
    """Return the shipped worlds, then the worlds in folders, given as paths or URIs.

    `go_on` skips folders that cannot be read.

    Raises:
        RequestError: a folder cannot be read.
    """
    found = list(shipped_worlds().values())
    for folder in folders:
        try:
            files = sorted(resolve_uri(folder).iterdir())
        except (ResourceNotFoundError, OSError) as error:
            if not go_on:
                raise RequestError(Refusal.FAILED, str(error)) from error
            continue
        found += [file for file in files if file.suffix in SUFFIXES]
    return [named_world(file) for file in found]


@contextmanager
def _temporary_file(text: str, tag: str) -> Iterator[Path]:
    """Write a text to a file, because the readers take files and look for others beside them."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder, "resource_string").with_suffix(TEXT_SUFFIXES[tag])
        path.write_text(text, encoding="utf-8")
        yield path


def _find(uri: str) -> Path:
    try:
        path = resolve_uri(uri) if "://" in uri else find_world(uri)
    except (GazeboError, ResourceNotFoundError) as error:
        raise RequestError(Refusal.NO_RESOURCE, str(error)) from error
    if path.suffix not in SUFFIXES:
        raise RequestError(
            Refusal.UNSUPPORTED_FORMAT, f"{path} does not end in one of {', '.join(SUFFIXES)}"
        )
    return path
