"""Parameter files whose substitutions are performed."""

import os

import pytest
import yaml

from launch_py import LaunchContext, SetLaunchConfiguration
from launch_py.errors import NodeParameterError, SubstitutionError
from launch_py.plan.steps import GeneratedFile
from launch_py.ros import Node, ParameterFile
from launch_py.ros.substitution_parser import parse_substitutions
from launch_py.substitution import perform_text
from launch_py.substitutions import LaunchConfiguration


@pytest.fixture
def share(package_prefix):
    return package_prefix("demo", "talker")


@pytest.fixture
def context(share, tmp_path):
    words = {"rate": "100", "name": "left", "list": "[a, b]", "odd": "a: 'b' #c", "yes": "yes"}
    environment = {"AMENT_PREFIX_PATH": str(share.parents[1]), "HOME": "/home/me"}
    return LaunchContext(
        launch_configurations=words,
        base_environment=environment,
        launch_file=tmp_path / "x.launch.py",
    )


@pytest.fixture
def performed(context, tmp_path):
    def perform(text: str) -> str:
        path = tmp_path / "params.yaml"
        path.write_text(text)
        file = ParameterFile(path, allow_substs=True).evaluate(context)
        assert isinstance(file, GeneratedFile)
        return file.text

    return perform


# Writing


@pytest.mark.parametrize(
    ("text", "meant"),
    [
        ("plain", "plain"),
        ("", ""),
        ("$(var rate) Hz", "100 Hz"),
        ("$(var no 5)", "5"),
        ("$(var no 'a (b) c')", "a (b) c"),
        ('$(var no "it\'s")', "it's"),
        ("$(var no a\\ b)", "a b"),
        ("$(env HOME)/$(env NO no)", "/home/me/no"),
        ("$(var $(var no name))", "left"),
        ("$(eval '$(var rate) / 4')", "25.0"),
        ("$(if $(var yes) a b)", "a"),
        ("$(and true $(not false))", "true"),
        ("$(any false false true)", "true"),
        ("$(equals $(var rate) 100.0)", "true"),
        ("\\$(var rate)", "$(var rate)"),
        ("C:\\x $5 (y)", "C:\\x $5 (y)"),
    ],
)
def test_the_value_of_a_text(context, text, meant):
    assert perform_text(context, parse_substitutions(text)) == meant


def test_packages_and_launch_files_are_found(context, share, tmp_path):
    text = perform_text(context, parse_substitutions("$(find-pkg-share demo) $(dirname)"))
    assert text == f"{share} {tmp_path}"


@pytest.mark.parametrize(
    ("text", "sentence"),
    [
        ("$(vra x)", r"no substitution \$\(vra\); did you mean 'var'"),
        ("$(1 + 2)", "is malformed at character 3"),
        ("$(var)", r"\$\(var\) takes 1 to 2 words after its name, not 0"),
        ("$(dirname x)", "takes 0 words after its name, not 1"),
        ("$(all)", "takes at least 1 words after its name, not 0"),
        ("x $(var", "is malformed at character 8"),
        ("$(var ", "is malformed"),
        ("$(var a", "is malformed"),
        ("$(var 'a)", "is malformed"),
        ("$(var 'a'b)", "is malformed"),
        ("$(var a\\", "is malformed"),
        ("$(eval (1))", "is malformed at character 8"),
        ("$(var=x)", r"is malformed at character 6"),
    ],
)
def test_malformed_substitutions_are_reported(text, sentence):
    with pytest.raises(SubstitutionError, match=sentence):
        parse_substitutions(text)


# Files


def test_keys_and_values_are_performed(performed):
    text = performed(
        """
        # $(var nothing) in a comment means nothing
        /$(var name)/node:
          ros__parameters:
            rate: $(var rate)
            quoted: "$(var rate)"
            words: $(var rate) Hz
            joints: $(var list)
            each: [$(var name), other]
            odd: $(var odd)
            flag: $(var yes)
        """
    )
    assert yaml.safe_load(text) == {
        "/left/node": {
            "ros__parameters": {
                "rate": 100,
                "quoted": 100,
                "words": "100 Hz",
                "joints": ["a", "b"],
                "each": ["left", "other"],
                "odd": "a: 'b' #c",
                "flag": True,
            }
        }
    }


