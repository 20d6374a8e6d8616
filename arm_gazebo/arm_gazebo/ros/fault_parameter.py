"""Faults through a parameter of the simulation's node, which lists the requested ones."""

import logging
from collections.abc import Sequence
from concurrent.futures import TimeoutError as FutureTimeoutError
from functools import partial

from rcl_interfaces.msg import SetParametersResult
from rclpy.node import Node
from rclpy.parameter import Parameter

from arm_control.errors import LoopStoppedError
from arm_control.loop.control_loop import ControlLoop
from arm_gazebo.errors import FaultError
from arm_gazebo.faults.fault import USAGE, Fault, read_fault
from arm_gazebo.faults.injector import FaultInjector
from arm_node.parameter_values import ParameterValueError, read_texts
from arm_node.parameters import declare, take_other_notations

PARAMETER = "faults"
LOOP_TIMEOUT_S = 10.0

logger = logging.getLogger(__name__)

_KINDS = "; ".join(f"{kind.value} {words}" for kind, words in USAGE.items())
_read_names = partial(read_texts, wanted=f"a list of texts, each one of: {_KINDS}")


def declare_faults(node: Node) -> None:
    """Declare the parameter, without any faults."""
    declare(
        node,
        PARAMETER,
        [],
        _read_names,
        "faults for tests; each lasts as long as it is listed",
        read_only=False,
    )


class FaultParameter:
    """Begins and ends faults when the parameter `faults` is set.

    Its value is the list of all requested faults, such as `['joint_stalled j0', 'slow_tick 0.02']`;
    see `arm_gazebo.faults.fault`. The callback runs on the executor of its node, which waits for
    the loop.

    Args:
        node: declares the parameter.
        injector: belongs to the loop.
        loop: runs the simulation.
    """

    def __init__(self, node: Node, injector: FaultInjector, loop: ControlLoop) -> None:
        self._injector = injector
        self._loop = loop
        declare_faults(node)
        take_other_notations(node, PARAMETER)
        node.add_on_set_parameters_callback(self._take)

    def _take(self, changed: Sequence[Parameter]) -> SetParametersResult:
        try:
            for parameter in changed:
                if parameter.name == PARAMETER:
                    wanted = [read_fault(text) for text in read_texts(list(parameter.value or ()))]
                    self._loop.call(lambda faults=wanted: self._change(faults)).result(
                        LOOP_TIMEOUT_S
                    )
        except (ParameterValueError, FaultError, LoopStoppedError) as error:
            return SetParametersResult(successful=False, reason=f"{PARAMETER}: {error}")
        except FutureTimeoutError:
            reason = f"{PARAMETER}: the simulation did not respond within {LOOP_TIMEOUT_S:g} s"
            return SetParametersResult(successful=False, reason=reason)
        return SetParametersResult(successful=True)

    def _change(self, wanted: Sequence[Fault]) -> None:
        """Begin and end faults so that those in the list remain, all or nothing. Loop thread."""
        injector = self._injector
        for fault in wanted:
            injector.check(fault)
        for fault in [fault for fault in injector.active if fault not in wanted]:
            injector.end(fault)
            logger.warning("fault ends: %s", fault)
        for fault in dict.fromkeys(wanted):
            if fault not in injector.active:
                logger.warning("fault begins: %s", fault)
                injector.begin(fault)
