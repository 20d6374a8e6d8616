"""The world of a launched move_group, saved to a file and loaded from it."""

import os
from pathlib import Path
from typing import Any

import pytest
from moveit_msgs.msg import CollisionObject
from moveit_msgs.srv import LoadGeometryFromFile, SaveGeometryToFile


def save(planning: Any, path: Path) -> bool:
    request = SaveGeometryToFile.Request(file_path_and_name=str(path))
    return planning.call("/save_geometry_to_file", request).success


def load(planning: Any, path: Path) -> bool:
    request = LoadGeometryFromFile.Request(file_path_and_name=str(path))
    return planning.call("/load_geometry_from_file", request).success


def test_objects_come_back_from_a_file(planning, box, tmp_path):
    file = tmp_path / "table.scene"
    assert planning.apply_object(box("table", (0.3, 0.1, -0.05), (0.4, 0.6, 0.1)))
    assert save(planning, file)
    (saved,) = planning.scene().world.collision_objects
    assert planning.apply_object(CollisionObject(operation=CollisionObject.REMOVE))
    assert not planning.scene().world.collision_objects
    assert load(planning, file)
    (loaded,) = planning.scene().world.collision_objects
    assert loaded == saved


def test_saving_leaves_only_the_file(planning, box, tmp_path):
    file = tmp_path / "table.scene"
    file.write_text("an older one")
    assert planning.apply_object(box("table", (0.3, 0.1, -0.05), (0.4, 0.6, 0.1)))
    assert save(planning, file)
    assert list(tmp_path.iterdir()) == [file]
    assert "* table" in file.read_text()


@pytest.mark.parametrize("place", ["", "no/such/folder/a.scene", "."])
def test_a_file_that_cannot_be_written_is_refused(planning, launched, tmp_path, place):
    path = tmp_path / place if place else Path()
    assert not save(planning, path)
    launched.wait_for_line(f"cannot save the scene to '{path}'")


def test_a_file_that_is_no_scene_changes_nothing_and_its_line_is_logged(
    planning, launched, box, tmp_path
):
    file = tmp_path / "broken.scene"
    file.write_text("broken\n* ball\n0 0 0\n0 0 0 1\n1\nsfere\n")
    assert planning.apply_object(box("table", (0.3, 0.1, -0.05), (0.4, 0.6, 0.1)))
    assert not load(planning, file)
    launched.wait_for_line(f"{file}, line 6: 'sfere' is not a shape")
    assert [each.id for each in planning.scene().world.collision_objects] == ["table"]


def test_files_that_would_hang_are_refused(planning, tmp_path):
    fifo = tmp_path / "fifo"
    os.mkfifo(fifo)
    for path in (fifo, Path("/dev/zero"), tmp_path / "missing"):
        assert not load(planning, path)
    assert not save(planning, fifo)
