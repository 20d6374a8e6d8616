"""Brings hardware components to a state through the services of a controller manager."""

import logging

from lifecycle_msgs.msg import State
from rclpy.node import Node

from arm_control.hardware_spawner_options import HardwareSpawnerOptions
from arm_control.manager_command_line import absolute_name
from arm_control.ros.hardware_client import HardwareClient
from arm_node.process import EXIT_OK, NodeProcess


def spawn_hardware(node: Node, process: NodeProcess, options: HardwareSpawnerOptions) -> int:
    """Do what the options say; return the process's exit code. Not on an executor's thread.

    As with ros2_control's, a component that is not there or does not go along is a warning: the
    code tells only whether there was a manager to ask.
    """
    log = logging.getLogger(node.get_logger().name)
    manager = absolute_name(options.controller_manager, node.get_namespace())
    client = HardwareClient(node, manager, lambda: process.stopping)
    client.wait_for_manager(options.controller_manager_timeout_s)
    target = State(id=options.target.value, label=options.target.label)
    states = client.states()
    for name in options.names:
        if name not in states:
            log.warning(
                "Hardware Component is not loaded - state can not be changed: %s; %s has %s",
                name,
                manager,
                ", ".join(states) or "none",
            )
        elif client.set_state(name, target):
            log.info("component '%s': Hardware now in state: %s.", name, client.states()[name])
        else:
            log.warning(
                "Could not bring component '%s' to state %s; it is in state %s and the reason in "
                "the log of %s",
                name,
                target.label,
                client.states()[name].label,
                manager,
            )
    return EXIT_OK
