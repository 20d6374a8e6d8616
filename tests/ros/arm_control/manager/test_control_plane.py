"""Controllers with a node: parameters set at an awkward moment, end points that come and go."""

import threading
from collections.abc import Iterator
from concurrent.futures import Future, ThreadPoolExecutor
from contextlib import ExitStack
from dataclasses import dataclass
from typing import Any

import pytest
import rclpy
from rcl_interfaces.msg import SetParametersResult
from rclpy.executors import SingleThreadedExecutor
from rclpy.parameter import Parameter
from rclpy.signals import SignalHandlerOptions
from std_srvs.srv import Trigger

from arm_control import Controller, ControllerContext, InterfaceConfiguration, ReturnType, parameter
from arm_control.controllers.forward_command.ros import ForwardCommandAdapter
from arm_control.errors import ControllerError, ControllerManagerError
from arm_control.lifecycle import LifecycleState
from arm_control.loop.control_loop import ControlLoop
from arm_control.loop.pacer import Pacer
from arm_control.manager import controller_creation
from arm_control.manager.controller_manager import ControllerManager
from arm_control.manager.ros import control_plane
from arm_control.manager.ros.controller_manager_node import ControllerManagerNode
from arm_control.manager.ros.controller_manager_server import ControllerManagerServer
from arm_control.manager.switch_planner import SwitchRequest
from arm_control.testing import fake_hardware
from arm_node.executor_thread import ExecutorThread

TIMEOUT_S = 30.0


@dataclass(frozen=True, slots=True)
class ProbeParameters:
    gain: float = parameter(1.0, "May change at any time")


class Probe(Controller[ProbeParameters]):
    """Takes its time to be configured, and fails on demand."""

    parameters_type = ProbeParameters
    adapter = "arm_control.controllers.forward_command.ros:ForwardCommandAdapter"

    def __init__(self, context: ControllerContext) -> None:
        super().__init__(context)
        self.configuring, self.may_go_on = threading.Event(), threading.Event()
        self.may_go_on.set()
        self.refuses_changes = self.cannot_stop = False

    def command_interface_configuration(self) -> InterfaceConfiguration:
        return InterfaceConfiguration.none()

    def state_interface_configuration(self) -> InterfaceConfiguration:
        return InterfaceConfiguration.none()

    def on_configure(self, parameters: ProbeParameters) -> None:
        self.configuring.set()
        assert self.may_go_on.wait(TIMEOUT_S)
        super().on_configure(parameters)

    def update_parameters(self, parameters: ProbeParameters) -> None:
        if self.refuses_changes:
            raise ControllerError("no gain but the first")
        super().update_parameters(parameters)

    def update(self, time_s: float, period_s: float) -> ReturnType:
        return ReturnType.OK

    def on_deactivate(self) -> None:
        if self.cannot_stop:
            raise ControllerError("the bus is gone")


class Relay:
    """Passes the manager's transitions on to the control plane, as the server does."""

    def __init__(self, plane: Any) -> None:
        self.controller_transitioned = plane.publish_transition

    def activity_changed(self) -> None:
        """Do nothing."""


class RosBench:
    """A manager's node, its manager, a paused loop, and an executor."""

    def __init__(self, ending: ExitStack) -> None:
        rclpy.init(signal_handler_options=SignalHandlerOptions.NO)
        ending.callback(rclpy.try_shutdown)
        self.node = ControllerManagerNode(["test", "--ros-args", "-p", "it.type:=test/Probe"])
        self.manager = ControllerManager([fake_hardware()], 100)
        self.manager.bring_up()
        self.loop = ControlLoop(lambda: None, Pacer(0.01))
        self.loop.start(paused=True)
        self.thread = ExecutorThread("executor", SingleThreadedExecutor())
        self.thread.start()
        self.executor = self.thread.executor
        ending.callback(self.thread.stop)
        ending.callback(self.loop.join, TIMEOUT_S)
        ending.callback(self.loop.stop)

    def set(self, node: Any, name: str, value: object) -> Any:
        """Set a parameter where a client's request is served; return the result."""
        done: Future[Any] = Future()
        change = [Parameter(name, value=value)]
        self.executor.create_task(lambda: done.set_result(node.set_parameters(change)[0]))
        return done.result(TIMEOUT_S)


