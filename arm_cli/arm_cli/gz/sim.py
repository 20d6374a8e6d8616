"""`arm gz sim FILE`: launches a world alone, with the page instead of Gazebo's window."""

import shlex
from collections.abc import Sequence

from arm_cli.launch import run as launch

SERVER = "-s"
HELP = """usage: arm gz sim [-r] [-s] [-v LEVEL] [FILE]

Show a world: empty, shapes, objects, pick_and_place_demo, house, or an SDF file. The options are
Gazebo's. The page opens in the browser unless -s is given. The world runs at once, even without -r.
"""


def run(words: Sequence[str]) -> int:
    """Launch the world; return the exit code."""
    from arm_cli.output import say_document

    if any(word in ("-h", "--help") for word in words):
        say_document(HELP, end="")
        return 0
    given = [word for word in words if ":=" not in word]
    arguments = [word for word in words if ":=" in word]
    if "-r" not in given:
        given.insert(0, "-r")
    page = "false" if SERVER in given else "true"
    file = ("ros_gz_sim", "gz_sim.launch.py")
    return launch([*file, f"gz_args:={shlex.join(given)}", f"viewer:={page}", *arguments])
