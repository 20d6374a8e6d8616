"""Tell setuptools which packages the build makes and who makes them.

Run by the backend only (``pip install ./arm_interfaces``). The rest of the metadata stands in
``pyproject.toml``.
"""

from pathlib import Path

from interface_build import command, interface_package
from setuptools import Extension, setup

PACKAGES = interface_package.find_packages(Path(__file__).parent / "interfaces")

setup(
    ext_modules=[Extension(package.extension_name, sources=[]) for package in PACKAGES],
    cmdclass={
        "build": command.Build,
        "build_ext": command.BuildInterfaces,
        "egg_info": command.EggInfo,
    },
)
