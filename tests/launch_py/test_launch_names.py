"""Every name of launch and launch_ros, as the manual's page lists them."""

import importlib
import re
from pathlib import Path

import pytest

from launch_py.ros_imports import NOT_HERE, MissingRosNameError, ros_imports

PAGE = Path(__file__).parents[2] / "docs" / "reference" / "launch_names.md"
ROW = re.compile(r"\| `(\w+)` \| (works|differs|not here) \| (.*) \|")
DUPLICATES = ("launch.launch_introspector", "launch.launch_service")
"""Modules whose only name is in another module, too."""


def listed() -> list[tuple[str, str, str, str]]:
    """Return module, name, state and remark of each row."""
    found, module = [], ""
    for line in PAGE.read_text().splitlines():
        if line.startswith("## "):
            module = line[3:]
        elif match := ROW.fullmatch(line):
            found.append((module, *match.groups()))
    return found


@pytest.mark.parametrize("module", sorted({row[0] for row in listed()}))
def test_every_name_of_a_module_can_be_imported(module):
    with ros_imports():
        home = importlib.import_module(module)
        for _, name, state, remark in (row for row in listed() if row[0] == module):
            value = getattr(home, name)
            assert value is not None
            assert (state == "not here") == (NOT_HERE.get(module, {}).get(name) == remark)
            if state == "not here":
                sentence = f"{module} has no '{name}' here; {re.escape(remark)}"
                for use in (lambda v=value: v(), lambda v=value: v.level, lambda v=value: v("a")):
                    with pytest.raises(MissingRosNameError, match=sentence):
                        use()


def test_the_page_has_all_that_is_not_here_and_counts_right():
    rows = listed()
    absent = {(module, name) for module, name, state, _ in rows if state == "not here"}
    assert absent == {
        (module, name)
        for module, names in NOT_HERE.items()
        for name in names
        if module not in DUPLICATES
    }
    states = [state for _, _, state, _ in rows]
    works, differs, lacks = (states.count(state) for state in ("works", "differs", "not here"))
    text = " ".join(PAGE.read_text().split())
    assert f"all {len(rows)} names: {works} work, {differs} differ as" in text
    assert f"and {lacks} can be imported" in text
    assert all(remark for _, _, state, remark in rows if state != "works")


def test_a_setting_of_what_is_not_here_is_an_error():
    with ros_imports():
        import launch  # pyright: ignore[reportMissingImports]

        with pytest.raises(MissingRosNameError, match="launch_config' here; set ROS_LOG_DIR"):
            launch.logging.launch_config.level = 10
