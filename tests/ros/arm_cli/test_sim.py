"""`arm sim` beside a running simulation: its contents, spawned entities and time."""

import json
import re

import pytest

pytestmark = pytest.mark.usefixtures("simulation_with_camera")

CAN = """<sdf version="1.9"><model name="tin"><static>true</static><link name="l">
<collision name="c"><geometry><cylinder><radius>0.03</radius><length>0.1</length></cylinder>
</geometry></collision></link></model></sdf>"""


def entities(text: str) -> dict[str, dict]:
    return {entity["name"]: entity for entity in json.loads(text)["entities"]}


def test_an_entity_is_spawned_and_deleted(run_until, tmp_path):
    (tmp_path / "can.sdf").write_text(CAN)
    # Whether or not an answer is lost on a busy machine, it is done.
    spawn = "arm sim spawn can.sdf --name can --pose 0.3 0 0.5 0 0 0 >&2; arm sim info --json"

    def is_complete(text: str) -> bool:
        # A look may be too short for the clock and for the camera, which starts later.
        report = json.loads(text)
        measured = min(report["time_s"], report["real_time_factor"]) > 0.0
        return "can" in entities(text) and measured and "/videocamera" in report["sensors"]

    text = run_until(spawn, is_complete)
    report = json.loads(text)
    assert (report["state"], report["world"]) == ("playing", "empty")
    assert report["sensors"]["/videocamera"] == "sensor_msgs/msg/Image"
    assert entities(text)["arm"]["category"] == "robot"
    assert entities(text)["can"]["position"] == pytest.approx([0.3, 0.0, 0.5], abs=1e-6)
    move = "arm sim move can -0.3 0.1 0.4 0 0 1.57 && arm sim move can -0.3 0.2 0.4 && "
    moved = entities(run_until(f"{move}arm sim info --json", lambda text: "can" in text))["can"]
    assert moved["position"] == pytest.approx([-0.3, 0.2, 0.4], abs=1e-6)
    assert moved["orientation"] == pytest.approx([0.0, 0.0, 0.7068, 0.7074], abs=1e-3)
    run_until("arm sim move can 1 2 3 4", lambda text: "X Y Z ROLL PITCH YAW" in text, code=2)
    delete = "arm sim delete can; arm sim info --json"
    run_until(delete, lambda text: entities(text).keys() == {"arm"})
    run_until("arm sim delete can", lambda text: "'can'" in text, code=1)


def test_a_state_is_saved_by_name_and_in_a_file_and_restored(run_until):
    saved = "arm sim save a >&2; arm sim save b.snapshot >&2; arm sim list"
    run_until(saved, lambda text: re.fullmatch(r"a: \d+\.\d{3} s in the world empty\n", text))
    for name in ("a", "b.snapshot"):
        run_until(f"arm sim restore {name}", lambda text: " s in the world empty" in text)
    run_until("arm sim restore c", lambda text: "no snapshot 'c'" in text, code=1)
    text = run_until("arm sim remove a >&2; arm sim list --json", lambda text: bool(text))
    assert json.loads(text) == {}


def test_time_stands_still_and_goes_on(run_until):
    paused = "arm sim pause; arm sim step 10; arm sim info"
    text = run_until(paused, lambda text: text.startswith("state: paused\nworld: empty\n"))
    assert re.search(r"^time: \d+\.\d{3} s, real-time factor 0\.00$", text, re.MULTILINE)
    assert re.search(r"^entities:\n  arm \[robot\] at ", text, re.MULTILINE)
    resumed = "arm sim reset; arm sim play; arm sim info"
    run_until(resumed, lambda text: text.startswith("state: playing\n"))
