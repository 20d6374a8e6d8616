"""The launcher with real processes: starts, output, logs, exits and exit codes."""

import os
import re
import signal
import subprocess
import sys
from pathlib import Path

import pytest

FAMILY = """
CODE = '''
import os, signal, subprocess, sys
sleep = [sys.executable, "-c", "import signal; signal.pause()"]
deaf = "import signal; [signal.signal(s, signal.SIG_IGN) for s in (2, 15)]; " + sleep[2]
children = [
    subprocess.Popen(sleep),
    subprocess.Popen([sys.executable, "-c", deaf]),
    subprocess.Popen(sleep, start_new_session=True),
    subprocess.Popen(sleep, process_group=0),
]
print("family", os.getpid(), *(c.pid for c in children), flush=True)
signal.pause()
'''
actions = [python("family", CODE, ready=LogLine("family"))]
"""

DEAF = """
CODE = '''
import signal
def say(number, frame): print("got", signal.Signals(number).name, flush=True)
signal.signal(signal.SIGINT, say)
signal.signal(signal.SIGTERM, say)
print("up", flush=True)
while True: signal.pause()
'''
options = {}
actions = [python("deaf", CODE, ready=LogLine("up"), **options)]
"""


def pids_of(line: str) -> list[int]:
    return [int(word) for word in re.findall(r"\b\d+\b", line)]


def parent_of(pid: int) -> int:
    return int(Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()[1])


def log_folder(environment) -> Path:
    return Path(environment["ROS_LOG_DIR"]) / "latest"


def test_starts_follow_readiness_and_the_last_line_of_the_start_up_is_ready(launch):
    launched = launch(
        """
        actions = [
            forever("b", depends_on="a"),
            python("a", "print('a is up', flush=True); import signal; signal.pause()",
                   ready=LogLine("is up$")),
        ]
        """
    )
    launched.wait_for(r"^ready \d+\.\d\d s$")
    lines = launched.lines
    assert lines.index("[a] a is up") < lines.index("[b] up")
    assert re.fullmatch(r"ready \d+\.\d\d s", lines[-1])
    assert all(re.match(r"\[\w+\] ", line) for line in lines[:-1])


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM, signal.SIGHUP])
def test_a_stop_signal_ends_everything_in_order_with_exit_code_0(launch, number):
    launched = launch("actions = [forever('a'), forever('b', depends_on='a')]")
    launched.wait_for("^ready ")
    launched.process.send_signal(number)
    assert launched.wait() == 0
    stops = [line for line in launched.lines if line.endswith(" stopped")]
    assert stops == ["[launch] b stopped", "[launch] a stopped"]
    assert re.fullmatch(r"\[launch\] stopped after \d+\.\d\d s", launched.lines[-1])


def test_a_terminal_s_ctrl_c_reaches_the_processes_only_through_the_launcher(launch):
    launched = launch(
        """
        CODE = "import os; print(os.getpid(), os.getsid(0), os.getpgid(0))"
        actions = [python("a", CODE)]
        """
    )
    assert launched.wait() == 0
    pid, session, group = pids_of(launched.wait_for(r"^\[a\] \d"))
    assert pid == session == group


@pytest.mark.parametrize(
    ("number", "code"), [(signal.SIGINT, 0), (signal.SIGKILL, -signal.SIGKILL)]
)
def test_grandchildren_are_stopped_too(launch, waiting, number, code):
    launched = launch(FAMILY)
    pids = pids_of(launched.wait_for(r"^\[family\] family"))
    launched.wait_for("^ready ")
    launched.process.send_signal(number)
    assert launched.wait() == code
    waiting.until(lambda: not any(map(waiting.running, pids)), "the end of all")


def test_processes_left_by_a_crash_are_ended_before_the_restart(launch, waiting):
    launched = launch(
        """
        CODE = '''
        import subprocess, sys
        c = subprocess.Popen([sys.executable, "-c", "import signal; signal.pause()"])
        print("child", c.pid, flush=True)
        sys.exit(1)
        '''
        policy = RestartPolicy("on-failure", first_delay_s=0.01)
        actions = [python("a", CODE, restart=policy)]
        """
    )
    (first,) = pids_of(launched.wait_for("child"))
    launched.wait_for("child", count=2)
    assert not waiting.running(first)


def test_when_the_launcher_is_killed_everything_ends_in_order(launch, waiting, launch_environment):
    launched = launch("actions = [forever('a'), forever('b', depends_on='a')]")
    launched.wait_for("^ready ")
    launched.process.send_signal(signal.SIGKILL)
    assert launched.wait() == -signal.SIGKILL
    launched.wait_for(r"^\[launch\] stopped after")
    log = log_folder(launch_environment) / "launch.log"
    assert "the launcher was killed" in log.read_text()


