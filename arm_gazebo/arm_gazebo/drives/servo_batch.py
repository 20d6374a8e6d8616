"""The servos of many copies of one robot, evaluated together; bit-identical to `Servo`.

MuJoCo itself moves the activations between two control periods, in C and on all threads. What
remains for each period is the set-points and the planned efforts, here as operations on arrays with
a row for each copy. Joints have the same modes in all copies.
"""

import math
from collections.abc import Sequence

import mujoco
import numpy as np
from numpy.typing import NDArray

from arm_gazebo.drives.braking_law import FLOOR, RENEW_EVERY, RESTING, budgets
from arm_gazebo.drives.drive_constants import drive_constants
from arm_gazebo.drives.driven_joint import LANDING_SPEED, NEAREST, SERVOED, DriveMode
from arm_gazebo.drives.inertia_product import InertiaProduct
from arm_gazebo.drives.servo import USABLE_EFFORT, WAKE_DISTANCE, Servo
from arm_gazebo.drives.setpoint_batch import CommandStreams, approach, held_back
from arm_node.index_slice import as_slice

Array = NDArray[np.float64]
Rows = NDArray[np.bool_]


class ServoBatch:
    """Drives the joints of all copies; used only by the thread that steps them.

    Args:
        model: the model of all copies, with the gains of the joints' modes.
        servo: the servo of one simulation of this model, whose joints and modes it takes.
        copies: number of copies.

    Attributes:
        activations: of the joints' actuators, at the start of a period, shape (copies, joints).
        rates: their rates, which are the actuators' controls, same shape.
    """

    def __init__(self, model: mujoco.MjModel, servo: Servo, copies: int) -> None:
        self._joints = joints = drive_constants(model, servo)
        self._copies = copies
        self._floor = FLOOR * joints.braking
        self._product = InertiaProduct(model, servo.tuning.coupling / joints.period_s)
        self._dofs, self._addresses = as_slice(joints.dofs), as_slice(joints.addresses)
        self._diagonal = as_slice(joints.diagonal)
        self._find_columns(joints.modes)
        shape = (copies, len(joints.modes))
        self._ticks = np.zeros((copies, 1), dtype=np.int64)
        self._way_to_renew = np.zeros(copies)
        self._part = np.zeros(shape)
        self._awake_ticks = np.full(copies, joints.settle_ticks)
        self._still = np.zeros(shape)
        self._position, self._velocity = np.zeros(shape), np.zeros(shape)
        self._start_position, self._start_velocity = np.zeros(shape), np.zeros(shape)
        self._streams = CommandStreams.at(np.zeros(shape))
        self._taken = np.full(shape, np.nan)
        self.activations, self.rates = np.zeros(shape), np.zeros(shape)

    def _find_columns(self, modes: Sequence[DriveMode]) -> None:
        """Note which joints follow a set-point, and how."""

        def columns(*which: DriveMode) -> NDArray[np.bool_]:
            return np.array([mode in which for mode in modes], dtype=bool)

        self._servoed = columns(*SERVOED)
        self._by_position = columns(DriveMode.POSITION)
        self._by_velocity = columns(DriveMode.VELOCITY)
        self._by_effort = columns(DriveMode.EFFORT)
        self._all_servoed = bool(self._servoed.all())

    def restart(self, rows: NDArray[np.intp], qpos: Array, qvel: Array) -> None:
        """Restart copies from states (rows, nq) and (rows, nv), as `Servo.reset` does."""
        position = qpos[:, self._addresses]
        joints = self._joints
        limit = joints.velocity_limit
        velocity = np.minimum(np.maximum(qvel[:, self._dofs], -limit), limit)
        stop = position + 0.5 * velocity * np.abs(velocity) / joints.braking
        self._position[rows], self._velocity[rows] = position, velocity
        self._start_position[rows], self._start_velocity[rows] = position, velocity
        stop = np.minimum(np.maximum(stop, joints.lower), joints.upper)
        self._streams.put(rows, CommandStreams.at(stop))
        self._ticks[rows], self._way_to_renew[rows], self._part[rows] = 0, 0.0, 0.0
        self._awake_ticks[rows] = joints.settle_ticks
        self._taken[rows] = np.nan

    def command(self, values: Array) -> None:
        """Take finite commands within the joints' limits, each in the unit of its joint's mode.

        Args:
            values: shape (copies, joints), contiguous; those of joints without a commanded mode
                are ignored.
        """
        # `Servo` compares the bytes, too.
        new = (values.view(np.int64) != self._taken.view(np.int64)).any(axis=1)
        if not new.any():
            return
        self._renew_where_one_starts(values, new)
        np.copyto(self._taken, values, where=new[:, None])
        self._awake_ticks[new] = self._joints.settle_ticks
        positions = np.where(self._by_position & new[:, None], values, self._streams.command)
        self._streams.take(positions, self._ticks, self._joints.period_s)

    def _renew_where_one_starts(self, values: Array, new: Rows) -> None:
        """See `DrivenJoint.command`."""
        differs = np.zeros(values.shape, dtype=bool)
        np.not_equal(values, self._streams.command, out=differs, where=self._by_position)
        np.not_equal(values, self._asked(), out=differs, where=self._by_velocity)
        starts = (differs & (self._velocity == 0.0)).any(axis=1)
        self._way_to_renew[new & starts] = 0.0

    def _asked(self) -> Array:
        """Return the last commands, 0 for none."""
        return np.where(np.isnan(self._taken), 0.0, self._taken)

    def update(self, qpos: Array, qvel: Array, inertia: Array, bias: Array) -> None:
        """Drive the joints of all copies for one control period; see `Servo.update`.

        Shapes: `qpos` (copies, nq), `qvel` (copies, nv); MuJoCo's sparse `M` (copies, nC) and
        `qfrc_bias` (copies, nv) are those of the last step.
        """
        self._ticks += 1
        rows = self._awake(qpos)
        if rows is not None and not rows.any():
            return
        where = None if rows is None else rows[:, None]
        gravity = self._felt(bias)
        due = self._way_to_renew <= 0.0
        if rows is not None:
            due &= rows
        if due.any():
            self._renew_braking(np.flatnonzero(due), inertia, gravity)
        moving = self._plan(where, qpos, qvel, inertia, gravity)
        efforts = self._planned_efforts(where, inertia, bias, gravity)
        self._write(where, efforts)
        self._count_down(rows, moving, qpos)

    def _count_down(self, rows: Rows | None, moving: Rows, qpos: Array) -> None:
        """Let copies fall asleep that have been at rest for a while."""
        # A joint that falls or is commanded by effort keeps its copy awake.
        stays = moving if self._all_servoed else np.ones(self._copies, dtype=bool)
        ticks = np.where(stays, self._joints.settle_ticks, self._awake_ticks - 1)
        self._awake_ticks = ticks if rows is None else np.where(rows, ticks, self._awake_ticks)
        falls = (ticks == 0) if rows is None else (ticks == 0) & rows
        if falls.any():
            self._still[falls] = qpos[falls][:, self._addresses]

    def _awake(self, qpos: Array) -> Rows | None:
        """Return which copies are awake; None for all. Wake those that something moved."""
        rows = self._awake_ticks > 0
        if rows.all():
            return None
        due = np.flatnonzero(~rows & (self._ticks[:, 0] % self._joints.check_ticks == 0))
        positions = qpos[:, self._addresses]
        for row in due.tolist():
            # As in `Servo`: summing the squares in another way would give other bits.
            distance = math.dist(positions[row].tolist(), self._still[row].tolist())
            if distance > WAKE_DISTANCE:
                self._awake_ticks[row], rows[row] = self._joints.settle_ticks, True
        return rows

    def _renew_braking(self, rows: NDArray[np.intp], inertia: Array, gravity: Array) -> None:
        """See `Servo`."""
        joints = self._joints
        self._way_to_renew[rows] = RENEW_EVERY
        position, velocity = self._position[rows], self._velocity[rows]
        streams, asked = self._streams, self._asked()[rows]
        target, followed = streams.target[rows], streams.velocity[rows]
        rests = (followed != 0.0) | ((velocity == 0.0) & (target == position))
        if self._by_velocity.any():
            by = self._by_velocity
            rests = np.where(by, (velocity == 0.0) & (asked == 0.0), rests)
            target = np.where(by, np.where(asked > 0.0, joints.upper, joints.lower), target)
        needs = 0.5 * velocity * velocity / np.maximum(np.abs(target - position), NEAREST)
        needs = np.where(rests | ~self._servoed, -1.0, needs)
        room = np.where(self._servoed, 1.0 / budgets(joints.effort, gravity[rows]), 0.0)
        room = np.where((needs < 0.0) & (velocity == 0.0), RESTING * room, room)
        parts = joints.law.parts_of_many(inertia[rows], room, self._floor, needs)
        self._part[rows] = np.where(needs >= 0.0, parts, self._part[rows])

    def _plan(
        self, where: Rows | None, qpos: Array, qvel: Array, inertia: Array, gravity: Array
    ) -> Rows:
        """Advance the set-points of the awake copies; return which copies have a moving one."""
        joints = self._joints
        place, motion = qpos[:, self._addresses], qvel[:, self._dofs]
        position, velocity = held_back(self._position, self._velocity, place, motion, joints.slack)
        self._streams.advance(where, joints.period_s)
        target, target_velocity = self._streams.target, self._streams.velocity
        rests = (target == position) & (target_velocity == 0.0) & (velocity == 0.0)
        speed = np.broadcast_to(joints.speed, position.shape)
        if joints.rate_per_s:
            by = self._by_position
            proportional = self._proportional_speed(target, position, velocity)
            speed = np.where(by, proportional, speed)
            target_velocity = np.where(by, 0.0, target_velocity)
        if self._by_velocity.any():
            asked, by = self._asked(), self._by_velocity
            speed = np.where(by, np.abs(asked), speed)
            target = np.where(by, np.where(asked > 0.0, joints.upper, joints.lower), target)
            target_velocity = np.where(by, 0.0, target_velocity)
            rests = rests & ~by
        felt = inertia[:, self._diagonal] + joints.followers_inertia
        acceleration = budgets(joints.effort, gravity) / felt
        braking = np.minimum(self._part * acceleration, joints.jerkless)
        braking = np.maximum(braking, self._floor)
        acceleration = np.maximum(np.minimum(acceleration, joints.jerkless), joints.braking)
        end, end_velocity = approach(
            position,
            velocity,
            target,
            target_velocity,
            speed,
            acceleration,
            braking,
            joints.period_s,
        )
        end = np.where(rests, position, end)
        end_velocity = np.where(rests, velocity, end_velocity)
        moving = ~rests & ((end_velocity != 0.0) | (end != position)) & self._servoed
        farthest = np.maximum.reduce(np.where(moving, np.abs(end - position), 0.0), axis=1)
        self._way_to_renew -= farthest if where is None else np.where(where[:, 0], farthest, 0.0)
        self._commit(where, position, velocity, end, end_velocity)
        return moving.any(axis=1)

    def _proportional_speed(self, target: Array, position: Array, velocity: Array) -> Array:
        """Return the speeds of exponential approaches; see `DrivenJoint`."""
        joints = self._joints
        half_s = 0.5 * joints.period_s
        distance = np.abs(target - position) - half_s * np.abs(velocity)
        speed = joints.rate_per_s * distance / (1.0 + joints.rate_per_s * half_s)
        return np.where(speed > LANDING_SPEED, np.minimum(speed, joints.speed), joints.speed)

    def _commit(
        self, where: Rows | None, start: Array, start_velocity: Array, end: Array, velocity: Array
    ) -> None:
        """Store the planned set-points of the awake copies."""
        if where is None and self._all_servoed:
            self._start_position, self._start_velocity = start, start_velocity
            self._position, self._velocity = end, velocity
            return
        mask = self._servoed if where is None else where & self._servoed
        np.copyto(self._start_position, start, where=mask)
        np.copyto(self._start_velocity, start_velocity, where=mask)
        np.copyto(self._position, end, where=mask)
        np.copyto(self._velocity, velocity, where=mask)

    def _planned_efforts(
        self, where: Rows | None, inertia: Array, bias: Array, gravity: Array
    ) -> Array:
        """Return the efforts of the planned motions; slow those that need too much."""
        efforts = self._efforts(inertia, bias)
        limit = USABLE_EFFORT * self._joints.effort
        over = ((np.abs(efforts) > limit) & self._servoed).any(axis=1, keepdims=True)
        if where is not None:
            over &= where
        if not over.any():
            return efforts
        moving = efforts - gravity
        room = limit - np.copysign(gravity, gravity * moving)
        short = (np.abs(efforts) > limit) & (room > 0.0) & (room < np.abs(moving)) & self._servoed
        shares = np.where(short, room / np.where(short, np.abs(moving), 1.0), 1.0)
        share = shares.min(axis=1, keepdims=True)
        gain = self._velocity - self._start_velocity
        slowed = over & (gain * self._velocity > 0.0) & self._servoed
        velocity = np.where(slowed, self._start_velocity + share * gain, self._velocity)
        mean = 0.5 * (self._start_velocity + velocity)
        end = self._start_position + mean * self._joints.period_s
        self._position = np.where(slowed, end, self._position)
        self._velocity = velocity
        return np.where(over, self._efforts(inertia, bias), efforts)

    def _efforts(self, inertia: Array, bias: Array) -> Array:
        """Return inertia x acceleration + gravity and Coriolis effort, shape (copies, joints)."""
        gains = self._velocity - self._start_velocity
        if not self._all_servoed:
            gains = np.where(self._servoed, gains, 0.0)
        load = self._product(inertia, gains)
        load += bias
        return self._felt(load)

    def _felt(self, efforts: Array) -> Array:
        """Return the efforts of all degrees of freedom as the driven joints feel them."""
        felt = efforts[:, self._dofs].copy()
        for column, follower, ratio in self._joints.followers:
            felt[:, column] += ratio * efforts[:, follower]
        return felt

    def _write(self, where: Rows | None, efforts: Array) -> None:
        """Store the activations at the start of the period, and their rates."""
        joints = self._joints
        speed, start_speed = self._velocity, self._start_velocity
        resisted = efforts + (joints.drag * speed + np.copysign(joints.friction, speed))
        effort = np.where(speed != 0.0, resisted, efforts)
        effort = np.maximum(np.minimum(effort, joints.effort), -joints.effort)
        start, lead_s = self._start_position, joints.lead_s
        activations = start + lead_s * start_speed + effort * joints.compliance
        rates = (self._position - start + lead_s * (speed - start_speed)) * (1.0 / joints.period_s)
        if not self._all_servoed:
            asked = np.where(self._by_effort & ~np.isnan(self._taken), self._taken, 0.0)
            activations = np.where(self._servoed, activations, asked)
            rates = np.where(self._servoed, rates, 0.0)
        if where is None:
            self.activations, self.rates = activations, rates
        else:
            np.copyto(self.activations, activations, where=where)
            np.copyto(self.rates, rates, where=where)
