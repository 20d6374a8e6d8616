"""The command line of `arm launch` and `python -m launch_py`."""

from __future__ import annotations

import argparse
import os
import signal
import sys
import time
import traceback
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from types import MappingProxyType
from typing import TYPE_CHECKING

from launch_py.command.interruption import Interruption
from launch_py.errors import LaunchError, NotFoundError, UsageError
from launch_py.launch_description import LaunchDescription, expand_description, survey_description
from launch_py.launch_description_sources import read_launch_file
from launch_py.near_names import describe_known, did_you_mean, near_names
from launch_py.printable import printable_message
from launch_py.system.packages import (
    LAUNCH_ENDING,
    LAUNCH_ENDINGS,
    Packages,
    ament_prefixes,
    describe_missing_launch_file,
    launch_files,
)
from launch_py.typed_values import parse_boolean

if TYPE_CHECKING:
    from launch_py.supervision.foreground import KeyCommand

EXIT_INTERRUPTED = 130

REPLACE = "replace"
"""The argument that ends running nodes with the names of those to be started."""

DEFAULT_LOG_LIMIT_MIB = 50.0

PackagedFile = tuple[str, str]
"""A package, and the name of one of its launch files."""
LONGEST_SHOWN = 200
"""How many characters of a word an error message shows."""


@dataclass(frozen=True, slots=True)
class _LaunchRequest:
    """A parsed command line: a launch file, values of its arguments, and what to do with it."""

    launch_file: Path
    arguments: dict[str, str]
    show_args: bool = False
    print_plan: bool = False
    show_all: bool = False
    log_limit_mib: float = DEFAULT_LOG_LIMIT_MIB


