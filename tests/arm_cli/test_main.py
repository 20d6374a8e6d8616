"""The `arm` command: its help, its verbs and its errors."""

import os
import signal
import subprocess
import sys
import tomllib
from pathlib import Path

import pytest
from run_python import run_python

from arm_cli.domain_programs import ports_of
from arm_cli.errors import UnansweredError
from arm_cli.main import main
from arm_cli.verb import run_reporting_errors
from arm_cli.verbs import ARM

PROJECT = tomllib.loads((Path(__file__).parents[2] / "pyproject.toml").read_text())["project"]


@pytest.mark.parametrize("words", [["--help"], ["-h"], ["help"]])
def test_help_lists_the_verbs(capsys, words):
    assert main(words) == 0
    text = capsys.readouterr().out
    lines = [line.split(maxsplit=1) for line in text.splitlines()]
    for verb in ARM.verbs:
        assert [verb.name, verb.help] in lines


def test_without_a_verb_there_is_help_and_exit_code_2(capsys):
    assert main([]) == 2
    assert "verbs:" in capsys.readouterr().out


def test_version_prints_the_distribution_s_version(capsys):
    assert main(["--version"]) == 0
    assert capsys.readouterr().out == f"arm {PROJECT['version']}\n"


@pytest.mark.parametrize(
    ("word", "sentence"),
    [
        ("lanch", "arm: no verb 'lanch'; did you mean 'launch'?\n"),
        ("--hlep", "arm: no option '--hlep'; did you mean '--help'?\n"),
    ],
)
def test_an_unknown_verb_suggests_a_similar_one(capsys, word, sentence):
    assert main([word]) == 2
    captured = capsys.readouterr()
    assert (captured.out, captured.err) == ("", sentence)


def test_optional_arguments_are_not_missing(capsys):
    with pytest.raises(SystemExit):
        main(["check"])
    with pytest.raises(SystemExit):
        main(["run", "arm_controller"])
    assert capsys.readouterr().err == (
        "arm check: the following arguments are required: FILE; see arm check --help\n"
        "arm run: the following arguments are required: executable_name; see arm run --help\n"
    )


def test_help_imports_no_verb():
    code = (
        "import sys; from arm_cli.main import main; main(['--help']); "
        "heavy = {'launch_py', 'rclpy', 'rich', 'yaml', 'numpy', 'asyncio'}; "
        "sys.exit(', '.join(heavy & sys.modules.keys()) or 0)"
    )
    done = run_python("-c", code)
    assert (done.returncode, done.stderr) == (0, "")


def test_python_m_arm_cli_is_the_command():
    done = run_python("-m", "arm_cli", "--version")
    assert done.stdout.startswith("arm ")


@pytest.mark.parametrize("closed", ["<&- >&-", ">&- 2>&-", "<&- >&- 2>&-"])
@pytest.mark.parametrize("module", ["arm_cli --help", "launch_py --help"])
def test_with_closed_standard_streams_the_output_is_discarded(closed, module):
    done = subprocess.run(
        ["sh", "-c", f"exec {sys.executable} -m {module} {closed}"],
        capture_output=True,
        text=True,
        timeout=100,
        check=False,
    )
    assert (done.returncode, done.stdout, done.stderr) == (0, "", "")


@pytest.mark.parametrize("words", [["launch"], ["topic", "list"]])
def test_an_invalid_domain_is_reported_before_anything_starts(capsys, monkeypatch, words):
    monkeypatch.setenv("ROS_DOMAIN_ID", "abc")
    assert main(words) == 2
    captured = capsys.readouterr()
    assert captured.out == ""
    assert captured.err.endswith(
        ": ROS_DOMAIN_ID is 'abc'; it must be a whole number from 0 to 232\n"
    )


def test_an_interrupt_is_recognised_even_if_the_code_raises_another_error():
    def check() -> int:
        try:
            signal.raise_signal(signal.SIGINT)
        except KeyboardInterrupt:
            raise ImportError("initialization failed") from None
        return 0

    before = signal.getsignal(signal.SIGINT)
    with pytest.raises(KeyboardInterrupt):
        run_reporting_errors("arm check", check)
    assert signal.getsignal(signal.SIGINT) is before


def test_an_error_without_an_interrupt_stays_an_error():
    def check() -> int:
        raise ImportError("no module")

    with pytest.raises(ImportError, match="no module"):
        run_reporting_errors("arm check", check)


def run_arm(script: str, **variables: str) -> subprocess.CompletedProcess[str]:
    command = f"{sys.executable} -m arm_cli"
    return subprocess.run(
        ["sh", "-c", script.replace("arm ", f"{command} ", 1)],
        env={**os.environ, **variables},
        capture_output=True,
        text=True,
        timeout=60,
        check=False,
    )


def test_a_terminal_without_utf_8_gets_escapes(tmp_path):
    file = tmp_path / "robot.urdf"
    file.write_text("<robot name='humano\u00efde'><link name='base'/></robot>")
    done = run_arm(f"arm check {file}", PYTHONIOENCODING="ascii")
    assert (done.returncode, done.stderr) == (0, "")
    assert done.stdout.startswith(r"robot 'humano\xefde'")


@pytest.mark.parametrize("words", ["--help", "interface show std_msgs/msg/String", "check {file}"])
def test_a_full_disk_is_one_sentence(tmp_path, words):
    file = tmp_path / "robot.urdf"
    file.write_text("<robot name='r'><link name='base'/></robot>")
    done = run_arm(f"arm {words.format(file=file)} > /dev/full")
    assert (done.returncode, done.stderr) == (1, "arm: cannot write: No space left on device\n")


@pytest.mark.parametrize("words", ["check r.urdf", "launch x.launch.py", "pkg create foo"])
def test_a_current_folder_that_was_removed_is_one_sentence(tmp_path, words):
    folder = tmp_path / "gone"
    folder.mkdir()
    done = run_arm(f"cd {folder} && rmdir {folder} && arm {words}")
    assert done.returncode == 1
    assert done.stderr == "arm: the current folder no longer exists; change to another one\n"


HOLDS_A_PORT = """
import os, signal, socket
port = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
port.bind(("127.0.0.1", PORT))
os.kill(os.getpid(), signal.SIGSTOP)
"""


def test_a_program_that_is_stopped_is_named_where_nobody_answers(capsys):
    # The last port of the domain: participants take them from the first on.
    source = HOLDS_A_PORT.replace("PORT", str(ports_of(os.environ)[-1]))

    def ask() -> None:
        raise UnansweredError("nobody answers")

    with subprocess.Popen([sys.executable, "-c", source]) as stopped:
        try:
            os.waitid(os.P_PID, stopped.pid, os.WSTOPPED)
            assert run_reporting_errors("arm move", ask) == 1
        finally:
            stopped.kill()
    assert capsys.readouterr().err.endswith(
        f"({stopped.pid}) is stopped and answers nobody until `kill -CONT {stopped.pid}`\n"
    )
