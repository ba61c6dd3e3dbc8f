#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# The man page and the completions have every command and option that `--help` prints, and no other.
# usage: tests/package/reference_test.sh BUILD
set -euo pipefail
build=$1
program=$build/orbitutte documents=$build/reference
failed=0
# usage: same WHAT EXPECTED FOUND
same() {
  [ "$2" = "$3" ] && return
  echo "FAILED: $1: expected '$2', found '$3'" >&2
  failed=1
}
in_one_line() { sort -u | tr '\n' ' '; }

# What --help prints: the names in front of the descriptions.
commands=$("$program" --help | sed -n '/^Subcommands:/,$s/^  \([a-z]*\) .*/\1/p')
options() { "$program" "$1" --help | sed -n 's/^  \(-[-a-zA-Z0-9,]*\).*/\1/p' | tr , '\n' | in_one_line; }
[ "$(wc -w <<<"$commands")" -ge 10 ] || same "commands of --help" "ten or more" "$commands"

# What the page has in the section of one command; -h and --help are in the page's own.
page_section() { sed -n "/^[.]SS $1\$/,/^[.]S[SH] /p" "$documents/orbitutte.1" | sed 's/\\-/-/g'; }
page_options() { { page_section "$1" | grep -A1 '^[.]TP' | grep -oE '\\fB-[-a-z0-9]+' | sed 's/\\fB//'; printf '%s\n' -h --help; } | in_one_line; }

# What bash completes after these words; the last one is being typed.
source "$documents/orbitutte.bash"
completed() {
  COMP_WORDS=("$@") COMP_CWORD=$(($# - 1))
  _orbitutte
  printf '%s\n' ${COMPREPLY[@]+"${COMPREPLY[@]}"} | in_one_line
}
zsh_options() {
  sed -n "/^        $1)\$/,/;;/p" "$documents/_orbitutte" | sed -n "s/^ *'(\(-[^)]*\)).*/\1/p" | tr ' ' '\n' | in_one_line
}
fish_options() {
  sed -n "s/.*__fish_seen_subcommand_from $1'\(.*\) -d .*/\1/p" "$documents/orbitutte.fish" |
    grep -oE -e '-(l|s) [-a-z0-9]+' | sed 's/^-l /--/; s/^-s /-/' | in_one_line
}

same "commands in the page" "$(in_one_line <<<"$commands")" "$(sed -n 's/^[.]SS //p' "$documents/orbitutte.1" | in_one_line)"
same "commands in bash" "$(printf '%s\n' $commands -h --help --version | in_one_line)" "$(completed orbitutte '')"
same "commands in fish" "$(in_one_line <<<"$commands")" "$(sed -n 's/.* -f -a \([a-z]*\) .*/\1/p' "$documents/orbitutte.fish" | in_one_line)"
for command in $commands; do
  expected=$(options "$command")
  same "options of $command in the page" "$expected" "$(page_options "$command")"
  same "options of $command in bash" "$expected" "$(completed orbitutte "$command" -)"
  same "options of $command in zsh" "$expected" "$(zsh_options "$command")"
  same "options of $command in fish" "$expected" "$(fish_options "$command")"
done

same "a command that was begun" "verify " "$(completed orbitutte ver)"
same "a value" "mean-value " "$(completed orbitutte embed mesh.ply --weights m)"
same "a value after =" "delaunay " "$(completed orbitutte embed mesh.ply --weights = d)"
same "every value after =" "cotan delaunay mean-value standard uniform " "$(completed orbitutte embed --weights =)"
# usage: completes_symbols WORD SYMBOL ...
completes_symbols() { same "symbols that begin with $1" "$(printf '%s\n' "${@:2}" | in_one_line)" "$(completed orbitutte embed mesh.ply --orbifold "$1")"; }
completes_symbols 2 222 2222 22 223 224 225 226 '2\*2' '2\*3' '2\*4' '2\*5' '2\*6' '2\*' 2x
completes_symbols '\*4' '\*432' '\*44' '\*442'
completes_symbols "'*4" '*432' '*44' '*442'
completes_symbols poly polygon
for shell in _orbitutte orbitutte.fish; do
  grep -q '532 432 332 222 .* \\\*532 .* 3\\\*2 .* 6x 1 \\\* 333 .* \\\*2222 polygon best' "$documents/$shell" || same "symbols in $shell" "532 ... polygon" "none"
done
same "a file" " " "$(completed orbitutte embed fig)"
if command -v groff >/dev/null; then
  same "groff's warnings" "" "$(groff -man -ww -T utf8 "$documents/orbitutte.1" 2>&1 >/dev/null)"
fi
[ "$failed" = 0 ] && echo "man page and completions: $(wc -w <<<"$commands") commands"
exit "$failed"
