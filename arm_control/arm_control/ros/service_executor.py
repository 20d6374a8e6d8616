"""The executor of the controller manager's services."""

from rclpy.executors import MultiThreadedExecutor


class ServiceExecutor(MultiThreadedExecutor):
    """Several threads, which end with it; rclpy's own stay until the process exits."""

    def shutdown(self, timeout_sec: float | None = None) -> bool:
        """End; return whether all callbacks have returned, for which it waits this long."""
        is_idle = super().shutdown(timeout_sec)
        self._executor.shutdown(wait=is_idle)
        return is_idle
