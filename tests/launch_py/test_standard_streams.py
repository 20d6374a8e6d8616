"""Output of libraries does not mix with a command's output."""

import subprocess
import sys

import pytest

BOTH = """
import os
from launch_py.standard_streams import library_output_on_stderr

print("before")
with library_output_on_stderr():
    print("mine")
    os.write(1, b"theirs\\n")
    {end}
os.write(1, b"after\\n")
"""


def run(end: str = "pass", **options):
    words = [sys.executable, "-c", BOTH.format(end=end)]
    return subprocess.run(words, capture_output=True, text=True, check=False, **options)


def test_stdout_is_reserved_for_python():
    done = run()
    assert done.stdout.split() == ["before", "mine", "after"]
    assert done.stderr == "theirs\n"


@pytest.mark.parametrize("end", ["raise SystemExit(3)", "1 / 0"])
def test_an_exception_in_the_context_loses_no_output(end):
    done = run(end)
    assert done.stdout.split() == ["before", "mine"]
    assert done.stderr.startswith("theirs\n")
    assert done.returncode == (3 if "Exit" in end else 1)


def test_a_captured_stdout_stays_captured(capsys):
    from launch_py.standard_streams import library_output_on_stderr

    with library_output_on_stderr():
        print("mine")
    print("after")
    assert capsys.readouterr().out == "mine\nafter\n"


def test_a_closed_pipe_raises_as_usual():
    code = (
        "import sys\n"
        "from arm_cli import main, verbs\n"
        "from launch_py.standard_streams import library_output_on_stderr\n"
        "class Talk:\n"
        "    def run(self, *_):\n"
        "        with library_output_on_stderr():\n"
        "            while True:\n"
        "                print('on and on')\n"
        "verbs.ARM = Talk()\n"
        "sys.exit(main.main(['talk']))\n"
    )
    line = '"$0" -c "$1" | head -1; echo ${PIPESTATUS[0]}'
    words = ["/bin/bash", "-c", line, sys.executable, code]
    done = subprocess.run(words, capture_output=True, text=True, check=False, timeout=60)
    assert (done.stdout, done.stderr) == ("on and on\n141\n", "")
