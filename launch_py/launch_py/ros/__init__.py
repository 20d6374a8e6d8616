"""Nodes and packages, named as in ROS 2's `launch_ros`."""

from launch_py.ros.actions import (
    Node,
    PushROSNamespace,
    PushRosNamespace,
    RosTimer,
    SetParameter,
    SetParametersFromFile,
    SetRemap,
    SetROSLogDir,
    SetUseSimTime,
)
from launch_py.ros.composable import (
    ComposableLifecycleNode,
    ComposableNode,
    ComposableNodeContainer,
    LoadComposableNodes,
)
from launch_py.ros.lifecycle import (
    ChangeState,
    LifecycleNode,
    LifecycleTransition,
    OnStateTransition,
)
from launch_py.ros.parameter_descriptions import Parameter, ParameterFile, ParameterValue
from launch_py.ros.substitutions import ExecutableInPackage, FindPackagePrefix, FindPackageShare

__all__ = [
    "ChangeState",
    "ComposableLifecycleNode",
    "ComposableNode",
    "ComposableNodeContainer",
    "ExecutableInPackage",
    "FindPackagePrefix",
    "FindPackageShare",
    "LifecycleNode",
    "LifecycleTransition",
    "LoadComposableNodes",
    "Node",
    "OnStateTransition",
    "Parameter",
    "ParameterFile",
    "ParameterValue",
    "PushROSNamespace",
    "PushRosNamespace",
    "RosTimer",
    "SetParameter",
    "SetParametersFromFile",
    "SetROSLogDir",
    "SetRemap",
    "SetUseSimTime",
]
