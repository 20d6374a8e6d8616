"""The way of the arm to one pose: whether it is there, whether it can be there in time."""

from collections.abc import Mapping

from arm_controller.joint_limits import JointLimits
from arm_controller.pose import JointPose


class Approach:
    """One pose from its publication on. Times are of the clock in use (s).

    Args:
        pose: where the joints shall go.
        limits: the joints' ranges and speeds.
        start: position by joint name at the moment of publication, as far as known.
        started_s: that moment.
        tolerance: how near (rad or m) each joint must come.
        timeout_s: how long it may take.
    """

    def __init__(
        self,
        pose: JointPose,
        limits: JointLimits,
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
        """Return the time since the start; a clock that was set back starts it anew."""
        self._started_s = min(self._started_s, now_s)
        return now_s - self._started_s

    def is_late(self, now_s: float) -> bool:
        """Return whether the time-out has passed."""
        return self.elapsed_s(now_s) >= self._timeout_s

    def is_reached(self, positions: Mapping[str, float]) -> bool:
        """Return whether every joint is known to be within the tolerance."""
        return all(
            name in positions and abs(positions[name] - goal) <= self._tolerance
            for name, goal in self._goals()
        )

    def forecast(self) -> str | None:
        """Return a sentence if the joints' top speed makes the time-out impossible to keep."""
        name, needed_s = self._limits.shortest_move_s(self._start, self.pose)
        if needed_s <= self._timeout_s:
            return None
        joint = self._limits.range_of(name)
        return (
            f"joint '{name}' needs at least {needed_s:.1f} s at its velocity limit of "
            f"{joint.velocity:g} {joint.unit}/s, and the time-out is {self._timeout_s:g} s "
            "(parameter timeout)"
        )

    def shortfall(self, positions: Mapping[str, float]) -> str:
        """Return a sentence on why the pose counts as not reached."""
        missing = [name for name, _ in self._goals() if name not in positions]
        if missing and not positions:
            return "/joint_states is silent: is the joint_state_broadcaster active?"
        if missing:
            existing = ", ".join(sorted(positions))
            return f"no joint '{missing[0]}' in /joint_states, which has {existing}"
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
        blame = "something is in its way or another node commands the arm"
        if needed_s == 0.0:
            return blame
        return f"at its velocity limit joint '{name}' takes {needed_s:.1f} s only, so {blame}"

    def _goals(self) -> list[tuple[str, float]]:
        return list(zip(self.pose.joint_names, self.pose.positions, strict=True))
