"""The manual's page of MoveIt's surface, against what a launched move_group offers."""

from pathlib import Path
from typing import Any

import pytest
from moveit_msgs.srv import QueryPlannerInterfaces
from rclpy.action import get_action_server_names_and_types_by_node

PAGE = Path(__file__).parents[4] / "docs" / "reference" / "moveit.md"
EVERY_NODE_HAS = ("rcl_interfaces/", "type_description_interfaces/")
TOPICS_OF_EVERY_NODE = ("/rosout", "/parameter_events", "/clock")
NODE = "move_group"
HIDDEN = "/_action/"


def rows_of(title: str) -> dict[str, str]:
    """Return a table of the page without what it calls not here: name to type."""
    section = PAGE.read_text().split(f"\n## {title}\n")[1].split("\n## ")[0]
    rows = [line.split("|") for line in section.splitlines() if line.startswith("| `")]
    return {
        "/" + row[1].strip(" `").lstrip("/"): row[2].strip()
        for row in rows
        if not row[3].strip().startswith("not here")
    }


def offered(client: Any, what: str) -> dict[str, str]:
    """Return names and types of what both of move_group's nodes have."""
    query = getattr(client.node, f"get_{what}_names_and_types_by_node")
    nodes = [name for name in client.node.get_node_names() if name.startswith(NODE)]
    return {
        name: types[0]
        for node in nodes
        for name, types in query(node, "/")
        if not types[0].startswith(EVERY_NODE_HAS)
        and name not in TOPICS_OF_EVERY_NODE
        and HIDDEN not in name
    }


def actions_of(client: Any) -> dict[str, str]:
    found = get_action_server_names_and_types_by_node(client.node, NODE, "/")
    return {name: types[0] for name, types in found}


@pytest.mark.parametrize(
    ("title", "what"),
    [
        ("Services", "service"),
        ("Topics it listens to", "subscriber"),
        ("Topics it publishes", "publisher"),
    ],
)
def test_the_page_lists_what_move_group_offers(planning, title, what):
    client, page = planning.client, rows_of(title)
    client.wait_until(lambda: page.items() <= offered(client, what).items(), f"all of {page}")
    assert offered(client, what) == page


def test_the_page_lists_the_actions(planning):
    client, page = planning.client, rows_of("Actions")
    client.wait_until(lambda: page.items() <= actions_of(client).items(), f"all of {page}")
    assert actions_of(client) == page


def test_the_page_names_the_planners_that_need_nothing(planning):
    answer = planning.call("/query_planner_interface", QueryPlannerInterfaces.Request())
    section = PAGE.read_text().split("\n## Planners\n")[1].split("\n## ")[0]
    for interface in answer.planner_interfaces:
        assert f"| `{interface.pipeline_id}` |" in section
    pilz = next(each for each in answer.planner_interfaces if "pilz" in each.pipeline_id)
    assert all(f"`{name}`" in section for name in ("PTP", "LIN", "CIRC"))
    assert {"PTP", "LIN", "CIRC"} <= set(pilz.planner_ids)