def test_values_without_substitutions_stay_unchanged(performed):
    lines = ["/**:", "  ros__parameters:", "    a: 1e-3", "    b: '1'", '    c: "yes"', "    d: ü"]
    lines += ["    e: [1.0, 2.50]", f"    f: {'x ' * 100}x"]
    assert performed("\n".join(lines)).splitlines() == lines


def test_an_empty_file_stays_empty(performed):
    assert performed("# nothing\n") == ""


@pytest.mark.parametrize(
    ("text", "sentence"),
    [
        ("a: [1", "params.yaml cannot be read: "),
        ("a: $(var nothing)", "params.yaml: no launch argument 'nothing'"),
        ("a: $(var", "params.yaml: .* is malformed at character"),
        ("a: $(find-pkg-share nobody)", "params.yaml: .*nobody"),
        ("a: $(var no '[1')", r"params.yaml: '\[1' is not YAML"),
    ],
)
def test_an_unusable_file_is_reported(performed, text, sentence):
    with pytest.raises(NodeParameterError, match=sentence) as error:
        performed(text)
    assert "\n" not in str(error.value)


# Nodes


def words(plan):
    return plan.processes[0].command


@pytest.mark.parametrize("allow", [True, "true", LaunchConfiguration("allow")])
def test_a_node_gets_the_generated_file(expand, share, tmp_path, allow):
    path = tmp_path / "params.yaml"
    path.write_text("/**: {ros__parameters: {rate: $(var rate)}}")
    file = ParameterFile([LaunchConfiguration("folder"), "/params.yaml"], allow_substs=allow)
    plan = expand(
        [
            SetLaunchConfiguration("folder", str(tmp_path)),
            SetLaunchConfiguration("rate", "7"),
            SetLaunchConfiguration("allow", "True"),
            Node(package="demo", executable="talker", parameters=[file]),
        ]
    )
    option, generated = words(plan)[-2:]
    assert option == "--params-file"
    assert yaml.safe_load(generated.text) == {"/**": {"ros__parameters": {"rate": 7}}}


def test_without_substitutions_a_node_gets_the_file_itself(expand, share, tmp_path):
    path = tmp_path / "params.yaml"
    path.write_text("no: $(substitution")
    node = Node(package="demo", executable="talker", parameters=[ParameterFile(path)])
    assert words(expand([node]))[-2:] == ("--params-file", str(path))


def test_a_missing_file_is_reported_with_the_node_and_similar_files(expand, share, tmp_path):
    (tmp_path / "params.yaml").touch()
    file = ParameterFile(tmp_path / "parms.yaml", allow_substs=True)
    with pytest.raises(NodeParameterError, match=r"talker: no parameter file .*mean 'params.yaml'"):
        expand([Node(package="demo", executable="talker", parameters=[file])])


def test_a_fifo_is_not_a_parameter_file(expand, share, tmp_path):
    os.mkfifo(tmp_path / "params.yaml")
    node = Node(package="demo", executable="talker", parameters=[tmp_path / "params.yaml"])
    with pytest.raises(NodeParameterError, match=r"params\.yaml is not a regular file"):
        expand([node])


def test_a_mistake_in_allow_substs_is_reported(expand, share, tmp_path):
    path = tmp_path / "params.yaml"
    path.touch()
    file = ParameterFile(path, allow_substs="perhaps")
    with pytest.raises(NodeParameterError, match="talker: 'perhaps' is neither true nor false"):
        expand([Node(package="demo", executable="talker", parameters=[file])])


def test_aliases_of_aliases_are_followed_once(performed):
    lines = ["a0: &a0 [$(var rate)]"]
    lines += [f"a{n}: &a{n} [{', '.join([f'*a{n - 1}'] * 10)}]" for n in range(1, 4)]
    said = performed("\n".join(lines))
    assert said.splitlines()[0] == "a0: &id001 [100]"
    assert said.count("100") == 1


def test_a_file_that_is_nested_too_deep_is_reported(performed):
    with pytest.raises(NodeParameterError, match="is nested more than 64 deep"):
        performed("[" * 65)
