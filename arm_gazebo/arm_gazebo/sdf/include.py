"""Find the files that <include> refers to."""

import os
from pathlib import Path

from arm_description.errors import ResourceNotFoundError
from arm_description.resources import resolve_uri
from arm_gazebo.sdf.element import MODEL_FILE, SdfElement
from arm_node.names import listing

GROUND = ("ground_plane", "ground plane")
SUN = ("sun",)
"""Gazebo's own models, which worlds include by name or from its web site."""
MAX_INCLUDE_DEPTH = 50
"""Limit on the depth of nested includes; no sensible world comes near it."""


def included_file(include: SdfElement) -> SdfElement | None:
    """Return the root of the file that an <include> refers to.

    None stands for Gazebo's own ground or sun if no folder has a file of that name, and for a model
    on the web, which is left out.

    Raises:
        WorldError: the file does not exist, is not SDF, or includes itself.
    """
    uri = include.text("uri")
    if not uri:
        raise include.error("needs a <uri>")
    folder = include.source.parent.resolve()
    is_builtin = is_ground(include) or is_sun(include)
    if uri.startswith(("http://", "https://")):
        if not is_builtin:
            include.leave_out(f"'{uri}' is on the web, and nothing is downloaded")
        return None
    try:
        found = resolve_uri(uri, [folder, folder.parent])
    except ResourceNotFoundError as error:
        if is_builtin:
            return None
        hint = "is GZ_SIM_RESOURCE_PATH the folder of the models?"
        raise include.error(f"is not available: {error}\n  {hint}") from error
    return _read(_model_file(found, include), include)


def is_ground(include: SdfElement) -> bool:
    """Return whether an <include> refers to Gazebo's ground."""
    return _last_word(include) in GROUND


def is_sun(include: SdfElement) -> bool:
    """Return whether an <include> refers to Gazebo's sun."""
    return _last_word(include) in SUN


def sdf_file_in(folder: Path) -> Path | None:
    """Return the SDF file of a model's folder, or None."""
    files = (folder / MODEL_FILE, *sorted(folder.glob("*.sdf")))
    return next((file for file in files if os.path.isfile(file)), None)


def _read(file: Path, include: SdfElement) -> SdfElement:
    """Read an included file, unless it is in its own chain of includes."""
    chain = [*include.home.includers, include.source]
    if file.resolve() in (source.resolve() for source in chain):
        start = next(i for i, path in enumerate(chain) if path.resolve() == file.resolve())
        circle = " -> ".join(path.name for path in (*chain[start:], file))
        names = f"{file.parent.name}/{file.name}"
        raise include.error(f"includes {names} within itself: {circle}")
    if len(chain) > MAX_INCLUDE_DEPTH:
        raise include.error(f"is nested more than {MAX_INCLUDE_DEPTH} files deep")
    return SdfElement.read(file, tuple(chain))


def _last_word(include: SdfElement) -> str:
    return include.text("uri").rstrip("/").rpartition("/")[2].lower()


def _model_file(found: Path, include: SdfElement) -> Path:
    """Return the SDF file for a path that is the file itself or a model's folder."""
    if not os.path.isdir(found):
        return found
    file = sdf_file_in(found)
    if file is not None:
        return file
    there = listing(sorted(path.name for path in found.iterdir()))
    raise include.error(f"refers to the folder {found}, which has no .sdf file; it has {there}")
