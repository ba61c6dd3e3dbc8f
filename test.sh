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
ctest --test-dir "$build" --output-on-failure --no-tests=error --parallel "$(nproc)" --output-junit "$build/ctest.xml" || failed=1

[ $# -gt 0 ] || set -- --quick
/usr/bin/python3 "$root/tests/acceptance.py" --summary "$build/acceptance.txt" "$@" || failed=1
/usr/bin/python3 "$root/tests/hard_set.py" --quick --summary "$build/hard_set.txt" || failed=1

# The sum of all, as one closing line.
count() { sed -n "s/.*[^a-z]$1=\"\([0-9]*\)\".*/\1/p;T;q" <(tr '\n\t' '  ' <"$build/ctest.xml" | grep -o '<testsuite [^>]*>'); }
read -r passed broken skipped < <(awk '{p += $1; f += $2; s += $3} END {print p, f, s}' "$build/acceptance.txt" "$build/hard_set.txt")
ctest_skipped=$(($(count skipped) + $(count disabled)))
ctest_failed=$(count failures)
passed=$((passed + $(count tests) - ctest_failed - ctest_skipped))
broken=$((broken + ctest_failed))
skipped=$((skipped + ctest_skipped))
[ "$failed" = 0 ] || [ "$broken" -gt 0 ] || broken=1
echo "$passed passed, $broken failed, $skipped skipped"
exit "$failed"
