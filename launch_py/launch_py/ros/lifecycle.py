"""Managed nodes, named as in ROS 2's `launch_ros`: their start, their transitions, their events.

The launcher itself talks to no node. A small program does: see `launch_py.ros.lifecycle_client`.
"""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from typing import Any, ClassVar

from launch_py.action import Action, steps_at_event
from launch_py.actions.event_actions import EmittedEvent
from launch_py.actions.execute_process import ExecuteProcess
from launch_py.conditions import Condition
from launch_py.errors import LaunchFileError
from launch_py.event_handlers import EventHandler, OnProcessStart
from launch_py.events import Event, ProcessIO, matches_action
from launch_py.launch_context import LaunchContext
from launch_py.near_names import describe_known
from launch_py.plan.readiness import LogLine
from launch_py.plan.steps import OutputHandlerStep
from launch_py.ros.actions import Node
from launch_py.substitution import Text, join_names, perform_text

TRANSITIONS = {"create": 0, "configure": 1, "cleanup": 2, "activate": 3, "deactivate": 4}
SHUTDOWNS = {"unconfigured_shutdown": 5, "inactive_shutdown": 6, "active_shutdown": 7}
TRANSITION_LABELS = {number: label for label, number in {**TRANSITIONS, **SHUTDOWNS}.items()}
"""The transitions of lifecycle_msgs/msg/Transition that a user may ask for."""

WATCHING = "watching"
"""What the client prints once it hears the node."""


def client(*words: str) -> list[str]:
    """Return the command line of the client."""
    return [sys.executable, "-P", "-m", "launch_py.ros.lifecycle_client", *words]


class LifecycleNode(Node):
    """A node that is taken through its states, by `ChangeState` and `LifecycleTransition`.

    With `autostart` it is configured and activated once it runs. The other options are those of
    `Node`.
    """

    def __init__(
        self, *, name: Text, namespace: Text = "", autostart: bool = False, **options: Any
    ) -> None:
        super().__init__(name=name, namespace=namespace, **options)
        self.autostart = autostart
        self.full_name: str | None = None
        """The node's name in the graph, known once the action has been expanded."""
        self.watcher: ExecuteProcess | None = None

    def expand(self, context: LaunchContext) -> None:
        """Add the process to the plan."""
        self.full_name = self.find_full_name(context)
        super().expand(context)
        if self.autostart:
            configure, activate = TRANSITIONS["configure"], TRANSITIONS["activate"]
            change_state(context, self, [configure, activate])

    def find_full_name(self, context: LaunchContext) -> str:
        """Return the node's name in the graph.

        Raises:
            LaunchFileError: its name is empty, so that nobody knows whose state to change.
        """
        names = self.node_names(context)()
        if not names:
            raise LaunchFileError("a LifecycleNode needs a name, which its changes of state use")
        return names[0]

    def watch(self, context: LaunchContext) -> ExecuteProcess:
        """Return the process that prints the node's transitions; add it to the plan once."""
        if self.watcher is None:
            full_name = self.full_name or self.find_full_name(context)
            self.watcher = ExecuteProcess(
                cmd=client("watch", full_name),
                name=f"transitions of {full_name}",
                output="own_log",
                ready=LogLine(f"^{WATCHING}$"),
            )
            watch = OnProcessStart(target_action=self, on_start=[self.watcher])
            watch.expand(context)
        return self.watcher


def change_state(context: LaunchContext, node: LifecycleNode, transitions: list[int]) -> None:
    """Add the process that takes a node through transitions to the plan."""
    full_name = node.full_name or node.find_full_name(context)
    words = client("change", full_name, *map(str, transitions))
    labels = " ".join(TRANSITION_LABELS[number] for number in transitions)
    process = ExecuteProcess(cmd=words, name=f"{labels} {full_name}")
    # Whoever waits for the transition must hear it.
    process.depends_on = (node, *([] if node.watcher is None else [node.watcher]))
    with context.plan.detached():  # It is no process of the node's own action.
        process.visit(context)


@dataclass(frozen=True, kw_only=True)
class ChangeState(EmittedEvent):
    """Emit it to take the nodes that the matcher is true for through a transition."""

    name: ClassVar[str] = "launch_ros.events.lifecycle.ChangeState"
    lifecycle_node_matcher: Callable[[Any], bool]
    transition_id: int

    def expand(self, context: LaunchContext) -> None:
        """Add the transition to the plan.

        Raises:
            LaunchFileError: there is no such transition, or no such node.
        """
        if self.transition_id not in TRANSITION_LABELS:
            known = ", ".join(f"{n} {label}" for n, label in TRANSITION_LABELS.items())
            raise LaunchFileError(f"ChangeState: no transition {self.transition_id!r}; {known}")
        nodes = [node for node in _nodes(context) if self.lifecycle_node_matcher(node)]
        if not nodes:
            raise LaunchFileError("ChangeState: its matcher fits no LifecycleNode before it")
        for node in nodes:
            change_state(context, node, [self.transition_id])


