"""`arm tf echo`: prints the transform between two frames, as tf2_echo does."""

import argparse
import math
from collections.abc import Iterable

from arm_cli.arguments import JSON, Argument, Flag, positive_number, verb
from arm_cli.errors import NoSuchNameError
from arm_cli.output import print_json, say_document
from arm_cli.ros.connection import connect
from arm_cli.tf.frame_log import Lookup

SETTLE_S = 2.0


@verb(
    Argument("source_frame", help="such as base_link"),
    Argument("target_frame", help="frame whose pose in the source frame to print"),
    Argument(
        "rate",
        nargs="?",
        type=positive_number,
        default=1.0,
        help="how often to print, in Hz (default 1)",
    ),
    Flag("--once", help="print once and end"),
    JSON,
)
def run(options: argparse.Namespace) -> None:
    """Print the transform repeatedly.

    Raises:
        NoSuchNameError: there is no such frame, or the two are in different trees.
        UnansweredError: nobody publishes transforms.
    """
    source, target = (f.lstrip("/") for f in (options.source_frame, options.target_frame))
    with connect() as session:
        from arm_cli.tf.ros_listener import listen

        log = listen(session, 0.0)

        def connected() -> bool:
            try:
                log.lookup(source, target)
            except NoSuchNameError:
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
                        "translation": pose.position,
                        "quaternion": pose.rotation,
                    }
                )
            else:
                say_document(describe_lookup(lookup))
            if options.once:
                return
            session.spin_for(1.0 / options.rate)


def describe_lookup(lookup: Lookup) -> str:
    """Return the lines that tf2_echo prints for a transform."""
    pose = lookup.pose
    rpy = pose.rpy()
    seconds, nanoseconds = divmod(round(lookup.stamp_s * 1e9), 1_000_000_000)
    return "\n".join(
        [
            f"At time {seconds}.{nanoseconds:09d}",
            f"- Translation: {_numbers(pose.position)}",
            f"- Rotation: in Quaternion (xyzw) {_numbers(pose.rotation)}",
            f"- Rotation: in RPY (radian) {_numbers(rpy)}",
            f"- Rotation: in RPY (degree) {_numbers(math.degrees(angle) for angle in rpy)}",
            "- Matrix:",
            *("".join(f" {_rounded(value):6.3f}" for value in row) for row in pose.matrix()),
        ]
    )


def _numbers(values: Iterable[float]) -> str:
    return f"[{', '.join(f'{_rounded(value):.3f}' for value in values)}]"


def _rounded(value: float) -> float:
    # Adding 0 turns -0 into 0.
    return round(value, 3) + 0.0
