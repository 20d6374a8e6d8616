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

from launch_py.errors import LaunchError, UsageError
from launch_py.expansion import expand_description, survey_description
from launch_py.interruption import Interruption
from launch_py.launch_description_sources import read_launch_file
from launch_py.near_names import describe_known
from launch_py.packages import Packages, ament_prefixes

EXIT_USAGE = 2
EXIT_INTERRUPTED = 130

PackagedFile = tuple[str, str]
"""A package, and the name of one of its launch files."""


@dataclass(frozen=True, slots=True)
class LaunchRequest:
    """What was asked for: a launch file, values of its arguments, what to do with it."""

    launch_file: Path
    arguments: dict[str, str]
    show_args: bool = False
    print_plan: bool = False
    show_all: bool = False


def run(
    argv: Sequence[str],
    program: str,
    short_names: Mapping[str, PackagedFile] = MappingProxyType({}),
    before_start: Callable[[], None] = lambda: None,
) -> int:
    """Carry out the command line; return the exit code.

    Args:
        argv: the words after the program's name.
        program: what to call it in its help.
        short_names: launch files by a word that stands for each; "" for where none is given.
        before_start: called when everything is checked and nothing is started yet; whatever
            speaks against starting it raises as a LaunchError.

    What is wrong with the words or the launch file is one sentence on stderr and exit code 2. Asked
    to stop before anything is started, it says so and has not failed.
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
            return _carry_out(request, started_s, before_start, interruption)
        except BaseException as error:
            if interruption.came or isinstance(error, KeyboardInterrupt):
                return _interrupted(program, options)
            if not isinstance(error, LaunchError):
                raise
            if options.debug:
                traceback.print_exc()
            sys.stderr.write(f"{program}: {error}\n")
            return EXIT_USAGE


def _interrupted(program: str, options: argparse.Namespace) -> int:
    if options.show_args or options.print_plan:
        return EXIT_INTERRUPTED
    sys.stderr.write(f"{program}: stopped before anything was started\n")
    return 0


def parse_request(
    options: argparse.Namespace, short_names: Mapping[str, PackagedFile]
) -> LaunchRequest:
    """Return what the parsed words ask for.

    Raises:
        UsageError: too many or too few words, or a malformed argument.
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
    return LaunchRequest(
        launch_file=find_launch_file(words, short_names),
        arguments=arguments,
        show_args=options.show_args,
        print_plan=options.print_plan,
        show_all=options.show_all or options.debug,
    )


def find_launch_file(words: Sequence[str], short_names: Mapping[str, PackagedFile]) -> Path:
    """Return the launch file that a short name, a path, or a package and a file name stand for.

    Raises:
        UsageError: the words are neither.
        NotFoundError: there is no such package or launch file.
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
            # Absolute, as the launch file's own folder is handed on to other processes.
            return Path(os.path.abspath(word))
        case [word] if word in short_names:
            return packages.launch_file(*short_names[word])
        case [word] if word.endswith(".py") or os.sep in word:
            path = Path(word)
            names = [p.name for p in path.parent.glob("*.py")]
            hint = describe_known(path.name, names, f"{path.parent.resolve()} holds")
            raise UsageError(f"no launch file {word}; {hint}")
        case [word]:
            share = packages.share_folder(word)
            names = [p.name for p in sorted(share.glob("launch/*.py"))]
            raise UsageError(
                f"which launch file of package {word!r}? It has {', '.join(names) or 'none'}"
            )
        case [package, name]:
            return packages.launch_file(package, name)
    raise UsageError(
        f"too many words: {' '.join(words)}; launch arguments are written name:=value, "
        "without spaces around ':='"
    )


def _carry_out(
    request: LaunchRequest,
    started_s: float,
    before_start: Callable[[], None],
    interruption: Interruption,
) -> int:
    # Launch files look packages up, too, before any process of theirs exists.
    os.environ["AMENT_PREFIX_PATH"] = os.pathsep.join(ament_prefixes(os.environ))
    environ = dict(os.environ)
    description = read_launch_file(request.launch_file)
    if request.show_args:
        from launch_py.argument_listing import list_arguments

        survey = survey_description(description, environ, request.launch_file)
        sys.stdout.write(list_arguments(survey, request.launch_file))
        return 0
    plan = expand_description(description, request.arguments, environ, request.launch_file)
    if request.print_plan:
        from launch_py.plan_listing import list_plan

        sys.stdout.write(list_plan(plan, environ))
        return 0
    before_start()
    from launch_py.supervision.linux import start_of_program
    from launch_py.supervision.session import SessionOptions, run_plan

    sys.stdout.reconfigure(errors="replace")  # pyright: ignore[reportAttributeAccessIssue]
    options = SessionOptions(
        title=request.launch_file.name.removesuffix(".launch.py"),
        started_s=start_of_program(started_s),
        show_all=request.show_all,
    )
    interruption.check()
    return run_plan(plan, environ, options)


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
        help="a launch file, by package and file name or by path, and values of its arguments",
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
        help="also show output that is meant for the log files only",
    )
    parser.add_argument(
        "-d",
        "--debug",
        action="store_true",
        help="like -a, with what the supervisor does and tracebacks of errors",
    )
    # Nothing is ever asked; but lines written for ros2 say so.
    parser.add_argument("-n", "--noninteractive", action="store_true", help=argparse.SUPPRESS)
    return parser


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
