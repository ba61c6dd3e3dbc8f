# SPDX-License-Identifier: MIT
# Sphinx's configuration; docs/build.sh says what is put where.
import os
import sys

sys.path.insert(0, os.environ["ORBITUTTE_PYTHON_PATH"])

project = "orbitutte"
author = "the authors of orbitutte"
version = release = os.environ["ORBITUTTE_VERSION"]

extensions = ["myst_parser", "breathe", "sphinx.ext.autodoc", "sphinx.ext.napoleon"]
source_suffix = {".md": "markdown", ".rst": "restructuredtext"}
root_doc = "index"

# Markdown: pages are written for a code host, too, whose links to headings are these.
myst_heading_anchors = 3

# C++
breathe_projects = {"orbitutte": os.environ["ORBITUTTE_XML"]}
breathe_default_project = "orbitutte"
breathe_default_members = ("members", "undoc-members")
breathe_show_include = False

# Python
autodoc_member_order = "bysource"
autodoc_typehints = "none"  # the docstrings say them
autoclass_content = "class"
autodoc_class_signature = "separated"
napoleon_use_ivar = True
napoleon_use_rtype = False
python_use_unqualified_type_names = True
default_role = "py:obj"

# The page: nothing is loaded from elsewhere, and it opens from disk.
html_theme = "furo"
html_title = f"orbitutte {version}"
html_static_path = [os.path.join(os.path.dirname(__file__), "static")]
html_css_files = ["site.css"]
html_copy_source = False
html_show_copyright = False
html_show_search_summary = False  # which the search would fetch, and no page on disk may fetch another
html_show_sourcelink = False
html_theme_options = {"navigation_with_keys": True}
pygments_style = "friendly"


def escape_bars(_app, _what, _name, _object, _options, lines):
    """|G| is the order of a group in docstrings, and no substitution."""
    lines[:] = [line.replace("|G|", r"\|G\|") for line in lines]


def setup(app):
    app.connect("autodoc-process-docstring", escape_bars)
