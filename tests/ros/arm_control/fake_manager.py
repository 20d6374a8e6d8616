"""A process with a controller manager over fake hardware, for tests of its ROS side.

    python fake_manager.py [--start NAME ...] [--paused] [--ros-args ...]

Writes "ready" on standard output once the services are there. A line on its standard input acts
on it: "pause", "resume", "block" and "unblock" (the loop thread), and what the hardware does next:
"fail read", "fail write", "deactivate" and "recover".
"""

import argparse
import sys
import threading
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from functools import partial

from arm_control.errors import ArmControlError
from arm_control.hardware.driver import HardwareReturn
from arm_control.loop.control_loop import ControlLoop
from arm_control.loop.pacer import Pacer
from arm_control.manager.controller_manager import ControllerManager
from arm_control.testing import FakeHardware, fake_hardware
from arm_node.process import NodeProcess, run_process

JOINTS = ("j0", "j1", "j2", "j3")
URDF = (
    "<robot name='fake'><link name='base_link'/>"
    + "".join(
        f"<link name='{joint}_link'/><joint name='{joint}' type='revolute'>"
        f"<parent link='base_link'/><child link='{joint}_link'/>"
        "<limit lower='-3' upper='3' effort='5' velocity='2'/></joint>"
        for joint in JOINTS
    )
    + "</robot>"
)


class Ticks:
    """The manager's cycle, in a time of its own."""

    def __init__(self, manager: ControllerManager, period_s: float) -> None:
        self._manager = manager
        self._period_s = period_s
        self._time_s = 0.0

    def __call__(self) -> None:
        self._manager.update(self._time_s, self._period_s)
        self._manager.write(self._time_s, self._period_s)
        self._time_s += self._period_s
        self._manager.read(self._time_s, self._period_s)
        self._manager.publish(self._time_s, self._period_s)


def obey(loop: ControlLoop, hardware: FakeHardware) -> None:
    """Execute the commands on standard input, and confirm each."""
    unblocked = threading.Event()
    for line in sys.stdin:
        match line.split():
            case ["pause"]:
                loop.pause().result(10.0)
            case ["resume"]:
                loop.resume().result(10.0)
            case ["block"]:
                unblocked.clear()
                loop.call(lambda: unblocked.wait(60.0))
            case ["unblock"]:
                unblocked.set()
            case ["fail", "read"]:
                hardware.read_result = HardwareReturn.ERROR
            case ["fail", "write"]:
                hardware.write_result = HardwareReturn.ERROR
            case ["deactivate"]:
                hardware.write_result = HardwareReturn.DEACTIVATE
            case ["recover"]:
                hardware.read_result = hardware.write_result = HardwareReturn.OK
        sys.stdout.write(f"{line.strip()} done\n")
        sys.stdout.flush()


@contextmanager
def application(
    argv: Sequence[str], start: Sequence[str], paused: bool, process: NodeProcess
) -> Iterator[None]:
    """Run the manager over fake hardware, with these controllers active."""
    from arm_control.manager.controller_manager import bring_up, configured_manager
    from arm_control.manager.ros.controller_manager_node import ControllerManagerNode
    from arm_control.manager.ros.controller_manager_server import ControllerManagerServer

    node = ControllerManagerNode(argv)
    hardware = fake_hardware(
        JOINTS, command_interfaces=("position", "velocity"), name="HardwareInterface"
    )
    manager = configured_manager([hardware], node.settings, URDF, node.get_fully_qualified_name())
    bring_up(manager, node.settings)
    period_s = 1.0 / node.settings.update_rate
    loop = ControlLoop(
        Ticks(manager, period_s), Pacer(period_s), on_failure=lambda _: process.stop(1)
    )
    loop.start(paused=paused)
    server = ControllerManagerServer(node, manager, loop, process.executor, robot_description=URDF)
    try:
        server.start_controllers(start)
        threading.Thread(target=obey, args=(loop, hardware), daemon=True).start()
        sys.stdout.write("ready\n")
        sys.stdout.flush()
        yield
    finally:
        server.shutdown()
        loop.stop()
        loop.join(60.0)
        # An executor that waits for a node that goes has a callback that failed, with a traceback.
        process.join_spinning()
        server.destroy_nodes()


def main(argv: Sequence[str]) -> int:
    """Run the manager until a signal."""
    own = argv[1 : argv.index("--ros-args")] if "--ros-args" in argv else argv[1:]
    parser = argparse.ArgumentParser()
    parser.add_argument("--start", nargs="*", default=[])
    parser.add_argument("--paused", action="store_true")
    options = parser.parse_args(own)
    run = partial(application, argv, options.start, options.paused)
    return run_process(run, argv, user_errors=(ArmControlError,))


if __name__ == "__main__":
    sys.exit(main(sys.argv))
