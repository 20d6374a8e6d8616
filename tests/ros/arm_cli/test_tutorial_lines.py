"""Command lines of tutorials, with `arm` for `ros2`, that tests/originals does not type."""

import json
import re
import sys

import pytest

pytestmark = pytest.mark.usefixtures("simulation_with_camera")

TOPICS = """\
/camera_info /clock /dynamic_joint_states /joint_state_broadcaster/transition_event /joint_states
/parameter_events /position_controller/commands /position_controller/transition_event
/robot_description /rosout /tf /tf_static /videocamera"""

LINES = {
    "arm control list_controllers -v": [
        r"^\tupdate_rate: 100 Hz$",
        r"^\tclaimed interfaces:\n(\t\tj\d/position\n){4}\trequired command interfaces:$",
        r"^\trequired state interfaces:\n\t\tj0/position$",
    ],
    "arm control list_controller_types": [
        r"^joint_state_broadcaster/JointStateBroadcaster +controller_interface::"
    ],
    "arm topic info -v /joint_states": [
        r"^Publisher count: 1\n\nNode name: joint_state_broadcaster\nNode namespace: /$",
        r"^  Durability: TRANSIENT_LOCAL$",
        r"^Node name: robot_state_publisher$",
    ],
    "arm topic type /joint_states | arm interface show -": [r"^float64\[\] position$"],
    "arm topic find sensor_msgs/msg/JointState": [r"^/joint_states$"],
    "arm topic echo --once /joint_states": [
        r"^header:\n  stamp:\n    sec: \d+\n    nanosec: \d+\n  frame_id: base_link$",
        r"^name:\n- j0\n- j1\n- j2\n- j3\nposition:\n- ",
        r"^---$",
    ],
    "arm topic echo /joint_states --field name --once": [r"^\['j0', 'j1', 'j2', 'j3'\]\n---$"],
    "arm topic echo /joint_states --csv -n 2": [r"^\d+,\d+,base_link,j0,j1,j2,j3,.*\n\d+,\d+,base"],
    "arm topic echo --once /robot_description -l 5": [r"^data: <\?xml\.\.\.$"],
    "arm topic echo --once /videocamera --no-arr": [
        r"^data: '<sequence type: uint8, length: 230400>'$"
    ],
    "arm node info /position_controller": [
        r"^  Subscribers:\n    /position_controller/commands: std_msgs/msg/Float64MultiArray$",
        r"^  Action Servers:\n\n  Action Clients:\n$",
    ],
    "arm param list /arm_controller_node": [r"^  desired_param$"],
    "arm param list --filter desired": [r"^/arm_controller_node:\n  desired_param\n/"],
    "timeout -s INT 30 arm topic hz /joint_states --wall-time --filter 'm.name' | head -n 1": [
        r"^average rate: \d+\.\d{3}$"
    ],
    "arm param describe /arm_controller_node print_period": [r"^  Type: double$"],
    "arm service type /controller_manager/list_controllers": [
        r"^controller_manager_msgs/srv/ListControllers$"
    ],
    "arm service call /controller_manager/list_controllers "
    "controller_manager_msgs/srv/ListControllers": [
        r"^requester: making request: controller_manager_msgs.srv.ListControllers_Request\(\)\n\n"
        r"response:\ncontroller_manager_msgs.srv.ListControllers_Response\(controller=\[",
        r"name='position_controller', state='active'",
    ],
    "arm tf echo --once base_link dyn4": [
        r"^At time \d+\.\d{9}\n- Translation: \[-?\d+\.\d{3}, ",
        r"^- Rotation: in Quaternion \(xyzw\) \[",
    ],
    "arm tf tree": [r"^world$", r"── base_turn_rot  \(\d+\.\d Hz\)$"],
    "arm tf monitor --once": [
        r"^RESULTS: for all Frames$",
        r"^Frame: base_turn_rot, published by <default_authority>, Average Delay: \d",
    ],
    "arm tf view_frames -t 1 -o drawn && cat drawn.gv": [r'^  "base_link" -> "base_turn" \[label='],
    "arm graph": [r'^  v\d+\["/joint_states"\]$', r'^  v\d+\(\["/joint_state_broadcaster"\]\)$'],
    "arm control view_controller_chains": [r"^Saved controller diagram to .*controller_diagram\."],
}


