"""The verbs of `arm`: the name, one line of help and the function of each."""

from arm_cli.verb import PlainVerb, Verb, VerbFamily

TOPIC = VerbFamily(
    "topic",
    "list, show, measure and publish topics",
    (
        Verb("list", "list the topics", "graph.entities:topic_list"),
        Verb(
            "info", "show a topic's type, publishers and subscriptions", "graph.entities:topic_info"
        ),
        Verb("echo", "print the messages of a topic", "topic.echo"),
        Verb("hz", "measure the rate of a topic", "topic.measuring"),
        Verb("bw", "measure the bandwidth of a topic", "topic.measuring"),
        Verb("delay", "measure the delay of a topic from its stamps", "topic.measuring"),
        Verb("pub", "publish a message to a topic", "topic.pub"),
        Verb("type", "print a topic's type", "graph.entities:topic_type"),
        Verb("find", "list the topics of a type", "graph.entities:topic_find"),
    ),
)

NODE = VerbFamily(
    "node",
    "list and show nodes",
    (
        Verb("list", "list the nodes", "graph.entities:node_list"),
        Verb(
            "info",
            "show a node's publishers, subscribers, services and actions",
            "graph.entities:node_info",
        ),
    ),
)

PARAM = VerbFamily(
    "param",
    "read and set the parameters of nodes",
    (
        Verb("list", "list the parameters of a node, or of all nodes", "param:list_parameters"),
        Verb("get", "print a parameter's value", "param"),
        Verb("set", "set a parameter", "param:set_parameter"),
        Verb("describe", "show a parameter's type and limits", "param"),
        Verb("dump", "print all parameters of a node as YAML", "param"),
        Verb("load", "set a node's parameters from a YAML file", "param"),
        Verb("delete", "remove a parameter", "param"),
    ),
)

SERVICE = VerbFamily(
    "service",
    "list and call services",
    (
        Verb("list", "list the services", "graph.entities:service_list"),
        Verb("info", "show a service's type, clients and servers", "graph.entities:service_info"),
        Verb("type", "print a service's type", "graph.entities:service_type"),
        Verb("find", "list the services of a type", "graph.entities:service_find"),
        Verb("echo", "print a service's requests and responses", "service"),
        Verb("call", "call a service and print its answer", "service"),
    ),
)

ACTION = VerbFamily(
    "action",
    "list actions and send goals",
    (
        Verb("list", "list the actions", "graph.entities:action_list"),
        Verb("info", "show an action's clients and servers", "graph.entities:action_info"),
        Verb("type", "print an action's type", "graph.entities:action_type"),
        Verb("find", "list the actions of a type", "graph.entities:action_find"),
        Verb("send_goal", "send a goal and wait for its result", "action.send_goal"),
    ),
)

INTERFACE = VerbFamily(
    "interface",
    "show message, service and action types",
    (
        Verb("list", "list the installed types", "interface:list_types"),
        Verb("show", "print the definition of a type", "interface"),
        Verb("package", "list the types of a package", "interface"),
        Verb("packages", "list the packages that define types", "interface"),
        Verb("proto", "print a type as YAML to fill in", "interface"),
    ),
)

CONTROL = VerbFamily(
    "control",
    "query and command the controller manager",
    (
        Verb("list_controllers", "list the controllers", "control.listing"),
        Verb(
            "list_controller_types",
            "list the controller types that can be loaded",
            "control.listing",
        ),
        Verb("list_hardware_components", "list the hardware components", "control.listing"),
        Verb(
            "list_hardware_interfaces", "list the command and state interfaces", "control.listing"
        ),
        Verb("load_controller", "load a controller", "control.changing"),
        Verb("unload_controller", "unload a controller", "control.changing"),
        Verb(
            "cleanup_controller",
            "return a controller to the unconfigured state",
            "control.changing",
        ),
        Verb(
            "set_controller_state",
            "configure, activate or deactivate a controller",
            "control.changing",
        ),
        Verb(
            "set_hardware_component_state",
            "configure, activate or deactivate a hardware component",
            "control.changing",
        ),
        Verb(
            "switch_controllers",
            "activate and deactivate controllers in one step",
            "control.changing",
        ),
        Verb("reload_controller_libraries", "reload the controllers' code", "control.changing"),
        Verb(
            "view_controller_chains", "draw the controllers and their interfaces", "control.listing"
        ),
    ),
)

SIM = VerbFamily(
    "sim",
    "inspect a running simulation and change it",
    (
        Verb("info", "show a simulation's entities, state and time", "sim.info"),
        Verb("stats", "show pace, cost of a tick, contacts, camera rates", "sim.info"),
        Verb("spawn", "add an entity to the world", "sim.changing"),
        Verb("move", "move an entity of the world", "sim.changing"),
        Verb("delete", "remove entities from the world", "sim.changing"),
        Verb("pause", "pause the simulation", "sim.changing"),
        Verb("play", "resume the simulation", "sim.changing"),
        Verb("step", "advance a paused simulation", "sim.changing"),
        Verb("speed", "show or set the real-time factor", "sim.changing"),
        Verb("reset", "return the simulation to its start", "sim.changing"),
        Verb("save", "save the state of the run", "sim.snapshots"),
        Verb("restore", "go back to a saved state", "sim.snapshots"),
        Verb("list", "list the saved states", "sim.snapshots:list_snapshots"),
        Verb("remove", "remove a saved state", "sim.snapshots"),
        Verb("record", "record a run, to replay it later", "sim.recordings"),
        Verb("replay", "run a recorded run again and compare it", "sim.recordings"),
        Verb("diff", "compare two recorded runs", "sim.recordings"),
    ),
)

