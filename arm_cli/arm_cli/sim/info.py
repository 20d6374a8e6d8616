"""`arm sim info` and `stats`: what a simulation contains, and how fast it runs."""

import argparse
from typing import Any

from arm_cli.arguments import JSON, verb
from arm_cli.errors import SimulationRefusedError
from arm_cli.output import print_json, say
from arm_cli.sim.simulation import NAMESPACE, STATE_NAMES, SimulationClient, ask_simulation

MEASURED_S = 1.0
SENSOR_TYPES = (
    "sensor_msgs/msg/Image",
    "sensor_msgs/msg/PointCloud2",
    "sensor_msgs/msg/Imu",
    "geometry_msgs/msg/WrenchStamped",
)
CATEGORIES = {0: "object", 1: "robot", 2: "human", 4: "moving", 5: "static"}


@verb(JSON, NAMESPACE)
def info(options: argparse.Namespace) -> None:
    """Print the simulation's state and contents."""
    with ask_simulation(options.namespace, must_run=True) as simulation:
        report = _report(simulation)
    if options.json:
        print_json(report)
        return
    say(f"state: {report['state']}")
    say(f"world: {report['world'] or 'none'}")
    if report["world_description"]:
        say(f"  {report['world_description']}")
    say(f"time: {report['time_s']:.3f} s, real-time factor {report['real_time_factor']:.2f}")
    say(f"steps: {report['about']}")
    say("entities:")
    for entity in report["entities"]:
        x, y, z = entity["position"]
        say(f"  {entity['name']} [{entity['category']}] at {x:.3f} {y:.3f} {z:.3f}")
    say("cameras and sensors:" if report["sensors"] else "cameras and sensors: none")
    for topic, type_ in report["sensors"].items():
        say(f"  {topic} [{type_}]")


def _report(simulation: SimulationClient) -> dict[str, Any]:
    from arm_cli.ros.graph import Graph
    from arm_cli.ros.listeners import ClockListener

    clock = ClockListener(simulation.session)
    state = simulation.ask("GetSimulationState", "get_simulation_state").state.state
    about = simulation.ask("GetSimulatorFeatures", "get_simulator_features").features.custom_info
    found = simulation.ask("GetEntitiesStates", "get_entities_states")
    entities = [
        _entity(simulation, name, where)
        for name, where in zip(found.entities, found.states, strict=True)
    ]
    simulation.session.spin_for(MEASURED_S)
    graph = Graph(simulation.session)
    graph.settle()
    world, description = _world(simulation)
    return {
        "state": STATE_NAMES[state],
        "world": world,
        "world_description": description,
        "time_s": clock.now_s,
        "real_time_factor": clock.simulated_s / clock.wall_s if clock.wall_s else 0.0,
        "about": about,
        "entities": entities,
        "sensors": {
            topic: types[0] for topic, types in graph.topics().items() if types[0] in SENSOR_TYPES
        },
    }


def _world(simulation: SimulationClient) -> tuple[str, str]:
    """Return the world's name and description, which says what the simulation leaves out."""
    try:
        world = simulation.ask("GetCurrentWorld", "get_current_world").world
    except SimulationRefusedError:
        return "", ""
    return str(world.name), str(world.description)


def _entity(simulation: SimulationClient, name: str, state: Any) -> dict[str, Any]:
    info = simulation.ask("GetEntityInfo", "get_entity_info", entity=name).info
    p, q = state.pose.position, state.pose.orientation
    return {
        "name": name,
        "category": CATEGORIES.get(info.category.category, str(info.category.category)),
        "description": info.description,
        "position": [p.x, p.y, p.z],
        "orientation": [q.x, q.y, q.z, q.w],
    }


@verb(JSON, NAMESPACE)
def stats(options: argparse.Namespace) -> None:
    """Print the figures of the last second or two."""
    with ask_simulation(options.namespace, must_run=True) as simulation:
        parts = simulation.statistics()
    if options.json:
        print_json(parts)
        return
    width = max(len(name) for figures in parts.values() for name in figures)
    for part, figures in parts.items():
        say(f"{part}:")
        for name, value in figures.items():
            say(f"  {name:<{width}}  {value}")
