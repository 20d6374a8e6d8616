"""The interface definitions of one ROS package in the source tree."""

from dataclasses import dataclass
from pathlib import Path
from xml.etree import ElementTree

KINDS = ("msg", "srv", "action")


@dataclass(frozen=True, slots=True)
class Interface:
    """One definition file.

    Attributes:
        kind: ``msg``, ``srv`` or ``action``; both the folder and the suffix.
        name: the type's name without its package, such as ``TFMessage``.
    """

    kind: str
    name: str

    @property
    def source(self) -> str:
        """Path of the definition inside its package, with forward slashes."""
        return f"{self.kind}/{self.name}.{self.kind}"

    @property
    def idl(self) -> str:
        """Path of the IDL file that the generators read, relative to their output."""
        return f"{self.kind}/{self.name}.idl"

    @property
    def description(self) -> str:
        """Path of the type description with its hash, relative to the output."""
        return f"{self.kind}/{self.name}.json"


@dataclass(frozen=True, slots=True)
class InterfacePackage:
    """A ROS package that contains only definitions.

    Attributes:
        name: the package's name.
        root: its folder in the source tree.
        interfaces: its definitions, messages first.
        uses: the packages of the same source tree that its definitions use.
    """

    name: str
    root: Path
    interfaces: tuple[Interface, ...]
    uses: tuple[str, ...]

    @property
    def extension_name(self) -> str:
        """Dotted name under which rclpy imports the compiled part."""
        return f"{self.name}.{self.name}_s__rosidl_typesupport_c"

    @property
    def kinds(self) -> tuple[str, ...]:
        """The kinds that occur in this package, in a fixed order."""
        present = {interface.kind for interface in self.interfaces}
        return tuple(kind for kind in KINDS if kind in present)


def find_packages(folder: Path) -> tuple[InterfacePackage, ...]:
    """Read every package below ``folder``, the largest first.

    A large package that started last would leave the other cores idle at the end.
    """
    roots = sorted(path.parent.resolve() for path in folder.glob("*/package.xml"))
    names = {root.name for root in roots}
    packages = [
        InterfacePackage(
            name=root.name,
            root=root,
            interfaces=_find_interfaces(root),
            uses=tuple(name for name in _find_depends(root) if name in names),
        )
        for root in roots
    ]
    return tuple(sorted(packages, key=lambda package: -len(package.interfaces)))


def _find_depends(root: Path) -> list[str]:
    """List the packages that the manifest names."""
    manifest = ElementTree.parse(root / "package.xml")
    return [name for depend in manifest.iter("depend") if (name := depend.text)]


def _find_interfaces(root: Path) -> tuple[Interface, ...]:
    """List the definitions of one package, sorted, messages first."""
    return tuple(
        Interface(kind, path.stem)
        for kind in KINDS
        for path in sorted((root / kind).glob(f"*.{kind}"))
    )
