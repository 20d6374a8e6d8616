"""Named as in ROS 2's `launch_ros.descriptions`."""

from launch_py.parameters import ParameterValue
from launch_py.ros.parameter_file import ParameterFile

__all__ = ["ParameterFile", "ParameterValue"]
