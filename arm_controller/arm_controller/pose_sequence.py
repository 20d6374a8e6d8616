"""Goes through poses: publishes one, waits until it is reached, and goes on with the next."""

from collections.abc import Mapping, Sequence
from math import isfinite

from arm_controller.joint_pose import JointPose, PoseLimits


class Approach:
    """The movement to one pose after its publication. Times are from the clock in use (s).

    Args:
        pose: the goal of the joints.
        limits: the joints' ranges and speeds.
        start: known positions by joint name at the publication.
        started_s: time of the publication.
        tolerance: how close (rad or m) each joint must come.
        timeout_s: how long it may take.
    """

    def __init__(
        self,
        pose: JointPose,
        limits: PoseLimits,
        start: Mapping[str, float],
        started_s: float,
        *,
        tolerance: float,
        timeout_s: float,
    ) -> None:
        self.pose = pose
        self._limits = limits
        self._start = dict(start)
        self._started_s = started_s
        self._tolerance = tolerance
        self._timeout_s = timeout_s

    def elapsed_s(self, now_s: float) -> float:
        """Return the time since the start; setting the clock back restarts it."""
        self._started_s = min(self._started_s, now_s)
        return now_s - self._started_s

    def is_late(self, now_s: float) -> bool:
        """Return whether the timeout has passed."""
        return self.elapsed_s(now_s) >= self._timeout_s

    def is_reached(self, positions: Mapping[str, float]) -> bool:
        """Return whether every joint is known to be within the tolerance."""
        return all(
            name in positions and abs(positions[name] - goal) <= self._tolerance
            for name, goal in self._goals()
        )

    def forecast(self) -> str | None:
        """Return a sentence if the joints are too slow to reach the pose within the timeout."""
        name, needed_s = self._limits.shortest_move_s(self._start, self.pose)
        if needed_s <= self._timeout_s:
            return None
        joint = self._limits.range_of(name)
        return (
            f"joint '{name}' needs at least {needed_s:.1f} s at its velocity limit of "
            f"{joint.velocity:g} {joint.unit}/s, and the timeout is {self._timeout_s:g} s "
            "(parameter timeout)"
        )

    def shortfall(self, positions: Mapping[str, float]) -> str:
        """Return a sentence on why the pose was not reached."""
        missing = [name for name, _ in self._goals() if name not in positions]
        if missing and not positions:
            return "/joint_states is silent: is the joint_state_broadcaster active?"
        if missing:
            existing = ", ".join(sorted(positions))
            return f"no joint '{missing[0]}' in /joint_states, which has {existing}"
        unknown = [name for name, _ in self._goals() if not isfinite(positions[name])]
        if unknown:
            return f"the position of joint '{unknown[0]}' in /joint_states is not a number"
        error, name, goal = max(
            (abs(positions[name] - goal), name, goal) for name, goal in self._goals()
        )
        unit = self._limits.range_of(name).unit
        return (
            f"joint '{name}' is at {positions[name]:.4f}, {error:.4f} {unit} from {goal:.4f} "
            f"(tolerance {self._tolerance:g}); {self.forecast() or self._suspicion()}"
        )

    def _suspicion(self) -> str:
        name, needed_s = self._limits.shortest_move_s(self._start, self.pose)
        cause = "something is in its way or another node commands the arm"
        if needed_s == 0.0:
            return cause
        return f"at its velocity limit joint '{name}' needs only {needed_s:.1f} s, so {cause}"

    def _goals(self) -> list[tuple[str, float]]:
        return list(zip(self.pose.joint_names, self.pose.positions, strict=True))


class PoseSequence:
    """The logic of publisher_defined without ROS: the node reports events and logs the answers.

    Times are from the clock in use (s). A pose that is refused or not reached is counted, and the
    next one follows.

    Args:
        poses: the poses, in order.
        tolerance: how close (rad or m) each joint must come.
        timeout_s: how long one pose may take.
        pause_s: shortest time between the publications of two poses.
    """

    def __init__(
        self,
        poses: Sequence[JointPose],
        *,
        tolerance: float,
        timeout_s: float,
        pause_s: float = 0.0,
    ) -> None:
        self._poses = tuple(poses)
        self._tolerance = tolerance
        self._timeout_s = timeout_s
        self._pause_s = pause_s
        self._begun_s: float | None = None
        self._index = 0
        self._approach: Approach | None = None
        self._missed = 0

    @property
    def finished(self) -> bool:
        """Whether no pose is left."""
        return self._index >= len(self._poses)

    @property
    def count(self) -> int:
        """How many poses there are."""
        return len(self._poses)

    @property
    def missed(self) -> int:
        """How many poses were not reached."""
        return self._missed

    @property
    def waiting_pose(self) -> JointPose | None:
        """The pose to publish next; None during a movement and at the end."""
        return None if self._approach or self.finished else self._poses[self._index]

    def is_pausing(self, now_s: float) -> bool:
        """Return whether it is too early to publish the waiting pose."""
        if self._begun_s is None:
            return False
        self._begun_s = min(self._begun_s, now_s)  # A simulation's clock may be set back.
        return now_s - self._begun_s < self._pause_s

    @property
    def label(self) -> str:
        """The current pose, for messages: 'Pose 2 of 5'."""
        return f"Pose {self._index + 1} of {len(self._poses)}"

    def refuse(self) -> None:
        """Skip the waiting pose, which exceeds the robot's limits."""
        self._next(missed=True)

    def begin(self, limits: PoseLimits, positions: Mapping[str, float], now_s: float) -> Approach:
        """Record that the waiting pose is published now; return its approach."""
        self._begun_s = now_s
        self._approach = Approach(
            self._poses[self._index],
            limits,
            positions,
            now_s,
            tolerance=self._tolerance,
            timeout_s=self._timeout_s,
        )
        return self._approach

    def on_positions(self, positions: Mapping[str, float], now_s: float) -> str | None:
        """If these positions reach the current pose, go on to the next and return a message."""
        if self._approach is None or not self._approach.is_reached(positions):
            return None
        said = f"{self.label} reached after {self._approach.elapsed_s(now_s):.1f} s"
        self._next(missed=False)
        return said

    def on_time(self, positions: Mapping[str, float], now_s: float) -> str | None:
        """If the current pose has timed out, go on to the next and return an error."""
        if self._approach is None or not self._approach.is_late(now_s):
            return None
        said = (
            f"{self.label} not reached within {self._timeout_s:g} s: "
            f"{self._approach.shortfall(positions)}"
        )
        self._next(missed=True)
        return said

    def give_up(self) -> None:
        """Count the current pose and the remaining ones as not reached."""
        self._missed += len(self._poses) - self._index
        self._index = len(self._poses)
        self._approach = None

    def _next(self, *, missed: bool) -> None:
        self._missed += missed
        self._index += 1
        self._approach = None
