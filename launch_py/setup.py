"""Installs this folder alone, by colcon or pip; the root pyproject.toml installs the suite."""

from pathlib import Path

from setuptools import find_packages, setup

PACKAGE = "launch_py"
REQUIREMENTS = [
    "PyYAML>=6.0",
    "rich>=13",
    "ros-jazzy-common-interfaces==5.3.6",
    "ros-jazzy-rclpy[fastrtps]==7.1.6",
]
DATA_FOLDERS = ["config"]
DATA_FILES = [
    path
    for folder in DATA_FOLDERS
    for path in Path(folder).rglob("*")
    if path.is_file() and path.suffix != ".pyc"
]

setup(
    name=PACKAGE,
    version="0.1.0",
    packages=find_packages(include=[PACKAGE, f"{PACKAGE}.*"]),
    data_files=[
        ("share/ament_index/resource_index/packages", [f"resource/{PACKAGE}"]),
        (f"share/{PACKAGE}", ["package.xml"]),
        *((f"share/{PACKAGE}/{path.parent}", [str(path)]) for path in DATA_FILES),
    ],
    install_requires=[
        "setuptools",
        *REQUIREMENTS,
    ],
    zip_safe=True,
    description=(
        "Process supervisor and launch files in Python: starts when ready, restarts with "
        "back-off, stops everything."
    ),
    license="Apache-2.0",
    entry_points={
        "console_scripts": ["launch_py = launch_py.__main__:main"],
    },
)
