"""A package's public names, imported on their first use."""

import subprocess
import sys

import pytest

import arm_node


def test_the_names_are_those_below_type_checking():
    assert arm_node.__all__ == ["UnusableEnvironmentError", "prepare_environment"]
    assert set(arm_node.__all__) <= set(dir(arm_node))
    assert issubclass(arm_node.UnusableEnvironmentError, Exception)


def test_a_wrong_name_is_an_attribute_error():
    with pytest.raises(AttributeError, match="module 'arm_node' has no attribute 'prepare'"):
        _ = arm_node.prepare


def test_a_name_is_imported_when_it_is_used(tmp_path):
    package = tmp_path / "lazy"
    package.mkdir()
    (package / "__init__.py").write_text(
        "from typing import TYPE_CHECKING\n"
        "from arm_node.public_names import on_first_use\n"
        "if TYPE_CHECKING:\n"
        "    from lazy.core import VALUE as VALUE\n"
        "__getattr__, __dir__ = on_first_use(__name__)\n"
    )
    (package / "core.py").write_text("VALUE = 3\n")
    code = (
        "import sys, lazy\n"
        "before = 'lazy.core' in sys.modules\n"
        "from lazy import *\n"
        "print(before, VALUE, lazy.VALUE, lazy.__dict__['VALUE'])"
    )
    done = subprocess.run(
        [sys.executable, "-c", code], cwd=tmp_path, capture_output=True, text=True, check=False
    )
    assert done.stdout == "False 3 3 3\n", done.stderr
