"""One driven joint: its mode, its command and the set-point that comes of them."""

from arm_gazebo.drives.command_stream import CommandStream
from arm_gazebo.drives.mode import SERVOED, DriveMode
from arm_gazebo.drives.servo_tuning import EFFORT_SHARE, MotionBounds
from arm_gazebo.drives.setpoint import Setpoint
from arm_gazebo.robot.joint import RobotJoint


class DrivenJoint:
    """The planning half of a servo; `Servo` owns the physics half. rad or m, N m or N.

    Attributes:
        joint: what the model says about the joint.
        mode: how it is driven.
        effort: commanded effort, in the mode EFFORT.
        effort_limit: what the drive may spend now, at most the joint's own limit.
        setpoint: where the joint is to be at the end of the current control period.
        start_position: where the set-point was at its start.
        start_velocity: its velocity then.
    """

    __slots__ = (
        "_bounds",
        "_braking",
        "_jerkless",
        "_period_s",
        "_slack",
        "_speed",
        "_stream",
        "_velocity",
        "effort",
        "effort_limit",
        "joint",
        "mode",
        "setpoint",
        "start_position",
        "start_velocity",
    )

    def __init__(self, joint: RobotJoint, bounds: MotionBounds, period_s: float) -> None:
        self.joint = joint
        self.mode = DriveMode.LIMP
        self.effort = 0.0
        self.setpoint = Setpoint(joint.initial)
        self.start_position = joint.initial
        self.start_velocity = 0.0
        # Looked up in every tick, so copied out of their classes.
        self._speed = joint.velocity
        self._jerkless = bounds.jerkless
        self._slack = bounds.slack
        self._bounds = bounds
        self.limit_effort(joint.effort, 1.0)
        self._period_s = period_s
        self._stream = CommandStream(joint.initial, period_s)
        self._velocity = 0.0

    def limit_effort(self, limit: float, share: float) -> None:
        """Plan with less effort than the joint's own limit.

        Args:
            limit: what may be spent, N m or N.
            share: how much of its usual braking the joint can still have.
        """
        self.effort_limit = limit
        self._braking = share * self._bounds.braking

    def enter(self, mode: DriveMode, position: float, velocity: float) -> None:
        """Change the mode; a set-point starts from the state of the joint if it had none."""
        if self.mode not in SERVOED:
            speed = self.joint.velocity_limit
            self.setpoint = Setpoint(position, min(max(velocity, -speed), speed))
        self.mode = mode
        self.effort = 0.0
        self._velocity = 0.0
        self._stream = CommandStream(self.stopping_point(), self._period_s)

    def stopping_point(self) -> float:
        """Return where the joint will stand if nothing new is commanded, within its limits."""
        point = self.setpoint.stopping_point(self._braking)
        return min(max(point, self.joint.lower), self.joint.upper)

    def command(self, value: float, tick: int) -> None:
        """Take a command in the unit of the mode; HOLD and LIMP take none."""
        if self.mode is DriveMode.POSITION:
            self._stream.command(value, tick)
        elif self.mode is DriveMode.VELOCITY:
            self._velocity = value
        elif self.mode is DriveMode.EFFORT:
            self.effort = value

    def plan(self, position: float, velocity: float, inertia: float, gravity: float) -> bool:
        """Move the set-point on by one control period; return whether it moves.

        Args:
            position: of the joint, now.
            velocity: of the joint, now.
            inertia: that it feels in this pose.
            gravity: effort that it needs in this pose to stay as it moves.
        """
        setpoint = self.setpoint
        lead = setpoint.position - position
        slack = self._slack
        # Something holds the joint or drags it. A set-point that ran on would fling it, once free;
        # but one that the joint merely ran ahead of between two ticks keeps its speed.
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
        if self.mode is DriveMode.VELOCITY:
            # A velocity is a way to the limit of the joint at that speed.
            speed = abs(self._velocity)
            target = self.joint.upper if self._velocity > 0.0 else self.joint.lower
            target_velocity = 0.0
        else:
            # Holding is going to where the joint could stop when it was told to.
            stream = self._stream
            stream.advance()
            target, target_velocity, speed = stream.target, stream.velocity, self._speed
            if target == start and not target_velocity and not setpoint.velocity:
                return False
        acceleration = EFFORT_SHARE * (self.effort_limit - abs(gravity)) / inertia
        if acceleration > self._jerkless:
            acceleration = self._jerkless
        if acceleration < self._braking:
            acceleration = self._braking
        setpoint.approach(
            target, target_velocity, speed, acceleration, self._braking, self._period_s
        )
        return setpoint.velocity != 0.0 or setpoint.position != start

    def gain_less(self, share: float) -> None:
        """Let the set-point gain only this share of the speed it was to gain in this period."""
        gain = self.setpoint.velocity - self.start_velocity
        if gain * self.setpoint.velocity > 0:
            self.setpoint.velocity = self.start_velocity + share * gain
            mean = 0.5 * (self.start_velocity + self.setpoint.velocity)
            self.setpoint.position = self.start_position + mean * self._period_s
