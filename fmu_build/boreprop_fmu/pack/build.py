"""Packs the model, as code and numbers, into an FMI 2.0 co-simulation FMU: on pythonfmu's runtime, or as machine code.

The archive is written here and not by pythonfmu's own builder, which imports the slave into the building process and
makes a different file every time. From pythonfmu come the binaries and the base class of the slave.
"""

import json
import zipfile
from collections.abc import Callable, Sequence
from dataclasses import asdict
from hashlib import sha256
from importlib.resources import files
from pathlib import Path
from uuid import UUID, uuid5

from boreprop.case.case import Case
from boreprop.case.file import dump_case
from boreprop.core.options import RELATIVE_TOLERANCE
from boreprop.core.quantities import BY_NAME
from boreprop.errors import InputError
from boreprop.replacing import replacing

from .description import model_description
from .documentation import documentation
from .icon import icon

IDENTIFIER = "Borehole"
CAPABILITIES = {
    "needsExecutionTool": False,
    "canHandleVariableCommunicationStepSize": True,
    "canBeInstantiatedOnlyOncePerProcess": False,
    "canNotUseMemoryManagementFunctions": True,
    "canGetAndSetFMUstate": True,
    "canSerializeFMUstate": True,
}
CASE_FILE = "resources/case.toml"
RUNTIME_MODULES = ("default_experiment", "enums", "fmi2slave", "logmsg", "variables", "_version")
GUID_NAMESPACE = UUID("6f0a3c1e-9d1b-5a55-8a0e-0d6c1f9f7b11")
STEP_SIZE = 0.1  # s, so 0.1 m at the start value of the rate of penetration
SCRIPT = '''"""What pythonfmu starts. It compiles this for every instance, and wants a class with methods of its own."""

from {package}.slave import Borehole as Slave


class Borehole(Slave):
    def __init__(self, **kwargs):
        super().__init__(**kwargs)

    def do_step(self, current_time, step_size):
        return super().do_step(current_time, step_size)
'''
EPOCH = (1980, 1, 1, 0, 0, 0)

RUNTIMES = ("python", "native")


def build_fmu(
    case: Case,
    output: Path,
    *,
    runtime: str = "python",
    platforms: Sequence[str] | None = None,
    progress: Callable[[float], None] | None = None,
) -> Path:
    """Write the FMU of `case` to `output` and return that path. Same case, same code: same bytes.

    Parameters
    ----------
    case
        What the FMU starts from.
    output
        The file.
    runtime
        What runs in the FMU: "python", for hosts that have a Python; "native", machine code and its C sources.
    platforms
        For a native FMU: what it has binaries for, of `boreprop.kernel.compiler.PLATFORMS`. None: this machine; empty:
        no binaries, only the sources.
    progress
        Called with the number of binaries compiled so far.

    Raises
    ------
    InputError
        If the runtime or a platform is unknown, there are platforms for Python, or nothing here compiles for one.
    OSError
        If the file cannot be written; nothing is left behind then.
    """
    if runtime not in RUNTIMES:
        raise InputError(f"runtime: must be {' or '.join(RUNTIMES)}, got {runtime!r}")
    if runtime == "native":
        from .native import pack_native

        archive = pack_native(case, platforms, progress)
    elif platforms is not None:
        raise InputError(f"platforms: must be left out for the runtime python, got {', '.join(platforms) or 'none'}")
    else:
        archive = pack_python(case)
    with replacing(output) as draft, zipfile.ZipFile(draft, "w") as fmu:
        for name in sorted(archive, key=lambda name: (name != "modelDescription.xml", name)):
            entry = zipfile.ZipInfo(name, EPOCH)
            entry.compress_type = zipfile.ZIP_DEFLATED
            entry.external_attr = 0o644 << 16
            fmu.writestr(entry, archive[name])
    return output


def pack_python(case: Case) -> dict[str, bytes]:
    """The FMU on pythonfmu's runtime."""
    code = pack_code()

    def numbers(guid: str) -> dict[str, bytes]:
        n = len(case.bha.stabilizer_positions)
        packed = {"guid": guid, "stabilizers": n, "start": start_values(case), "survey": asdict(case.survey)}
        return {**describe(case, guid), "resources/fmu.json": json.dumps(packed, indent=1).encode()}

    guid = identify({**code, **numbers(guid="")})
    return {**numbers(guid), **code, **pack_runtime(), **pack_manual(case, "python")}


