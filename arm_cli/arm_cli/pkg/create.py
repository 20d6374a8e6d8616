"""`arm pkg create`: creates a package that runs as soon as it is installed."""

import argparse
import getpass
import keyword
import os
import re
import sys
from collections.abc import Sequence
from pathlib import Path
from xml.sax.saxutils import escape

from arm_cli.arguments import Argument, verb
from arm_cli.errors import CommandUsageError
from arm_cli.output import say
from arm_node.user_file import read_text
from launch_py.system.packages import Packages

TEMPLATE = "config/package_template"
ENDING = ".in"
"""The suffix of the template's files, which become Python, YAML or XML when filled in."""
NAME = re.compile(r"[a-z][a-z0-9]*(_[a-z0-9]+)*", re.ASCII)
NAME_RULE = "use lower-case letters, digits and single underscores, and start with a letter"
BUILD_TYPES = {
    "ament_cmake": "there is no compiler here: packages of this suite are Python, for pip and "
    "colcon alike. Use --build-type ament_python, which is the default",
    "cmake": "packages of this suite are Python, for pip and colcon alike. Use --build-type "
    "ament_python, which is the default",
}
"""Build types of ros2 that are refused, and why."""
NEEDED = ("arm_gazebo", "rclpy", "sensor_msgs", "std_msgs")
"""The packages that the template's node and launch file use."""
NO_DESCRIPTION = "TODO: Package description"
NO_LICENSE = "TODO: License declaration"


@verb(
    Argument("package_name", help="such as my_arm"),
    Argument(
        "--package-format", "--package_format", choices=("2", "3"), default="3", help="always 3"
    ),
    Argument("--description", default=NO_DESCRIPTION, help="one sentence"),
    Argument("--license", default=NO_LICENSE, help="such as Apache-2.0"),
    Argument(
        "--destination-directory", default=os.curdir, metavar="FOLDER", help="default: this folder"
    ),
    Argument("--build-type", default="ament_python", help="only ament_python, the default"),
    Argument("--dependencies", nargs="+", default=[], metavar="PACKAGE"),
    Argument("--maintainer-email", help="default: your user name at todo.todo"),
    Argument("--maintainer-name", help="default: your user name"),
    Argument("--node-name", metavar="NODE", help="default: PACKAGE_node"),
    Argument("--library-name", metavar="LIBRARY", help="also create an empty module"),
)
def create(options: argparse.Namespace) -> None:
    """Write the package and list its files."""
    refuse_build_type(options.build_type)
    name = options.package_name
    node = options.node_name or f"{name}_node"
    check_names(name, node, options.library_name)
    folder = Path(options.destination_directory, name)
    if folder.exists():
        raise CommandUsageError(
            f"the directory already exists: {folder}; remove it, or choose another "
            "--destination-directory or another package name"
        )
    user = options.maintainer_name or getpass.getuser()
    words = {
        "PACKAGE": name,
        "NODE": node,
        "DESCRIPTION": options.description,
        "LICENSE": options.license,
        "MAINTAINER_NAME": user,
        "MAINTAINER_EMAIL": options.maintainer_email or f"{user.replace(' ', '.')}@todo.todo",
        "DEPENDENCIES": dependencies(options.dependencies),
    }
    for key in ("DESCRIPTION", "LICENSE", "MAINTAINER_NAME", "MAINTAINER_EMAIL"):
        if re.search(r'["\\\n]', words[key]):
            raise CommandUsageError(
                f"{words[key]!r} contains a quotation mark, a backslash or a line break"
            )
    announce(options, folder, words)
    write(folder, words)
    if options.library_name:
        write_file(
            folder / name / options.library_name / "__init__.py",
            f'"""What the nodes of {name} share."""\n',
        )
    if options.license != NO_LICENSE:
        say(f"put the text of {options.license} into {folder / 'LICENSE'}; arm does not write it")
    say("", "now:", f"  pip install {_shell_path(folder)}", f"  arm launch {name} {name}.launch.py")


def dependencies(named: Sequence[str]) -> str:
    """Return package.xml's lines for these packages and for those that the template needs.

    Each package is listed once, because colcon refuses duplicates.
    """
    kinds = {name: "depend" for name in named}
    kinds = dict.fromkeys(NEEDED, "exec_depend") | kinds
    return "\n".join(f"  <{kind}>{escape(name)}</{kind}>" for name, kind in kinds.items())


def refuse_build_type(build_type: str) -> None:
    """Check that the build type is ament_python.

    Raises:
        CommandUsageError: it is another build type.
    """
    if build_type in BUILD_TYPES:
        raise CommandUsageError(f"--build-type {build_type}: {BUILD_TYPES[build_type]}")
    if build_type != "ament_python":
        raise CommandUsageError(f"no build type {build_type!r}; the only one is ament_python")


def check_names(package: str, node: str, library: str | None) -> None:
    """Check that the names are valid for a package, a node and a module.

    Raises:
        CommandUsageError: a name is not valid, or is taken.
    """
    for what, name in (("package", package), ("node", node), ("library", library)):
        if name is None:
            continue
        if not NAME.fullmatch(name) or keyword.iskeyword(name):
            raise CommandUsageError(f"{name!r} is not a valid {what} name: {NAME_RULE}")
    if library in (package, node):
        raise CommandUsageError(f"library {library!r} has the name of the package or the node")
    if package in Packages(os.environ).names():
        raise CommandUsageError(
            f"there is already a package {package!r}, and one would hide the other; choose "
            f"another name, such as my_{package}"
        )
    if package in sys.stdlib_module_names:
        raise CommandUsageError(f"{package!r} is a module of Python; choose another name")


def announce(options: argparse.Namespace, folder: Path, words: dict[str, str]) -> None:
    """Print what is about to be written, as ros2 does."""
    say(
        "going to create a new package",
        f"package name: {options.package_name}",
        f"destination directory: {folder.parent.absolute()}",
        "package format: 3",
        "version: 0.0.0",
        f"description: {words['DESCRIPTION']}",
        f"maintainer: ['{words['MAINTAINER_NAME']} <{words['MAINTAINER_EMAIL']}>']",
        f"licenses: ['{words['LICENSE']}']",
        "build type: ament_python",
        f"dependencies: {options.dependencies}",
        f"node_name: {words['NODE']}",
    )


def write(folder: Path, words: dict[str, str]) -> None:
    """Write the template's files with their placeholders filled in.

    Raises:
        CommandUsageError: a file cannot be written.
    """
    template = Packages(os.environ).share_folder("arm_cli") / TEMPLATE
    for source in sorted(template.rglob(f"*{ENDING}")):
        place = str(source.relative_to(template)).removesuffix(ENDING)
        for word in ("PACKAGE", "NODE"):
            place = place.replace(word, words[word])
        quote = escape if source.name.endswith(".xml" + ENDING) else str
        text = read_text(source)
        for word, value in words.items():
            text = text.replace(f"@{word}@", value if word == "DEPENDENCIES" else quote(value))
        write_file(folder / place, text)


def write_file(path: Path, text: str) -> None:
    """Write one file, and create its folder if needed.

    Raises:
        CommandUsageError: the file cannot be written.
    """
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text, encoding="utf-8")
    except OSError as error:
        raise CommandUsageError(f"cannot write {path}: {error.strerror}") from error
    say(f"creating {path}")


def _shell_path(folder: Path) -> str:
    text = str(folder)
    return text if os.path.isabs(text) or text.startswith(".") else f"./{text}"
