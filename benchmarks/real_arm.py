"""Drivers of real arms on emulated devices: the cycle, faults, a pulled plug, a follower's lag.

The emulated servos run in a process of their own and deliver their bytes no faster than 1 Mbaud.
Both drivers read and write the same six servos, in turns. `feetech-servo-sdk==1.0.0` is the peer;
without it its rows are left out:

    pip install feetech-servo-sdk==1.0.0
    python benchmarks/real_arm.py
"""

import contextlib
import random
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Iterator
from pathlib import Path

import harness
import numpy as np

from arm_control import HardwareReturn
from arm_control.hardware.info import parse_hardware_info
from arm_drivers.feetech.bus import FeetechBus
from arm_drivers.feetech.frames import ReplyCollector, sync_read_request
from arm_drivers.feetech.hardware import FeetechArm, FeetechHardware, JointServo
from arm_drivers.mycobot.frames import MyCobotCommand, reply_data
from arm_drivers.mycobot.hardware import MyCobotArm, MyCobotHardware
from arm_drivers.serial_line import SerialLine
from arm_gazebo.launching.leader_follower import UPDATE_RATE_HZ
from arm_sim.bench.feetech_servos import FeetechServos
from arm_sim.bench.mycobot_arm import EmulatedMyCobot
from arm_sim.bench.serial_device import EmulatedPort, ReplyFaults, SerialDevice

CYCLES = 1000
TURNS = 3
PERIOD_S = 0.005
MYCOBOT_PERIOD_S = 0.02
LAG_CYCLES = 4000
STREAMS = 100_000
IDS = range(1, 7)
STEP_RAD = 2 * np.pi / 4096


@contextlib.contextmanager
def emulator(name: str, folder: Path) -> Iterator[str]:
    """Run an emulated device in a process of its own; yield its port."""
    port = folder / name
    command = [sys.executable, "-m", f"arm_sim.bench.{name}", "--port", str(port)]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as process:
        assert process.stdout is not None
        process.stdout.readline()
        yield str(port)
        process.terminate()


def timed(
    cycle: Callable[[], None], count: int, period_s: float = PERIOD_S
) -> tuple[np.ndarray, float]:
    """Return the time of each cycle in ms, and the processor time of one in ms."""
    times = np.empty(count)
    processor_s = time.process_time()
    for number in range(count):
        started = time.perf_counter()
        cycle()
        times[number] = 1e3 * (time.perf_counter() - started)
        time.sleep(max(0.0, period_s - 1e-3 * times[number]))
    return times, 1e3 * (time.process_time() - processor_s) / count


def own_cycle(port: str) -> tuple[Callable[[], None], Callable[[], None]]:
    """Return one cycle of the driver, and what closes it."""
    bus = FeetechBus(SerialLine(port, 1_000_000), 0.02)
    arm = FeetechArm(bus, [JointServo(f"j{number}", number) for number in IDS], 1.9)
    arm.start()
    goals = np.zeros(len(IDS))
    return lambda: void(arm.exchange(goals)), arm.close


def void(_: object) -> None:
    """Ignore a value."""


def peer_cycle(port: str) -> tuple[Callable[[], None], Callable[[], None]]:
    """Return one cycle of feetech-servo-sdk, and what closes it."""
    import scservo_sdk as sdk

    line, packets = sdk.PortHandler(port), sdk.PacketHandler(0)
    assert line.setBaudRate(1_000_000)
    reader = sdk.GroupSyncRead(line, packets, 56, 7)
    writer = sdk.GroupSyncWrite(line, packets, 42, 2)
    for number in IDS:
        reader.addParam(number)

    failed = [0]

    def close() -> None:
        print(f"feetech-servo-sdk: {failed[0]} failed reads", file=sys.stderr)
        line.closePort()

    def cycle() -> None:
        for number in IDS:
            writer.addParam(number, [0, 8])
        writer.txPacket()
        writer.clearParam()
        # It does not do so by itself: after one late reply it reads one behind for good.
        line.ser.reset_input_buffer()
        failed[0] += reader.txRxPacket() != sdk.COMM_SUCCESS
        for number in IDS:
            for address, size in ((56, 2), (58, 2), (60, 2), (62, 1)):
                reader.getData(number, address, size)

    return cycle, close


