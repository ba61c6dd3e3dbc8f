#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Makes the documentation's site in BUILD/site, from docs/, the public headers, the Python module and the program's own help.
# usage: docs/build.sh [BUILD]      BUILD: where the program was built, build/ unless given
# Needs what './setup --docs' installs. The site opens from disk (BUILD/site/index.html) and loads nothing from elsewhere.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd -P)
exec /usr/bin/python3 "$root/docs/site/build.py" "${1-$root/build}"
