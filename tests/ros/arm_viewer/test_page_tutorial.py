"""The tutorial of the page, step by step, with the requests that its buttons send."""

import re
from contextlib import closing
from pathlib import Path

import pytest

from arm_viewer.planning import Activity, named_poses
from arm_viewer.recordings.player import Player
from arm_viewer.recordings.recorder import Recorder
from arm_viewer.requests import DragTip, PlanMotion, SetGoal
from arm_viewer.ros.recorded_state import RecordedState
from arm_viewer.world.shape_fields import read_pose

pytestmark = pytest.mark.timeout(600)

PAGE = Path(__file__).parents[3] / "docs/tutorials/page.md"
ROW = re.compile(r"\| ([^|`]+) \| `(\w+)` \| `([^`]+)` \| (?:`([^`]+)`)? *\|")
CYLINDER, LIFT_M = "red_cylinder", 0.08


@pytest.fixture
def page(launch, new_viewer):
    """Return the page's node beside the launch of the tutorial."""
    launch("mycobot", "planning:=true").wait_until_ready()
    page = new_viewer()
    page.seen(lambda s: s.planning.get("") and s.joint_states and s.world and s.world.things)
    return page


def do(page, group: str, place: str, turned: str) -> None:
    """Set the goal of a row, and move there."""
    before = page.node.latest().planning[""]
    if turned:
        page.node.send(DragTip("", group, read_pose(place, turned), avoids=True))
    else:
        page.node.send(SetGoal("", group, named_poses(before.model, group)[place]))
    page.seen(lambda s: s.planning[""].goal is not before.goal and s.planning[""].goal)
    page.node.send(PlanMotion("", 1.0, 1.0, executes=True))
    page.seen(lambda s: s.planning[""].activity is not Activity.NONE)
    after = page.seen(lambda s: s.planning[""].activity is Activity.NONE and s.planning[""])
    assert after.said == "The robot has arrived.", (group, place, after.goal)


def test_a_stranger_picks_the_cylinder_and_replays_it(page, tmp_path):
    node, recorder = page.node, Recorder(tmp_path)
    rows = ROW.findall(PAGE.read_text())
    assert len(rows) == 5
    with closing(recorder), closing(Player(node.latest, node.send, RecordedState)) as player:
        recorder.start_run()
        page.until(lambda: recorder.state.is_recording and not recorder.state.is_starting)
        stood_m = node.latest().world.things[CYLINDER].pose.position[2]
        for _, *row in rows:
            do(page, *row)
        hangs = page.seen(
            lambda s: abs(s.world.things[CYLINDER].pose.position[2] - stood_m - LIFT_M) < 0.01
        )
        assert hangs
        recorder.stop()
        page.until(lambda: not recorder.state.is_recording)
        player.open(recorder.state.path)
        page.until(lambda: player.state.run.is_over)
        assert player.state.run.text.startswith("verified: all "), player.state.run
        page.until(lambda: player.state.name == recorder.state.path.name)
        player.act(lambda playback: playback.seek(playback.length_s))
        replayed = page.until(lambda: cylinder_in(player.latest()))
        assert replayed == pytest.approx(stood_m + LIFT_M, abs=0.01)


def cylinder_in(snapshot) -> float:
    """Return the height of the cylinder in a recording's snapshot; 0 while it stands."""
    heights = [
        marker.pose.position[2]
        for name, marker in snapshot.markers.items()
        if snapshot.replay and f"/{CYLINDER}/" in name
    ]
    return heights[0] if heights and heights[0] > 0.2 else 0.0
