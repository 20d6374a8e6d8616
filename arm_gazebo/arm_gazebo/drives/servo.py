"""The drives of a robot's joints: commands in, efforts out, no gain set by hand.

Each drive is a MuJoCo actuator whose force is

    stiffness (act - q - T q') with T = damping / stiffness, within the effort limit,

where the activation `act` = r + T r' + f / stiffness carries the set-point r, its velocity and
the effort f that the model says the motion needs: inertia times acceleration, gravity, Coriolis
forces and friction. The control of the actuator is the rate of `act`, so that MuJoCo moves the
set-point on between two control ticks by itself.
"""

import math
from collections.abc import Sequence

import mujoco
import numpy as np
from numpy.typing import NDArray

from arm_gazebo.drives.driven_joint import DrivenJoint
from arm_gazebo.drives.mode import SERVOED, DriveMode
from arm_gazebo.drives.servo_tuning import EFFORT_SHARE, TIME_CONSTANT_S, ServoTuning, resistance
from arm_gazebo.index_slice import as_slice
from arm_gazebo.physics_timing import PhysicsTiming
from arm_gazebo.robot.joint import RobotJoint

Array = NDArray[np.float64]

USABLE_EFFORT = 0.9
"""Share of the effort limit that planned motion may use; the rest is for what is not planned."""
SETTLE_S = 0.1
LOOK_EVERY_S = 0.01
STIRRED = 5e-4
"""Resting joints that together moved by this much, in rad or m, are looked after again."""


