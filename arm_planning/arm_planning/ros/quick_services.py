"""Services that answer at once get a thread of their own, whose executor serves nothing else.

For a request, rclpy's executors build several times anew what they wait for, all services, actions
and topics of a node. That takes longer than such an answer.
"""

from typing import Any

from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.executors import MultiThreadedExecutor, SingleThreadedExecutor
from rclpy.node import Node


class QuickServices(ReentrantCallbackGroup):
    """The group of the services of a node that answer at once."""


class QuickExecutor(SingleThreadedExecutor):
    """Serves such a group, whose services are all made before, one request at a time.

    The node belongs to another executor.
    """

    def __init__(self, node: Node, group: QuickServices) -> None:
        super().__init__(context=node.context)
        self._node, self._group = node, group

    def get_nodes(self) -> list[Node]:
        """Return the node."""
        return [self._node]

    def can_execute(self, entity: Any) -> bool:
        """Return whether it is of the group, and is not being served."""
        return entity.callback_group is self._group and super().can_execute(entity)


class SlowExecutor(MultiThreadedExecutor):
    """Serves nodes on several threads, but for their quick services."""

    def can_execute(self, entity: Any) -> bool:
        """Return whether it is not of such a group, and may be served now."""
        is_quick = isinstance(entity.callback_group, QuickServices)
        return not is_quick and super().can_execute(entity)
