"""A node whose clock a test drives."""

import pytest


@pytest.fixture
def node():
    """Return a node that uses simulation time."""
    import rclpy
    from rclpy.context import Context
    from rclpy.node import Node
    from rclpy.parameter import Parameter
    from rclpy.signals import SignalHandlerOptions

    context = Context()
    rclpy.init(context=context, signal_handler_options=SignalHandlerOptions.NO)
    overrides = [Parameter("use_sim_time", value=True)]
    node = Node("simulated", context=context, parameter_overrides=overrides)
    yield node
    node.destroy_node()
    context.try_shutdown()
