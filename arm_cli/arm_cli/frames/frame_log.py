"""What has been heard of each frame, and the tree that the frames form."""

from collections import deque
from collections.abc import Iterator
from dataclasses import dataclass, field

from arm_cli.errors import NotFoundError
from arm_cli.frames.pose import Pose
from launch_py.near_names import describe_known

STATIC_RATE_HZ = 10000.0
"""What the original prints for a static transform."""

_STAMPS_KEPT = 10000


@dataclass(slots=True)
class FrameHistory:
    """One frame: its parent, its latest pose in it, and when that was told.

    Attributes:
        parent: name of the parent frame.
        static: whether it came on /tf_static.
        pose: in the parent.
        stamps_s: of the transforms heard, oldest first.
    """

    parent: str
    static: bool
    pose: Pose = field(default_factory=Pose)
    stamps_s: deque[float] = field(default_factory=lambda: deque(maxlen=_STAMPS_KEPT))

    @property
    def span_s(self) -> float:
        """Time from the oldest to the latest stamp."""
        return self.stamps_s[-1] - self.stamps_s[0]

    @property
    def rate_hz(self) -> float:
        """Average rate, 0 after a single transform."""
        if self.static:
            return STATIC_RATE_HZ
        return (len(self.stamps_s) - 1) / self.span_s if self.span_s > 0 else 0.0


@dataclass(frozen=True, slots=True)
class Lookup:
    """Where one frame is in another.

    Attributes:
        pose: of the target in the source.
        stamp_s: the oldest of the latest stamps on the way; 0 where all is static.
    """

    pose: Pose
    stamp_s: float


class FrameLog:
    """All frames heard of."""

    def __init__(self) -> None:
        self._frames: dict[str, FrameHistory] = {}

    def add(self, parent: str, child: str, stamp_s: float, pose: Pose, static: bool) -> None:
        """Take a transform. A frame has one parent: a new one replaces the old."""
        parent, child = parent.lstrip("/"), child.lstrip("/")
        history = self._frames.get(child)
        if history is None or history.parent != parent:
            history = self._frames[child] = FrameHistory(parent, static)
        history.static = static
        history.pose = pose
        history.stamps_s.append(stamp_s)

    @property
    def frames(self) -> dict[str, FrameHistory]:
        """What is known of each frame that has a parent, by name."""
        return dict(self._frames)

    def names(self) -> list[str]:
        """Return the names of all frames, sorted; roots, too."""
        return sorted({*self._frames, *(history.parent for history in self._frames.values())})

    def roots(self) -> list[str]:
        """Return the frames without a parent, sorted."""
        return [name for name in self.names() if name not in self._frames]

    def children(self, parent: str) -> list[str]:
        """Return the frames that hang on a frame, sorted."""
        return sorted(name for name, history in self._frames.items() if history.parent == parent)

    def lookup(self, source: str, target: str) -> Lookup:
        """Return where the target frame is in the source frame.

        Raises:
            NotFoundError: no such frame, or the two are in different trees.
        """
        known = self.names()
        for name in (source, target):
            if name not in known:
                raise NotFoundError(f"no frame {name!r}; {describe_known(name, known)}")
        source_line, target_line = self._line(source), self._line(target)
        common = next((name for name in target_line if name in source_line), None)
        if common is None:
            raise NotFoundError(
                f"{source!r} and {target!r} are not in one tree: they hang on "
                f"{source_line[-1]!r} and {target_line[-1]!r}"
            )
        down = target_line[: target_line.index(common)]
        up = source_line[: source_line.index(common)]
        pose = self._pose_below(up).inverse().then(self._pose_below(down))
        moving = [h for h in (self._frames[name] for name in (*up, *down)) if not h.static]
        return Lookup(pose, min((h.stamps_s[-1] for h in moving), default=0.0))

    def draw_tree(self) -> Iterator[str]:
        """Yield the tree in lines, roots first."""
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
        """Return a frame and those above it, up to the root; a loop ends it, too."""
        line = [name]
        while name in self._frames and self._frames[name].parent not in line:
            name = self._frames[name].parent
            line.append(name)
        return line

    def _pose_below(self, line: list[str]) -> Pose:
        pose = Pose()
        for name in reversed(line):
            pose = pose.then(self._frames[name].pose)
        return pose