LIFECYCLE = VerbFamily(
    "lifecycle",
    "show managed nodes and change their states",
    (
        Verb("nodes", "list the managed nodes", "lifecycle"),
        Verb("get", "print the state of a node, or of all", "lifecycle"),
        Verb("list", "list the transitions of a node", "lifecycle:list_transitions"),
        Verb("set", "trigger a transition of a node", "lifecycle:set_state"),
    ),
)

TF = VerbFamily(
    "tf",
    "show coordinate frames",
    (
        Verb("tree", "print the tree of frames", "tf.showing"),
        Verb("echo", "print the transform between two frames", "tf.showing"),
        Verb("monitor", "print how late transforms arrive", "tf.showing"),
        Verb("view_frames", "draw the tree of frames to a file", "tf.showing"),
    ),
)

BAG = VerbFamily(
    "bag",
    "record and play topics",
    (
        Verb("record", "record topics to a bag", "bag.record"),
        Verb("info", "show the contents of a bag", "bag.info"),
        Verb("play", "publish the messages of a bag", "bag.play"),
        Verb("convert", "rewrite bags with other topics, compression or file sizes", "bag.convert"),
        Verb("reindex", "rebuild a bag's metadata from its files", "bag.convert"),
        Verb("list", "list the supported bag formats", "bag.info:list_plugins"),
    ),
)

DATASET = VerbFamily(
    "dataset",
    "record demonstrations for learning, in LeRobot's format",
    (
        Verb("record", "record demonstrations, and write a dataset", "dataset.writing"),
        Verb("convert", "write bags as a dataset", "dataset.writing"),
        Verb("check", "check a dataset against its format", "dataset.writing"),
    ),
)

PKG = VerbFamily(
    "pkg",
    "list packages and their executables, create new ones",
    (
        Verb("create", "write a new package that runs at once", "pkg.create"),
        Verb("deps", "show what packages need, and install it", "pkg.deps"),
        Verb("list", "list the packages", "pkg.packages:list_packages"),
        Verb("prefix", "print where a package is installed", "pkg.packages"),
        Verb("executables", "list the executables of a package", "pkg.packages"),
        Verb("xml", "print a package's manifest", "pkg.packages"),
    ),
)

GZ = VerbFamily(
    "gz",
    "Gazebo's commands for this simulation",
    (
        PlainVerb("sim", "show a world", "gz"),
        Verb("topic", "list topics and print their messages", "gz"),
        Verb("service", "list services and their replacements", "gz"),
        Verb("model", "list models and print their poses", "gz"),
    ),
)

PLANNING = VerbFamily(
    "planning",
    "prepare a robot for motion planning",
    (Verb("srdf", "make an SRDF for a robot: groups, states, allowed collisions", "planning"),),
)

VERBS = (
    PlainVerb("launch", "start the simulated arm, or any launch file", "launch"),
    PlainVerb("run", "run an executable of a package", "run"),
    Verb("move", "plan a motion of the running robot, and execute it", "move"),
    TOPIC,
    NODE,
    PARAM,
    SERVICE,
    ACTION,
    INTERFACE,
    CONTROL,
    SIM,
    GZ,
    LIFECYCLE,
    TF,
    BAG,
    DATASET,
    Verb("sweep", "make the runs of a study on all cores, or on a Ray cluster", "sweep"),
    PLANNING,
    Verb("teleop", "move the running robot with keys or a gamepad", "teleop.verb"),
    Verb("stop", "stop all robots at once, or release them", "stop"),
    Verb("view", "show the robots in the browser, and move them", "run"),
    Verb("check", "check a robot or world file as the simulation reads it", "check"),
    Verb("calibrate", "find the middle and the ends of a real arm's joints", "calibrate"),
    Verb("doctor", "find out why the arm does not move or is not seen", "doctor.verb"),
    Verb("graph", "draw the nodes and topics, as SVG or Mermaid", "graph.picture"),
    PKG,
    Verb("completion", "print the completion script of a shell", "word_completion"),
)

MISSING = {
    "component": "the suite has no composable nodes: every node is a process of its own, for "
    "`arm run` and `arm launch`",
    "daemon": "there is no daemon to start or stop: every command discovers the graph by itself",
    "multicast": "not needed: `arm doctor` says whether processes find each other, and how",
    "security": "not available: the wheels' Fast DDS has no security plugins. "
    "ROS_AUTOMATIC_DISCOVERY_RANGE=LOCALHOST limits processes to this host",
    "wtf": "use `arm doctor`",
}
"""Verbs of ros2 that do not exist here, and why."""

ARM = VerbFamily("arm", "simulated robot arms on ROS 2, from pip", VERBS, MISSING)
