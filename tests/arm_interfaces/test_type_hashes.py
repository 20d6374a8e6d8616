"""The hashes decide whether two ROS 2 processes take each other's types for the same."""

import ctypes
import importlib
from pathlib import Path

import pytest
from type_description_interfaces.srv import GetTypeDescription


class TypeHash(ctypes.Structure):
    """The C struct of rosidl."""

    _fields_ = (("version", ctypes.c_uint8), ("value", ctypes.c_uint8 * 32))


def compiled_hash(type_name: str) -> str:
    """Read the hash out of the installed library, as the middleware does."""
    package = type_name.split("/")[0]
    folder = Path(importlib.import_module(package).__file__).parent
    library = ctypes.CDLL(str(folder / f"lib{package}__rosidl_typesupport_fastrtps_c.so"))
    function = getattr(library, f"{type_name.replace('/', '__')}__get_type_hash")
    function.argtypes = [ctypes.c_void_p]
    function.restype = ctypes.POINTER(TypeHash)
    type_hash = function(None).contents
    return f"RIHS{type_hash.version:02d}_{bytes(type_hash.value).hex()}"


def test_compiled_hashes_are_the_recorded_ones(recorded):
    assert {name: compiled_hash(name) for name in recorded} == recorded


@pytest.mark.ros
def test_hashes_on_the_wire_are_the_recorded_ones(client, start_peer, expected_types):
    recorded = {name: value for name, value in expected_types.items() if "/msg/" in name}
    start_peer("announcer", *recorded)

    def announced() -> dict[str, str]:
        endpoints = {
            name: client.node.get_publishers_info_by_topic(f"/{name}") for name in recorded
        }
        return {name: str(found[0].topic_type_hash) for name, found in endpoints.items() if found}

    client.spin_until(lambda: len(announced()) == len(recorded), "all topics are announced")
    assert announced() == recorded


@pytest.mark.ros
@pytest.mark.parametrize("name", ["tf2_msgs/msg/TFMessage", "simulation_interfaces/msg/Bounds"])
def test_node_describes_its_types(client, start_peer, load_type, expected_types, name):
    start_peer("announcer", name)
    service = client.node.create_client(GetTypeDescription, "/announcer/get_type_description")
    client.spin_until(service.service_is_ready, "the description service")
    client.be_known_to_server(service.service_name)
    # The service looks a type up in the graph, which a node's own topics join a moment later.
    client.spin_until(lambda: client.node.count_publishers(f"/{name}"), "the topic")
    request = GetTypeDescription.Request(type_name=name, type_hash=expected_types[name])
    answer = client.wait_for(service.call_async(request), "the description")
    assert answer.successful, answer.failure_reason
    described = answer.type_description.type_description
    fields = [field.name for field in described.fields]
    assert fields == list(load_type(name).get_fields_and_field_types())
