"""Executable publisher_terminal: sends the arm to the poses that a person types."""

import os
import sys
import threading
from collections.abc import Iterator, Sequence
from contextlib import contextmanager

from arm_controller.errors import ArmControllerError
from arm_controller.input_lines import InputLines
from arm_controller.terminal_dialogue import TerminalDialogue
from arm_node.discovery import answers_held_back
from arm_node.process import EXIT_FAILED, EXIT_OK, NodeProcess, run_process

LINGER_S = 0.2
"""The last message may still be on its way when the input ends."""


def main(argv: Sequence[str] | None = None) -> int:
    """Talk until the end of input or a signal; return 1 if a good line was not delivered."""
    return run_process(_application, argv, user_errors=(ArmControllerError,))


@contextmanager
def _application(process: NodeProcess) -> Iterator[None]:
    from arm_controller.ros.publisher_terminal import PublisherTerminal

    with answers_held_back():
        node = PublisherTerminal(process)
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
        # Whoever ends the dialogue by a signal has not failed.
        if not process.stopping:
            process.stop(exit_code)


def _write(text: str) -> None:
    sys.stdout.write(text)
    sys.stdout.flush()


@contextmanager
def _standard_input() -> Iterator[int]:
    # A process that was started without an input has none to talk to: the same as its end.
    if sys.stdin is not None:
        yield sys.stdin.fileno()
        return
    with open(os.devnull, "rb") as nothing:
        yield nothing.fileno()


if __name__ == "__main__":
    sys.exit(main())
