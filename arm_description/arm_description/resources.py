"""Finds the files that a description names: package://, model:// and file:// URIs and paths.

The simulation, the page, `arm check` and xacro's $(find) all use a `ResourceFinder`.
"""

import os
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from types import MappingProxyType
from typing import TYPE_CHECKING, TypeVar
from urllib.parse import unquote

from arm_description.errors import ResourceNotFoundError
from arm_description.package_search import (
    GAZEBO,
    SUITE,
    PackagePlace,
    PackageSearch,
    model_folders,
)
from arm_description.urdf.description_source import source_of

if TYPE_CHECKING:
    from arm_description.urdf.robot import Collision, Robot, Visual

SCHEMES = ("package://", "model://", "file://")
ShapeT = TypeVar("ShapeT", "Visual", "Collision")


class ResourceFinder:
    """Finds the files that one description names, and records where its packages are.

    Args:
        file: the description's file; None if unknown.
        package_path: folders that the user names for packages; see `PackageSearch`.
        environ: the environment variables.
    """

    def __init__(
        self,
        file: Path | None = None,
        package_path: Sequence[Path] = (),
        environ: Mapping[str, str] = os.environ,
    ) -> None:
        self._environ = environ
        self._search = PackageSearch(file, package_path, environ)
        self._used: dict[str, dict[Path, PackagePlace]] = {}

    @classmethod
    def of_description(cls, urdf: str, package_path: Sequence[Path] = ()) -> "ResourceFinder":
        """Return the finder of a description, which may contain its own path.

        Args:
            urdf: the description's text.
            package_path: folders to search before those that the description names.
        """
        source = source_of(urdf)
        given = dict.fromkeys((*package_path, *source.package_path))
        return cls(source.file, tuple(given))

    @property
    def used(self) -> Mapping[str, tuple[PackagePlace, ...]]:
        """Where each package was found so far; a package may have files in several folders."""
        return MappingProxyType({name: tuple(found.values()) for name, found in self._used.items()})

    @property
    def folders(self) -> tuple[Path, ...]:
        """Folders in which relative paths are looked up."""
        return self._search.folders()

    def find(self, uri: str) -> Path:
        """Return the existing file or folder that a URI names.

        * `package://NAME/REST`: REST in the package's folder; see `PackageSearch`.
        * `model://NAME/REST`: first in the folders of GZ_SIM_RESOURCE_PATH and GAZEBO_MODEL_PATH,
          then like package://.
        * `file:///PATH` and an absolute path: that file.
        * a relative path: beside the description's file, in its package, in the folders that the
          user names, then in the working folder.

        `..` may lead to another of the given folders, but not out of them or out of a package, so
        that a description from an unknown source can only name its own files.

        Raises:
            ResourceNotFoundError: the file does not exist; the message names every place tried.
        """
        tried: dict[Path, None] = {}
        for candidate in self._candidates(uri.strip()):
            # os.path.exists, unlike Path.exists, accepts names that no file can have.
            if os.path.exists(candidate):
                return candidate
            tried[candidate] = None
        places = "".join(f"\n  {candidate}" for candidate in tried)
        raise ResourceNotFoundError(f"no file for '{uri.strip()}'; tried:{places}")

    def package(self, name: str) -> Path:
        """Return the folder of a package's data; see `PackageSearch`.

        Raises:
            ResourceNotFoundError: there is none; a one-line message, which xacro quotes.
        """
        tried: dict[Path, None] = {}
        for place in self._search.places(name):
            # os.path.isdir, unlike Path.is_dir, accepts names that no folder can have.
            if os.path.isdir(place.folder):
                self._remember(name, place)
                return place.folder
            tried[place.folder] = None
        raise ResourceNotFoundError(f"no package '{name}'; tried {', '.join(map(str, tried))}")

    def located(self, robot: "Robot") -> "Robot":
        """Return the robot with absolute paths for its meshes; those not found stay unchanged."""
        return replace(
            robot,
            links=tuple(
                replace(
                    link,
                    visuals=tuple(map(self._located, link.visuals)),
                    collisions=tuple(map(self._located, link.collisions)),
                )
                for link in robot.links
            ),
        )

    def _located(self, shape: ShapeT) -> ShapeT:
        # Imported here, because xacro, and so the launcher, finds files without it.
        from arm_description.urdf.robot import Mesh

        mesh = shape.geometry
        if not isinstance(mesh, Mesh):
            return shape
        try:
            path = self.find(mesh.uri)
        except ResourceNotFoundError:
            return shape
        return replace(shape, geometry=replace(mesh, uri=str(path.absolute())))

    def _candidates(self, uri: str) -> Iterator[Path]:
        scheme = next((known for known in SCHEMES if uri.lower().startswith(known)), "")
        rest = uri[len(scheme) :]
        if not rest:
            raise ResourceNotFoundError(f"'{uri}' names no file")
        if not scheme and "://" in uri:
            raise ResourceNotFoundError(
                f"cannot read '{uri}'; {', '.join(SCHEMES)} and plain paths are supported"
            )
        if scheme == "file://":
            yield Path(unquote(rest.removeprefix("localhost")))
        elif scheme:
            yield from self._in_packages(scheme, rest)
        elif os.path.isabs(rest):
            yield Path(rest)
        else:
            yield from _in_folders(rest, [*self._search.folders(), Path.cwd()])

    def _in_packages(self, scheme: str, rest: str) -> Iterator[Path]:
        name, _, inside = rest.partition("/")
        # RViz decodes "%20", too. A URI that is joined from parts often has "//", which must not
        # start an absolute path.
        ways = dict.fromkeys(way.lstrip("/") for way in (inside, unquote(inside)))
        if name in ("", ".", ".."):
            raise ResourceNotFoundError(f"'{scheme}{rest}' names no package")
        if any(os.path.normpath(way or ".").split(os.sep)[0] == ".." for way in ways):
            raise ResourceNotFoundError(f"'{scheme}{rest}' leads out of the package '{name}'")
        is_elsewhere = False
        for place in self._places(scheme, name):
            if place.origin == SUITE and is_elsewhere:
                # A file missing from the user's package must not come from the suite's package of
                # that name.
                return
            paths = [place.folder / way for way in ways]
            if any(map(os.path.exists, paths)):
                self._remember(name, place)
            is_elsewhere = is_elsewhere or self._search.is_package(place.folder, name)
            yield from paths

    def _places(self, scheme: str, name: str) -> Iterator[PackagePlace]:
        if scheme == "model://":
            for folder in model_folders(self._environ):
                yield PackagePlace(folder / name, GAZEBO)
        yield from self._search.places(name)

    def _remember(self, name: str, place: PackagePlace) -> None:
        self._used.setdefault(name, {}).setdefault(place.folder, place)


def resolve_uri(
    uri: str, search_path: Sequence[Path] = (), environ: Mapping[str, str] = os.environ
) -> Path:
    """Return the existing file or folder of a URI that is not from a description's file.

    Args:
        uri: see `ResourceFinder.find`.
        search_path: folders for packages and for relative paths.
        environ: the environment variables.

    Raises:
        ResourceNotFoundError: the file does not exist; the message names every place tried.
    """
    return ResourceFinder(None, search_path, environ).find(uri)


def _in_folders(rest: str, folders: Sequence[Path]) -> Iterator[Path]:
    roots = [os.path.abspath(folder) for folder in folders]
    paths = [Path(os.path.normpath(os.path.join(root, rest))) for root in roots]
    inside = [path for path in paths if any(path.is_relative_to(root) for root in roots)]
    if not inside:
        raise ResourceNotFoundError(f"'{rest}' leads out of {', '.join(dict.fromkeys(roots))}")
    yield from inside
