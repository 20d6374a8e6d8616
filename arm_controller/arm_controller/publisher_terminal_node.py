"""Executable publisher_terminal: moves the arm to the poses that the user types."""

import os
import sys
import threading
from collections.abc import Iterator, Sequence
from contextlib import contextmanager

from arm_controller.errors import ArmControllerError
from arm_controller.terminal import InputLines, TerminalDialogue
from arm_node.process import EXIT_FAILED, EXIT_OK, NodeProcess, run_process
from arm_node.workarounds.discovery import first_node

LINGER_S = 0.2
"""Time for the last message to arrive after the input has ended."""


def main(argv: Sequence[str] | None = None) -> int:
    """Run until the end of input or a signal; return 1 if a valid line was not delivered."""
    return run_process(_application, argv, user_errors=(ArmControllerError,))


@contextmanager
def _application(process: NodeProcess) -> Iterator[None]:
    from arm_controller.ros.publisher_terminal import PublisherTerminal

    node = first_node(lambda: PublisherTerminal(process))
    process.executor.add_node(node)
    with _standard_input() as descriptor, InputLines(descriptor) as lines:
        dialogue = TerminalDialogue(node.joint_names, lines.read_line, _write, node.deliver)
        thread = threading.Thread(target=_talk, args=(dialogue, process), name="dialogue")
        thread.start()
        try:
            yield
        finally:
            lines.end()
            thread.join()


def _talk(dialogue: TerminalDialogue, process: NodeProcess) -> None:
    exit_code = EXIT_FAILED
    try:
        if dialogue.run():
            exit_code = EXIT_OK
        process.wait(LINGER_S)
    finally:
        # A dialogue that a signal interrupts has not failed.
        if not process.stopping:
            process.stop(exit_code)


def _write(text: str) -> None:
    sys.stdout.write(text)
    sys.stdout.flush()


@contextmanager
def _standard_input() -> Iterator[int]:
    # A process may start without standard input, which counts as the end of input.
    if sys.stdin is not None:
        yield sys.stdin.fileno()
        return
    with open(os.devnull, "rb") as nothing:
        yield nothing.fileno()


if __name__ == "__main__":
    sys.exit(main())
