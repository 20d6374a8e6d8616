"""Entities are spawned, moved and deleted in a running simulation without affecting the arm."""

import re

import numpy as np
import pytest
from rcl_interfaces.srv import ListParameters
from rclpy.qos import QoSProfile
from robots import crate
from sensor_msgs.msg import Image, JointState
from simulated import OK, PAUSED, PLAYING, Simulated
from simulation_interfaces.msg import EntityFilters, EntityState, Resource
from simulation_interfaces.srv import GetEntities
from visualization_msgs.msg import Marker, MarkerArray

from arm_description.resources import resolve_uri
from arm_description.xacro.expansion import expand_xacro

CRATE = crate(size=0.2)
WALL = """<sdf version="1.9"><model name="wall"><static>true</static><link name="l">
  <visual name="v"><geometry><box><size>6 6 6</size></box></geometry>
  <material><diffuse>1 0 0 1</diffuse></material></visual></link></model></sdf>"""
SPAWNED = "joint_state_broadcaster,position_controller"
CONTROLLERS = {
    "controller_manager": {
        "joint_state_broadcaster": {"type": "joint_state_broadcaster/JointStateBroadcaster"},
        "position_controller": {"type": "position_controllers/JointGroupPositionController"},
    },
    "position_controller": {"joints": ["j0", "j1", "j2", "j3"]},
}
START_TIMEOUT_S = 120.0


@pytest.fixture(scope="module")
def arm(simulate):
    """Run the simulation of the arm with its camera, its forearm held up."""
    xacro = str(resolve_uri("package://arm_description/urdf/arm.urdf.xacro"))
    pose = {"j1_pos": "0.5", "j2_pos": "0.5"}
    settings = {"robot_description": expand_xacro(xacro, pose), "spawn": SPAWNED}
    simulate({"arm_gazebo": settings, **CONTROLLERS})


@pytest.fixture
def simulator(arm, client) -> Simulated:
    return Simulated(client)


def test_the_arm_holds_while_entities_are_spawned_moved_and_deleted(simulator, client):
    states = client.subscribe(JointState, "/joint_states")
    states.wait_for(10, START_TIMEOUT_S)
    start_s = stamp_s(states.messages[-1])
    for number in range(5):
        simulator.spawn(f"crate_{number}", CRATE, 3.0, 3.0, 0.1 + 0.25 * number)
    simulator.move("crate_2", 2.0, -3.0, 0.5)
    for number in range(5):
        simulator.delete(f"crate_{number}")
    states.wait_until(lambda m: stamp_s(m[-1]) > start_s + 1.0, "a second more")
    held = np.array([message.position for message in states.messages])
    assert np.abs(held - [0.0, 0.5, 0.5, 0.0]).max() < 0.005
    assert np.all(np.diff([stamp_s(message) for message in states.messages]) > 0)


@pytest.mark.parametrize("node", ["simulation", "arm_gazebo", "controller_manager"])
def test_every_node_has_parameters(arm, client, node):
    answer = client.call(ListParameters, f"/{node}/list_parameters", ListParameters.Request())
    assert "use_sim_time" in answer.result.names


def test_the_camera_sees_a_spawned_entity(simulator, client):
    def red(message: Image) -> float:
        pixels = np.frombuffer(message.data, np.uint8).reshape(-1, 3).astype(int)
        return float(np.mean((pixels[:, 0] > 80) & (pixels[:, 1:].max(axis=1) < 60)))

    pictures = client.subscribe(Image, "/videocamera")
    pictures.wait_until(lambda m: bool(m) and red(m[-1]) < 0.01, "no wall", START_TIMEOUT_S)
    # The camera looks along -y.
    simulator.spawn("wall", WALL, 0.0, -6.0, 0.0)
    pictures.wait_until(lambda m: red(m[-1]) > 0.1, "the red wall")
    simulator.delete("wall")
    seen = pictures.wait_until(lambda m: red(m[-1]) < 0.01, "no wall any more")
    assert red(seen[-1]) < 0.01


def test_markers_show_the_world(simulator, client, latched):
    arrays = client.subscribe(MarkerArray, "/world_markers", latched)

    def of(owner: str, messages: list) -> list[Marker]:
        return [marker for marker in messages[-1].markers if marker.ns == owner]

    arrays.wait_until(lambda m: bool(m) and of("world", m), "the floor")
    assert arrays.messages[-1].markers[0].header.frame_id == "world"
    simulator.spawn("crate", CRATE, 3.0, 3.0, 0.1)
    arrays.wait_until(
        lambda m: [(k.id, k.type, k.scale.x) for k in of("crate", m)] == [(0, Marker.CUBE, 0.2)],
        "the crate",
    )
    simulator.move("crate", 2.0, -3.0, 0.1)
    arrays.wait_until(
        lambda m: any(abs(k.pose.position.y + 3.0) < 0.05 for k in of("crate", m)),
        "the crate at its new place",
    )
    simulator.delete("crate")
    arrays.wait_until(
        lambda m: [k.action for k in of("crate", m)] == [Marker.DELETE], "the crate's end"
    )


