"""Studies: a task over many variations of a simulation, on all cores, that survive a kill."""

from arm_sim.sweep.study import Run, Study, StudyError, read_study

__all__ = ["Run", "Study", "StudyError", "read_study"]