@pytest.mark.parametrize("line", LINES)
def test_a_line_prints_what_the_tutorial_shows(run_until, line):
    def is_shown(text: str) -> bool:
        return all(re.search(pattern, text, re.MULTILINE) for pattern in LINES[line])

    assert "Traceback" not in run_until(line, is_shown)


def test_topic_list(run_until):
    text = run_until("arm topic list", lambda text: set(TOPICS.split()) <= set(text.split()))
    assert text.splitlines() == sorted(set(text.splitlines()))


def test_controllers_are_not_lifecycle_nodes(run):
    assert run("arm lifecycle nodes") == ""


def test_lists_as_json(run_until):
    def has_tf(text):
        topics = {entry["name"]: entry["types"] for entry in json.loads(text)}
        return topics.get("/tf") == ["tf2_msgs/msg/TFMessage"]

    run_until("arm topic list --json", has_tf)
    state = json.loads(run_until("arm topic echo /joint_states --json --once", json.loads))
    assert state["name"] == ["j0", "j1", "j2", "j3"]


MANAGED_NODE = """\
import rclpy
from rclpy.lifecycle import LifecycleNode

rclpy.init()
rclpy.spin(LifecycleNode("managed"))
"""


def test_a_managed_node_is_taken_through_its_transitions(start, run_until, tmp_path):
    program = tmp_path / "managed.py"
    program.write_text(MANAGED_NODE)
    node = start(f"{sys.executable} {program}")
    run_until("arm lifecycle nodes --no-daemon", lambda text: text == "/managed\n")
    # Whether or not an answer is lost on a busy machine, it arrives there.
    both = "arm lifecycle set /managed configure; arm lifecycle get /managed"
    run_until(both, lambda text: text.endswith("inactive [2]\n"))
    sentence = "no transition 'configur' of /managed in its present state; there is activate, "
    run_until("arm lifecycle set /managed configur", lambda text: sentence in text, code=1)
    assert run_until("arm lifecycle get /managed", bool) == "inactive [2]\n"
    node.kill()


def test_json_stays_valid_when_fast_dds_logs(run_until, run):
    complaining = "env FASTRTPS_DEFAULT_PROFILES_FILE=/no/such/profile.xml arm topic list --json"
    run_until(complaining, lambda text: "/clock" in [entry["name"] for entry in json.loads(text)])
    assert "XMLPARSER" in run(f"{complaining} 2>&1 >/dev/null")


@pytest.mark.parametrize(
    ("line", "sentence"),
    [
        ("arm topic echo /joint_state", "no topic '/joint_state' on ROS_DOMAIN_ID="),
        (
            "arm topic echo /joint_states --field positon",
            "no field 'positon' (fields: header, name",
        ),
        ("arm node info /controler_manager", "did you mean '/controller_manager'"),
        ("arm param get /arm_controller_node desired", "did you mean 'desired_param'"),
        ("arm service type /list_controllers", "'/controller_manager/list_controllers'"),
        ("arm control set_controller_state nothere active", "does not seem to be loaded"),
        ("arm control load_controller nothere", "Failed loading controller nothere check"),
        ("arm tf echo base_link gripper --once", "no frame 'gripper'"),
        (
            "arm topic pub -1 /position_controller/commands std_msgs/msg/Float64 'data: 1.0'",
            " is std_msgs/msg/Float64MultiArray, not std_msgs/msg/Float64",
        ),
    ],
)
def test_a_missing_name_is_one_sentence(run_until, line, sentence):
    # On a busy machine it may say before that it waits for what it looks for.
    code = 2 if "topic pub" in line else 1
    said = run_until(line, lambda text: sentence in text and text.count("\n") == 1, code)
    assert "Traceback" not in said
