"""Instructions that the program executes for two small frames, against those of recorded.json: at most 10 % more.

Seconds depend on the computer and on what else runs there; instructions hardly do. So a feature that costs frames that
do not use it is seen here. callgrind counts the whole process: reading the machine, building it, simulating and writing
the picture.

  instructions_test.py PROGRAM COMPILER            compares; exit status 77 if another compiler made recorded.json
  instructions_test.py PROGRAM COMPILER --record   writes recorded.json; do this when a change is worth its instructions

COMPILER is the name and version of what compiled PROGRAM, as CMake has them. CMake's test says how it calls this:
ctest --preset release -R instructions -V
"""
import argparse
import json
import os
import pathlib
import re
import subprocess
import sys
import tempfile

RECORDED = pathlib.Path(__file__).with_name("recorded.json")
FRAMES = ["builtin:triangle --size 480x270", "builtin:cubes --size 256x144"]
BOUND = 1.10
SKIPPED = 77


def instructions(program, frame, folder):
    """What callgrind counts while the program renders the frame."""
    counts = pathlib.Path(folder, "callgrind.out")
    command = ["valgrind", "--tool=callgrind", f"--callgrind-out-file={counts}"]
    command += [program, "render", *frame.split(), "--out", str(pathlib.Path(folder, "frame.png"))]
    # The size of the environment moves the stack; a fixed one leaves nothing to chance.
    environment = {"PATH": os.environ["PATH"], "SYSTEMC_DISABLE_COPYRIGHT_MESSAGE": "1"}
    try:
        done = subprocess.run(command, env=environment, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    except FileNotFoundError:
        sys.exit("valgrind is not installed; scripts/setup installs it")
    if done.returncode != 0:
        sys.exit(f"{' '.join(command)} exits with {done.returncode}:\n{done.stdout}")
    return int(re.search(r"^summary: (\d+)$", counts.read_text(), re.MULTILINE).group(1))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program")
    parser.add_argument("compiler")
    parser.add_argument("--record", action="store_true")
    arguments = parser.parse_args()
    recorded = {} if arguments.record else json.loads(RECORDED.read_text())
    if recorded and recorded["compiler"] != arguments.compiler:
        print(f"skipped: recorded.json is of {recorded['compiler']}, and this program of {arguments.compiler}")
        return SKIPPED
    with tempfile.TemporaryDirectory() as folder:
        counted = {frame: instructions(arguments.program, frame, folder) for frame in FRAMES}
    if arguments.record:
        RECORDED.write_text(json.dumps({"compiler": arguments.compiler, "instructions": counted}, indent=2) + "\n")
        return 0
    too_many = False
    for frame, count in counted.items():
        before = recorded["instructions"][frame]
        over = count > BOUND * before
        too_many = too_many or over
        print(f"{frame}: {count:,} instructions, {100 * (count / before - 1):+.2f} % of the recorded {before:,}"
              + (f": more than {100 * (BOUND - 1):.0f} % over" if over else ""))
    if too_many:
        print("if the change is worth it, record the new counts with --record, and say in the commit why")
    return 1 if too_many else 0


if __name__ == "__main__":
    sys.exit(main())
