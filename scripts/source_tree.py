"""The files of the tree that the checks beside this module read, and how they report."""
import pathlib
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent


def files(root=ROOT, suffixes=None):
    """Paths relative to the root: tracked ones and new ones that git does not ignore; without git, all but hidden ones and builds."""
    command = ["git", "-c", f"safe.directory={root}", "-C", str(root), "ls-files", "-z", "--cached", "--others", "--exclude-standard"]
    found = subprocess.run(command, capture_output=True, text=True) if (root / ".git").exists() else None
    if found and found.returncode == 0:
        names = {name for name in found.stdout.split("\0") if name}
    else:
        names = {str(p.relative_to(root)) for p in root.rglob("*")}
        names = {n for n in names if not n.startswith("build/") and not any(part.startswith(".") for part in n.split("/"))}
    return sorted(n for n in names if (root / n).is_file() and (suffixes is None or n.endswith(suffixes)))


def lines(name, root=ROOT):
    """(line number from 1, text) of a file; bytes that are not UTF-8 are replaced."""
    return enumerate((root / name).read_text(encoding="utf-8", errors="replace").splitlines(), start=1)


def finish(check, findings, checked):
    """Prints the findings as file:line: text, then a summary; exits with 1 when there are any."""
    for finding in findings:
        print(finding)
    print(f"{check}: {checked} files, {len(findings)} finding{'' if len(findings) == 1 else 's'}")
    sys.exit(1 if findings else 0)
