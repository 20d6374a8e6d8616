"""Goes through poses one after the other: publish, wait until reached, next."""

from collections.abc import Mapping, Sequence

from arm_controller.approach import Approach
from arm_controller.joint_limits import JointLimits
from arm_controller.pose import JointPose


class PoseSequence:
    """What publisher_defined does, without ROS: the node tells what happens and says the rest.

    Times are of the clock in use (s). A pose that is refused or not reached is counted, and the
    next one has its turn.

    Args:
        poses: where to go, in order.
        tolerance: how near (rad or m) each joint must come.
        timeout_s: how long one pose may take.
    """

    def __init__(self, poses: Sequence[JointPose], *, tolerance: float, timeout_s: float) -> None:
        self._poses = tuple(poses)
        self._tolerance = tolerance
        self._timeout_s = timeout_s
        self._index = 0
        self._approach: Approach | None = None
        self._missed = 0

    @property
    def finished(self) -> bool:
        """Whether every pose has had its turn."""
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
        """The pose that must be published next; None while one is under way and at the end."""
        return None if self._approach or self.finished else self._poses[self._index]

    @property
    def label(self) -> str:
        """Which pose it is: 'Pose 2 of 5'."""
        return f"Pose {self._index + 1} of {len(self._poses)}"

    def refuse(self) -> None:
        """Pass over the waiting pose, which the robot cannot take."""
        self._next(missed=True)

    def begin(self, limits: JointLimits, positions: Mapping[str, float], now_s: float) -> Approach:
        """Note that the waiting pose has been published now; return its approach."""
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
        """Take in a new joint state; return what to say if it completes the pose."""
        if self._approach is None or not self._approach.is_reached(positions):
            return None
        said = f"{self.label} reached after {self._approach.elapsed_s(now_s):.1f} s"
        self._next(missed=False)
        return said

    def on_time(self, positions: Mapping[str, float], now_s: float) -> str | None:
        """Take in the time; return what to say if the pose under way has run out of it."""
        if self._approach is None or not self._approach.is_late(now_s):
            return None
        said = (
            f"{self.label} not reached within {self._timeout_s:g} s: "
            f"{self._approach.shortfall(positions)}"
        )
        self._next(missed=True)
        return said

    def give_up(self) -> None:
        """Count the pose under way and all that are left as not reached."""
        self._missed += len(self._poses) - self._index
        self._index = len(self._poses)
        self._approach = None

    def _next(self, *, missed: bool) -> None:
        self._missed += missed
        self._index += 1
        self._approach = None
