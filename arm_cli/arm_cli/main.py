"""Entry point of the `arm` command: finds the verb and leaves the rest to it."""

import os
import signal
import sys
from collections.abc import Sequence

DISTRIBUTION = "arm-suite"
EXIT_BROKEN_PIPE = 128 + signal.SIGPIPE


def main(argv: Sequence[str] | None = None) -> int:
    """Run the command line; return the exit code."""
    try:
        return _run(list(sys.argv[1:] if argv is None else argv))
    except KeyboardInterrupt:
        return int(signal.SIGINT)
    except BrokenPipeError:
        return _leave_broken_pipe()


def _run(words: list[str]) -> int:
    # Imported here: an interrupt meanwhile is one like any other.
    from arm_cli.errors import StoppedError
    from arm_cli.verbs import ARM

    if None in (sys.stdin, sys.stdout, sys.stderr):
        from launch_py.standard_streams import open_closed_streams

        open_closed_streams()
    if "_ARGCOMPLETE" in os.environ:
        from arm_cli.word_completion import complete_words

        complete_words()
    if words[:1] in (["-V"], ["--version"]):
        print(_version())
        return 0
    try:
        # Whoever reads from a pipe sees each line when it is printed.
        sys.stdout.reconfigure(line_buffering=True)  # pyright: ignore[reportAttributeAccessIssue]
        code = ARM.run("arm", words)
        sys.stdout.flush()
        return code
    except StoppedError as stopped:
        return stopped.exit_code


def _leave_broken_pipe() -> int:
    # The reader, `head` for example, has had enough. Python flushes stdout once more at exit and
    # would complain.
    os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
    return EXIT_BROKEN_PIPE


def _version() -> str:
    from importlib.metadata import PackageNotFoundError, version

    try:
        return f"arm {version(DISTRIBUTION)}"
    except PackageNotFoundError:
        return f"arm (the distribution {DISTRIBUTION} is not installed)"
