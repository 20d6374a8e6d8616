"""Named as in ROS 2's `launch_ros.parameter_descriptions`."""

from launch_py.parameters import ParameterValue

__all__ = ["ParameterValue"]
