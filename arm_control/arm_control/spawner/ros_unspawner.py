"""Deactivates and unloads controllers through the services of a controller manager."""

import logging
from collections.abc import Sequence

from rclpy.node import Node

from arm_control.spawner.command_line import UnspawnerOptions, absolute_name
from arm_control.spawner.ros_retrying_caller import RetryingCaller
from arm_node.controller_manager import ControllerManagerClient
from arm_node.process import EXIT_FAILED, EXIT_OK, NodeProcess

SERVICE_CALL_TIMEOUT_S = 10.0
UNLOAD_SERVICES = ("list_controllers", "switch_controller", "unload_controller")


def unspawn(node: Node, process: NodeProcess, options: UnspawnerOptions) -> int:
    """Unload controllers; return the process's exit code. Not on an executor's thread."""
    caller = RetryingCaller(
        node,
        absolute_name(options.controller_manager, node.get_namespace()),
        UNLOAD_SERVICES,
        SERVICE_CALL_TIMEOUT_S,
        lambda: process.stopping,
    )
    caller.wait_for("list_controllers", 0.0)
    manager = ControllerManagerClient(caller)
    log = logging.getLogger(node.get_logger().name)
    states = manager.states()
    active = [name for name in options.names if states.get(name) == "active"]
    others = [name for name in options.names if name not in active]
    if active and others:
        # As in ros2_control, whose strict switch refuses to deactivate an inactive controller.
        log.error(
            "Nothing is unloaded: %s is active, but %s is not", " ".join(active), " ".join(others)
        )
        return EXIT_FAILED
    return unload_controllers(manager, options.names, options.switch_timeout_s, log)


def unload_controllers(
    manager: ControllerManagerClient,
    names: Sequence[str],
    switch_timeout_s: float,
    log: logging.Logger,
) -> int:
    """Deactivate the active ones in one switch, then unload all; return the exit code.

    A controller that cannot be deactivated cannot be unloaded either, and unloading reports it.
    """
    states = manager.states()
    active = [name for name in names if states.get(name) == "active"]
    if active and manager.switch(deactivate=active, timeout_s=switch_timeout_s).ok:
        log.info("Deactivated controllers: %s", " ".join(active))
    code = EXIT_OK
    for name in names:
        if manager.unload(name):
            log.info("Unloaded controller %s", name)
        else:
            log.error("Failed to unload controller %s", name)
            code = EXIT_FAILED
    return code
