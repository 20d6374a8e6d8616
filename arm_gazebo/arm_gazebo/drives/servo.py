"""The drives of a robot's joints, which turn commands into efforts without hand-tuned gains.

Each drive is a MuJoCo actuator whose force is

    stiffness (act - q - T q') with T = damping / stiffness, within the effort limit,

where the activation `act` = r + T r' + f / stiffness contains the set-point r, its velocity and
the feed-forward effort f that the motion needs according to the model: inertia times acceleration,
gravity, Coriolis forces and friction. The control of the actuator is the rate of `act`, so that
MuJoCo itself moves the set-point between two control ticks.
"""

import math
import struct
from collections.abc import Sequence
from typing import Any

import mujoco
import numpy as np
from numpy.typing import NDArray

from arm_gazebo.drives.braking_law import FLOOR, RENEW_EVERY, RESTING, BrakingLaw, budget
from arm_gazebo.drives.driven_joint import SERVOED, DriveMode, DrivenJoint
from arm_gazebo.drives.servo_tuning import (
    EFFORT_SHARE,
    TIME_CONSTANT_S,
    ServoTuning,
    resistance,
    set_armature,
)
from arm_gazebo.mjcf.dry_friction import sticking, yielding
from arm_gazebo.physics_timing import PhysicsTiming
from arm_gazebo.robot.actuation import RobotJoint, drive_slices
from arm_node.index_slice import as_slice

Array = NDArray[np.float64]

USABLE_EFFORT = 0.9
"""Fraction of the effort limit that planned motion may use; the rest is for disturbances."""
SETTLE_S = 0.1
CHECK_EVERY_S = 0.01
WAKE_DISTANCE = 5e-4
"""Distance in rad or m, over all joints together, that wakes the servo from rest."""

MODE_NUMBERS = {mode: number for number, mode in enumerate(DriveMode)}


