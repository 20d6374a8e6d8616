"""How texts of other processes reach a terminal or a log file."""

import io

import pytest

from launch_py.command.command_line import run
from launch_py.printable import printable, printable_coloured, printable_message, without_colours
from launch_py.screen import PlainScreen
from launch_py.screen.log_folder import LogFolder
from launch_py.screen.reporter import Reporter

CLEAR, TITLE, COLOUR = "\x1b[2J", "\x1b]0;owned\x07", "\x1b[31mred\x1b[0m"


@pytest.mark.parametrize(
    ("text", "shown"),
    [
        ("/joint_states, 20 °C, 関節\t1", "/joint_states, 20 °C, 関節\t1"),
        (f"a{CLEAR}b", r"a\x1b[2Jb"),
        (TITLE, r"\x1b]0;owned\x07"),
        (COLOUR, r"\x1b[31mred\x1b[0m"),
        ("j0\n[launch] all is well\r", r"j0\n[launch] all is well\r"),
        ("\x9b2J\x7f", r"\x9b2J\x7f"),
        ("abc\u202edcba\u2028", r"abc\u202edcba\u2028"),
        ("\udcff", r"\udcff"),
    ],
)
def test_control_sequences_are_escaped(text, shown):
    assert printable(text) == shown
    assert printable(shown) == shown


def test_only_colours_may_stay():
    assert printable_coloured(f"{COLOUR}{CLEAR}{TITLE}") == rf"{COLOUR}\x1b[2J\x1b]0;owned\x07"
    assert without_colours(f"{COLOUR}{CLEAR}") == f"red{CLEAR}"


def test_only_indented_lines_of_a_message_stay_lines():
    assert (
        printable_message("a:\n  b\x1b\nc")
        == r"""a:
  b\x1b\nc"""
    )


def test_the_output_of_a_process_is_escaped_on_the_screen_and_in_its_log(tmp_path):
    logs, stream = LogFolder(tmp_path), io.StringIO()
    reporter = Reporter(PlainScreen(stream), logs)
    reporter.line("a", f"{COLOUR}{CLEAR}{TITLE}", shown=True)
    reporter.note(f"one\ntwo {TITLE}")
    logs.close()
    escaped = r"\x1b[2J\x1b]0;owned\x07"
    assert stream.getvalue().splitlines() == [
        f"[a] {COLOUR}{escaped}",
        "[launch] one",
        r"[launch] two \x1b]0;owned\x07",
    ]
    assert (logs.path / "a.log").read_text().endswith(f" red{escaped}\n")


def test_an_argument_of_the_command_line_is_printed_escaped(capsys, tmp_path):
    file = tmp_path / "x.launch.py"
    file.write_text(
        "from launch_py import DeclareLaunchArgument, LaunchDescription\n"
        "def generate_launch_description():\n"
        "    return LaunchDescription([DeclareLaunchArgument('a', default_value='\\x1b[2J')])\n"
    )
    assert run([str(file), f"b{CLEAR}:=1", "--print"], "launch") == 0
    assert run([str(file), "--show-args"], "launch") == 0
    said = capsys.readouterr()
    assert "\x1b" not in said.err + said.out
    assert said.err.count(r"\x1b[2J") + said.out.count(r"\x1b[2J") > 1
