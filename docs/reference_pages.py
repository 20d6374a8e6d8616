"""MkDocs hook: writes the pages of the reference from what is installed.

`arm` verbs come from their parsers, launch arguments from the launch files, controllers and the
controller manager from their parameters, messages from their definitions, and the Python pages
from each package's `__all__`. The table of the originals comes from the lines that tests type. The
benchmark page takes its tables from the committed results, and formulas become MathML.
"""

import contextlib
import importlib
import io
import os
import re
import sys
from collections.abc import Iterator
from functools import cache
from html import unescape
from pathlib import Path
from typing import Any

from ament_index_python.packages import get_package_share_directory
from latex2mathml.converter import convert
from mkdocs.config.defaults import MkDocsConfig
from mkdocs.exceptions import PluginError
from mkdocs.structure.files import File, Files

from arm_cli.verb import Verb, VerbFamily
from arm_cli.verbs import ARM
from arm_control.manager.registry import controller_class, controller_types
from arm_node import workarounds

os.environ.setdefault("AMENT_PREFIX_PATH", sys.prefix)
sys.path.insert(0, str(Path(__file__).parent))
from node_parameters import node_parameters_page, parameter_of, parameter_table
from originals_table import table_page

ROOT = Path(__file__).parents[1]
RESULTS = "<!-- benchmarks/RESULTS.md -->"
WORKAROUNDS = "<!-- arm_node.workarounds -->"
INTERFACES = [ROOT / name / "interfaces" for name in ("arm_interfaces", "arm_moveit_interfaces")]
BY_JOINT = {"joints": ("<joint>",), "dof_names": ("<dof>",)}
"""Parameters whose values are part of other parameters' names."""
LAUNCH_FILES = (
    "arm_gazebo/arm_gazebo.launch.py",
    "arm_gazebo/arm_world.launch.py",
    "arm_gazebo/sim.launch.py",
    "arm_gazebo/leader_follower.launch.py",
    "arm_control/arm_control.launch.py",
    "arm_control/arm_mock.launch.py",
    "arm_controller/arm_controller_node.launch.py",
    "arm_description/display.launch.py",
    "arm_description/robot_view.launch.py",
    "arm_viewer/viewer.launch.py",
    "mycobot_gazebo/mycobot.gazebo.launch.py",
    "mycobot_gazebo/pick_and_place.launch.py",
    "mycobot_moveit_config/load_ros2_controllers.launch.py",
    "mycobot_description/robot_state_publisher.launch.py",
    "gz_ros2_control_demos/diff_drive_example.launch.py",
    "gz_ros2_control_demos/gripper_mimic_joint_example_effort.launch.py",
    "gz_ros2_control_demos/gripper_mimic_joint_example_position.launch.py",
    "yahboom_rosmaster_description/robot_state_publisher.launch.py",
    "yahboom_rosmaster_gazebo/yahboom_rosmaster.gazebo.launch.py",
    "ros_gz_sim/gz_sim.launch.py",
)
FORMULA = re.compile(r'<(span|div) class="arithmatex">\\[(\[](.+?)\\[)\]]</\1>', re.DOTALL)
PYTHON_PACKAGES = (
    "arm_control",
    "arm_control.testing",
    "arm_description",
    "arm_node",
    "arm_sim",
    "launch_py",
    "launch_py.ros",
)

Pages = Iterator[tuple[str, str]]
"""Paths below docs/, and their text."""


def on_config(config: MkDocsConfig) -> MkDocsConfig:
    """Fill the lists of generated pages into the navigation."""
    groups = generated_pages()
    reference = next(part["Reference"] for part in config.nav or [] if "Reference" in part)
    for entry in reference:
        for title, value in entry.items():
            if isinstance(value, list):
                entry[title] = list(groups[value[0]])
    return config


def on_files(files: Files, config: MkDocsConfig) -> Files:
    """Add the generated pages."""
    for pages in generated_pages().values():
        for path, text in pages.items():
            files.append(File.generated(config, path, content=text))
    return files


@cache
def generated_pages() -> dict[str, dict[str, str]]:
    """Return all generated pages: their text, by group and path."""
    groups = {
        "arm": verb_pages,
        "launch": launch_pages,
        "messages": message_pages,
        "api": python_pages,
        "control": control_pages,
        "originals": originals_pages,
    }
    return {group: dict(pages()) for group, pages in groups.items()}


def on_page_markdown(markdown: str, **context: Any) -> str:
    """Insert the benchmark results and the table of workarounds at their marks."""
    markdown = markdown.replace(WORKAROUNDS, workarounds.__doc__ or "")
    if RESULTS not in markdown:
        return markdown
    results = (ROOT / "benchmarks" / "RESULTS.md").read_text().partition("\n")[2]
    return markdown.replace(RESULTS, results.replace("\n### ", "\n## "))


def on_page_content(html: str, **context: Any) -> str:
    """Convert formulas to MathML, which browsers show without a script."""
    return FORMULA.sub(_mathml, html)


def _mathml(formula: re.Match[str]) -> str:
    display = "block" if formula[1] == "div" else "inline"
    return convert(unescape(formula[2]), display=display)


