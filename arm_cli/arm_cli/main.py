"""Entry point of the `arm` command: finds the verb and runs it."""

import errno
import gc
import os
import signal
import sys
from collections.abc import Sequence
from typing import NoReturn

DISTRIBUTION = "arm-suite"
EXIT_BROKEN_PIPE = 128 + signal.SIGPIPE
COLLECTION_THRESHOLD = 50_000
"""How many new objects Python waits for before it looks for reference cycles; by default 700.
Nearly all that a command makes until it runs stays; to look through it takes a tenth of that time.
"""


def run() -> NoReturn:
    """Run the command line of this process and end the process."""
    gc.set_threshold(COLLECTION_THRESHOLD)
    code = main()
    from arm_node.workarounds.exit_pause import end_process

    end_process(code)


def main(argv: Sequence[str] | None = None) -> int:
    """Run the command line; return the exit code."""
    try:
        return _run(list(sys.argv[1:] if argv is None else argv))
    except KeyboardInterrupt:
        return int(signal.SIGINT)
    except BrokenPipeError:
        _discard_stdout()
        return EXIT_BROKEN_PIPE
    except OSError as error:
        sentence = _describe_surroundings(error)
        if not sentence:
            raise
        _discard_stdout()
        sys.stderr.write(f"arm: {sentence}\n")
        return 1


def gz() -> int:
    """Run a command line of Gazebo's `gz`, or Ignition's `ign`, from a launch file."""
    return main(["gz", *sys.argv[1:]])


def _run(words: list[str]) -> int:
    # Imported here, so that Ctrl-C during the imports is handled like any other.
    from arm_cli.errors import StoppedError
    from arm_cli.output import say
    from arm_cli.verbs import ARM

    if None in (sys.stdin, sys.stdout, sys.stderr):
        from launch_py.standard_streams import open_closed_streams

        open_closed_streams()
    if "_ARGCOMPLETE" in os.environ:
        from arm_cli.word_completion import complete_words

        complete_words()
    if words[:1] in (["-V"], ["--version"]):
        say(_version())
        return 0
    try:
        # The reader of a pipe sees each line as soon as it is printed. Names may have characters
        # that the terminal's encoding lacks.
        sys.stdout.reconfigure(  # pyright: ignore[reportAttributeAccessIssue]
            line_buffering=True, errors="backslashreplace"
        )
        code = ARM.run("arm", words)
        sys.stdout.flush()
        return code
    except StoppedError as stopped:
        return stopped.exit_code


def _discard_stdout() -> None:
    # The reader, for example `head`, has closed the pipe, or the disk is full. Without this,
    # Python's last flush of stdout would fail at exit.
    os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())


def _describe_surroundings(error: OSError) -> str | None:
    """Return a sentence if the machine, and no input of the command, causes this error."""
    if error.errno in (errno.ENOSPC, errno.EDQUOT, errno.EFBIG):
        where = f" {error.filename}" if error.filename else ""
        return f"cannot write{where}: {os.strerror(error.errno)}"
    try:
        os.getcwd()
    except FileNotFoundError:
        return "the current folder no longer exists; change to another one"
    return None


def _version() -> str:
    from importlib.metadata import PackageNotFoundError, version

    try:
        return f"arm {version(DISTRIBUTION)}"
    except PackageNotFoundError:
        return f"arm (the distribution {DISTRIBUTION} is not installed)"
