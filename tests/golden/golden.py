#!/usr/bin/env python3
"""Render-comparison tests: draws the scenes of tests/golden/scenes with the `toile` command and
compares them with tests/golden/reference by `toile compare`. See docs/golden_tests.md.

golden.py check   --toile PROGRAM --out DIR SCENE     one scene against its reference
golden.py differ  --toile PROGRAM --out DIR PAIR      two commands whose pictures must differ
golden.py broken  --toile PROGRAM --out DIR SCENE     its subject broken on purpose must be noticed
golden.py table   --toile PROGRAM --out DIR           how far each break is noticed, as a table
golden.py repeat  --toile PROGRAM --out DIR SCENE     same bytes for 0, 1 and 2 rasteriser threads
golden.py update  --toile PROGRAM --out DIR [SCENE..] makes the references anew (scripts/update-goldens)
"""
import argparse
import html
import json
import os
import pathlib
import re
import shlex
import shutil
import subprocess
import sys

HERE = pathlib.Path(__file__).resolve().parent
KEYS = {"about", "command", "other_command", "tolerance", "broken"}
TOLERANCE_KEYS = {"fail": 0.02, "fail_percent": 0.1, "max": 0.5}


def load(name, folder="scenes"):
    file = HERE / folder / f"{name}.json"
    scene = json.loads(file.read_text())
    unknown = set(scene) - KEYS
    if unknown or "command" not in scene:
        sys.exit(f"{file}: unknown or missing keys: {sorted(unknown) or 'command'}")
    tolerance = dict(TOLERANCE_KEYS, **scene.get("tolerance", {}))
    if set(tolerance) != set(TOLERANCE_KEYS):
        sys.exit(f"{file}: /tolerance: only {', '.join(TOLERANCE_KEYS)} are known")
    scene["tolerance"] = tolerance
    return scene


def moved(source, offset, out):
    """A copy of an OBJ file, moved by "x,y,z" metres."""
    offset = [float(v) for v in offset.split(",")]
    lines = []
    for line in (HERE / source).read_text().splitlines():
        words = line.split()
        if words and words[0] == "v":
            place = [float(w) + o for w, o in zip(words[1:4], offset)]
            line = "v " + " ".join(f"{v:.6f}" for v in place)
        lines.append(line)
    out.write_text("\n".join(lines) + "\n")
    return str(out)


def draw(toile, command, picture, threads=None):
    """{out}: the picture; {here}: this folder; {moved:FILE:x,y,z}: a moved mesh."""
    words = []
    for word in shlex.split(command):
        if word.startswith("{moved:"):
            _, source, offset = word.strip("{}").split(":")
            word = moved(source, offset, picture.with_suffix(".moved.obj"))
        words.append(word.replace("{out}", str(picture)).replace("{here}", str(HERE)))
    environment = dict(os.environ)
    if threads is not None:
        environment["LP_NUM_THREADS"] = str(threads)
    picture.unlink(missing_ok=True)
    done = subprocess.run([toile, *words], env=environment, capture_output=True, text=True)
    if done.returncode != 0 or not picture.exists():
        sys.exit(f"toile {shlex.join(words)}\nexit status {done.returncode}\n{done.stderr}")


def compare(toile, a, b, tolerance, difference):
    done = subprocess.run(
        [toile, "compare", str(a), str(b), "--fail", str(tolerance["fail"]), "--fail-percent",
         str(tolerance["fail_percent"]), "--max", str(tolerance["max"]), "--diff", str(difference)],
        capture_output=True, text=True)
    return done.returncode, (done.stdout + done.stderr).strip()


def write_page(out, name, scene, text):
    page = out / f"{name}.html"
    pictures = "".join(
        f'<figure><img src="{name}.{kind}.png" alt="{kind}"><figcaption>{title}</figcaption></figure>'
        for kind, title in (("new", "new"), ("reference", "reference"),
                            ("difference", "difference, 8 times as strong")))
    page.write_text(
        f"<!DOCTYPE html><meta charset='utf-8'><title>{name}</title><style>body{{font-family:"
        "sans-serif;background:#eee}section{display:flex;gap:1em}figure{margin:0}img{max-width:100%}"
        f"</style><h1>{name}</h1><p>{html.escape(scene.get('about', ''))}</p>"
        f"<p><code>toile {html.escape(scene['command'])}</code></p><p>{html.escape(text)}</p>"
        f"<section>{pictures}</section>\n")
    return page


