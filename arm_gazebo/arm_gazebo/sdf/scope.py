"""A <world> or a <model> with the models in it, written in place or included."""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from arm_gazebo.sdf.element import SdfElement
from arm_gazebo.sdf.frames import SdfFrames
from arm_gazebo.sdf.include import included_file, is_ground, is_sun

PLACEMENT = "placement_frame"
"""Names the frame of a model that its pose places, if that is not the model's own frame."""
MAX_MODELS = 5000
"""Limit for one world, because nested includes can multiply without bound."""
Matrix = NDArray[np.float64]


@dataclass(frozen=True, slots=True)
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

    Args:
        element: the <world> or <model>.
        budget: how many more models are allowed, in a list of one number that all scopes share.

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
            root = included_file(include)
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
