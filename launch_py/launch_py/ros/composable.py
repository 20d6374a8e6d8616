"""Composable nodes, named as in ROS 2's `launch_ros`: each starts as a process of its own.

A component is a library that a C++ container loads. Nothing can load one here, so a component that
the suite or a package has a program for starts as that program. Any other is skipped, with a
warning.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from launch_py.action import Action
from launch_py.conditions import Condition
from launch_py.errors import LaunchFileError, NotFoundError
from launch_py.launch_context import LaunchContext, LaunchSurvey
from launch_py.ros.actions import Node
from launch_py.ros.lifecycle import LifecycleNode
from launch_py.substitution import Pairs, Text, describe_text, perform_text
from launch_py.system.packages import Packages


class ComposableNode:
    """A component and the node that it becomes.

    Args:
        package: the package that the component is in.
        plugin: its class, such as "image_proc::RectifyNode".
        name: the node's name.
        namespace: the node's namespace; as in ROS that of the container has no effect.
        parameters: as of `Node`.
        remappings: as of `Node`.
        extra_arguments: accepted as in ROS, without effect: they are for a container.
        condition: whether to load it.
    """

    def __init__(
        self,
        *,
        package: Text,
        plugin: Text,
        name: Text | None = None,
        namespace: Text | None = None,
        parameters: Iterable[Any] | None = None,
        remappings: Pairs | None = None,
        extra_arguments: Iterable[Any] | None = None,
        condition: Condition | None = None,
    ) -> None:
        self.package = package
        self.plugin = plugin
        self.name = name
        self.namespace = namespace
        self.parameters = parameters
        self.remappings = remappings
        self.condition = condition

    def node(self) -> Node:
        """Return the action that starts it as a process."""
        return _ComponentNode(
            package=self.package,
            executable=self.plugin,
            name=self.name,
            namespace=self.namespace,
            parameters=self.parameters,
            remappings=self.remappings,
            condition=self.condition,
        )


class ComposableLifecycleNode(ComposableNode):
    """A component that is a managed node; with `autostart` it is configured and activated."""

    def __init__(self, *, autostart: bool = False, **options: Any) -> None:
        super().__init__(**options)
        self.autostart = autostart

    def node(self) -> Node:
        """Return the action that starts it as a process."""
        return _ComponentLifecycleNode(
            package=self.package,
            executable=self.plugin,
            name=self.name or "",
            namespace=self.namespace or "",
            parameters=self.parameters,
            remappings=self.remappings,
            condition=self.condition,
            autostart=self.autostart,
        )


class _ComponentNode(Node):
    def expand(self, context: LaunchContext) -> None:
        """Add the process, or a warning if there is no program for the component."""
        if _is_available(context, self):
            super().expand(context)


class _ComponentLifecycleNode(LifecycleNode):
    def expand(self, context: LaunchContext) -> None:
        """Add the process, or a warning if there is no program for the component."""
        if _is_available(context, self):
            super().expand(context)


def _is_available(context: LaunchContext, node: Node) -> bool:
    package = perform_text(context, node.package or "")
    plugin = perform_text(context, node.executable)
    try:
        Packages(context.base_environment).executable(package, plugin)
    except NotFoundError:
        name = "" if node.node_name is None else f"{perform_text(context, node.node_name)}, "
        context.warnings.append(
            f"the composable node {name}{plugin} of {package} is skipped: no program here does "
            "its work, and a C++ component cannot be loaded"
        )
        return False
    return True


class LoadComposableNodes(Action):
    """Starts components as processes, whatever the container; see `ComposableNode`."""

    def __init__(
        self,
        *,
        composable_node_descriptions: Iterable[ComposableNode],
        target_container: Any = None,
        condition: Condition | None = None,
    ) -> None:
        super().__init__(condition=condition)
        self.target_container = target_container
        self.nodes: list[Node] = []
        for node in composable_node_descriptions:
            if not isinstance(node, ComposableNode):
                name = type(self).__name__
                raise LaunchFileError(f"{name} takes ComposableNodes, not {node!r}")
            self.nodes.append(node.node())

    def expand(self, context: LaunchContext) -> None:
        """Add the processes to the plan."""
        for node in self.nodes:
            node.visit(context)

    def survey(self, survey: LaunchSurvey, context: LaunchContext) -> None:
        """Survey the processes."""
        super().survey(survey, context)
        for node in self.nodes:
            node.survey(survey, context)


class ComposableNodeContainer(LoadComposableNodes):
    """A container: no process of its own, but those of its components."""

    def __init__(
        self,
        *,
        name: Text,
        composable_node_descriptions: Iterable[ComposableNode] | None = None,
        condition: Condition | None = None,
        **options: Any,
    ) -> None:
        super().__init__(
            composable_node_descriptions=composable_node_descriptions or (), condition=condition
        )
        self.name = name

    def describe(self) -> str:
        """Return its name in messages."""
        return f"the container {describe_text(self.name)!r}"
