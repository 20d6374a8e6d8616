"""A process with a controller manager over fake hardware, for tests of its ROS side.

    python fake_manager.py [--start NAME ...] [--paused] [--ros-args ...]

Writes "ready" on standard output once the services are there. A line on its standard input acts
on it: "pause", "resume", "block" and "unblock" (the loop thread), "fail read".
"""

import argparse
import sys
import threading
from collections.abc import Iterator, Sequence
from contextlib import contextmanager

from arm_control.control_loop import ControlLoop
from arm_control.controller_manager import ControllerManager
from arm_control.errors import ArmControlError
from arm_control.hardware import HardwareReturn
from arm_control.pacer import Pacer
from arm_control.testing import fake_hardware
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


def main(argv: Sequence[str]) -> int:
    """Run the manager until a signal."""
    own = argv[1 : argv.index("--ros-args")] if "--ros-args" in argv else argv[1:]
    parser = argparse.ArgumentParser()
    parser.add_argument("--start", nargs="*", default=[])
    parser.add_argument("--paused", action="store_true")
    options = parser.parse_args(own)

    @contextmanager
    def application(process: NodeProcess) -> Iterator[None]:
        from arm_control.ros.controller_manager_node import ControllerManagerNode
        from arm_control.ros.controller_manager_server import ControllerManagerServer

        node = ControllerManagerNode(argv)
        rate_hz = node.settings.update_rate
        hardware = fake_hardware(
            JOINTS, command_interfaces=("position", "velocity"), name="HardwareInterface"
        )
        manager = ControllerManager([hardware], rate_hz, node.settings.policy)
        manager.bring_up()
        period_s = 1.0 / rate_hz
        time_s = 0.0

        def tick() -> None:
            nonlocal time_s
            manager.update(time_s, period_s)
            manager.write(time_s, period_s)
            time_s += period_s
            manager.read(time_s, period_s)
            manager.publish(time_s, period_s)

        unblocked = threading.Event()

        def obey() -> None:
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
                sys.stdout.write(f"{line.strip()} done\n")
                sys.stdout.flush()

        loop = ControlLoop(tick, Pacer(period_s), on_failure=lambda _: process.stop(1))
        loop.start(paused=options.paused)
        server = ControllerManagerServer(
            node, manager, loop, process.executor, robot_description=URDF
        )
        try:
            server.start_controllers(options.start)
            threading.Thread(target=obey, daemon=True).start()
            sys.stdout.write("ready\n")
            sys.stdout.flush()
            yield
        finally:
            server.shutdown()
            loop.stop()
            loop.join(5.0)
            server.destroy_nodes()

    return run_process(application, argv, user_errors=(ArmControlError,))


if __name__ == "__main__":
    sys.exit(main(sys.argv))
