"""The nodes of a simulation's process take its time without /clock."""

import threading

import pytest

from arm_node.workarounds.clocks import ProcessClock

pytestmark = [pytest.mark.ros, pytest.mark.workaround("process_clock")]


class Simulation:
    """A time that the test sets, and the clock of its process."""

    def __init__(self) -> None:
        self.time_ns = 0
        self.clock = ProcessClock(lambda: self.time_ns)

    def go_to(self, time_ns: int) -> None:
        self.time_ns = time_ns
        self.clock.advance()


@pytest.fixture
def simulation(node):
    made = Simulation()
    made.clock.give(node)
    return made


def test_a_node_has_the_time_and_listens_to_nothing(node, simulation):
    simulation.go_to(1_500_000_000)
    assert node.get_clock().now().nanoseconds == 1_500_000_000
    assert node.get_clock().ros_time_is_active
    assert not list(node.subscriptions)
    assert node.get_parameter("use_sim_time").value is True


@pytest.mark.parametrize("kind", ["single-threaded", "event-driven"])
def test_timers_run_in_simulation_time(node, simulation, kind):
    from rclpy.executors import SingleThreadedExecutor
    from rclpy.experimental.events_executor import EventsExecutor

    types = {"single-threaded": SingleThreadedExecutor, "event-driven": EventsExecutor}
    executor = types[kind](context=node.context)
    executor.add_node(node)
    called = threading.Event()
    node.create_timer(10.0, called.set)
    simulation.go_to(9_000_000_000)
    executor.spin_once(timeout_sec=0.05)
    assert not called.is_set()
    simulation.go_to(10_000_000_000)
    while not called.is_set():
        executor.spin_once(timeout_sec=0.05)
    executor.shutdown()


def test_time_may_be_set_back(node, simulation):
    node.create_timer(10.0, lambda: None)
    for time_ns in (5, 3, 0):
        simulation.go_to(time_ns)
        assert node.get_clock().now().nanoseconds == time_ns


def test_a_client_cannot_give_it_another_clock(node, simulation):
    from rclpy.parameter import Parameter

    simulation.go_to(7)
    (refused,) = node.set_parameters([Parameter("use_sim_time", value=False)])
    assert not refused.successful
    assert "stays true" in refused.reason
    (kept,) = node.set_parameters([Parameter("use_sim_time", value=True)])
    assert kept.successful
    assert node.get_clock().now().nanoseconds == 7
    assert not list(node.subscriptions)
