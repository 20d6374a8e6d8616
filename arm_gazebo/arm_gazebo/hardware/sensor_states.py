"""The sensors of a hardware component: readings as ros2_control's state interfaces."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from arm_control.hardware_info import HardwareInfo
from arm_gazebo.hardware.instrument import Instrument
from arm_gazebo.index_slice import as_slice


class SensorStates:
    """What `<sensor>`s of a `<ros2_control>` block show; loop thread.

    A sensor of the block is the robot's sensor of the same name, as in gz_ros2_control.

    Attributes:
        names: state interfaces that there are, in the block's order.
    """

    def __init__(self, info: HardwareInfo, instruments: Sequence[Instrument]) -> None:
        by_name = {instrument.sensor.name: instrument for instrument in instruments}
        names: list[str] = []
        self._parts: list[tuple[Instrument, slice | NDArray[np.intp], NDArray[np.intp]]] = []
        for part in info.sensors:
            instrument = by_name.get(part.name)
            if instrument is None:
                continue
            channels = instrument.sensor.channels
            shown = [state.name for state in part.state_interfaces if state.name in channels]
            where = as_slice(np.arange(len(names), len(names) + len(shown)))
            which = np.array([channels.index(name) for name in shown], dtype=np.intp)
            names += [f"{part.name}/{name}" for name in shown]
            if shown:
                self._parts.append((instrument, where, which))
        self.names = tuple(names)

    def fill(self, states: NDArray[np.float64]) -> None:
        """Write the present readings.

        Args:
            states: in the order of `names`, shape (n,).
        """
        for instrument, where, which in self._parts:
            states[where] = instrument.read()[which]
