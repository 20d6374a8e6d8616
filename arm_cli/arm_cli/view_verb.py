"""`arm view`: the page in the browser, beside whatever runs."""

import argparse
from typing import NoReturn

from arm_cli.run_verb import become, find_command

DEFAULT_PORT = 8080


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the verb's arguments."""
    parser.add_argument(
        "--port",
        type=int,
        default=DEFAULT_PORT,
        help=f"of the page, on 127.0.0.1; default {DEFAULT_PORT}",
    )
    parser.add_argument(
        "--publish-joint-states",
        action="store_true",
        help="by the page's sliders, for a robot that is not there",
    )


def run(options: argparse.Namespace) -> NoReturn:
    """Become the page's process."""
    displays = "true" if options.publish_joint_states else "false"
    parameters = (f"port:={options.port}", f"publish_joint_states:={displays}")
    words = [word for parameter in parameters for word in ("-p", parameter)]
    become([*find_command("arm_viewer", "arm_viewer_node"), "--ros-args", *words])
