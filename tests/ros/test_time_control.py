"""The pace of a simulation changes while it runs, and steps are answered when all is published."""

import pytest
from diagnostic_msgs.msg import DiagnosticArray
from diagnostic_msgs.srv import SelfTest
from sensor_msgs.msg import Image, JointState
from simulated import PAUSED, PLAYING, Simulated
from std_msgs.msg import Float64MultiArray

from arm_description.resources import resolve_uri
from arm_description.xacro.expansion import expand_xacro

START_TIMEOUT_S = 120.0
PERIOD_S = 0.01
RATE_HZ = 25.0
"""Of the camera: a picture in every fourth control period."""
DEPTH = 1000


def stamp_s(message) -> float:
    return message.header.stamp.sec + message.header.stamp.nanosec * 1e-9


def ticks(messages: list) -> list[int]:
    """Return the control periods of stamped messages, counted from the start."""
    return [round(stamp_s(message) / PERIOD_S) for message in messages]


@pytest.fixture(scope="module")
def simulation(simulate):
    """Run the simulation of the arm with its camera, paused."""
    arm = str(resolve_uri("package://arm_description/urdf/arm.urdf.xacro"))
    description = expand_xacro(arm, {}).replace("<update_rate>30", f"<update_rate>{RATE_HZ:g}")
    assert f"<update_rate>{RATE_HZ:g}" in description
    settings = {
        "robot_description": description,
        "spawn": "joint_state_broadcaster,turner",
        "paused": True,
        "real_time_factor": 4,
    }
    broadcaster = {"type": "joint_state_broadcaster/JointStateBroadcaster"}
    simulate(
        {
            "arm_gazebo": settings,
            "controller_manager": {
                "joint_state_broadcaster": broadcaster,
                "turner": {"type": "velocity_controllers/JointGroupVelocityController"},
            },
            "turner": {"joints": ["j0"], "command_timeout": 0.5},
        }
    )


class Simulator(Simulated):
    """The simulation with its statistics."""

    def step(self, steps: int, service: str = "") -> None:
        self.do("StepSimulation", service, steps=steps)

    def figures(self) -> dict[str, dict[str, str]]:
        answer = self.client.call(SelfTest, "/simulation/get_statistics", SelfTest.Request())
        assert answer.passed == b"\x01", answer
        return {
            status.name: {pair.key: pair.value for pair in status.values}
            for status in answer.status
        }

    def tick(self) -> int:
        """Return the number of the last control period."""
        return round(float(self.figures()["time"]["simulated time (s)"]) / PERIOD_S)


@pytest.fixture
def simulator(simulation, client) -> Simulator:
    return Simulator(client)


@pytest.fixture
def subscribed(simulator, client):
    """Collect the messages of a topic, once they are seen to come; the simulation is paused."""

    def collect(message_type: type, topic: str):
        # Steps are not paced: their messages come faster than a client in Python takes them.
        collector = client.subscribe(message_type, topic, DEPTH)

        def comes() -> bool:
            simulator.step(4, "step_simulation_with_sensors")
            return bool(collector.messages)

        client.wait_until(comes, f"messages on {topic}", START_TIMEOUT_S)
        # All of them have been sent, the last at this time at the latest.
        last = simulator.tick()
        return collector, last

    return collect


def test_a_step_is_answered_when_its_states_are_out(simulator, subscribed):
    states, last = subscribed(JointState, "/joint_states")
    states.wait_until(lambda m: ticks(m)[-1] == last, "the states so far")
    states.clear()
    simulator.step(25)
    assert simulator.tick() == last + 25
    states.wait_until(lambda m: len(m) >= 25, "a state of each step")
    assert ticks(states.messages) == list(range(last + 1, last + 26))


def test_steps_with_sensors_take_every_picture(simulator, subscribed):
    pictures, last = subscribed(Image, "/videocamera")
    pictures.wait_until(lambda m: ticks(m)[-1] == last - last % 4, "the pictures so far")
    pictures.clear()
    simulator.step(40, "step_simulation_with_sensors")
    due = [tick for tick in range(last + 1, last + 41) if tick % 4 == 0]
    pictures.wait_until(lambda m: len(m) >= len(due), "ten pictures")
    assert ticks(pictures.messages) == due
    camera = next(f for n, f in simulator.figures().items() if n.startswith("camera: "))
    assert camera["requested rate (Hz of simulation time)"] == f"{RATE_HZ:g}"
    assert int(camera["published"]) >= len(due)


def test_a_change_of_the_speed_loses_no_tick_and_no_message(simulator, client, subscribed):
    states, _ = subscribed(JointState, "/joint_states")
    states.clear()
    simulator.go_to(PLAYING)
    # No faster, or a busy machine loses messages on their way to this process.
    for factor in (0.5, 4.0, 1.0, 3.0, 2.0):
        assert simulator.set(real_time_factor=factor) == ""
        count = len(states.messages)
        states.wait_until(lambda m, count=count: len(m) > count + 20, "more states")
    simulator.go_to(PAUSED)
    last = simulator.tick()
    states.wait_until(lambda m: ticks(m)[-1] == last, "the last state")
    seen = ticks(states.messages)
    assert seen == list(range(seen[0], last + 1))
    assert simulator.figures()["time"]["requested real-time factor"] == "2"


@pytest.mark.parametrize(
    ("value", "reason"),
    [
        (-1.0, "real_time_factor out of range Min: 0.0"),
        ("fast", "Wrong parameter type, expected 'Type.DOUBLE'"),
        (8, "Wrong parameter type, expected 'Type.DOUBLE'"),
    ],
)
def test_a_speed_that_is_none_is_refused(simulator, value, reason):
    assert reason in simulator.set(real_time_factor=value)


def test_statistics_come_once_a_second(simulator, client):
    reports = client.subscribe(DiagnosticArray, "/simulation/statistics")
    simulator.go_to(PLAYING)
    reports.clear()
    # The first of them may be about the pause, too.
    (*_, report) = reports.wait_for(3)
    simulator.go_to(PAUSED)
    parts = {s.name: {pair.key: pair.value for pair in s.values} for s in report.status}
    assert float(parts["time"]["achieved real-time factor"]) > 0.0
    assert int(parts["tick"]["ticks measured"]) > 0
    phases = ("update", "write", "physics", "read", "publish")
    costs = [float(parts["tick"][f"{phase} (us)"]) for phase in phases]
    assert sum(costs) == pytest.approx(float(parts["tick"]["whole (us)"]), abs=0.5)
    assert float(parts["physics"]["potential energy (J)"]) > 0.0


def test_a_joint_stops_when_its_commands_cease(simulator, client):
    commands = client.publisher(Float64MultiArray, "/turner/commands")
    states = client.subscribe(JointState, "/joint_states", DEPTH)
    assert simulator.set(real_time_factor=2.0) == ""
    simulator.go_to(PLAYING)
    commands.publish(Float64MultiArray(data=[0.3]))
    # It may have stopped before this thread looks.
    states.wait_until(lambda m: any(each.velocity[0] > 0.25 for each in m), "j0 turning")
    states.wait_until(lambda m: abs(m[-1].velocity[0]) < 0.001, "j0 at rest")
    simulator.go_to(PAUSED)
    turning = [stamp_s(message) for message in states.messages if message.velocity[0] > 0.25]
    # From the command to the timeout, in simulation time.
    assert 0.4 < turning[-1] - turning[0] < 0.7
