"""The hashes decide whether two ROS 2 processes take each other's types for the same."""

import signal
import sys
from importlib import import_module
from pathlib import Path

import pytest
import yaml
from programs import RosProgram
from type_description_interfaces.srv import GetTypeDescription

RECORD = Path(__file__).parents[2] / "arm_interfaces" / "expected_types.yaml"
HASHES = {n: h for n, h in yaml.safe_load(RECORD.read_bytes()).items() if "/msg/" in n}


@pytest.fixture
def announce():
    """Return a function that lets another process offer topics of types."""
    started = []

    def start(*types: str) -> None:
        command = [sys.executable, Path(__file__).with_name("announcer.py"), *types]
        started.append(RosProgram(command))

    yield start
    codes = [program.stop(signal.SIGTERM) for program in started]
    for program in started:
        program.close()
    assert codes == [0] * len(started)


def test_their_hashes_are_the_recorded_ones(client, announce):
    announce(*HASHES)

    def announced() -> dict[str, str]:
        ends = {name: client.node.get_publishers_info_by_topic(f"/{name}") for name in HASHES}
        return {name: str(found[0].topic_type_hash) for name, found in ends.items() if found}

    client.wait_until(lambda: len(announced()) == len(HASHES), "all topics are announced")
    assert announced() == HASHES


@pytest.mark.parametrize("name", ["tf2_msgs/msg/TFMessage", "simulation_interfaces/msg/Bounds"])
def test_a_node_describes_its_types(client, announce, name):
    announce(name)
    # The service looks a type up in the graph, which a node's own topics join a moment later.
    client.wait_until(lambda: client.node.count_publishers(f"/{name}"), "the topic")
    request = GetTypeDescription.Request(type_name=name, type_hash=HASHES[name])
    answer = client.call(GetTypeDescription, "/announcer/get_type_description", request)
    assert answer.successful, answer.failure_reason
    package, kind, short = name.split("/")
    fields = getattr(import_module(f"{package}.{kind}"), short).get_fields_and_field_types()
    described = answer.type_description.type_description
    assert [field.name for field in described.fields] == list(fields)
