"""`arm launch copies:=4`: four arms in one world, each by its own topics."""

import numpy as np
import pytest
from controller_manager_msgs.srv import ListControllers
from rclpy.qos import DurabilityPolicy, QoSProfile
from sensor_msgs.msg import JointState
from std_msgs.msg import Float64MultiArray
from tf2_msgs.msg import TFMessage

COPIES = 4


def test_each_copy_moves_by_its_own_topic_and_stands_at_its_own_place(launch, client):
    launched = launch(f"copies:={COPIES}", "camera:=none", "copy_spacing:=0.75")
    launched.wait_until_ready()
    launched.wait_for_line("arm control list_controllers -c /arm_0/controller_manager")
    names = [f"arm_{index}" for index in range(COPIES)]
    states = {name: client.subscribe(JointState, f"/{name}/joint_states") for name in names}
    goals = {name: np.zeros(4) for name in names}
    for name in reversed(names):
        goals[name] = np.full(4, 0.1 * (1 + names.index(name)))
        topic = f"/{name}/position_controller/commands"
        client.publisher(Float64MultiArray, topic).publish(Float64MultiArray(data=[*goals[name]]))
        states[name].wait_until(
            lambda m, n=name: bool(m) and np.allclose(m[-1].position, goals[n], atol=0.005),
            f"{name} is at {goals[name]}",
        )
        for other in names:
            states[other].clear()
            newest = states[other].wait_for()[-1]
            assert newest.name == [f"{other}_j{joint}" for joint in range(4)]
            assert newest.position == pytest.approx(goals[other], abs=0.005), f"{name} -> {other}"

    service = "/arm_3/controller_manager/list_controllers"
    listed = client.call(ListControllers, service, ListControllers.Request()).controller
    claimed = {name for controller in listed for name in controller.claimed_interfaces}
    assert claimed == {f"arm_3_j{joint}/position" for joint in range(4)}

    latched = QoSProfile(depth=COPIES, durability=DurabilityPolicy.TRANSIENT_LOCAL)
    places = client.subscribe(TFMessage, "/tf_static", latched).wait_for(COPIES)
    feet = {
        each.child_frame_id: (each.transform.translation.x, each.transform.translation.y)
        for message in places
        for each in message.transforms
        if each.header.frame_id == "world"
    }
    corners = [(0.0, 0.0), (0.0, 0.75), (0.75, 0.0), (0.75, 0.75)]
    assert feet == {f"{name}_base_link": xy for name, xy in zip(names, corners, strict=True)}
