#!/usr/bin/env bash
# same_rows.sh BEFORE AFTER SHARED_DATA: runs two builds of the program on the demo and on the footage of four_cameras,
# and compares the sessions row by row. What a run can't repeat is left out: its times of day and its id.
set -euo pipefail

declare -A program=([before]=$1 [after]=$2)
data=$3
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

rows() {
  sqlite3 "$1" .dump |
    sed -E "s/'[0-9]{4}-[0-9]{2}-[0-9]{2}T[0-9:]{8}Z'/TIME/g; /'recording\.id'/d"
}

write_trial() {
  cat >"$work/box.stl" <<'STL'
solid wedge
facet normal 0 0 0
outer loop
vertex 0 0 0
vertex 300 0 300
vertex 0 300 0
endloop
endfacet
facet normal 0 0 0
outer loop
vertex 0 0 0
vertex 0 300 0
vertex 0 0 300
endloop
endfacet
facet normal 0 0 0
outer loop
vertex 0 0 0
vertex 0 0 300
vertex 300 0 300
endloop
endfacet
facet normal 0 0 0
outer loop
vertex 300 0 300
vertex 0 0 300
vertex 0 300 0
endloop
endfacet
endsolid wedge
STL
  {
    printf 'unit = "mm"\n'
    printf '[[part]]\nname = "reaches_in"\nfile = "box.stl"\nposition_mm = [220, -250, 550]\n'
    printf '[[part]]\nname = "beside"\nfile = "box.stl"\nposition_mm = [220, 320, 550]\n'
  } >"$work/layout.toml"
  printf 'rig = "%s"\nlayout = "layout.toml"\n' "$(realpath "$data/four_cameras/rig.yml")" >"$work/trial.toml"
}

# compare NAME BEFORE.db AFTER.db
compare() {
  rows "$2" >"$work/before.rows"
  rows "$3" >"$work/after.rows"
  if ! cmp -s "$work/before.rows" "$work/after.rows"; then
    printf '%s: the rows differ\n' "$1" >&2
    diff "$work/before.rows" "$work/after.rows" | cut -c1-200 | head -20 >&2
    return 1
  fi
  printf '%s: %d rows, the same\n' "$1" "$(grep -c '^INSERT' "$work/after.rows")"
}

write_trial
differ=0
for side in before after; do
  "${program[$side]}" demo --headless --out "$work/demo_$side" >/dev/null
  [[ ! -d $data/four_cameras ]] ||
    "${program[$side]}" trial run "$work/trial.toml" --session "$work/footage_$side.db" --headless >/dev/null
done
compare demo "$work/demo_before/session.db" "$work/demo_after/session.db" || differ=1
if [[ -d $data/four_cameras ]]; then
  compare four_cameras "$work/footage_before.db" "$work/footage_after.db" || differ=1
else
  printf 'four_cameras: NOT COMPARED, no footage in %s\n' "$data" >&2
fi
exit "$differ"
