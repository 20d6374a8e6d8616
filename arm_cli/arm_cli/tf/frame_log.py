"""The coordinate frames received on /tf and /tf_static, and their tree."""

from collections import deque
from collections.abc import Iterator
from dataclasses import dataclass, field

from arm_cli.errors import NoSuchNameError
from arm_node.names import describe_known
from arm_node.rigid_transform import RigidTransform

STATIC_RATE_HZ = 10000.0
"""The rate that tf2's view_frames prints for a static transform."""
_STAMPS_KEPT = 10000


@dataclass(slots=True)
class FrameHistory:
    """A frame's parent, its latest pose in it, and the stamps of its transforms.

    Attributes:
        parent: the name of the parent frame.
        static: whether the latest transform came on /tf_static.
        pose: the latest pose in the parent.
        stamps_s: the stamps of the received transforms, oldest first.
        delays_s: from each stamp to its arrival; empty for a static frame.
    """

    parent: str
    static: bool
    pose: RigidTransform = field(default_factory=RigidTransform)
    stamps_s: deque[float] = field(default_factory=lambda: deque(maxlen=_STAMPS_KEPT))
    delays_s: deque[float] = field(default_factory=lambda: deque(maxlen=_STAMPS_KEPT))

    @property
    def span_s(self) -> float:
        """The time from the oldest to the latest stamp."""
        return self.stamps_s[-1] - self.stamps_s[0]

    @property
    def rate_hz(self) -> float:
        """The average rate, 0 after a single transform."""
        if self.static:
            return STATIC_RATE_HZ
        return (len(self.stamps_s) - 1) / self.span_s if self.span_s > 0 else 0.0


@dataclass(frozen=True, slots=True)
class Lookup:
    """The result of a lookup.

    Attributes:
        pose: the pose of the target frame in the source frame.
        stamp_s: the oldest of the latest stamps on the path; 0 if the whole path is static.
    """

    pose: RigidTransform
    stamp_s: float


class FrameLog:
    """All frames received."""

    def __init__(self) -> None:
        self._frames: dict[str, FrameHistory] = {}

    def add(
        self,
        parent: str,
        child: str,
        stamp_s: float,
        pose: RigidTransform,
        static: bool,
        delay_s: float = 0.0,
    ) -> None:
        """Add a transform. A frame has one parent, and a new parent replaces the old one."""
        parent, child = parent.lstrip("/"), child.lstrip("/")
        history = self._frames.get(child)
        if history is None or history.parent != parent:
            history = self._frames[child] = FrameHistory(parent, static)
        history.static = static
        history.pose = pose
        if history.stamps_s and stamp_s < history.stamps_s[-1]:
            # The clock was set back, as by a reset; tf2 forgets the old time as well.
            history.stamps_s.clear()
            history.delays_s.clear()
        history.stamps_s.append(stamp_s)
        if not static:
            history.delays_s.append(delay_s)

    @property
    def frames(self) -> dict[str, FrameHistory]:
        """The frames that have a parent, by name."""
        return dict(self._frames)

    def names(self) -> list[str]:
        """Return the names of all frames, including roots, sorted."""
        return sorted({*self._frames, *(history.parent for history in self._frames.values())})

    def roots(self) -> list[str]:
        """Return the frames without a parent, sorted."""
        return [name for name in self.names() if name not in self._frames]

    def children(self, parent: str) -> list[str]:
        """Return the child frames of a frame, sorted."""
        return sorted(name for name, history in self._frames.items() if history.parent == parent)

    def lookup(self, source: str, target: str) -> Lookup:
        """Return the pose of the target frame in the source frame.

        Raises:
            NoSuchNameError: there is no such frame, or the two are in different trees.
        """
        up, down = self._ways(source, target)
        pose = self._pose_below(up).inverse().then(self._pose_below(down))
        moving = [h for h in (self._frames[name] for name in (*up, *down)) if not h.static]
        return Lookup(pose, min((h.stamps_s[-1] for h in moving), default=0.0))

    def path(self, source: str, target: str) -> list[str]:
        """Return the frames from one to the other, with both; raises like `lookup`."""
        up, down = self._ways(source, target)
        common = self._frames[up[-1]].parent if up else source
        return [*up, common, *reversed(down)]

    def _ways(self, source: str, target: str) -> tuple[list[str], list[str]]:
        """Return the frames below the common ancestor: those above the source, then the target.

        Raises:
            NoSuchNameError: see `lookup`.
        """
        known = self.names()
        for name in (source, target):
            if name not in known:
                raise NoSuchNameError(f"no frame {name!r}; {describe_known(name, known)}")
        source_line, target_line = self._line(source), self._line(target)
        common = next((name for name in target_line if name in source_line), None)
        if common is None:
            raise NoSuchNameError(
                f"{source!r} and {target!r} are not in the same tree: their roots are "
                f"{source_line[-1]!r} and {target_line[-1]!r}"
            )
        down = target_line[: target_line.index(common)]
        return source_line[: source_line.index(common)], down

    def draw_tree(self) -> Iterator[str]:
        """Yield the lines of the tree, with the roots first."""
        for root in self.roots():
            yield root
            yield from self._branches(root, "", {root})

    def _branches(self, parent: str, indent: str, above: set[str]) -> Iterator[str]:
        children = [name for name in self.children(parent) if name not in above]
        for name in children:
            last = name == children[-1]
            history = self._frames[name]
            how = "static" if history.static else f"{history.rate_hz:.1f} Hz"
            yield f"{indent}{'└── ' if last else '├── '}{name}  ({how})"
            yield from self._branches(name, f"{indent}{'    ' if last else '│   '}", {*above, name})

    def _line(self, name: str) -> list[str]:
        """Return a frame and its ancestors up to the root, or up to a loop."""
        line = [name]
        while name in self._frames and self._frames[name].parent not in line:
            name = self._frames[name].parent
            line.append(name)
        return line

    def _pose_below(self, line: list[str]) -> RigidTransform:
        pose = RigidTransform()
        for name in reversed(line):
            pose = pose.then(self._frames[name].pose)
        return pose
