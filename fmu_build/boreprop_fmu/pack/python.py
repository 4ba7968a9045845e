"""Packs the model as Python code on pythonfmu's runtime, for hosts that have a Python.

The binaries and the base class of the slave are those of pythonfmu. Its own builder is not used: it would import the
slave into this process, and make a different file every time.
"""

import json
from dataclasses import asdict
from hashlib import sha256
from importlib.resources import files
from pathlib import Path

from boreprop.case.case import Case

from .archive import digest, identify
from .contents import describe, pack_manual, start_values

RUNTIME_MODULES = ("default_experiment", "enums", "fmi2slave", "logmsg", "variables", "_version")
ADVICE = (
    "it needs CPython in the host, and falls short of FMI 2.0 where its documentation/index.html says so; "
    "--runtime native does neither"
)
SCRIPT = '''"""The script that pythonfmu runs for every instance, to find the class in it."""

from {package}.process import keep_alive
from {package}.slave import Borehole as Slave

if not keep_alive(globals()):

    class Borehole(Slave):  # a class of each instance keeps the globals alive too, and several kB more
        def __init__(self, **kwargs):
            super().__init__(**kwargs)

        def do_step(self, current_time, step_size):
            return super().do_step(current_time, step_size)
'''
# The binaries whose logger is known to remember loggingOn this far from its beginning, bytes: by their SHA-256.
LOG_SWITCH = {
    "4be156a552c16f30eb4395805c59855d8d4086056d0f165442565f6c5fbac0c9": 8,  # pythonfmu 0.7.0, Linux
    "24de3fd7a3a18eae5e9106f42924a146eeed7ae7234a6d34f6f5fdae62e65a6e": 8,  # pythonfmu 0.7.0, Windows
}


def pack_python(case: Case, identifier: str) -> dict[str, bytes]:
    """The files of an FMU on pythonfmu's runtime: path in the FMU → content."""
    code = pack_code()

    def numbers(guid: str) -> dict[str, bytes]:
        packed = {
            "guid": guid,
            "log_switch": log_switch(),
            "structure": case.structure,
            "start": start_values(case),
            "bit_diameter": case.bit_diameter,
            "survey": asdict(case.survey),
            "ground": case.ground and asdict(case.ground),
        }
        return {**describe(case, identifier, guid), "resources/fmu.json": json.dumps(packed, indent=1).encode()}

    guid = identify({**code, **numbers(guid="")})
    return {**numbers(guid), **code, **pack_runtime(identifier), **pack_manual(case, identifier, "python")}


def pack_code() -> dict[str, bytes]:
    """The core and the slave in one package, and the script that starts the slave.

    An embedded interpreter tells modules apart by name alone. So the names of both contain a hash of their content, and
    several FMUs in one process each run their own code.
    """
    moved = {
        "from boreprop.core.": "from .",
        "from boreprop_fmu.python.": "from .",
        "from pythonfmu.": f"from {base_class()[0]}.",
    }
    core = read_modules("boreprop.core")
    for name, content in read_modules("boreprop_fmu.python").items():
        if name != "__init__.py":
            text = content.decode()
            for before, after in moved.items():
                text = text.replace(before, after)
            core[name] = text.encode()
    package = f"boreprop_core_{digest(core)[:16]}"
    script = SCRIPT.format(package=package).encode()
    module = f"boreprop_slave_{digest({package: script})[:16]}"
    return {
        "resources/slavemodule.txt": module.encode(),
        f"resources/{module}.py": script,
        **{f"resources/{package}/{name}": content for name, content in core.items()},
    }


def pack_runtime(identifier: str) -> dict[str, bytes]:
    """The parts of pythonfmu: the binaries, under the FMU's name, and the base class of the slave."""
    package, modules = base_class()
    archive = {f"resources/{package}/{name}": content for name, content in modules.items()}
    for platform in files("pythonfmu").joinpath("resources/binaries").iterdir():
        for binary in platform.iterdir():
            archive[f"binaries/{platform.name}/{identifier}{Path(binary.name).suffix}"] = binary.read_bytes()
    return archive


def log_switch() -> int:
    """How far into pythonfmu's logger it remembers loggingOn, bytes; 0 if that is not known of all its binaries."""
    folders = files("pythonfmu").joinpath("resources/binaries").iterdir()
    binaries = [binary.read_bytes() for folder in folders for binary in folder.iterdir()]
    places = {LOG_SWITCH.get(sha256(binary).hexdigest(), 0) for binary in binaries}
    return places.pop() if len(places) == 1 else 0


def base_class() -> tuple[str, dict[str, bytes]]:
    """The name and the modules of a package with pythonfmu's base class. Its name contains a hash, too.

    pythonfmu's `__init__` is replaced by an empty one: it would import the builder whenever an FMU starts.
    """
    modules = read_modules("pythonfmu")
    needed = {"__init__.py": b"", **{f"{name}.py": modules[f"{name}.py"] for name in RUNTIME_MODULES}}
    return f"boreprop_slave_base_{digest(needed)[:16]}", needed


def read_modules(package: str) -> dict[str, bytes]:
    """The modules of `package`: file name → source."""
    return {path.name: path.read_bytes() for path in files(package).iterdir() if path.name.endswith(".py")}
