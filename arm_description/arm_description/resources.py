"""Files that a URDF names: package://, model:// and file:// URIs and plain paths."""

import os
import re
import sys
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from urllib.parse import unquote

from arm_description.errors import ResourceNotFoundError

SCHEMES = ("package://", "model://", "file://")
MODEL_PATH_VARIABLES = ("GZ_SIM_RESOURCE_PATH", "GAZEBO_MODEL_PATH")
"""Where Gazebo's users say where their models are."""
MANIFEST = "package.xml"
FOLDERS_UP = 3
"""At least: the folder of a model's file, its package, and what holds its neighbours."""
_MANIFEST_NAME = re.compile(r"<name>\s*([\w.-]+)\s*</name>")


def resolve_uri(
    uri: str, search_path: Sequence[Path] = (), environ: Mapping[str, str] = os.environ
) -> Path:
    """Return the existing file or folder that a URI names.

    * `package://NAME/REST`: REST in the package's folder; see `package_folders`.
    * `model://NAME/REST`: the same after the folders of GZ_SIM_RESOURCE_PATH and
      GAZEBO_MODEL_PATH.
    * `file:///PATH` and an absolute path: that file.
    * a relative path: in each folder of the search path, then in the working folder.

    `..` may lead to another of the given folders, and not out of them or of a package: a
    description that comes from anywhere names its own files.

    Args:
        uri: what the URDF says.
        search_path: folders; for package:// they hold packages, or are the package itself.
        environ: where the variables are read.

    Raises:
        ResourceNotFoundError: names every place tried.
    """
    tried: dict[Path, None] = {}
    for candidate in _candidates(uri.strip(), search_path, environ):
        # os.path.exists, unlike Path.exists, takes names that no file can have.
        if os.path.exists(candidate):
            return candidate
        tried[candidate] = None
    places = "".join(f"\n  {candidate}" for candidate in tried)
    raise ResourceNotFoundError(f"no file for '{uri}'; tried:{places}")


def find_package(
    name: str, search_path: Sequence[Path] = (), environ: Mapping[str, str] = os.environ
) -> Path:
    """Return the folder of a package's data; see `package_folders`.

    Raises:
        ResourceNotFoundError: in one line, for xacro takes it into its own.
    """
    tried: dict[Path, None] = {}
    for folder in package_folders(name, search_path, environ):
        # os.path.isdir, unlike Path.is_dir, takes names that no folder can have.
        if os.path.isdir(folder):
            return folder
        tried[folder] = None
    raise ResourceNotFoundError(f"no package '{name}'; tried {', '.join(map(str, tried))}")


def package_folders(
    name: str, search_path: Sequence[Path], environ: Mapping[str, str]
) -> Iterator[Path]:
    """Yield where a package may be, existing or not.

    First its share folder, under each prefix of AMENT_PREFIX_PATH and under this Python's own;
    then a folder NAME of the search path, and of Gazebo's, who asks the same of it. A folder of
    those, or one in it, that is called otherwise is the package if its package.xml says so, as
    in many a repository.
    """
    yield from (share / name for share in share_folders(environ))
    search = (*search_path, *_model_folders(environ))
    for folder in search:
        yield folder / name
        if folder.name == name:
            yield folder
    for folder in search:
        for place in (folder, *_folders_in(folder)):
            if place.name != name and _package_name(place) == name:
                yield place


def folders_of(model: Path) -> tuple[Path, ...]:
    """Return where a model's own files may be: beside it, in its package, in a neighbour."""
    above = tuple(model.absolute().parents)
    package = next((i for i, folder in enumerate(above) if (folder / MANIFEST).is_file()), 0)
    return above[: max(FOLDERS_UP, package + 2)]


def share_folders(environ: Mapping[str, str] = os.environ) -> list[Path]:
    """Return the folders that hold packages' data, in the order of AMENT_PREFIX_PATH."""
    prefixes = [p for p in environ.get("AMENT_PREFIX_PATH", "").split(os.pathsep) if p]
    return [Path(prefix) / "share" for prefix in dict.fromkeys([*prefixes, sys.prefix])]


def _candidates(
    uri: str, search_path: Sequence[Path], environ: Mapping[str, str]
) -> Iterator[Path]:
    scheme = next((known for known in SCHEMES if uri.lower().startswith(known)), "")
    rest = uri[len(scheme) :]
    if not rest:
        raise ResourceNotFoundError(f"'{uri}' names no file")
    if not scheme and "://" in uri:
        raise ResourceNotFoundError(
            f"cannot read '{uri}'; {', '.join(SCHEMES)} and plain paths are understood"
        )
    if scheme == "file://":
        yield Path(unquote(rest.removeprefix("localhost")))
    elif scheme:
        yield from _in_packages(scheme, rest, search_path, environ)
    elif os.path.isabs(rest):
        yield Path(rest)
    else:
        yield from _in_folders(rest, [*search_path, Path.cwd()])


def _in_folders(rest: str, folders: Sequence[Path]) -> Iterator[Path]:
    roots = [os.path.abspath(folder) for folder in folders]
    paths = [Path(os.path.normpath(os.path.join(root, rest))) for root in roots]
    inside = [path for path in paths if any(path.is_relative_to(root) for root in roots)]
    if not inside:
        raise ResourceNotFoundError(f"'{rest}' leads out of {', '.join(dict.fromkeys(roots))}")
    yield from inside


def _in_packages(
    scheme: str, rest: str, search_path: Sequence[Path], environ: Mapping[str, str]
) -> Iterator[Path]:
    name, _, inside = rest.partition("/")
    # Put together from parts, a URI often has "//": no path of the whole file system.
    inside = inside.lstrip("/")
    if name in ("", ".", ".."):
        raise ResourceNotFoundError(f"'{scheme}{rest}' names no package")
    if os.path.normpath(inside or ".").split(os.sep)[0] == "..":
        raise ResourceNotFoundError(f"'{scheme}{rest}' leads out of the package '{name}'")
    if scheme == "model://":
        yield from (folder / name / inside for folder in _model_folders(environ))
    yield from (folder / inside for folder in package_folders(name, search_path, environ))


def _model_folders(environ: Mapping[str, str]) -> list[Path]:
    paths = (environ.get(variable, "") for variable in MODEL_PATH_VARIABLES)
    return [Path(folder) for path in paths for folder in path.split(os.pathsep) if folder]


def _folders_in(folder: Path) -> list[Path]:
    try:
        return sorted(path for path in folder.iterdir() if os.path.isdir(path))
    except OSError:
        return []


def _package_name(folder: Path) -> str:
    """Return what a folder's package.xml calls it, "" where there is none to be read."""
    try:
        found = _MANIFEST_NAME.search((folder / MANIFEST).read_text(encoding="utf-8"))
    except (OSError, ValueError):
        return ""
    return found.group(1) if found else ""
