"""The actions, named as in ROS 2's `launch.actions`; `ReadyPanel` is new."""

from launch_py.action import Action
from launch_py.actions.event_actions import (
    EmitEvent,
    RegisterEventHandler,
    Shutdown,
    UnregisterEventHandler,
)
from launch_py.actions.execute_process import ExecuteLocal, ExecuteProcess
from launch_py.actions.grouping import (
    GroupAction,
    OpaqueCoroutine,
    OpaqueFunction,
    TimerAction,
)
from launch_py.actions.messages import LogInfo, ReadyPanel
from launch_py.actions.settings import (
    AppendEnvironmentVariable,
    DeclareLaunchArgument,
    PopEnvironment,
    PopLaunchConfigurations,
    PushEnvironment,
    PushLaunchConfigurations,
    ReplaceEnvironmentVariables,
    ResetEnvironment,
    ResetLaunchConfigurations,
    SetEnvironmentVariable,
    SetLaunchConfiguration,
    UnsetEnvironmentVariable,
    UnsetLaunchConfiguration,
)
from launch_py.launch_description_sources import IncludeLaunchDescription

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