def run(
    argv: Sequence[str],
    program: str,
    short_names: Mapping[str, PackagedFile] = MappingProxyType({}),
    before_start: Callable[[], None] = lambda: None,
    key: KeyCommand | None = None,
) -> int:
    """Execute the command line; return the exit code.

    A mistake in the command line or the launch file is reported in one sentence on stderr, with
    exit code 2, and one in a file for a node with exit code 1. A stop signal before the first
    process starts is reported, with exit code 0.

    Args:
        argv: the words after the program's name.
        program: the program's name in its help.
        short_names: launch files by short name; "" is the default launch file.
        before_start: called after all checks and before the first start; it raises a LaunchError
            to prevent the start.
        key: what the space bar does while the launch runs on a terminal.
    """
    started_s = time.monotonic()
    parser = _parser(program, short_names)
    options = argparse.Namespace(debug=False, show_args=False, print_plan=False)
    interruption = Interruption()
    with interruption.at(signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
        try:
            options, unknown = parser.parse_known_intermixed_args(argv)
            _refuse_unknown_options(unknown, parser)
            request = parse_request(options, short_names)
            return _execute(request, started_s, before_start, key, interruption)
        except BaseException as error:
            # Some libraries turn Ctrl-C into an error of their own; other errors are raised again.
            if interruption.came or isinstance(error, KeyboardInterrupt):
                return _interrupted(program, options)
            if not isinstance(error, LaunchError):
                raise
            if options.debug:
                traceback.print_exc()
            sys.stderr.write(f"{program}: {printable_message(str(error))}\n")
            return error.exit_code


def _interrupted(program: str, options: argparse.Namespace) -> int:
    if options.show_args or options.print_plan:
        return EXIT_INTERRUPTED
    sys.stderr.write(f"{program}: stopped before anything was started\n")
    return 0


def parse_request(
    options: argparse.Namespace, short_names: Mapping[str, PackagedFile]
) -> _LaunchRequest:
    """Return the request that the parsed words describe.

    Raises:
        UsageError: there are too many or too few words, or an argument is malformed.
        NotFoundError: there is no such package or launch file.
    """
    arguments: dict[str, str] = {}
    words: list[str] = []
    for word in options.words:
        name, separator, value = word.partition(":=")
        if not separator:
            words.append(word)
        elif not name:
            raise UsageError(f"{word!r} has no name before ':='")
        else:
            arguments[name] = value
    return _LaunchRequest(
        launch_file=find_launch_file(words, short_names),
        arguments=arguments,
        show_args=options.show_args,
        print_plan=options.print_plan,
        show_all=options.show_all or options.debug,
        log_limit_mib=options.log_limit,
    )


def find_launch_file(words: Sequence[str], short_names: Mapping[str, PackagedFile]) -> Path:
    """Return the launch file that a short name, a path, or a package and a file name stand for.

    Raises:
        UsageError: the words are none of these.
        NotFoundError: there is no such package, short name or launch file.
    """
    packages = Packages(os.environ)
    for word in words:
        if "=" in word and not os.path.exists(word):
            raise UsageError(f"{word!r}: launch arguments are written name:=value")
    match words:
        case []:
            if "" not in short_names:
                raise UsageError("which launch file? Give PACKAGE FILE, or the path of a file")
            return packages.launch_file(*short_names[""])
        case [word] if os.path.isfile(word):
            # Absolute, because the launch file passes its own folder on to other processes.
            return Path(os.path.abspath(word))
        case [word] if word in short_names:
            return packages.launch_file(*short_names[word])
        case [word] if word.endswith(LAUNCH_ENDINGS) or os.sep in word:
            try:
                sentence = describe_missing_launch_file(word, packages)
            except ValueError as error:  # A file cannot have this name.
                raise UsageError(f"no launch file {word[:LONGEST_SHOWN]!r}: {error}") from error
            raise UsageError(sentence)
        case [word]:
            share = _share_folder(packages, word, short_names)
            names = launch_files(share / "launch")
            raise UsageError(
                f"which launch file of package {word!r}? It has {', '.join(names) or 'none'}"
            )
        case [package, name]:
            return packages.launch_file(package, name)
    raise UsageError(
        f"too many words: {' '.join(words)}; launch arguments are written name:=value, "
        "without spaces around ':='"
    )


def _share_folder(packages: Packages, word: str, short_names: Mapping[str, PackagedFile]) -> Path:
    try:
        return packages.share_folder(word)
    except NotFoundError as error:
        near = near_names(word, filter(None, short_names))
        if not near:
            raise
        near += near_names(word, packages.names())
        raise NotFoundError(f"no package or short name {word!r}; {did_you_mean(near)}") from error


def _execute(
    request: _LaunchRequest,
    started_s: float,
    before_start: Callable[[], None],
    key: KeyCommand | None,
    interruption: Interruption,
) -> int:
    # Launch files look up packages too, in this process.
    os.environ["AMENT_PREFIX_PATH"] = os.pathsep.join(ament_prefixes(os.environ))
    environ = dict(os.environ)
    description = read_launch_file(request.launch_file)
    if request.show_args:
        from launch_py.command.listings import list_arguments

        survey = survey_description(description, environ, request.launch_file)
        sys.stdout.write(list_arguments(survey, request.launch_file))
        return 0
    arguments = dict(request.arguments)
    replace = _take_replace(arguments, description, environ, request.launch_file)
    plan = expand_description(description, arguments, environ, request.launch_file)
    if request.print_plan:
        from launch_py.command.listings import list_plan

        sys.stdout.write(list_plan(plan, environ))
        return 0
    before_start()
    from launch_py.supervision.linux import start_of_program
    from launch_py.supervision.session import LaunchOptions, run_plan

    sys.stdout.reconfigure(errors="replace")  # pyright: ignore[reportAttributeAccessIssue]
    options = LaunchOptions(
        title=LAUNCH_ENDING.sub("", request.launch_file.name),
        started_s=start_of_program(started_s),
        show_all=request.show_all,
        replace=replace,
        log_limit_bytes=int(request.log_limit_mib * 1024 * 1024),
        key=key,
    )
    interruption.check()
    return run_plan(plan, environ, options)


def _take_replace(
    arguments: dict[str, str],
    description: LaunchDescription,
    environ: Mapping[str, str],
    path: Path,
) -> bool:
    """Remove replace:=... from the arguments and return its value.

    It belongs to the launcher unless the launch file declares an argument of that name.
    """
    if REPLACE not in arguments:
        return False
    if REPLACE in survey_description(description, environ, path).arguments:
        return False
    text = arguments.pop(REPLACE)
    truth = parse_boolean(text)
    if truth is None:
        raise UsageError(f"{REPLACE}:={text} is neither true nor false")
    return truth


def _parser(program: str, short_names: Mapping[str, PackagedFile]) -> argparse.ArgumentParser:
    meanings = [
        f"{word or 'Without PACKAGE and FILE'}: {package} {name}."
        for word, (package, name) in short_names.items()
    ]
    parser = argparse.ArgumentParser(
        prog=program,
        description="Start the processes of a launch file and supervise them.",
        epilog=" ".join(meanings) or None,
        allow_abbrev=False,
    )
    parser.add_argument(
        "words",
        nargs="*",
        metavar="PACKAGE FILE | PATH | name:=value",
        help="a launch file, by package and file name or by path, and values of its arguments; "
        "replace:=true ends running nodes that have the names of the nodes to be started",
    )
    parser.add_argument(
        "-s",
        "--show-args",
        "--show-arguments",
        dest="show_args",
        action="store_true",
        help="list the arguments of the launch file and exit",
    )
    parser.add_argument(
        "-p",
        "--print",
        "--print-description",
        dest="print_plan",
        action="store_true",
        help="show what would be started, and exit",
    )
    parser.add_argument(
        "-a",
        "--show-all-subprocesses-output",
        dest="show_all",
        action="store_true",
        help="also show the output that otherwise goes to the log files only",
    )
    parser.add_argument(
        "-d",
        "--debug",
        action="store_true",
        help="like -a, and show the supervisor's debug messages and tracebacks of errors",
    )
    parser.add_argument(
        "--log-limit",
        type=_log_limit,
        default=DEFAULT_LOG_LIMIT_MIB,
        metavar="MIB",
        help="largest total size of a process's log files, NAME.log and the older NAME.log.1, "
        "in MiB (default: %(default)g)",
    )
    # Accepted because command lines written for ros2 use it. The launcher never asks anything.
    parser.add_argument("-n", "--noninteractive", action="store_true", help=argparse.SUPPRESS)
    return parser


def _log_limit(text: str) -> float:
    try:
        limit = float(text)
    except ValueError:
        raise argparse.ArgumentTypeError(f"must be a number of MiB, not {text!r}") from None
    if not 0.1 <= limit < float("inf"):
        raise argparse.ArgumentTypeError(f"must be at least 0.1 MiB, not {text}")
    return limit


def _refuse_unknown_options(unknown: Sequence[str], parser: argparse.ArgumentParser) -> None:
    if unknown:
        known = [
            name
            for name, action in parser._option_string_actions.items()
            if action.help != argparse.SUPPRESS
        ]
        text = f"no option {unknown[0]}; {describe_known(unknown[0], known)}"
        dashes, name = unknown[0][:2], unknown[0][2:].partition("=")[0]
        if dashes == "--":
            text += f"; an argument of the launch file is given as {name}:=VALUE"
        raise UsageError(text)
