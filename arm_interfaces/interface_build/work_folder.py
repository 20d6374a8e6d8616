"""The folders for intermediate files, all in one temporary folder of the whole build.

pip builds in the source tree, and files left there would get into the next build, perhaps by
another Python version. So nothing is written there.
"""

import functools
import tempfile
from dataclasses import dataclass
from pathlib import Path


def scratch_folder(name: str) -> Path:
    """Return a folder of this name, which is deleted when this process ends."""
    folder = Path(_temporary_directory().name) / name
    folder.mkdir(exist_ok=True)
    return folder


@functools.cache
def _temporary_directory() -> tempfile.TemporaryDirectory[str]:
    """Create the folder in TMPDIR on first use."""
    return tempfile.TemporaryDirectory(prefix="arm_interfaces_")


@dataclass(frozen=True, slots=True)
class WorkFolder:
    """Intermediate files of one package.

    The generated folders end in the package's name, because the generated code includes its
    headers as ``<package>/msg/...``.

    Attributes:
        root: a folder of the whole build, shared by all packages.
        package: the package's name.
    """

    root: Path
    package: str

    @property
    def generated(self) -> Path:
        """Output of all generators except one."""
        return self.root / "generated" / self.package

    @property
    def introspection(self) -> Path:
        """Output of the introspection generator, whose file names partly repeat the others'."""
        return self.root / "introspection" / self.package

    @property
    def arguments(self) -> Path:
        """The argument files of the generators."""
        return self.root / "arguments" / self.package

    @property
    def objects(self) -> Path:
        """The object files."""
        return self.root / "objects" / self.package

    @property
    def include_folders(self) -> tuple[Path, Path]:
        """The include folders that precede the wheels'."""
        return self.generated.parent, self.introspection.parent

    def beside(self, package: str) -> "WorkFolder":
        """Return the folder of another package of the same build."""
        return WorkFolder(self.root, package)

    def create(self) -> None:
        """Make all folders."""
        for folder in (self.generated, self.introspection, self.arguments, self.objects):
            folder.mkdir(parents=True, exist_ok=True)
