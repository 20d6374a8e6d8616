"""The running physics: one model, its state, and the drives of the robot's joints."""

import logging
from collections.abc import Collection
from dataclasses import dataclass

import mujoco
import numpy as np

from arm_gazebo.drives.mode import DriveMode
from arm_gazebo.drives.servo import Servo
from arm_gazebo.drives.servo_tuning import ServoTuning, too_weak, tune, tuned_again
from arm_gazebo.errors import TimingError
from arm_gazebo.model.built_model import BuiltModel
from arm_gazebo.physics import profiler
from arm_gazebo.physics.contact_gate import ContactGate
from arm_gazebo.physics.state_probe import StateProbe
from arm_gazebo.physics.state_transfer import StateTransfer
from arm_gazebo.physics.world_state import WorldState
from arm_gazebo.physics_timing import DIVIDES_WITHIN, PhysicsTiming
from arm_gazebo.robot.joint import RobotJoint

logger = logging.getLogger(__name__)

SAVE_EVERY_S = 0.1
"""How often the state is kept, to go back to if the physics fails."""

TOUCH_N = 1e-9
"""A force that moves nothing, and wakes what sleeps."""


class Simulation:
    """Advances a model by control periods; used by one thread.

    Args:
        built: the robot in its world. Its model is tuned here and belongs to the simulation.
        timing: control period and physics step; the model was built with the latter.
        hold_joints: whether a driven joint that no one commands stands still or falls.

    Raises:
        TimingError: the model was built for another physics step.
    """

    def __init__(self, built: BuiltModel, timing: PhysicsTiming, hold_joints: bool = True) -> None:
        step_s = built.model.opt.timestep
        if abs(step_s - timing.step_s) > DIVIDES_WITHIN * step_s:
            raise TimingError(
                f"the model was built with a physics step of {step_s:g} s, "
                f"and the simulation asks for {timing.step_s:g} s"
            )
        self.built = built
        self.timing = timing
        self.model = built.model
        self.data = mujoco.MjData(built.model)
        self._saved_qpos = self.data.qpos.copy()
        self.idle_mode = DriveMode.HOLD if hold_joints else DriveMode.LIMP
        driven = [joint for joint in built.joints.values() if joint.actuator is not None]
        driven.sort(key=lambda joint: joint.actuator or 0)
        tuning = tune(self.model, driven, built.qpos, timing.period_s)
        for name, problem in too_weak(self.model, driven, tuning):
            logger.warning("joint '%s': %s", name, problem)
        self._tuning = tuning
        self.servo = Servo(self.model, self.data, driven, tuning, timing)
        self.probe = StateProbe()
        self._restart(built.qpos, 0.0)
        self._gate = ContactGate(self.model, self.data, timing.period_s)
        self._failures: list[str] = []
        self._ticks_to_save = 0
        self._save_ticks = max(1, round(SAVE_EVERY_S / timing.period_s))
        # Without a handler MuJoCo writes a log file into whatever folder this process runs in.
        mujoco.set_mju_user_warning(_log_warning)
        profiler.switch_off()
        for index in range(len(driven)):
            self.servo.set_mode(index, self.idle_mode)

    @property
    def time_s(self) -> float:
        """Simulation time."""
        return self.data.time

    def advance(self) -> None:
        """Advance by one control period."""
        data = self.data
        before_s = data.time
        self.servo.update()
        self._gate.update()
        mujoco.mj_step(self.model, data, self.timing.steps)
        if data.time <= before_s:
            # MuJoCo starts over by itself where a number is no longer finite.
            self._recover(before_s)
        else:
            # MuJoCo adds up its steps, and with them their rounding: 3 ns in 12 minutes.
            self._periods += 1
            data.time = self._started_s + self._periods * self.timing.period_s
        self.probe.expire()
        self._ticks_to_save -= 1
        if self._ticks_to_save < 0:
            self._ticks_to_save = self._save_ticks
            self._saved_qpos[:] = data.qpos

    def reset(self, time_s: float = 0.0) -> None:
        """Put everything back to where it started, at rest; the clock goes on from `time_s`.

        Joints stay as they are claimed, and stand until a new command comes.
        """
        self._restart(self.built.qpos, time_s)
        self.servo.reset()

    def prepare(self, built: BuiltModel, roots: Collection[str]) -> "NextModel":
        """Return what `swap` needs to go on with another model; any thread, takes its time.

        Args:
            built: has the same robots. Its model belongs to the simulation from now on.
            roots: bodies right below the world whose states are carried over; the others start
                as `built` says.
        """
        transfer = StateTransfer(self.model, built.model, roots)
        transfer.carry_drives(self.model, built.model)
        joints = tuple(built.joints[joint.name] for joint in self.servo.joints)
        data = mujoco.MjData(built.model)
        tuning = tuned_again(built.model, data, joints, self._tuning)
        mujoco.mj_resetData(built.model, data)
        data.qpos[:] = built.qpos
        mujoco.mj_forward(built.model, data)
        gate = ContactGate(built.model, data, self.timing.period_s)
        return NextModel(built, data, joints, tuning, gate, transfer)

    def swap(self, following: "NextModel") -> None:
        """Go on with another model in the present state; between two calls of `advance`.

        `model`, `data` and `built` are others from here on: whoever keeps indices or views of
        them looks them up again.
        """
        data = following.data
        following.transfer.carry(self.data, data)
        following.transfer.carry_drives(self.model, following.built.model)
        self.built, self.model, self.data = following.built, following.built.model, data
        self._tuning, self._gate = following.tuning, following.gate
        self.servo.rebind(self.model, data, following.joints, following.tuning)
        warm_start = data.qacc_warmstart.copy()
        # The drives read inertia and gravity of the last step.
        mujoco.mj_forward(self.model, data)
        data.qacc_warmstart[:] = warm_start
        self._saved_qpos = data.qpos.copy()
        self.probe.expire()

    def place(self, joint: str, position: np.ndarray, velocity: np.ndarray) -> None:
        """Put what hangs on a free joint elsewhere; between two calls of `advance`.

        Args:
            joint: its name.
            position: x, y, z and quaternion (w, x, y, z) in the world, shape (7,).
            velocity: linear in the world, angular in the body's own frame, shape (6,).
        """
        data, where = self.data, self.model.joint(joint)
        data.qpos[where.qposadr[0] :][:7] = position
        data.qvel[where.dofadr[0] :][:6] = velocity
        # It may have carried others, and all that sleeps feels nothing of it.
        forces = data.xfrc_applied.copy()
        data.xfrc_applied[:] = TOUCH_N
        mujoco.mj_forward(self.model, data)
        data.xfrc_applied[:] = forces
        self._saved_qpos[:] = data.qpos
        self.probe.expire()

    def state(self) -> WorldState:
        """Return a copy of where everything is."""
        data = self.data
        return WorldState(
            data.time,
            data.qpos.copy(),
            data.qvel.copy(),
            data.mocap_pos.copy(),
            data.mocap_quat.copy(),
        )

    def observe(self) -> mujoco.MjData:
        """Return the present state with all that follows from it; see `StateProbe.look`."""
        return self.probe.look(self.model, self.data)

    def take_failures(self) -> list[str]:
        """Return what went wrong in the physics since the last call, one sentence each."""
        failures, self._failures = self._failures, []
        return failures

    def _restart(self, qpos: np.ndarray, time_s: float) -> None:
        mujoco.mj_resetData(self.model, self.data)
        self.data.time = self._started_s = time_s
        self._periods = 0
        self.data.qpos[:] = qpos
        self._saved_qpos[:] = qpos
        # The drives read inertia and gravity of the last step.
        mujoco.mj_forward(self.model, self.data)
        self.probe.expire()

    def _recover(self, before_s: float) -> None:
        self._restart(self._saved_qpos.copy(), before_s + self.timing.period_s)
        self.servo.reset()
        self._failures.append(
            f"the physics became unstable at {before_s:.3f} s; it goes on at rest from the pose "
            f"of up to {SAVE_EVERY_S:g} s before"
        )


@dataclass(frozen=True, slots=True)
class NextModel:
    """A model that the simulation can go on with at once; see `Simulation.prepare`."""

    built: BuiltModel
    data: mujoco.MjData
    joints: tuple[RobotJoint, ...]
    tuning: ServoTuning
    gate: ContactGate
    transfer: StateTransfer


def _log_warning(message: str) -> None:
    logger.warning("MuJoCo: %s", message)
