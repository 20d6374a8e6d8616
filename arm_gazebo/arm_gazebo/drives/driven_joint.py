"""One driven joint: its mode, its command and the resulting set-point."""

from enum import Enum
from typing import Any

from arm_gazebo.drives.braking_law import FLOOR, LEAST_LEFT
from arm_gazebo.drives.servo_tuning import EFFORT_SHARE, MotionBounds
from arm_gazebo.drives.setpoint import Setpoint
from arm_gazebo.robot.actuation import UNLIMITED, RobotJoint


class DriveMode(Enum):
    """How a joint is driven; the values of the last three are ros2_control's interface names."""

    FREE = "free"
    """The drive exerts no effort: the joint moves freely."""
    HOLD = "hold"
    """Brake, then hold the position."""
    POSITION = "position"
    """Go to the commanded position, in rad or m."""
    VELOCITY = "velocity"
    """Move at the commanded velocity, in rad/s or m/s; stop before the joint's limit."""
    EFFORT = "effort"
    """Exert the commanded effort, in N m or N."""


SERVOED = frozenset({DriveMode.HOLD, DriveMode.POSITION, DriveMode.VELOCITY})
"""Modes in which the joint follows a set-point."""
# Looked up once: in Python 3.11 a member of an enum takes as long as a call.
_POSITION, _VELOCITY, _EFFORT = DriveMode.POSITION, DriveMode.VELOCITY, DriveMode.EFFORT


LANDING_SPEED = 1e-5
"""A proportional approach ends below this speed (rad/s or m/s)."""

NEAREST = 1e-9
"""Distance in rad or m to which a need for braking refers at least."""

MAX_INTERVAL_S = 0.05
"""Commands farther apart than this are steps; closer ones are samples of one motion."""


class CommandStream:
    """Turns the commands of a joint into a target with a velocity.

    A single command is a step: the target jumps and stays. Commands that follow each other
    within 50 ms are samples of a motion: the target moves from one to the next in the time
    between them, so the joint follows a trajectory without stopping at every sample.

    Attributes:
        target: position of the target at the end of this control period.
        velocity: velocity of the target.
    """

    __slots__ = ("_command", "_last_change", "_left", "_period_s", "target", "velocity")

    def __init__(self, position: float, period_s: float) -> None:
        self.target = position
        self.velocity = 0.0
        self._period_s = period_s
        self._command = position
        self._left = 0
        self._last_change = -1_000_000

    def command(self, position: float, tick: int) -> bool:
        """Take the command of control period `tick`; return whether it differs from the last."""
        if position == self._command:
            return False
        interval = tick - self._last_change
        self._command = position
        self._last_change = tick
        if interval * self._period_s > MAX_INTERVAL_S:
            self._left = 0
            self.target = position
            self.velocity = 0.0
        else:
            self._left = max(interval, 1)
            self.velocity = (position - self.target) / (self._left * self._period_s)
        return True

    def save_state(self) -> tuple[float, float, float, int, int]:
        """Return the target and the last command."""
        return self.target, self.velocity, self._command, self._left, self._last_change

    def load_state(self, state: tuple[float, float, float, int, int]) -> None:
        """Continue with a saved target."""
        self.target, self.velocity, self._command, self._left, self._last_change = state

    def advance(self) -> None:
        """Advance by one control period; called once in each, after its commands."""
        if self._left > 1:
            self._left -= 1
            self.target += self.velocity * self._period_s
        elif self._left == 1:
            self._left = 0
            self.target = self._command
        else:
            self.velocity = 0.0


