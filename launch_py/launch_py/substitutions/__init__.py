"""The substitutions, named as in ROS 2's `launch.substitutions`; `Call` is new."""

from launch_py.errors import SubstitutionError as SubstitutionFailure
from launch_py.substitution import Substitution
from launch_py.substitutions.command import Call, Command, FindExecutable, PythonExpression
from launch_py.substitutions.files import (
    AnonName,
    FileContent,
    LaunchLogDir,
    PathJoinSubstitution,
    PathSubstitution,
    ThisLaunchFile,
    ThisLaunchFileDir,
)
from launch_py.substitutions.text import (
    AllSubstitution,
    AndSubstitution,
    AnySubstitution,
    BooleanSubstitution,
    EnvironmentVariable,
    EqualsSubstitution,
    IfElseSubstitution,
    LaunchConfiguration,
    LocalSubstitution,
    NotEqualsSubstitution,
    NotSubstitution,
    OrSubstitution,
    StringJoinSubstitution,
    TextSubstitution,
)

__all__ = [
    "AllSubstitution",
    "AndSubstitution",
    "AnonName",
    "AnySubstitution",
    "BooleanSubstitution",
    "Call",
    "Command",
    "EnvironmentVariable",
    "EqualsSubstitution",
    "FileContent",
    "FindExecutable",
    "IfElseSubstitution",
    "LaunchConfiguration",
    "LaunchLogDir",
    "LocalSubstitution",
    "NotEqualsSubstitution",
    "NotSubstitution",
    "OrSubstitution",
    "PathJoinSubstitution",
    "PathSubstitution",
    "PythonExpression",
    "StringJoinSubstitution",
    "Substitution",
    "SubstitutionFailure",
    "TextSubstitution",
    "ThisLaunchFile",
    "ThisLaunchFileDir",
]
