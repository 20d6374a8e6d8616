"""The basis of every node process of the suite: environment, start and shutdown of rclpy.

Imports are kept light: nothing here imports rclpy before `prepare_environment` has run.
"""

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from arm_node.environment import UnusableEnvironmentError, prepare_environment

__all__ = ["UnusableEnvironmentError", "prepare_environment"]


def __getattr__(name: str) -> Any:
    # Imported on first use: `arm --help` needs only this package's text functions, and importing
    # the environment would take a fifth of its time.
    if name not in __all__:
        raise AttributeError(f"module '{__name__}' has no attribute '{name}'")
    from arm_node import environment

    return getattr(environment, name)
