"""What a shell gets on Tab."""

import os
import subprocess
import sys

import pytest

from arm_cli.main import main


def offered(line: str, tmp_path) -> list[str]:
    answer = tmp_path / "words"
    subprocess.run(
        [sys.executable, "-m", "arm_cli"],
        env={
            **os.environ,
            "_ARGCOMPLETE": "1",
            "_ARGCOMPLETE_IFS": "\n",
            "_ARGCOMPLETE_STDOUT_FILENAME": str(answer),
            "COMP_LINE": line,
            "COMP_POINT": str(len(line)),
            "COMP_TYPE": "9",
        },
        timeout=60,
        check=True,
    )
    return [word.strip() for word in answer.read_text().split("\n") if word.strip()]


def test_tab_offers_the_verbs_of_a_family(tmp_path):
    words = offered("arm control ", tmp_path)
    assert {"list_controllers", "switch_controllers", "view_controller_chains"} <= set(words)


def test_tab_completes_options_types_and_executables(tmp_path):
    assert offered("arm topic echo --onc", tmp_path) == ["--once"]
    types = offered("arm interface show std_msgs/msg/Float64", tmp_path)
    assert "std_msgs/msg/Float64MultiArray" in types
    assert "publisher_terminal" in offered("arm run arm_controller ", tmp_path)


@pytest.mark.parametrize(
    ("shell", "part"), [("bash", "complete "), ("zsh", "compdef"), ("fish", "--command arm")]
)
def test_the_script_is_the_shell_s(capsys, shell, part):
    assert main(["completion", shell]) == 0
    assert part in capsys.readouterr().out
