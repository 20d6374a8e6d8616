"""The actions, named as in ROS 2's `launch.actions`; `ReadyPanel` is new."""

from launch_py.action import Action
from launch_py.actions.configuration import (
    AppendEnvironmentVariable,
    DeclareLaunchArgument,
    SetEnvironmentVariable,
    SetLaunchConfiguration,
    UnsetEnvironmentVariable,
)
from launch_py.actions.event_actions import (
    EmitEvent,
    RegisterEventHandler,
    Shutdown,
    UnregisterEventHandler,
)
from launch_py.actions.execute_local import ExecuteLocal
from launch_py.actions.execute_process import ExecuteProcess
from launch_py.actions.grouping import (
    GroupAction,
    OpaqueCoroutine,
    OpaqueFunction,
    TimerAction,
)
from launch_py.actions.include_launch_description import IncludeLaunchDescription
from launch_py.actions.messages import LogInfo, ReadyPanel
from launch_py.actions.scoping import (
    PopEnvironment,
    PopLaunchConfigurations,
    PushEnvironment,
    PushLaunchConfigurations,
    ReplaceEnvironmentVariables,
    ResetEnvironment,
    ResetLaunchConfigurations,
    UnsetLaunchConfiguration,
)

__all__ = [
    "Action",
    "AppendEnvironmentVariable",
    "DeclareLaunchArgument",
    "EmitEvent",
    "ExecuteLocal",
    "ExecuteProcess",
    "GroupAction",
    "IncludeLaunchDescription",
    "LogInfo",
    "OpaqueCoroutine",
    "OpaqueFunction",
    "PopEnvironment",
    "PopLaunchConfigurations",
    "PushEnvironment",
    "PushLaunchConfigurations",
    "ReadyPanel",
    "RegisterEventHandler",
    "ReplaceEnvironmentVariables",
    "ResetEnvironment",
    "ResetLaunchConfigurations",
    "SetEnvironmentVariable",
    "SetLaunchConfiguration",
    "Shutdown",
    "TimerAction",
    "UnregisterEventHandler",
    "UnsetEnvironmentVariable",
    "UnsetLaunchConfiguration",
]
