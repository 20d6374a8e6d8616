"""Select entities by name pattern, category, tags and place."""

from dataclasses import dataclass

import numpy as np
import re2
from numpy.typing import NDArray

from arm_gazebo.world.entity import Category, Entities, WorldEntity
from arm_gazebo.world.entity_motion import EntityMotions
from arm_gazebo.world.refusal import Refusal, RequestError

MAX_PATTERN_LENGTH = 200


class NamePattern:
    """A POSIX extended regular expression; the escapes of `re` are accepted as well.

    Raises:
        RequestError: the pattern is invalid, or longer than `MAX_PATTERN_LENGTH`.
    """

    def __init__(self, pattern: str) -> None:
        if len(pattern) > MAX_PATTERN_LENGTH:
            raise RequestError(
                Refusal.FAILED, f"the filter has more than {MAX_PATTERN_LENGTH} characters"
            )
        options = re2.Options()
        options.log_errors = False  # RE2 would write to stderr; the caller reports the error.
        try:
            self._expression = re2.compile(pattern, options)
        except (re2.error, UnicodeEncodeError) as error:
            raise RequestError(
                Refusal.FAILED,
                f"the filter {pattern!r} is not a regular expression: {_reason(error)}",
            ) from error

    def is_in(self, name: str) -> bool:
        """Return whether the pattern matches some part of a name."""
        return self._expression.search(name) is not None


def _reason(error: Exception) -> str:
    """Return RE2's message, which is bytes."""
    [reason, *_] = error.args or ("",)
    return reason.decode("utf-8", "replace") if isinstance(reason, bytes) else str(error)


@dataclass(frozen=True, slots=True)
class Volume:
    """A box, or a ball if it has a radius.

    Attributes:
        low: lowest corner of a box, or centre of a ball, shape (3,).
        high: highest corner of a box, or centre of a ball, shape (3,).
        radius: radius of a ball, 0 for a box.
    """

    low: NDArray[np.float64]
    high: NDArray[np.float64]
    radius: float = 0.0

    def overlaps(self, box: NDArray[np.float64]) -> bool:
        """Return whether an axis-aligned box, corners of shape (2, 3), overlaps the volume."""
        gap = np.maximum(np.maximum(box[0] - self.high, self.low - box[1]), 0.0)
        return bool(np.linalg.norm(gap) <= self.radius)


@dataclass(frozen=True, slots=True)
class EntityFilter:
    """Passes entities that match every condition that is set.

    Attributes:
        pattern: regular expression to find in the name, see `NamePattern`; "" for any name.
        categories: accepted categories, empty for any.
        tags: accepted tags, empty for any.
        all_tags: whether an entity needs all of the tags instead of one.
        volume: volume that they overlap, None for anywhere.
    """

    pattern: str = ""
    categories: frozenset[Category] = frozenset()
    tags: frozenset[str] = frozenset()
    all_tags: bool = False
    volume: Volume | None = None

    def choose(self, entities: Entities, motions: EntityMotions) -> list[WorldEntity]:
        """Return the entities that pass.

        Raises:
            RequestError: the pattern is not a regular expression.
        """
        pattern = NamePattern(self.pattern)
        return [
            entity
            for entity in entities
            if pattern.is_in(entity.name) and self._passes(entity, motions)
        ]

    def _passes(self, entity: WorldEntity, motions: EntityMotions) -> bool:
        note = entity.note
        if self.categories and not self._in_category(note.category):
            return False
        matching = self.tags.intersection(note.tags)
        if self.tags and (matching != self.tags if self.all_tags else not matching):
            return False
        if self.volume is None:
            return True
        box = motions.bounds(entity)
        return box is not None and self.volume.overlaps(box)

    def _in_category(self, category: Category) -> bool:
        things = (Category.DYNAMIC_OBJECT, Category.STATIC_OBJECT)
        # OBJECT covers both dynamic and static objects.
        return category in self.categories or (
            Category.OBJECT in self.categories and category in things
        )
