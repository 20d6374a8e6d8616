"""MuJoCo opens the files of an MJCF by itself, so they are looked at before."""

import os

import pytest

from arm_gazebo.errors import ModelError, WorldError
from arm_gazebo.mjcf.references import check_readable, references
from arm_gazebo.model.world_file import load_world


def mjcf(inside):
    return f"<mujoco>\n{inside}</mujoco>"


@pytest.fixture
def folder(tmp_path):
    """Return a folder with a FIFO, a device and a regular file, here and in `parts`."""
    for place in (tmp_path, tmp_path / "parts"):
        place.mkdir(exist_ok=True)
        (place / "regular").touch()
    os.mkfifo(tmp_path / "fifo")
    os.mkfifo(tmp_path / "parts" / "inner_fifo")
    (tmp_path / "device").symlink_to("/dev/zero")
    return tmp_path


@pytest.mark.parametrize(
    ("inside", "named"),
    [
        ('<asset><mesh name="m" file="fifo"/></asset>', "fifo: it is a FIFO"),
        ('<asset><hfield name="h" file="device"/></asset>', "device: it is a device"),
        ('<asset><texture type="cube" fileup="fifo"/></asset>', "fifo: it is a FIFO"),
        ('<asset><skin name="s" file="fifo"/></asset>', "fifo: it is a FIFO"),
        ('<include file="fifo"/>', "fifo: it is a FIFO"),
        ('<asset><model name="m" file="device"/></asset>', "device: it is a device"),
        (
            '<compiler meshdir="parts"/><asset><mesh file="inner_fifo"/></asset>',
            "parts/inner_fifo: it is a FIFO",
        ),
        (
            '<compiler assetdir="parts" strippath="true"/><asset><mesh file="a/inner_fifo"/>'
            "</asset>",
            "parts/inner_fifo: it is a FIFO",
        ),
        ('<asset><mesh file="/dev/zero"/></asset>', "/dev/zero: it is a device"),
    ],
)
def test_a_file_that_is_not_regular_is_refused_with_its_line(folder, inside, named):
    with pytest.raises(ModelError, match=f"line 2: cannot read .*{named}, not a regular file"):
        check_readable(mjcf(inside), folder / "a.xml")


def test_what_an_included_file_names_is_looked_at_too(folder):
    (folder / "parts" / "b.xml").write_text(mjcf('<asset><mesh file="inner_fifo"/></asset>'))
    with pytest.raises(ModelError, match="inner_fifo: it is a FIFO"):
        check_readable(mjcf('<include file="parts/b.xml"/>'), folder / "a.xml")


@pytest.mark.parametrize("file", ["regular", "missing", "parts", "a\x7f" * 4000])
def test_regular_files_pass_and_missing_ones_are_left_to_mujoco(folder, file):
    text = mjcf(f'<asset><mesh file="{file}"/></asset>')
    assert [each.value for each in references(text, folder / "a.xml")] == [file]
    check_readable(text, folder / "a.xml")


def test_a_world_is_not_compiled_with_such_a_file(folder):
    (folder / "w.xml").write_text(mjcf('<asset><mesh name="m" file="fifo"/></asset>'))
    with pytest.raises(WorldError, match=r"w\.xml is not usable .*fifo: it is a FIFO"):
        load_world(folder / "w.xml")
