"""The node joint_state_publisher: publishes joint states without a robot."""

from collections.abc import Callable

from rclpy.node import Node
from rclpy.parameter import Parameter
from sensor_msgs.msg import JointState
from std_msgs.msg import String

from arm_description.errors import (
    DescriptionError,
    JointStateError,
    MimicCycleError,
    SettingsError,
)
from arm_description.publishers.joint_document import read_joints
from arm_description.publishers.joint_state_merge import JointStateMerge
from arm_description.publishers.settings import JointPublisherSettings
from arm_node.parameters import check_changes, declare_setting, given_parameters
from arm_node.printable import printable, printable_message
from arm_node.qos import LATCHED

LOG_INTERVAL_S = 5.0
_QUEUE = 10


class JointStatePublisher(Node):
    """Publishes joint_states at a rate; every callback runs in the executor's thread.

    Raises:
        SettingsError: a parameter is invalid.
        XmlError, UrdfError: the given description is not a robot.
    """

    def __init__(self, description: str | None, fail: Callable[[], None]) -> None:
        """Make the node.

        Args:
            description: the initial URDF, SDF or COLLADA document; one from the topic
                robot_description replaces it.
            fail: ends the process with an error; called if joints depend on each other in a circle,
                because then no joint state is valid.
        """
        super().__init__("joint_state_publisher")
        given = given_parameters(self)
        self._settings = JointPublisherSettings.from_parameters(given)
        declared = list(JointPublisherSettings.declarations(given))
        for each in declared:
            declare_setting(self, each)
        self._names = [each.name for each in declared]
        self._fail = fail
        self._merge: JointStateMerge | None = None
        if description is not None:
            self._merge = JointStateMerge(read_joints(description), self._settings)
        self._publisher = self.create_publisher(JointState, "joint_states", _QUEUE)
        self.create_subscription(String, "robot_description", self._on_description, LATCHED)
        for topic in self._settings.source_list:
            self.create_subscription(JointState, topic, self._on_source, _QUEUE)
        self._timer = self.create_timer(1.0 / self._settings.rate_hz, self._publish)
        check_changes(self, self._checked, SettingsError)
        self.add_post_set_parameters_callback(self._take_parameters)

    def _checked(self, changes: list[Parameter]) -> JointPublisherSettings:
        values = {name: self.get_parameter(name).value for name in self._names}
        values.update((change.name, change.value) for change in changes)
        return JointPublisherSettings.from_parameters(values)

    def _take_parameters(self, _changes: list[Parameter]) -> None:
        self._settings = self._checked([])
        self._timer.timer_period_ns = 1_000_000_000 // self._settings.rate_hz
        if self._merge is not None:
            self._merge.set_delta(self._settings.delta)

    def _on_description(self, message: String) -> None:
        try:
            self._merge = JointStateMerge(read_joints(message.data), self._settings)
        except (MimicCycleError, SettingsError) as error:
            self.get_logger().error(printable(str(error)))
            self._merge = None
            self._fail()
        except DescriptionError as error:
            about = printable_message(str(error))
            self.get_logger().warning(f"Invalid robot_description given, ignoring: {about}")

    def _on_source(self, message: JointState) -> None:
        if self._merge is None:
            return
        try:
            self._merge.merge(
                list(message.name), message.position, message.velocity, message.effort
            )
        except JointStateError as error:
            self.get_logger().error(
                printable(f"ignored a JointState: {error}"),
                throttle_duration_sec=LOG_INTERVAL_S,
            )

    def _publish(self) -> None:
        if self._merge is None:
            return
        self._merge.sweep()
        state = self._merge.state()
        if not state.names:
            return
        message = JointState()
        message.header.stamp = self.get_clock().now().to_msg()
        message.name = list(state.names)
        message.position = list(state.positions)
        message.velocity = list(state.velocities)
        message.effort = list(state.efforts)
        self._publisher.publish(message)
