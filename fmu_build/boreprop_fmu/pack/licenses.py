"""The licenses of what is in an FMU, from the installed packages."""

from importlib.metadata import distribution

from boreprop.errors import InputError


def license_text(package: str) -> str:
    """The license of an installed package; `InputError` if the installation lacks it."""
    installed = distribution(package)
    for name in installed.metadata.get_all("License-File") or []:
        for place in (f"licenses/{name}", name):
            if text := installed.read_text(place):
                return text
    raise InputError(f"{package}: must be installed with its license, got none; install it again")


def copyright_line() -> str:
    """Who has the copyright of the model."""
    return next(line for line in license_text("boreprop").splitlines() if line.startswith("Copyright"))
