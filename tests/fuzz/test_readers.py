"""Each reader takes 200 broken inputs: a result or a sentence, no other error, no end of all.

Requests to `move_group` are inputs like files; the campaign of 10,000 is `fuzz.py requests`.
"""

import json
import subprocess
import sys
from pathlib import Path

import pytest

FUZZ = Path(__file__).with_name("fuzz.py")
TARGETS = (
    *("urdf", "xacro", "sdf", "mjcf", "meshes", "yaml", "mcap", "arguments"),
    *("srdf", "planning", "requests"),
)
INPUTS = 200
MOST_MB = 1000


@pytest.mark.parametrize("target", TARGETS)
def test_every_input_is_a_result_or_a_sentence(target):
    done = subprocess.run(
        [sys.executable, str(FUZZ), target, "--inputs", str(INPUTS)],
        stdout=subprocess.PIPE,
        check=True,
    )
    result = json.loads(done.stdout)
    assert result["failures"] == []
    assert result["inputs"] == INPUTS
    assert 0 < result["refused"] < INPUTS
    assert result["most_mb"] < MOST_MB
