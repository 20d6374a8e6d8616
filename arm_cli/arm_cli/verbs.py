"""The verbs of `arm`: the name, one line of help and the implementation of each."""

from arm_cli.verb import PlainVerb, Verb, VerbFamily

TOPIC = VerbFamily(
    "topic",
    "list, show, measure and publish topics",
    (
        Verb("list", "list the topics", "graph.listing:topic_list"),
        Verb(
            "info",
            "show a topic's type, publishers and subscriptions",
            "graph.info:topic_info",
        ),
        Verb("echo", "print the messages of a topic", "topic.echo"),
        Verb("hz", "measure the rate of a topic", "topic.measuring:hz"),
        Verb("bw", "measure the bandwidth of a topic", "topic.measuring:bw"),
        Verb("delay", "measure the delay of a topic from its stamps", "topic.measuring:delay"),
        Verb("pub", "publish a message to a topic", "topic.pub"),
        Verb("type", "print a topic's type", "graph.listing:topic_type"),
        Verb("find", "list the topics of a type", "graph.listing:topic_find"),
    ),
)

NODE = VerbFamily(
    "node",
    "list and show nodes",
    (
        Verb("list", "list the nodes", "graph.nodes:list_nodes"),
        Verb(
            "info",
            "show a node's publishers, subscribers, services and actions",
            "graph.nodes:node_info",
        ),
    ),
)

PARAM = VerbFamily(
    "param",
    "read and set the parameters of nodes",
    (
        Verb(
            "list",
            "list the parameters of a node, or of all nodes",
            "param.access:list_parameters",
        ),
        Verb("get", "print a parameter's value", "param.access:get"),
        Verb("set", "set a parameter", "param.access:set_parameter"),
        Verb("describe", "show a parameter's type and limits", "param.access:describe"),
        Verb("dump", "print all parameters of a node as YAML", "param.files:dump"),
        Verb("load", "set a node's parameters from a YAML file", "param.files:load"),
        Verb("delete", "remove a parameter", "param.access:delete"),
    ),
)

SERVICE = VerbFamily(
    "service",
    "list and call services",
    (
        Verb("list", "list the services", "graph.listing:service_list"),
        Verb("info", "show a service's type, clients and servers", "graph.info:service_info"),
        Verb("type", "print a service's type", "graph.listing:service_type"),
        Verb("find", "list the services of a type", "graph.listing:service_find"),
        Verb("echo", "print a service's requests and responses", "service.echo"),
        Verb("call", "call a service and print its answer", "service.call"),
    ),
)

ACTION = VerbFamily(
    "action",
    "list actions and send goals",
    (
        Verb("list", "list the actions", "graph.listing:action_list"),
        Verb("info", "show an action's clients and servers", "graph.info:action_info"),
        Verb("type", "print an action's type", "graph.listing:action_type"),
        Verb("find", "list the actions of a type", "graph.listing:action_find"),
        Verb("send_goal", "send a goal and wait for its result", "action.send_goal"),
    ),
)

INTERFACE = VerbFamily(
    "interface",
    "show message, service and action types",
    (
        Verb("list", "list the installed types", "interface_verbs:list_types"),
        Verb("show", "print the definition of a type", "interface_verbs:show"),
        Verb("package", "list the types of a package", "interface_verbs:list_package"),
        Verb(
            "packages",
            "list the packages that define types",
            "interface_verbs:list_packages",
        ),
        Verb("proto", "print a type as YAML to fill in", "interface_verbs:print_prototype"),
    ),
)

CONTROL = VerbFamily(
    "control",
    "query and command the controller manager",
    (
        Verb("list_controllers", "list the controllers", "control.listing:list_controllers"),
        Verb(
            "list_controller_types",
            "list the controller types that can be loaded",
            "control.listing:list_controller_types",
        ),
        Verb(
            "list_hardware_components",
            "list the hardware components",
            "control.listing:list_hardware_components",
        ),
        Verb(
            "list_hardware_interfaces",
            "list the command and state interfaces",
            "control.listing:list_hardware_interfaces",
        ),
        Verb("load_controller", "load a controller", "control.changing:load_controller"),
        Verb(
            "unload_controller",
            "unload a controller",
            "control.changing:unload_controller",
        ),
        Verb(
            "cleanup_controller",
            "return a controller to the unconfigured state",
            "control.changing:cleanup_controller",
        ),
        Verb(
            "set_controller_state",
            "configure, activate or deactivate a controller",
            "control.changing:set_controller_state",
        ),
        Verb(
            "set_hardware_component_state",
            "configure, activate or deactivate a hardware component",
            "control.changing:set_hardware_component_state",
        ),
        Verb(
            "switch_controllers",
            "activate and deactivate controllers in one step",
            "control.changing:switch_controllers",
        ),
        Verb(
            "reload_controller_libraries",
            "reload the controllers' code",
            "control.changing:reload_controller_libraries",
        ),
        Verb(
            "view_controller_chains",
            "draw the controllers and their interfaces",
            "control.view_controller_chains",
        ),
    ),
)