class DrivenJoint:
    """The planning half of a servo; `Servo` owns the physics half. Units: rad or m, N m or N.

    Attributes:
        joint: the joint in the model.
        mode: how it is driven.
        effort: commanded effort, in the mode EFFORT.
        effort_limit: largest effort of the drive now, at most the joint's own limit.
        sure_braking: deceleration that it can reach in any pose, whatever the others do.
        part: part of its present acceleration that it may brake with; see `BrakingLaw`.
        braking: deceleration that stops are planned with now.
        setpoint: the set-point at the end of the current control period.
        start_position: position of the set-point at the start of the period.
        start_velocity: velocity of the set-point at the start of the period.
    """

    __slots__ = (
        "_bounds",
        "_floor",
        "_jerkless",
        "_least",
        "_period_s",
        "_rate_per_s",
        "_slack",
        "_speed",
        "_stream",
        "_strength",
        "_velocity",
        "braking",
        "effort",
        "effort_limit",
        "joint",
        "mode",
        "part",
        "setpoint",
        "start_position",
        "start_velocity",
        "sure_braking",
    )

    def __init__(
        self,
        joint: RobotJoint,
        bounds: MotionBounds,
        period_s: float,
        proportional_gain: float = 0.0,
    ) -> None:
        """Start at the joint's first position, without a command.

        Args:
            joint: the joint in the model.
            bounds: bounds on the set-point.
            period_s: control period.
            proportional_gain: fraction of the distance to a position command that the set-point
                moves in a period, as gz_ros2_control's position_proportional_gain; 0 moves as
                fast as the bounds allow.
        """
        self.joint = joint
        self.mode = DriveMode.FREE
        self.effort = 0.0
        self.setpoint = Setpoint(joint.initial)
        self.start_position = joint.initial
        self.start_velocity = 0.0
        # Copied because they are read in every tick.
        self._speed = joint.velocity
        self._jerkless = bounds.jerkless
        self._slack = bounds.slack
        self._bounds = bounds
        self.limit_effort(joint.effort, 1.0)
        self.part, self.braking = 0.0, self.sure_braking
        self._period_s = period_s
        self._rate_per_s = proportional_gain / period_s
        self._stream = CommandStream(joint.initial, period_s)
        self._velocity = 0.0

    def limit_effort(self, limit: float, share: float) -> None:
        """Plan with less effort, N m or N, than the joint's own limit.

        The share is the fraction of the normal braking deceleration that this effort allows.
        """
        self.effort_limit = limit
        self.sure_braking = share * self._bounds.braking
        self._derive()

    def rebound(self, bounds: MotionBounds, share: float) -> None:
        """Plan with other bounds; see `limit_effort` for the share."""
        if bounds != self._bounds:
            self._bounds = bounds
            self._jerkless, self._slack = bounds.jerkless, bounds.slack
            self.limit_effort(self.effort_limit, share)

    def _derive(self) -> None:
        """Note what follows from the effort limit, as it is needed in every tick."""
        self._strength = min(self.effort_limit, UNLIMITED)
        self._least = LEAST_LEFT * self._strength
        self._floor = FLOOR * self.sure_braking

    def enter(self, mode: DriveMode, position: float, velocity: float) -> None:
        """Change the mode; a new set-point starts from the state of the joint."""
        if self.mode not in SERVOED:
            speed = self.joint.velocity_limit
            self.setpoint = Setpoint(position, min(max(velocity, -speed), speed))
        self.mode = mode
        self.effort = 0.0
        self._velocity = 0.0
        self._stream = CommandStream(self.stopping_point(), self._period_s)

    def save_state(self) -> tuple[Any, ...]:
        """Return the mode, the limit, the command and the set-point: the mode, then numbers."""
        setpoint = self.setpoint
        return (
            self.mode,
            self.effort,
            self.effort_limit,
            self.sure_braking,
            self._velocity,
            setpoint.position,
            setpoint.velocity,
            self.start_position,
            self.start_velocity,
            *self._stream.save_state(),
            self.braking,
            self.part,
        )

    def load_state(self, state: tuple[Any, ...]) -> None:
        """Continue from a saved state."""
        self.mode, self.effort, self.effort_limit, self.sure_braking, self._velocity = state[:5]
        self._derive()
        self.setpoint = Setpoint(*state[5:7])
        self.start_position, self.start_velocity = state[7:9]
        self._stream.load_state(state[9:14])
        # States of older versions end here.
        self.braking, self.part = state[14:] or (self.sure_braking, 0.0)

    def stopping_point(self) -> float:
        """Return where the joint will stop without a new command, within its limits."""
        point = self.setpoint.stopping_point(self.braking)
        return min(max(point, self.joint.lower), self.joint.upper)

    def command(self, value: float, tick: int) -> bool:
        """Take a command in the unit of the mode; return whether a resting set-point may start.

        HOLD and FREE ignore commands.
        """
        differs = False
        if self.mode is _POSITION:
            differs = self._stream.command(value, tick)
        elif self.mode is _VELOCITY:
            differs = value != self._velocity
            self._velocity = value
        elif self.mode is _EFFORT:
            self.effort = value
        return differs and self.setpoint.velocity == 0.0

    def needed_braking(self) -> float:
        """Return the deceleration that stops the present motion at its target.

        -1 at rest, and for a target that moves.
        """
        position, velocity = self.setpoint.position, self.setpoint.velocity
        if self.mode is _VELOCITY:
            if not velocity and not self._velocity:
                return -1.0
            target = self.joint.upper if self._velocity > 0.0 else self.joint.lower
        else:
            stream = self._stream
            target = stream.target
            if stream.velocity or (not velocity and target == position):
                return -1.0
        return 0.5 * velocity * velocity / max(abs(target - position), NEAREST)

    def plan(self, position: float, velocity: float, inertia: float, gravity: float) -> bool:
        """Advance the set-point by one control period; return whether it moves.

        All are those of the joint at present; `gravity` is an effort and includes Coriolis forces.
        """
        setpoint = self.setpoint
        lead = setpoint.position - position
        slack = self._slack
        # Something holds or drags the joint. If the set-point ran on, it would fling the joint once
        # it is free. A set-point that the joint overtook between two ticks keeps its speed.
        if lead > slack:
            setpoint.position = position + slack
            fastest = velocity if velocity > 0.0 else 0.0
            if setpoint.velocity > fastest:
                setpoint.velocity = fastest
        elif lead < -slack:
            setpoint.position = position - slack
            fastest = velocity if velocity < 0.0 else 0.0
            if setpoint.velocity < fastest:
                setpoint.velocity = fastest
        start = self.start_position = setpoint.position
        self.start_velocity = setpoint.velocity
        if self.mode is _VELOCITY:
            # A velocity command moves towards the joint's limit at that speed.
            speed = abs(self._velocity)
            target = self.joint.upper if self._velocity > 0.0 else self.joint.lower
            target_velocity = 0.0
        else:
            # HOLD moves to the point where the joint could stop when the mode began.
            stream = self._stream
            stream.advance()
            target, target_velocity, speed = stream.target, stream.velocity, self._speed
            if target == start and not target_velocity and not setpoint.velocity:
                return False
            if self._rate_per_s and self.mode is _POSITION:
                target_velocity, speed = 0.0, self._proportional_speed(target)
        # As `budget`: a call for every joint in every tick would cost more than the rest.
        left = self._strength - (gravity if gravity > 0.0 else -gravity)
        if left < self._least:
            left = self._least
        acceleration = EFFORT_SHARE * left / inertia
        braking, jerkless = self.part * acceleration, self._jerkless
        if braking > jerkless:
            braking = jerkless
        if braking < self._floor:
            braking = self._floor
        if acceleration > jerkless:
            acceleration = jerkless
        if acceleration < self.sure_braking:
            acceleration = self.sure_braking
        self.braking = braking
        setpoint.approach(target, target_velocity, speed, acceleration, braking, self._period_s)
        return setpoint.velocity != 0.0 or setpoint.position != start

    def _proportional_speed(self, target: float) -> float:
        """Return the velocity limit at which the distance to the target decays exponentially.

        The velocity at the end of the period is the rate times the distance at its end, so the
        time constant is 1 / rate at every control period.
        """
        setpoint, half_s = self.setpoint, 0.5 * self._period_s
        distance = abs(target - setpoint.position) - half_s * abs(setpoint.velocity)
        speed = self._rate_per_s * distance / (1.0 + self._rate_per_s * half_s)
        # At the end of the decay the set-point lands, so that the drive can sleep.
        return min(speed, self._speed) if speed > LANDING_SPEED else self._speed

    def scale_acceleration(self, share: float) -> None:
        """Reduce the speed that the set-point gains in this period to this fraction of it."""
        gain = self.setpoint.velocity - self.start_velocity
        if gain * self.setpoint.velocity > 0:
            self.setpoint.velocity = self.start_velocity + share * gain
            mean = 0.5 * (self.start_velocity + self.setpoint.velocity)
            self.setpoint.position = self.start_position + mean * self._period_s
