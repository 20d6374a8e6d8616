"""Files that a URDF names: package://, model:// and file:// URIs and plain paths."""

import os
import sys
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from urllib.parse import unquote

from arm_description.errors import ResourceNotFoundError

SCHEMES = ("package://", "model://", "file://")
MODEL_PATH_VARIABLES = ("GZ_SIM_RESOURCE_PATH", "GAZEBO_MODEL_PATH")
"""Where Gazebo's users say where their models are."""


def resolve_uri(
    uri: str, search_path: Sequence[Path] = (), environ: Mapping[str, str] = os.environ
) -> Path:
    """Return the existing file or folder that a URI names.

    * `package://NAME/REST`: REST in the package's share folder, under each prefix of
      AMENT_PREFIX_PATH and under this Python's own; then in a folder NAME of the search path.
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
    tried = list(dict.fromkeys(_candidates(uri.strip(), search_path, environ)))
    for candidate in tried:
        # os.path.exists, unlike Path.exists, takes names that no file can have.
        if os.path.exists(candidate):
            return candidate
    places = "".join(f"\n  {candidate}" for candidate in tried)
    raise ResourceNotFoundError(f"no file for '{uri}'; tried:{places}")


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
    if name in ("", ".", ".."):
        raise ResourceNotFoundError(f"'{scheme}{rest}' names no package")
    if os.path.normpath(inside or ".").split(os.sep)[0] == "..":
        raise ResourceNotFoundError(f"'{scheme}{rest}' leads out of the package '{name}'")
    if scheme == "model://":
        for variable in MODEL_PATH_VARIABLES:
            for folder in filter(None, environ.get(variable, "").split(os.pathsep)):
                yield Path(folder) / name / inside
    yield from (share / name / inside for share in share_folders(environ))
    for folder in search_path:
        yield folder / name / inside
        if folder.name == name:
            yield folder / inside
