"""publisher_terminal beside a robot of topics."""

from itertools import pairwise

import pytest

pytestmark = pytest.mark.ros

NAME = "publisher_terminal"
PROMPT = "Enter the 4 Joint Variables to send (separated by spaces): "


def test_sends_every_line_of_a_pipe_and_ends_with_it(robot, run, until):
    # Deeper than the controller's, for a robot that is held up; the publisher's pace is seen below.
    commands = robot.listen(depth=10)
    robot.describe()
    program = run(NAME)
    wanted = [[0.1 * step, 0.0, -0.1 * step, 1.0] for step in range(1, 11)]
    program.type("".join(" ".join(map(repr, pose)) + "\n" for pose in wanted))
    program.end_of_input()
    assert program.wait() == 0
    until(lambda: len(commands) == len(wanted), "the last line")
    assert commands == wanted
    assert min(after - before for before, after in pairwise(robot.sent_ns)) > 90_000_000
    assert program.output.count("Publishing: [") == len(wanted)


def test_answers_each_typed_line(robot, run, until):
    commands = robot.listen()
    robot.describe()
    program = run(NAME)
    program.wait_for_line(PROMPT)
    program.type("0.4 -0.1 0.5 0.4\n")
    program.wait_for_line("Publishing: [0.400000, -0.100000, 0.500000, 0.400000]")
    until(lambda: commands, "the pose")
    program.type("1 2 3\n")
    program.wait_for_line("Please enter exactly 4 numbers.")
    program.type("-5 0.5 -1.2 -1\n")
    program.wait_for_line("joint 'j0' cannot go to -5: its limits are -2.57 to 2.57")
    program.end_of_input()
    assert program.wait() == 0
    assert commands == [[0.4, -0.1, 0.5, 0.4]]


def test_bytes_that_are_not_text_are_answered(run):
    program = run(NAME)
    program.process.stdin.buffer.write(b"\xff 0 0 0\n")
    program.end_of_input()
    assert program.wait() == 0
    assert "Please enter exactly 4 numbers." in program.output


def test_ctrl_c_at_the_prompt_ends_it(run):
    program = run(NAME)
    program.wait_for_line(PROMPT)
    assert program.stop() == 0
    assert "Traceback" not in program.output


def test_ctrl_c_while_a_line_waits_ends_it(run):
    program = run(NAME)
    program.type("0 0 0 0\n")
    program.wait_for_line(PROMPT)
    assert program.stop() == 0


def test_a_line_without_a_subscriber_fails_with_a_sentence(run):
    program = run(NAME, match_timeout=1)
    program.type("0 0 0 0\n")
    program.end_of_input()
    assert program.wait() == 1
    assert "Not published: nobody listens on /position_controller/commands." in program.output
