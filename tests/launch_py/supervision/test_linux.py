import time

import pytest
from run_python import run_python

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


def test_a_stopped_child_has_not_ended_and_an_ended_child_stays_to_be_reaped():
    answers = run_python("-c", CHILDREN, check=True).stdout.splitlines()
    assert answers == ["without children False", "stopped False", "ended True True", "reaped False"]


ADOPTED = """
import os, subprocess, sys
from launch_py.supervision import linux

os.setsid()
linux.become_subreaper()
own = [subprocess.Popen(["sleep", "60"], start_new_session=led) for led in (False, True)]
leave_one = "sleep 60 >/dev/null & echo $!"
orphan = int(subprocess.check_output(["sh", "-c", leave_one], start_new_session=True))
print(set(linux.children()) == {orphan, *(child.pid for child in own)})
print(linux.adopted_children() == [orphan])
os.kill(orphan, 9)
os.waitid(os.P_PID, orphan, os.WEXITED | os.WNOWAIT)
print(linux.adopted_children() == [orphan])
for child in own:
    child.kill()
"""


def test_orphans_are_told_from_this_process_s_own_children():
    done = run_python("-c", ADOPTED)
    assert done.stdout.split() == ["True"] * 3, done.stderr


START = """
import sys, time
entered_s = time.monotonic()
from launch_py.supervision import linux
linux.LONGEST_INTERPRETER_START_S = float(sys.argv[1])
print(entered_s, linux.start_of_program(entered_s))
"""


@pytest.mark.parametrize("longest_s", [1000.0, 0.0])
def test_a_program_started_with_its_process_unless_it_was_exec_d(longest_s):
    before_s = time.monotonic()
    answer = run_python("-c", START, str(longest_s)).stdout
    entered_s, start_s = map(float, answer.split())
    if longest_s:
        # The kernel reports the start of a process in steps of 10 ms.
        assert before_s - 0.02 <= start_s < entered_s
    else:
        assert start_s == entered_s
