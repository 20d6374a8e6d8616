"""The numbers that house_numbers.py counts, on a small package and on the product."""

import runpy
from pathlib import Path

import pytest

TOOL = runpy.run_path(str(Path(__file__).parents[2] / "tools" / "house_numbers.py"))
numbers, product = TOOL["numbers"], TOOL["product"]

FILES = {
    "__init__.py": "from .arm import Arm\n",
    "arm.py": "from .joint import Joint\nfrom small import hand\n\nclass Arm: ...\n",
    "hand.py": "class Arm: ...\nclass _Finger: ...\n",
    "joint.py": "class Joint:\n    def move(self):\n" + "        pass\n" * 60,
    "deep/__init__.py": "",
    "deep/link.py": "def size():\n    from ..joint import Joint\n" + "#\n" * 399,
}


@pytest.fixture
def counted(tmp_path):
    package = tmp_path / "small"
    for name, text in FILES.items():
        file = package / name
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(text)
    return numbers(product([package]))


def test_files_and_lines_include_the_faces_of_packages(counted):
    assert counted["product files"] == 6
    assert counted["product lines"] == sum(len(text.splitlines()) for text in FILES.values())


def test_short_and_long_files_are_named_with_their_lines(counted):
    assert counted["files under 40 lines"] == ["small.arm (4)", "small.hand (2)"]
    assert counted["files over 400 lines"] == ["small.deep.link (401)"]


def test_a_function_of_more_than_sixty_lines_is_named(counted):
    assert counted["functions over 60 lines"] == ["small.joint.move (61)"]


def test_public_classes_are_counted_and_equal_names_told(counted):
    assert counted["public classes"] == 3
    assert counted["class names that stand twice"] == ["Arm: small.arm, small.hand"]


def test_modules_with_a_single_user_are_named_with_it(counted):
    """`joint` has two users, one of which imports it within a function."""
    assert counted["modules imported by a single other module"] == [
        "small.arm by small",
        "small.hand by small.arm",
    ]


def test_the_product_is_counted_without_arguments(capsys):
    assert TOOL["main"]([]) == 0
    printed = capsys.readouterr().out
    assert "product files" in printed
    assert "files over 400 lines" in printed
    assert "      0  functions over 60 lines" in printed


def test_verbose_lists_what_is_counted(tmp_path, capsys):
    (tmp_path / "lone.py").write_text("class Arm: ...\n")
    TOOL["main"](["-v", str(tmp_path)])
    assert ".lone (1)" in capsys.readouterr().out
