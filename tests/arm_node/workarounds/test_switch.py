"""Workarounds are on for the versions that they were made for, and off by hand."""

import os

import pytest
from run_python import run_python

from arm_node.workarounds.switch import LIBRARIES, VARIABLE, Library, switched_off


def manifest(folder, package, version):
    share = folder / "share" / package
    share.mkdir(parents=True)
    (share / "package.xml").write_text(f"<package><version>{version}</version></package>")


def asked(code: str, **variables: str) -> str:
    """The output of a process that starts with these variables."""
    done = run_python(
        "-c",
        f"from arm_node.workarounds.switch import *; {code}",
        env={**os.environ, **variables},
        check=True,
    )
    return done.stdout.strip()


@pytest.mark.parametrize(
    ("version", "fits"),
    [("2.14", True), ("2.14.5", True), ("2.140.0", False), ("2.1", False), ("3.1.0", False)],
)
def test_a_workaround_is_for_the_versions_that_begin_like_its_own(version, fits):
    assert Library("Fast DDS", ("2.14",), lambda: version).fits == fits


def test_with_the_wheels_of_this_suite_all_are_on():
    assert asked("import mujoco; print(*map(is_on, LIBRARIES))", ARM_WITHOUT="") == " ".join(
        ["True"] * len(LIBRARIES)
    )
    assert asked("print(switched_off())", ARM_WITHOUT="") == ""


def test_those_that_the_variable_names_are_off_and_no_others():
    assert asked(
        "import mujoco; print([n for n in LIBRARIES if not is_on(n)])", ARM_WITHOUT=" discovery,"
    ) == ("['discovery']")
    line = switched_off({VARIABLE: "discovery,torn_ports"})
    assert line == "workarounds that are off: discovery, torn_ports (by ARM_WITHOUT)"


def test_a_library_that_is_not_loaded_is_not_spoken_of():
    assert asked("print(is_on('profiler'), switched_off())", ARM_WITHOUT="") == "False"


def test_those_of_the_build_of_the_interfaces_are_known_by_name():
    assert switched_off({VARIABLE: "template_cache"}) == ""


def test_all_are_off_if_the_variable_is_all():
    assert asked("print(any(map(is_on, LIBRARIES)))", ARM_WITHOUT="all") == "False"


def test_an_unknown_name_is_reported_with_the_existing_ones():
    assert (
        "unknown in ARM_WITHOUT: sings_of_life; the names are discovery, signs_of_life"
        in switched_off({VARIABLE: "sings_of_life"})
    )


def test_with_another_version_they_are_off_and_say_so(tmp_path):
    manifest(tmp_path, "rmw_fastrtps_cpp", "10.0.1")
    code = "print(is_on('discovery'), is_on('stamp_clock'), switched_off())"
    said = asked(code, AMENT_PREFIX_PATH=str(tmp_path), ARM_WITHOUT="")
    assert said.startswith("False True workarounds that are off: discovery, signs_of_life")
    assert said.endswith("(made for rmw_fastrtps 8.4 and 9.3; the version here is 10.0.1)")


def test_with_another_middleware_those_of_fast_dds_are_off():
    said = asked("print(is_on('torn_ports'))", RMW_IMPLEMENTATION="rmw_cyclonedds_cpp")
    assert said == "False"


TORN = """
import os, sys, time
from arm_node.workarounds.ports import remove_torn_ports
path = os.path.join(sys.argv[1], "fastrtps_port7411")
open(path, "wb").close()
os.utime(path, (0, 0))
print(remove_torn_ports(sys.argv[1]))
"""


@pytest.mark.parametrize(("without", "removed"), [("", "['fastrtps_port7411']"), ("all", "[]")])
def test_what_is_off_does_nothing(tmp_path, without, removed):
    done = run_python("-c", TORN, str(tmp_path), env={**os.environ, VARIABLE: without}, check=True)
    assert done.stdout.strip() == removed
