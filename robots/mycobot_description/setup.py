"""Installs this folder alone, by colcon or pip; the root pyproject.toml installs the suite."""

from pathlib import Path

from setuptools import setup

PACKAGE = "mycobot_description"
NEIGHBOURS = ["../../arm_description", "../../launch_py"]
DATA_FOLDERS = ["urdf", "meshes", "config", "launch"]
DATA_FILES = [
    path
    for folder in DATA_FOLDERS
    for path in Path(folder).rglob("*")
    if path.is_file() and path.suffix != ".pyc"
]

setup(
    name=PACKAGE,
    version="0.1.0",
    packages=[],
    data_files=[
        ("share/ament_index/resource_index/packages", [f"resource/{PACKAGE}"]),
        (f"share/{PACKAGE}", ["package.xml"]),
        *((f"share/{PACKAGE}/{path.parent}", [str(path)]) for path in DATA_FILES),
    ],
    install_requires=[
        "setuptools",
        *(f"{Path(path).name} @ {Path(path).resolve().as_uri()}" for path in NEIGHBOURS),
    ],
    zip_safe=True,
    description="The myCobot 280 with its adaptive gripper: xacro, meshes, display.",
    license="Apache-2.0",
)
