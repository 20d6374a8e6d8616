import numpy as np
import pytest

from arm_sim.sweep.study import Range, Study, StudyError, find_task, read_study

YAML = """
task: task.py:run
sampling: {sampling}
samples: 40
seed: 3
variations:
  mass: {{from: 0.5, to: 1.5}}
  grip: [soft, hard]
  count: {{from: 1, to: 4, whole: true}}
"""


@pytest.fixture
def study_file(tmp_path):
    def write(text: str, name: str = "study.yaml"):
        path = tmp_path / name
        path.write_text(text)
        return path

    return write


def test_a_latin_hypercube_has_one_sample_in_each_part(study_file):
    study = read_study(study_file(YAML.format(sampling="latin_hypercube")))
    runs = study.runs()
    parts = np.floor((np.array([run["mass"] for run in runs]) - 0.5) * 40)
    assert sorted(parts) == list(range(40))
    assert [run["grip"] for run in runs].count("soft") == 20
    assert [run["count"] for run in runs].count(1) == 10
    assert runs == study.runs()


def test_random_samples_lie_in_their_ranges_and_repeat_by_the_seed(study_file):
    study = read_study(study_file(YAML.format(sampling="random")))
    runs = study.runs()
    assert len(runs) == 40
    assert all(0.5 <= run["mass"] <= 1.5 for run in runs)
    assert {run["count"] for run in runs} == {1, 2, 3, 4}
    assert runs == study.runs()
    assert runs != Study(study.task, study.variations, "random", 40, seed=4).runs()


def test_a_grid_has_every_combination():
    study = Study("x.py:f", {"a": (1, 2), "b": Range(0, 2, is_whole=True), "c": ("x",)})
    assert study.runs() == [{"a": a, "b": b, "c": "x"} for a in (1, 2) for b in (0, 1, 2)]


def test_the_task_is_found_beside_the_study(study_file, tmp_path):
    (tmp_path / "task.py").write_text("def run(run):\n    return {}\n")
    study = read_study(study_file(YAML.format(sampling="random")))
    assert study.task == f"{tmp_path / 'task.py'}:run"
    assert find_task(study.task)(None) == {}


def test_a_python_file_may_be_a_study(study_file):
    path = study_file(
        "STUDY = {'task': ':run', 'variations': {'a': [1, 2]}}\ndef run(run): return {}\n", "s.py"
    )
    study = read_study(path)
    assert study.runs() == [{"a": 1}, {"a": 2}]
    assert study.task == f"{path}:run"


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("[1]", "is not a mapping with the keys task"),
        ("tasks: a.py:b", "unknown tasks; the keys are task"),
        ("task: a.py:b", "variations must be a mapping"),
        ("task: a.py\nvariations: {a: [1]}", "task must be FILE.py:FUNCTION, not 'a.py'"),
        ("task: a.py:b\nvariations: {a: 1}", "variation 'a' must be a list"),
        ("task: a.py:b\nvariations: {a: {from: 2, to: 1}}", "variation 'a' must be a list"),
        ("task: a.py:b\nvariations: {a: {from: 0, to: .inf}}", "variation 'a' must be a list"),
        ("task: a.py:b\nvariations: {a: {from: 0, to: 1}}", "a grid needs lists"),
        ("task: a.py:b\nsampling: lots\nvariations: {a: [1]}", "sampling 'lots' is not one of"),
        ("task: a.py:b\nsampling: random\nvariations: {a: [1]}", "0 runs; a study has 1 to"),
        ("task: a.py:b\nsamples: -1\nvariations: {a: [1]}", "samples must be a whole number"),
        ("task: a.py:b\nvariations: {a: {from: 0, to: 1.0e+15, whole: true}}", "a study has 1 to"),
        ("task: a.py:b\ntimeout_s: soon\nvariations: {a: [1]}", "timeout_s must be a positive"),
        ("task: a.py:b\ntimeout_s: -1\nvariations: {a: [1]}", "timeout_s must be a positive"),
        ("a: [", "study.yaml"),
    ],
)
def test_a_study_that_cannot_be_used_is_a_sentence(study_file, text, message):
    with pytest.raises(StudyError) as caught:
        read_study(study_file(text))
    assert message in str(caught.value)
    assert "\n" not in str(caught.value)


def test_missing_files_and_functions_are_a_sentence(tmp_path, study_file):
    with pytest.raises(StudyError, match="does not exist"):
        read_study(tmp_path / "none.yaml")
    path = study_file("x = 1 / 0", "broken.py")
    with pytest.raises(StudyError, match="cannot be imported: ZeroDivisionError"):
        find_task(f"{path}:run")
    path = study_file("", "empty.py")
    with pytest.raises(StudyError, match="has no function 'run'"):
        find_task(f"{path}:run")
    with pytest.raises(StudyError, match="has no mapping named STUDY"):
        read_study(path)
