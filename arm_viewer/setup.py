"""Installs this folder as an ament_python package, for colcon; pip uses the root pyproject.toml."""

from collections.abc import Sequence
from pathlib import Path

from setuptools import find_packages, setup

PACKAGE = "arm_viewer"
DATA_FOLDERS = ["launch"]


def data_files() -> list[tuple[str, Sequence[str]]]:
    """Return the share/ entries of every file below the data folders."""
    share = Path("share") / PACKAGE
    files: list[tuple[str, Sequence[str]]] = [
        ("share/ament_index/resource_index/packages", [f"resource/{PACKAGE}"]),
        (str(share), ["package.xml"]),
    ]
    for folder in DATA_FOLDERS:
        for path in sorted(Path(folder).rglob("*")):
            if path.is_file():
                files.append((str(share / path.parent), [str(path)]))
    return files


setup(
    name=PACKAGE,
    version="0.1.0",
    packages=find_packages(include=[PACKAGE, f"{PACKAGE}.*"]),
    data_files=data_files(),
    install_requires=["setuptools"],
    zip_safe=True,
    description="A page in the browser that shows robots and drives them.",
    license="Apache-2.0",
    entry_points={
        "console_scripts": ["arm_viewer_node = arm_viewer.arm_viewer_node:main"],
    },
)
