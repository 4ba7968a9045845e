"""The files that a hosting service reads: each after its schema, and workflows without what would be a weakness."""

import sys

from lint_c import run
from places import ROOT

GITHUB = ROOT / ".github"
SCHEMAS = {
    "custom.github-workflows-require-timeout": "workflows/*.yml",
    "vendor.github-workflows": "workflows/*.yml",
    "vendor.dependabot": "dependabot.yml",
    "vendor.github-issue-config": "ISSUE_TEMPLATE/config.yml",
    "vendor.github-issue-forms": "ISSUE_TEMPLATE/[!c]*.yml",
    "vendor.citation-file-format": "../CITATION.cff",
}


def main() -> int:
    """The command."""
    failures = run("zizmor", "--offline", "--quiet", GITHUB)  # offline: nothing is asked of the service
    for schema, pattern in SCHEMAS.items():
        failures += run("check-jsonschema", "--builtin-schema", schema, *sorted(GITHUB.glob(pattern)))
    return int(failures > 0)


if __name__ == "__main__":
    sys.exit(main())
