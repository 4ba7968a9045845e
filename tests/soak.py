"""Look for what the suite does not meet: its property tests with fresh examples, then the fuzzers, for a given time.

    python tests/soak.py [--minutes M] [--seed S]

A round is every property test once, with a seed of its own; twenty rounds try twenty times the examples of the suite.
They end early where the fuzzers' share of the time begins. The exit status is 1 if anything failed; the seed that is
printed repeats it.
"""

import argparse
import os
import secrets
import signal
import subprocess
import sys
import tempfile
from collections.abc import Sequence
from pathlib import Path
from time import monotonic
from xml.etree import ElementTree

TESTS = Path(__file__).parent
PROPERTIES = [sys.executable, "-m", "pytest", "-n", "2", "-q", "-m", "hypothesis", "--hypothesis-profile=soak"]
ENGINES, SPACE = ([sys.executable, str(TESTS / name)] for name in ("fuzz_engines.py", "fuzz_space.py"))
FUZZERS = [[*ENGINES, "near-bit"], [*ENGINES, "wide"], [*ENGINES, "as-built"], SPACE]
ROUNDS = 20
FUZZERS_SHARE = 0.25  # of the time, at least
PATIENCE = 60.0  # s that a process has to end after it was asked to


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the soak; the exit status."""
    parser = argparse.ArgumentParser(description="Property tests with fresh examples, then the fuzzers.")
    parser.add_argument("--minutes", type=float, default=40.0, metavar="M")
    parser.add_argument("--seed", type=int, default=secrets.randbelow(2**31), metavar="S")
    options = parser.parse_args(arguments)
    if not options.minutes > 0:
        parser.error(f"--minutes: must be > 0, got {options.minutes:g}")
    print(f"soak: {options.minutes:g} minutes, seed {options.seed}", flush=True)
    end = monotonic() + 60 * options.minutes
    failures: list[str] = []
    signal.signal(signal.SIGINT, signal.default_int_handler)  # which a shell may have told us to ignore
    try:
        failures += properties(options.seed, end - FUZZERS_SHARE * 60 * options.minutes)
        failures += fuzzers(options.seed, (end - monotonic()) / 60)
    except KeyboardInterrupt:
        print("soak: stopped", flush=True)
        return 130
    for failure in failures:
        print(f"soak: failed; to repeat it: {failure}", flush=True)
    print(f"soak: {'failed' if failures else 'all green'}, seed {options.seed}", flush=True)
    return 1 if failures else 0


def properties(seed: int, until: float) -> list[str]:
    """Rounds of the property tests until a clock time; the command of the round that failed, if one did."""
    done = 0
    while done < ROUNDS and monotonic() < until:
        command = [*PROPERTIES, f"--hypothesis-seed={seed + done}"]
        with tempfile.TemporaryDirectory() as folder:
            report = Path(folder) / "report.xml"
            process = start([*command, f"--junitxml={report}"])
            cut = not finish([process], until)
            if has_failures(report) or (process.returncode and not cut):
                return [" ".join(command)]
        if not cut:
            done += 1
    print(f"soak: the property tests with {done} × the examples of the suite", flush=True)
    return []


def has_failures(report: Path) -> bool:
    """Whether the report of a round, whole or cut short, names a test that failed."""
    if not report.exists():
        return False
    suites = ElementTree.parse(report).getroot().iter("testsuite")
    return any(int(suite.get(kind, "0")) > 0 for suite in suites for kind in ("failures", "errors"))


def fuzzers(seed: int, minutes: float) -> list[str]:
    """The fuzzers side by side; the commands of those that failed."""
    commands = [[*fuzzer, "--minutes", f"{max(minutes, 0.0):.2f}", "--seed", str(seed)] for fuzzer in FUZZERS]
    processes = [start(command) for command in commands]
    finish(processes)
    return [" ".join(command) for command, process in zip(commands, processes, strict=True) if process.returncode]


def start(command: list[str]) -> "subprocess.Popen[bytes]":
    """Start a command that Ctrl-C reaches through `finish` alone, and once."""
    return subprocess.Popen(command, cwd=TESTS.parent, start_new_session=True)


def finish(processes: list["subprocess.Popen[bytes]"], until: float | None = None) -> bool:
    """Wait until the processes have ended; end those that run at a clock time. Whether they ended by themselves."""
    try:
        for process in processes:
            process.wait(None if until is None else max(until - monotonic(), 0.0))
    except subprocess.TimeoutExpired:
        stop(processes)
        return False
    except KeyboardInterrupt:
        stop(processes)
        raise
    return True


def stop(processes: list["subprocess.Popen[bytes]"]) -> None:
    """Ask processes to end, and wait until they have."""
    for process in processes:
        process.send_signal(signal.SIGINT)
    for process in processes:
        try:
            process.wait(PATIENCE)
        except subprocess.TimeoutExpired:
            os.killpg(process.pid, signal.SIGKILL)
            process.wait()


if __name__ == "__main__":
    sys.exit(main())
