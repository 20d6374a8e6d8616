"""Stop signals before anything runs: in a launch file, and in a process that still imports."""

import os
import signal
import subprocess

import pytest

from launch_py.system.packages import ConsoleScript

TIMEOUT_S = 30.0


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM, signal.SIGHUP])
def test_a_stop_signal_while_the_launch_file_is_read_shows_no_traceback(launch, number):
    launched = launch("print('reading', flush=True); import signal; signal.pause(); actions = []")
    launched.wait_for("reading")
    launched.process.send_signal(number)
    assert launched.wait() == 0
    assert launched.lines[-1].endswith(": stopped before anything was started")
    assert "Traceback" not in launched.output


@pytest.mark.parametrize("makes", ["raise ImportError('IMPORTANT')", "pass"])
@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_a_stop_signal_that_other_code_turns_into_another_error_still_stops(launch, number, makes):
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
    launched.process.send_signal(number)
    assert launched.wait() == 0
    assert launched.lines[1:] == ["launch_py: stopped before anything was started"]


@pytest.mark.parametrize(
    "lost",
    [
        "gone = weakref.ref(Thing(), lambda _: signal.raise_signal({}))",
        "Thing.__del__ = lambda _: signal.raise_signal({})\nThing()",
    ],
)
@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_a_stop_signal_whose_exception_python_drops_still_stops_without_a_traceback(
    launch, number, lost
):
    """Exceptions in weak-reference callbacks are dropped, and imports run many of them."""
    launched = launch(
        "import signal, weakref\n"
        "class Thing: pass\n"
        f"{lost.format(int(number))}\n"
        "print('goes on', flush=True)\n"
        "actions = [forever('a')]"
    )
    assert launched.wait() == 0
    assert launched.lines == ["goes on", "launch_py: stopped before anything was started"]


def test_an_interrupted_listing_is_not_a_success(launch):
    launched = launch(
        "print('reading', flush=True); import signal; signal.pause(); actions = []", "--print"
    )
    launched.wait_for("reading")
    launched.process.send_signal(signal.SIGINT)
    assert launched.wait() == 128 + signal.SIGINT
    assert "Traceback" not in launched.output


def test_a_script_interrupted_during_its_imports_prints_nothing(tmp_path):
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


def test_a_script_that_has_started_is_interrupted_as_usual(tmp_path):
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


def test_output_of_a_process_stopped_before_it_was_ready_goes_to_its_log_only(
    launch, launch_environment
):
    launched = launch(
        """
        CODE = "import signal; print('importing', flush=True); signal.pause()"
        actions = [python("a", CODE, ready=LogLine("never"))]
        """
    )
    launched.wait_for("importing")
    launched.process.send_signal(signal.SIGINT)
    assert launched.wait() == 0
    assert "KeyboardInterrupt" not in launched.output
    with open(f"{launch_environment['ROS_LOG_DIR']}/latest/a.log", encoding="utf-8") as log:
        assert "KeyboardInterrupt" in log.read()
