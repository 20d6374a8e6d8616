"""The running physics: one model, its state, and the drives of the robot's joints."""

import logging
from collections.abc import Collection, Iterator, Mapping
from copy import deepcopy
from typing import Any

import mujoco
import numpy as np

from arm_control.run_inputs import InputGate, run_input, run_input_noted_as
from arm_control.state.encoding import encode
from arm_gazebo.drives.driven_joint import DriveMode
from arm_gazebo.drives.servo import Servo
from arm_gazebo.drives.servo_tuning import (
    ServoTuning,
    rederive,
    retune,
    tune,
    tuned_for_gravity,
    weak_drives,
)
from arm_gazebo.errors import RecordingError, TimingError
from arm_gazebo.model.built_model import BuiltModel, SavedModel
from arm_gazebo.physics.contact_gate import ContactGate
from arm_gazebo.physics.faults import Distortion, PhysicsFaults
from arm_gazebo.physics.state_probe import StateProbe, WorldState
from arm_gazebo.physics.state_transfer import PhysicsState, StateTransfer
from arm_gazebo.physics.stepped_shapes import SteppedShapes
from arm_gazebo.physics.world_properties import UNCHANGED, OwnProperties, PropertyChanges
from arm_gazebo.physics_timing import DIVIDES_WITHIN, PhysicsTiming
from arm_gazebo.robot.actuation import RobotJoint
from arm_node.frozen import frozen
from arm_node.workarounds.profiler import switch_off_profiler

logger = logging.getLogger(__name__)

SAVE_EVERY_S = 0.1
"""Interval at which the state is saved for recovery from a physics failure."""

RESETTING = (
    mujoco.mjtWarning.mjWARN_BADQPOS,
    mujoco.mjtWarning.mjWARN_BADQVEL,
    mujoco.mjtWarning.mjWARN_BADQACC,
)
"""The warnings after which MuJoCo resets itself."""

WAKING_FORCE_N = 1e-9
"""A force too small to move anything that still wakes sleeping bodies."""


def _describe_swap(arguments: Mapping[str, Any]) -> Mapping[str, object]:
    """Return what a recording stores for `swap`: the model as data."""
    following: NextModel = arguments["following"]
    if following.saved is None:
        raise RecordingError("the recording began while this change was prepared; try again")
    return {"model": following.saved, "roots": following.roots}


def _describe_properties(arguments: Mapping[str, Any]) -> Mapping[str, object]:
    """Return what a recording stores for `set_properties`; a replay finds the tuning itself."""
    return {"changes": arguments["changes"]}


