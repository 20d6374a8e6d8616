"""Publishing what a file holds, without a simulation."""

import re

import pytest

pytestmark = pytest.mark.ros

ECHOED = "data: one\n---\n---\ndata: two\n---\n"


@pytest.mark.parametrize(
    ("option", "words"), [("", ["one", "two"]), ("-t 5", ["one", "two"]), ("--once", ["one"])]
)
def test_the_messages_of_a_file_are_published_once(run, tmp_path, option, words):
    (tmp_path / "f.yaml").write_text(ECHOED)
    line = "arm topic pub -w 0 -r 50 /chat std_msgs/msg/String --yaml-file f.yaml"
    assert re.findall(r"#\d: .*data='(.*)'", run(f"{line} {option}")) == words


def test_a_message_of_the_line_is_published_again_and_again(run):
    text = run("arm topic pub -w 0 -r 50 -t 3 /chat std_msgs/msg/String 'data: one'")
    assert re.findall(r"#(\d): .*data='one'", text) == ["1", "2", "3"]
