"""The executable `spawner`: loads, configures and activates controllers."""

import sys
import threading
from collections.abc import Iterator, Sequence
from contextlib import contextmanager

from arm_control.spawner_options import (
    SpawnerOptions,
    parse_spawner_options,
    split_ros_arguments,
)
from arm_node.process import NodeProcess, run_process


def main(argv: Sequence[str] | None = None) -> int:
    """Run a spawner; return 0, 1 where a step failed, 2 for a wrong command line."""
    arguments = list(sys.argv if argv is None else argv)
    own, ros = split_ros_arguments(arguments[1:])
    options = parse_spawner_options(own)

    @contextmanager
    def application(process: NodeProcess) -> Iterator[None]:
        yield from _spawn(process, options)

    return run_process(application, [arguments[0], *ros])


def _spawn(process: NodeProcess, options: SpawnerOptions) -> Iterator[None]:
    from rclpy.node import Node

    from arm_control.ros.spawner import Spawner

    node = Node(f"spawner_{options.names[0]}")
    process.executor.add_node(node)
    spawner = Spawner(node, options, lambda: process.stopping)
    done: list[int] = []

    def work() -> None:
        done.append(spawner.run())
        if done[0] or not options.unload_on_kill:
            process.stop(done[0])

    # The executor starts to spin only after the yield, so the work needs a thread of its own.
    worker = threading.Thread(target=work, name="spawner", daemon=True)
    worker.start()
    yield
    worker.join()
    if options.unload_on_kill and done == [0]:
        spawner.unload()


if __name__ == "__main__":
    sys.exit(main())
