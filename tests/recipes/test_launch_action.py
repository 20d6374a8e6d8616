"""The recipe for a launch action: `LogTime`, which says how late it is."""

import re

from checkout import Checkout

ACTION = '''\
"""An action that says how late it is."""

import time

from launch_py.action import Action
from launch_py.conditions import Condition
from launch_py.launch_context import LaunchContext
from launch_py.plan.steps import MessageStep
from launch_py.substitution import Text, perform_text


class LogTime(Action):
    """Prints the time of day when the launch begins.

    Args:
        label: what stands before it.
        condition: whether it is printed.
    """

    def __init__(self, *, label: Text, condition: Condition | None = None) -> None:
        super().__init__(condition=condition)
        self.label = label

    def expand(self, context: LaunchContext) -> None:
        """Add the message to the plan."""
        text = f"{perform_text(context, self.label)}: {time.strftime('%H:%M')}"
        context.plan.add(MessageStep(after=context.after, delay_s=context.delay_s, text=text))
'''

LAUNCH_FILE = """\
import sys

from launch_py import DeclareLaunchArgument, ExecuteProcess, LaunchDescription, LogTime, Shutdown
from launch_py.substitutions import LaunchConfiguration


def generate_launch_description():
    return LaunchDescription(
        [
            DeclareLaunchArgument("label", default_value="it is"),
            LogTime(label=LaunchConfiguration("label")),
            ExecuteProcess(cmd=[sys.executable, "-c", ""], name="brief", on_exit=Shutdown()),
        ]
    )
"""


def test_an_action_is_added_through_the_files_of_its_recipe(tmp_path):
    checkout = Checkout(tmp_path, "A launch action", NAME="log_time")
    checkout.write("launch_py/launch_py/actions/log_time.py", ACTION)
    checkout.insert(
        "launch_py/launch_py/actions/__init__.py",
        (
            "from launch_py.actions.messages import",
            "from launch_py.actions.log_time import LogTime\n"
            "from launch_py.actions.messages import",
        ),
        ('    "LogInfo",\n', '    "LogInfo",\n    "LogTime",\n'),
    )
    checkout.insert(
        "launch_py/launch_py/__init__.py",
        ("        LogInfo,\n", "        LogInfo,\n        LogTime,\n"),
        ('    "LogInfo",\n', '    "LogInfo",\n    "LogTime",\n'),
    )
    file = tmp_path / "late.launch.py"
    file.write_text(LAUNCH_FILE)

    printed = checkout.run_module("arm_cli", "launch", str(file), "label:=now it is")
    assert re.search(r"now it is: \d\d:\d\d\n", printed), printed
