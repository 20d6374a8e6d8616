"""Brings hardware components to a state through the services of a controller manager."""

import logging

from rclpy.node import Node

from arm_control.spawner.command_line import HardwareSpawnerOptions, absolute_name
from arm_control.spawner.ros_retrying_caller import RetryingCaller
from arm_node.controller_manager import ControllerManagerClient
from arm_node.process import EXIT_OK, NodeProcess

SERVICE_CALL_TIMEOUT_S = 10.0
SERVICES = ("list_hardware_components", "set_hardware_component_state")


def spawn_hardware(node: Node, process: NodeProcess, options: HardwareSpawnerOptions) -> int:
    """Bring the components to their state; return the exit code. Not on an executor's thread.

    As in ros2_control, a component that is missing or fails causes only a warning: the exit code
    says only whether the manager answered.
    """
    log = logging.getLogger(node.get_logger().name)
    manager = absolute_name(options.controller_manager, node.get_namespace())
    caller = RetryingCaller(
        node, manager, SERVICES, SERVICE_CALL_TIMEOUT_S, lambda: process.stopping
    )
    caller.wait_for("list_hardware_components", options.controller_manager_timeout_s)
    client = ControllerManagerClient(caller)
    target = options.target.label
    states = client.component_states()
    for name in options.names:
        if name not in states:
            log.warning(
                "Hardware Component is not loaded - state can not be changed: %s; %s has %s",
                name,
                manager,
                ", ".join(states) or "none",
            )
        elif client.set_component_state(name, target).ok:
            state = client.component_states()[name]
            log.info("component '%s': Hardware now in state: %s.", name, state)
        else:
            log.warning(
                "Could not bring component '%s' to state %s; it is in state %s, and the reason is "
                "in the log of %s",
                name,
                target,
                client.component_states()[name].label,
                manager,
            )
    return EXIT_OK