def pack_code() -> dict[str, bytes]:
    """The core with the slave, and the script that starts it, each under a name that carries a hash of its content."""
    slave = files("boreprop_fmu.python").joinpath("slave.py").read_text(encoding="utf-8")
    slave = slave.replace("from boreprop.core.", "from .").replace("from pythonfmu.", f"from {base_class()[0]}.")
    core = {**read_modules("boreprop.core"), "slave.py": slave.encode()}
    package = f"boreprop_core_{digest(core)[:16]}"
    script = SCRIPT.format(package=package).encode()
    module = f"boreprop_slave_{digest({package: script})[:16]}"
    return {
        "resources/slavemodule.txt": module.encode(),
        f"resources/{module}.py": script,
        **{f"resources/{package}/{name}": content for name, content in core.items()},
    }


def describe(
    case: Case, guid: str, *, interpolates: bool = False, source_files: Sequence[str] = ()
) -> dict[str, bytes]:
    """The description, and the case file for whoever runs the FMU."""
    description = model_description(
        IDENTIFIER,
        guid,
        len(case.bha.stabilizer_positions),
        start_values(case),
        stop_time=case.length,
        step_size=STEP_SIZE,
        capabilities={**CAPABILITIES, "canInterpolateInputs": interpolates},
        source_files=source_files,
    )
    return {"modelDescription.xml": description, CASE_FILE: dump_case(case).encode()}


def identify(archive: dict[str, bytes]) -> str:
    """The guid of an FMU, from all that decides what it does."""
    return str(uuid5(GUID_NAMESPACE, digest(archive)))


def pack_runtime() -> dict[str, bytes]:
    """pythonfmu: the binaries under the FMU's name, and the base class of the slave."""
    package, modules = base_class()
    archive = {f"resources/{package}/{name}": content for name, content in modules.items()}
    for platform in files("pythonfmu").joinpath("resources/binaries").iterdir():
        for binary in platform.iterdir():
            archive[f"binaries/{platform.name}/{IDENTIFIER}{Path(binary.name).suffix}"] = binary.read_bytes()
    return archive


def pack_manual(case: Case, runtime: str) -> dict[str, bytes]:
    """What people see: the icon and the documentation."""
    return {"model.png": icon(), "documentation/index.html": documentation(case, runtime)}


def start_values(case: Case) -> dict[str, float | str]:
    """Start value of every input and parameter, by scalar name."""
    bha, bit = case.bha, case.bit
    n = len(bha.stabilizer_positions)
    return {
        "rss_force": case.schedule.rss_force[0],
        "active_weight_on_bit": case.active_weight_on_bit,
        "rate_of_penetration": 1.0,
        **dict(zip(BY_NAME["stabilizer_position"].names(n), bha.stabilizer_positions, strict=True)),
        **dict(zip(BY_NAME["stabilizer_clearance"].names(n), bha.stabilizer_clearances, strict=True)),
        "rss_position": bha.rss_position,
        "distributed_weight": bha.distributed_weight,
        "flexural_stiffness": bha.flexural_stiffness,
        "lateral_steering_resistance": bit.lateral_steering_resistance,
        "angular_steering_resistance": bit.angular_steering_resistance,
        "bit_tilt_limit": bit.tilt_limit,
        "relative_tolerance": RELATIVE_TOLERANCE,
        "survey_file": "",
    }


def base_class() -> tuple[str, dict[str, bytes]]:
    """A package with pythonfmu's base class and its name, which carries a hash too: the binaries ask for none.

    Without pythonfmu's `__init__`, which would load its builder whenever an FMU starts.
    """
    modules = read_modules("pythonfmu")
    needed = {"__init__.py": b"", **{f"{name}.py": modules[f"{name}.py"] for name in RUNTIME_MODULES}}
    return f"boreprop_slave_base_{digest(needed)[:16]}", needed


def read_modules(package: str) -> dict[str, bytes]:
    """Sources of the modules of `package`, by file name."""
    return {path.name: path.read_bytes() for path in files(package).iterdir() if path.name.endswith(".py")}


def digest(archive: dict[str, bytes]) -> str:
    """SHA-256 over names and contents, hexadecimal."""
    lines = (f"{sha256(content).hexdigest()} {name}\n" for name, content in sorted(archive.items()))
    return sha256("".join(lines).encode()).hexdigest()
