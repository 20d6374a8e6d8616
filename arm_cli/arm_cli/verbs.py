"""The verbs of `arm`: the name, one line of help and the implementation of each."""

from arm_cli.verb import PlainVerb, Verb, VerbFamily

TOPIC = VerbFamily(
    "topic",
    "list, show, measure and publish topics",
    (
        Verb("list", "list the topics", "arm_cli.graph.listing:TOPIC_LIST"),
        Verb(
            "info",
            "show a topic's type, publishers and subscriptions",
            "arm_cli.graph.info:TOPIC_INFO",
        ),
        Verb("echo", "print the messages of a topic", "arm_cli.topic.echo"),
        Verb("hz", "measure the rate of a topic", "arm_cli.topic.measuring:HZ"),
        Verb("bw", "measure the bandwidth of a topic", "arm_cli.topic.measuring:BW"),
        Verb(
            "delay", "measure the delay of a topic from its stamps", "arm_cli.topic.measuring:DELAY"
        ),
        Verb("pub", "publish a message to a topic", "arm_cli.topic.pub"),
        Verb("type", "print a topic's type", "arm_cli.graph.listing:TOPIC_TYPE"),
        Verb("find", "list the topics of a type", "arm_cli.graph.listing:TOPIC_FIND"),
    ),
)

NODE = VerbFamily(
    "node",
    "list and show nodes",
    (
        Verb("list", "list the nodes", "arm_cli.graph.nodes:LIST_NODES"),
        Verb(
            "info",
            "show a node's publishers, subscribers, services and actions",
            "arm_cli.graph.nodes:NODE_INFO",
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
            "arm_cli.param.access:LIST_PARAMETERS",
        ),
        Verb("get", "print a parameter's value", "arm_cli.param.access:GET"),
        Verb("set", "set a parameter", "arm_cli.param.access:SET_PARAMETER"),
        Verb("describe", "show a parameter's type and limits", "arm_cli.param.access:DESCRIBE"),
        Verb("dump", "print all parameters of a node as YAML", "arm_cli.param.files:DUMP"),
        Verb("load", "set a node's parameters from a YAML file", "arm_cli.param.files:LOAD"),
        Verb("delete", "remove a parameter", "arm_cli.param.access:DELETE"),
    ),
)

SERVICE = VerbFamily(
    "service",
    "list and call services",
    (
        Verb("list", "list the services", "arm_cli.graph.listing:SERVICE_LIST"),
        Verb(
            "info", "show a service's type, clients and servers", "arm_cli.graph.info:SERVICE_INFO"
        ),
        Verb("type", "print a service's type", "arm_cli.graph.listing:SERVICE_TYPE"),
        Verb("find", "list the services of a type", "arm_cli.graph.listing:SERVICE_FIND"),
        Verb("echo", "print a service's requests and responses", "arm_cli.service.echo"),
        Verb("call", "call a service and print its answer", "arm_cli.service.call"),
    ),
)

ACTION = VerbFamily(
    "action",
    "list actions and send goals",
    (
        Verb("list", "list the actions", "arm_cli.graph.listing:ACTION_LIST"),
        Verb("info", "show an action's clients and servers", "arm_cli.graph.info:ACTION_INFO"),
        Verb("type", "print an action's type", "arm_cli.graph.listing:ACTION_TYPE"),
        Verb("find", "list the actions of a type", "arm_cli.graph.listing:ACTION_FIND"),
        Verb("send_goal", "send a goal and wait for its result", "arm_cli.action.send_goal"),
    ),
)

INTERFACE = VerbFamily(
    "interface",
    "show message, service and action types",
    (
        Verb("list", "list the installed types", "arm_cli.interface_verbs:LIST_TYPES"),
        Verb("show", "print the definition of a type", "arm_cli.interface_verbs:SHOW"),
        Verb("package", "list the types of a package", "arm_cli.interface_verbs:LIST_PACKAGE"),
        Verb(
            "packages",
            "list the packages that define types",
            "arm_cli.interface_verbs:LIST_PACKAGES",
        ),
        Verb("proto", "print a type as YAML to fill in", "arm_cli.interface_verbs:PRINT_PROTOTYPE"),
    ),
)