SIM = VerbFamily(
    "sim",
    "inspect a running simulation and change it",
    (
        Verb("info", "show a simulation's entities, state and time", "sim.info"),
        Verb("stats", "show pace, cost of a tick, contacts, camera rates", "sim.stats"),
        Verb("spawn", "add an entity to the world", "sim.changing:spawn"),
        Verb("move", "move an entity of the world", "sim.changing:move"),
        Verb("delete", "remove entities from the world", "sim.changing:delete"),
        Verb("pause", "pause the simulation", "sim.changing:pause"),
        Verb("play", "resume the simulation", "sim.changing:play"),
        Verb("step", "advance a paused simulation", "sim.step"),
        Verb("speed", "show or set the real-time factor", "sim.speed"),
        Verb("reset", "return the simulation to its start", "sim.changing:reset"),
        Verb("save", "save the state of the run", "sim.snapshots:save"),
        Verb("restore", "go back to a saved state", "sim.snapshots:restore"),
        Verb("list", "list the saved states", "sim.snapshots:list_snapshots"),
        Verb("remove", "remove a saved state", "sim.snapshots:remove"),
        Verb("record", "record a run, to replay it later", "sim.recordings:record"),
        Verb("replay", "run a recorded run again and compare it", "sim.recordings:replay"),
        Verb("diff", "compare two recorded runs", "sim.recordings:diff"),
    ),
)

LIFECYCLE = VerbFamily(
    "lifecycle",
    "show managed nodes and change their states",
    (
        Verb("nodes", "list the managed nodes", "lifecycle_verbs:list_nodes"),
        Verb("get", "print the state of a node, or of all", "lifecycle_verbs:get_state"),
        Verb("list", "list the transitions of a node", "lifecycle_verbs:list_transitions"),
        Verb("set", "trigger a transition of a node", "lifecycle_verbs:set_state"),
    ),
)

TF = VerbFamily(
    "tf",
    "show coordinate frames",
    (
        Verb("tree", "print the tree of frames", "tf.tree:print_tree"),
        Verb("echo", "print the transform between two frames", "tf.echo"),
        Verb("monitor", "print how late transforms arrive", "tf.monitor"),
        Verb("view_frames", "draw the tree of frames to a file", "tf.tree:view_frames"),
    ),
)

BAG = VerbFamily(
    "bag",
    "record and play topics",
    (
        Verb("record", "record topics to a bag", "bag.record"),
        Verb("info", "show the contents of a bag", "bag.info:info"),
        Verb("play", "publish the messages of a bag", "bag.play"),
        Verb(
            "convert",
            "rewrite bags with other topics, compression or file sizes",
            "bag.convert:convert",
        ),
        Verb("reindex", "rebuild a bag's metadata from its files", "bag.convert:reindex"),
        Verb("list", "list the supported bag formats", "bag.info:list_plugins"),
    ),
)

DATASET = VerbFamily(
    "dataset",
    "record demonstrations for learning, in LeRobot's format",
    (
        Verb("record", "record demonstrations, and write a dataset", "dataset.record"),
        Verb("convert", "write bags as a dataset", "dataset.convert:convert"),
        Verb("check", "check a dataset against its format", "dataset.convert:check"),
    ),
)

PKG = VerbFamily(
    "pkg",
    "list packages and their executables, create new ones",
    (
        Verb("create", "write a new package that runs at once", "pkg_create_verb"),
        Verb("deps", "show what packages need, and install it", "pkg_deps_verb"),
        Verb("list", "list the packages", "pkg_verbs:list_packages"),
        Verb("prefix", "print where a package is installed", "pkg_verbs:show_prefix"),
        Verb(
            "executables",
            "list the executables of a package",
            "pkg_verbs:list_executables",
        ),
        Verb("xml", "print a package's manifest", "pkg_verbs:show_manifest"),
    ),
)

GZ = VerbFamily(
    "gz",
    "Gazebo's commands for this simulation",
    (
        PlainVerb("sim", "show a world", "gz.sim"),
        Verb("topic", "list topics and print their messages", "gz.topic"),
        Verb("service", "list services and their replacements", "gz.model:service"),
        Verb("model", "list models and print their poses", "gz.model:model"),
    ),
)

VERBS = (
    PlainVerb("launch", "start the simulated arm, or any launch file", "launch"),
    PlainVerb("run", "run an executable of a package", "run_verb"),
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
    Verb("sweep", "make the runs of a study on all cores, or on a Ray cluster", "sweep_verb"),
    Verb("stop", "stop all robots at once, or release them", "stop_verb"),
    Verb("view", "show the robots in the browser, and move them", "run_verb:view"),
    Verb("check", "check a robot or world file as the simulation reads it", "check_verb"),
    Verb("doctor", "find out why the arm does not move or is not seen", "doctor.verb"),
    Verb("graph", "draw the nodes and topics, as SVG or Mermaid", "graph.picture"),
    PKG,
    Verb(
        "completion",
        "print the completion script of a shell",
        "word_completion:print_script",
    ),
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
