"""The classes in files of earlier builds are found, wherever they stand now."""

from pathlib import Path

import pytest

from arm_control.state.class_names import (
    EARLIER_ATTRIBUTES,
    EARLIER_NAMES,
    attributes_by_present_name,
    class_name,
    class_named,
)

SAVED = Path(__file__).with_name("saved_classes.txt").read_text(encoding="utf-8").split()
"""Every class that the build of November 2026 wrote into snapshots and recordings.

Names are never taken out. A class that moves gets its old name into `EARLIER_NAMES`.
"""


@pytest.mark.parametrize("name", SAVED)
def test_a_class_of_an_earlier_build_is_found(name):
    assert isinstance(class_named(name), type)


def test_every_earlier_name_is_one_of_those():
    assert EARLIER_NAMES.keys() <= {*SAVED, *(name.partition(":")[0] for name in SAVED)}


@pytest.mark.parametrize("name", EARLIER_ATTRIBUTES)
def test_earlier_attributes_are_listed_by_the_present_name_of_their_class(name):
    kind = class_named(name)
    assert class_name(kind) == name
    given = {earlier: number for number, earlier in enumerate(EARLIER_ATTRIBUTES[name])}
    present = attributes_by_present_name(kind, {**given, "other": -1})
    assert present.pop("other") == -1
    assert present.keys().isdisjoint(given)


def test_a_module_outside_of_the_suite_is_not_imported():
    assert class_named("antigravity:Nothing") is None
