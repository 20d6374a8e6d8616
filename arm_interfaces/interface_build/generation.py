"""Call the rosidl generators of the wheels as functions.

Their command line does not work: each wheel contains its entry points twice, which the command
rejects. A generator reads its arguments from a JSON file and keeps its template engine in a global,
so each needs its own process, not only a thread.
"""

import contextlib
import io
import json
from collections.abc import Callable
from pathlib import Path

import rosidl_generator_c
import rosidl_generator_type_description
import rosidl_typesupport_c
import rosidl_typesupport_fastrtps_c
import rosidl_typesupport_introspection_c
from rosidl_adapter.action import convert_action_to_idl
from rosidl_adapter.msg import convert_msg_to_idl
from rosidl_adapter.srv import convert_srv_to_idl
from rosidl_generator_py.generate_py_impl import generate_py

from interface_build import generator_caches
from interface_build.interface_package import InterfacePackage
from interface_build.ros_prefix import RosPrefix
from interface_build.work_folder import WorkFolder

_CONVERTERS = {
    "msg": convert_msg_to_idl,
    "srv": convert_srv_to_idl,
    "action": convert_action_to_idl,
}

# rmw_fastrtps serialises with the first, but create_publisher registers a type with the second.
_TYPE_SUPPORTS = ["rosidl_typesupport_fastrtps_c", "rosidl_typesupport_introspection_c"]


def describe(package: InterfacePackage, work: WorkFolder, prefix: RosPrefix) -> None:
    """Write the IDL files and the type descriptions, which all other steps need.

    The packages that this one uses must be described.
    """
    generator_caches.install()
    work.create()
    with contextlib.redirect_stdout(io.StringIO()):
        for interface in package.interfaces:
            convert = _CONVERTERS[interface.kind]
            folder = work.generated / interface.kind
            convert(package.root, package.name, Path(interface.source), folder)
        described = {
            **prefix.description_folders(),
            **{name: work.beside(name).generated for name in package.uses},
        }
        includes = [f"{name}:{path}" for name, path in described.items()]
        arguments = _arguments(package, work, work.generated)
        arguments["include_paths"] = includes
        path = _write_arguments(work, "rosidl_generator_type_description", arguments)
        rosidl_generator_type_description.generate_type_hash(path)
    _write_visibility_headers(package, work, prefix)
    (work.generated / "__init__.py").touch()


def generate_messages(package: InterfacePackage, work: WorkFolder, prefix: RosPrefix) -> None:
    """Write the C structs, their functions, and the type descriptions as C data."""
    arguments = _arguments(package, work, work.generated)
    arguments["type_description_tuples"] = [
        f"{interface.idl}:{work.generated / interface.description}"
        for interface in package.interfaces
    ]
    arguments["ros_interface_files"] = [
        str(package.root / interface.source) for interface in package.interfaces
    ]
    _generate(rosidl_generator_c.generate_c, "rosidl_generator_c", arguments, work, prefix)


def generate_fastrtps(package: InterfacePackage, work: WorkFolder, prefix: RosPrefix) -> None:
    """Write the C++ code that serialises for Fast DDS."""
    _generate(
        rosidl_typesupport_fastrtps_c.generate_typesupport_fastrtps_c,
        "rosidl_typesupport_fastrtps_c",
        _arguments(package, work, work.generated),
        work,
        prefix,
    )


def generate_introspection(package: InterfacePackage, work: WorkFolder, prefix: RosPrefix) -> None:
    """Write the tables that describe the structs at run time."""
    _generate(
        rosidl_typesupport_introspection_c.generate_c,
        "rosidl_typesupport_introspection_c",
        _arguments(package, work, work.introspection),
        work,
        prefix,
    )


def generate_dispatch(package: InterfacePackage, work: WorkFolder, prefix: RosPrefix) -> None:
    """Write the code that picks one of the type supports by name."""

    def generate(path: str) -> object:
        return rosidl_typesupport_c.generate_c(path, _TYPE_SUPPORTS)

    arguments = _arguments(package, work, work.generated)
    _generate(generate, "rosidl_typesupport_c", arguments, work, prefix)


def generate_python(package: InterfacePackage, work: WorkFolder, prefix: RosPrefix) -> None:
    """Write the Python classes and the C code that converts them."""

    def generate(path: str) -> object:
        return generate_py(path, ["rosidl_typesupport_c"])

    arguments = _arguments(package, work, work.generated)
    _generate(generate, "rosidl_generator_py", arguments, work, prefix)


GENERATORS = {
    "messages": generate_messages,
    "fastrtps": generate_fastrtps,
    "introspection": generate_introspection,
    "dispatch": generate_dispatch,
    "python": generate_python,
}


def _generate(
    generator: Callable[[str], object],
    name: str,
    arguments: dict[str, object],
    work: WorkFolder,
    prefix: RosPrefix,
) -> None:
    """Run one generator silently with its templates."""
    generator_caches.install()
    arguments["template_dir"] = str(prefix.template_folder(name))
    with contextlib.redirect_stdout(io.StringIO()):
        generator(_write_arguments(work, name, arguments))


def _arguments(package: InterfacePackage, work: WorkFolder, output: Path) -> dict[str, object]:
    """Return the arguments that every generator needs."""
    return {
        "package_name": package.name,
        "output_dir": str(output),
        "idl_tuples": [f"{work.generated}:{interface.idl}" for interface in package.interfaces],
        "target_dependencies": [],
        "ros_interface_dependencies": [],
    }


def _write_arguments(work: WorkFolder, name: str, arguments: dict[str, object]) -> str:
    """Write the arguments to the file that the generator reads; return its path."""
    path = work.arguments / f"{name}.json"
    path.write_text(json.dumps(arguments), encoding="utf-8")
    return str(path)


def _write_visibility_headers(
    package: InterfacePackage, work: WorkFolder, prefix: RosPrefix
) -> None:
    """Write the three export headers, which CMake would write otherwise."""
    folder = work.generated / "msg"
    folder.mkdir(exist_ok=True)
    for generator in ("rosidl_generator_c", *_TYPE_SUPPORTS):
        name = f"{generator}__visibility_control.h"
        text = (prefix.template_folder(generator) / f"{name}.in").read_text(encoding="utf-8")
        text = text.replace("@PROJECT_NAME@", package.name)
        text = text.replace("@PROJECT_NAME_UPPER@", package.name.upper())
        (folder / name).write_text(text, encoding="utf-8")
