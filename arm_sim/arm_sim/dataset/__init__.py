"""Demonstrations in LeRobot's dataset format v3.0; the extra `dataset` installs what it needs."""

from arm_sim.errors import MissingPackageError

try:
    from arm_sim.dataset.alignment import Alignment, align
    from arm_sim.dataset.check import check_dataset
    from arm_sim.dataset.streams import CameraStream, Samples, Stream
    from arm_sim.dataset.writer import DatasetWriter
except ModuleNotFoundError as error:
    if error.name not in ("av", "pyarrow"):
        raise
    raise MissingPackageError(error.name, "dataset") from error

__all__ = [
    "Alignment",
    "CameraStream",
    "DatasetWriter",
    "Samples",
    "Stream",
    "align",
    "check_dataset",
]
