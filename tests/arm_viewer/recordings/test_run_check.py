"""Runs are told apart from bags, and verified by a process, with a script in its place."""

import json
import sys
import threading
import time

import pytest
from mcap.writer import Writer

from arm_viewer.errors import PageRecordingError
from arm_viewer.recordings.run_check import RunCheck, is_run

TIMEOUT_S = 60.0
LENGTHS = {"of_periods": 100, "period_s": 0.01}
EQUAL = {"periods": 100, "difference": None, "is_cut_off": False, "end_reason": "", **LENGTHS}
DIFFERENT = {
    **EQUAL,
    "periods": 20,
    "difference": {"period": 20, "time_s": 0.21, "lines": ["position of joint j0: 1 instead of 2"]},
}
SCRIPT = """
import pathlib, sys
bag = pathlib.Path(sys.argv[sys.argv.index("--bag") + 1])
bag.mkdir()
for number in range(2):
    (bag / f"a_{number}.mcap").touch()
print(sys.argv[1])
"""


@pytest.fixture
def run_file(tmp_path):
    path = tmp_path / "a.run"
    with path.open("wb") as stream:
        writer = Writer(stream)
        writer.start("arm-run", "arm-suite")
        writer.finish()
    return path


@pytest.fixture
def checked(run_file):
    """Return a function that lets a script verify a run; it returns the check and its parts."""
    checks = []

    def check(script, *words):
        over = threading.Event()
        parts = []

        def take(check):
            parts.append(check.part)
            if not check.part.grows:
                over.set()

        command = (sys.executable, "-c", script, *words)
        checks.append(RunCheck(run_file, take, command))
        assert over.wait(TIMEOUT_S)
        wait_for(lambda: checks[-1].verdict.is_over)
        return checks[-1], parts

    yield check
    for check in checks:
        check.close()


def wait_for(condition):
    deadline_s = time.monotonic() + TIMEOUT_S
    while not condition():
        assert time.monotonic() < deadline_s
        time.sleep(0.01)


def lines(*told):
    return "\n".join(map(json.dumps, told))


def test_a_run_is_known_by_its_content(run_file, tmp_path, write_mcap):
    assert is_run(run_file)
    assert not is_run(write_mcap([("/a", 0, b"12345678")], name="b.run"))
    (tmp_path / "short.run").write_bytes(b"\x89MCAP0")
    assert not any(map(is_run, (tmp_path / "short.run", tmp_path, tmp_path / "gone")))


def test_a_run_without_a_period_is_not_called_verified(checked):
    check, _ = checked(SCRIPT, lines({"result": {**EQUAL, "periods": 0}}))
    assert check.verdict.text == "holds no control period, so nothing was compared"
    assert not check.verdict.is_equal


def test_a_process_may_end_before_all_threads_that_read_it_have_started(checked, monkeypatch):
    started = []

    def start(thread, usual=threading.Thread.start):
        usual(thread)
        started.append(thread)
        if len(started) == 1:
            thread.join(TIMEOUT_S)

    monkeypatch.setattr(threading.Thread, "start", start)
    check, _ = checked(SCRIPT, lines({"result": EQUAL}))
    assert check.verdict.is_equal


def test_equal_periods_are_counted(checked):
    check, (part,) = checked(SCRIPT, lines({"periods": 50, **LENGTHS}, {"result": EQUAL}))
    assert (check.verdict.is_over, check.verdict.is_equal) == (True, True)
    assert check.verdict.text == "verified: all 100 control periods are equal"
    bag = part.files[0].parent
    assert (bag.name, check.verdict.name) == ("a.run", "a.run")
    assert (part.until_s, part.grows) == (1.0, False)
    assert check.close() == "", "nothing was left to compare"
    assert not bag.exists()


def test_what_is_equal_so_far_can_be_shown_file_by_file(checked):
    told = ({"periods": 50, "file": "a_0.mcap", **LENGTHS}, {"result": EQUAL})
    check, (first, last) = checked(SCRIPT, lines(*told))
    assert ([file.name for file in first.files], first.until_s, first.grows) == (
        ["a_0.mcap"],
        0.5,
        True,
    )
    assert sorted(file.name for file in last.files) == ["a_0.mcap", "a_1.mcap"]
    assert (last.until_s, check.verdict.length_s) == (1.0, 1.0)


def test_it_is_over_when_all_of_it_is_shown(run_file):
    seen = []
    told = lines({"periods": 50, "file": "a_0.mcap", **LENGTHS}, {"result": EQUAL})
    command = (sys.executable, "-c", SCRIPT, told)
    check = RunCheck(run_file, lambda c: seen.append((c.part.grows, c.verdict.is_over)), command)
    wait_for(lambda: check.verdict.is_over)
    check.close()
    assert seen == [(True, False), (False, False)]


def test_a_difference_is_told_with_its_time(checked):
    check, (part,) = checked(SCRIPT, lines({"result": DIFFERENT}))
    assert not check.verdict.is_equal
    assert check.verdict.text.startswith("differs at 0.21 s, in control period 20: position of j")
    assert check.verdict.differences == ("position of joint j0: 1 instead of 2",)
    assert "0 to 0.20 of 1.00 s is equal" in check.verdict.details[-1]
    assert (part.until_s, check.verdict.differs_s) == (0.2, pytest.approx(0.21))


def test_progress_is_told_until_then(run_file):
    script = "import sys, time; print(sys.argv[1], flush=True); time.sleep(600)"
    command = (sys.executable, "-c", script, lines({"periods": 50, **LENGTHS}))
    check = RunCheck(run_file, lambda *_: None, command)
    try:
        wait_for(lambda: "equal so far: 0.50 of 1.00 s" in check.verdict.text)
        assert not check.verdict.is_equal, "the rest may differ"
    finally:
        said = check.close()
    assert "stopped; 0 to 0.50 of 1.00 s is equal, the rest was not compared" in said
    for thread in threading.enumerate():
        if thread.name == "run check":
            thread.join(TIMEOUT_S)
    assert not check.verdict.is_over, "nobody wants to know how a check ended that was closed"


@pytest.mark.parametrize(
    ("script", "said"),
    [
        ("import sys; sys.exit('another version of MuJoCo')", "another version of MuJoCo"),
        ("print('no JSON')", "no JSON"),
        ("print('{\"result\": {}}')", "{}"),
        ("", "ended without a word"),
    ],
)
def test_what_cannot_run_again_says_why(checked, script, said):
    check, (part,) = checked(script)
    assert part.files == ()
    assert check.verdict.text.startswith("cannot be run again: ")
    assert said in check.verdict.text


def test_a_run_that_is_damaged_further_on_is_equal_up_to_there(checked):
    script = f"{SCRIPT}sys.exit('a.run is damaged')"
    check, (part,) = checked(script, lines({"periods": 50, **LENGTHS}))
    assert check.verdict.text == (
        "0 to 0.50 of 1.00 s is equal, then it cannot be run again: a.run is damaged"
    )
    assert (check.verdict.is_equal, part.until_s, len(part.files)) == (False, 0.5, 2)


def test_a_program_that_cannot_be_started_is_named(run_file):
    with pytest.raises(PageRecordingError, match="cannot start /no/such"):
        RunCheck(run_file, lambda *_: None, ("/no/such",))
