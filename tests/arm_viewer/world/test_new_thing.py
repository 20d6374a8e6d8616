"""SDF of things that a user adds: what the fields say, and what they cannot say."""

from dataclasses import replace
from xml.etree import ElementTree

import pytest

from arm_viewer.world.new_thing import ThingFields, new_thing
from arm_viewer.world.shape_fields import ObjectKind

FIELDS = ThingFields(
    "box", ObjectKind.BOX, "0.1 0.2 0.3", "1 2 3", "0 0 0", (255, 0, 51), 0.25, 0.5, False
)


def texts(text: str) -> dict[str, str]:
    return {element.tag: element.text or "" for element in ElementTree.fromstring(text).iter()}


def test_the_sdf_has_what_was_entered():
    text, pose = new_thing(FIELDS)
    found = texts(text)
    assert pose.position == (1.0, 2.0, 3.0)
    assert found["size"] == "0.1 0.2 0.3"
    assert (found["mass"], found["mu"], found["static"]) == ("0.25", "0.5", "false")
    assert found["diffuse"] == "1 0 0.2 1"


@pytest.mark.parametrize(
    ("kind", "size", "tag"),
    [(ObjectKind.SPHERE, "0.1", "sphere"), (ObjectKind.CYLINDER, "0.1 0.2", "cylinder")],
)
def test_each_shape_is_an_element(kind, size, tag):
    text, _ = new_thing(replace(FIELDS, kind=kind, size=size, is_fixed=True))
    assert tag in texts(text)
    assert texts(text)["static"] == "true"


@pytest.mark.parametrize(
    ("change", "sentence"),
    [
        ({"name": "<a>"}, "'<a>' is not a name"),
        ({"name": ""}, "is not a name"),
        ({"size": "0.1 0.2"}, "size is not 'x y z'"),
        ({"size": "0.1 0.2 -1"}, "must be greater than 0 m"),
        ({"position": "1 2 inf"}, "position is not"),
        ({"mass": 0.0}, "mass must be greater than 0 kg"),
        ({"friction": float("nan")}, "friction must be at least 0"),
    ],
)
def test_a_wrong_field_is_a_sentence(change, sentence):
    with pytest.raises(ValueError, match=sentence):
        new_thing(replace(FIELDS, **change))
