"""Executable publisher_defined: sends the arm to the poses of a file, one after the other."""

import sys
from collections.abc import Iterator, Sequence
from contextlib import contextmanager

from arm_controller.errors import ArmControllerError
from arm_node.discovery import answers_held_back
from arm_node.process import EXIT_FAILED, EXIT_OK, NodeProcess, run_process


def main(argv: Sequence[str] | None = None) -> int:
    """Run until every pose has had its turn; return 1 if one of them was not reached."""
    return run_process(_application, argv, user_errors=(ArmControllerError,))


@contextmanager
def _application(process: NodeProcess) -> Iterator[None]:
    from arm_controller.ros.publisher_defined import PublisherDefined

    def end(missed: int) -> None:
        process.stop(EXIT_FAILED if missed else EXIT_OK)

    with answers_held_back():
        node = PublisherDefined(end)
    process.executor.add_node(node)
    yield


if __name__ == "__main__":
    sys.exit(main())
