"""What a test asks for with its markers."""

from pathlib import Path

import pytest

from arm_sim.bench.configuration import arguments_of, configuration_key, marked_arguments
from arm_sim.errors import CallError

TESTS = """
import pytest

@pytest.mark.arm_sim(robot="mine.urdf", world="objects", seed=1)
class TestIt:
    @pytest.mark.arm_sim(seed=2)
    def test_it(self):
        pass

    @pytest.mark.arm_sim("arm")
    def test_positional(self):
        pass

    @pytest.mark.arm_sim(robot="<robot name='r'/>", controllers={"a": 1})
    def test_contents(self):
        pass
"""
NAMES = ("robot", "world", "controllers", "seed")


@pytest.fixture
def items(pytester) -> dict[str, pytest.Item]:
    items, _ = pytester.inline_genitems(pytester.makepyfile(TESTS))
    return {item.name: item for item in items}


def test_a_nearer_marker_overrides_single_arguments(items):
    found = marked_arguments(items["test_it"], "arm_sim", NAMES)
    assert found == {"robot": "mine.urdf", "world": "objects", "seed": 2}


def test_a_file_beside_the_test_is_found(items, pytester):
    (pytester.path / "mine.urdf").touch()
    found = marked_arguments(items["test_it"], "arm_sim", NAMES)
    assert Path(found["robot"]) == pytester.path / "mine.urdf"
    assert found["world"] == "objects"


def test_texts_and_mappings_are_no_files(items):
    found = marked_arguments(items["test_contents"], "arm_sim", NAMES)
    assert found["robot"] == "<robot name='r'/>"
    assert found["controllers"] == {"a": 1}


def test_an_unknown_argument_and_one_without_a_name_are_refused(items):
    with pytest.raises(CallError, match="has no argument 'seed'; it has robot, world"):
        marked_arguments(items["test_it"], "arm_sim", ("robot", "world"))
    with pytest.raises(CallError, match="takes arguments by name"):
        marked_arguments(items["test_positional"], "arm_sim", NAMES)


def test_only_keywords_are_arguments():
    def function(first: int, *, one: int = 1, other: int = 2) -> None:
        """Take some."""

    assert arguments_of(function) == ["one", "other"]


def test_equal_configurations_have_equal_keys():
    one = {"arguments": {"b": 1, "a": 2}, "spawn": ["x"], "robot": Path("r")}
    assert configuration_key(one) == configuration_key(
        {"robot": "r", "spawn": ("x",), "arguments": {"a": 2, "b": 1}}
    )
    assert configuration_key(one) != configuration_key({**one, "seed": 1})
