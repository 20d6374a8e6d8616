"""Finds out why an action server refused or aborted a goal: from what it logs.

The response to a goal has no field for a reason, and neither have most results.
"""

from rcl_interfaces.msg import Log
from rclpy.action.graph import get_action_server_names_and_types_by_node
from rclpy.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy

from arm_cli.ros.session import CommandSession

WAIT_S = 1.0
"""How long a reason may arrive after the response, on another connection."""
ROSOUT_QOS = QoSProfile(
    depth=1000,
    reliability=ReliabilityPolicy.RELIABLE,
    # What was logged before this subscription was discovered arrives as well.
    durability=DurabilityPolicy.TRANSIENT_LOCAL,
)


class RefusalListener:
    """Listens to /rosout from the sending of a goal on."""

    def __init__(self, session: CommandSession, action_name: str) -> None:
        """Subscribe.

        Args:
            session: the command's node.
            action_name: full name of the action.
        """
        self._session = session
        self._action_name = action_name
        self._logged: list[Log] = []
        self._since_ns = 0
        self._subscription = session.node.create_subscription(
            Log, "/rosout", self._logged.append, ROSOUT_QOS
        )

    def close(self) -> None:
        """Unsubscribe."""
        self._session.node.destroy_subscription(self._subscription)

    def begin(self, system_ns: int) -> None:
        """Forget what was logged before this system time."""
        self._since_ns = system_ns
        self._logged.clear()

    def reason(self) -> str:
        """Return the latest warning or error of the action's server; "" if none arrives."""
        names = self._server_loggers()

        def found() -> list[str]:
            return [
                message.msg
                for message in self._logged
                if message.name in names
                and message.level >= Log.WARN
                and message.stamp.sec * 10**9 + message.stamp.nanosec >= self._since_ns
            ]

        self._session.wait_until(lambda: bool(found()), timeout_s=WAIT_S)
        reasons = found()
        return reasons[-1] if reasons else ""

    def _server_loggers(self) -> set[str]:
        """Return the names under which the nodes of the action's servers log."""
        node = self._session.node
        return {
            logger
            for name, namespace in node.get_node_names_and_namespaces()
            if any(
                action == self._action_name
                for action, _ in get_action_server_names_and_types_by_node(node, name, namespace)
            )
            for logger in (name, f"{namespace}.{name}".replace("/", ".").lstrip("."))
        }
