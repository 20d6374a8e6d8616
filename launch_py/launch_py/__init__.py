"""A launcher and supervisor: what `ros2 launch` does, and start when ready, restart, full stop.

The names are those of ROS 2's `launch` and `launch_ros` packages, so most launch files port by
changing their imports: `launch` becomes `launch_py`, `launch_ros` becomes `launch_py.ros`. Not here
are XML and YAML launch files, composable and lifecycle nodes, and the event handlers other than
those of a process's start, lines and end, and of the shutdown.
"""

from launch_py.actions import (
    Action,
    AppendEnvironmentVariable,
    DeclareLaunchArgument,
    EmitEvent,
    ExecuteProcess,
    GroupAction,
    IncludeLaunchDescription,
    LogInfo,
    OpaqueFunction,
    ReadyPanel,
    RegisterEventHandler,
    SetEnvironmentVariable,
    SetLaunchConfiguration,
    Shutdown,
    TimerAction,
    UnsetEnvironmentVariable,
)
from launch_py.errors import LaunchError
from launch_py.launch_context import LaunchContext
from launch_py.launch_description import LaunchDescription
from launch_py.readiness import (
    ActionAvailable,
    HttpOk,
    LogLine,
    Notified,
    ProcessExited,
    ServiceAvailable,
    TopicPublished,
)
from launch_py.restart_policy import RestartPolicy

__all__ = [
    "Action",
    "ActionAvailable",
    "AppendEnvironmentVariable",
    "DeclareLaunchArgument",
    "EmitEvent",
    "ExecuteProcess",
    "GroupAction",
    "HttpOk",
    "IncludeLaunchDescription",
    "LaunchContext",
    "LaunchDescription",
    "LaunchError",
    "LogInfo",
    "LogLine",
    "Notified",
    "OpaqueFunction",
    "ProcessExited",
    "ReadyPanel",
    "RegisterEventHandler",
    "RestartPolicy",
    "ServiceAvailable",
    "SetEnvironmentVariable",
    "SetLaunchConfiguration",
    "Shutdown",
    "TimerAction",
    "TopicPublished",
    "UnsetEnvironmentVariable",
]
