"""The parameters of servo_node: moveit_servo's, below `moveit_servo`."""

import logging
from collections.abc import Iterator

from rcl_interfaces.msg import ParameterDescriptor
from rclpy.node import Node

from arm_node.names import describe_known
from arm_node.parameter_values import Reader, Value, read_parameter
from arm_node.parameters import declare_typed, type_of
from arm_node.setting import read_settings, settings_of
from arm_planning.ros.robot_setup import values_below
from arm_planning.servo.settings import ServoSettings

PREFIX = "moveit_servo"
NOT_USED = """
    active_subgroup apply_twist_commands_about_ee_frame cartesian_command_in_topic
    check_octomap_collisions collision_check_rate joint_command_in_topic joint_topic
    is_primary_planning_scene_monitor max_expected_latency monitored_planning_scene_topic
    pose_command_in_topic publish_joint_accelerations singularity_step_scale
    smoothing_filter_plugin_name status_topic thread_priority use_smoothing
    """
"""Parameters that moveit_servo has and this node does not need."""
LOGGER = logging.getLogger("servo_node")


def read_servo_settings(node: Node) -> ServoSettings:
    """Return the settings; a name that moveit_servo does not have is warned of.

    Raises:
        ParameterValueError: a value is invalid.
    """

    def value(
        name: str,
        default: object,
        read: Reader[Value],
        description: str,
        /,
        *,
        read_only: bool = True,
    ) -> Value:
        full = f"{PREFIX}.{name}"
        given = node.has_parameter(full)
        found = read_parameter(full, node.get_parameter(full).value if given else default, read)
        if not given:
            descriptor = ParameterDescriptor(description=description, read_only=read_only)
            declare_typed(node, full, type_of(default), default, descriptor)
        return found

    settings = read_settings(ServoSettings, value)
    for warning in unknown_names(set(values_below(node, PREFIX))):
        LOGGER.warning("%s", warning)
    return settings


def unknown_names(names: set[str]) -> Iterator[str]:
    """Yield a sentence for each parameter that moveit_servo does not have."""
    known = {each.name for each in settings_of(ServoSettings)}
    for name in sorted(names - known):
        if name.partition(".")[0] in NOT_USED.split():
            continue
        yield f"there is no parameter {PREFIX}.{name}; {describe_known(name, known)}"
