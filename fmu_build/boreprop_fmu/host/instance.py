"""Loads an FMU through fmpy: reads its description, and opens an instance of it safely in this process."""

from collections import deque
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from signal import Signals, getsignal, raise_signal, signal
from threading import current_thread, main_thread
from typing import Any

import fmpy
from fmpy.fmi1 import FMICallException
from fmpy.fmi2 import FMU2Slave, defaultCallbacks, fmi2CallbackFunctions, fmi2CallbackLoggerTYPE, fmi2Fatal, fmi2Warning

from boreprop.case.archive import open_archive
from boreprop.errors import InputError
from boreprop.kernel.compiler import host_platform
from boreprop.leftovers import temporary_folder

KIND = "FMI 2.0 co-simulation FMU"


def read_description(fmu: Path) -> Any:
    """Read modelDescription.xml; `InputError` unless it is that of a sound FMI 2.0 co-simulation FMU."""
    with open_archive(fmu, KIND):
        pass
    try:
        description = fmpy.read_model_description(fmu)
    except Exception as error:  # fmpy raises what its parsers raise
        reason = getattr(error, "strerror", None) or error
        raise InputError(f"{fmu}: must be an {KIND}, got: {reason}") from error
    if description.fmiVersion != "2.0" or description.coSimulation is None:
        kind = "without co-simulation" if description.coSimulation is None else "for co-simulation"
        raise InputError(f"{fmu}: must be an {KIND}, got: FMI {description.fmiVersion} {kind}")
    return description


@contextmanager
def open_instance(
    fmu: Path,
    description: Any,
    messages: deque[str],
    *,
    start: float,
    stop: float,
    platform: str | None = None,
    warn: Callable[[str], None] = lambda _: None,
) -> Iterator[Any]:
    """Yield an instance of an FMU in initialization mode; terminate and free it at the end. This runs the FMU's code.

    Parameters
    ----------
    fmu, description
        The FMU, and its description from `read_description`.
    messages
        The lines of the instance's log but warnings are appended to it.
    start, stop
        Start and end of the experiment, s.
    platform
        The folder in binaries/ from which the library is taken, named as in FMI 2.0.4. None: that of this machine.
    warn
        Called with each warning in the instance's log.

    Raises
    ------
    InputError
        If the FMU cannot be loaded here.
    FMICallException
        If a call fails.
    """
    callbacks = _log_to(messages, warn)
    identifier = description.coSimulation.modelIdentifier
    with temporary_folder("boreprop-fmu-") as folder:
        directory = str(folder)
        with open_archive(fmu) as archive:
            archive.extractall(directory)
        if Path(directory, "resources", "slavemodule.txt").exists():
            _check_readable(directory)
        slave: Any = None
        dead, handlers = False, interruptions()
        try:
            with uninterrupted(handlers):
                try:
                    made = FMU2Slave(
                        instanceName=fmu.stem,
                        guid=description.guid,
                        modelIdentifier=identifier,
                        unzipDirectory=directory,
                        libraryPath=_library(directory, identifier, platform or host_platform()),
                    )
                    made.instantiate(callbacks=callbacks, loggingOn=True)
                except Exception as error:  # a plain one if, say, there is no binary for this platform
                    reason = " ".join(messages) or error
                    raise InputError(f"{fmu}: must load on this machine, got: {reason}") from error
                slave = made
                slave.setupExperiment(startTime=start, stopTime=stop)
                slave.enterInitializationMode()
            yield slave
            with uninterrupted(handlers):
                slave.terminate()
        except FMICallException as error:
            dead = error.status == fmi2Fatal  # FMI then forbids all further calls
            raise
        finally:
            if slave and not dead:
                slave.fmi2FreeInstance(slave.component)
                _release_runtime(slave.dll)
                slave.freeLibrary()


def _log_to(messages: deque[str], warn: Callable[[str], None]) -> fmi2CallbackFunctions:
    """Callbacks for an instance that logs to `messages`, or warns; they must be kept as long as the instance."""

    def log(*arguments: Any) -> None:  # environment, instance, status, category, message
        line = arguments[4].decode(errors="replace").replace("%%", "%").replace("##", "#")
        if arguments[2] == fmi2Warning:
            warn(line)
        else:
            messages.append(line)

    return fmi2CallbackFunctions(
        logger=fmi2CallbackLoggerTYPE(log),
        allocateMemory=defaultCallbacks.allocateMemory,
        freeMemory=defaultCallbacks.freeMemory,
    )


def _library(directory: str, identifier: str, platform: str | None) -> str | None:
    """The binary in the folder that FMI 2.0.4 names; None if there is none, and fmpy chooses a folder."""
    library = Path(directory, "binaries", platform or "", f"{identifier}{fmpy.sharedLibraryExtension}")
    return str(library) if platform and library.exists() else None


def interruptions() -> dict[int, Any]:
    """Ctrl-C, and the signals that ask for the end, with their handlers, as far as this thread handles them."""
    if current_thread() is not main_thread():  # only the main thread is interrupted
        return {}
    handlers = {number: getsignal(number) for number in Signals if number.name in ("SIGINT", "SIGTERM", "SIGHUP")}
    return {number: handler for number, handler in handlers.items() if callable(handler)}


@contextmanager
def uninterrupted(handlers: Mapping[int, Any]) -> Iterator[None]:
    """Delay some signals, given with their handlers, until the end of a call.

    An FMU with Python in it would take what a handler raises for an error of its own.
    """
    received: list[int] = []
    for number in handlers:
        signal(number, lambda number, _: received.append(number))
    try:
        yield
    finally:
        for number, handler in handlers.items():
            signal(number, handler)
    if received:
        raise_signal(received[0])


def _check_readable(directory: str) -> None:
    """Raise `InputError` if the name of a directory is not plain ASCII, since pythonfmu would crash on it."""
    if "%" in Path(directory).as_uri().replace("%20", " "):
        raise InputError(
            "TMPDIR: the temporary directory must have a plain ASCII name, or the FMU be built with --runtime native, "
            f"got {directory}"
        )


def _release_runtime(library: Any) -> None:
    """Free the static state of pythonfmu's library: at exit it would be freed twice, which may abort the process."""
    if hasattr(library, "finalizePythonInterpreter"):  # in a host that is Python, it does not end the interpreter
        library.finalizePythonInterpreter()
