"""A message is imported when it is first used; for its user nothing else changes."""

import json
import subprocess
import sys

import pytest

pytestmark = pytest.mark.workaround("lazy_messages")

FIRST = """
import sys
from arm_node.environment import prepare_environment
prepare_environment()
"""


def said(code: str, first: str = FIRST) -> list[object]:
    """Return what a new process prints as JSON."""
    command = [sys.executable, "-c", first + "import json\n" + code]
    return json.loads(subprocess.check_output(command, text=True, timeout=60))


def test_only_what_is_used_is_imported():
    code = """
from sensor_msgs.msg import JointState
modules = sorted(name for name in sys.modules if name.startswith(("sensor_msgs.", "numpy")))
JointState()
print(json.dumps([*modules, *sorted(n for n in sys.modules if n.startswith("std_msgs.msg."))]))"""
    assert said(code) == ["sensor_msgs.msg", "sensor_msgs.msg._joint_state", "std_msgs.msg._header"]


def test_every_package_of_the_wheels_has_the_same_classes():
    code = """
import importlib, pathlib
found = {}
for file in pathlib.Path(sys.prefix).glob("lib/python*/site-packages/*/*/__init__.py"):
    package, kind = file.parts[-3:-1]
    if kind in ("msg", "srv", "action"):
        module = importlib.import_module(f"{package}.{kind}")
        values = {name: getattr(module, name) for name in dir(module) if name[0] != "_"}
        found[module.__name__] = sorted(n for n, v in values.items() if isinstance(v, type))
print(json.dumps(found))"""
    lazily, at_once = said(code), said(code, "import sys\n")
    assert len(lazily) > 20
    assert lazily == at_once


def test_a_star_import_a_submodule_and_a_wrong_name():
    code = """
from std_msgs.msg import *
import std_msgs.msg
from std_msgs.msg import _string
try:
    std_msgs.msg.Strung
except AttributeError as error:
    print(json.dumps([String.__name__, std_msgs.msg._bool.Bool is Bool, _string.String is String,
        str(error)]))"""
    message = "module 'std_msgs.msg' has no attribute 'Strung'"
    assert said(code) == ["String", True, True, message]


def test_a_package_that_does_more_than_import_is_imported_as_it_is(tmp_path):
    folder = tmp_path / "own_msgs" / "msg"
    folder.mkdir(parents=True)
    (tmp_path / "own_msgs" / "__init__.py").touch()
    (folder / "__init__.py").write_text("ANSWER = 42\nfrom own_msgs.msg._own import Own\n")
    (folder / "_own.py").write_text("class Own: pass\n")
    code = f"""
sys.path.insert(0, {str(tmp_path)!r})
import own_msgs.msg
print(json.dumps([own_msgs.msg.ANSWER, "own_msgs.msg._own" in sys.modules]))"""
    assert said(code) == [42, True]


def test_a_node_with_its_services_needs_neither_numpy_nor_the_parser_of_the_generator():
    code = """
import rclpy
from sensor_msgs.msg import JointState
rclpy.init()
node = rclpy.create_node("plain")
node.create_subscription(JointState, "joint_states", print, 1)
print(json.dumps([name in sys.modules for name in ("rosidl_generator_py", "numpy", "lark", "em")]))
node.destroy_node()
rclpy.shutdown()"""
    assert said(code) == [True, False, False, False]


def test_the_generator_still_generates():
    code = """
import rosidl_generator_py
from rosidl_generator_py import generate_py, import_type_support
names = [generate_py.__module__, import_type_support.__module__]
print(json.dumps([*names, hasattr(rosidl_generator_py, "generate_cpp")]))"""
    package = "rosidl_generator_py"
    expected = [f"{package}.generate_py_impl", f"{package}.import_type_support_impl", False]
    assert said(code) == expected


def test_arrays_of_messages_are_numpys():
    code = """
from rclpy.serialization import deserialize_message, serialize_message
from sensor_msgs.msg import CameraInfo
from unique_identifier_msgs.msg import UUID
info = CameraInfo(k=[float(i) for i in range(9)])
info = deserialize_message(serialize_message(info), CameraInfo)
uuid = deserialize_message(serialize_message(UUID()), UUID)
import numpy
refused = False
try:
    CameraInfo(k=[1.0])
except AssertionError:
    refused = True
is_numpys = type(info.k) is numpy.ndarray
print(json.dumps([info.k.tolist(), str(uuid.uuid.dtype), is_numpys, refused]))"""
    assert said(code) == [[float(i) for i in range(9)], "uint8", True, True]
