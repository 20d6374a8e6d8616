"""Limits on the memory of compiled models, which parameters of the simulation raise."""

from arm_node.frozen import frozen


@frozen
class MemoryLimit:
    """A limit on the memory of a compiled model.

    Attributes:
        mb: the limit in 10^6 bytes.
        parameter: the simulation parameter that raises the limit.
    """

    mb: float
    parameter: str


WORLD_LIMIT = MemoryLimit(1000.0, "world_memory_limit")
SPAWN_LIMIT = MemoryLimit(100.0, "spawn_memory_limit")
"""Smaller, because MuJoCo holds the interpreter lock while it copies an attached model. The copy
takes about 1 ms per megabyte, and the control loop stops for that time."""
