"""The servos of many copies of one robot on a GPU, with the set-points of `ServoBatch` bit for bit.

So a GPU does a control period from the commands to the last physics step without the host.
"""

import mujoco
import numpy as np
import warp as wp
from numpy.typing import NDArray

from arm_gazebo.batch.gpu.braking_kernels import BrakingStates, CoupledJoints
from arm_gazebo.batch.gpu.drive_states import DriveLaw, DriveStates
from arm_gazebo.batch.gpu.servo_kernels import command, restart, update
from arm_gazebo.batch.gpu.setpoint_kernels import Streams
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
        actuators = np.array([joint.actuator or 0 for joint in servo.joints], dtype=np.intp)
        with wp.ScopedDevice(device):
            self._joints = _joints(constants, product)
            self._joints.control = _integers(model.actuator_ctrladr[actuators])
            self._joints.activation = _integers(model.actuator_actadr[actuators])
            self._drives = _drives(copies, len(servo.joints), model.nv)
            self._start = _numbers(start)
            self._values = wp.zeros((copies, len(servo.joints)), dtype=wp.float64)

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


def _joints(constants: DriveConstants, product: InertiaProduct) -> DriveLaw:
    joints = DriveLaw()
    joints.count = len(constants.modes)
    joints.mode = _integers([MODE_NUMBERS[mode] for mode in constants.modes])
    joints.servoed = _integers([mode in SERVOED for mode in constants.modes])
    joints.address, joints.dof = _integers(constants.addresses), _integers(constants.dofs)
    joints.diagonal = _integers(constants.diagonal)
    for name in (
        "effort",
        "speed",
        "lower",
        "upper",
        "jerkless",
        "slack",
        "friction",
        "drag",
        "compliance",
        "followers_inertia",
    ):
        setattr(joints, name, _numbers(getattr(constants, name)))
    joints.sure = _numbers(constants.braking)
    joints.coupled = _coupled(constants)
    joints.follower_joint = _integers([follower[0] for follower in constants.followers])
    joints.follower_dof = _integers([follower[1] for follower in constants.followers])
    joints.follower_ratio = _numbers([follower[2] for follower in constants.followers])
    terms = product.terms()
    joints.term_row = _integers([term[0] for term in terms])
    joints.term_entry = _integers([term[1] for term in terms])
    joints.term_joint = _integers([term[2] for term in terms])
    joints.term_factor = _numbers([term[3] for term in terms])
    joints.period_s, joints.per_period = constants.period_s, 1.0 / constants.period_s
    joints.rate_per_s, joints.lead_s = constants.rate_per_s, constants.lead_s
    joints.settle_ticks, joints.check_ticks = constants.settle_ticks, constants.check_ticks
    return joints


def _coupled(constants: DriveConstants) -> CoupledJoints:
    law, coupled = constants.law, CoupledJoints()
    layers, count, _ = law.entries.shape
    coupled.count = count
    coupled.entry = _integers(law.entries.reshape(layers, count * count))
    coupled.weight = _numbers(law.weights.reshape(layers, count * count))
    coupled.related = _integers(law.related.ravel())
    coupled.followers_inertia = _numbers(law.followers)
    coupled.jerkless, coupled.sure = _numbers(law.jerkless), _numbers(constants.braking)
    return coupled


def _drives(copies: int, joints: int, dofs: int) -> DriveStates:
    drives, shape = DriveStates(), (copies, joints)
    drives.tick, drives.awake = (wp.zeros(copies, dtype=wp.int32) for _ in range(2))
    for name in (
        "still",
        "position",
        "velocity",
        "taken",
        "start_position",
        "start_velocity",
        "gravity",
        "planned",
    ):
        setattr(drives, name, wp.zeros(shape, dtype=wp.float64))
    drives.load = wp.zeros((copies, dofs), dtype=wp.float64)
    streams = Streams()
    for name in ("target", "velocity", "command"):
        setattr(streams, name, wp.zeros(shape, dtype=wp.float64))
    streams.left = wp.zeros(shape, dtype=wp.int32)
    streams.last_change = wp.zeros(shape, dtype=wp.int32)
    drives.streams = streams
    bounds = BrakingStates()
    for name in ("part", "need", "room", "kept", "more", "share"):
        setattr(bounds, name, wp.zeros(shape, dtype=wp.float64))
    bounds.way_to_renew = wp.zeros(copies, dtype=wp.float64)
    bounds.felt = wp.zeros((copies, joints * joints), dtype=wp.float64)
    drives.bounds = bounds
    return drives


def _integers(values: object) -> wp.array:
    return wp.array(np.asarray(values, dtype=np.int32), dtype=wp.int32)


def _numbers(values: object) -> wp.array:
    return wp.array(np.asarray(values, dtype=np.float64), dtype=wp.float64)
