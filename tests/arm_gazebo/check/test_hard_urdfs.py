"""Small difficult URDFs, one for each rule, with the expected findings in their first comment."""

import re
from pathlib import Path

import pytest

from arm_gazebo.check.description import check_description

FOLDER = Path(__file__).with_name("urdfs")
FILES = sorted(FOLDER.glob("*.urdf"))
EXPECTED = re.compile(r"\A<!--\n(.*?)\n-->\n", re.DOTALL)


def outcome(text: str, name: str) -> list[str]:
    check = check_description(text, name)
    found = [f"{finding.outcome.value:<8}  {finding}" for finding in check.findings]
    return ["usable" if check.is_usable else "not usable", *found]


def test_the_folder_of_urdfs_exists():
    assert len(FILES) > 40


@pytest.mark.parametrize("file", FILES, ids=lambda file: file.stem)
def test_the_findings_of_a_file_match_its_comment(file):
    text = file.read_text()
    written = EXPECTED.match(text)
    assert written is not None
    expected, found = written.group(1).splitlines(), outcome(text, file.name)
    assert len(found) == len(expected), found
    for line, beginning in zip(found, expected, strict=True):
        assert line.startswith(beginning)