CONTROL = VerbFamily(
    "control",
    "query and command the controller manager",
    (
        Verb(
            "list_controllers", "list the controllers", "arm_cli.control.listing:LIST_CONTROLLERS"
        ),
        Verb(
            "list_controller_types",
            "list the controller types that can be loaded",
            "arm_cli.control.listing:LIST_CONTROLLER_TYPES",
        ),
        Verb(
            "list_hardware_components",
            "list the hardware components",
            "arm_cli.control.listing:LIST_HARDWARE_COMPONENTS",
        ),
        Verb(
            "list_hardware_interfaces",
            "list the command and state interfaces",
            "arm_cli.control.listing:LIST_HARDWARE_INTERFACES",
        ),
        Verb("load_controller", "load a controller", "arm_cli.control.changing:LOAD_CONTROLLER"),
        Verb(
            "unload_controller",
            "unload a controller",
            "arm_cli.control.changing:UNLOAD_CONTROLLER",
        ),
        Verb(
            "cleanup_controller",
            "return a controller to the unconfigured state",
            "arm_cli.control.changing:CLEANUP_CONTROLLER",
        ),
        Verb(
            "set_controller_state",
            "configure, activate or deactivate a controller",
            "arm_cli.control.changing:SET_CONTROLLER_STATE",
        ),
        Verb(
            "set_hardware_component_state",
            "configure, activate or deactivate a hardware component",
            "arm_cli.control.changing:SET_HARDWARE_COMPONENT_STATE",
        ),
        Verb(
            "switch_controllers",
            "activate and deactivate controllers in one step",
            "arm_cli.control.changing:SWITCH_CONTROLLERS",
        ),
        Verb(
            "reload_controller_libraries",
            "reload the controllers' code",
            "arm_cli.control.changing:RELOAD_CONTROLLER_LIBRARIES",
        ),
        Verb(
            "view_controller_chains",
            "draw the controllers and their interfaces",
            "arm_cli.control.view_controller_chains",
        ),
    ),
)

SIM = VerbFamily(
    "sim",
    "inspect a running simulation and change it",
    (
        Verb("info", "show a simulation's entities, state and time", "arm_cli.sim.info"),
        Verb("stats", "show pace, cost of a tick, contacts, camera rates", "arm_cli.sim.stats"),
        Verb("spawn", "add an entity to the world", "arm_cli.sim.changing:SPAWN"),
        Verb("move", "move an entity of the world", "arm_cli.sim.changing:MOVE"),
        Verb("delete", "remove entities from the world", "arm_cli.sim.changing:DELETE"),
        Verb("pause", "pause the simulation", "arm_cli.sim.changing:PAUSE"),
        Verb("play", "resume the simulation", "arm_cli.sim.changing:PLAY"),
        Verb("step", "advance a paused simulation", "arm_cli.sim.step"),
        Verb("speed", "show or set the real-time factor", "arm_cli.sim.speed"),
        Verb("reset", "return the simulation to its start", "arm_cli.sim.changing:RESET"),
        Verb("save", "save the state of the run", "arm_cli.sim.snapshots:SAVE"),
        Verb("restore", "go back to a saved state", "arm_cli.sim.snapshots:RESTORE"),
        Verb("list", "list the saved states", "arm_cli.sim.snapshots:LIST"),
        Verb("remove", "remove a saved state", "arm_cli.sim.snapshots:REMOVE"),
        Verb("record", "record a run, to replay it later", "arm_cli.sim.recordings:RECORD"),
        Verb("replay", "run a recorded run again and compare it", "arm_cli.sim.recordings:REPLAY"),
        Verb("diff", "compare two recorded runs", "arm_cli.sim.recordings:DIFF"),
    ),
)

LIFECYCLE = VerbFamily(
    "lifecycle",
    "show managed nodes and change their states",
    (
        Verb("nodes", "list the managed nodes", "arm_cli.lifecycle_verbs:LIST_NODES"),
        Verb("get", "print the state of a node, or of all", "arm_cli.lifecycle_verbs:GET_STATE"),
        Verb("list", "list the transitions of a node", "arm_cli.lifecycle_verbs:LIST_TRANSITIONS"),
        Verb("set", "trigger a transition of a node", "arm_cli.lifecycle_verbs:SET_STATE"),
    ),
)

