"""Spawns, moves, deletes and inspects the entities of the world between two ticks."""

from collections.abc import Sequence
from os import PathLike, fspath

import numpy as np

from arm_gazebo.physics.physics import Physics
from arm_gazebo.world.changes import NOTHING, WorldChanges
from arm_gazebo.world.contacts import Contact, bodies_of, contacts_of
from arm_gazebo.world.editor import ModelHolder, SpawnRequest, WorldEditor
from arm_gazebo.world.spawn_model import ModelSource
from arm_sim.pose import AnyPose, Matrix, pose_matrix


class Things:
    """Does for a program what the world's services do for clients of the node; see `Simulation`.

    Attributes:
        editor: changes the world.
        source: reads models to spawn.
    """

    def __init__(
        self, physics: Physics, holders: Sequence[ModelHolder], source: ModelSource
    ) -> None:
        """Take a simulation that runs on the calling thread.

        Args:
            physics: the simulation.
            holders: look up their indices in a new model.
            source: reads models to spawn.
        """
        self._physics = physics
        self.source = source
        self.editor = WorldEditor(physics, lambda function: function(), holders, [], source)

    @property
    def changes(self) -> WorldChanges:
        """The changes to the world since it was built."""
        return self.editor.changes

    def change_to(self, changes: WorldChanges | None) -> None:
        """Apply the changes that the world had at an earlier time; None for those at its start."""
        self.editor.change_to(changes or NOTHING)

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the entities."""
        return tuple(entity.name for entity in self.editor.entities)

    def spawn(self, model: str | PathLike[str], name: str, pose: AnyPose, frame: str) -> str:
        """Spawn a model; return its name."""
        text = fspath(model)
        is_text = text.lstrip().startswith("<")
        return self.editor.spawn(
            SpawnRequest(
                name=name,
                uri="" if is_text else text,
                text=text if is_text else "",
                pose=pose_matrix(pose),
                frame=frame,
                allow_renaming=not name,
            )
        )

    def delete(self, name: str) -> None:
        """Delete an entity."""
        self.editor.delete(name)

    def place(self, name: str, pose: AnyPose, frame: str) -> None:
        """Move an entity."""
        self.editor.place(name, pose_matrix(pose), frame, None)

    def pose(self, name: str, frame: str) -> Matrix:
        """Return the pose of an entity or a link in a frame, shape (4, 4)."""
        seen = self.editor.in_world(np.eye(4), name)
        return np.linalg.inv(self.editor.in_world(np.eye(4), frame)) @ seen if frame else seen

    def contacts(self, name: str | None) -> tuple[Contact, ...]:
        """Return the contacts of an entity or a link; all contacts for None."""
        state = self._physics.observe()
        return contacts_of(name, self._physics.model, state, self.editor.entities)

    def bodies(self, name: str) -> frozenset[str]:
        """Return the names of the bodies of an entity, or of a single link."""
        model = self._physics.model
        numbers = bodies_of(name, model, self.editor.entities)
        return frozenset(model.body(number).name for number in numbers)