class LoadedProbe:
    """A probe under a control plane."""

    def __init__(self, bench: RosBench, monkeypatch: pytest.MonkeyPatch) -> None:
        made: list[Probe] = []

        def make(context: ControllerContext) -> Probe:
            made.append(Probe(context))
            return made[-1]

        monkeypatch.setattr(controller_creation, "controller_class", lambda _: make)
        self._bench = bench
        self.plane = control_plane.ControlPlane(
            bench.node, bench.manager, bench.loop, bench.executor, robot_description=""
        )
        bench.manager.add_observer(Relay(self.plane))
        self.plane.load_controller("it")
        (self.probe,) = made
        self.node: Any = next(n for n in bench.executor.get_nodes() if n.get_name() == "it")

    @property
    def state(self) -> LifecycleState:
        (status,) = self._bench.manager.list_controllers()
        return status.state

    def subscriptions(self) -> int:
        return [s.topic_name for s in self.node.subscriptions].count("/it/commands")

    def set_gain(self, value: float) -> bool:
        return self._bench.set(self.node, "gain", value).successful

    def set_gain_while_it_is_configured(self, value: float) -> "Future[None]":
        """Return the result of the configuration."""
        self.probe.may_go_on.clear()
        with ThreadPoolExecutor(1) as threads:
            configured = threads.submit(self.plane.configure_controller, "it")
            assert self.probe.configuring.wait(TIMEOUT_S)
            assert self.set_gain(value)
            self.probe.may_go_on.set()
        return configured

    def fail_to_stop(self) -> None:
        """Configure and activate it, then fail to deactivate it."""
        self.probe.cannot_stop = True
        self.plane.configure_controller("it")
        assert self.plane.switch_controller(SwitchRequest(("it",))).ok
        assert not self.plane.switch_controller(SwitchRequest((), ("it",))).ok
        assert self.state is LifecycleState.UNCONFIGURED


@pytest.fixture
def ending() -> Iterator[ExitStack]:
    with ExitStack() as stack:
        yield stack


@pytest.fixture
def ros_bench(ending) -> RosBench:
    return RosBench(ending)


@pytest.fixture
def loaded(ros_bench, ending, monkeypatch) -> LoadedProbe:
    ending.callback(ros_bench.node.destroy_node)
    loaded = LoadedProbe(ros_bench, monkeypatch)
    ending.callback(loaded.plane.destroy_nodes)
    # No node goes while the executor looks at it.
    ending.callback(ros_bench.thread.stop)
    return loaded


def test_a_parameter_set_during_the_configuration_takes_effect(loaded):
    loaded.set_gain_while_it_is_configured(2.0).result()
    assert loaded.probe.parameters.gain == 2.0


def test_a_parameter_set_while_it_is_configured_that_it_refuses_fails_that(loaded):
    loaded.probe.refuses_changes = True
    with pytest.raises(ControllerManagerError, match="was not configured: no gain but the first"):
        loaded.set_gain_while_it_is_configured(2.0).result()
    assert loaded.state is LifecycleState.UNCONFIGURED
    assert loaded.subscriptions() == 0


def test_a_parameter_stored_after_the_configuration_takes_effect(loaded, ros_bench):
    def configure(_: object) -> SetParametersResult:
        with ThreadPoolExecutor(1) as threads:
            threads.submit(loaded.plane.configure_controller, "it").result(TIMEOUT_S)
        return SetParametersResult(successful=True)

    # After the controller's own look at the change, before the change is stored.
    loaded.node._on_set_parameters_callbacks.append(configure)
    assert ros_bench.set(loaded.node, "gain", 2.0).successful
    assert loaded.probe.parameters.gain == 2.0


def test_to_configure_it_asks_nothing_of_the_executor(loaded, ros_bench, monkeypatch):
    # It does not spin yet when a simulation starts its controllers: each request would wait 5 s.
    def refuse(*_: object) -> None:
        pytest.fail("the executor was asked for something")

    monkeypatch.setattr(ros_bench.executor, "create_task", refuse)
    loaded.plane.configure_controller("it")
    assert loaded.state is LifecycleState.INACTIVE


def test_without_a_change_no_parameters_are_handed_over(loaded):
    loaded.probe.refuses_changes = True
    loaded.plane.configure_controller("it")
    assert loaded.state is LifecycleState.INACTIVE


def test_one_that_could_not_stop_has_its_end_points_once(loaded):
    loaded.fail_to_stop()
    loaded.fail_to_stop()
    loaded.plane.configure_controller("it")
    assert loaded.subscriptions() == 1
    loaded.plane.cleanup_controller("it")
    assert loaded.subscriptions() == 0


def test_one_that_could_not_stop_takes_parameters_when_it_is_configured(loaded):
    loaded.fail_to_stop()
    loaded.probe.refuses_changes = True
    assert loaded.set_gain(3.0)
    loaded.plane.configure_controller("it")
    assert loaded.probe.parameters.gain == 3.0


def test_warnings_of_overruns_can_be_switched_off_at_any_time(ros_bench, ending):
    server = ControllerManagerServer(
        ros_bench.node, ros_bench.manager, ros_bench.loop, ros_bench.executor
    )
    ending.callback(server.destroy_nodes)
    ending.callback(ros_bench.thread.stop)
    ending.callback(server.shutdown)
    for value in (False, True):
        assert ros_bench.set(ros_bench.node, "overruns.print_warnings", value).successful
        assert ros_bench.loop.pacer.print_warnings is value


def test_a_controller_whose_callback_is_a_coroutine_is_not_configured(loaded, monkeypatch):
    async def answer(_request: Any, response: Any) -> Any:
        return response

    def on_configure(adapter: Any, _parameters: Any) -> None:
        adapter.node.create_service(Trigger, "~/ask", answer)

    monkeypatch.setattr(ForwardCommandAdapter, "on_configure", on_configure)
    reason = "the callback of service ~/ask is a coroutine, which is never run; use a plain"
    with pytest.raises(ControllerManagerError, match=reason):
        loaded.plane.configure_controller("it")
    assert loaded.state is LifecycleState.UNCONFIGURED
