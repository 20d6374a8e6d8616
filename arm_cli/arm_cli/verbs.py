"""The verbs of `arm`: name, one line of help, and the module that carries each out."""

from arm_cli.verb import PlainVerb, Verb, VerbFamily

TOPIC = VerbFamily(
    "topic",
    "list, show, measure and publish topics",
    (
        Verb("list", "list the topics", "arm_cli.topic.list"),
        Verb("info", "show a topic's type, publishers and subscriptions", "arm_cli.topic.info"),
        Verb("echo", "print the messages of a topic", "arm_cli.topic.echo"),
        Verb("hz", "measure the rate of a topic", "arm_cli.topic.hz"),
        Verb("bw", "measure the bandwidth of a topic", "arm_cli.topic.bw"),
        Verb("delay", "measure the age of a topic's stamps", "arm_cli.topic.delay"),
        Verb("pub", "publish a message to a topic", "arm_cli.topic.pub"),
        Verb("type", "print a topic's type", "arm_cli.topic.type"),
        Verb("find", "list the topics of a type", "arm_cli.topic.find"),
    ),
)

NODE = VerbFamily(
    "node",
    "list and show nodes",
    (
        Verb("list", "list the nodes", "arm_cli.node.list"),
        Verb("info", "show what a node publishes, subscribes and serves", "arm_cli.node.info"),
    ),
)

PARAM = VerbFamily(
    "param",
    "read and set the parameters of nodes",
    (
        Verb("list", "list the parameters of a node, or of all", "arm_cli.param.list"),
        Verb("get", "print a parameter's value", "arm_cli.param.get"),
        Verb("set", "set a parameter", "arm_cli.param.set"),
        Verb("describe", "show a parameter's type and limits", "arm_cli.param.describe"),
        Verb("dump", "print all parameters of a node as YAML", "arm_cli.param.dump"),
        Verb("load", "set a node's parameters from a YAML file", "arm_cli.param.load"),
        Verb("delete", "remove a parameter", "arm_cli.param.delete"),
    ),
)

SERVICE = VerbFamily(
    "service",
    "list and call services",
    (
        Verb("list", "list the services", "arm_cli.service.list"),
        Verb("info", "show a service's type, clients and servers", "arm_cli.service.info"),
        Verb("type", "print a service's type", "arm_cli.service.type"),
        Verb("find", "list the services of a type", "arm_cli.service.find"),
        Verb("call", "call a service and print its answer", "arm_cli.service.call"),
    ),
)

ACTION = VerbFamily(
    "action",
    "list actions and send goals",
    (
        Verb("list", "list the actions", "arm_cli.action.list"),
        Verb("info", "show an action's clients and servers", "arm_cli.action.info"),
        Verb("type", "print an action's type", "arm_cli.action.type"),
        Verb("find", "list the actions of a type", "arm_cli.action.find"),
        Verb("send_goal", "send a goal and wait for its result", "arm_cli.action.send_goal"),
    ),
)

INTERFACE = VerbFamily(
    "interface",
    "show message, service and action types",
    (
        Verb("list", "list the installed types", "arm_cli.interface.list"),
        Verb("show", "print the definition of a type", "arm_cli.interface.show"),
        Verb("package", "list the types of a package", "arm_cli.interface.package"),
        Verb("packages", "list the packages that define types", "arm_cli.interface.packages"),
        Verb("proto", "print a type as YAML to fill in", "arm_cli.interface.proto"),
    ),
)