def verb_pages() -> Pages:
    """Write a page for each family of verbs, and one for the verbs that stand alone."""
    alone = [verb for verb in ARM.verbs if not isinstance(verb, VerbFamily)]
    yield (
        "reference/arm/index.md",
        "\n".join(
            [
                "# The arm command",
                "",
                "| verb | |",
                "|---|---|",
                *(f"| {_verb_link(verb)} | {verb.help} |" for verb in ARM.verbs),
                "",
                *(line for verb in alone for line in _verb_section(f"arm {verb.name}", verb)),
            ]
        ),
    )
    for family in ARM.verbs:
        if not isinstance(family, VerbFamily):
            continue
        program = f"arm {family.name}"
        lines = [f"# {program}", "", f"{family.help[0].upper()}{family.help[1:]}.", ""]
        for verb in family.verbs:
            lines += _verb_section(f"{program} {verb.name}", verb)
        yield f"reference/arm/{family.name}.md", "\n".join(lines)


def _verb_link(verb: Any) -> str:
    if isinstance(verb, VerbFamily):
        return f"[`arm {verb.name}`]({verb.name}.md)"
    return f"[`arm {verb.name}`](#arm-{verb.name})"


def _verb_section(program: str, verb: Any) -> list[str]:
    if isinstance(verb, Verb):
        text = verb.parser(program).format_help()
    else:
        text = _printed_by([verb.name, "--help"])
    return [f"## {program}", "", "```text", text.strip(), "```", ""]


def launch_pages() -> Pages:
    """Write a page for the launch files of each package."""
    packages = dict.fromkeys(path.partition("/")[0] for path in LAUNCH_FILES)
    for package in packages:
        lines = [f"# {package}", ""]
        for path in LAUNCH_FILES:
            if path.startswith(f"{package}/"):
                lines += _launch_section(package, path.partition("/")[2])
        yield f"reference/launch/{package}.md", "\n".join(lines)


def _launch_section(package: str, file: str) -> list[str]:
    share = str(Path(get_package_share_directory(package)).parent)
    text = _printed_by(["launch", package, file, "--show-args"]).replace(share, "share")
    lines = [f"## {file}", "", f"`arm launch {package} {file}`", ""]
    arguments = re.split(r"\n  (?=\S)", text)[1:]
    if not arguments:
        return [*lines, "It has no arguments.", ""]
    lines += ["| argument | default | |", "|---|---|---|"]
    for argument in arguments:
        head, *rest = (line.strip() for line in argument.strip().split("\n"))
        name, _, default = head.partition("  ")
        default = default.strip("()").removeprefix("default ").replace("|", "\\|")
        about = "; ".join(rest).replace("|", "\\|").replace("<", "&lt;")
        lines.append(f"| `{name}` | `{default}` | {about} |")
    return [*lines, ""]


def control_pages() -> Pages:
    """Write the page of the controllers and that of the nodes."""
    lines = [
        "# Controllers",
        "",
        "Their parameters. A name with `<joint>` or `<dof>` stands for one of each.",
        "",
    ]
    for name in controller_types():
        if not controller_class(name).__module__.startswith("arm_control."):
            continue
        lines += [f"## {name}", "", _docstring(controller_class(name)), ""]
        specs = controller_class(name).parameter_specs(BY_JOINT)
        lines += parameter_table([parameter_of(spec) for spec in specs])
    yield "reference/controllers.md", "\n".join(lines)
    yield "reference/nodes.md", node_parameters_page()


def _docstring(documented: Any) -> str:
    return (documented.__doc__ or "").partition("\n\n")[0].replace("\n", " ").strip()


def message_pages() -> Pages:
    """Write a page for each interface package that the suite compiles."""
    for package in sorted(
        path.parent for folder in INTERFACES for path in folder.glob("*/package.xml")
    ):
        lines = [f"# {package.name}", ""]
        for suffix in ("msg", "srv", "action"):
            for definition in sorted(package.rglob(f"*.{suffix}")):
                name = f"{package.name}/{suffix}/{definition.stem}"
                lines += [f"## {name}", "", "```text", definition.read_text().strip(), "```", ""]
        yield f"reference/messages/{package.name}.md", "\n".join(lines)


def originals_pages() -> Pages:
    """Write the page of what the originals do."""
    yield "reference/originals.md", table_page()


def python_pages() -> Pages:
    """Write a page for each package that programs import."""
    for package in PYTHON_PACKAGES:
        module = importlib.import_module(package)
        names = getattr(module, "__all__", None) or _own_names(module)
        lines = [f"# {package}", "", (module.__doc__ or "").strip(), ""]
        for name in names:
            lines += [f"::: {package}.{name}", ""]
        yield f"reference/api/{package}.md", "\n".join(lines)


def _own_names(module: Any) -> list[str]:
    return [
        name
        for name, value in vars(module).items()
        if getattr(value, "__module__", None) == module.__name__ and not name.startswith("_")
    ]


def _printed_by(words: list[str]) -> str:
    """Return what `arm WORDS` prints.

    Raises:
        PluginError: it fails.
    """
    printed = io.StringIO()
    with contextlib.redirect_stdout(printed):
        try:
            code = ARM.run("arm", words)
        except SystemExit as end:
            code = end.code
    if code:
        raise PluginError(f"'arm {' '.join(words)}' failed with exit code {code}")
    return printed.getvalue()
