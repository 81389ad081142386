#!/bin/sh
# What `toile plugin` says and how it ends: plugin_command.sh TOILE LIBZOO
set -eu
toile=$1
library=$2
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT

fail() {
    echo "FAILED: $1" >&2
    cat "$folder/out" "$folder/err" >&2
    exit 1
}
add() {
    mkdir -p "$folder/$1"
    cp "$library" "$folder/$1/libzoo.so"
    cat > "$folder/$1/plugin.json" <<JSON
{"id": "zoo.animal", "version": "1.0.0", "abi": {"major": 1, "minor": 0},
 "library": "libzoo.so", "provides": ["toile.skinning/1"]}
JSON
}
# expect STATUS ARGUMENT...
expect() {
    wanted=$1
    shift
    status=0
    "$toile" "$@" > "$folder/out" 2> "$folder/err" || status=$?
    [ "$status" = "$wanted" ] || fail "toile $*: exit status $status, wanted $wanted"
}
says() { # says FILE TEXT
    grep -qF -- "$2" "$folder/$1" || fail "'$2' is not in std$1"
}

add good
expect 0 plugin check "$folder/good"
says out "good: zoo.animal 1.0.0 keeps the rules of toile.skinning/1"
[ ! -s "$folder/err" ] || fail "a good plugin is not silent on stderr"
expect 0 plugin check "$folder/good/libzoo.so"
expect 0 plugin list --plugins "$folder/good"
says out "loaded   zoo.animal 1.0.0: toile.skinning/1"

for animal in pose_nan pose_crashes init_hangs constructor_throws; do
    add $animal
    expect 1 plugin check "$folder/$animal" --timeout 2
    [ "$(wc -l < "$folder/err")" = 1 ] || fail "$animal: not one line"
    [ ! -s "$folder/out" ] || fail "$animal: something on stdout"
done
expect 1 plugin check "$folder/pose_nan"
says err "pose: returns numbers that are not finite [non_finite]"
expect 0 plugin list --plugins "$folder/constructor_throws"
says out "aborts in opening the library [aborted]"
expect 0 plugin list --json --plugins "$folder/constructor_throws"
says out '"reason": "aborted"'

expect 1 plugin check "$folder/nowhere"
expect 1 plugin list --plugins "$folder/nowhere"
expect 2 plugin check
expect 2 plugin check "$folder/good" --timeout -1
expect 2 plugin