def check(toile, out, name):
    scene = load(name)
    reference = HERE / "reference" / f"{name}.png"
    new = out / f"{name}.new.png"
    draw(toile, scene["command"], new)
    if not reference.exists():
        sys.exit(f"{reference}: no reference; look at {new}, then run scripts/update-goldens {name}")
    status, text = compare(toile, new, reference, scene["tolerance"], out / f"{name}.difference.png")
    print(text)
    if status != 0:
        shutil.copy(reference, out / f"{name}.reference.png")
        sys.exit(f"golden {name}: the picture changed; see {write_page(out, name, scene, text)}")


def differ(toile, out, name):
    pair = load(name, "must_fail")
    pictures = [out / f"{name}.{side}.png" for side in ("a", "b")]
    for picture, command in zip(pictures, (pair["command"], pair["other_command"])):
        draw(toile, command, picture)
    status, text = compare(toile, *pictures, pair["tolerance"], out / f"{name}.difference.png")
    print(text)
    if status != 1:
        sys.exit(f"golden {name}: these two pictures must be told apart, exit status is {status}")
    status, text = compare(toile, pictures[0], pictures[0], pair["tolerance"],
                           out / f"{name}.difference.png")
    if status != 0:
        sys.exit(f"golden {name}: a picture differs from itself: {text}")


def break_scene(toile, out, name):
    """Each way in which a scene is broken, and what the comparison with its reference says."""
    scene = load(name)
    reference = HERE / "reference" / f"{name}.png"
    for number, broken in enumerate(scene.get("broken", [])):
        if set(broken) not in ({"how", "add"}, {"how", "replace", "by"}):
            sys.exit(f"{name}: /broken/{number}: how, and either add, or replace and by")
        command = scene["command"]
        if "add" in broken:
            command += " " + broken["add"]
        elif broken["replace"] not in command:
            sys.exit(f"{name}: /broken/{number}: the command has no '{broken['replace']}'")
        else:
            command = command.replace(broken["replace"], broken["by"])
        picture = out / f"{name}.broken{number}.png"
        draw(toile, command, picture)
        status, text = compare(toile, picture, reference, scene["tolerance"],
                               out / f"{name}.broken{number}.difference.png")
        yield broken["how"], status, text


def check_broken(toile, out, name):
    if not load(name).get("broken"):
        sys.exit(f"golden {name}: /broken: says no way in which its subject can be broken")
    for how, status, text in break_scene(toile, out, name):
        print(f"{how}: {text}")
        if status != 1:
            sys.exit(f"golden {name}: not noticed: {how}")


def write_table(toile, out):
    rows = []
    for scene in sorted(p.stem for p in (HERE / "scenes").glob("*.json")):
        for how, status, text in break_scene(toile, out, scene):
            share = re.search(r"\(([0-9.]+) %\)", text)
            rows.append(f"| {scene} | {how} | {float(share.group(1)) if share else 100:.1f} | "
                        f"{'yes' if status == 1 else 'NO'} |")
    print("| scene | broken | pixels that differ, % | noticed |\n|---|---|---|---|")
    print("\n".join(rows))


def repeat(toile, out, name):
    scene = load(name)
    seen = {}
    for threads in (0, 1, 2, 2):
        picture = out / f"{name}.threads{threads}.png"
        draw(toile, scene["command"], picture, threads)
        seen[picture.read_bytes()] = threads
    if len(seen) != 1:
        sys.exit(f"golden {name}: other bytes with other numbers of threads")


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("mode", choices=("check", "differ", "broken", "table", "repeat", "update"))
    parser.add_argument("scenes", nargs="*")
    parser.add_argument("--toile", required=True)
    parser.add_argument("--out", required=True, type=pathlib.Path)
    options = parser.parse_intermixed_args()
    options.out.mkdir(parents=True, exist_ok=True)
    if options.mode == "update":
        names = options.scenes or sorted(p.stem for p in (HERE / "scenes").glob("*.json"))
        for name in names:
            draw(options.toile, load(name)["command"], HERE / "reference" / f"{name}.png")
            print(f"{name}: new reference")
        return
    if options.mode == "table":
        write_table(options.toile, options.out)
        return
    if not options.scenes:
        sys.exit("no scene named")
    for name in options.scenes:
        {"check": check, "differ": differ, "broken": check_broken, "repeat": repeat}[options.mode](
            options.toile, options.out, name)


if __name__ == "__main__":
    main()