def test_when_the_supervisor_is_killed_its_processes_and_theirs_end(launch, waiting):
    launched = launch(FAMILY)
    pids = pids_of(launched.wait_for(r"^\[family\] family"))
    launched.wait_for("^ready ")
    os.kill(parent_of(pids[0]), signal.SIGKILL)
    assert launched.wait() == 128 + signal.SIGKILL
    waiting.until(lambda: not any(map(waiting.running, pids)), "the end of all")


def test_when_both_are_killed_the_processes_still_end(launch, waiting):
    launched = launch(
        "actions = [python('a', 'import os, signal; print(os.getpid(), flush=True); "
        "signal.pause()', ready=LogLine('.'))]"
    )
    (pid,) = pids_of(launched.wait_for(r"^\[a\]"))
    launched.wait_for("^ready ")
    supervisor = parent_of(pid)
    launched.process.send_signal(signal.SIGSTOP)
    os.kill(supervisor, signal.SIGKILL)
    launched.process.send_signal(signal.SIGKILL)
    assert launched.wait() == -signal.SIGKILL
    waiting.until(lambda: not waiting.running(pid), "the end of the process")


def test_a_hanging_process_gets_sigint_sigterm_sigkill(launch):
    launched = launch(DEAF.replace("{}", "{'sigterm_timeout': 2.0, 'sigkill_timeout': 2.0}"))
    launched.wait_for("^ready ")
    launched.process.send_signal(signal.SIGTERM)
    assert launched.wait() == 137
    got = [line for line in launched.lines if line.startswith("[deaf] got")]
    assert got == ["[deaf] got SIGINT", "[deaf] got SIGTERM"]
    assert launched.lines[-1].endswith("exit code 137: deaf did not stop and was killed")


def test_a_second_ctrl_c_stops_now(launch):
    launched = launch(DEAF)
    launched.wait_for("^ready ")
    launched.process.send_signal(signal.SIGINT)
    launched.wait_for("got SIGINT")
    while launched.process.poll() is None:  # One that comes at once counts as the first.
        launched.process.send_signal(signal.SIGINT)
    assert launched.wait() == 130
    assert "got SIGTERM" not in launched.output
    assert "second Ctrl-C" in launched.lines[-1]


def test_a_signal_sent_twice_at_once_counts_once(launch):
    launched = launch(
        """
        from launch_py.supervision import session

        session.REPEATED_SIGNAL_S = 1000.0  # However late the second one comes.
        CODE = '''
        import signal
        signal.signal(signal.SIGINT, lambda *_: print("got SIGINT", flush=True))
        print("up", flush=True)
        while True: signal.pause()
        '''
        actions = [python("a", CODE, ready=LogLine("up"), sigterm_timeout=1.0)]
        """
    )
    launched.wait_for("^ready ")
    launched.process.send_signal(signal.SIGINT)
    launched.wait_for("got SIGINT")
    launched.process.send_signal(signal.SIGINT)
    assert launched.wait() == 0
    assert "second Ctrl-C" not in launched.output


def test_a_required_process_gives_the_exit_code(launch):
    launched = launch(
        "actions = [forever('a'), python('b', 'raise SystemExit(5)', depends_on='a', "
        "on_exit=Shutdown())]"
    )
    assert launched.wait() == 5
    assert "failed with exit code 5: b ended with exit code 5" in launched.lines[-1]


def test_a_log_file_for_each_process_and_for_the_launcher(launch, launch_environment):
    launched = launch(
        "actions = [python('a', 'print(1); import sys; print(2, file=sys.stderr)', output='log')]"
    )
    assert launched.wait() == 0
    folder = log_folder(launch_environment)
    assert "[a] 1" not in launched.lines
    assert "[a] 2" in launched.lines
    assert {line.split(" ")[1] for line in (folder / "a.log").read_text().splitlines()} == {
        "1",
        "2",
    }
    assert "a ended with exit code 0" in (folder / "launch.log").read_text()


def test_show_all_shows_output_meant_for_the_log(launch):
    launched = launch("actions = [python('a', 'print(1)', output='log')]", "-a")
    assert launched.wait() == 0
    assert "[a] 1" in launched.lines


def test_processes_get_the_environment_and_their_own_variables(launch):
    code = (
        "import os; print(*(os.environ.get(n) for n in "
        "('ROS_AUTOMATIC_DISCOVERY_RANGE', 'PYTHONUNBUFFERED', 'OWN', 'GONE')))"
    )
    launched = launch(
        f"actions = [UnsetEnvironmentVariable('GONE'), "
        f"python('a', {code!r}, additional_env={{'OWN': 'x'}})]",
        ROS_AUTOMATIC_DISCOVERY_RANGE="SUBNET",
        GONE="1",
    )
    assert launched.wait() == 0
    assert "[a] SUBNET 1 x None" in launched.lines


