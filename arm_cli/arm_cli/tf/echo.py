"""`arm tf echo`: where a frame is in another, as tf2_echo prints it."""

import argparse

from arm_cli.command_parser import positive_number
from arm_cli.errors import NotFoundError
from arm_cli.frames.lookup_text import describe_lookup
from arm_cli.output import add_json_argument, print_json
from arm_cli.ros.connection import connect
from arm_cli.tf.listening import listen

SETTLE_S = 2.0


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the verb's arguments."""
    parser.add_argument("source_frame", help="such as base_link")
    parser.add_argument("target_frame", help="whose pose in the source frame is printed")
    parser.add_argument(
        "rate", nargs="?", type=positive_number, default=1.0, help="prints a second (default 1)"
    )
    parser.add_argument("--once", action="store_true", help="end after one")
    add_json_argument(parser)


def run(options: argparse.Namespace) -> None:
    """Print the transform again and again.

    Raises:
        NotFoundError: no such frame, or the two are in different trees.
        UnansweredError: nobody publishes transforms.
    """
    source, target = (f.lstrip("/") for f in (options.source_frame, options.target_frame))
    with connect() as session:
        log = listen(session, 0.0)

        def connected() -> bool:
            try:
                log.lookup(source, target)
            except NotFoundError:
                return False
            return True

        session.wait_until(connected, timeout_s=SETTLE_S)
        while True:
            lookup = log.lookup(source, target)
            if options.json:
                pose = lookup.pose
                print_json(
                    {
                        "stamp_s": lookup.stamp_s,
                        "translation": pose.translation,
                        "quaternion": pose.quaternion,
                    }
                )
            else:
                print(describe_lookup(lookup))
            if options.once:
                return
            session.spin_for(1.0 / options.rate)
