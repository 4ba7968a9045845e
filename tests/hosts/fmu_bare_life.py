"""Takes an unpacked FMU through every call of FMI 2.0 co-simulation that it answers, with the standard library alone.

python -I -S fmu_bare_life.py DIRECTORY → JSON on stdout: statuses, and which modules of others got imported
"""

import json
import sys
from ctypes import (
    CFUNCTYPE,
    POINTER,
    PyDLL,
    Structure,
    byref,
    c_char,
    c_char_p,
    c_double,
    c_int,
    c_size_t,
    c_uint,
    c_void_p,
)
from math import nan
from pathlib import Path
from xml.etree.ElementTree import fromstring

Logger = CFUNCTYPE(None, c_void_p, c_char_p, c_int, c_char_p, c_char_p)


class Callbacks(Structure):
    _fields_ = [
        ("logger", Logger),
        ("allocate", c_void_p),
        ("free", c_void_p),
        ("finished", c_void_p),
        ("environment", c_void_p),
    ]


directory = Path(sys.argv[1]).absolute()
description = fromstring((directory / "modelDescription.xml").read_bytes())
reference = {
    v.attrib["name"]: int(v.attrib["valueReference"]) for v in description.iterfind("ModelVariables/ScalarVariable")
}
log: list[str] = []
statuses: list[int] = []
callbacks = Callbacks(logger=Logger(lambda *arguments: log.append(arguments[4].decode())))
fmu = PyDLL(str(directory / "binaries" / "linux64" / "Borehole.so"))  # keeps the lock, which the FMU asks for again
fmu.fmi2Instantiate.restype = c_void_p
fmu.fmi2Instantiate.argtypes = [c_char_p, c_int, c_char_p, c_char_p, POINTER(Callbacks), c_int, c_int]
guid, resources = description.attrib["guid"].encode(), (directory / "resources").as_uri().encode()
component = c_void_p(fmu.fmi2Instantiate(b"bare", 1, guid, resources, byref(callbacks), 0, 1))


def call(name: str, *arguments: object) -> None:
    statuses.append(getattr(fmu, name)(component, *arguments))


def start() -> None:
    call("fmi2SetupExperiment", 0, c_double(0.0), c_double(0.0), 0, c_double(0.0))
    call("fmi2SetString", byref(c_uint(reference["survey_file"])), c_size_t(1), byref(c_char_p(b"")))
    call("fmi2EnterInitializationMode")
    call("fmi2ExitInitializationMode")


def put(name: str, value: float) -> None:
    call("fmi2SetReal", byref(c_uint(reference[name])), c_size_t(1), byref(c_double(value)))


def real(name: str) -> float:
    value = c_double()
    call("fmi2GetReal", byref(c_uint(reference[name])), c_size_t(1), byref(value))
    return value.value


def drill(first: int, last: int) -> float:
    for k in range(first, last):
        put("rss_force", 100.0 * k)
        call("fmi2DoStep", c_double(k * 0.5), c_double(0.5), 1)
    return real("bit_inclination")


start()
drill(0, 20)
contact, text = c_int(), c_char_p()
call("fmi2GetInteger", byref(c_uint(reference["stabilizer_contact[1]"])), c_size_t(1), byref(contact))
call("fmi2GetString", byref(c_uint(reference["survey_file"])), c_size_t(1), byref(text))

kept, size = c_void_p(), c_size_t()
call("fmi2GetFMUstate", byref(kept))
call("fmi2SerializedFMUstateSize", kept, byref(size))
content = (c_char * size.value)()
call("fmi2SerializeFMUstate", kept, content, size)
inclinations, drilled = [drill(20, 40)], [real("drilled_length")]
call("fmi2SetFMUstate", kept)
inclinations.append(drill(20, 40))
call("fmi2FreeFMUstate", byref(kept))
call("fmi2DeSerializeFMUstate", content, size, byref(kept))
call("fmi2SetFMUstate", kept)
call("fmi2FreeFMUstate", byref(kept))
inclinations.append(drill(20, 40))

put("rss_force", nan)
refused = fmu.fmi2DoStep(component, c_double(20.0), c_double(0.5), 1)
call("fmi2Reset")
start()
inclinations.append(drill(0, 40))
drilled.append(real("drilled_length"))
call("fmi2Terminate")
fmu.fmi2FreeInstance.restype = None
fmu.fmi2FreeInstance(component)
foreign = [
    name
    for name in sys.modules
    if name.partition(".")[0] not in {*sys.stdlib_module_names, "__main__"} and not name.startswith("boreprop_")
]
report = {"statuses": statuses, "refused": refused, "log": log, "drilled": drilled, "foreign": foreign}
print(json.dumps({**report, "repeated": len(set(inclinations)) == 1}))
