"""`arm sim replay` for programs: lines of JSON, and a bag of what ran again."""

import json
from dataclasses import replace

import numpy as np
import pytest
from rclpy.serialization import deserialize_message
from sensor_msgs.msg import JointState
from visualization_msgs.msg import MarkerArray

from arm_cli.bag_format.reader import BagReader
from arm_cli.main import main
from arm_gazebo.recording.run_file import RunFile, RunFileWriter, StateBlock
from arm_sim import Simulation

PERIODS = 30
TOPICS = (
    *("/clock", "/contact_markers", "/joint_states", "/robot_description", "/tf"),
    "/world_markers",
)


@pytest.fixture(scope="module")
def recorded(tmp_path_factory):
    """Return a recording of 30 control periods, in which the clock goes back in the middle."""
    path = tmp_path_factory.mktemp("run") / "arm.run"
    arguments = {"camera": "none"}
    with Simulation("arm", world="objects", record=path, arguments=arguments) as sim:
        sim["position_controller"].command([0.4, 0.3, 0.2, 0.1])
        sim.run(0.15)
        sim.reset()
        sim.run(0.15)
    return path


@pytest.fixture
def replayed(recorded, tmp_path, capsys):
    """Return a function that replays into a bag; it returns exit code, lines and the bag."""

    def run(path=recorded):
        code = main(["sim", "replay", str(path), "--json", "--bag", str(tmp_path / "bag")])
        return code, [*map(json.loads, capsys.readouterr().out.splitlines())], tmp_path / "bag"

    return run


def test_progress_and_result_are_lines_of_json(replayed):
    code, (first, *_, last), _ = replayed()
    assert (code, first) == (0, {"periods": 0, "of_periods": PERIODS, "period_s": 0.01})
    result = last["result"]
    assert (result["periods"], result["difference"]) == (PERIODS, None)
    assert not result["is_cut_off"]


def test_the_bag_has_each_joint_state_and_its_time_never_goes_back(replayed):
    with BagReader(replayed()[2]) as bag:
        messages = list(bag.messages(TOPICS))
    times_ns = [message.log_time_ns for message in messages]
    assert times_ns == sorted(times_ns)
    states = [m for m in messages if m.topic == "/joint_states"]
    assert np.allclose([m.log_time_ns for m in states], np.arange(PERIODS + 1) * 1e7)
    read = [deserialize_message(m.data, JointState) for m in states]
    assert read[0].name == ["j0", "j1", "j2", "j3"]
    assert read[15].position[0] > 0.01
    assert {message.topic for message in messages} == set(TOPICS)
    shapes = next(m for m in messages if m.topic == "/world_markers")
    owners = {marker.ns for marker in deserialize_message(shapes.data, MarkerArray).markers}
    assert "pink_cylinder" in owners


def test_the_bag_has_the_forces_where_things_touch(replayed, tmp_path):
    box = "<mujoco><worldbody><body name='crate'><freejoint/><geom type='box' \
size='.05 .05 .05' mass='1'/></body></worldbody></mujoco>"
    arguments = {"camera": "none"}
    with Simulation("arm", record=tmp_path / "box.run", arguments=arguments) as simulation:
        simulation.spawn(box, name="crate", pose=(0.5, 0.0, 0.049))
        simulation.run(0.3)
    with BagReader(replayed(tmp_path / "box.run")[2]) as bag:
        found = [
            deserialize_message(m.data, MarkerArray) for m in bag.messages(["/contact_markers"])
        ]
    told = [message.markers[1].text for message in found]
    assert told[0] == ""
    assert any(text.startswith("crate::crate on world: ") for text in told), told


def test_files_of_the_bag_are_named_when_they_are_complete(replayed, monkeypatch):
    for setting in ("PROGRESS_S", "MIN_PART_S"):
        monkeypatch.setattr(f"arm_cli.sim.recordings.{setting}", 0.0)
    monkeypatch.setattr("arm_cli.sim.recordings.MAX_PART_S", 0.0)
    _, told, folder = replayed()
    named = [(line["file"], line["periods"]) for line in told if "file" in line]
    assert [periods for _, periods in named] == list(range(PERIODS + 1))
    for name, periods in named:
        with BagReader(folder / name) as part:
            times_ns = [m.log_time_ns for m in part.messages(["/joint_states"])]
        assert times_ns == [periods * 10_000_000]
    with BagReader(folder) as bag:
        assert len(list(bag.messages(["/joint_states"]))) == PERIODS + 1


def test_a_difference_ends_the_bag(recorded, replayed, tmp_path):
    file = RunFile(recorded)
    header = {name: value for name, value in file.header.items() if name != "format"}
    writer = RunFileWriter(tmp_path / "other.run", header)
    for record in file.records():
        if isinstance(record, StateBlock):
            hashes = record.hashes.copy()
            hashes[record.first + np.arange(len(hashes)) == 20] += 1
            record = replace(record, hashes=hashes)
        writer.write(record)
    writer.close()
    code, (*_, last), bag = replayed(tmp_path / "other.run")
    assert code == 1
    assert (last["result"]["periods"], last["result"]["difference"]["period"]) == (20, 20)
    with BagReader(bag) as written:
        assert max(m.log_time_ns for m in written.messages(TOPICS)) == 200_000_000


def test_it_is_written_or_published(recorded, capsys):
    assert main(["sim", "replay", str(recorded), "--publish", "--bag", "x"]) == 1
    assert "either written or published" in capsys.readouterr().err
