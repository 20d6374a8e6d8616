"""glTF files of every valid layout, against the shape that was written."""

import base64
import json
import struct

import numpy as np
import pytest
from mesh_measures import measures

from arm_description.errors import MeshFileError
from arm_description.mesh.file import read_mesh_file

CORNERS = np.array([(x, y, z) for x in (0, 1) for y in (0, 1) for z in (0, 1)], dtype=float)
TRIANGLES = np.array(
    [
        *((0, 1, 3), (0, 3, 2), (4, 6, 7), (4, 7, 5), (0, 4, 5), (0, 5, 1)),
        *((2, 3, 7), (2, 7, 6), (0, 2, 6), (0, 6, 4), (1, 5, 7), (1, 7, 3)),
    ]
)
TYPES = {np.int8: 5120, np.uint8: 5121, np.int16: 5122, np.uint16: 5123, np.uint32: 5125}
SIZE = np.array([0.2, 0.3, 0.5])
VOLUME, AREA = 0.03, 2 * (0.06 + 0.15 + 0.1)


class Document:
    """A glTF file with one buffer, whose parts are added one after the other."""

    def __init__(self) -> None:
        self.buffer = b"\xff" * 8  # What is before the first view must not matter.
        self.views: list[dict] = []
        self.accessors: list[dict] = []
        self.primitives: list[dict] = []
        self.nodes: list[dict] = [{"mesh": 0}]
        self.more: dict = {}

    def view(self, data: bytes, **more: int) -> int:
        self.buffer += b"\xff" * (-len(self.buffer) % 4)
        self.views.append(
            {"buffer": 0, "byteOffset": len(self.buffer), "byteLength": len(data), **more}
        )
        self.buffer += data
        return len(self.views) - 1

    def accessor(self, values: np.ndarray, stride: int = 0, **more: object) -> int:
        """Add an array; with a stride its rows are that many bytes apart, from the fourth on."""
        rows = [row.tobytes() for row in values]
        if stride:
            data = b"\xee" * 4 + b"".join(row.ljust(stride, b"\xee") for row in rows)
            view = self.view(data, byteStride=stride)
            more["byteOffset"] = 4
        else:
            view = self.view(b"".join(rows))
        kind = 5126 if values.dtype == np.float32 else TYPES[values.dtype.type]
        shape = "VEC3" if values.ndim == 2 else "SCALAR"
        self.accessors.append(
            {"bufferView": view, "componentType": kind, "count": len(rows), "type": shape, **more}
        )
        return len(self.accessors) - 1

    def draw(self, positions: int, indices: int | None, mode: int = 4) -> None:
        primitive = {"attributes": {"POSITION": positions}, "mode": mode}
        if indices is not None:
            primitive["indices"] = indices
        self.primitives.append(primitive)

    def write(self, path) -> None:
        buffer = self.buffer + b"\0" * (-len(self.buffer) % 4)
        document = {
            "asset": {"version": "2.0"},
            "scene": 0,
            "scenes": [{"nodes": [0]}],
            "nodes": self.nodes,
            "meshes": [{"primitives": self.primitives}],
            "accessors": self.accessors,
            "bufferViews": self.views,
            "buffers": [{"byteLength": len(buffer)}],
            **self.more,
        }
        if path.suffix == ".gltf":
            data = base64.b64encode(buffer).decode()
            document["buffers"][0]["uri"] = f"data:application/octet-stream;base64,{data}"
            path.write_text(json.dumps(document))
            return
        text = json.dumps(document).encode()
        text += b" " * (-len(text) % 4)
        parts = struct.pack("<I4s", len(text), b"JSON") + text
        parts += struct.pack("<I4s", len(buffer), b"BIN\0") + buffer
        path.write_bytes(struct.pack("<4sII", b"glTF", 2, 12 + len(parts)) + parts)


