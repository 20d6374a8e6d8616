"""Link the three shared libraries of a package.

``rosidl_typesupport_c`` opens the type supports at run time by their library names
``lib<package>__rosidl_typesupport_{fastrtps,introspection}_c.so``, but does not search the
package's folder. The dynamic loader returns a library that is already loaded under the same soname,
so the extension module, which Python finds by its path, lists both as needed and thereby loads
them. All code is in the first; the second is empty, because a symbol lookup in it continues in the
libraries that it needs.
"""

import sysconfig
from dataclasses import dataclass
from pathlib import Path

from interface_build.interface_package import InterfacePackage
from interface_build.ros_prefix import RosPrefix
from interface_build.toolchain import Toolchain
from interface_build.translation_unit import find_units
from interface_build.work_folder import WorkFolder

_RUNTIME_LIBRARIES = (
    "rosidl_runtime_c",
    "rosidl_typesupport_c",
    "rosidl_typesupport_fastrtps_c",
    "rosidl_typesupport_fastrtps_cpp",
    "rosidl_typesupport_introspection_c",
    "fastcdr",
    "rcutils",
)

# From <prefix>/lib/python3.x/site-packages/<package> to <prefix>/lib.
_ROS_LIBRARIES_FROM_PACKAGE = "$ORIGIN/../../.."


@dataclass(frozen=True, slots=True)
class LibraryNames:
    """File names of the three libraries of one package."""

    package: str

    @property
    def code(self) -> str:
        """The library with all code, found as the Fast DDS type support."""
        return f"lib{self.package}__rosidl_typesupport_fastrtps_c.so"

    @property
    def stub(self) -> str:
        """The empty library, found as the introspection type support."""
        return f"lib{self.package}__rosidl_typesupport_introspection_c.so"

    @property
    def extension(self) -> str:
        """The module that rclpy imports."""
        suffix = sysconfig.get_config_var("EXT_SUFFIX")
        return f"{self.package}_s__rosidl_typesupport_c{suffix}"


def entry_point(package: InterfacePackage, work: WorkFolder) -> Path:
    """Return the generated source of the extension module."""
    return work.generated / f"_{package.name}_s.ep.rosidl_typesupport_c.c"


def link_libraries(
    package: InterfacePackage,
    work: WorkFolder,
    prefix: RosPrefix,
    toolchain: Toolchain,
    includes: tuple[Path, ...],
    target: Path,
) -> None:
    """Compile the extension module and link all three libraries into the folder ``target``.

    The packages that this one uses must be linked, in folders beside ``target``.

    Raises:
        CompileError: a linker run failed.
    """
    target.mkdir(parents=True, exist_ok=True)
    names = LibraryNames(package.name)
    objects = [unit.object_file for unit in find_units(package, work)]
    toolchain.link(objects, target / names.code, _code_flags(package, target, prefix))
    toolchain.link([], target / names.stub, _flags(names.stub, target, [names.code]))

    extension = work.objects / "extension.o"
    toolchain.compile(entry_point(package, work), extension, includes, "-O1")
    flags = _flags(names.extension, target, [names.stub, names.code])
    toolchain.link([extension], target / names.extension, flags)


def _code_flags(package: InterfacePackage, target: Path, prefix: RosPrefix) -> list[str]:
    """Return flags that link the libraries of the wheels and of this build that the objects use."""
    folder = prefix.library_folder
    messages = sorted(
        path.name for path in folder.glob("lib*__rosidl_*.so") if not path.stem.endswith("_cpp")
    )
    return [
        f"-Wl,-soname,{LibraryNames(package.name).code}",
        f"-L{folder}",
        "-Wl,--as-needed",
        *(f"-l:{name}" for name in messages),
        *(f"-l{name}" for name in _RUNTIME_LIBRARIES),
        f"-Wl,-rpath,{_ROS_LIBRARIES_FROM_PACKAGE}",
        *(str(target.parent / name / LibraryNames(name).code) for name in package.uses),
        *(f"-Wl,-rpath,$ORIGIN/../{name}" for name in package.uses),
    ]


def _flags(soname: str, folder: Path, needed: list[str]) -> list[str]:
    """Return flags that link libraries in the same folder, even without undefined symbols."""
    return [
        f"-Wl,-soname,{soname}",
        f"-L{folder}",
        "-Wl,--no-as-needed",
        *(f"-l:{name}" for name in needed),
        "-Wl,-rpath,$ORIGIN",
    ]
