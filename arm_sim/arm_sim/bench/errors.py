"""The errors of the test bench."""

from arm_sim.errors import ArmSimError


class BenchError(ArmSimError):
    """The bench cannot do what a test requests; the message says why."""
