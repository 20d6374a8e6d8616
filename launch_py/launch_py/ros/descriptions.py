"""Descriptions of nodes and parameters, named as in ROS 2's `launch_ros.descriptions`."""

from launch_py.ros.composable import ComposableLifecycleNode, ComposableNode
from launch_py.ros.parameter_descriptions import Parameter, ParameterFile
from launch_py.ros.parameters import ParameterValue

__all__ = [
    "ComposableLifecycleNode",
    "ComposableNode",
    "Parameter",
    "ParameterFile",
    "ParameterValue",
]
