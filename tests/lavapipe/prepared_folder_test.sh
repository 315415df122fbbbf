#!/usr/bin/env bash
# A prepared folder measures on lavapipe with none of this machine's copies of its libraries, and its curves are set beside simulated ones.
# Usage: prepared_folder_test.sh SCRIPTS VULKAN_PROGRAM SIMULATING_PROGRAM
set -euo pipefail
scripts=$1 vulkan=$2 simulated=$3
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
folder=$scratch/prepared measured=$scratch/measured.json machine=$scratch/machine.json

fails() { echo "FAILED: $*"; exit 1; }
# refused COMMAND...: must exit with 2 and one line.
refused() {
  local said status=0
  said=$("$@" 2>&1 >/dev/null) || status=$?
  [ "$status" = 2 ] && [ "$(wc -l <<<"$said")" = 1 ] || fails "$*: exit code $status: $said"
}

"$scripts/measure_gpu" --prepare "$folder" --program "$vulkan"
"$folder/measure_gpu" --device llvmpipe --no-times --size 64x48 --out "$measured" thin-triangles -q 2>"$scratch/error" || {
  grep -q 'Vulkan: no' "$scratch/error" && { cat "$scratch/error"; exit 77; }
  cat "$scratch/error"
  fails "the prepared folder does not measure"
}
# Started with the libraries of the folder alone, each of them must come from there.
"$folder"/c/ld-linux* --library-path "$folder/c:$folder/cxx:$folder/lib" --list "$folder/quadrille_measure_vulkan" >"$scratch/libraries"
! grep '=> /' "$scratch/libraries" | grep -v "$folder/" || fails "libraries from elsewhere"
! grep 'not found' "$scratch/libraries" || fails "libraries are missing"

# Times, though they are not kept: the curves of both sides make a picture.
"$folder/measure_gpu" --device llvmpipe --repeats 3 --size 64x48 --out "$measured" thin-triangles back-to-front -q
"$simulated" --size 64x48 --out "$machine" thin-triangles back-to-front -q
"$scripts/plot_measurements" "$measured" "$machine" --table --out "$scratch/shapes.png" >"$scratch/table"
[ "$(head -c4 "$scratch/shapes.png" | tail -c3)" = PNG ] || fails "no picture"
grep -q '| back-to-front | 1 | 1 | 1 |' "$scratch/table" || { cat "$scratch/table"; fails "a curve does not begin with 1"; }

# Each point as a trace, and the picture that the driver draws of it.
"$simulated" --size 64x48 --traces "$scratch" setup-rate
[ -s "$scratch/setup-rate_off_screen.qtrace" ] || fails "no trace"
"$folder/measure_gpu" --device llvmpipe --repeats 1 --scene "$scratch/setup-rate_one_pixel.qtrace" --pictures "$scratch" --out "$measured" -q
picture=$scratch/scenes_setup-rate_one_pixel.ppm
[ "$(head -c 12 "$picture")" = "P6
64 48
255" ] && [ "$(wc -c <"$picture")" = $((13 + 3 * 64 * 48)) ] || fails "no picture of 64x48"
[ "$(tail -c 3 "$picture" | od -An -tu1 | tr -s ' ')" = ' 204 102 51' ] || fails "the last pixel is not of the triangles' colour"

refused "$folder/measure_gpu" --device 'no such card'
refused "$scripts/measure_gpu" --prepare
refused "$scripts/measure_gpu" --prepare "$scratch/other" --program /no/program
refused "$scripts/measure_gpu"
refused "$scripts/plot_measurements" "$measured"
refused "$scripts/plot_measurements" "$scratch/table" --table
"$simulated" --size 32x32 --out "$machine" thin-triangles -q
refused "$scripts/plot_measurements" "$measured" "$machine" --table
