"""Entry point of the `arm` command: finds the verb and leaves the rest to it."""

import sys
from collections.abc import Sequence

from arm_cli.verbs import VERBS

EXIT_USAGE = 2
DISTRIBUTION = "arm-suite"


def main(argv: Sequence[str] | None = None) -> int:
    """Run the command line; return the exit code."""
    words = list(sys.argv[1:] if argv is None else argv)
    if not words or words[0] in ("-h", "--help", "help"):
        print(_help())
        return 0 if words else EXIT_USAGE
    if words[0] in ("-V", "--version"):
        print(_version())
        return 0
    verb = next((verb for verb in VERBS if verb.name == words[0]), None)
    if verb is None:
        print(f"arm: {_unknown(words[0])}", file=sys.stderr)
        return EXIT_USAGE
    return verb.run(words[1:])


def _help() -> str:
    width = max(len(verb.name) for verb in VERBS)
    return "\n".join(
        [
            "usage: arm [-h] [--version] VERB ...",
            "",
            "Simulated robot arms on ROS 2, from pip.",
            "",
            "verbs:",
            *(f"  {verb.name:<{width}}  {verb.help}" for verb in VERBS),
            "",
            "`arm VERB --help` explains a verb.",
        ]
    )


def _version() -> str:
    from importlib.metadata import PackageNotFoundError, version

    try:
        return f"arm {version(DISTRIBUTION)}"
    except PackageNotFoundError:
        return f"arm (the distribution {DISTRIBUTION} is not installed)"


def _unknown(word: str) -> str:
    from launch_py.near_names import describe_known

    what = "option" if word.startswith("-") else "verb"
    known = [verb.name for verb in VERBS] if what == "verb" else ["--help", "--version"]
    return f"no {what} {word!r}; {describe_known(word, known)}"
