"""The names that launch files import."""

import importlib

import pytest

MODULES = ("launch_py", "launch_py.actions", "launch_py.substitutions", "launch_py.ros")

ROS_NAMES = {
    "launch_py": "LaunchDescription LaunchContext",
    "launch_py.actions": (
        "AppendEnvironmentVariable DeclareLaunchArgument EmitEvent ExecuteProcess GroupAction "
        "IncludeLaunchDescription LogInfo OpaqueFunction RegisterEventHandler "
        "SetEnvironmentVariable SetLaunchConfiguration Shutdown TimerAction "
        "UnsetEnvironmentVariable"
    ),
    "launch_py.conditions": (
        "IfCondition LaunchConfigurationEquals LaunchConfigurationNotEquals UnlessCondition"
    ),
    "launch_py.event_handlers": "OnProcessExit OnProcessIO OnProcessStart OnShutdown",
    "launch_py.events": "Shutdown",
    "launch_py.launch_description_sources": (
        "AnyLaunchDescriptionSource PythonLaunchDescriptionSource"
    ),
    "launch_py.substitutions": (
        "AllSubstitution AndSubstitution AnySubstitution Command EnvironmentVariable "
        "EqualsSubstitution FindExecutable IfElseSubstitution LaunchConfiguration "
        "LocalSubstitution NotEqualsSubstitution NotSubstitution OrSubstitution "
        "PathJoinSubstitution PythonExpression TextSubstitution ThisLaunchFile ThisLaunchFileDir"
    ),
    "launch_py.ros.actions": (
        "Node PushROSNamespace PushRosNamespace SetParameter SetParametersFromFile SetRemap "
        "SetUseSimTime"
    ),
    "launch_py.ros.descriptions": "ParameterFile ParameterValue",
    "launch_py.ros.substitutions": "FindPackagePrefix FindPackageShare",
    "launch_py.ros.parameter_descriptions": "ParameterFile ParameterValue",
}


@pytest.mark.parametrize("name", MODULES)
def test_all_names_exist_and_are_sorted(name):
    module = importlib.import_module(name)
    assert module.__all__ == sorted(module.__all__)
    assert all(hasattr(module, exported) for exported in module.__all__)


@pytest.mark.parametrize("name", ROS_NAMES)
def test_a_launch_file_of_ros_finds_its_names(name):
    module = importlib.import_module(name)
    assert [n for n in ROS_NAMES[name].split() if not hasattr(module, n)] == []
