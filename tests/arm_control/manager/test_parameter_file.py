"""Where a parameter file may speak of a controller."""

from pathlib import Path

import pytest

from arm_control.errors import ParameterError
from arm_control.manager.parameter_file import ControllerParameterFile

TYPE = "{ros__parameters: {type: a/B}}"


@pytest.fixture
def path(tmp_path) -> Path:
    return tmp_path / "controllers.yaml"


def lookup(path: Path, text: str, namespace: str = "/") -> object:
    path.write_text(text)
    return ControllerParameterFile(str(path)).lookup("ctrl", namespace, "type")


@pytest.mark.parametrize(
    "text",
    [
        f"ctrl: {TYPE}",
        f"/ctrl: {TYPE}",
        f"/**/ctrl: {TYPE}",
        f"/**: {{ctrl: {TYPE}}}",
        f"/**: {TYPE}",
        "controller_manager: {ros__parameters: {ctrl: {type: a/B}}}",
        "/controller_manager: {ros__parameters: {ctrl: {type: a/B}}}",
        "{ctrl: {ros__parameters: {x: 1}}, "
        "controller_manager: {ros__parameters: {ctrl: {type: a/B}}}}",
        "/**/controller_manager: {ros__parameters: {ctrl: {type: a/B}}}",
        f"{{ctrl: {{ros__parameters: {{x: 1}}}}, /**: {TYPE}}}",
        f"{{ctrl: {TYPE}, /**: {{ros__parameters: {{type: c/D}}}}}}",
        f"{{/**/ctrl: {{ros__parameters: {{x: 1}}}}, /**: {{ctrl: {TYPE}}}}}",
        f"/**: {{other: {{no: parameters}}, ctrl: {TYPE}}}",
        f"/**: {{ctrl: {TYPE}}}\n/**: {{ctrl: {{ros__parameters: {{x: 1}}}}}}",
        f"ctrl: {TYPE}\nctrl: {{ros__parameters: {{x: 1}}}}",
        "controller_manager: {ros__parameters: {ctrl: {type: a/B}}}\n"
        "controller_manager: {ros__parameters: {update_rate: 100, ctrl: {x: 1}}}",
        "/*: {ros__parameters: {x: 1}}\n/**: {ros__parameters: {ctrl.type: c/D}}\n"
        f"ctrl: {TYPE}",
    ],
)
def test_it_is_found(path, text):
    assert lookup(path, text) == "a/B"


@pytest.mark.parametrize(
    "text",
    [
        f"/ns/ctrl: {TYPE}",
        f"/**/ctrl: {TYPE}",
        f"/**/ns/ctrl: {TYPE}",
        f"/**: {{ctrl: {TYPE}}}",
        f"/**: {TYPE}",
        f"{{ctrl: {{ros__parameters: {{}}}}, /ns/ctrl: {TYPE}}}",
        "/ns/controller_manager: {ros__parameters: {ctrl: {type: a/B}}}",
    ],
)
def test_it_is_found_in_a_namespace(path, text):
    assert lookup(path, text, "/ns") == "a/B"


def test_all_that_a_node_is_given_is_what_rcl_gives_it(path):
    path.write_text(
        "ctrl: {ros__parameters: {a: 1, gains: {j0: {p: 1e3}}}}\n"
        "/**: {ros__parameters: {a: 2, ids: [010, 011]}}\n"
        "ctrl: {ros__parameters: {gains: {j0: {i: 08}}}}\n"
        "other: {ros__parameters: {a: 3}}\n"
    )
    given = ControllerParameterFile(str(path)).given("ctrl", "/")
    assert given == {"a": 2, "gains.j0.p": 1000.0, "gains.j0.i": 8.0, "ids": [8, 9]}


def test_the_own_entry_wins_over_the_managers(path):
    text = f"{{ctrl: {TYPE}, controller_manager: {{ros__parameters: {{ctrl: {{type: c/D}}}}}}}}"
    assert lookup(path, text) == "a/B"


@pytest.mark.parametrize("text", [f"other: {TYPE}", f"/other/ctrl: {TYPE}"])
def test_a_missing_parameter_is_none(path, text):
    assert lookup(path, text) is None


@pytest.mark.parametrize(
    ("text", "mentioned"),
    [
        (f"ctrl: {TYPE}", True),
        ("/**: {ros__parameters: {}}", True),
        (f"other: {TYPE}", False),
        ("controller_manager: {ros__parameters: {ctrl: {type: a/B}}}", False),
    ],
)
def test_only_parameters_of_its_own_node_mention_a_controller(path, text, mentioned):
    path.write_text(text)
    assert ControllerParameterFile(str(path)).mentions("ctrl", "/") is mentioned


def test_a_bare_name_does_not_serve_in_a_namespace(path):
    with pytest.raises(ParameterError, match="without its namespace: write '/ns/ctrl' or"):
        lookup(path, f"ctrl: {TYPE}", "/ns")


def test_an_entry_without_parameters_is_refused(path):
    with pytest.raises(ParameterError, match="'ctrl' has no mapping ros__parameters"):
        lookup(path, "ctrl: {type: a/B}")


def test_a_missing_file_is_named(path):
    with pytest.raises(ParameterError, match=f"cannot read parameter file '{path}'"):
        ControllerParameterFile(str(path))


@pytest.mark.parametrize(("text", "says"), [("a: [", "is not YAML"), ("- a", "contains no nodes")])
def test_a_file_of_another_kind_is_refused(path, text, says):
    path.write_text(text)
    with pytest.raises(ParameterError, match=says):
        ControllerParameterFile(str(path))


def test_a_relative_path_becomes_absolute(path, monkeypatch):
    path.write_text("a: {}")
    monkeypatch.chdir(path.parent)
    assert ControllerParameterFile(path.name).path == path
