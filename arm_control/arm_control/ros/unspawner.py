"""Deactivates and unloads controllers through the services of a controller manager."""

import logging
from collections.abc import Sequence

from rclpy.node import Node

from arm_control.manager_command_line import absolute_name
from arm_control.ros.manager_client import ManagerClient
from arm_control.unspawner_options import UnspawnerOptions
from arm_node.process import EXIT_FAILED, EXIT_OK, NodeProcess

SERVICE_CALL_TIMEOUT_S = 10.0


def unspawn(node: Node, process: NodeProcess, options: UnspawnerOptions) -> int:
    """Do what the options say; return the process's exit code. Not on an executor's thread."""
    manager = ManagerClient(
        node,
        absolute_name(options.controller_manager, node.get_namespace()),
        SERVICE_CALL_TIMEOUT_S,
        lambda: process.stopping,
    )
    manager.wait_for_manager(0.0)
    log = logging.getLogger(node.get_logger().name)
    return unload_controllers(manager, options.names, options.switch_timeout_s, log)


def unload_controllers(
    manager: ManagerClient, names: Sequence[str], switch_timeout_s: float, log: logging.Logger
) -> int:
    """Deactivate those that are active in one switch, and unload all; return the exit code.

    Those that cannot be deactivated cannot be unloaded either: the unloading says so.
    """
    states = manager.states()
    active = [name for name in names if states.get(name) == "active"]
    if active and manager.deactivate(active, switch_timeout_s):
        log.info("Deactivated controllers: %s", " ".join(active))
    code = EXIT_OK
    for name in names:
        if manager.unload(name):
            log.info("Unloaded controller %s", name)
        else:
            log.error("Failed to unload controller %s", name)
            code = EXIT_FAILED
    return code
