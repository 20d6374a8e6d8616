"""`arm doctor` beside a running simulation with faults that are cheap to cause."""

import json
from collections.abc import Iterator

import psutil
import pytest
from rclpy.qos import QoSProfile, ReliabilityPolicy
from rclpy.time import Time
from rosgraph_msgs.msg import Clock
from sensor_msgs.msg import JointState
from std_msgs.msg import Float64MultiArray, String
from trajectory_msgs.msg import JointTrajectory

from arm_cli.doctor.diagnosis import Severity
from arm_cli.doctor.verb import SIMULATION

pytestmark = pytest.mark.usefixtures("simulation")

BEST_EFFORT = QoSProfile(depth=10, reliability=ReliabilityPolicy.BEST_EFFORT)


@pytest.fixture
def doctor(run_until):
    """Return a function that runs the doctor until its findings meet a condition."""

    def ask(is_right, code: int) -> dict[str, dict]:
        def fits(text: str) -> bool:
            found = _by_check(text)
            # One look may be too short to find the simulation.
            return SIMULATION not in found and is_right(found)

        # The compilers are not what is looked at here. What is printed on stderr is not JSON.
        line = "env CC=true CXX=true arm doctor --json 2>/dev/null"
        return _by_check(run_until(line, fits, code))

    return ask


def _by_check(text: str) -> dict[str, dict]:
    report = json.loads(text)
    assert report["healthy"] is all(f["severity"] != "error" for f in report["findings"])
    return {finding["check"]: finding for finding in report["findings"]}


def test_a_healthy_simulation(doctor):
    checks = ("description", "hardware", "controllers", "claims", "clock", "QoS", "commands")
    checks += ("joint states",)
    found = doctor(lambda f: all(f[name]["severity"] == "ok" for name in checks), code=0)
    assert found["claims"]["sentence"] == "4 joints are commanded by active controllers"
    assert found["duplicate publishers"]["severity"] == "ok"
    assert found["hardware"]["sentence"].endswith(" active")
    assert float(found["real-time factor"]["sentence"].split()[0].rstrip(",")) > 0.0


def test_foreign_publishers_and_mismatches(look, client):
    client.node.create_publisher(JointState, "/joint_states", 10)
    client.node.create_publisher(String, "/whisper", BEST_EFFORT)
    client.node.create_subscription(String, "/whisper", lambda _: None, 10)
    # A node's name arrives later than its end points, seldom too late for one look.
    names = "/whisper from /test_client to /test_client: "
    found = look(
        lambda f: (
            names in f["QoS"].sentence and "/test_client" in f["duplicate publishers"].sentence
        )
    )
    assert found["QoS"].severity is Severity.WARNING
    assert "est effort publisher" in found["QoS"].sentence
    duplicate = found["duplicate publishers"]
    assert duplicate.severity is Severity.ERROR
    assert duplicate.sentence.startswith("/joint_states is published by ")
    assert "/test_client" in duplicate.sentence


def test_an_inactive_controller_and_a_command_without_effect(look, run, client):
    run("arm control set_controller_state position_controller inactive")
    commands = client.publisher(Float64MultiArray, "/position_controller/commands")
    client.node.create_timer(0.05, lambda: commands.publish(Float64MultiArray(data=[0.0] * 4)))
    found = look(lambda f: f["commands"].severity is Severity.ERROR)
    assert found["controllers"].sentence.startswith("position_controller is inactive")
    assert found["claims"].severity is Severity.ERROR
    assert "position_controller is inactive" in found["commands"].sentence
    # The fix beside it mends it.
    run(found["claims"].fix)
    arrive = "commands arrive on /position_controller/commands"
    # In a look that is too short none arrives, which is not an error.
    mended = look(lambda f: f["commands"].sentence == arrive)
    assert mended["claims"].severity is Severity.OK
    assert mended["commands"].severity is Severity.OK


@pytest.fixture
def send_trajectories(client):
    """Return a function that sends trajectories repeatedly, stamped by a clock."""

    def begin(stamp) -> None:
        trajectories = client.node.create_publisher(JointTrajectory, "/c/joint_trajectory", 10)
        client.node.create_subscription(JointTrajectory, "/c/joint_trajectory", lambda _: None, 10)

        def send() -> None:
            message = JointTrajectory()
            message.header.stamp = stamp().to_msg()
            trajectories.publish(message)

        client.node.create_timer(0.05, send)

    return begin


def test_a_command_by_the_wall_clock_and_a_second_clock(look, client, send_trajectories):
    send_trajectories(client.node.get_clock().now)
    client.node.create_publisher(Clock, "/clock", 10)
    found = look(lambda f: f["commands"].severity is Severity.ERROR)
    assert "ahead of the simulation's time" in found["commands"].sentence
    assert "use_sim_time" in found["commands"].fix
    assert found["duplicate publishers"].sentence.startswith("/clock is published by ")


def process_of(simulation, name: str) -> psutil.Process:
    [process] = simulation.processes(name)
    return process


@pytest.fixture
def without_description(simulation) -> Iterator[None]:
    """Stop the state publisher."""
    node = process_of(simulation, "robot_state_publisher")
    node.suspend()
    yield
    node.resume()


@pytest.mark.usefixtures("without_description")
def test_hardware_description_and_an_old_command(look, run, send_trajectories):
    component = "HardwareInterface_MuJoCo"
    run(f"arm control set_hardware_component_state {component} inactive")
    send_trajectories(lambda: Time(nanoseconds=1))
    broken = ("hardware", "description", "commands")
    found = look(lambda f: all(f[name].severity is Severity.ERROR for name in broken))
    assert found["hardware"].sentence.startswith(f"{component} is inactive")
    assert "/robot_description" in found["description"].sentence
    assert "is stale: it ended " in found["commands"].sentence
    # The fix beside it mends it.
    assert run(found["hardware"].fix).startswith(f"Successfully set {component} to state ")


def test_a_simulation_that_is_stuck(doctor, simulation):
    node = process_of(simulation, "arm_gazebo_node")
    node.suspend()
    try:
        # A node's name arrives later than its end points, seldom too late for one look.
        found = doctor(
            lambda f: "/robot_state_publisher" in f.get("joint states", {}).get("sentence", ""),
            code=1,
        )
    finally:
        node.resume()
    assert found["joint states"]["severity"] == "error"
    assert "nobody publishes /joint_states" in found["joint states"]["sentence"]
    assert found["clock"]["sentence"] != "/clock advances, from /arm_gazebo"
