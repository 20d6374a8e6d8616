"""The basis of every node process of the suite: environment, start and shutdown of rclpy.

Imports are kept light: nothing here imports rclpy before `prepare_environment` has run.
"""

from typing import TYPE_CHECKING

from arm_node.public_names import on_first_use

if TYPE_CHECKING:
    from arm_node.environment import UnusableEnvironmentError as UnusableEnvironmentError
    from arm_node.environment import prepare_environment as prepare_environment

# `arm --help` needs only this package's text functions, and importing the environment would take a
# fifth of its time.
__getattr__, __dir__ = on_first_use(__name__)
