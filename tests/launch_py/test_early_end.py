"""An end that comes before anything runs: in a launch file, in a process that still imports."""

import os
import signal
import subprocess

import pytest

from launch_py.packages import ConsoleScript

TIMEOUT_S = 30.0


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM, signal.SIGHUP])
def test_an_end_while_the_launch_file_is_read_is_none_with_a_traceback(launch, number):
    launched = launch("print('reading', flush=True); import signal; signal.pause(); actions = []")
    launched.wait_for("reading")
    launched.signal(number)
    assert launched.wait() == 0
    assert launched.lines[-1].endswith(": stopped before anything was started")
    assert "Traceback" not in launched.output


@pytest.mark.parametrize("makes", ["raise ImportError('IMPORTANT')", "pass"])
@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_an_end_of_which_other_code_makes_something_else_is_an_end(launch, number, makes):
    launched = launch(f"""
        import signal
        try:
            print('importing', flush=True)
            signal.pause()
        except KeyboardInterrupt:
            {makes}
        actions = [forever('a')]
        """)
    launched.wait_for("importing")
    launched.signal(number)
    assert launched.wait() == 0
    assert launched.lines[1:] == ["launch_py: stopped before anything was started"]


def test_a_listing_that_is_interrupted_is_no_success(launch):
    launched = launch(
        "print('reading', flush=True); import signal; signal.pause(); actions = []", "--print"
    )
    launched.wait_for("reading")
    launched.signal(signal.SIGINT)
    assert launched.wait() == 128 + signal.SIGINT
    assert "Traceback" not in launched.output


def test_a_script_that_is_interrupted_while_it_imports_says_nothing(tmp_path):
    (tmp_path / "slow.py").write_text("import signal\nprint('here', flush=True)\nsignal.pause()\n")
    process = subprocess.Popen(
        ConsoleScript("slow", "slow", "main").command(),
        env={**os.environ, "PYTHONPATH": str(tmp_path)},
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
    )
    with process:
        assert process.stdout is not None
        assert process.stdout.readline() == "here\n"
        process.send_signal(signal.SIGINT)
        assert process.stdout.read() == ""
    assert process.returncode == -signal.SIGINT


def test_a_script_that_has_started_is_interrupted_as_ever(tmp_path):
    (tmp_path / "quick.py").write_text(
        "import signal\n"
        "def main():\n"
        "    try:\n"
        "        signal.raise_signal(signal.SIGINT)\n"
        "    except KeyboardInterrupt:\n"
        "        return 7\n"
    )
    process = subprocess.run(
        ConsoleScript("quick", "quick", "main").command(),
        env={**os.environ, "PYTHONPATH": str(tmp_path)},
        timeout=TIMEOUT_S,
        check=False,
    )
    assert process.returncode == 7


def test_what_a_process_says_that_never_got_ready_and_is_stopped_is_in_its_log_only(
    launch, launch_environment
):
    launched = launch(
        """
        CODE = "import signal; print('importing', flush=True); signal.pause()"
        actions = [python("a", CODE, ready=LogLine("never"))]
        """
    )
    launched.wait_for("importing")
    launched.signal(signal.SIGINT)
    assert launched.wait() == 0
    assert "KeyboardInterrupt" not in launched.output
    with open(f"{launch_environment['ROS_LOG_DIR']}/latest/a.log", encoding="utf-8") as log:
        assert "KeyboardInterrupt" in log.read()
