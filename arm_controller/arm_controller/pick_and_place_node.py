"""Executable mycobot_pick_and_place: picks an object up, holds it, puts it back, and ends."""

import logging
import sys
from collections.abc import Iterator, Sequence
from contextlib import contextmanager

from arm_controller.errors import ArmControllerError
from arm_node.process import EXIT_FAILED, NodeProcess, run_process
from arm_node.workarounds.discovery import first_node

logger = logging.getLogger(__name__)


def main(argv: Sequence[str] | None = None) -> int:
    """Run one pick; return the exit code."""
    return run_process(_application, argv, user_errors=(ArmControllerError,))


@contextmanager
def _application(process: NodeProcess) -> Iterator[None]:
    from arm_controller.pick_and_place import PickAndPlace
    from arm_controller.ros.pick_and_place import PickAndPlaceNode
    from arm_description.errors import DescriptionError

    node = first_node(PickAndPlaceNode)

    async def pick() -> None:
        try:
            await node.connect()
            await PickAndPlace(node, await node.plan()).run()
        except (ArmControllerError, DescriptionError) as error:
            # A pick that a signal interrupts has not failed.
            if not process.stopping:
                logger.critical("%s", error)
                process.stop(EXIT_FAILED)
        else:
            process.stop()

    process.executor.add_node(node)
    process.executor.create_task(pick)
    yield
    node.stop()


if __name__ == "__main__":
    sys.exit(main())
