"""The actions, named as in ROS 2's `launch.actions`; `ReadyPanel` is new."""

from launch_py.action import Action
from launch_py.actions.configuration import (
    AppendEnvironmentVariable,
    DeclareLaunchArgument,
    SetEnvironmentVariable,
    SetLaunchConfiguration,
    UnsetEnvironmentVariable,
)
from launch_py.actions.event_actions import EmitEvent, RegisterEventHandler, Shutdown
from launch_py.actions.execute_process import ExecuteProcess
from launch_py.actions.grouping import GroupAction, OpaqueFunction, TimerAction
from launch_py.actions.include_launch_description import IncludeLaunchDescription
from launch_py.actions.messages import LogInfo, ReadyPanel

__all__ = [
    "Action",
    "AppendEnvironmentVariable",
    "DeclareLaunchArgument",
    "EmitEvent",
    "ExecuteProcess",
    "GroupAction",
    "IncludeLaunchDescription",
    "LogInfo",
    "OpaqueFunction",
    "ReadyPanel",
    "RegisterEventHandler",
    "SetEnvironmentVariable",
    "SetLaunchConfiguration",
    "Shutdown",
    "TimerAction",
    "UnsetEnvironmentVariable",
]
