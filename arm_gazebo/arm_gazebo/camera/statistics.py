"""Count how well a camera keeps its rate."""

import threading
from dataclasses import dataclass

from arm_gazebo.feed.schedule import FrameDue
from arm_gazebo.feed.socket_pair import CameraProgress


@dataclass(frozen=True, slots=True)
class CameraReport:
    """The figures of a camera over one time window.

    Attributes:
        achieved: fraction of the wanted frames that were rendered, 0..1; None if none was wanted.
        rendered: number of frames rendered since the start.
        dropped: number of due frames since the start that were lost for lack of time.
        render_s: mean time in s to render a frame; None if none was rendered.
    """

    achieved: float | None
    rendered: int
    dropped: int
    render_s: float | None


class CameraStatistics:
    """Counts one camera's frames. Any thread."""

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._arrived = -1
        self._last: FrameDue | None = None
        self._rendered = 0
        self._dropped = 0
        self._start_window()

    def count_arrived(self, frame: FrameDue) -> None:
        """Note a frame that may still be passed over for a newer one."""
        with self._lock:
            self._arrived = frame.serial

    def count_due(self, frame: FrameDue, wanted: bool) -> None:
        """Count a frame that arrived, and the frames lost before it."""
        with self._lock:
            last, self._last = self._last, frame
            steps = 1
            if last is not None:
                self._dropped += max(frame.serial - last.serial - 1, 0)
                # The difference is negative if time jumped back.
                steps = max(frame.number - last.number, 1)
            if wanted:
                self._window_wanted += steps

    def count_rendered(self, duration_s: float) -> None:
        """Count a rendered frame."""
        with self._lock:
            self._rendered += 1
            self._window_rendered += 1
            self._window_render_s += duration_s

    def progress(self) -> CameraProgress:
        """Return the figures since the start."""
        with self._lock:
            return CameraProgress(self._arrived, self._rendered, self._dropped)

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