def cycle_rows(folder: Path) -> list[harness.Row]:
    """Measure the cycle of both."""
    with emulator("feetech_servos", folder) as port:
        own, peer = [], []
        for _ in range(TURNS):
            own.append(measured(own_cycle, port))
            with contextlib.suppress(ModuleNotFoundError):
                peer.append(measured(peer_cycle, port))
    times = np.concatenate([each for each, _ in own])
    median, high = harness.percentiles(times, 50, 99)
    rows = [
        harness.Row(
            "six STS servos at 1 Mbaud, goals written and 7 bytes read: median; p99",
            f"{median:.2f} ms; {high:.2f} ms (n={len(times)})",
            "p99 2.5 ms",
        )
    ]
    if peer:
        median, high = harness.percentiles(np.concatenate([each for each, _ in peer]), 50, 99)
        rows.append(harness.Row("the same by feetech-servo-sdk", f"{median:.2f}; {high:.2f} ms"))
        mine, its = (float(np.median([cpu for _, cpu in each])) for each in (own, peer))
        rows.append(
            harness.Row(
                "processor time of a cycle: driver; feetech-servo-sdk",
                f"{mine:.2f} ms; {its:.2f} ms: {mine / its:.2f} x",
                "0.5 x",
            )
        )
    return rows


def mycobot_row(folder: Path) -> harness.Row:
    """Measure the cycle of the myCobot's driver; the emulated arm answers after 2 ms."""
    with emulator("mycobot_arm", folder) as port:
        arm = MyCobotArm(SerialLine(port, 115_200), [f"j{n}" for n in range(6)], None, 0.05, 80)
        arm.start()
        arm.engage(np.zeros(6))
        times, _ = timed(lambda: void(arm.exchange(np.zeros(6))), CYCLES, MYCOBOT_PERIOD_S)
        arm.close()
    median, high = harness.percentiles(times, 50, 99)
    return harness.Row(
        "myCobot at 115200 baud, angles written and read: median; p99",
        f"{median:.1f} ms; {high:.1f} ms (n={len(times)})",
        "20 ms",
    )


def measured(
    make: Callable[[str], tuple[Callable[[], None], Callable[[], None]]], port: str
) -> tuple[np.ndarray, float]:
    """Open, measure and close one driver."""
    cycle, close = make(port)
    timed(cycle, 50)
    result = timed(cycle, CYCLES)
    close()
    return result


def description(plugin: str, port: Path, **parameters: str) -> str:
    words = "".join(f'<param name="{n}">{v}</param>' for n, v in parameters.items())
    joints = "".join(
        f'<joint name="j{n}"><command_interface name="position"/>'
        '<state_interface name="position"/></joint>'
        for n in range(6)
    )
    return (
        f'<robot name="arm"><ros2_control name="Arm" type="system"><hardware><plugin>{plugin}'
        f'</plugin><param name="port">{port}</param>{words}</hardware>{joints}</ros2_control>'
        "</robot>"
    )


