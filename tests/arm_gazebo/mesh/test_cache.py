"""The mesh cache."""

import os
from pathlib import Path

import numpy as np
import pytest
import trimesh

from arm_description.mesh.data import MeshData
from arm_gazebo.mesh import library
from arm_gazebo.mesh.cache import MeshCache, cache_folder
from arm_gazebo.mesh.part import MeshPart

RED = (1.0, 0.0, 0.0, 1.0)
LINK = (
    '<robot name="r"><link name="base"><visual><geometry><mesh filename="{}"/></geometry></visual>'
    "</link></robot>"
)


@pytest.fixture
def cache(tmp_path):
    return MeshCache(tmp_path / "cache")


@pytest.fixture
def ball():
    mesh = trimesh.creation.icosphere(4, 0.1)
    return MeshPart.of(MeshData(np.asarray(mesh.vertices), np.asarray(mesh.faces, np.int32), RED))


@pytest.fixture
def reads(monkeypatch):
    """The mesh files that are read instead of taken from the cache."""
    files = []
    read = library.read_mesh_file

    def counting(path):
        files.append(path.name)
        return read(path)

    monkeypatch.setattr(library, "read_mesh_file", counting)
    return files


def entries(folder):
    return sorted(path for path in folder.iterdir())


def test_what_was_stored_is_loaded(cache, ball):
    cache.store("k", [ball, ball])
    first, second = cache.load("k")
    for part in (first, second):
        assert np.array_equal(part.drawn.vertices, ball.drawn.vertices)
        assert np.array_equal(part.drawn.faces, ball.drawn.faces)
        assert np.array_equal(part.hull, ball.hull)
        assert part.drawn.rgba == RED
        assert (part.triangles, part.different) == (ball.triangles, ball.different)


def test_an_unknown_key_is_nothing(cache):
    assert cache.load("k") is None


@pytest.mark.parametrize("spoil", [lambda b: b"", lambda b: b[: len(b) // 2], lambda b: b"x" * 99])
def test_a_spoilt_entry_counts_as_not_there(cache, ball, tmp_path, spoil):
    cache.store("k", [ball])
    [entry] = entries(tmp_path / "cache")
    entry.write_bytes(spoil(entry.read_bytes()))
    assert cache.load("k") is None
    cache.store("k", [ball])
    assert cache.load("k") is not None


def test_flipped_bytes_are_noticed(cache, ball, tmp_path):
    cache.store("k", [ball])
    [entry] = entries(tmp_path / "cache")
    content = bytearray(entry.read_bytes())
    content[len(content) // 2] ^= 0xFF
    entry.write_bytes(content)
    assert cache.load("k") is None


def test_an_entry_of_triangles_without_vertices_is_refused(cache, ball):
    wrong = MeshData(ball.drawn.vertices[:10], ball.drawn.faces)
    cache.store("k", [MeshPart(wrong, ball.hull, 1, 1)])
    assert cache.load("k") is None


def test_a_folder_that_cannot_be_created_is_ignored(tmp_path, ball):
    (tmp_path / "file").touch()
    cache = MeshCache(tmp_path / "file" / "cache")
    cache.store("k", [ball])
    assert cache.load("k") is None


def test_nothing_half_written_stays(cache, ball, tmp_path, monkeypatch):
    def full(*_args):
        raise OSError("disk full")

    monkeypatch.setattr(os, "replace", full)
    cache.store("k", [ball])
    assert entries(tmp_path / "cache") == []


def test_the_longest_unused_entries_make_room(cache, ball, tmp_path, monkeypatch):
    cache.store("old", [ball])
    [entry] = entries(tmp_path / "cache")
    os.utime(entry, (1, 1))
    monkeypatch.setattr("arm_gazebo.mesh.cache.MAX_CACHE_BYTES", int(1.5 * entry.stat().st_size))
    cache.store("new", [ball])
    assert cache.load("old") is None
    assert cache.load("new") is not None


def test_the_same_content_is_read_once(parts, tmp_path, reads):
    trimesh.creation.box([0.1, 0.2, 0.3]).export(tmp_path / "a.ply")
    (tmp_path / "b.ply").write_bytes((tmp_path / "a.ply").read_bytes())
    for name in ("a.ply", "a.ply", "b.ply"):
        parts.build(LINK.format(tmp_path / name), mesh_cache=tmp_path / "cache", strict=True)
    assert reads == ["a.ply"]


def test_changed_materials_are_read_again(parts, tmp_path, reads):
    (tmp_path / "a.obj").write_text(
        "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nusemtl m\nf 1 3 2\nf 1 2 4\nf 2 3 4\n"
    )
    for colour in ("1 0 0", "0 1 0"):
        (tmp_path / "a.mtl").write_text(f"newmtl m\nKd {colour}\n")
        model = parts.build(LINK.format(tmp_path / "a.obj"), mesh_cache=tmp_path / "cache").model
        assert model.geom_rgba[-1][:3] == pytest.approx([float(c) for c in colour.split()])
    assert reads == ["a.obj", "a.obj"]


def test_the_model_is_the_same_from_the_cache(parts, tmp_path):
    mesh = trimesh.creation.icosphere(4, 0.1)
    mesh.export(tmp_path / "ball.stl")
    shape = f'<geometry><mesh filename="{tmp_path}/ball.stl" scale="1 2 -1"/></geometry>'
    urdf = (
        f'<robot name="r"><link name="base"><visual>{shape}</visual>'
        f"<collision>{shape}</collision></link></robot>"
    )
    fresh, first, again = (
        parts.build(urdf, mesh_cache=folder).model
        for folder in (None, tmp_path / "cache", tmp_path / "cache")
    )
    assert fresh.nmesh == 2
    for model in (first, again):
        assert np.array_equal(model.mesh_vert, fresh.mesh_vert)
        assert np.array_equal(model.mesh_face, fresh.mesh_face)


def test_the_folder_is_in_the_users_cache_folder():
    assert cache_folder({"XDG_CACHE_HOME": "/c"}) == Path("/c/arm-suite/meshes")
    assert cache_folder({"XDG_CACHE_HOME": "relative"}) == cache_folder({})
    assert cache_folder({}).parts[-3:] == (".cache", "arm-suite", "meshes")
