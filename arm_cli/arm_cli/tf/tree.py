"""`arm tf tree`: the tree of frames as text."""

import argparse

from arm_cli.command_parser import positive_number
from arm_cli.output import add_json_argument, print_json
from arm_cli.ros.connection import connect
from arm_cli.tf.listening import listen

LISTEN_S = 1.0


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the verb's arguments."""
    parser.add_argument(
        "-t",
        "--wait-time",
        type=positive_number,
        default=LISTEN_S,
        metavar="SECONDS",
        help=f"listen so long (default {LISTEN_S:g})",
    )
    add_json_argument(parser)


def run(options: argparse.Namespace) -> None:
    """Print the tree.

    Raises:
        UnansweredError: nobody publishes transforms.
    """
    with connect() as session:
        log = listen(session, options.wait_time)
    if options.json:
        print_json(
            {
                name: {"parent": h.parent, "static": h.static, "rate_hz": h.rate_hz}
                for name, h in sorted(log.frames.items())
            }
        )
    else:
        print(*log.draw_tree(), sep="\n")
