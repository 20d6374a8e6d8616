"""Descriptions of parameters, named as in ROS 2's `launch_ros.descriptions`."""

from launch_py.ros.parameter_descriptions import ParameterFile
from launch_py.ros.parameters import ParameterValue

__all__ = ["ParameterFile", "ParameterValue"]
