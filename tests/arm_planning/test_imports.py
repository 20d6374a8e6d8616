"""What reading plans and scenes does not import."""

import subprocess
import sys

SCRIPT = """
import sys
from arm_planning import PlanningScene
assert "mujoco" not in sys.modules
from arm_planning import Planner
print(Planner.__name__)
"""


def test_a_program_that_only_reads_scenes_does_not_import_mujoco():
    done = subprocess.run([sys.executable, "-c", SCRIPT], capture_output=True, text=True)
    assert (done.stdout, done.stderr) == ("Planner\n", "")