class Servo:
    """Drives joints; used only by the thread that steps the simulation.

    A robot at rest costs nothing: the drives sleep until a command arrives or a joint is moved.

    Args:
        model: the model, tuned by `servo_tuning.tune`; its gains are set here.
        data: a state with valid positions.
        joints: the driven joints; their actuators and activations are contiguous.
        tuning: gains and bounds.
        timing: control period and physics step.
        proportional_gain: see `DrivenJoint`.

    Attributes:
        timing: control period and physics step.
        proportional_gain: see `DrivenJoint`.
        law: the bounds on braking, by the pose.
        tuning: gains and bounds of the joints.
    """

    law: BrakingLaw

    def __init__(
        self,
        model: mujoco.MjModel,
        data: mujoco.MjData,
        joints: Sequence[RobotJoint],
        tuning: ServoTuning,
        timing: PhysicsTiming,
        proportional_gain: float = 0.0,
    ) -> None:
        self.timing = timing
        self.proportional_gain = proportional_gain
        self._period_s = timing.period_s
        # The force uses the position at the start of a step and the set-point at its end. At
        # constant speed they are one step apart.
        self._lead_s = TIME_CONSTANT_S - timing.step_s
        self._joints = tuple(
            DrivenJoint(joint, tuning.bounds(index), timing.period_s, proportional_gain)
            for index, joint in enumerate(joints)
        )
        self._servoed: tuple[tuple[int, DrivenJoint], ...] = ()
        self._gains = [0.0] * len(joints)
        self._compliance: list[float] = (1.0 / tuning.stiffness).tolist()
        self._followers: list[float] = tuning.followers.tolist()
        self._accelerations = np.zeros(len(joints))
        self._bind(model, data, joints, tuning)
        self._still: list[float] = []
        self._settle_ticks = math.ceil(SETTLE_S / timing.period_s)
        self._check_ticks = max(1, round(CHECK_EVERY_S / timing.period_s))
        self._way_to_renew = 0.0
        self._tick = 0
        self._awake_ticks = self._settle_ticks

    def rebind(
        self,
        model: mujoco.MjModel,
        data: mujoco.MjData,
        joints: Sequence[RobotJoint],
        tuning: ServoTuning,
    ) -> None:
        """Continue in another model; the drives keep their modes and their planned motion.

        Args:
            model: has the same driven joints, in the same order, with the same gains.
            data: state of that model, with the joints' present state copied to it.
            joints: the driven joints in that model.
            tuning: see `servo_tuning.retune`.
        """
        self._bind(model, data, joints, tuning)
        for driven, joint in zip(self._joints, joints, strict=True):
            driven.joint = joint
        self._rebound(tuning)
        self.set_friction_solvers()
        # The activations that hold a resting joint must be written to the new state.
        self._awake_ticks = self._settle_ticks

    def retune(self, tuning: ServoTuning) -> None:
        """Continue with other bounds of the same gains, because the gravity has changed."""
        self.tuning = tuning
        self._rebound(tuning)
        # The efforts that hold a resting joint are others now.
        self._wake()

    def _rebound(self, tuning: ServoTuning) -> None:
        for index, driven in enumerate(self._joints):
            driven.rebound(tuning.bounds(index), self._share(index, driven.effort_limit))

    def _wake(self) -> None:
        """Plan anew in the next period."""
        self._awake_ticks, self._way_to_renew = self._settle_ticks, 0.0

    def _bind(
        self,
        model: mujoco.MjModel,
        data: mujoco.MjData,
        joints: Sequence[RobotJoint],
        tuning: ServoTuning,
    ) -> None:
        """Store views of MuJoCo's arrays: looking up an attribute costs as much as a sum."""
        self._model, self._data, self.tuning = model, data, tuning
        self._spread = tuning.coupling / self._period_s
        self._ratios = tuning.follower_ratios()
        self._friction, self._drag = resistance(model, tuning.coupling)
        self._motion = np.zeros(model.nv)
        self._load = np.zeros(model.nv)
        activations, controls = drive_slices(model, joints)
        # Numbers are packed into the arrays: assigning a list takes three times as long.
        self._pack = struct.Struct(f"{len(joints)}d").pack_into
        self._act, self._ctrl = data.act[activations].data, data.ctrl[controls].data
        dofs = np.array([joint.dof_address for joint in joints], dtype=np.intp)
        addresses = np.array([joint.qpos_address for joint in joints], dtype=np.intp)
        self.law = BrakingLaw(model, tuning, dofs)
        self._dofs, self._addresses = as_slice(dofs), as_slice(addresses)
        self._diagonal = as_slice(model.M_rowadr[dofs] + model.M_rownnz[dofs] - 1)
        self._qpos, self._qvel = data.qpos, data.qvel
        self._inertia = data.M
        self._lifted = data.qfrc_gravcomp if model.ngravcomp else None
        self._bias = data.qfrc_bias if self._lifted is None else np.zeros(model.nv)

    @property
    def joints(self) -> tuple[RobotJoint, ...]:
        """The driven joints, in the order of the indices that the methods take."""
        return tuple(driven.joint for driven in self._joints)

    def mode(self, index: int) -> DriveMode:
        """Return how a joint is driven."""
        return self._joints[index].mode

    def set_mode(self, index: int, mode: DriveMode) -> None:
        """Change how a joint is driven, without a jump."""
        driven = self._joints[index]
        position = float(self._qpos[driven.joint.qpos_address])
        driven.enter(mode, position, float(self._qvel[driven.joint.dof_address]))
        self._set_gains(index, mode)
        self._find_servoed()
        self._wake()

    def command(self, index: int, value: float) -> None:
        """Take a finite command, within the joint's limits, in the unit of the joint's mode."""
        if self._joints[index].command(value, self._tick):
            self._way_to_renew = 0.0
        self._awake_ticks = self._settle_ticks

    def limit_effort(self, index: int, limit: float) -> None:
        """Limit the effort of a joint's drive, N m or N; a value of 0 or less lifts the limit."""
        driven = self._joints[index]
        own = driven.joint.effort
        limit = limit if 0.0 < limit < own else own
        driven.limit_effort(limit, self._share(index, limit))
        self._set_gains(index, driven.mode)
        self._wake()

    def _share(self, index: int, limit: float) -> float:
        """Return the fraction of the normal braking deceleration that an effort limit allows."""
        return min(1.0, EFFORT_SHARE * limit / self.tuning.braking_efforts[index])

    def stopping_point(self, index: int) -> float:
        """Return where a joint will stop without a new command, in rad or m."""
        return self._joints[index].stopping_point()

    def reset(self) -> None:
        """Restart from the joints' state after it was changed from outside; modes are kept."""
        for index, driven in enumerate(self._joints):
            mode = driven.mode
            driven.mode = DriveMode.FREE
            driven.part, driven.braking = 0.0, driven.sure_braking
            self.set_mode(index, mode)
        self._tick = 0

    def save_state(self) -> dict[str, Any]:
        """Return what the next periods depend on, apart from MuJoCo's model and state."""
        return {
            "joints": [driven.save_state() for driven in self._joints],
            "gains": self._gains,
            "still": self._still,
            "tick": self._tick,
            "awake_ticks": self._awake_ticks,
            "way_to_renew": self._way_to_renew,
        }

    def load_state(self, state: dict[str, Any]) -> None:
        """Continue from a saved state, after MuJoCo's model and state were restored."""
        for driven, saved in zip(self._joints, state["joints"], strict=True):
            driven.load_state(saved)
        self._find_servoed()
        self.set_friction_solvers()
        self._gains, self._still = list(state["gains"]), list(state["still"])
        self._tick, self._awake_ticks = state["tick"], state["awake_ticks"]
        # States of older versions have no bounds that are renewed.
        self._way_to_renew = state.get("way_to_renew", 0.0)

    def fingerprint(self) -> bytes:
        """Return bytes that differ if the state does."""
        numbers: list[float] = [self._tick, self._awake_ticks, self._way_to_renew]
        for driven in self._joints:
            mode, *rest = driven.save_state()
            numbers.append(MODE_NUMBERS[mode])
            numbers += rest
        return struct.pack(f"<{len(numbers)}d", *numbers)

    def update(self) -> None:
        """Drive the joints for one control period; called before each, even without commands."""
        self._tick += 1
        if not self._awake_ticks:
            if self._tick % self._check_ticks or not self._has_moved():
                return
            self._awake_ticks = self._settle_ticks
        if self._lifted is not None:
            np.subtract(self._data.qfrc_bias, self._lifted, self._bias)
        gravity = self._felt(self._bias)
        if self._way_to_renew <= 0.0:
            self._renew_braking(gravity)
        if self._plan(gravity) or len(self._servoed) < len(self._joints):
            self._awake_ticks = self._settle_ticks
        else:
            self._awake_ticks -= 1
        self._write(self._planned_efforts(gravity))
        if not self._awake_ticks:
            self._still = self._qpos[self._addresses].tolist()

    def _find_servoed(self) -> None:
        self._servoed = tuple(
            (each, joint) for each, joint in enumerate(self._joints) if joint.mode in SERVOED
        )

    def _has_moved(self) -> bool:
        return math.dist(self._qpos[self._addresses].tolist(), self._still) > WAKE_DISTANCE

    def _renew_braking(self, gravity: list[float]) -> None:
        """Bound the braking of the joints that move by the present pose."""
        self._way_to_renew = RENEW_EVERY
        count = len(self._joints)
        needs, floors, room = [-1.0] * count, [0.0] * count, [0.0] * count
        stops = False
        for index, driven in self._servoed:
            needs[index] = need = driven.needed_braking()
            stops = stops or need >= 0.0
            floors[index] = FLOOR * driven.sure_braking
            room[index] = 1.0 / budget(driven.effort_limit, gravity[index])
            if need < 0.0 and not driven.setpoint.velocity:
                room[index] *= RESTING
        if stops:
            parts = self.law.parts(self._inertia, room, floors, needs)
            for index, driven in self._servoed:
                if needs[index] >= 0.0:
                    driven.part = parts[index]

    def _plan(self, gravity: list[float]) -> bool:
        """Advance every set-point; return whether any of them moves."""
        positions = self._qpos[self._addresses].tolist()
        velocities = self._qvel[self._dofs].tolist()
        inertias = self._inertia[self._diagonal].tolist()
        moving, farthest = False, 0.0
        for index, driven in self._servoed:
            inertia = inertias[index] + self._followers[index]
            if driven.plan(positions[index], velocities[index], inertia, gravity[index]):
                moving = True
                way = abs(driven.setpoint.position - driven.start_position)
                if way > farthest:
                    farthest = way
        self._way_to_renew -= farthest
        return moving

    def _planned_efforts(self, gravity: list[float]) -> list[float]:
        """Return the efforts of the planned motion; slow the motion if it needs too much."""
        efforts = self._efforts()
        for index, driven in self._servoed:
            if abs(efforts[index]) > USABLE_EFFORT * driven.effort_limit:
                self._slow_down(efforts, gravity)
                return self._efforts()
        return efforts

    def _efforts(self) -> list[float]:
        """Return inertia x acceleration + gravity and Coriolis effort of the driven joints."""
        gains = self._gains
        for index, driven in self._servoed:
            gains[index] = driven.setpoint.velocity - driven.start_velocity
        self._pack(self._accelerations.data, 0, *gains)
        # `_spread` is divided by the period already, which turns a speed gain into acceleration.
        self._spread.dot(self._accelerations, self._motion)
        mujoco.mj_mulM(self._model, self._data, self._load, self._motion)
        np.add(self._load, self._bias, self._load)
        return self._felt(self._load)

    def _felt(self, efforts: Array) -> list[float]:
        """Return the efforts of all degrees of freedom as the driven joints feel them."""
        # In a fixed order, unlike a product of matrices: `ServoBatch` adds in the same order.
        felt = efforts[self._dofs].tolist()
        for index, follower, ratio in self._ratios:
            felt[index] += ratio * efforts.item(follower)
        return felt

    def _slow_down(self, efforts: list[float], gravity: list[float]) -> None:
        """Scale the acceleration of all joints by one factor, so that the efforts suffice."""
        share = 1.0
        for index, driven in self._servoed:
            limit = USABLE_EFFORT * driven.effort_limit
            moving = efforts[index] - gravity[index]
            room = limit - math.copysign(gravity[index], gravity[index] * moving)
            if abs(efforts[index]) > limit and 0.0 < room < abs(moving):
                share = min(share, room / abs(moving))
        for _, driven in self._servoed:
            driven.scale_acceleration(share)

    def _write(self, efforts: list[float]) -> None:
        """Write the activations at the start of the period, and their rates, to MuJoCo."""
        lead_s, per_period = self._lead_s, 1.0 / self._period_s
        activations = [driven.effort for driven in self._joints]
        rates = [0.0] * len(activations)
        for index, driven in self._servoed:
            setpoint = driven.setpoint
            speed, start_speed = setpoint.velocity, driven.start_velocity
            effort = efforts[index]
            if speed:
                effort += self._drag[index] * speed + math.copysign(self._friction[index], speed)
            limit = driven.effort_limit
            if effort > limit:
                effort = limit
            elif effort < -limit:
                effort = -limit
            start = driven.start_position
            activations[index] = start + lead_s * start_speed + effort * self._compliance[index]
            rates[index] = (setpoint.position - start + lead_s * (speed - start_speed)) * per_period
        self._pack(self._act, 0, *activations)
        self._pack(self._ctrl, 0, *rates)

    def _set_gains(self, index: int, mode: DriveMode) -> None:
        tuning, model = self.tuning, self._model
        actuator = self._joints[index].joint.actuator
        gain, stiffness, damping = 0.0, 0.0, 0.0
        rotor = 0.0
        if mode in SERVOED:
            gain = stiffness = tuning.stiffness[index]
            damping, rotor = tuning.damping[index], tuning.armature[index]
        elif mode is DriveMode.EFFORT:
            gain = 1.0
        limit = self._joints[index].effort_limit
        if math.isfinite(limit):
            model.actuator_forcerange[actuator] = -limit, limit
        model.actuator_forcelimited[actuator] = math.isfinite(limit)
        model.actuator_gainprm[actuator, 0] = gain
        model.actuator_biasprm[actuator, :3] = 0.0, -stiffness, -damping
        self._set_rotor(self._joints[index].joint.dof_address, rotor)
        for follower, gear in tuning.gears[index]:
            self._set_rotor(follower, 0.0 if mode is DriveMode.FREE else gear)
        self._set_friction_solver(index)

    def _set_rotor(self, dof: int, armature: float) -> None:
        """Change a rotor, also in the last inertia, which the next period plans with."""
        model = self._model
        diagonal = model.M_rowadr[dof] + model.M_rownnz[dof] - 1
        self._inertia[diagonal] += armature - model.dof_armature[dof]
        set_armature(model, dof, armature)

    def set_friction_solvers(self) -> None:
        """Let dry friction yield or stick, after a change of modes or frictions from outside."""
        for index in range(len(self._joints)):
            self._set_friction_solver(index)

    def _set_friction_solver(self, index: int) -> None:
        """Let friction stick unless the drive holds the joint and can overcome it."""
        model, tuning = self._model, self.tuning
        driven = self._joints[index]
        dofs = (driven.joint.dof_address, *(follower for follower, _ in tuning.gears[index]))
        friction = float(np.abs(tuning.coupling[:, index]).dot(model.dof_frictionloss))
        held = driven.mode in SERVOED and friction < tuning.sizing[index]
        for dof in dofs:
            # A follower feels its leader's rotor through the gearing.
            rotor = tuning.armature[index] / tuning.coupling[dof, index] ** 2
            softness = float(model.dof_invweight0[dof])
            solver = yielding(softness, float(rotor)) if held else sticking(model.opt.timestep)
            solver.apply(model, dof)
