"""What draws the cameras' pictures?"""

from collections.abc import Mapping
from dataclasses import dataclass

from arm_cli.doctor.finding import Finding
from arm_cli.doctor.trial import try_python

NAME = "rendering"
PROBE = "arm_gazebo.rendering.backend_probe"
RAYCAST = "raycast"
FIX = "apt install libegl1 libgl1-mesa-dri (or libosmesa6)"


@dataclass(frozen=True, slots=True)
class Rendering:
    """Draws one picture in a child process, as the camera process would."""

    environ: Mapping[str, str]

    def examine(self) -> Finding:
        """Let the child choose a backend; one that fails there is left out, as with cameras."""
        failed: list[str] = []
        while True:
            trial = try_python(["-m", PROBE, *failed], {**self.environ, "MUJOCO_GL": "off"})
            tried = trial.out.split()
            if trial.worked and tried:
                return self._found(tried[-1], failed, trial.complaint)
            if not tried or tried[-1] in (*failed, RAYCAST):
                return Finding.error(
                    NAME,
                    f"no picture can be drawn: {trial.complaint}",
                    "pip install . from the arm suite's folder; without cameras: camera:=none",
                )
            failed.append(tried[-1])

    def _found(self, backend: str, failed: list[str], complaint: str) -> Finding:
        if backend == RAYCAST:
            why = f"{', '.join(failed)} failed" if failed else complaint
            return Finding.warning(
                NAME, f"no OpenGL: pictures are ray-cast, slower and plainer ({why})", FIX
            )
        return Finding.ok(NAME, f"a picture was drawn with {backend}")