def faults_row(
    name: str, kind: type[FeetechHardware | MyCobotHardware], device: SerialDevice, path: Path
) -> harness.Row:
    """Move an arm while one in 100 replies is faulty; count wrong values and failures.

    A value is wrong if the joint was nowhere near it within the last tenth of a second.
    """
    faults = ReplyFaults(0.01, ("lost", "late", "doubled", "damaged", "short", "noise"))
    wrong = failures = 0
    with EmulatedPort(device, path) as port:
        hardware = kind(parse_hardware_info(description(f"arm_drivers/{name}", path))[0])
        assert hardware.on_configure()
        assert hardware.on_activate()
        port.faults = faults
        recent: list[np.ndarray] = []
        for cycle in range(6000):
            hardware.commands[:] = 0.5 * np.sin(0.01 * cycle)
            outcomes = hardware.read(0.0, PERIOD_S), hardware.write(0.0, PERIOD_S)
            if HardwareReturn.ERROR in outcomes:
                failures += 1
                break
            recent = [*recent[-20:], true_positions(device)]
            low, high = np.min(recent, axis=0) - STEP_RAD, np.max(recent, axis=0) + STEP_RAD
            wrong += int(((hardware.states < low) | (hardware.states > high)).sum())
            time.sleep(PERIOD_S)
        exchanges = hardware.thread.exchanges if hardware.thread else 0
        hardware.on_cleanup()
    counts = ", ".join(f"{count} {fault}" for fault, count in sorted(faults.counts.items()))
    return harness.Row(
        f"{name}, 1 in 100 replies faulty ({counts}), {exchanges} exchanges: wrong values; "
        "failures",
        f"{wrong}; {failures}",
        "0; 0" if name == "Feetech" else "none that range and jump show; 0",
    )


def true_positions(device: SerialDevice) -> np.ndarray:
    if isinstance(device, FeetechServos):
        return np.array([(s.position - 2048) * STEP_RAD for s in device.servos.values()])
    assert isinstance(device, EmulatedMyCobot)
    return np.radians(device.angles)


def streams_row() -> harness.Row:
    """Let both readers read random streams, then a sound reply behind each.

    A stream is noise, replies of others, and replies that are cut off or have one wrong bit. The
    myCobot's protocol has no checksum: a wrong bit in an angle passes, and a cut reply with the end
    of the next one behind it. Its streams have neither; the driver's rules of range and jump
    answer those.
    """
    chance = random.Random(1)
    servo_frames = [feetech_reply(number, b"\x12\x07") for number in (1, 2, 3)]
    servo_others = [feetech_reply(9, b"ab"), feetech_reply(1, b"a"), feetech_reply(2, b"abc")]
    sound = b"".join(servo_frames)
    request = sync_read_request((1, 2, 3), 56, 2)
    angles = b"\xfe\xfe\x0e\x20" + bytes(range(12)) + b"\xfa"
    arm_others = [b"\xfe\xfe\x03\x22\x01\xfa", b"\xfe\xfe\x03\x65\x64\xfa", angles[:-3] + b"\xfa"]
    wrong, late = [0, 0], [0, 0]
    for _ in range(STREAMS):
        flipped = bytearray(chance.choice(servo_frames))
        flipped[chance.randrange(len(flipped))] ^= 1 << chance.randrange(8)
        parts = [
            chance.randbytes(chance.randrange(20)),
            chance.choice(servo_others),
            bytes(flipped),
        ]
        chance.shuffle(parts)
        stream = b"".join(parts)[: chance.randrange(60)]
        found = collected(request, stream)
        wrong[0] += bool(found)
        late[0] += collected(request, stream[chance.randrange(len(stream) + 1) :] + sound) != {
            number: b"\x12\x07" for number in (1, 2, 3)
        }
        cut = angles[: chance.randrange(len(angles))]
        stream = chance.randbytes(chance.randrange(20)) + chance.choice(arm_others) + cut
        wrong[1] += reply_data(stream, MyCobotCommand.READ_ANGLES) is not None
        late[1] += reply_data(stream + angles, MyCobotCommand.READ_ANGLES) != angles[4:-1]
    return harness.Row(
        f"readers on {STREAMS} random streams each, Feetech; myCobot: wrong values; next request "
        "out of step",
        f"{wrong[0]}, {late[0]}; {wrong[1]}, {late[1]}",
        "0",
    )


def collected(request: bytes, stream: bytes) -> dict[int, bytes]:
    collector = ReplyCollector(request, (1, 2, 3), 2)
    collector.take(stream)
    return {servo: reply.data for servo, reply in collector.replies().items()}


def feetech_reply(servo: int, data: bytes) -> bytes:
    body = bytes((servo, len(data) + 2, 0)) + data
    return b"\xff\xff" + body + bytes((255 - sum(body) % 256,))


