"""The fenced blocks of the README and of the manual, as a reader sees them.

A comment before a block says how it runs:

    <!-- test: background -->      keep it running for the commands that follow
    <!-- test: print -->           a launch that only shows what it would start
    <!-- test: exit 1 -->          another exit code than 0; `exit any` for whichever
    <!-- test: exact -->           numbers in the output count, too
    <!-- test: typed WORDS -->     on a terminal, where somebody types these words
    <!-- test: not run, REASON --> it cannot run in a test
"""

import re
from dataclasses import dataclass
from functools import cache
from pathlib import Path

from markdown_it import MarkdownIt

ROOT = Path(__file__).parents[2]
PAGES = (ROOT / "README.md", *sorted((ROOT / "docs").rglob("*.md")))
DIRECTIVE = re.compile(r"<!-- test: (.+) -->")
TITLE = re.compile(r'(\w+)(?: title="([^"]+)")?')


@dataclass(frozen=True)
class Block:
    """One fenced block.

    Attributes:
        page: path of its page below the repository.
        line: where it begins there.
        language: the first word after the fence.
        title: name of the file that it is, or empty.
        directive: how it runs, or empty.
        text: what is in it.
    """

    page: str
    line: int
    language: str
    title: str
    directive: str
    text: str

    @property
    def place(self) -> str:
        """Where it stands, for messages."""
        return f"{self.page}:{self.line}"


@dataclass(frozen=True)
class Command:
    """A command of a console block, and the lines that the page shows below it."""

    line: str
    output: tuple[str, ...]


@cache
def blocks_of(page: Path) -> tuple[Block, ...]:
    """Return the blocks of a page, in their order."""
    found: list[Block] = []
    directive = ""
    name = str(page.relative_to(ROOT))
    for token in MarkdownIt("commonmark").enable("table").parse(page.read_text()):
        if token.type == "html_block":
            comment = DIRECTIVE.match(token.content)
            directive = comment[1] if comment else ""
        if token.type not in ("fence", "code_block"):
            continue
        assert token.map is not None
        words = TITLE.fullmatch(token.info.strip())
        assert words, f"{name}:{token.map[0] + 1}: a block needs a fence with a language"
        found.append(
            Block(name, token.map[0] + 1, words[1], words[2] or "", directive, token.content)
        )
        directive = ""
    return tuple(found)


def commands_of(block: Block) -> list[Command]:
    """Return the commands of a console block with their output."""
    commands: list[Command] = []
    for line in block.text.splitlines():
        if line.startswith("$ "):
            commands.append(Command(line[2:], ()))
        else:
            assert commands, f"{block.place}: the first line has no command"
            commands[-1] = Command(commands[-1].line, (*commands[-1].output, line))
    return commands
