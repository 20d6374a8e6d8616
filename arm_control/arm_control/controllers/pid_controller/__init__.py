"""pid_controller/PidController."""
