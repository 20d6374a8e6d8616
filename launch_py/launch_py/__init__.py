"""A launcher and supervisor: `ros2 launch` plus readiness, restarts and a complete shutdown.

The names are those of ROS 2's `launch` and `launch_ros` packages. Launch files that import from
those run unchanged (see `ros_imports`). In new files `launch` is `launch_py`, and `launch_ros` is
`launch_py.ros`. The manual lists every name and where it differs.
"""

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from launch_py.actions import (
        Action,
        AppendEnvironmentVariable,
        DeclareLaunchArgument,
        EmitEvent,
        ExecuteLocal,
        ExecuteProcess,
        GroupAction,
        IncludeLaunchDescription,
        LogInfo,
        OpaqueCoroutine,
        OpaqueFunction,
        PopEnvironment,
        PopLaunchConfigurations,
        PushEnvironment,
        PushLaunchConfigurations,
        ReadyPanel,
        RegisterEventHandler,
        ReplaceEnvironmentVariables,
        ResetEnvironment,
        ResetLaunchConfigurations,
        SetEnvironmentVariable,
        SetLaunchConfiguration,
        Shutdown,
        TimerAction,
        UnregisterEventHandler,
        UnsetEnvironmentVariable,
        UnsetLaunchConfiguration,
    )
    from launch_py.errors import LaunchError
    from launch_py.launch_context import LaunchContext
    from launch_py.launch_description import LaunchDescription
    from launch_py.plan.readiness import (
        ActionAvailable,
        Finished,
        HttpOk,
        LogLine,
        Notified,
        ProcessExited,
        ServiceAvailable,
        TopicPublished,
    )
    from launch_py.plan.restart_policy import RestartPolicy

__all__ = [
    "Action",
    "ActionAvailable",
    "AppendEnvironmentVariable",
    "DeclareLaunchArgument",
    "EmitEvent",
    "ExecuteLocal",
    "ExecuteProcess",
    "Finished",
    "GroupAction",
    "HttpOk",
    "IncludeLaunchDescription",
    "LaunchContext",
    "LaunchDescription",
    "LaunchError",
    "LogInfo",
    "LogLine",
    "Notified",
    "OpaqueCoroutine",
    "OpaqueFunction",
    "PopEnvironment",
    "PopLaunchConfigurations",
    "ProcessExited",
    "PushEnvironment",
    "PushLaunchConfigurations",
    "ReadyPanel",
    "RegisterEventHandler",
    "ReplaceEnvironmentVariables",
    "ResetEnvironment",
    "ResetLaunchConfigurations",
    "RestartPolicy",
    "ServiceAvailable",
    "SetEnvironmentVariable",
    "SetLaunchConfiguration",
    "Shutdown",
    "TimerAction",
    "TopicPublished",
    "UnregisterEventHandler",
    "UnsetEnvironmentVariable",
    "UnsetLaunchConfiguration",
]

_PUBLIC_MODULES = (
    "actions",
    "errors",
    "launch_context",
    "launch_description",
    "plan.readiness",
    "plan.restart_policy",
)


def __getattr__(name: str) -> Any:
    """Import a public name on its first use, so that importing one module does not load all."""
    if name in __all__:
        for module_name in _PUBLIC_MODULES:
            module = import_module(f"launch_py.{module_name}")
            if hasattr(module, name):
                globals()[name] = getattr(module, name)
                return globals()[name]
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
