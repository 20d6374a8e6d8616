"""The servos of many copies of one robot on a GPU, with the set-points of `ServoBatch` bit for bit.

So a GPU does a control period from the commands to the last physics step without the host.
"""

from collections.abc import Sequence
from typing import Any

import mujoco
import numpy as np
import warp as wp
from numpy.typing import NDArray

from arm_gazebo.batch.gpu.drive_states import DriveLaw, DriveStates
from arm_gazebo.batch.gpu.servo_kernels import command, restart, update
from arm_gazebo.drives.drive_constants import DriveConstants, drive_constants
from arm_gazebo.drives.driven_joint import SERVOED
from arm_gazebo.drives.inertia_product import InertiaProduct
from arm_gazebo.drives.servo import MODE_NUMBERS, Servo

Array = NDArray[np.float64]

THREADS = 32
"""Threads of a block: few, so that a few thousand copies occupy the whole GPU."""


class ServoWarp:
    """Drives the joints of all copies; used only by the thread that steps them.

    Its methods return before the device is done.

    Args:
        model: the model of all copies, with the gains of the joints' modes.
        servo: the servo of one simulation of this model, whose joints and modes it takes.
        copies: number of copies; they start with `restart`.
        start: the positions from which they start, at rest, shape (nq,).
        device: Warp's name of the device.
    """

    def __init__(
        self, model: mujoco.MjModel, servo: Servo, copies: int, start: Array, device: str
    ) -> None:
        self._copies, self._device = copies, device
        constants = drive_constants(model, servo)
        product = InertiaProduct(model, servo.tuning.coupling / constants.period_s)
        count = len(servo.joints)
        with wp.ScopedDevice(device):
            self._joints = _joints(model, servo, constants, product)
            self._drives = _zeros(DriveStates, copies, count)
            self._drives.load = wp.zeros((copies, model.nv), dtype=wp.float64)
            self._drives.bounds.felt = wp.zeros((copies, count * count), dtype=wp.float64)
            self._start = wp.array(start, dtype=wp.float64)
            self._values = wp.zeros((copies, count), dtype=wp.float64)

    def restart(self, rows: wp.array) -> None:
        """Restart copies from their start; their indices are 32-bit integers on the device."""
        inputs = [self._joints, self._drives, self._start, rows]
        wp.launch(restart, len(rows), inputs=inputs, device=self._device)

    def command(self, values: Array) -> None:
        """Take finite commands in limits, contiguous (copies, joints); see `ServoBatch.command`."""
        self._values.assign(values)
        inputs = [self._joints, self._drives, self._values]
        wp.launch(command, self._copies, inputs=inputs, device=self._device, block_dim=THREADS)

    def update(
        self,
        qpos: wp.array,
        qvel: wp.array,
        inertia: wp.array,
        bias: wp.array,
        act: wp.array,
        ctrl: wp.array,
    ) -> None:
        """Drive the joints of all copies for one control period.

        Args:
            qpos: present positions on the device, 32 bits, shape (copies, nq).
            qvel: present velocities, shape (copies, nv).
            inertia: MuJoCo's sparse inertia matrices of the last step, shape (copies, nC).
            bias: its `qfrc_bias` of the last step, shape (copies, nv).
            act: receives the activations of the drives' actuators, shape (copies, na).
            ctrl: receives their rates, shape (copies, nu).
        """
        inputs = [self._joints, self._drives, qpos, qvel, inertia, bias, act, ctrl]
        wp.launch(update, self._copies, inputs=inputs, device=self._device, block_dim=THREADS)


def _joints(
    model: mujoco.MjModel, servo: Servo, constants: DriveConstants, product: InertiaProduct
) -> DriveLaw:
    law, actuators = constants.law, [joint.actuator or 0 for joint in servo.joints]
    values = {
        "count": len(constants.modes),
        "mode": [MODE_NUMBERS[mode] for mode in constants.modes],
        "servoed": [mode in SERVOED for mode in constants.modes],
        "address": constants.addresses,
        "dof": constants.dofs,
        "control": model.actuator_ctrladr[actuators],
        "activation": model.actuator_actadr[actuators],
        "sure": constants.braking,
        "entry": law.entries.reshape(len(law.entries), -1),
        "weight": law.weights.reshape(len(law.weights), -1),
        "related": law.related.ravel(),
        "per_period": 1.0 / constants.period_s,
        **_columns(("follower_joint", "follower_dof", "follower_ratio"), constants.followers),
        **_columns(("term_row", "term_entry", "term_joint", "term_factor"), product.terms()),
    }
    joints = DriveLaw()
    for name, member in DriveLaw.vars.items():
        value = values[name] if name in values else getattr(constants, name)
        is_array = hasattr(member.type, "dtype")
        setattr(joints, name, wp.array(value, dtype=member.type.dtype) if is_array else value)
    return joints


def _columns(names: Sequence[str], rows: Sequence[Sequence[float]]) -> dict[str, Array]:
    return dict(zip(names, np.reshape(rows, (-1, len(names))).T, strict=True))


def _zeros(struct: Any, copies: int, joints: int) -> Any:
    """Return a structure with arrays of zeros, of shape (copies,) or (copies, joints)."""
    made = struct()
    for name, member in struct.vars.items():
        kind = member.type
        if hasattr(kind, "dtype"):
            setattr(made, name, wp.zeros((copies, joints)[: kind.ndim], dtype=kind.dtype))
        else:
            setattr(made, name, _zeros(kind, copies, joints))
    return made
