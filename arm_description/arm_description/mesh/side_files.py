"""Files beside a mesh that belong to it: materials of an .obj, data of a .gltf.

It imports trimesh, which takes half a second, so import it only for a mesh that needs it.
"""

from pathlib import Path

from trimesh.resolvers import FilePathResolver

from arm_description.mesh.data import LARGEST_BYTES
from arm_node.user_file import read_bytes

PICTURES = (".png", ".jpg", ".jpeg", ".tga", ".tif", ".tiff", ".bmp", ".gif", ".dds", ".webp")


class SideFiles(FilePathResolver):
    """Gives trimesh the regular files beside or below a mesh, except pictures.

    Parts of a robot have one colour each, so pictures are not needed.
    """

    def __init__(self, mesh: Path) -> None:
        super().__init__(str(mesh))

    def get(self, name: str) -> bytes:
        """Return the content of a file; raise OSError, or ValueError outside the folder."""
        path = self.absolute(name)
        if path.suffix.lower() in PICTURES:
            raise FileNotFoundError(f"the picture {path} is not needed")
        return read_bytes(path, LARGEST_BYTES)
