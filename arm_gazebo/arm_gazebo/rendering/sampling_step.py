"""How closely the first rays of a picture lie: as close as the machine can afford."""

FIRST_SAMPLES = 45_000
"""Most first rays of the first picture; later ones go by how long it took."""
LARGEST_STEP = 8
AVERAGED_FRAMES = 10
AFFORDABLE = 0.8
"""Share of the time between two frames that drawing one may take."""
FINER_COST = 4.0
"""Half the step means at most so many times the rays."""


class SamplingStep:
    """Distance of the first rays in pixels, a power of two, for one camera.

    Attributes:
        step: the distance for the next picture.
    """

    def __init__(self, width: int, height: int, rate_hz: float) -> None:
        self.step = 1
        while self.step < LARGEST_STEP and width * height > FIRST_SAMPLES * self.step**2:
            self.step *= 2
        self._affordable_s = AFFORDABLE / rate_hz
        self._start_average()

    def note(self, duration_s: float) -> None:
        """Take into account how long a picture took to draw, in s."""
        self._sum_s += duration_s
        self._count += 1
        if self._count < AVERAGED_FRAMES:
            return
        mean_s = self._sum_s / self._count
        if mean_s > self._affordable_s and self.step < LARGEST_STEP:
            self.step *= 2
        elif mean_s * FINER_COST < self._affordable_s and self.step > 1:
            self.step //= 2
        self._start_average()

    def _start_average(self) -> None:
        self._sum_s = 0.0
        self._count = 0
