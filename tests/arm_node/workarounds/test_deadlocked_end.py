"""A process that cannot destroy its nodes ends all the same."""

import subprocess
import sys

import pytest

STUCK = """
import ctypes
from arm_node.workarounds.deadlocked_end import end_after
print("before", flush=True)
end_after(1, {code})
# Waits for ever, and holds Python's lock, as rclpy does.
ctypes.PyDLL(None).pause()
"""


@pytest.mark.parametrize("code", [0, 3])
def test_a_process_that_holds_pythons_lock_for_ever_ends_with_its_exit_code(code):
    done = subprocess.run([sys.executable, "-c", STUCK.format(code=code)], capture_output=True)
    assert (done.returncode, done.stdout, done.stderr) == (code, b"before\n", b"")


LIMITED = """
from arm_node.workarounds import deadlocked_end
deadlocked_end.PATIENCE_S = 1
deadlocked_end.is_on = lambda _: {is_on}
limit = deadlocked_end.DestructionLimit()
limit.start(7)
limit.start(8)
if {cancelled}:
    limit.cancel()
import select
select.select([], [], [], {wait_s})
"""


@pytest.mark.parametrize(
    ("is_on", "cancelled", "wait_s", "code"),
    [(True, False, 100, 7), (True, True, 1.5, 0), (False, False, 1.5, 0)],
)
def test_it_can_be_cancelled_and_switched_off(is_on, cancelled, wait_s, code):
    script = LIMITED.format(is_on=is_on, cancelled=cancelled, wait_s=wait_s)
    assert subprocess.run([sys.executable, "-c", script]).returncode == code
