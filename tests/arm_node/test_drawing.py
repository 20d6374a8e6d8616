"""Graphs: which node talks to which, layout, SVG."""

from itertools import pairwise
from xml.etree import ElementTree

from hypothesis import given
from hypothesis import strategies as st

from arm_node.drawing import Digraph, Edge, NodeTopics, Shape, Vertex, node_graph, place, to_svg

SVG = "{http://www.w3.org/2000/svg}"
TALK = (
    NodeTopics("/talker", ("/chatter", "/rosout", "/_hidden"), ("/parameter_events",)),
    NodeTopics("/listener", (), ("/chatter",)),
    NodeTopics("/_daemon", ("/chatter",), ()),
)


def graph_of(*pairs, label=""):
    keys = dict.fromkeys(key for pair in pairs for key in pair)
    vertices = tuple(Vertex(key, f"/{key}") for key in keys)
    return Digraph(vertices, tuple(Edge(a, b, label) for a, b in pairs))


def test_every_arrow_goes_to_a_later_layer():
    assert place(graph_of("ab", "bc")).layers == (("a",), ("b",), ("c",))


def test_a_long_arrow_bends_in_the_layers_between():
    layout = place(graph_of("ab", "bc", "ac"))
    assert layout.routes[2] == ("a", "bend 2 1", "c")
    assert "bend 2 1" in layout.layers[1]


def test_a_cycle_is_drawn_with_one_arrow_back():
    layout = place(graph_of("ab", "ba"))
    assert layout.layers == (("a",), ("b",))
    assert layout.routes == (("a", "b"), ("b", "a"))


def test_neighbours_stand_side_by_side():
    layout = place(graph_of("ax", "by", "cz", "bx"))
    assert layout.layers == (("a", "b", "c"), ("x", "y", "z"))
    crossed = place(graph_of("ax", "by", "ay", "bx"))
    assert {len(layer) for layer in crossed.layers} == {2}


@given(st.lists(st.tuples(st.sampled_from("abcdefg"), st.sampled_from("abcdefg")), max_size=20))
def test_any_graph_can_be_placed(pairs):
    graph = graph_of(*pairs)
    layout = place(graph)
    level = {key: index for index, layer in enumerate(layout.layers) for key in layer}
    assert {vertex.key for vertex in graph.vertices} <= level.keys()
    for (source, target), route in zip(pairs, layout.routes, strict=True):
        assert (route[0], route[-1]) == (source, target)
        steps = {level[b] - level[a] for a, b in pairwise(route)}
        assert steps <= {1} or steps <= {-1} or source == target
    ElementTree.fromstring(to_svg(graph))
    ElementTree.fromstring(to_svg(graph, downward=True))


def test_svg_shows_each_vertex_and_each_line_of_its_label():
    graph = Digraph(
        (Vertex("a", "one\n<two>"), Vertex("b", "/b", Shape.BOX)), (Edge("a", "b", "why"),)
    )
    root = ElementTree.fromstring(to_svg(graph))
    assert [text.text for text in root.iter(f"{SVG}text")] == ["why", "one", "<two>", "/b"]
    assert len(list(root.iter(f"{SVG}path"))) == 2


def places(graph, downward):
    root = ElementTree.fromstring(to_svg(graph, downward))
    return {t.text: (float(t.attrib["x"]), float(t.attrib["y"])) for t in root.iter(f"{SVG}text")}


def test_arrows_go_to_the_right_or_down():
    rightward = places(graph_of("ab"), downward=False)
    assert rightward["/a"][0] < rightward["/b"][0]
    assert rightward["/a"][1] == rightward["/b"][1]
    downward = places(graph_of("ab"), downward=True)
    assert downward["/a"][1] < downward["/b"][1]
    assert downward["/a"][0] == downward["/b"][0]


def test_siblings_leave_room_for_the_labels_of_their_arrows():
    label = "x" * 50
    tree = places(graph_of("ab", "ac", label=label), downward=True)
    assert abs(tree["/b"][0] - tree["/c"][0]) > 50 * 7


def test_messages_go_from_node_to_topic_to_node():
    graph = node_graph(TALK)
    shapes = {vertex.label: vertex.shape for vertex in graph.vertices}
    assert shapes == {"/talker": Shape.ELLIPSE, "/listener": Shape.ELLIPSE, "/chatter": Shape.BOX}
    assert graph.edges == (
        Edge("node /talker", "topic /chatter"),
        Edge("topic /chatter", "node /listener"),
    )


def test_the_complete_graph_has_what_is_hidden_and_what_every_node_has():
    labels = {vertex.label for vertex in node_graph(TALK, complete=True).vertices}
    assert labels >= {"/_daemon", "/_hidden", "/rosout", "/parameter_events"}
