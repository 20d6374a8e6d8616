"""Worlds that a running simulation can go on in, with the robots that it has."""

import tempfile
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from arm_description.errors import DescriptionError, ResourceNotFoundError, XmlError
from arm_description.resources import resolve_uri
from arm_description.xml_document import parse_xml
from arm_gazebo.build_report import BuildReport, Outcome
from arm_gazebo.errors import GazeboError
from arm_gazebo.model.builder import build_world
from arm_gazebo.model.built_model import BuiltModel
from arm_gazebo.model.world_file import SDF_SUFFIXES, load_world
from arm_gazebo.model.world_path import find_world, shipped_worlds
from arm_gazebo.robot.part import RobotInWorld
from arm_gazebo.world.mjcf_files import check_mjcf_files
from arm_gazebo.world.refusal import Refusal, RefusedError

SUFFIXES = (".xml", ".mjcf", *SDF_SUFFIXES)
TEXT_SUFFIXES = {"sdf": ".sdf", "mujoco": ".xml"}
NOWHERE = "<mujoco model='no_world'/>"


@dataclass(frozen=True, slots=True)
class NamedWorld:
    """A world that can be loaded.

    Attributes:
        name: for people.
        uri: of its file, "" where it was given as a text.
        description: for people.
    """

    name: str
    uri: str = ""
    description: str = ""


class WorldLoader:
    """Reads worlds and builds the robots into them; one thread, not the simulation's.

    Args:
        entries: the robots.
    """

    def __init__(self, entries: Sequence[RobotInWorld]) -> None:
        self._entries = tuple(entries)

    def load(self, uri: str, text: str, all_elements: bool) -> tuple[BuiltModel, NamedWorld]:
        """Return a world with the robots in it.

        Args:
            uri: a shipped world's name, a path or a URI; goes before `text`.
            text: SDF or MuJoCo XML.
            all_elements: refuse a world of which something cannot be simulated.

        Raises:
            RefusedError: there is no such world, or it cannot be simulated with the robots.
        """
        if uri.strip():
            path = _find(uri.strip())
            return self._build(path, all_elements), named_world(path)
        if not text.strip():
            raise RefusedError(
                Refusal.NO_RESOURCE, "no world to load: neither uri nor resource_string is given"
            )
        return self._build_text(text, all_elements), NamedWorld("resource_string")

    def nowhere(self) -> BuiltModel:
        """Return the robots with nothing around them, not even a floor."""
        return self._build_text(NOWHERE, False)

    def _build_text(self, text: str, all_elements: bool) -> BuiltModel:
        try:
            tag = str(parse_xml(text, "resource_string").tag)
        except XmlError as error:
            raise RefusedError(Refusal.UNREADABLE, str(error)) from error
        if tag not in TEXT_SUFFIXES:
            raise RefusedError(
                Refusal.UNSUPPORTED_FORMAT,
                f"resource_string: <{tag}> is neither <sdf> nor <mujoco>",
            )
        if tag == "mujoco":
            check_mjcf_files(text)
        # The readers of worlds go by files, and files named in the text start beside it.
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder, "resource_string").with_suffix(TEXT_SUFFIXES[tag])
            path.write_text(text, encoding="utf-8")
            return self._build(path, all_elements)

    def _build(self, path: Path, all_elements: bool) -> BuiltModel:
        try:
            if all_elements:
                report = BuildReport()
                load_world(path, report)
                left_out = [str(f) for f in report.findings if f.outcome is Outcome.DROPPED]
                if left_out:
                    raise RefusedError(Refusal.UNSUPPORTED_ELEMENTS, "; ".join(left_out))
            return build_world(self._entries, path)
        except RefusedError:
            raise
        except (GazeboError, DescriptionError, OSError, ValueError) as error:
            raise RefusedError(Refusal.UNREADABLE, " ".join(str(error).split())) from error


def named_world(path: Path) -> NamedWorld:
    """Return what to call the world of a file."""
    shipped = path in shipped_worlds().values()
    return NamedWorld(path.stem, path.absolute().as_uri(), "shipped" if shipped else "")


def available_worlds(folders: Sequence[str], go_on: bool = False) -> list[NamedWorld]:
    """Return the shipped worlds, then those in folders.

    Args:
        folders: paths or URIs.
        go_on: pass over folders that cannot be read.

    Raises:
        RefusedError: a folder cannot be read.
    """
    found = list(shipped_worlds().values())
    for folder in folders:
        try:
            files = sorted(resolve_uri(folder).iterdir())
        except (ResourceNotFoundError, OSError) as error:
            if not go_on:
                raise RefusedError(Refusal.FAILED, str(error)) from error
            continue
        found += [file for file in files if file.suffix in SUFFIXES]
    return [named_world(file) for file in found]


def _find(uri: str) -> Path:
    try:
        path = resolve_uri(uri) if "://" in uri else find_world(uri)
    except (GazeboError, ResourceNotFoundError) as error:
        raise RefusedError(Refusal.NO_RESOURCE, str(error)) from error
    if path.suffix not in SUFFIXES:
        raise RefusedError(Refusal.UNSUPPORTED_FORMAT, f"{path} is none of {', '.join(SUFFIXES)}")
    return path
