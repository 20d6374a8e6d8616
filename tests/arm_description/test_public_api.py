"""The public names of the package."""

import inspect

import arm_description
from arm_description import errors


def test_every_public_name_exists():
    for name in arm_description.__all__:
        assert hasattr(arm_description, name)


def test_every_error_is_public_and_has_the_same_root():
    classes = [cls for _, cls in inspect.getmembers(errors, inspect.isclass)]
    assert len(classes) > 5
    for cls in classes:
        assert issubclass(cls, arm_description.DescriptionError)
        assert cls.__name__ in arm_description.__all__