TF = VerbFamily(
    "tf",
    "show coordinate frames",
    (
        Verb("tree", "print the tree of frames", "arm_cli.tf.tree:PRINT_TREE"),
        Verb("echo", "print the transform between two frames", "arm_cli.tf.echo"),
        Verb("monitor", "print how late transforms arrive", "arm_cli.tf.monitor"),
        Verb("view_frames", "draw the tree of frames to a file", "arm_cli.tf.tree:VIEW_FRAMES"),
    ),
)

BAG = VerbFamily(
    "bag",
    "record and play topics",
    (
        Verb("record", "record topics to a bag", "arm_cli.bag.record"),
        Verb("info", "show the contents of a bag", "arm_cli.bag.info:INFO"),
        Verb("play", "publish the messages of a bag", "arm_cli.bag.play"),
        Verb(
            "convert",
            "rewrite bags with other topics, compression or file sizes",
            "arm_cli.bag.convert:CONVERT",
        ),
        Verb("reindex", "rebuild a bag's metadata from its files", "arm_cli.bag.convert:REINDEX"),
        Verb("list", "list the supported bag formats", "arm_cli.bag.info:LIST"),
    ),
)

DATASET = VerbFamily(
    "dataset",
    "record demonstrations for learning, in LeRobot's format",
    (
        Verb("record", "record demonstrations, and write a dataset", "arm_cli.dataset.record"),
        Verb("convert", "write bags as a dataset", "arm_cli.dataset.convert:CONVERT"),
        Verb("check", "check a dataset against its format", "arm_cli.dataset.convert:CHECK"),
    ),
)

PKG = VerbFamily(
    "pkg",
    "list packages and their executables, create new ones",
    (
        Verb("create", "write a new package that runs at once", "arm_cli.pkg_create_verb"),
        Verb("deps", "show what packages need, and install it", "arm_cli.pkg_deps_verb"),
        Verb("list", "list the packages", "arm_cli.pkg_verbs:LIST_PACKAGES"),
        Verb("prefix", "print where a package is installed", "arm_cli.pkg_verbs:SHOW_PREFIX"),
        Verb(
            "executables",
            "list the executables of a package",
            "arm_cli.pkg_verbs:LIST_EXECUTABLES",
        ),
        Verb("xml", "print a package's manifest", "arm_cli.pkg_verbs:SHOW_MANIFEST"),
    ),
)

GZ = VerbFamily(
    "gz",
    "Gazebo's commands for this simulation",
    (
        PlainVerb("sim", "show a world", "arm_cli.gz.sim"),
        Verb("topic", "list topics and print their messages", "arm_cli.gz.topic"),
        Verb("service", "list services and their replacements", "arm_cli.gz.model:SERVICE"),
        Verb("model", "list models and print their poses", "arm_cli.gz.model:MODEL"),
    ),
)

VERBS = (
    PlainVerb("launch", "start the simulated arm, or any launch file", "arm_cli.launch_verb"),
    PlainVerb("run", "run an executable of a package", "arm_cli.run_verb"),
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
    Verb(
        "sweep", "make the runs of a study on all cores, or on a Ray cluster", "arm_cli.sweep_verb"
    ),
    Verb("stop", "stop all robots at once, or release them", "arm_cli.stop_verb"),
    Verb("view", "show the robots in the browser, and move them", "arm_cli.run_verb:VIEW"),
    Verb("check", "check a robot or world file as the simulation reads it", "arm_cli.check_verb"),
    Verb("doctor", "find out why the arm does not move or is not seen", "arm_cli.doctor.verb"),
    Verb("graph", "draw the nodes and topics, as SVG or Mermaid", "arm_cli.graph.picture"),
    PKG,
    Verb(
        "completion",
        "print the completion script of a shell",
        "arm_cli.word_completion:PRINT_SCRIPT",
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
