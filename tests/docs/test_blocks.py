"""Every command and code block of the README and the manual does what its page says."""

import runpy
import time
import tomllib
from pathlib import Path

import pytest
import yaml
from blocks import PAGES, Block, Command, blocks_of, commands_of
from lxml import etree
from shell import ANYTHING, INTERRUPT, Background, Running, as_in_peace, comparable, ended, pattern

LANGUAGES = {"console", "bash", "python", "yaml", "xml", "toml", "text", "dockerfile"}


RUNNING_PAGES = [page for page in PAGES if "```console" in page.read_text()]


@pytest.mark.ros
@pytest.mark.slow
@pytest.mark.timeout(600)
@pytest.mark.parametrize("page", RUNNING_PAGES, ids=lambda page: page.stem)
def test_the_commands_of_a_page_print_what_it_says(page, folder, background):
    for block in blocks_of(page):
        if block.title:
            (folder / block.title).write_text(block.text)
        elif block.language == "console" and not block.directive.startswith("not run"):
            for command in commands_of(block):
                run(command, block, folder, background)


def run(command: Command, block: Block, folder: Path, background: Background) -> None:
    how, _, words = block.directive.partition(" ")
    if how == "background":
        background.start(command.line, command.output)
        return
    line = f"{command.line} --print" if how == "print" else command.line
    if how == "typed" or INTERRUPT in command.output:
        code, output = at_a_terminal(line, command, how, words, folder)
    else:
        code, output = ended(line, folder)
    where = f"{block.place}: {line}\n{output}"
    if INTERRUPT not in command.output and words != "any":
        assert code == (int(words) if how == "exit" else 0), where
    lines = [line for line in command.output if line != INTERRUPT]
    if how != "print":
        wanted = pattern(lines or [ANYTHING], how == "exact")
        said = comparable(as_in_peace(output, lines), how == "exact")
        assert wanted.fullmatch(said), where


def at_a_terminal(
    line: str, command: Command, how: str, words: str, folder: Path
) -> tuple[int, str]:
    """Type a command and what it asks for, or interrupt it; return its exit code and output."""
    running = Running(line, folder, terminal=how == "typed")
    try:
        if how == "typed":
            running.wait_until_shown([f"{command.output[0].removesuffix(words)}..."])
            running.type(f"{words}\n")
        if INTERRUPT in command.output:
            before = command.output[: command.output.index(INTERRUPT)]
            running.wait_until_shown(list(before), exact=how == "exact")
            running.interrupt()
        return running.wait(), running.output
    finally:
        running.close()


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.stem)
def test_blocks_that_are_files_are_well_formed(page):
    for block in blocks_of(page):
        assert block.language in LANGUAGES, block.place
        if block.language == "python":
            compile(block.text, block.place, "exec")
        elif block.language == "yaml":
            yaml.safe_load(block.text)
        elif block.language == "xml":
            etree.fromstring(block.text)
        elif block.language == "toml":
            tomllib.loads(block.text)


def test_blocks_that_cannot_run_say_why():
    blocks = [block for page in PAGES for block in blocks_of(page)]
    assert len(blocks) > 50
    for block in blocks:
        if block.language in ("bash", "dockerfile"):
            assert block.directive.startswith("not run, "), block.place
        if block.directive.startswith("not run"):
            assert len(block.directive) > len("not run, "), block.place


def rows_of(kind: str) -> dict[str, str]:
    """Return the page's table of topics or of services: name to type."""
    page = Path(__file__).parents[2] / "docs" / "reference" / "topics.md"
    rows = [line.split("|") for line in page.read_text().splitlines() if line.startswith("| `/")]
    return {row[1].strip(" `"): row[2].strip() for row in rows if f"/{kind}/" in row[2]}


def listed(what: str, folder: Path) -> dict[str, str]:
    code, output = ended(f"arm {what} list -t", folder)
    assert code == 0
    names = [line for line in output.splitlines() if line.startswith("/")]
    lines = (line.replace("[", "").rstrip("]").split(" ") for line in names)
    return {line[0]: line[1] for line in lines}


@pytest.mark.ros
def test_the_tables_of_topics_and_services_are_those_of_a_running_arm(folder, background):
    background.start("arm launch", ())
    topics, services = rows_of("msg"), rows_of("srv")
    assert len(topics) > 15
    own = ("controller_manager_msgs/", "simulation_interfaces/")
    # The topics of the introspection and the services of the simulation come some time later.
    missing, offered = topics.items(), dict[str, str]()
    deadline = time.monotonic() + 60.0
    while (missing or offered != services) and time.monotonic() < deadline:
        missing = topics.items() - listed("topic", folder).items()
        found = listed("service", folder).items()
        offered = {
            name: type_ for name, type_ in found if type_.startswith(own) or name in services
        }
    assert not missing
    assert offered == services


def test_the_drawings_are_those_of_their_script():
    docs = Path(__file__).parents[2] / "docs"
    made = runpy.run_path(str(docs / "make_drawings.py"))
    for name in made["DRAWINGS"]:
        assert (docs / "images" / name).read_text() == made["drawing"](name)


def test_each_term_of_the_glossary_stands_once():
    page = Path(__file__).parents[2] / "docs" / "reference" / "glossary.md"
    terms = [line.strip("*") for line in page.read_text().splitlines() if line.startswith("**")]
    assert len(terms) > 40
    assert terms == sorted(set(terms), key=str.lower)


def test_the_readme_stays_short():
    assert len(PAGES[0].read_text().splitlines()) <= 200
