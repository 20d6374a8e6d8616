"""`arm dataset record` while somebody else commands the arm."""

import json
from collections import Counter
from pathlib import Path

import pyarrow.parquet as pq
import pytest

pytestmark = pytest.mark.usefixtures("simulation_with_camera")

COMMAND = (
    "arm topic pub --rate 10 /position_controller/commands "
    'std_msgs/msg/Float64MultiArray "data: [0.3, 0.2, 0.0, -0.1]"'
)
RECORD = "arm dataset record wave --task 'Lean left.'"
ENOUGH = Counter({"/joint_states": 150, "/videocamera": 20, "/position_controller/commands": 10})


@pytest.fixture
def commander(start):
    """Command the arm."""
    start(COMMAND).wait_for("publishing #1:")


def info_of(dataset: Path) -> dict:
    return json.loads((dataset / "meta/info.json").read_text())


@pytest.mark.usefixtures("commander")
def test_a_running_robot_is_recorded_as_a_dataset(start, run, counts, tmp_path):
    recorder, bag = start(RECORD), tmp_path / "wave_bags/episode_000000"
    recorder.wait_until(lambda: counts(bag) >= ENOUGH, "enough of every topic")
    assert recorder.interrupt() == 0, recorder.err
    said = recorder.out + recorder.err
    assert "wrote wave: 1 episodes" in said
    assert "observation.images." in said
    info = info_of(tmp_path / "wave")
    # A busy machine draws fewer than the camera's 30 pictures a second.
    assert info["total_episodes"] == 1
    assert info["fps"] in range(5, 31)
    rows = pq.read_table(tmp_path / "wave/data/chunk-000/file-000.parquet")
    assert rows["action"].to_pylist()[-1] == pytest.approx([0.3, 0.2, 0.0, -0.1])
    assert rows["observation.state"].to_pylist()[-1] == pytest.approx(
        [0.3, 0.2, 0.0, -0.1], abs=0.01
    )
    # The messages themselves stay, and can be converted again.
    again = run("arm dataset convert wave_bags/episode_000000 -o again --task 'Lean.' --fps 10")
    assert "wrote again: 1 episodes" in again
    assert run("arm dataset check again") == "again is valid in LeRobot's format v3.0\n"
    run(RECORD, code=1)


@pytest.mark.usefixtures("commander")
def test_episodes_follow_one_another(run, tmp_path):
    assert "wrote wave: 2 episodes" in run(f"{RECORD} --episodes 2 --duration 1 --cameras")
    assert info_of(tmp_path / "wave")["total_episodes"] == 2
    rows = pq.read_table(tmp_path / "wave/data/chunk-000/file-000.parquet")
    assert set(rows["episode_index"].to_pylist()) == {0, 1}
