"""Finds which controllers command which others, and the order in which they run."""

from collections.abc import Callable, Iterable, Iterator, Mapping

from arm_control.controllers.exported_interfaces import ExportedInterfaces
from arm_control.manager.managed_controller import ManagedController
from arm_control.status import ChainConnection


class ControllerChain:
    """The relations between the loaded controllers as currently configured. Loop thread only.

    A controller *precedes* those whose references it commands or whose exported states it requests
    by name; these *follow* it. A controller that reads all available states depends on none.
    """

    def __init__(
        self, controllers: Mapping[str, ManagedController], exported: ExportedInterfaces
    ) -> None:
        """Refer to the manager's controllers.

        Args:
            controllers: by name; the manager adds and removes some later.
            exported: the interfaces that they export.
        """
        self._controllers = controllers
        self._exported = exported

    def commanded_by(self, controller: ManagedController) -> tuple[ManagedController, ...]:
        """Return the controllers whose references it commands."""
        return self._named(map(self._exported.reference_owner, controller.commands))

    def read_by(self, controller: ManagedController) -> tuple[ManagedController, ...]:
        """Return the controllers whose exported states it reads, requested by name or not."""
        return self._named(map(self._exported.state_owner, controller.states))

    def following(self, controller: ManagedController) -> tuple[ManagedController, ...]:
        """Return the controllers that follow it directly."""
        needed = self._named(map(self._exported.state_owner, controller.named_states))
        return tuple(dict.fromkeys((*self.commanded_by(controller), *needed)))

    def preceding(self, controller: ManagedController) -> tuple[ManagedController, ...]:
        """Return the controllers that precede it directly."""
        return tuple(c for c in self._controllers.values() if controller in self.following(c))

    def is_commanded(self, controller: ManagedController, by: Iterable[ManagedController]) -> bool:
        """Return whether one of these commands the controller's references."""
        return any(controller in self.commanded_by(other) for other in by)

    def connections(self, controller: ManagedController) -> tuple[ChainConnection, ...]:
        """Return the references that a controller commands, by the controller that exports them."""
        return tuple(
            ChainConnection(
                other.name,
                tuple(
                    name.removeprefix(f"{other.name}/")
                    for name in controller.commands
                    if self._exported.reference_owner(name) == other.name
                ),
            )
            for other in self.commanded_by(controller)
        )

    def in_order(self) -> tuple[ManagedController, ...]:
        """Return all controllers in their order of execution: newest first, but along the chains.

        A controller runs before those that it commands. A controller that exports states runs
        before those that read them, unless the reader commands it.
        """
        if not self._exported.references() and not self._exported.states():
            return self._newest_first()
        ordered: dict[str, ManagedController] = {}
        visited: set[str] = set()

        def visit(controller: ManagedController) -> None:
            if controller.name in visited:
                return
            visited.add(controller.name)
            for earlier in self._earlier(controller):
                visit(earlier)
            ordered[controller.name] = controller

        for controller in self._newest_first():
            visit(controller)
        return tuple(ordered.values())

    def from_below(self, controllers: Iterable[ManagedController]) -> tuple[ManagedController, ...]:
        """Return these with following controllers first; otherwise the order is kept.

        They are started in this order, and stopped in the reverse order.
        """
        wanted = tuple(controllers)
        ordered: dict[str, ManagedController] = {}
        visited: set[str] = set()

        def visit(controller: ManagedController) -> None:
            if controller.name in visited or controller not in wanted:
                return
            visited.add(controller.name)
            for follower in self.following(controller):
                visit(follower)
            ordered[controller.name] = controller

        for controller in wanted:
            visit(controller)
        return tuple(ordered.values())

    def with_preceding(
        self, controllers: Iterable[ManagedController]
    ) -> tuple[ManagedController, ...]:
        """Return these and all active ones that precede them."""
        return self._closure(controllers, self.preceding)

    def with_commands(
        self, controllers: Iterable[ManagedController]
    ) -> tuple[ManagedController, ...]:
        """Return these and all active ones that command them or that they command, at any depth."""
        every = tuple(self._controllers.values())

        def neighbours(controller: ManagedController) -> Iterator[ManagedController]:
            yield from self.commanded_by(controller)
            yield from (c for c in every if controller in self.commanded_by(c))

        return self._closure(controllers, neighbours)

    def with_read(self, controllers: Iterable[ManagedController]) -> tuple[ManagedController, ...]:
        """Return these and all active ones whose exported states they read."""
        return self._closure(controllers, self.read_by)

    def with_group(self, controllers: Iterable[ManagedController]) -> tuple[ManagedController, ...]:
        """Return these and all active ones connected with them, directly or not."""
        return self._closure(controllers, lambda c: (*self.preceding(c), *self.following(c)))

    def _newest_first(self) -> tuple[ManagedController, ...]:
        return tuple(self._controllers.values())[::-1]

    def _earlier(self, controller: ManagedController) -> Iterator[ManagedController]:
        for other in self._newest_first():
            if controller in self.commanded_by(other):
                yield other
        for other in self.read_by(controller):
            if not self._leads_to(controller, other):
                yield other

    def _leads_to(self, controller: ManagedController, goal: ManagedController) -> bool:
        """Return whether one controller's commands reach the other, directly or through others."""
        waiting, seen = [controller], {controller.name}
        while waiting:
            for other in self.commanded_by(waiting.pop()):
                if other is goal:
                    return True
                if other.name not in seen:
                    seen.add(other.name)
                    waiting.append(other)
        return False

    def _closure(
        self,
        controllers: Iterable[ManagedController],
        neighbours: Callable[[ManagedController], Iterable[ManagedController]],
    ) -> tuple[ManagedController, ...]:
        reached = {controller.name for controller in controllers}
        waiting = [self._controllers[name] for name in reached]
        while waiting:
            for other in neighbours(waiting.pop()):
                if other.is_active and other.name not in reached:
                    reached.add(other.name)
                    waiting.append(other)
        return tuple(c for c in self.in_order() if c.name in reached)

    def _named(self, names: Iterable[str | None]) -> tuple[ManagedController, ...]:
        return tuple(
            self._controllers[name]
            for name in dict.fromkeys(names)
            if name is not None and name in self._controllers
        )
