"""Where the intermediate files of one package lie during a build."""

from dataclasses import dataclass
from pathlib import Path


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
        """Output of all generators but one."""
        return self.root / "generated" / self.package

    @property
    def introspection(self) -> Path:
        """Output of the introspection generator, some of whose files have names used above."""
        return self.root / "introspection" / self.package

    @property
    def arguments(self) -> Path:
        """The argument files that the generators take."""
        return self.root / "arguments" / self.package

    @property
    def objects(self) -> Path:
        """What the compiler makes."""
        return self.root / "objects" / self.package

    @property
    def include_folders(self) -> tuple[Path, Path]:
        """What goes before the wheels' own include folders."""
        return self.generated.parent, self.introspection.parent

    def create(self) -> None:
        """Make all folders."""
        for folder in (self.generated, self.introspection, self.arguments, self.objects):
            folder.mkdir(parents=True, exist_ok=True)