def test_a_node_reads_its_parameters_from_a_file_that_is_removed_at_the_end(
    launch, launch_environment
):
    launched = launch(
        """
        import sys
        node = Node(package="launch_py", executable="launch_py", parameters=[{"a": 1}])
        words = node.command_words
        CODE = "import sys; print(open(sys.argv[-1]).read())"
        node.command_words = lambda context: (sys.executable, "-c", CODE, words(context)[-1])
        actions = [node]
        """
    )
    assert launched.wait() == 0
    assert '[launch_py] "/**": {"ros__parameters": {"a": 1}}' in launched.lines
    assert list(log_folder(launch_environment).glob("*.yaml")) == []


def test_a_process_may_notify_that_it_is_ready(launch):
    launched = launch(
        """
        CODE = '''
        import os, signal, socket
        s = socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM)
        s.sendto(b"READY=1", os.environ["NOTIFY_SOCKET"].replace("@", chr(0), 1))
        signal.pause()
        '''
        actions = [python("a", CODE, ready=Notified()), forever("b", depends_on="a")]
        """
    )
    launched.wait_for("^ready ")
    assert "[b] up" in launched.lines


def test_emulate_tty_gives_a_terminal(launch):
    launched = launch(
        "actions = [python('a', 'import sys; print(sys.stdout.isatty())', emulate_tty=True)]"
    )
    assert launched.wait() == 0
    assert "[a] True" in launched.lines


def test_an_http_page_is_a_readiness_condition(launch):
    launched = launch(
        """
        CODE = '''
        import http.server
        class Handler(http.server.BaseHTTPRequestHandler):
            asked = 0
            def do_GET(self):
                Handler.asked += 1
                self.send_response(200 if Handler.asked > 2 else 503)
                self.end_headers()
            def log_message(self, *_): pass
        server = http.server.HTTPServer(("127.0.0.1", PORT), Handler)
        server.serve_forever()
        '''
        import socket
        with socket.socket() as s:
            s.bind(("127.0.0.1", 0))
            port = s.getsockname()[1]
        code = CODE.replace("PORT", str(port))
        actions = [python("web", code, ready=HttpOk(f"http://127.0.0.1:{port}/"))]
        """
    )
    launched.wait_for("^ready ")
    launched.process.send_signal(signal.SIGINT)
    assert launched.wait() == 0


def test_a_program_that_vanishes_is_reported_by_name(launch, tmp_path):
    program = tmp_path / "program"
    program.write_text("not a program")
    program.chmod(0o755)
    launched = launch(f"actions = [ExecuteProcess(cmd=[{str(program)!r}], name='p')]")
    assert launched.wait() == 127
    assert "p could not be started: cannot run" in launched.lines[-1]


def test_a_relative_program_is_resolved_in_its_working_folder(run_launch_py, tmp_path):
    folder = tmp_path / "sub"
    folder.mkdir()
    program = folder / "program"
    program.write_text("#!/bin/sh\necho runs in $PWD\n")
    program.chmod(0o755)
    path = tmp_path / "cwd.launch.py"
    path.write_text(
        "from launch_py import *\n"
        "def generate_launch_description():\n"
        "    p = ExecuteProcess(cmd=['./program'], prefix='./program', cwd='sub')\n"
        "    return LaunchDescription([p])\n"
    )
    done = run_launch_py(str(path))
    assert done.returncode == 0, done.stdout + done.stderr
    assert f"[program] runs in {folder}\n" in done.stdout


@pytest.mark.parametrize(
    ("options", "said"),
    [
        ("additional_env={'A=B': '1'}", "no environment variable can be named 'A=B'"),
        ("additional_env={'A': '1\\0'}", "environment variable 'A' holds a null character"),
        ("shell=True", r"argument 'true Pi\x00' holds a null character"),
        ("cwd='/\\0'", "embedded null byte"),
    ],
)
def test_invalid_arguments_are_reported_and_the_other_processes_are_stopped(launch, options, said):
    launched = launch(
        f"""
        a = forever("a")
        word = "Pi\\0" if "shell" in {options!r} else "x"
        p = ExecuteProcess(cmd=["true", word], name="p", depends_on=a, {options})
        actions = [a, p]
        """
    )
    assert launched.wait() == 127, launched.output
    assert "[launch] a stopped" in launched.lines
    assert re.search(f"p could not be started: cannot run /.*: {re.escape(said)}", launched.output)


def test_a_closed_output_stops_everything(write_launch_file, launch_environment, waiting):
    path = write_launch_file(
        """
        CODE = '''
        import itertools, os
        print(os.getpid(), flush=True)
        for i in itertools.count(): print(i, flush=True)
        '''
        actions = [python("a", CODE)]
        """
    )
    with subprocess.Popen(
        [sys.executable, "-m", "launch_py", str(path)],
        stdout=subprocess.PIPE,
        text=True,
        env=launch_environment,
    ) as process:
        assert process.stdout is not None
        line = next(line for line in process.stdout if line.startswith("[a]"))
    (pid,) = pids_of(line)
    assert not waiting.running(pid)
