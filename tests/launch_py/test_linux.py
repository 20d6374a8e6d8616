import subprocess
import sys

CHILDREN = """
import os, signal, subprocess
from launch_py.supervision import linux

print("without children", linux.child_has_ended())
child = subprocess.Popen(["sleep", "60"])
os.kill(child.pid, signal.SIGSTOP)
os.waitid(os.P_PID, child.pid, os.WSTOPPED | os.WNOWAIT)
print("stopped", linux.child_has_ended())
child.kill()
os.waitid(os.P_PID, child.pid, os.WEXITED | os.WNOWAIT)
print("ended", linux.child_has_ended(), linux.child_has_ended())
linux.reap([child.pid])
print("reaped", linux.child_has_ended())
"""


def test_a_child_that_stops_has_not_ended_and_one_that_ended_is_left_to_be_reaped():
    answers = subprocess.run(
        [sys.executable, "-c", CHILDREN], capture_output=True, text=True, check=True, timeout=60
    ).stdout.splitlines()
    assert answers == ["without children False", "stopped False", "ended True True", "reaped False"]