def test_contacts_are_markers_while_somebody_subscribes(simulator, client, latched):
    arrays = client.subscribe(MarkerArray, "/contact_markers", latched)

    def lines(messages: list) -> list[str]:
        return messages[-1].markers[1].text.splitlines() if messages else []

    simulator.spawn("crate", CRATE, 3.0, 3.0, 0.1)
    weight = arrays.wait_until(
        lambda m: any(re.fullmatch(r"crate::\w+ on world: 9\.8\d? N", t) for t in lines(m)),
        "the crate rests on the floor",
    )
    points, forces = weight[-1].markers
    assert (points.type, forces.type) == (Marker.SPHERE_LIST, Marker.LINE_LIST)
    assert points.header.frame_id == "world"
    assert 2 * len(points.points) == len(forces.points) > 0
    # The floor pushes up.
    assert forces.points[1].z > forces.points[0].z
    simulator.delete("crate")
    arrays.wait_until(
        lambda m: {marker.action for marker in m[-1].markers} == {Marker.DELETE}, "nothing touches"
    )


def test_time_stops_and_advances_by_steps(simulator, client):
    simulator.spawn("crate", CRATE, 3.0, 3.0, 2.0)
    simulator.go_to(PAUSED)
    simulator.move("crate", 3.0, 3.0, 5.0)
    before_s, place = simulator.where("crate")
    assert place == pytest.approx([3.0, 3.0, 5.0])
    simulator.do("StepSimulation", steps=20)
    after_s, fallen = simulator.where("crate")
    assert after_s - before_s == pytest.approx(0.2, abs=1e-6)
    assert fallen[2] == pytest.approx(5.0 - 0.5 * 9.81 * 0.2**2, abs=0.02)
    simulator.go_to(PLAYING)
    client.wait_until(lambda: simulator.where("crate")[0] > after_s, "time going on")
    simulator.delete("crate")


def test_forty_requests_at_once_are_all_answered(simulator, client):
    # With the usual ten, the client itself loses answers.
    deep = QoSProfile(depth=100)
    service = client.node.create_client(GetEntities, "/get_entities", qos_profile=deep)
    client.wait_until(service.service_is_ready, "/get_entities")
    client.be_known_to_server("/get_entities")
    request = GetEntities.Request()
    answers = client.run(lambda: [service.call_async(request) for _ in range(40)], "requests")
    client.wait_until(lambda: all(answer.done() for answer in answers), "forty answers")
    assert {answer.result().result.result for answer in answers} == {OK}


def test_a_long_run_of_steps_can_be_cancelled(simulator, client):
    simulator.go_to(PAUSED)
    before_s, _ = simulator.where("arm")
    steps = simulator.start("StepSimulation", steps=2**40)
    client.wait_until(lambda: simulator.where("arm")[0] > before_s + 1.0, "a second of steps")
    simulator.go_to(PAUSED)
    result = client.result_of(steps, "step_simulation").result
    assert result.result == result.RESULT_OPERATION_FAILED
    assert f" of {2**40} steps: the state was changed" in result.error_message
    simulator.go_to(PLAYING)


def test_the_arm_continues_in_another_world(simulator, client):
    assert simulator.do("LoadWorld", world_resource=Resource(uri="shapes")).world.name == "shapes"
    assert "cone" in simulator.do("GetEntities").entities
    simulator.go_to(PLAYING)
    states = client.subscribe(JointState, "/joint_states")
    states.wait_for(20)
    held = np.array([message.position for message in states.messages])
    assert np.abs(held - [0.0, 0.5, 0.5, 0.0]).max() < 0.005


def test_invalid_requests_are_refused_with_a_sentence(simulator):
    for service, fields in (
        ("SpawnEntity", {"name": "a", "entity_resource": Resource(resource_string="<a")}),
        ("SpawnEntity", {"name": "a b", "entity_resource": Resource(resource_string=CRATE)}),
        ("DeleteEntity", {"entity": "arm"}),
        ("GetEntityState", {"entity": "nobody"}),
        ("GetEntities", {"filters": EntityFilters(filter="(")}),
        ("SetEntityState", {"entity": "cone", "state": nowhere(), "set_pose": True}),
        ("SetEntityState", {"entity": "cone", "state": EntityState(), "set_acceleration": True}),
        ("SetEntityState", {"entity": "cone", "state": EntityState()}),
        ("LoadWorld", {"world_resource": Resource(uri="nowhere")}),
    ):
        answer = simulator.ask(service, **fields)
        assert answer.result.result != OK, (service, fields)
        assert len(answer.result.error_message.split()) > 2, (service, answer)


def nowhere():
    """Return a state whose pose is not a number."""
    state = EntityState()
    state.pose.position.x = float("nan")
    return state


def stamp_s(message) -> float:
    return message.header.stamp.sec + message.header.stamp.nanosec * 1e-9
