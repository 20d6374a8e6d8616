"""`arm dataset record` while somebody else commands the arm."""

import json
from pathlib import Path

import pyarrow.parquet as pq
import pytest

pytestmark = [pytest.mark.ros, pytest.mark.usefixtures("simulation_with_camera")]

COMMAND = (
    "arm topic pub --rate 10 /position_controller/commands "
    'std_msgs/msg/Float64MultiArray "data: [0.3, 0.2, 0.0, -0.1]"'
)


def test_a_running_robot_is_recorded_as_a_dataset(start, run, tmp_path: Path):
    commander = start(COMMAND)
    commander.wait_for("publishing #1:")
    said = run("arm dataset record wave --task 'Lean left.' --episodes 2 --duration 5")
    commander.interrupt()
    assert "wrote wave: 2 episodes" in said
    assert "observation.images." in said
    info = json.loads((tmp_path / "wave/meta/info.json").read_text())
    assert (info["total_episodes"], info["fps"]) == (2, 30)
    rows = pq.read_table(tmp_path / "wave/data/chunk-000/file-001.parquet")
    assert rows["action"].to_pylist()[-1] == pytest.approx([0.3, 0.2, 0.0, -0.1])
    assert rows["observation.state"].to_pylist()[-1] == pytest.approx(
        [0.3, 0.2, 0.0, -0.1], abs=0.01
    )
    # The messages themselves stay, and can be converted again.
    again = run("arm dataset convert wave_bags/episode_000001 -o again --task 'Lean.' --fps 10")
    assert "wrote again: 1 episodes" in again
    assert run("arm dataset check again") == "again is valid in LeRobot's format v3.0\n"
    run("arm dataset record wave --task 'Lean left.'", code=1)
