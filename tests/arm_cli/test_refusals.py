"""Mistakes in types and fields are reported before ROS starts."""

import json
import subprocess
import sys
from collections.abc import Callable, Iterator

import pytest

# In a process of its own, because rclpy is in that of the tests.
ANSWERING = """
import contextlib, io, json, sys
from arm_cli.main import main

for line in sys.stdin:
    with contextlib.redirect_stderr(io.StringIO()) as errors:
        code = main(json.loads(line))
    print(json.dumps([code, errors.getvalue(), "rclpy" in sys.modules]), flush=True)
"""
ARRAY = "std_msgs/msg/Float64MultiArray"


@pytest.fixture(scope="module")
def assert_refused() -> Iterator[Callable[[list[str], str], None]]:
    """Return a function that asserts what a command line is refused with."""
    command = [sys.executable, "-c", ANSWERING]
    pipes = {"stdin": subprocess.PIPE, "stdout": subprocess.PIPE}
    with subprocess.Popen(command, text=True, **pipes) as process:
        assert process.stdin is not None
        assert process.stdout is not None

        def check(words: list[str], sentence: str) -> None:
            process.stdin.write(json.dumps(words) + "\n")
            process.stdin.flush()
            code, said, with_rclpy = json.loads(process.stdout.readline())
            assert code in (1, 2)
            assert sentence in said
            assert said.count("\n") == 1
            assert not with_rclpy

        yield check
        process.stdin.close()
        assert process.wait(60.0) == 0


@pytest.mark.parametrize(
    ("words", "sentence"),
    [
        (
            ["topic", "pub", "/x", "std_msgs/msg/Strng", "data: a"],
            "did you mean 'std_msgs/msg/String'",
        ),
        (["topic", "pub", "/x", ARRAY, "dta: [1]"], "no field 'dta'; did you mean 'data'?"),
        (["topic", "pub", "/x", ARRAY, "data: [1"], "the values are not YAML: line 2, column 1"),
        (["topic", "echo", "/x", ARRAY, "--field", "dat"], "no field 'dat'"),
        (
            ["topic", "echo", "/x", "--once", "--times", "2"],
            "--once and --times exclude each other",
        ),
        (["topic", "echo", "/x", "--filter", "m >"], "is not a Python expression"),
        (["interface", "show", "Float64MultiArray"], f"did you mean '{ARRAY}'?"),
        (["interface", "show", "Float64MultArray"], f"did you mean '{ARRAY}'"),
        (["topic", "find", "sensor_msg/msg/Image"], "did you mean 'sensor_msgs'"),
        (["service", "call", "/x", "std_srvs/srv/SetBol", "{}"], "'std_srvs/srv/SetBool'"),
        (["service", "call", "/x", "std_srvs/srv/SetBool", "{dat: true}"], "no field 'dat'"),
        (["action", "send_goal", "/x", "control_msgs/action/Gripper"], "no action type"),
        (
            ["action", "send_goal", "/x", "control_msgs/action/GripperCommand", "{position: 1}"],
            "no field 'position' (fields: command)",
        ),
        (["param", "load", "/n", "/no/such.yaml"], "no parameter file /no/such.yaml"),
        (["graph", "-o", "x.png"], "no format for '.png' of x.png; there is .svg, .mmd"),
        (["check", ""], "arm check: FILE is empty"),
        (["sim", "step", "0"], "the number of steps is 0; it must be at least 1"),
    ],
)
def test_it_is_one_sentence_and_rclpy_is_not_imported(assert_refused, words, sentence):
    assert_refused(words, sentence)


@pytest.mark.parametrize(
    ("text", "sentence"),
    [
        ("data: [1]\n---\ndta: [2]\n---\n", "f.yaml: message 2: no field 'dta'; did you mean"),
        ("---\n---\n", "f.yaml: the file holds no message"),
    ],
)
def test_every_message_of_a_file_is_checked_before_publishing(
    assert_refused, tmp_path, text, sentence
):
    file = tmp_path / "f.yaml"
    file.write_text(text)
    assert_refused(["topic", "pub", "/x", ARRAY, "--yaml-file", str(file)], sentence)
