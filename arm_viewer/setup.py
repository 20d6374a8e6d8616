"""Installs this folder as an ament_python package, for colcon; pip uses the root pyproject.toml."""

from pathlib import Path

from setuptools import find_packages, setup

PACKAGE = "arm_viewer"
DATA_FOLDERS = ["launch"]
DATA_FILES = [path for folder in DATA_FOLDERS for path in Path(folder).rglob("*") if path.is_file()]

setup(
    name=PACKAGE,
    version="0.1.0",
    packages=find_packages(include=[PACKAGE, f"{PACKAGE}.*"]),
    data_files=[
        ("share/ament_index/resource_index/packages", [f"resource/{PACKAGE}"]),
        (f"share/{PACKAGE}", ["package.xml"]),
        *((f"share/{PACKAGE}/{path.parent}", [str(path)]) for path in DATA_FILES),
    ],
    install_requires=["setuptools"],
    zip_safe=True,
    description="A page in the browser that shows robots and drives them.",
    license="Apache-2.0",
    entry_points={
        "console_scripts": ["arm_viewer_node = arm_viewer.arm_viewer_node:main"],
    },
)