class Servo:
    """Drives joints; used by one thread, the one that steps the simulation.

    A robot at rest costs nothing: the drives sleep until a command, or a joint that is moved.

    Args:
        model: its gains are set; tuned by `servo_tuning.tune` before.
        data: state; its positions are valid.
        joints: the driven joints; their actuators and activations are contiguous.
        tuning: gains and bounds.
        timing: control period and physics step.
    """

    def __init__(
        self,
        model: mujoco.MjModel,
        data: mujoco.MjData,
        joints: Sequence[RobotJoint],
        tuning: ServoTuning,
        timing: PhysicsTiming,
    ) -> None:
        self._period_s = timing.period_s
        # The force sees the position at the start of a step and the set-point of its end: at
        # constant speed they lie one step apart.
        self._lead_s = TIME_CONSTANT_S - timing.step_s
        self._joints = tuple(
            DrivenJoint(joint, tuning.bounds(index), timing.period_s)
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
        self._look_ticks = max(1, round(LOOK_EVERY_S / timing.period_s))
        self._tick = 0
        self._awake_ticks = self._settle_ticks

    def rebind(
        self,
        model: mujoco.MjModel,
        data: mujoco.MjData,
        joints: Sequence[RobotJoint],
        tuning: ServoTuning,
    ) -> None:
        """Go on in another model: the drives stay as they are, with all that they plan.

        Args:
            model: has the same driven joints, in the same order, with the gains that they have.
            data: state that the joints' present one was carried to.
            joints: the driven joints at their places there.
            tuning: see `servo_tuning.tuned_again`.
        """
        self._bind(model, data, joints, tuning)
        for driven, joint in zip(self._joints, joints, strict=True):
            driven.joint = joint
        # What holds a resting joint was in the state before.
        self._awake_ticks = self._settle_ticks

    def _bind(
        self,
        model: mujoco.MjModel,
        data: mujoco.MjData,
        joints: Sequence[RobotJoint],
        tuning: ServoTuning,
    ) -> None:
        """Take hold of MuJoCo's arrays; each look-up of an attribute costs as much as a sum."""
        self._model, self._data, self._tuning = model, data, tuning
        self._spread = tuning.coupling / self._period_s
        self._coupling = np.ascontiguousarray(tuning.coupling.T)
        self._friction, self._drag = resistance(model, tuning.coupling)
        self._motion = np.zeros(model.nv)
        self._load = np.zeros(model.nv)
        count = len(joints)
        first = next((j.actuator for j in joints if j.actuator is not None), 0)
        activation = int(model.actuator_actadr[first]) if count else 0
        self._actuators = range(first, first + count)
        self._act = data.act[activation : activation + count]
        self._ctrl = data.ctrl[first : first + count]
        dofs = np.array([joint.dof_address for joint in joints], dtype=np.intp)
        addresses = np.array([joint.qpos_address for joint in joints], dtype=np.intp)
        self._dofs, self._addresses = as_slice(dofs), as_slice(addresses)
        self._diagonal = as_slice(model.M_rowadr[dofs] + model.M_rownnz[dofs] - 1)
        self._qpos, self._qvel = data.qpos, data.qvel
        self._inertia, self._bias = data.M, data.qfrc_bias

    @property
    def joints(self) -> tuple[RobotJoint, ...]:
        """The driven joints; their order is that of the indices below."""
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
        self._servoed = tuple(
            (each, joint) for each, joint in enumerate(self._joints) if joint.mode in SERVOED
        )
        self._awake_ticks = self._settle_ticks

    def command(self, index: int, value: float) -> None:
        """Take a finite command, within the joint's limits, in the unit of the joint's mode."""
        self._joints[index].command(value, self._tick)
        self._awake_ticks = self._settle_ticks

    def limit_effort(self, index: int, limit: float) -> None:
        """Let a joint's drive spend no more than this, N m or N; only above 0 is it a limit."""
        driven = self._joints[index]
        own = driven.joint.effort
        limit = limit if 0.0 < limit < own else own
        needed = self._tuning.braking_efforts[index]
        driven.limit_effort(limit, min(1.0, EFFORT_SHARE * limit / needed))
        self._set_gains(index, driven.mode)
        self._awake_ticks = self._settle_ticks

    def stopping_point(self, index: int) -> float:
        """Return where a joint will stand if nothing new is commanded, in rad or m."""
        return self._joints[index].stopping_point()

    def reset(self) -> None:
        """Start anew from the joints' state, which was changed from outside; modes stay."""
        for index, driven in enumerate(self._joints):
            mode = driven.mode
            driven.mode = DriveMode.LIMP
            self.set_mode(index, mode)

    def update(self) -> None:
        """Drive the joints for one control period; called before each, commands or not."""
        self._tick += 1
        if not self._awake_ticks:
            if self._tick % self._look_ticks or not self._is_stirred():
                return
            self._awake_ticks = self._settle_ticks
        gravity = self._coupling.dot(self._bias).tolist()
        if self._plan(gravity) or len(self._servoed) < len(self._joints):
            self._awake_ticks = self._settle_ticks
        else:
            self._awake_ticks -= 1
        self._write(self._planned_efforts(gravity))
        if not self._awake_ticks:
            self._still = self._qpos[self._addresses].tolist()

    def _is_stirred(self) -> bool:
        return math.dist(self._qpos[self._addresses].tolist(), self._still) > STIRRED

    def _plan(self, gravity: list[float]) -> bool:
        """Move every set-point on; return whether one of them moves."""
        positions = self._qpos[self._addresses].tolist()
        velocities = self._qvel[self._dofs].tolist()
        inertias = self._inertia[self._diagonal].tolist()
        moving = False
        for index, driven in self._servoed:
            inertia = inertias[index] + self._followers[index]
            if driven.plan(positions[index], velocities[index], inertia, gravity[index]):
                moving = True
        return moving

    def _planned_efforts(self, gravity: list[float]) -> list[float]:
        """Return the efforts that the planned motion needs, having slowed one that is too fast."""
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
        self._accelerations[:] = gains
        # The couplings are divided by the period beforehand: gain to acceleration.
        self._spread.dot(self._accelerations, self._motion)
        mujoco.mj_mulM(self._model, self._data, self._load, self._motion)
        np.add(self._load, self._bias, self._load)
        return self._coupling.dot(self._load).tolist()

    def _slow_down(self, efforts: list[float], gravity: list[float]) -> None:
        """Let all joints that gain speed gain less, by one share, until the efforts suffice."""
        share = 1.0
        for index, driven in self._servoed:
            limit = USABLE_EFFORT * driven.effort_limit
            moving = efforts[index] - gravity[index]
            room = limit - math.copysign(gravity[index], gravity[index] * moving)
            if abs(efforts[index]) > limit and 0.0 < room < abs(moving):
                share = min(share, room / abs(moving))
        for _, driven in self._servoed:
            driven.gain_less(share)

    def _write(self, efforts: list[float]) -> None:
        """Hand over to MuJoCo: where the activations start and how fast they move."""
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
        self._act[:] = activations
        self._ctrl[:] = rates

    def _set_gains(self, index: int, mode: DriveMode) -> None:
        tuning, model, actuator = self._tuning, self._model, self._actuators[index]
        gain, stiffness, damping = 0.0, 0.0, 0.0
        rotor = tuning.limp_armature[index]
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
        dof = self._joints[index].joint.dof_address
        # MuJoCo takes the inertia of a body that moves by itself from here, once and for all.
        model.dof_M0[dof] += rotor - model.dof_armature[dof]
        model.dof_armature[dof] = rotor
