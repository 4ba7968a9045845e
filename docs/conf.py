"""How Sphinx builds the documentation: ``make docs``.

Nothing is fetched when it is built, and a page needs no network to be read.
"""

import os
import re
import sys
from pathlib import Path

from numpydoc import xref

import boreprop

HERE = Path(__file__).parent
sys.path.insert(0, str(HERE))
# What tutorials run: the commands of this environment, the notebook kernel of this interpreter, tables of one width.
os.environ["PATH"] = os.pathsep.join((str(Path(sys.executable).parent), os.environ["PATH"]))
os.environ["COLUMNS"] = "88"
os.environ["NO_COLOR"] = "1"

project = "boreprop"
author = "The boreprop authors"
copyright = author
version = release = boreprop.__version__

extensions = ["myst_nb", "sphinx.ext.autodoc", "numpydoc", "sphinx_parts"]
exclude_patterns = ["build"]
nitpicky = True
nitpick_ignore_regex = [  # types of other projects, whose documentation is not fetched
    ("py:.*", r"(python:|pathlib|collections\.abc|concurrent|numpy|rerun|Dataset|DataArray).*"),
]
nitpick_ignore = [  # not for scripts
    ("py:class", "boreprop.analysis.stability.characteristic.Characteristic"),
    ("py:class", "boreprop.core.ground.Ground"),
    ("py:class", "boreprop.core.quantities.Structure"),
]
default_role = "code"
suppress_warnings = ["mystnb.unknown_mime_type"]

myst_enable_extensions = ["dollarmath", "deflist", "colon_fence", "attrs_inline", "attrs_block"]
myst_heading_anchors = 3

nb_execution_mode = "force"
nb_execution_in_temp = True  # a tutorial finds an empty folder, and leaves nothing behind
nb_execution_raise_on_error = True
nb_execution_timeout = 120

autodoc_member_order = "bysource"
autodoc_typehints = "signature"
autodoc_typehints_format = "short"
python_use_unqualified_type_names = True
python_maximum_signature_line_length = 80
numpydoc_show_class_members = False
numpydoc_xref_param_type = True
numpydoc_xref_ignore = "all"
numpydoc_xref_aliases = {
    name: f"{module}{name}"
    for module, name in [
        *(("boreprop.", name) for name in boreprop.__all__ if name != "__version__"),
        *re.findall(r"^\.\. autoclass:: (boreprop\.\S+\.)(\w+)$", (HERE / "api.md").read_text("utf-8"), re.MULTILINE),
    ]
}
xref.DEFAULT_LINKS.clear()  # to the documentation of Python and numpy, which is not fetched

html_theme = "furo"
html_title = f"boreprop {release}"
html_static_path = ["style"]
html_css_files = ["style.css"]
html_copy_source = False
html_show_copyright = False
html_math_renderer = "mathml"
