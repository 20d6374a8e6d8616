"""How text from outside appears on a terminal or in a log."""

import logging
import sys

import pytest

import launch_py.printable
from arm_node import ros_logging
from arm_node.printable import first_line, printable, printable_document, printable_message
from arm_node.ros_logging import RosLogHandler

CLEAR = "\x1b[2J"


@pytest.mark.parametrize(
    "text",
    [
        "cannot make the folder: 13, at /project/src/rcl_logging_spdlog.cpp:154",
        "cannot make the folder: 13\n, at /project/src/participant.cpp:234, at /src/rcl/node.c:252",
    ],
)
def test_the_source_position_of_rcl_is_left_out(text):
    assert first_line(RuntimeError(text)) == "cannot make the folder: 13"


@pytest.mark.parametrize(
    ("text", "shown"),
    [
        ("/joint_states, 20 °C, 関節\t1", "/joint_states, 20 °C, 関節\t1"),
        (f"a{CLEAR}\x1b[31mb", r"a\x1b[2J\x1b[31mb"),
        ("j0\n[INFO] all is well\r", r"j0\n[INFO] all is well\r"),
        ("\x9b2J\x00", r"\x9b2J\x00"),
        ("abc\u202edcba\u2029", r"abc\u202edcba\u2029"),
        ("\udcff", r"\udcff"),
    ],
)
def test_what_a_terminal_would_obey_is_escaped(text, shown):
    assert printable(text) == shown


def test_only_indented_lines_of_a_message_stay_lines():
    assert printable_message("tried:\n  a\x1b\nforged") == "tried:\n  a\\x1b\\nforged"
    assert printable_document("a\nb\x1b\n") == "a\nb\\x1b\n"


def test_the_launcher_escapes_the_same_characters():
    for character in map(chr, range(sys.maxunicode + 1)):
        assert printable(character) == launch_py.printable.printable(character)


def test_what_is_logged_is_one_message_and_a_traceback_stays_readable(monkeypatch):
    said = []

    class Rcutils:
        def rclpy_logging_logger_is_enabled_for(self, name, severity):
            return name == "core"

        def rclpy_logging_rcutils_log(self, severity, name, text, function, file, line):
            said.append(text)
            calls.append((severity.name, name, function, file))

    calls = []
    monkeypatch.setattr(ros_logging, "rclpy_implementation", Rcutils())
    logger = logging.Logger("core")
    logger.addHandler(RosLogHandler())
    logger.error("no controller %s", f"x\n[INFO] forged{CLEAR}")
    try:
        raise ValueError(f"of\n{CLEAR}")
    except ValueError:
        logger.exception("the task failed")
    first, second = said
    assert first == r"no controller x\n[INFO] forged\x1b[2J"
    function = "test_what_is_logged_is_one_message_and_a_traceback_stays_readable"
    assert calls == [("ERROR", "core", function, __file__)] * 2
    head, *lines, last = second.split("\n")
    assert head == "the task failed"
    assert lines[0] == "  Traceback (most recent call last):"
    assert last == r"  \x1b[2J"
