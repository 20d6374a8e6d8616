"""Plain lines, and the terminal's prefixes, panel and status line."""

import io
import os
import pty
import re
import select
import signal
import subprocess
import sys

import pytest

from launch_py.screen import PlainScreen, ReadySummary, TerminalScreen
from launch_py.testing import FakeClock

SUMMARY = ReadySummary(
    title="the arm",
    topics=(("/joint_states", "100 Hz"),),
    commands=(("move it", "arm topic pub " + "x" * 200),),
    notes=(("logs", "/tmp/log"),),
)


@pytest.fixture
def stream():
    return io.StringIO()


@pytest.fixture
def clock():
    return FakeClock()


@pytest.fixture
def terminal(stream, clock):
    return TerminalScreen(stream, started_s=0.0, colours=False, clock=clock)


def test_plain_lines_start_with_the_name(stream):
    screen = PlainScreen(stream)
    screen.begin(["a"], lambda: "status")
    screen.line("a", "hello")
    screen.note("note")
    screen.problem("problem")
    screen.refresh()
    screen.end("stopped", failed=False)
    assert stream.getvalue() == "[a] hello\n[launch] note\n[launch] problem\n[launch] stopped\n"


def test_the_plain_summary_ends_with_the_time(stream):
    PlainScreen(stream).ready(1.434, SUMMARY)
    lines = stream.getvalue().splitlines()
    assert lines[0] == "[launch] /joint_states: 100 Hz"
    assert lines[-1] == "ready 1.43 s"


def test_terminal_prefixes_are_aligned_and_timed(terminal, stream, clock):
    terminal.begin(["simulation", "b"], lambda: "")
    clock.advance(1.5)
    terminal.line("simulation", "one")
    terminal.line("b", "two")
    text = stream.getvalue().replace("\r\x1b[2K", "")
    assert text == "   1.50 simulation │ one\n   1.50 b          │ two\n"


def test_every_process_has_a_colour_of_its_own(stream, clock):
    screen = TerminalScreen(stream, 0.0, colours=True, clock=clock)
    screen.begin(["a", "b"], lambda: "")
    for name in ("a", "b", "a"):
        screen.line(name, "x")
    colours = re.findall(r"\x1b\[(\d+)m[ab] +\x1b", stream.getvalue())
    assert colours[0] == colours[2] != colours[1]


def test_a_line_s_colours_end_with_the_line(terminal, stream):
    terminal.begin(["a"], lambda: "")
    terminal.line("a", "\x1b[31mred")
    assert stream.getvalue().endswith("red\x1b[0m\n")


def test_the_status_stays_below_the_lines(terminal, stream):
    terminal.begin(["a"], lambda: "up 0:01")
    terminal.refresh()
    assert stream.getvalue().endswith("\x1b[2Kup 0:01")
    terminal.line("a", "x")
    assert stream.getvalue().endswith("│ x\nup 0:01")
    terminal.end("stopped", failed=True)
    assert stream.getvalue().endswith("│ stopped\n")


def test_a_long_status_is_cut_to_the_width(terminal, stream):
    terminal.begin(["a"], lambda: "x" * 500)
    terminal.refresh()
    assert stream.getvalue().count("x") == 79


def test_the_panel_is_complete_and_commands_can_be_copied(terminal, stream):
    terminal.ready(1.434, SUMMARY)
    text = stream.getvalue()
    assert "the arm: ready in 1.43 s" in text
    assert re.search(r"│ /joint_states +100 Hz +│", text)
    assert re.search(r"│ logs +/tmp/log +│", text)
    assert f"    {SUMMARY.commands[0][1]}\n" in text


def test_a_narrow_panel_cuts_nothing_off(terminal, stream, monkeypatch):
    monkeypatch.setenv("COLUMNS", "60")
    topic = ("/position_controller/commands", "std_msgs/msg/Float64MultiArray, j0 to j3")
    path = "/home/somebody/.ros/log/2026-01-01-12-00-00-a1b2c3d4e5f6-1234567"
    terminal.ready(1.434, ReadySummary("the arm", (topic,), (), (("logs", path),)))
    rows = [line.strip("│ ") for line in stream.getvalue().splitlines()]
    assert path in "".join(row.removeprefix("logs").strip() for row in rows)
    assert re.search(r"│ /position_controller/commands +std_msgs/msg/Float", stream.getvalue())
    assert "…" not in stream.getvalue()


class Terminal:
    """The launcher under a pseudo terminal."""

    def __init__(self, path, environment) -> None:
        self.fd, slave = pty.openpty()
        self.text = ""
        self.process = subprocess.Popen(
            [sys.executable, "-m", "launch_py", str(path)],
            stdin=slave,
            stdout=slave,
            stderr=slave,
            env=environment,
            start_new_session=True,
        )
        os.close(slave)

    def read_until(self, pattern: str) -> None:
        while not re.search(pattern, self.text):
            assert select.select([self.fd], [], [], 30)[0], self.text
            self.text += os.read(self.fd, 65536).decode()

    def read_all(self) -> None:
        try:
            while data := os.read(self.fd, 65536):
                self.text += data.decode()
        except OSError:
            return


@pytest.fixture
def on_terminal(write_launch_file, launch_environment):
    opened = []

    def start(actions, **environment):
        path = write_launch_file(actions)
        opened.append(Terminal(path, {**launch_environment, "TERM": "xterm", **environment}))
        return opened[-1]

    yield start
    for terminal in opened:
        terminal.process.kill()
        terminal.process.wait()
        os.close(terminal.fd)


SHOW = (
    "actions = [ReadyPanel(title='the arm', topics={'/clock': 'time'}, commands={'look': 'cmd'}), "
    "forever('sim')]"
)


def test_on_a_terminal_there_is_a_panel_a_status_line_and_colour(on_terminal):
    terminal = on_terminal(SHOW)
    terminal.read_until("Ctrl-C; twice: now")
    terminal.read_until(r"up \d:\d\d · 1 process\x1b")
    terminal.process.send_signal(signal.SIGINT)
    assert terminal.process.wait(30) == 0
    terminal.read_all()
    assert "the arm: ready in" in terminal.text
    assert "╭" in terminal.text
    assert "waiting for sim\x1b" in terminal.text
    assert "waiting for \x1b" not in terminal.text
    assert "\x1b[36msim" in terminal.text
    assert re.search(r"stopped after \d", terminal.text)
    assert not re.search(r"^ready \d", terminal.text, re.MULTILINE)


def test_no_color_switches_colours_off(on_terminal):
    terminal = on_terminal(SHOW, NO_COLOR="1")
    terminal.read_until("Ctrl-C; twice: now")
    terminal.process.send_signal(signal.SIGINT)
    assert terminal.process.wait(30) == 0
    terminal.read_all()
    assert set(re.findall(r"\x1b\[[\d;]*[A-Za-z]", terminal.text)) == {"\x1b[2K"}


def test_a_dumb_terminal_gets_plain_lines(on_terminal):
    terminal = on_terminal(SHOW, TERM="dumb")
    terminal.read_until(r"ready \d+\.\d\d s")
    assert "\x1b" not in terminal.text
