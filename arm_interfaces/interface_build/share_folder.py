"""The files for ``share``, where recorders and command-line tools read definitions."""

from pathlib import Path

from interface_build.interface_package import InterfacePackage

_INDEX = "share/ament_index/resource_index"


def data_files(package: InterfacePackage, work: Path) -> list[tuple[str, list[str]]]:
    """List the files by their destination folder, in setuptools' form.

    Args:
        package: the package.
        work: a folder for generated files.
    """
    share = f"share/{package.name}"
    definitions = [
        (
            f"{share}/{kind}",
            [str(package.root / i.source) for i in package.interfaces if i.kind == kind],
        )
        for kind in package.kinds
    ]
    return [
        (share, [str(package.root / "package.xml")]),
        *definitions,
        (f"{_INDEX}/packages", [_write_marker(work / "packages", package.name, "")]),
        (
            f"{_INDEX}/rosidl_interfaces",
            [_write_marker(work / "rosidl_interfaces", package.name, _list_interfaces(package))],
        ),
    ]


def _list_interfaces(package: InterfacePackage) -> str:
    """List the definition files, one per line, for ``interface list``."""
    return "\n".join(interface.source for interface in package.interfaces)


def _write_marker(folder: Path, name: str, content: str) -> str:
    """Write one file of the ament index; return its path."""
    folder.mkdir(parents=True, exist_ok=True)
    path = folder / name
    path.write_text(content, encoding="utf-8")
    return str(path)