class Physics:
    """Advances a model by control periods; used by one thread.

    Args:
        built: the robot in its world. The simulation tunes its model and owns it.
        timing: control period and physics step; the model was built with this step.
        hold_joints: whether a driven joint without a command holds its position or falls.
        proportional_gain: of position commands, see `DrivenJoint`; 0 for the fastest approach.

    Attributes:
        properties: what the user has changed of gravity, masses and friction.
        faults: the faults of joints and readings; none unless they are requested.
        input_gate: notes the inputs while a run is recorded, see `arm_control.run_inputs`.

    Raises:
        TimingError: the model was built for another physics step.
    """

    input_gate: InputGate | None = None

    def __init__(
        self,
        built: BuiltModel,
        timing: PhysicsTiming,
        hold_joints: bool = True,
        proportional_gain: float = 0.0,
    ) -> None:
        step_s = built.model.opt.timestep
        if abs(step_s - timing.step_s) > DIVIDES_WITHIN * step_s:
            raise TimingError(
                f"the model was built with a physics step of {step_s:g} s, "
                f"but the simulation needs {timing.step_s:g} s"
            )
        self.built = built
        self.timing = timing
        self.properties, self._own_properties = UNCHANGED, OwnProperties(built.model)
        self.model = built.model
        self.data = mujoco.MjData(built.model)
        self._saved_qpos = self.data.qpos.copy()
        self.idle_mode = DriveMode.HOLD if hold_joints else DriveMode.FREE
        driven = [joint for joint in built.joints.values() if joint.actuator is not None]
        driven.sort(key=lambda joint: joint.actuator or 0)
        tuning = tune(self.model, driven, built.qpos, timing.period_s)
        for name, problem in weak_drives(self.model, driven, tuning):
            logger.warning("joint '%s': %s", name, problem)
        self._tuning = tuning
        self.servo = Servo(self.model, self.data, driven, tuning, timing, proportional_gain)
        self.probe = StateProbe()
        self.faults = PhysicsFaults(built.model, lambda name: self.built.joints[name].dof_address)
        self._restart(built.qpos, 0.0)
        self._gate = ContactGate(self.model, self.data, timing.period_s)
        self._shapes = SteppedShapes(self.model)
        self._physics = PhysicsState(self.model, self.data)
        self._failures: list[str] = []
        self._ticks_to_save = 0
        self._save_ticks = max(1, round(SAVE_EVERY_S / timing.period_s))
        # Without a handler MuJoCo writes a log file into the working directory.
        mujoco.set_mju_user_warning(_log_warning)
        switch_off_profiler(mujoco)
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
        self._shapes.hide()
        try:
            mujoco.mj_step(self.model, data, self.timing.steps)
        finally:
            self._shapes.show()
        if data.time <= before_s or (not before_s and _has_reset_itself(data)):
            # MuJoCo resets itself when a number is no longer finite.
            self._recover(before_s)
        else:
            # MuJoCo adds up its steps with their rounding errors: 3 ns in 12 minutes.
            self._periods += 1
            data.time = self._started_s + self._periods * self.timing.period_s
        self.probe.expire()
        self._ticks_to_save -= 1
        if self._ticks_to_save < 0:
            self._ticks_to_save = self._save_ticks
            self._saved_qpos[:] = data.qpos

    @run_input
    def stall_joint(self, joint: str) -> None:
        """Make a joint stick where it is, whatever its drive does."""
        self.faults.stall(joint)

    @run_input
    def free_joint(self, joint: str) -> None:
        """Let a joint that sticks move again."""
        self.faults.free(joint)
        self.servo.set_friction_solvers()

    @run_input
    def distort(self, name: str, kind: str, deviation: float = 0.0, seed: int = 0) -> None:
        """Make readings frozen, noisy or NaN; see `PhysicsFaults.distort`."""
        self.faults.distort(name, Distortion(kind), deviation, seed)

    @run_input
    def read_rightly(self, name: str, kind: str) -> None:
        """End `distort`."""
        self.faults.clear(name, Distortion(kind))

    @run_input
    def resume_faults(self, present: Mapping[str, Any]) -> None:
        """Begin the faults that last when a recording begins; see `PhysicsFaults.present`."""
        self.faults.resume(present)

    def reset(self, time_s: float = 0.0) -> None:
        """Return everything to its start, at rest; the clock continues from `time_s`.

        Noise starts again. Joints stay claimed, and hold their positions until a new command
        arrives.
        """
        self._restart(self.built.qpos, time_s)
        self.servo.reset()
        self._ticks_to_save = 0
        self.probe.restart()

    def set_clock(self, time_s: float) -> None:
        """Continue the clock from another time; nothing else changes."""
        self.data.time = self._started_s = time_s
        self._periods = 0

    def save_state(self) -> dict[str, Any]:
        """Return everything that the next periods depend on, as plain values.

        It shares arrays with the simulation, so encode it at once.
        """
        return {
            "physics": self._physics.save(),
            "started_s": self._started_s,
            "periods": self._periods,
            "saved_qpos": self._saved_qpos,
            "ticks_to_save": self._ticks_to_save,
            "gate": self._gate.save_state(),
            "state_number": self.probe.number,
            "servo": self.servo.save_state(),
            "properties": self.properties,
        }

    def load_state(self, state: dict[str, Any]) -> None:
        """Restore a saved state of the same model; call it between two `advance` calls.

        Raises:
            StateError: it is that of another model.
        """
        # States of older versions have the world's own properties.
        self._change_properties(state.get("properties", UNCHANGED))
        self._gate.load_state(state["gate"])
        self._physics.load(state["physics"])
        self._started_s, self._periods = state["started_s"], state["periods"]
        self._saved_qpos[:] = state["saved_qpos"]
        self._ticks_to_save = state["ticks_to_save"]
        self.servo.load_state(state["servo"])
        self.probe.restart(state["state_number"])

    def fingerprint(self) -> Iterator[tuple[str, bytes]]:
        """Yield the parts of the state by name, as bytes that differ if the state does."""
        yield "physics", self._physics.integration().tobytes()
        yield "drives", self.servo.fingerprint()
        yield "noise", self.probe.number.to_bytes(8, "little")
        yield "properties", encode(self.properties)

    def prepare(self, built: BuiltModel, roots: Collection[str]) -> "NextModel":
        """Prepare another model for `swap`. Any thread; it takes a while.

        Args:
            built: a model with the same robots. The simulation owns it from now on.
            roots: top-level bodies whose states are carried over; the others start as in `built`.
        """
        saved = SavedModel.of(built) if self.input_gate is not None else None
        own = OwnProperties(built.model)
        changes = self.properties.carried_to(built.model, roots)
        own.change(built.model, changes)
        transfer = StateTransfer(self.model, built.model, roots)
        transfer.carry_drives(self.model, built.model)
        joints = tuple(built.joints[joint.name] for joint in self.servo.joints)
        data = mujoco.MjData(built.model)
        tuning = retune(built.model, data, joints, self._tuning)
        if (built.model.opt.gravity != self.model.opt.gravity).any():
            tuning = tuned_for_gravity(deepcopy(built.model), joints, built.qpos, tuning)
        mujoco.mj_resetData(built.model, data)
        data.qpos[:] = built.qpos
        mujoco.mj_forward(built.model, data)
        gate = ContactGate(built.model, data, self.timing.period_s)
        shapes = SteppedShapes(built.model)
        kept = tuple(sorted(roots))
        return NextModel(
            built, data, joints, tuning, gate, shapes, transfer, kept, saved, own, changes
        )

    @run_input_noted_as(_describe_swap)
    def swap(self, following: "NextModel") -> None:
        """Continue with another model in the present state; call it between two `advance` calls.

        It replaces `model`, `data` and `built`, so stored indices and views of them must be
        looked up again.
        """
        data = following.data
        following.transfer.carry(self.data, data)
        following.transfer.carry_drives(self.model, following.built.model)
        self.built, self.model, self.data = following.built, following.built.model, data
        self._tuning, self._gate = following.tuning, following.gate
        self.properties, self._own_properties = following.properties, following.own_properties
        self._shapes = following.shapes
        self._physics = PhysicsState(self.model, data)
        self.faults.rebind(self.model)
        self.servo.rebind(self.model, data, following.joints, following.tuning)
        warm_start = data.qacc_warmstart.copy()
        # The drives read the inertia and gravity of the last step.
        mujoco.mj_forward(self.model, data)
        data.qacc_warmstart[:] = warm_start
        self._saved_qpos = data.qpos.copy()
        self.probe.expire()

    @run_input
    def place(self, joint: str, position: np.ndarray, velocity: np.ndarray) -> None:
        """Move the body of a free joint to another pose; call it between two `advance` calls.

        Args:
            joint: name of the free joint.
            position: x, y, z and quaternion (w, x, y, z) in the world, shape (7,).
            velocity: linear in the world, angular in the body's own frame, shape (6,).
        """
        data, found = self.data, self.model.joint(joint)
        data.qpos[found.qposadr[0] :][:7] = position
        data.qvel[found.dofadr[0] :][:6] = velocity
        self._wake()
        self._saved_qpos[:] = data.qpos
        self.probe.expire()

    def tuning_for(self, changes: PropertyChanges) -> ServoTuning:
        """Return the drives' tuning under the gravity of these changes. Any thread; some ms."""
        model = deepcopy(self.model)
        self._own_properties.change(model, changes)
        return tuned_for_gravity(model, self.servo.joints, self.built.qpos, self._tuning)

    @run_input_noted_as(_describe_properties)
    def set_properties(self, changes: PropertyChanges, tuning: ServoTuning | None = None) -> None:
        """Continue with other gravity, masses and friction; between two `advance` calls.

        Args:
            changes: all that differs from the world's own properties from now on.
            tuning: what `tuning_for` returns for another gravity; None to find it now.
        """
        if changes == self.properties:
            return
        self._change_properties(changes, tuning)
        warm_start = self.data.qacc_warmstart.copy()
        # The drives read the inertia and gravity of the last step.
        self._wake()
        self.data.qacc_warmstart[:] = warm_start
        self.probe.expire()

    def _change_properties(
        self, changes: PropertyChanges, tuning: ServoTuning | None = None
    ) -> None:
        before, self.properties = self.properties, changes
        if changes == before:
            return
        if changes.gravity != before.gravity:
            self._tuning = tuning or self.tuning_for(changes)
            self.servo.retune(self._tuning)
        self._own_properties.change(self.model, changes)
        if changes.masses != before.masses:
            rederive(self.model, self.servo.joints, self._tuning)

    def _wake(self) -> None:
        """Compute what follows from a change, and wake every sleeping body, which may now move."""
        data = self.data
        forces = data.xfrc_applied.copy()
        data.xfrc_applied[:] = WAKING_FORCE_N
        mujoco.mj_forward(self.model, data)
        data.xfrc_applied[:] = forces

    def state(self) -> WorldState:
        """Return a copy of the present state."""
        data = self.data
        return WorldState(
            data.time,
            data.qpos.copy(),
            data.qvel.copy(),
            data.mocap_pos.copy(),
            data.mocap_quat.copy(),
        )

    def observe(self) -> mujoco.MjData:
        """Return the present state with all derived quantities; see `StateProbe.observe`."""
        return self.probe.observe(self.model, self.data)

    def poses(self) -> mujoco.MjData:
        """Return the present poses of bodies and shapes alone; see `StateProbe.poses`."""
        return self.probe.poses(self.model, self.data)

    def take_failures(self) -> list[str]:
        """Return one sentence for each physics failure since the last call."""
        failures, self._failures = self._failures, []
        return failures

    def _restart(self, qpos: np.ndarray, time_s: float) -> None:
        mujoco.mj_resetData(self.model, self.data)
        self.data.time = self._started_s = time_s
        self._periods = 0
        self.data.qpos[:] = qpos
        self._saved_qpos[:] = qpos
        # The drives read the inertia and gravity of the last step.
        mujoco.mj_forward(self.model, self.data)
        self.probe.expire()

    def _recover(self, before_s: float) -> None:
        self._restart(self._saved_qpos.copy(), before_s + self.timing.period_s)
        self.servo.reset()
        self._failures.append(
            f"the physics became unstable at {before_s:.3f} s; it continues at rest from the pose "
            f"up to {SAVE_EVERY_S:g} s earlier"
        )


def _has_reset_itself(data: mujoco.MjData) -> bool:
    """Return whether MuJoCo's warnings since the last reset are about numbers out of bounds.

    The time cannot tell it in the first control period, which begins at 0 as a reset does.
    """
    return any(data.warning[kind].number for kind in RESETTING)


@frozen
class NextModel:
    """A model that the simulation can switch to without delay; see `Physics.prepare`.

    Attributes:
        saved: the model before the simulation changed it; None if no run was recorded then.
        own_properties: gravity, masses and friction of the model before the user's changes.
        properties: the user's changes, which the model has.
    """

    built: BuiltModel
    data: mujoco.MjData
    joints: tuple[RobotJoint, ...]
    tuning: ServoTuning
    gate: ContactGate
    shapes: SteppedShapes
    transfer: StateTransfer
    roots: tuple[str, ...]
    saved: SavedModel | None
    own_properties: OwnProperties
    properties: PropertyChanges


def _log_warning(message: str) -> None:
    logger.warning("MuJoCo: %s", message)
