"""No file and no function outgrows what one reads in one go."""

import ast
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
PARTS = sorted(path.name for path in ROOT.iterdir() if any(path.glob("**/*.py")))
FILE_LINES = 600
FUNCTION_LINES = 60


def sources(part: str) -> list[Path]:
    """The Python files of a top-level folder, without those that a build leaves there."""
    files = (ROOT / part).rglob("*.py")
    return [path for path in files if not {"build", ".venv"} & set(path.relative_to(ROOT).parts)]


@pytest.mark.parametrize("part", [part for part in PARTS if not part.startswith((".", "build"))])
def test_files_and_functions_stay_small(part):
    too_long = []
    for path in sources(part):
        text = path.read_text()
        lengths = {"the file": (text.count("\n"), FILE_LINES)}
        for node in ast.walk(ast.parse(text)):
            if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef):
                lines = (node.end_lineno or node.lineno) - node.lineno + 1
                lengths[f"{node.name} in line {node.lineno}"] = (lines, FUNCTION_LINES)
        too_long += [
            f"{path.relative_to(ROOT)}: {what} has {lines} lines, at most {most}"
            for what, (lines, most) in lengths.items()
            if lines > most
        ]
    assert not too_long, "\n".join(too_long)
