"""What every node process of the arm suite shares: environment, start and orderly end of rclpy.

Import-light on purpose: nothing here imports rclpy before `prepare_environment` has run.
"""

from arm_node.environment import UnusableEnvironmentError, prepare_environment

__all__ = ["UnusableEnvironmentError", "prepare_environment"]
