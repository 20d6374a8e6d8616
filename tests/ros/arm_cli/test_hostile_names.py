"""`arm` escapes another node's names and strings, so that no terminal obeys them."""

import json

import pytest
from controller_manager_msgs.msg import ControllerState
from controller_manager_msgs.srv import ListControllers
from geometry_msgs.msg import TransformStamped
from rclpy.qos import DurabilityPolicy, QoSProfile
from std_msgs.msg import String
from tf2_msgs.msg import TFMessage

HOSTILE = "a\x1b[2J\x1b]0;owned\x07\nforged: true\x9b"
SHOWN = r"a\x1b[2J\x1b]0;owned\x07\nforged: true\x9b"
LATCHED = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)


@pytest.fixture
def hostile_node(client):
    """A node with hostile strings in a topic, its parameters, its frames and its answers."""
    node = client.node
    node.create_publisher(String, "/text", LATCHED).publish(String(data=HOSTILE))
    transform = TransformStamped(child_frame_id=HOSTILE)
    transform.header.frame_id = "world"
    transform.transform.rotation.w = 1.0
    node.create_publisher(TFMessage, "/tf_static", LATCHED).publish(
        TFMessage(transforms=[transform])
    )
    node.declare_parameter("text", HOSTILE)

    def answer(_request, response):
        response.controller = [
            ControllerState(name=HOSTILE, type=HOSTILE, state=HOSTILE, claimed_interfaces=[HOSTILE])
        ]
        return response

    node.create_service(ListControllers, "/controller_manager/list_controllers", answer)
    return node


@pytest.fixture
def run(run_until):
    """Run a command line until it succeeds: what it asks for may be discovered late."""
    return lambda line: run_until(line, bool)


@pytest.mark.usefixtures("hostile_node")
def test_hostile_text_is_printed_escaped(run, run_until):
    assert run("arm topic echo /text --once --field data") == f"{SHOWN}\n---\n"
    assert run("arm topic echo /text --once --csv") == f"{SHOWN}\n"
    assert json.loads(run("arm topic echo /text --once --json")) == {"data": HOSTILE}
    # On a busy machine, frames and nodes may be discovered too late for one look.
    run_until("arm tf tree", lambda text: text.endswith(f"{SHOWN}  (static)\n"))
    parameter = "String value is: " + SHOWN.replace(r"\n", "\n") + "\n"
    run_until("arm param get /test_client text", lambda text: text == parameter)
    listed = run("arm control list_controllers -v")
    assert f"\t\t{SHOWN}\n" in listed
    for line in listed.splitlines():
        assert not line.startswith("forged")
    texts = [
        listed,
        run(
            "arm service call /controller_manager/list_controllers "
            "controller_manager_msgs/srv/ListControllers"
        ),
    ]
    for text in texts:
        assert SHOWN in text
        assert not set(text) & set("\x1b\x07\x9b")
