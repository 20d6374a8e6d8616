"""Actions about nodes, named as in ROS 2's `launch_ros.actions`."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from os import PathLike
from typing import TYPE_CHECKING, Any

from launch_py.actions.action import Action
from launch_py.actions.execute_process import ExecuteProcess
from launch_py.errors import LaunchFileError
from launch_py.names import join_names
from launch_py.packages import Packages
from launch_py.parameters import evaluate_parameters, parameter_file_text
from launch_py.plan import GeneratedFile
from launch_py.substitution import Substitution, Text, perform_text

if TYPE_CHECKING:
    from launch_py.conditions import Condition
    from launch_py.launch_context import LaunchContext

Parameters = Mapping[Any, Any] | Text


class Node(ExecuteProcess):
    """A process of a package that holds a node, or several.

    Args:
        package: the package; a Python distribution's script whose module lies in it is taken
            first, else a program in <prefix>/lib/<package>.
        executable: the name of the script or program.
        name: the node's name. It renames *every* node of the process: leave it out for a process
            with several nodes and say what to call the process with `process_name_text`.
        namespace: the namespace, inside the one of `PushRosNamespace`.
        parameters: parameter files and dicts of parameters, later ones win.
        remappings: pairs of a name and what it becomes.
        arguments: words for the program itself.
        ros_arguments: words after --ros-args.
        process: what to call the process in output and `depends_on`; default the node's name,
            else the executable's.
        options: all others are those of `ExecuteProcess`.
    """