def assert_is_the_box(path, tolerance: float = 1e-5) -> None:
    area, volume, low, high = measures(read_mesh_file(path))
    assert area == pytest.approx(AREA, rel=tolerance)
    assert volume == pytest.approx(VOLUME, rel=tolerance)
    assert low == pytest.approx([0, 0, 0], abs=1e-6)
    assert high == pytest.approx(SIZE.tolist(), rel=tolerance)


@pytest.mark.parametrize("suffix", [".gltf", ".glb"])
@pytest.mark.parametrize("stride", [0, 12, 20])
@pytest.mark.parametrize("index", [np.uint8, np.uint16, np.uint32, None])
def test_plain_positions(tmp_path, suffix, stride, index):
    document = Document()
    corners = CORNERS * SIZE
    if index is None:
        corners = corners[TRIANGLES.ravel()]
    positions = document.accessor(corners.astype(np.float32), stride)
    indices = None if index is None else document.accessor(TRIANGLES.ravel().astype(index))
    document.draw(positions, indices)
    document.write(tmp_path / f"box{suffix}")
    assert_is_the_box(tmp_path / f"box{suffix}")


@pytest.mark.parametrize("suffix", [".gltf", ".glb"])
@pytest.mark.parametrize("normalized", [True, False])
@pytest.mark.parametrize("kind", [np.int8, np.uint8, np.int16, np.uint16])
def test_positions_that_are_integers(tmp_path, suffix, normalized, kind):
    """What gltfpack writes: small integers, and a node that gives them their size."""
    document = Document()
    largest = np.iinfo(kind).max
    values = (CORNERS * largest).astype(kind)
    positions = document.accessor(values, 4 if values.itemsize == 1 else 8, normalized=normalized)
    document.draw(positions, document.accessor(TRIANGLES.ravel().astype(np.uint16)))
    unit = 1.0 if normalized else 1.0 / largest
    # A child of the node must not shrink with its mesh.
    document.nodes = [
        {"children": [1, 2]},
        {"mesh": 0, "scale": (SIZE * unit).tolist(), "children": [3]},
        {"mesh": 0, "scale": (SIZE * unit).tolist()},
        {"mesh": 0, "scale": [1.0, 1.0, 1.0]},
    ]
    document.more = {"extensionsRequired": ["KHR_mesh_quantization"]}
    document.write(tmp_path / f"box{suffix}")
    area, volume, _, high = measures(read_mesh_file(tmp_path / f"box{suffix}"))
    assert volume == pytest.approx(3 * VOLUME, rel=1e-5)
    assert area == pytest.approx(3 * AREA, rel=1e-5)
    assert high == pytest.approx(SIZE.tolist(), rel=1e-5)


def test_parts_of_one_mesh_may_differ(tmp_path):
    document = Document()
    indices = document.accessor(TRIANGLES.ravel().astype(np.uint16))
    document.draw(document.accessor((CORNERS * SIZE).astype(np.float32)), indices)
    thousandth = (CORNERS * SIZE * 32767).round().astype(np.int16)
    document.draw(document.accessor(thousandth, 8, normalized=True), indices)
    document.write(tmp_path / "two.glb")
    area, volume, low, high = measures(read_mesh_file(tmp_path / "two.glb"))
    assert (area, volume) == pytest.approx((2 * AREA, 2 * VOLUME), rel=1e-3)
    assert (low, high) == (pytest.approx([0, 0, 0]), pytest.approx(SIZE.tolist(), rel=1e-4))


def test_strips(tmp_path):
    document = Document()
    corners = np.array([(0, 0, 0), (1, 0, 0), (0, 1, 0), (1, 1, 0), (0, 0, 1)], np.float32)
    positions = document.accessor(corners)
    document.draw(positions, document.accessor(np.array([0, 1, 2, 3], np.uint16)), mode=5)
    document.draw(positions, document.accessor(np.array([0, 2, 4], np.uint16)))
    document.write(tmp_path / "strip.gltf")
    area, _, _, _ = measures(read_mesh_file(tmp_path / "strip.gltf"))
    assert area == pytest.approx(1.5)


