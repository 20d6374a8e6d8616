"""`arm doctor`: says why the arm does not move or is not seen, with the fix beside it."""

import argparse
import os
from collections.abc import Iterator
from dataclasses import asdict

from arm_cli.doctor.examination import (
    SIMULATION,
    examine_running,
    installation_checks,
    is_healthy,
)
from arm_cli.doctor.finding import Finding, Severity
from arm_cli.errors import ArmCliError
from arm_cli.output import add_json_argument, colour, print_json
from arm_cli.ros.connection import connect

EXIT_UNHEALTHY = 1
COLOURS = {Severity.OK: 92, Severity.WARNING: 93, Severity.ERROR: 91}
SEVERITY_WIDTH = max(map(len, Severity))


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the verb's arguments."""
    add_json_argument(parser)


def run(options: argparse.Namespace) -> int:
    """Print each finding as soon as it is there; return 1 where there is an error."""
    findings: list[Finding] = []
    for finding in _examine():
        findings.append(finding)
        if not options.json:
            print(_line(finding))
    healthy = is_healthy(findings)
    if options.json:
        print_json({"healthy": healthy, "findings": [asdict(finding) for finding in findings]})
    else:
        print(_summary(findings))
    return 0 if healthy else EXIT_UNHEALTHY


def _examine() -> Iterator[Finding]:
    findings: list[Finding] = []
    for check in installation_checks(dict(os.environ)):
        findings.append(check.examine())
        yield findings[-1]
    if is_healthy(findings):
        yield from _examine_running()
    else:
        sentence = "not looked at: what is wrong above may be why nothing would be seen"
        yield Finding.warning(SIMULATION, sentence, "mend the errors above, then arm doctor again")


def _examine_running() -> list[Finding]:
    try:
        with connect() as session:
            from arm_cli.ros.observer import observe

            return examine_running(observe(session))
    except ArmCliError as error:
        return [Finding.error(SIMULATION, str(error), "start the simulation again")]


def _line(finding: Finding) -> str:
    word = colour(COLOURS[finding.severity], f"{finding.severity:<{SEVERITY_WIDTH}}")
    line = f"{word}  {finding.check}: {finding.sentence}"
    return f"{line}\n{'':{SEVERITY_WIDTH}}  -> {finding.fix}" if finding.fix else line


def _summary(findings: list[Finding]) -> str:
    counts = [
        f"{count} {severity}{'s' if count > 1 else ''}"
        for severity in (Severity.ERROR, Severity.WARNING)
        if (count := sum(finding.severity is severity for finding in findings))
    ]
    return ", ".join(counts) or "all is well"
