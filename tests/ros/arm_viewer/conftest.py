"""The page's node without a page, spun by the test, so that nothing happens behind its back."""

import time
from collections.abc import Callable

import pytest
import rclpy
from rclpy.context import Context
from rclpy.executors import SingleThreadedExecutor
from rclpy.signals import SignalHandlerOptions

from arm_viewer.ros.viewer import Viewer

TIMEOUT_S = 60.0


class SpunViewer:
    """The node, and the ways to wait with it."""

    def __init__(self, *parameters: str) -> None:
        self.context = Context()
        rclpy.init(
            args=["--ros-args", *(word for each in parameters for word in ("-p", each))],
            context=self.context,
            signal_handler_options=SignalHandlerOptions.NO,
        )
        self.node = Viewer(self.context)
        self._executor = SingleThreadedExecutor(context=self.context)
        self._executor.add_node(self.node)

    def seen(self, find: Callable, meanwhile: Callable[[], None] = lambda: None):
        """Spin until `find(snapshot)` finds something, and return it."""
        return self.until(lambda: find(self.node.latest()), meanwhile)

    def until(self, find: Callable, meanwhile: Callable[[], None] = lambda: None):
        """Spin until `find()` finds something, and return it; publish `meanwhile`, again and again.

        A message that is sent right after the match may be lost.
        """
        deadline = time.monotonic() + TIMEOUT_S
        while not (found := find()):
            if time.monotonic() > deadline:
                pytest.fail(f"not within {TIMEOUT_S} s; the snapshot is {self.node.latest()}")
            meanwhile()
            self._executor.spin_once(timeout_sec=0.05)
        return found

    def close(self) -> None:
        self._executor.shutdown()
        self.node.destroy_node()
        self.context.try_shutdown()


@pytest.fixture(scope="module")
def viewer():
    spun = SpunViewer("publish_joint_states:=true")
    yield spun
    spun.close()


@pytest.fixture
def new_viewer():
    """Return a function that creates a viewer like that of a page beside a robot."""
    spun = []

    def create() -> SpunViewer:
        spun.append(SpunViewer())
        return spun[-1]

    yield create
    for viewer in spun:
        viewer.close()