def plug_row(path: Path) -> harness.Row:
    """Pull the plug of a running arm and put it back."""
    gone, back = [], []
    with EmulatedPort(FeetechServos(), path) as port:
        hardware = FeetechHardware(parse_hardware_info(description("arm_drivers/Feetech", path))[0])
        for _ in range(10):
            started = time.perf_counter()
            assert hardware.on_configure()
            assert hardware.on_activate()
            back.append(time.perf_counter() - started)
            for _ in range(20):
                hardware.read(0.0, PERIOD_S), hardware.write(0.0, PERIOD_S)
                time.sleep(PERIOD_S)
            port.unplug()
            started = time.perf_counter()
            while hardware.read(0.0, PERIOD_S) is HardwareReturn.OK:
                hardware.write(0.0, PERIOD_S)
                time.sleep(PERIOD_S)
            gone.append(time.perf_counter() - started)
            hardware.on_cleanup()
            port.plug()
    return harness.Row(
        "plug pulled: until it is said, longest; taken up again, longest",
        f"{max(gone):.3f} s; {max(back):.3f} s (n=10)",
        "0.2 s",
    )


def lag_row(folder: Path) -> harness.Row:
    """Let one arm follow another that moves to and fro; say how far it is behind.

    The lag is the distance of the two arms' true positions by the speed of the leader. It is
    looked at just before a cycle, when it is longest. The emulated servos move only when they are
    asked, so up to a period of it is theirs.
    """
    speed, period_s = 0.5, 1.0 / UPDATE_RATE_HZ
    leader, follower = FeetechServos(), FeetechServos()
    with EmulatedPort(leader, folder / "leader"), EmulatedPort(follower, folder / "follower"):
        # A missed reply shows in the figure; it must not end the run.
        patience = {"reply_timeout": "0.05", "max_missed": "1000"}
        text = description("arm_drivers/Feetech", folder / "leader", passive="true", **patience)
        leading = FeetechHardware(parse_hardware_info(text)[0])
        text = description("arm_drivers/Feetech", folder / "follower", **patience)
        following = FeetechHardware(parse_hardware_info(text)[0])
        for arm in (leading, following):
            assert arm.on_configure()
            assert arm.on_activate()
        lags_ms = []
        start_s = time.perf_counter()
        for cycle in range(LAG_CYCLES):
            time.sleep(max(0.0, start_s + cycle * period_s - time.perf_counter()))
            place = (time.perf_counter() - start_s) % 4.0
            for servo in leader.servos.values():
                servo.position = 2048 + speed * (1.0 - abs(place - 2.0)) / STEP_RAD
            if 0.5 < place % 2.0 < 1.9:  # Away from the ends, where it turns.
                behind = np.abs(true_positions(leader) - true_positions(follower)).max()
                lags_ms.append(1e3 * behind / speed)
            for arm in (leading, following):
                assert arm.read(0.0, period_s) is HardwareReturn.OK
            following.commands[:] = leading.states  # As LeaderFollowerController does.
            for arm in (leading, following):
                arm.write(0.0, period_s)
        for arm in (leading, following):
            arm.on_cleanup()
    median, high = harness.percentiles(lags_ms, 50, 99)
    return harness.Row(
        f"follower behind its leader at {UPDATE_RATE_HZ} Hz: median; p99",
        f"{median:.1f} ms; {high:.1f} ms (n={len(lags_ms)})",
        "p99 20 ms",
    )


def main() -> None:
    """Print the table."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        rows = cycle_rows(folder)
        rows.append(mycobot_row(folder))
        rows.append(faults_row("Feetech", FeetechHardware, FeetechServos(), folder / "feetech"))
        rows.append(
            faults_row("MyCobot280", MyCobotHardware, EmulatedMyCobot(), folder / "mycobot")
        )
        rows.append(plug_row(folder / "plug"))
        rows.append(lag_row(folder))
    rows.append(streams_row())
    harness.print_table("Drivers of real arms, on emulated devices", rows)


if __name__ == "__main__":
    main()
