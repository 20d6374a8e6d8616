"""Demonstrations of an expert in random scenes, as a dataset for learning.

The extras `gym` and `dataset` install what it needs.
"""

from arm_sim.demonstrations.pick import Demonstration, PickDemonstrator
from arm_sim.demonstrations.recording import (
    DemonstrationError,
    RecordedDemonstrations,
    record_demonstrations,
    worker_processes,
)

__all__ = [
    "Demonstration",
    "DemonstrationError",
    "PickDemonstrator",
    "RecordedDemonstrations",
    "record_demonstrations",
    "worker_processes",
]
