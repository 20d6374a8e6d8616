"""A recording of a run in which one recorded number is another."""

from dataclasses import replace
from pathlib import Path

import numpy as np

from arm_gazebo.recording.recorded_run import run_of
from arm_gazebo.recording.run_file import RunFile, RunFileWriter, StateBlock
from arm_gazebo.recording.run_state import state_names


def write_altered_run(source: Path, path: Path, period: int, name: str, by: float) -> float:
    """Write a copy of a recording; return the altered number.

    Args:
        source: the recording.
        path: the copy, which must not exist.
        period: the control period whose state is altered, with its hash.
        name: of the number, as `state_names` has it.
        by: how much is added.
    """
    file = RunFile(source)
    run = run_of(file)
    column = state_names(run.model.load().model, run.build().managers).index(name)
    header = {key: value for key, value in file.header.items() if key != "format"}
    writer = RunFileWriter(path, header)
    altered = np.nan
    for record in file.records():
        if isinstance(record, StateBlock):
            row = period - record.first
            if 0 <= row < len(record.hashes):
                hashes, states = record.hashes.copy(), record.states.copy()
                hashes[row] += 1
                states[row // record.interval, column] += by
                altered = float(states[row // record.interval, column])
                record = replace(record, hashes=hashes, states=states)
        writer.write(record)
    writer.close()
    return altered
