"""Where frames were that move in each other, at any of the last instants."""

from bisect import bisect_left
from collections import deque
from dataclasses import dataclass, field
from math import hypot

from arm_node.rigid_transform import RigidTransform

KEPT = 200
"""Poses of a frame that are remembered: 10 s at robot_state_publisher's rate."""


@dataclass(frozen=True, slots=True)
class TransformHistory:
    """The last poses of frames in their parents. For one thread at a time."""

    _known: dict[str, deque[tuple[int, str, RigidTransform]]] = field(default_factory=dict)

    def add(self, child: str, parent: str, pose: RigidTransform, stamp_ns: int) -> None:
        """Take a pose; one that is older than the last starts anew, as after a reset."""
        known = self._known.setdefault(child, deque(maxlen=KEPT))
        if known and stamp_ns < known[-1][0]:
            known.clear()
        known.append((stamp_ns, parent, pose))

    def add_static(self, child: str, parent: str, pose: RigidTransform) -> None:
        """Take a pose that holds at all times."""
        self._known[child] = deque([(0, parent, pose)], maxlen=KEPT)

    def pose(self, name: str, base: str, stamp_ns: int | None = None) -> RigidTransform | None:
        """Return a frame's pose in another one; None if no transforms connect them.

        Args:
            name: the frame.
            base: the other one.
            stamp_ns: when: between two poses it is interpolated, beyond them the nearest holds;
                None for the last.
        """
        ours, theirs = self._in_root(base, stamp_ns), self._in_root(name, stamp_ns)
        if ours[0] != theirs[0]:
            return None
        return ours[1].inverse().then(theirs[1])

    def _in_root(self, name: str, stamp_ns: int | None) -> tuple[str, RigidTransform]:
        """Return the root above a frame, and the frame's pose in it."""
        pose, passed = RigidTransform(), {name}
        while name in self._known:
            name, step = self._step(name, stamp_ns)
            pose = step.then(pose)
            if name in passed:
                break
            passed.add(name)
        return name, pose

    def _step(self, name: str, stamp_ns: int | None) -> tuple[str, RigidTransform]:
        """Return a frame's parent, and its pose in it."""
        known = self._known[name]
        if stamp_ns is None or stamp_ns >= known[-1][0]:
            return known[-1][1:]
        index = bisect_left(known, stamp_ns, key=lambda each: each[0])
        after_ns, parent, after = known[index]
        if index == 0 or known[index - 1][1] != parent:
            return parent, after
        before_ns, _, before = known[index - 1]
        return parent, _between(before, after, (stamp_ns - before_ns) / (after_ns - before_ns))


def _between(before: RigidTransform, after: RigidTransform, share: float) -> RigidTransform:
    """Return the pose at a share of the way; the turn is small, so linear does for it, too."""
    turned = sum(a * b for a, b in zip(before.rotation, after.rotation, strict=True))
    sign = 1.0 if turned >= 0 else -1.0
    x, y, z, w = (
        a + share * (sign * b - a) for a, b in zip(before.rotation, after.rotation, strict=True)
    )
    length = hypot(x, y, z, w) or 1.0
    px, py, pz = (a + share * (b - a) for a, b in zip(before.position, after.position, strict=True))
    return RigidTransform((px, py, pz), (x / length, y / length, z / length, w / length))
