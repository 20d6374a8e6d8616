"""A <world> or a <model> with the models in it, written in place or included."""

import os
from collections.abc import Iterator
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from arm_description.errors import ResourceNotFoundError
from arm_description.resources import resolve_uri
from arm_gazebo.sdf.element import MODEL_FILE, SdfElement
from arm_gazebo.sdf.frames import SdfFrames
from arm_node.frozen import frozen
from arm_node.names import listing

PLACEMENT = "placement_frame"
"""Names the frame of a model that its pose places, if that is not the model's own frame."""
MAX_MODELS = 5000
"""Limit for one world, because nested includes can multiply without bound."""
Matrix = NDArray[np.float64]


@frozen
class NestedModel:
    """A model in a scope.

    Attributes:
        name: name in the scope.
        scope: the content of the model.
        element: the <include>, or the <model> if it is written in the scope itself.
        pose_source: the <include> or <model> whose <pose> counts.
        static: value of <static>, None if there is none.
        frame: name of the frame in the model that the pose places, "" for the model's own.
        merged: whether the model's links count as those of the scope.
    """

    name: str
    scope: "SdfScope"
    element: SdfElement
    pose_source: SdfElement
    static: bool | None
    frame: str
    merged: bool = False

    @property
    def offset(self) -> Matrix:
        """The model's frame (4, 4) in the frame that its pose places."""
        frame = self.scope.frames.named(self.frame, self.scope.element)
        return np.asarray(np.linalg.inv(frame), np.float64)


class SdfScope:
    """The content of one <world> or <model>.

    All scopes share `budget`, a list of one number: how many more models are allowed.

    Raises:
        WorldError: a file is not available or includes itself, or a name is missing or not unique.
    """

    def __init__(self, element: SdfElement, budget: list[int] | None = None) -> None:
        self.element = element
        self._budget = [MAX_MODELS] if budget is None else budget
        self._files: list[SdfElement] = []
        self._gazebos: list[SdfElement] = []
        self.links = element.children("link") if element.tag == "model" else []
        # Only the poses of joints are used, so joints still count as unread.
        self.joints = element.find("joint")
        models = (*self._nested(), *self._included())
        self.models = {model.name: model for model in models}
        _check_names((*self.links, *(model.element for model in models)), models)
        frames = element.children("frame")
        for frame in frames:
            frame.pose()  # Marks it as read: a frame that nothing refers to is not missing.
        self.parts = {part.name: part for part in (*self.joints, *self.links, *frames)}
        self.frames = SdfFrames(
            {**{model.name: model.pose_source for model in models}, **self.parts},
            {model.pose_source: model.offset for model in models},
            {model.name: model.scope.frames for model in models},
            [model.name for model in models if model.merged],
        )

    @property
    def files(self) -> Iterator[SdfElement]:
        """The roots of all files that are included directly or indirectly."""
        yield from self._files
        for model in self.models.values():
            yield from model.scope.files

    @property
    def builtin_includes(self) -> Iterator[SdfElement]:
        """The includes of Gazebo's own ground and sun."""
        yield from self._gazebos
        for model in self.models.values():
            yield from model.scope.builtin_includes

    def _nested(self) -> Iterator[NestedModel]:
        for model in self.element.children("model"):
            scope, static = self._scope(model), _static_flag(model)
            yield NestedModel(model.name, scope, model, model, static, model.attribute(PLACEMENT))

    def _included(self) -> Iterator[NestedModel]:
        for include in self.element.children("include"):
            root = _included_file(include)
            if root is None:
                if is_ground(include) or is_sun(include):
                    self._gazebos.append(include)
                continue
            self._files.append(root)
            model = root.child("model")
            if model is None:
                # Its actor or light is reported as unread.
                continue
            own, static, merged = (
                _static_flag(model),
                _static_flag(include),
                include.boolean("merge"),
            )
            model.pose()  # Marks it as read: an include's own pose may replace it.
            name = include.text("name") or model.name
            yield NestedModel(
                f"_merged__{name}__model__" if merged else name,
                self._scope(model),
                include,
                include if include.child("pose") else model,
                own if static is None else static,
                include.text(PLACEMENT) or model.attribute(PLACEMENT),
                merged,
            )

    def _scope(self, model: SdfElement) -> "SdfScope":
        self._budget[0] -= 1
        if self._budget[0] < 0:
            raise model.error(f"is beyond the limit of {MAX_MODELS} models")
        return SdfScope(model, self._budget)


def _static_flag(element: SdfElement) -> bool | None:
    return element.flag("static") if element.child("static") else None


def _check_names(elements: tuple[SdfElement, ...], models: tuple[NestedModel, ...]) -> None:
    names = {model.element: model.name for model in models}
    taken = set[str]()
    for element in elements:
        name = names.get(element, element.name)
        if not name:
            raise element.error("needs a name")
        if name in taken:
            raise element.error(f"has the name '{name}', which is already taken")
        taken.add(name)


GROUND = ("ground_plane", "ground plane")
SUN = ("sun",)
"""Gazebo's own models, which worlds include by name or from its web site."""
MAX_INCLUDE_DEPTH = 50
"""Limit on the depth of nested includes; no sensible world comes near it."""


def _included_file(include: SdfElement) -> SdfElement | None:
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
