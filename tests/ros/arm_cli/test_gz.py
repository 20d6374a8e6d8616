"""`arm gz` beside a running simulation: topics, services and models in gz' form."""

import re
import shlex
import time

import pytest

TIMEOUT_S = 120.0


def anything(_text: str) -> bool:
    return True


@pytest.fixture(scope="module")
def gz(launch_for_file, start_for_file):
    launch_for_file("world:=objects").wait_until_ready()

    def run(*words: str, code: int = 0, verb: str = "gz", until=anything) -> str:
        """Run a command line; `until` repeats it, as topics may be discovered too late at first."""
        deadline = time.monotonic() + TIMEOUT_S
        while True:
            command = start_for_file(shlex.join(["arm", verb, *words]))
            ended = command.wait()
            text = command.out if code == 0 else command.err
            if ended == code and until(text):
                return text
            is_over = until is anything or time.monotonic() > deadline
            assert not is_over, command.out + command.err

    # The camera's process starts after the simulation's.
    run("echo", "--once", "/videocamera/camera_info", verb="topic", until=bool)
    return run


def test_topics_are_listed_with_the_world_s_and_the_camera_s(gz):
    topics = {
        "/clock",
        "/stats",
        "/videocamera",
        "/world/objects/clock",
        "/world/objects/dynamic_pose/info",
        "/world/objects/pose/info",
        "/world/objects/stats",
    }
    listed = gz("topic", "-l", until=lambda text: topics <= set(text.splitlines()))
    assert topics <= set(listed.splitlines())
    shown = gz("topic", "-i", "--topic", "/videocamera", until=lambda text: "gz.msgs.Image" in text)
    assert "gz.msgs.Image" in shown


def test_messages_come_in_protobuf_s_form(gz):
    assert re.fullmatch(
        r"(sim \{\n(  sec: \d+\n)?(  nsec: \d+\n)?\}\n\n){2}",
        gz("topic", "-e", "-t", "/clock", "-n", "2"),
    )
    poses = gz("topic", "-e", "-t", "/world/objects/pose/info", "-n", "1")
    assert re.search(r'pose \{\n  name: "\w+"\n  id: 1\n  position \{', poses)
    assert "sim_time {" in gz("topic", "-e", "-t", "/stats", "-n", "1")
    instead = "arm topic echo /videocamera"
    gz("topic", "-e", "-t", "/videocamera", code=2, until=lambda text: instead in text)
    assert "did you mean '/clock'" in gz("topic", "-e", "-t", "/clok", code=1)


def test_models_are_listed_and_shown(gz):
    head, _, listed = gz("model", "--list").partition("Available models:\n")
    assert head == "Requesting state for world [objects]...\n\n"
    names = [line.removeprefix("    - ") for line in listed.splitlines()]
    assert "arm" in names
    shown = gz("model", "-m", names[0], "-p").splitlines()
    assert shown[2:5] == [
        "Model: [1]",
        f"  - Name: {names[0]}",
        "  - Pose [ XYZ (m) ] [ RPY (rad) ]:",
    ]
    assert "no model named <no>" in gz("model", "-m", "no", code=1)


def test_services_say_what_does_the_same(gz):
    assert "/world/objects/control" in gz("service", "-l").splitlines()
    assert "arm sim pause" in gz("service", "-s", "/world/objects/control", "--req", "x", code=2)


def test_a_duration_ends_the_output_although_time_stands_still(gz):
    gz("pause", verb="sim")
    try:
        assert gz("topic", "-e", "-t", "/clock", "-d", "0.5").count("sim {") <= 1
    finally:
        gz("play", verb="sim")
