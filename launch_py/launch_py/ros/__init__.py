"""Nodes and packages, named as in ROS 2's `launch_ros`."""

from launch_py.ros.actions import (
    Node,
    PushROSNamespace,
    PushRosNamespace,
    SetParameter,
    SetParametersFromFile,
    SetRemap,
    SetUseSimTime,
)
from launch_py.ros.parameter_descriptions import ParameterFile, ParameterValue
from launch_py.ros.substitutions import FindPackagePrefix, FindPackageShare

__all__ = [
    "FindPackagePrefix",
    "FindPackageShare",
    "Node",
    "ParameterFile",
    "ParameterValue",
    "PushROSNamespace",
    "PushRosNamespace",
    "SetParameter",
    "SetParametersFromFile",
    "SetRemap",
    "SetUseSimTime",
]
