#!/usr/bin/env bash
# The programs of examples/ link the installed package and do what they say.
#   examples_test.sh BUILD_FOLDER ROOT
set -euo pipefail
build=$1 root=$2
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cmake --install "$build" --prefix "$folder/installed" >"$folder/install.log" || { cat "$folder/install.log"; exit 1; }
# Nothing of the tree may be needed: the examples are copied out of it.
cp -r "$root/examples" "$folder/examples"
cmake -G Ninja -S "$folder/examples" -B "$folder/build" -DCMAKE_PREFIX_PATH="$folder/installed" -DCMAKE_BUILD_TYPE=Release >"$folder/configure.log" ||
  { cat "$folder/configure.log"; exit 1; }
cmake --build "$folder/build" -j 2
ctest --test-dir "$folder/build" --output-on-failure
"$folder/installed/bin/quadrille" render builtin:triangle --size 64x48 --out "$folder/triangle.png" --quiet
test -s "$folder/triangle.png"
