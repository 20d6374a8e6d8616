"""Verbs without a simulation: publishing a file, service events, and Tab completion."""

import re
import shlex
from functools import partial
from typing import Any

import pytest
from rclpy.parameter import Parameter
from rclpy.qos import qos_profile_system_default
from rclpy.service_introspection import ServiceIntrospectionState
from std_srvs.srv import SetBool

ECHOED = "data: one\n---\n---\ndata: two\n---\n"


@pytest.mark.parametrize(
    ("option", "words"), [("", ["one", "two"]), ("-t 5", ["one", "two"]), ("--once", ["one"])]
)
def test_the_messages_of_a_file_are_published_once(run, tmp_path, option, words):
    (tmp_path / "f.yaml").write_text(ECHOED)
    line = "arm topic pub -w 0 -r 50 /chat std_msgs/msg/String --yaml-file f.yaml"
    assert re.findall(r"#\d: .*data='(.*)'", run(f"{line} {option}")) == words


def test_a_message_of_the_command_line_is_published_repeatedly(run):
    text = run("arm topic pub -w 0 -r 50 -t 3 /chat std_msgs/msg/String 'data: one'")
    assert re.findall(r"#(\d): .*data='one'", text) == ["1", "2", "3"]


def answer(_request: Any, response: Any) -> Any:
    response.message = "a\x1b[2J"
    return response


def test_requests_and_responses_are_shown(client, start):
    service = client.node.create_service(SetBool, "/switch", answer)
    service.configure_introspection(
        client.node.get_clock(), qos_profile_system_default, ServiceIntrospectionState.CONTENTS
    )
    caller = client.node.create_client(SetBool, "/switch")
    client.node.create_timer(0.1, lambda: caller.call_async(SetBool.Request(data=True)))
    command = start("arm service echo /switch")
    command.wait_for("event_type: 2")
    # The one after it, whole.
    command.wait_for("request:\n- data: true\nresponse: []\n---\n")
    command.wait_for(r'message: "a\e[2J"')
    command.interrupt()
    requests = [event for event in command.out.split("---\n") if "- data: true" in event]
    assert all("event_type: 1" in event for event in requests)


def test_a_service_that_publishes_nothing_is_explained(client, run_until):
    client.node.create_service(SetBool, "/silent", answer)
    explained = "is service introspection enabled in its node?"
    line = "arm service echo /silent --timeout 1.5"
    said = run_until(line, lambda text: explained in text, code=1)
    assert "no event of /silent within 1.5 s" in said


TAB = (
    "env _ARGCOMPLETE=1 _ARGCOMPLETE_IFS=, _ARGCOMPLETE_STDOUT_FILENAME=words "
    "COMP_TYPE=9 COMP_POINT={point} COMP_LINE={line} {variables} arm"
)


@pytest.fixture
def offered(start, tmp_path):
    """Return a function that presses Tab until a word is offered."""

    def press(line: str, variables: str = "") -> list[str]:
        answer = tmp_path / "words"
        answer.write_text("")
        tab = TAB.format(point=len(line), line=shlex.quote(line), variables=variables)
        # It fails if it needs ROS, and ROS cannot start in the environment of the test.
        assert start(tab).wait() == 0 or variables
        return [word.strip() for word in answer.read_text().split(",")]

    return press


def test_tab_knows_parameters_and_their_values(client, offered):
    client.node.declare_parameter("flag", False)
    client.node.declare_parameter("size", [1.0, 2.5])

    def offers(line: str, *words: str) -> bool:
        # On a busy machine Tab gives up before the node is discovered.
        return set(words) <= set(offered(line))

    for line, words in (
        ("arm param set /test_c", ["/test_client"]),
        ("arm param set /test_client ", ["flag", "size"]),
        ("arm param set /test_client flag ", ["true", "false"]),
        ("arm param get /test_client fl", ["flag"]),
        ("arm service call /test_client/set", ["/test_client/set_parameters"]),
    ):
        assert client.wait_until(partial(offers, line, *words), f"{line}: {words}")


def test_what_is_not_set_is_said_with_how_to_set_it(client, run_until):
    client.node.declare_parameter("goal", Parameter.Type.DOUBLE)
    get = "arm param get /test_client goal"
    run_until(get, lambda text: text == "Parameter not set.\n")
    hints = ("goal is declared, but has no value yet", "arm param set /test_client goal VALUE")
    said = run_until(f"{get} 2>&1", lambda text: all(hint in text for hint in hints))
    assert "Parameter not set." in said


NO_ROS = "ROS_LOG_DIR=/dev/null"
"""With this, a process can start no node."""


def test_tab_gets_names_from_a_running_robot_without_a_node(start, offered, client):
    start(
        "arm run robot_state_publisher robot_state_publisher --ros-args "
        """-p robot_description:='<robot name="r"><link name="base"/></robot>'"""
    )
    for line, words in (
        ("arm node info /", {"/robot_state_publisher"}),
        ("arm topic echo /", {"/robot_description", "/tf_static"}),
        ("arm service call /", {"/robot_state_publisher/set_parameters"}),
    ):
        # Tab does not wait long for the names.
        assert client.wait_until(
            lambda line=line, words=words: words <= set(offered(line, NO_ROS)), f"{line}: {words}"
        )