CONTROL = VerbFamily(
    "control",
    "ask and steer the controller manager",
    (
        Verb("list_controllers", "list the controllers", "arm_cli.control.list_controllers"),
        Verb(
            "list_controller_types",
            "list the types of controllers that can be loaded",
            "arm_cli.control.list_controller_types",
        ),
        Verb(
            "list_hardware_components",
            "list the hardware components",
            "arm_cli.control.list_hardware_components",
        ),
        Verb(
            "list_hardware_interfaces",
            "list the command and state interfaces",
            "arm_cli.control.list_hardware_interfaces",
        ),
        Verb("load_controller", "load a controller", "arm_cli.control.load_controller"),
        Verb("unload_controller", "unload a controller", "arm_cli.control.unload_controller"),
        Verb(
            "cleanup_controller",
            "take a controller back to unconfigured",
            "arm_cli.control.cleanup_controller",
        ),
        Verb(
            "set_controller_state",
            "configure, activate or deactivate a controller",
            "arm_cli.control.set_controller_state",
        ),
        Verb(
            "set_hardware_component_state",
            "configure, activate or deactivate a hardware component",
            "arm_cli.control.set_hardware_component_state",
        ),
        Verb(
            "switch_controllers",
            "activate and deactivate controllers in one step",
            "arm_cli.control.switch_controllers",
        ),
        Verb(
            "reload_controller_libraries",
            "read the controllers' code anew",
            "arm_cli.control.reload_controller_libraries",
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
    "look into a simulation, and change it while it runs",
    (
        Verb("info", "show what a simulation holds, and its time", "arm_cli.sim.info"),
        Verb("spawn", "put a thing into the world", "arm_cli.sim.spawn"),
        Verb("delete", "take things out of the world", "arm_cli.sim.delete"),
        Verb("pause", "let simulated time stand still", "arm_cli.sim.pause"),
        Verb("play", "let simulated time go on", "arm_cli.sim.play"),
        Verb("step", "advance a paused simulation", "arm_cli.sim.step"),
        Verb("reset", "put everything back to where it started", "arm_cli.sim.reset"),
    ),
)

LIFECYCLE = VerbFamily(
    "lifecycle",
    "show and steer managed nodes",
    (
        Verb("nodes", "list the nodes with a lifecycle", "arm_cli.lifecycle.nodes"),
        Verb("get", "print the state of a node, or of all", "arm_cli.lifecycle.get"),
        Verb("list", "list the transitions of a node", "arm_cli.lifecycle.list"),
        Verb("set", "take a node through a transition", "arm_cli.lifecycle.set"),
    ),
)

TF = VerbFamily(
    "tf",
    "show coordinate frames",
    (
        Verb("tree", "print the tree of frames", "arm_cli.tf.tree"),
        Verb("echo", "print where a frame is in another", "arm_cli.tf.echo"),
        Verb("view_frames", "draw the tree of frames to a file", "arm_cli.tf.view_frames"),
    ),
)

BAG = VerbFamily(
    "bag",
    "record and play topics",
    (
        Verb("record", "record topics to a bag", "arm_cli.bag.record"),
        Verb("info", "show what is in a bag", "arm_cli.bag.info"),
        Verb("play", "publish again what is in a bag", "arm_cli.bag.play"),
    ),
)

PKG = VerbFamily(
    "pkg",
    "list packages and their executables",
    (
        Verb("list", "list the packages", "arm_cli.pkg.list"),
        Verb("prefix", "print where a package is installed", "arm_cli.pkg.prefix"),
        Verb("executables", "list the executables of a package", "arm_cli.pkg.executables"),
        Verb("xml", "print a package's manifest", "arm_cli.pkg.xml"),
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
    LIFECYCLE,
    TF,
    BAG,
    Verb("view", "show the robots in the browser, and move them", "arm_cli.view_verb"),
    Verb("check", "tell what becomes of a URDF or xacro file", "arm_cli.check_verb"),
    Verb("doctor", "say why the arm does not move or is not seen", "arm_cli.doctor_verb"),
    Verb("graph", "draw the nodes and topics, as SVG or Mermaid", "arm_cli.graph_verb"),
    PKG,
    Verb("completion", "print the completion script of a shell", "arm_cli.completion_verb"),
)

ARM = VerbFamily("arm", "simulated robot arms on ROS 2, from pip", VERBS)
