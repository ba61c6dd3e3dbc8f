#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Installs what is missing, builds, and runs every test.
# usage: ./test.sh [OPTION ...]     options of tests/acceptance.py; without any, its quick part (--quick) is run
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd -P)
build=$root/build

"$root/setup" --tests
"$root/cmake/build.sh"

failed=0
rm -f "$build"/tests/unit_tests.*.xml
ctest --test-dir "$build" --output-on-failure --no-tests=error --parallel "$(nproc)" --output-junit "$build/ctest.xml" || failed=1

[ $# -gt 0 ] || set -- --quick
/usr/bin/python3 "$root/tests/acceptance.py" --summary "$build/acceptance.txt" "$@" || failed=1
/usr/bin/python3 "$root/tests/hard_set.py" --quick --summary "$build/hard_set.txt" || failed=1

# The sum of all, as one closing line.
/usr/bin/python3 "$root/tests/count.py" "$build" >"$build/ctest.txt"
read -r passed broken skipped < <(cd "$build" && awk '{p += $1; f += $2; s += $3} END {print p, f, s}' ctest.txt acceptance.txt hard_set.txt)
[ "$failed" = 0 ] || [ "$broken" -gt 0 ] || broken=1
echo "$passed passed, $broken failed, $skipped skipped"
exit "$failed"
