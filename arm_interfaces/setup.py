"""Tell setuptools which packages to build and which commands build them.

Only the backend runs it, as in ``pip install ./arm_interfaces``. The other metadata are in
``pyproject.toml``.
"""

from interface_build import command, interface_package
from interface_build.project import DEFINITIONS, read_project
from setuptools import Extension, setup

PACKAGES = interface_package.find_packages(DEFINITIONS)

setup(
    install_requires=read_project().dependencies,
    ext_modules=[Extension(package.extension_name, sources=[]) for package in PACKAGES],
    cmdclass={
        "build": command.Build,
        "build_ext": command.BuildInterfaces,
        "egg_info": command.EggInfo,
    },
)
