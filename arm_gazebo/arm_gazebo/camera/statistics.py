"""How well a camera keeps up, counted over a window."""

import threading
from dataclasses import dataclass

from arm_gazebo.feed.schedule import FrameDue


@dataclass(frozen=True, slots=True)
class CameraReport:
    """One window's figures of a camera.

    Attributes:
        achieved: share of the wanted frames that were rendered, 0..1; None if none was wanted.
        rendered: frames rendered since the start.
        dropped: frames since the start that were due and lost for want of time.
        render_s: mean time to render one, in s; None if none was rendered.
    """

    achieved: float | None
    rendered: int
    dropped: int
    render_s: float | None


class CameraStatistics:
    """Counts one camera's frames. Any thread."""

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._last: FrameDue | None = None
        self._rendered = 0
        self._dropped = 0
        self._start_window()

    def count_due(self, frame: FrameDue, wanted: bool) -> None:
        """Count a frame that arrived, and those lost before it."""
        with self._lock:
            last, self._last = self._last, frame
            steps = 1
            if last is not None:
                self._dropped += max(frame.serial - last.serial - 1, 0)
                # Time that jumped back makes the difference negative.
                steps = max(frame.number - last.number, 1)
            if wanted:
                self._window_wanted += steps

    def count_rendered(self, duration_s: float) -> None:
        """Count a rendered frame."""
        with self._lock:
            self._rendered += 1
            self._window_rendered += 1
            self._window_render_s += duration_s

    def report(self) -> CameraReport:
        """Return the figures and start a new window."""
        with self._lock:
            wanted, rendered = self._window_wanted, self._window_rendered
            report = CameraReport(
                achieved=min(rendered / wanted, 1.0) if wanted else None,
                rendered=self._rendered,
                dropped=self._dropped,
                render_s=self._window_render_s / rendered if rendered else None,
            )
            self._start_window()
        return report

    def _start_window(self) -> None:
        self._window_wanted = 0
        self._window_rendered = 0
        self._window_render_s = 0.0
