#!/usr/bin/env python3
"""A sweep is killed 50 times at random moments and goes on each time: what was committed stays, is not drawn again, and is what an undisturbed run says."""
import pathlib
import random
import sqlite3
import subprocess
import sys
import tempfile
import time

PROGRAM = sys.argv[1]
KILLS = 50
SWEEP = """
[[scene]]
file = "builtin:triangle"
size = "24x24"
[vary]
gpu.cores = [1, 2, 3, 4]
l2.cache_lines = { from = 512, to = %d, step = 16 }
"""


def rows(path):
    """Committed points: what they are, when they ended, and their cycles."""
    if not path.exists():
        return {}
    database = sqlite3.connect(path)
    try:
        return {row[:2]: row[2:] for row in database.execute("SELECT scene_hash, machine_hash, finished, status, cycles FROM points")}
    except sqlite3.OperationalError as error:  # killed before it made its tables
        assert "no such table" in str(error), error
        return {}
    finally:
        database.close()


def command(name):
    return [PROGRAM, "explore", name, "--jobs", "2"]


def main():
    chance = random.Random(20)
    with tempfile.TemporaryDirectory() as scratch:
        folder = pathlib.Path(scratch)
        (folder / "sweep.toml").write_text(SWEEP % 4096)  # 900 machines
        results = folder / "sweep.db"
        known, kills = {}, 0
        while kills < KILLS:
            process = subprocess.Popen(command("sweep.toml"), cwd=folder, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
            # At any moment: while it starts, or after so many points more, and somewhat later. How fast the host is does not matter.
            more = chance.randrange(14)
            while more > 0 and len(rows(results)) < len(known) + more and process.poll() is None:
                time.sleep(0.005)
            time.sleep(chance.uniform(0, 0.04 if more else 0.3))
            if process.poll() is not None:
                sys.exit(f"the sweep ended by itself ({process.returncode}) after {kills} kills: {len(known)} points")
            process.kill()
            process.wait()
            kills += 1
            now = rows(results)
            lost = {key for key in known if now.get(key) != known[key]}
            assert not lost, f"{len(lost)} points were lost or drawn again after kill {kills}"
            known = now
        print(f"{kills} kills, {len(known)} points committed")
        assert 0 < len(known) < 900, "the kills came before the first point, or after the last"
        # What is left is drawn on a small part of the machines, and undisturbed.
        (folder / "part.toml").write_text(SWEEP % 704)
        for out in (["--out", "sweep.db"], ["--out", "other.db"]):
            subprocess.run(command("part.toml") + out, cwd=folder, check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        after, other = rows(results), rows(folder / "other.db")
        assert all(after[key] == known[key] for key in known), "a point that was committed changed"
        assert len(other) == 52
        for key, (_, status, cycles) in other.items():
            assert status == "done" and after[key][1:] == (status, cycles), "a point differs from that of an undisturbed run"
        database = sqlite3.connect(results)
        assert database.execute("PRAGMA integrity_check").fetchone() == ("ok",)
        database.close()


main()
