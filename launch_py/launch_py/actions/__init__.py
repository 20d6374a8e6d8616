"""The actions, named as in ROS 2's `launch.actions`; `ReadyPanel` is new."""

from launch_py.actions.action import Action
from launch_py.actions.declare_launch_argument import DeclareLaunchArgument
from launch_py.actions.environment import (
    AppendEnvironmentVariable,
    SetEnvironmentVariable,
    SetLaunchConfiguration,
    UnsetEnvironmentVariable,
)
from launch_py.actions.execute_process import ExecuteProcess
from launch_py.actions.group_action import GroupAction
from launch_py.actions.include_launch_description import IncludeLaunchDescription
from launch_py.actions.messages import EmitEvent, LogInfo, Shutdown
from launch_py.actions.opaque_function import OpaqueFunction
from launch_py.actions.ready_panel import ReadyPanel
from launch_py.actions.register_event_handler import RegisterEventHandler
from launch_py.actions.timer_action import TimerAction

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
