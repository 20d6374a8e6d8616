"""A description with its source, and the files that are found from it."""

from pathlib import Path

import pytest

from arm_description import Box, Mesh, ResourceFinder, expand_xacro, parse_urdf
from arm_description.urdf.description_source import DescriptionSource, source_of, with_source

ROBOT = "<robot name='r'><link name='a'/></robot>"
FILE = Path("/somewhere/my arm/50%?>.urdf")


@pytest.mark.parametrize(
    "text", [ROBOT, f"<?xml version='1.0'?>\n{ROBOT}", f"<!-- <?xml?> -->\n{ROBOT}", f"\n {ROBOT}"]
)
def test_the_source_is_read_as_it_was_written(text):
    stamped = with_source(text, FILE, [Path("/a"), Path("/b c")])
    assert source_of(stamped) == DescriptionSource(FILE, (Path("/a"), Path("/b c")))
    assert parse_urdf(stamped) == parse_urdf(text)
    assert stamped.count("\n") == text.count("\n")


def test_the_source_comes_right_after_the_declaration():
    assert with_source(f"<?xml version='1.0'?>\n{ROBOT}", Path("/a.urdf")) == (
        f"<?xml version='1.0'?><?description_source file:///a.urdf?>\n{ROBOT}"
    )


def test_a_description_with_a_source_keeps_it():
    stamped = with_source(ROBOT, FILE)
    assert with_source(stamped, Path("/elsewhere.urdf")) == stamped


@pytest.mark.parametrize("text", [ROBOT, f"<?description_source ?>{ROBOT}", "", f"{' ' * 5000}x"])
def test_a_description_may_say_nothing(text):
    assert source_of(text) == DescriptionSource()


def test_a_source_that_cannot_be_a_file_is_ignored():
    assert source_of(f"<?description_source file:///a%00b?>{ROBOT}") == DescriptionSource()


def test_expanded_xacro_finds_its_meshes_wherever_its_text_goes(tmp_path):
    (tmp_path / "urdf").mkdir()
    (tmp_path / "part.stl").touch()
    file = tmp_path / "urdf/arm.xacro"
    shapes = "".join(
        f"<visual><geometry>{shape}</geometry></visual>"
        for shape in ("<mesh filename='../part.stl'/>", "<mesh filename='gone.stl'/>",
                      "<box size='1 1 1'/>")
    )  # fmt: skip
    file.write_text(f"<robot name='r'><link name='a'>{shapes}</link></robot>")
    text = expand_xacro(file)
    robot = ResourceFinder.of_description(text).located(parse_urdf(text))
    found, gone, box = (visual.geometry for visual in robot.links[0].visuals)
    assert (found, gone) == (Mesh(str(tmp_path / "part.stl")), Mesh("gone.stl"))
    assert isinstance(box, Box)