def test_fans_get_a_sentence(tmp_path):
    """trimesh leaves them out."""
    document = Document()
    positions = document.accessor((CORNERS * SIZE).astype(np.float32))
    document.draw(positions, document.accessor(TRIANGLES.ravel().astype(np.uint16)))
    document.draw(positions, document.accessor(np.array([0, 1, 3, 2], np.uint16)), mode=6)
    document.write(tmp_path / "fan.gltf")
    with pytest.raises(MeshFileError, match="triangle fans; export it with triangles"):
        read_mesh_file(tmp_path / "fan.gltf")


def test_values_that_are_replaced_get_a_sentence(tmp_path):
    """trimesh reads a sparse accessor without the values that stand elsewhere."""
    document = Document()
    places = document.view(np.array([2, 7], np.uint16).tobytes())
    right = document.view((CORNERS * SIZE)[[2, 7]].astype(np.float32).tobytes())
    sparse = {
        "count": 2,
        "indices": {"bufferView": places, "componentType": 5123},
        "values": {"bufferView": right},
    }
    positions = document.accessor(CORNERS.astype(np.float32), sparse=sparse)
    document.draw(positions, document.accessor(TRIANGLES.ravel().astype(np.uint16)))
    document.write(tmp_path / "sparse.gltf")
    with pytest.raises(MeshFileError, match="sparse accessors"):
        read_mesh_file(tmp_path / "sparse.gltf")


def test_transforms_of_nodes(tmp_path):
    document = Document()
    positions = document.accessor(CORNERS.astype(np.float32))
    document.draw(positions, document.accessor(TRIANGLES.ravel().astype(np.uint16)))
    half = float(np.sqrt(0.5))
    # A quarter turn about z, after the scale of 0.3, 0.2, 0.5; then 0.2 along x by a matrix.
    moved = np.eye(4)
    moved[0, 3] = SIZE[0]
    document.nodes = [
        {"children": [1], "matrix": moved.T.ravel().tolist()},
        {"mesh": 0, "rotation": [0, 0, half, half], "scale": [SIZE[1], SIZE[0], SIZE[2]]},
    ]
    document.write(tmp_path / "turned.glb")
    assert_is_the_box(tmp_path / "turned.glb")


@pytest.mark.parametrize(
    ("material", "opacity"),
    [
        ({}, 1.0),
        ({"alphaMode": "OPAQUE"}, 1.0),
        ({"alphaMode": "BLEND"}, 0.25),
        ({"alphaMode": "MASK"}, 0.0),
        ({"alphaMode": "MASK", "alphaCutoff": 0.2}, 1.0),
    ],
)
def test_the_alpha_mode_decides_about_opacity(tmp_path, material, opacity):
    document = Document()
    positions = document.accessor((CORNERS * SIZE).astype(np.float32))
    document.draw(positions, document.accessor(TRIANGLES.ravel().astype(np.uint16)))
    document.primitives[0]["material"] = 0
    look = {"baseColorFactor": [1.0, 0.0, 0.0, 0.25]}
    document.more = {"materials": [{"pbrMetallicRoughness": look, **material}]}
    document.write(tmp_path / "red.glb")
    (part,) = read_mesh_file(tmp_path / "red.glb")
    assert part.rgba == pytest.approx((1.0, 0.0, 0.0, opacity), abs=3e-3)


def test_a_compressed_file_gets_a_sentence(tmp_path):
    document = Document()
    document.more = {"extensionsRequired": ["KHR_draco_mesh_compression"]}
    document.write(tmp_path / "small.glb")
    with pytest.raises(MeshFileError, match=r"compressed \(KHR_draco_mesh_compression\); export"):
        read_mesh_file(tmp_path / "small.glb")
