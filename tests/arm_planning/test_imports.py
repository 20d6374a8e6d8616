"""What reading plans and scenes does not import."""

from run_python import run_python

SCRIPT = """
import sys
from arm_planning import PlanningScene
assert "mujoco" not in sys.modules
from arm_planning import Planner
print(Planner.__name__)
"""


def test_a_program_that_only_reads_scenes_does_not_import_mujoco():
    done = run_python("-c", SCRIPT)
    assert (done.stdout, done.stderr) == ("Planner\n", "")
