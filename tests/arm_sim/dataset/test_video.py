"""Videos of equal images are equal, whatever the memory held before."""

import os
import subprocess
import sys

WRITE = """
import sys
from pathlib import Path
import numpy as np
from arm_sim.dataset.video import VideoFile

y, x = np.mgrid[:240, :320]
video = VideoFile(Path(sys.argv[1]), 240, 320, 25)
for k in range(12):
    red = 128 + 100 * np.sin((x + 5 * k) / 17) * np.cos(y / 23)
    green = 128 + 90 * np.sin((y + 4 * k) / 13)
    video.add(np.stack([red, green, (3 * x + 2 * y + 7 * k) % 256], -1).astype(np.uint8))
video.close()
"""
FILLINGS = ("0", "1", "85")
"""What the C library fills new memory with, and memory that is freed; 0 leaves it as it was."""


def test_what_memory_held_before_changes_no_byte(tmp_path):
    written = []
    for filling in FILLINGS:
        path = tmp_path / f"{filling}.mp4"
        subprocess.run(
            [sys.executable, "-c", WRITE, path],
            env={**os.environ, "MALLOC_PERTURB_": filling},
            check=True,
        )
        written.append(path.read_bytes())
    assert len(written[0]) > 10_000
    assert written[0] == written[1] == written[2]
