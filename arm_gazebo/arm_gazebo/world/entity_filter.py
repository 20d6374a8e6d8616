"""Which entities a client means."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from arm_gazebo.world.entity import Category, Entities, Entity
from arm_gazebo.world.entity_motion import EntityMotions
from arm_gazebo.world.name_pattern import NamePattern


@dataclass(frozen=True, slots=True)
class Volume:
    """A box, or a ball where it has a radius.

    Attributes:
        low: lowest corner, or the middle of a ball, shape (3,).
        high: highest corner, or the middle of a ball, shape (3,).
        radius: of a ball, 0 for a box.
    """

    low: NDArray[np.float64]
    high: NDArray[np.float64]
    radius: float = 0.0

    def overlaps(self, box: NDArray[np.float64]) -> bool:
        """Return whether an axis-aligned box, corners of shape (2, 3), reaches into the volume."""
        gap = np.maximum(np.maximum(box[0] - self.high, self.low - box[1]), 0.0)
        return bool(np.linalg.norm(gap) <= self.radius)


@dataclass(frozen=True, slots=True)
class EntityFilter:
    """Passes entities that fit all that is set.

    Attributes:
        pattern: regular expression, see `NamePattern`, that is found in the name; "" for any.
        categories: at least one of which they are in, none for any.
        tags: what they are marked with, none for any.
        all_tags: whether one of the tags is not enough.
        volume: what they reach into, None for anywhere.
    """

    pattern: str = ""
    categories: frozenset[Category] = frozenset()
    tags: frozenset[str] = frozenset()
    all_tags: bool = False
    volume: Volume | None = None

    def choose(self, entities: Entities, motions: EntityMotions) -> list[Entity]:
        """Return the entities that pass.

        Raises:
            RefusedError: the pattern is no regular expression.
        """
        pattern = NamePattern(self.pattern)
        return [
            entity
            for entity in entities
            if pattern.is_in(entity.name) and self._passes(entity, motions)
        ]

    def _passes(self, entity: Entity, motions: EntityMotions) -> bool:
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
        # A plain object is any thing, whether it moves or not.
        return category in self.categories or (
            Category.OBJECT in self.categories and category in things
        )
