"""A later entry of a node's parameters wins; rcl itself is the judge."""

import pytest

from launch_py import GroupAction
from launch_py.errors import NodeParameterError
from launch_py.plan.steps import GeneratedFile
from launch_py.ros import Node, ParameterFile, SetParameter

pytestmark = pytest.mark.ros


def section(name, **values):
    lines = "".join(f"    {key}: {value}\n" for key, value in values.items())
    return f'"{name}":\n  ros__parameters:\n{lines}'


def every(**values):
    return section("/**", **values)


@pytest.fixture
def seen(expand, tmp_path, read_by_nodes, ros_arguments):
    """What the node /ns/n sees of these parameters; a text is the content of a file."""

    def see(*sources, before=(), **options):
        parameters = []
        for number, source in enumerate(sources):
            if isinstance(source, str):
                (tmp_path / f"{number}.yaml").write_text(source)
                source = tmp_path / f"{number}.yaml"
            parameters.append(source)
        node = Node(executable="/bin/true", parameters=parameters, **options)
        plan = expand([GroupAction([*before, node])])
        [values] = read_by_nodes([ros_arguments(plan, tmp_path / "made")], "n", "/ns")
        return values

    return see


NAMED = {"name": "n", "namespace": "ns"}


@pytest.mark.parametrize("options", [NAMED, {}], ids=["named", "unnamed"])
@pytest.mark.parametrize(
    "pattern", ["/ns/n", "ns/n", "/**", "/**/n", "/*/n", "/ns/**", "/ns/*", "/*/*"]
)
def test_a_dict_after_a_file_wins_and_a_file_after_a_dict(seen, pattern, options):
    file = section(pattern, b=5)
    assert seen({"b": 100}, file, {"b": 200}, **options) == {"b": 200}
    assert seen({"b": 100}, file, **options) == {"b": 5}
    assert seen(file, {"b": 200}, **options) == {"b": 200}


@pytest.mark.parametrize(
    ("sources", "expected"),
    [
        ([every(b=1), every(b=2.5)], {"b": 2.5}),
        ([every(b="auto"), every(b=3)], {"b": 3}),
        ([every(b=True), every(b=[1, 2])], {"b": [1, 2]}),
        ([section("/ns/n", b=1), every(b=2)], {"b": 2}),
        ([every(b=1) + section("/ns/n", b=2), every(b=3)], {"b": 3}),
        ([section("/*/n", b=1), section("/ns/*", b=2), section("/*/n", b=3)], {"b": 3}),
        ([section("n", b=1), every(b=2), section("/ns/n", a=3)], {"a": 3, "b": 2}),
        ([section("/ns/n", a=1), every(a=2, b=2), section("/ns/n", b=3)], {"a": 2, "b": 3}),
        ([every(c="{d: 1, e: 2}"), every(**{"c.d": 2.5})], {"c.d": 2.5, "c.e": 2}),
        ([every(b="'08'"), every(b="'1e3'", c="'y'")], {"b": "1e3", "c": "y"}),
        ([every(b=1), every(b="!!str 5")], {"b": "5"}),
        ([every(b=1), every(b="08", c="[1e3, 2e3]")], {"b": 8.0, "c": [1e3, 2e3]}),
        ([every(b=1), every(b="|\n      a: 'b'")], {"b": "a: 'b'\n"}),
        (["/**: {n: {ros__parameters: {b: 1}}}", section("ns/n", b=2.0)], {"b": 2.0}),
        (["ns: {n: {ros__parameters: {b: 1}}}", {"b": 2.0}], {"b": 2.0}),
        ([f"{every(b=1)}---\n{every(c=1)}", {"b": 2}], {"b": 2, "c": 1}),
        ([every(b=1, c=1), every(b="|-\n      5.5", c=2)], {"b": 5.5, "c": 2}),
        ([section("/other", b=1), {"b": 2}], {"b": 2}),
        (["", every(b=1), {"b": 2}], {"b": 2}),
    ],
)
def test_a_later_file_wins_whatever_its_type_and_its_sections(seen, sources, expected):
    assert seen(*sources, **NAMED) == expected


def test_parameters_of_a_scope_come_before_the_node_s_own(seen):
    before = [SetParameter("b", 1), SetParameter("c", 1)]
    assert seen(section("n", b=2), before=before, **NAMED) == {"b": 1, "c": 1}
    assert seen(section("ns/n", b=2.5), before=before, **NAMED) == {"b": 2.5, "c": 1}


def test_other_nodes_of_the_process_keep_theirs(expand, tmp_path, read_by_nodes, ros_arguments):
    (tmp_path / "a.yaml").write_text(section("/m", b=1) + section("/n", b=2) + every(c=3))
    last = {"n": {"ros__parameters": {"b": 2.5}}}
    plan = expand([Node(executable="/bin/true", parameters=[tmp_path / "a.yaml", last])])
    arguments = ros_arguments(plan, tmp_path / "made")
    assert read_by_nodes([arguments], "m") == [{"b": 1, "c": 3}]
    assert read_by_nodes([arguments], "n") == [{"b": 2.5, "c": 3}]
    assert read_by_nodes([arguments], "k") == [{"c": 3}]


def test_files_that_do_not_contradict_each_other_are_passed_as_they_are(expand, tmp_path):
    path = tmp_path / "a.yaml"
    path.write_text(every(b=1, c=2))
    plan = expand([Node(executable="/bin/true", parameters=[path, {"d": 1}, {"c": 2}])])
    words = plan.processes[0].command
    assert [str(path) == word or isinstance(word, GeneratedFile) for word in words[3::2]] == [
        True
    ] * 3
    plan = expand([Node(executable="/bin/true", parameters=[path, {"b": 2}])])
    [merged] = [word for word in plan.processes[0].command if isinstance(word, GeneratedFile)]
    assert merged.text.startswith(f'# "{path}, the launch file"')


def test_a_file_with_substitutions_is_put_in_order(expand, tmp_path, read_by_nodes, ros_arguments):
    path = tmp_path / "a.yaml"
    path.write_text(every(b="$(var no 1)", c="$(var no '08')"))
    file = ParameterFile(path, allow_substs=True)
    plan = expand([Node(executable="/bin/true", parameters=[file, {"b": 2.5}])])
    arguments = ros_arguments(plan, tmp_path / "made")
    assert read_by_nodes([arguments]) == [{"b": 2.5, "c": 8.0}]


def test_a_file_that_rcl_refuses_is_left_to_rcl(expand, tmp_path):
    path = tmp_path / "a.yaml"
    path.write_text("b: 5\n")
    plan = expand([Node(executable="/bin/true", parameters=[{"b": 1}, path, {"b": 2}])])
    assert str(path) in plan.processes[0].command


def test_a_file_that_is_not_yaml_is_named(expand, tmp_path):
    path = tmp_path / "a.yaml"
    path.write_text("a: [1\n")
    with pytest.raises(NodeParameterError, match=r"parameter file .*a\.yaml cannot be read"):
        expand([Node(executable="/bin/true", parameters=[path, {"b": 2}])])
