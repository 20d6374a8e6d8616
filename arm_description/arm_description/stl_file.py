"""STL files, binary and text, without a mesh library: the import of one takes half a second."""

import re

import numpy as np

from arm_description.errors import MeshFileError
from arm_description.mesh_data import MeshData, merged

HEADER_BYTES = 80
TRIANGLE = np.dtype([("normal", "<f4", 3), ("vertices", "<f4", (3, 3)), ("attribute", "<u2")])
VERTEX = re.compile(rb"vertex\s+(\S+)\s+(\S+)\s+(\S+)", re.IGNORECASE)


def read_stl(data: bytes) -> MeshData:
    """Return the mesh of an STL file's bytes.

    Raises:
        MeshFileError: neither a binary nor a text STL, or one that is cut off.
    """
    start = HEADER_BYTES + 4
    if len(data) >= start:
        count = int.from_bytes(data[HEADER_BYTES:start], "little")
        # A binary file may start with the word 'solid' too: only the size tells.
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
            f"a text STL with {len(corners)} vertices, which is no number of triangles"
        )
    try:
        return merged(np.array(corners).astype(np.float32))
    except ValueError as error:
        raise MeshFileError(f"a text STL with a coordinate that is no number: {error}") from error
