"""Mistakes in types and fields are reported before ROS starts."""

import subprocess
import sys

import pytest

CODE = (
    "import sys; from arm_cli.main import main; code = main(sys.argv[1:]); "
    "print('rclpy' in sys.modules); sys.exit(code)"
)
ARRAY = "std_msgs/msg/Float64MultiArray"


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
def test_it_is_one_sentence_and_rclpy_is_not_imported(words, sentence):
    assert_refused(words, sentence)


@pytest.mark.parametrize(
    ("text", "sentence"),
    [
        ("data: [1]\n---\ndta: [2]\n---\n", "f.yaml: message 2: no field 'dta'; did you mean"),
        ("---\n---\n", "f.yaml: the file holds no message"),
    ],
)
def test_every_message_of_a_file_is_checked_before_publishing(tmp_path, text, sentence):
    file = tmp_path / "f.yaml"
    file.write_text(text)
    assert_refused(["topic", "pub", "/x", ARRAY, "--yaml-file", str(file)], sentence)


def assert_refused(words, sentence):
    done = subprocess.run(
        [sys.executable, "-c", CODE, *words],
        capture_output=True,
        text=True,
        timeout=60,
        check=False,
    )
    assert done.returncode in (1, 2)
    assert sentence in done.stderr
    assert done.stderr.count("\n") == 1
    assert done.stdout == "False\n"