@dataclass(frozen=True, kw_only=True)
class StateTransition(Event):
    """A managed node has gone through a transition: from one state to another, by their labels."""

    name: ClassVar[str] = "launch_ros.events.lifecycle.StateTransition"
    action: LifecycleNode
    transition: str
    start_state: str
    goal_state: str


class LifecycleTransition(Action):
    """Takes nodes through transitions, one after the other."""

    def __init__(
        self,
        *,
        lifecycle_node_names: Iterable[Text],
        transition_ids: Iterable[int | Text],
        condition: Condition | None = None,
    ) -> None:
        super().__init__(condition=condition)
        self.lifecycle_node_names = list(lifecycle_node_names)
        self.transition_ids = list(transition_ids)

    def expand(self, context: LaunchContext) -> None:
        """Add the transitions to the plan.

        Raises:
            LaunchFileError: a node or a transition is unknown.
        """
        known_ids = {str(number): number for number in TRANSITION_LABELS}
        ids = [n if isinstance(n, int) else perform_text(context, n) for n in self.transition_ids]
        unknown = [number for number in ids if str(number) not in known_ids]
        numbers = [known_ids[str(number)] for number in ids if number not in unknown]
        nodes = {node.full_name: node for node in _nodes(context)}
        for name in self.lifecycle_node_names:
            full_name = join_names("", perform_text(context, name))
            if full_name not in nodes or unknown:
                known = describe_known(full_name, [n for n in nodes if n], "there are")
                why = f"no transition {unknown[0]}" if unknown else f"no node {full_name}; {known}"
                raise LaunchFileError(f"LifecycleTransition: {why}")
            change_state(context, nodes[full_name], numbers)


class OnStateTransition(EventHandler):
    """Actions that follow a transition of a managed node, each time that it fits.

    Args:
        entities: the actions, or a function of the `StateTransition` and the context.
        target_lifecycle_node: the node; without one, every LifecycleNode of the description.
        transition: the label of the transition, such as "configure"; None for any.
        start_state: the label of the state before it, such as "configuring".
        goal_state: the label of the state after it, such as "inactive".
        handle_once: whether the actions follow the first one that fits only.
    """

    def __init__(
        self,
        *,
        entities: Any,
        target_lifecycle_node: LifecycleNode | None = None,
        transition: str | None = None,
        start_state: str | None = None,
        goal_state: str | None = None,
        handle_once: bool = False,
    ) -> None:
        if not isinstance(target_lifecycle_node, LifecycleNode | None):
            raise LaunchFileError(
                "target_lifecycle_node= of OnStateTransition takes a LifecycleNode"
            )
        self.node = target_lifecycle_node
        wanted = {"transition": transition, "start_state": start_state, "goal_state": goal_state}
        super().__init__(
            matcher=lambda event: all(
                value is None or getattr(event, name) == value for name, value in wanted.items()
            ),
            entities=entities,
            handle_once=handle_once,
        )

    def expand(self, context: LaunchContext) -> None:
        """Add the step that hears the node's transitions to the plan."""
        every = [a for a in context.plan.surveyed_actions if isinstance(a, LifecycleNode)]
        for node in every if self.node is None else [self.node]:
            watcher = node.watch(context)
            context.plan.add(
                OutputHandlerStep(
                    after=context.after,
                    delay_s=context.delay_s,
                    processes=(watcher,),
                    expand=self._expand_line(context, node),
                )
            )

    def _expand_line(
        self, context: LaunchContext, node: LifecycleNode
    ) -> Callable[[ProcessIO], Any]:
        expand = steps_at_event(context, self.react)

        def take(line: ProcessIO) -> Any:
            words = line.text.decode().split()
            if len(words) != 3 or not line.from_stdout:
                return ()
            names = ("start_state", "goal_state", "transition")
            fields = dict(zip(names, words, strict=True))
            return expand(StateTransition(action=node, **fields))

        return take


def matches_node_name(node_name: str) -> Callable[[Any], bool]:
    """Return a matcher of the LifecycleNode with this full name."""
    full_name = join_names("", node_name)
    return lambda action: getattr(action, "full_name", None) == full_name


def _nodes(context: LaunchContext) -> list[LifecycleNode]:
    """Return the managed nodes that have been expanded so far."""
    return [a for a in context.plan.expanded_actions() if isinstance(a, LifecycleNode)]


__all__ = [
    "ChangeState",
    "LifecycleNode",
    "LifecycleTransition",
    "OnStateTransition",
    "StateTransition",
    "matches_action",
    "matches_node_name",
]
