"""The planner, the page and a recording beside a driver, whose arm is an emulated myCobot."""

import math
import os
import sys
import urllib.request
from collections.abc import Iterator
from pathlib import Path

import pytest
from programs import Program, RosProgram
from rosbags.highlevel import AnyReader

from arm_sim.bench.mycobot_arm import EmulatedMyCobot
from arm_sim.bench.serial_device import EmulatedPort

pytestmark = pytest.mark.timeout(600)


@pytest.fixture(scope="module")
def arm(tmp_path_factory) -> Iterator[tuple[EmulatedMyCobot, Path]]:
    """Return an emulated arm and its port."""
    emulated, path = EmulatedMyCobot(), tmp_path_factory.mktemp("port") / "mycobot"
    with EmulatedPort(emulated, path):
        yield emulated, path


@pytest.fixture(scope="module")
def launched(arm, launch_for_file) -> Program:
    """Return the launch of the simulated arm with the driver in its place, ready."""
    program = launch_for_file(
        *("mycobot", "planning:=true", "viewer:=true", "viewer_port:=0"),
        *("hardware:=mycobot_280", f"port:={arm[1]}"),
        # A busy machine may hold the emulated arm up.
        "hardware_args:=reply_timeout:=0.2 max_missed:=50",
    )
    program.wait_until_ready()
    return program


def test_a_planned_motion_moves_the_arm_and_is_recorded(
    arm, planning, request_of, joint_goal, joints, tmp_path
):
    bag = tmp_path / "bag"
    words = ("bag", "record", "/joint_states", "-o", str(bag))
    recorder = RosProgram([sys.executable, "-m", "arm_cli", *words], os.environ)
    try:
        recorder.wait_for_line("All requested topics are subscribed")
        before = planning.positions()["link1_to_link2"]
        assert before == pytest.approx(0.0, abs=0.02)
        slow = {"max_velocity_scaling_factor": 0.1, "max_acceleration_scaling_factor": 0.1}
        end = planning.move(request_of(joint_goal(joints(0.4)), **slow))
        assert end.result.error_code.val == 1, end.result.error_code.message
        # What stands still may also be an arm that a busy machine keeps from being read.
        planning.client.wait_until(
            lambda: abs(planning.positions()["link1_to_link2"] - 0.4) < 0.02, "the joint at 0.4"
        )
        assert math.radians(arm[0].angles[0]) == pytest.approx(0.4, abs=0.02)
        assert recorder.stop() == 0
    finally:
        recorder.close()
    with AnyReader([bag]) as reader:
        states = [reader.deserialize(data, c.msgtype) for c, _, data in reader.messages()]
    turned = [s.position[list(s.name).index("link1_to_link2")] for s in states]
    assert turned[0] == pytest.approx(0.0, abs=0.02)
    assert turned[-1] == pytest.approx(0.4, abs=0.02)
    assert any(0.05 < position < 0.35 for position in turned), "the motion itself"


def test_the_page_is_served_without_complaint(launched):
    line = launched.wait_for_line("the page is at http://")
    with urllib.request.urlopen(line.partition("is at ")[2].strip(), timeout=60.0) as page:
        assert page.status == 200
    own = [line for line in launched.own_words if line.startswith("[arm_viewer_node]")]
    assert not [line for line in own if "[ERROR]" in line or "[WARN]" in line]
    assert "Traceback" not in launched.output
