"""`arm pkg list`: the packages."""

import argparse
import os

from arm_cli.output import add_json_argument, print_json
from launch_py.packages import Packages


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the verb's arguments."""
    add_json_argument(parser)


def run(options: argparse.Namespace) -> None:
    """Print the names of the packages."""
    names = Packages(os.environ).names()
    if options.json:
        print_json(names)
    else:
        print(*names, sep="\n")
