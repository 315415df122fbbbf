# Sourced by the scripts beside it: goes to the root of the tree, whatever directory the caller is in, and times the steps.
set -euo pipefail
script=$(cd "$(dirname "$0")" && pwd -P)/${0##*/}
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd -P)
cd "$root"

# A clone that belongs to another user (a container's mount, a CI checkout) is still ours to list.
config_index=${GIT_CONFIG_COUNT:-0}
export "GIT_CONFIG_KEY_$config_index=safe.directory" "GIT_CONFIG_VALUE_$config_index=$root" "GIT_CONFIG_COUNT=$((config_index + 1))"

# Processors to use; QUADRILLE_JOBS overrides.
jobs=${QUADRILLE_JOBS:-$(nproc)}

fail() { echo "${0##*/}: $*" >&2; exit 1; }

# step NAME COMMAND...: runs the command under a heading and prints what it took. Returns the command's status.
step() {
  local name=$1 started=$SECONDS status=0
  shift
  printf '\n== %s\n' "$name"
  "$@" || status=$?
  printf '== %s: %s in %d s\n' "$name" "$([ "$status" = 0 ] && echo ok || echo "FAILED ($status)")" $((SECONDS - started))
  return "$status"
}

# The C++ files of the tree, tracked or new; in an unpacked archive without git, those of the source folders.
cpp_files() {
  if git rev-parse --is-inside-work-tree >/dev/null 2>&1; then
    git ls-files --cached --others --exclude-standard -- '*.h' '*.cpp' | while read -r file; do
      if [ -f "$file" ]; then echo "$file"; fi
    done
  else
    find models hw pipeline traces scenes studies cli tests -name '*.h' -o -name '*.cpp' | sort
  fi
}

# The comment at the top of the script, as its help.
usage() { sed -n '2,/^[^#]/s/^# \{0,1\}//p' "$script"; }

# build PRESET [TARGET...]: configures (quietly, unless that fails) and builds one of the presets of CMakePresets.json.
build() {
  local preset=$1 configured quiet=()
  shift
  [ -t 1 ] || quiet=(-- --quiet)   # ninja's progress is for a terminal; warnings and errors show either way
  configured=$(cmake --preset "$preset" 2>&1) || { echo "$configured" >&2; return 1; }
  cmake --build --preset "$preset" -j "$jobs" ${1:+--target "$@"} "${quiet[@]}"
}
