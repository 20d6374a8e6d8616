"""Reads STL files, binary and text, without a mesh library, which takes long to import."""

import re

import numpy as np

from arm_description.errors import MeshFileError
from arm_description.mesh.data import MeshData, merged

HEADER_BYTES = 80
TRIANGLE = np.dtype([("normal", "<f4", 3), ("vertices", "<f4", (3, 3)), ("attribute", "<u2")])
VERTEX = re.compile(rb"vertex\s+(\S+)\s+(\S+)\s+(\S+)", re.IGNORECASE)


def read_stl(data: bytes) -> MeshData:
    """Return the mesh of an STL file's bytes.

    Raises:
        MeshFileError: the bytes are not STL, or incomplete.
    """
    start = HEADER_BYTES + 4
    if len(data) >= start:
        count = int.from_bytes(data[HEADER_BYTES:start], "little")
        # A binary file may also start with the word 'solid', so the size decides.
        if count and len(data) >= start + count * TRIANGLE.itemsize:
            triangles = np.frombuffer(data, TRIANGLE, count, start)
            return merged(triangles["vertices"].reshape(-1, 3))
    if not data.lstrip()[:5].lower() == b"solid":
        raise MeshFileError("neither a text STL nor a complete binary one")
    return _read_text(data)


def _read_text(data: bytes) -> MeshData:
    corners = VERTEX.findall(data)
    if not corners or len(corners) % 3:
        raise MeshFileError(
            f"a text STL whose number of vertices, {len(corners)}, is not a multiple of 3"
        )
    try:
        return merged(np.array(corners).astype(np.float32))
    except ValueError as error:
        raise MeshFileError(f"a text STL with an invalid coordinate: {error}") from error
