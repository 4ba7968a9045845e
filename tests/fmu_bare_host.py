"""Steps an unpacked FMU with nothing but the standard library; run it with python -I -S. Prints what got imported."""

import ctypes
import json
import sys
from ctypes import CFUNCTYPE, POINTER, Structure, byref, c_char_p, c_double, c_int, c_size_t, c_uint, c_void_p
from pathlib import Path

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
messages: list[str] = []
callbacks = Callbacks(logger=Logger(lambda *arguments: messages.append(arguments[4].decode())))
# PyDLL keeps the interpreter's lock, which the FMU asks for again
fmu = ctypes.PyDLL(str(directory / "binaries" / "linux64" / "Borehole.so"))
fmu.fmi2Instantiate.restype = c_void_p
fmu.fmi2Instantiate.argtypes = [c_char_p, c_int, c_char_p, c_char_p, POINTER(Callbacks), c_int, c_int]
resources = (directory / "resources").as_uri().encode()
component = c_void_p(fmu.fmi2Instantiate(b"bare", 1, b"", resources, byref(callbacks), 0, 1))
fmu.fmi2SetupExperiment(component, 0, c_double(0.0), c_double(0.0), 0, c_double(0.0))
fmu.fmi2EnterInitializationMode(component)
fmu.fmi2ExitInitializationMode(component)
statuses = [fmu.fmi2DoStep(component, c_double(k * 0.5), c_double(0.5), 1) for k in range(40)]
drilled = c_double()
fmu.fmi2GetReal(component, byref(c_uint(3)), c_size_t(1), byref(drilled))
foreign = [
    name
    for name in sys.modules
    if name.partition(".")[0] not in {*sys.stdlib_module_names, "__main__", "pythonfmu"}
    and not name.startswith(("boreprop_core_", "boreprop_slave_"))
]
print(json.dumps({"statuses": statuses, "drilled": drilled.value, "foreign": foreign, "log": messages}))
