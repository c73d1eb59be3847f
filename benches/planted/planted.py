#!/usr/bin/env python3
"""Tests which planted defects the claims detect: plants sixty random defects one by one and records the red results.

    python3 benches/planted/planted.py [--seed N] [--each 15] [--only-run] [--longest SECONDS]

A defect changes a sign, a factor, an index or a term of a sum. There are as many defects in grains on springs, in material
points, in scenes (with the code that resolves them and their probes) and in readers of files. One copy of the tree under
`target/planted` contains all of them, and the environment variable PLANTED activates one. Without an active defect every
value must equal the value of the plain build to the last bit. Stored runs are outdated in the copy, because its sources
differ. Each defect is tested by the main job, `grainbench run`, and if that
passes by the tests, quickest first. Results are stored in `results.jsonl`, so that an interrupted run continues. Needs
python 3.9 only. After the build a defect takes about a minute, plus the time of the tests if the main job passes.
"""

import argparse
import json
import os
import random
import re
import resource
import subprocess
import sys
from collections import Counter
from pathlib import Path

sys.dont_write_bytecode = True

import defects  # noqa: E402  (after the line that avoids a folder of compiled Python files here)

ROOT = Path(__file__).resolve().parents[2]
# Crate of the switch of the defects, on which all other crates depend.
SCENE = "solvers/scene/src"
CLASSES = {"dem": ("solvers/dem/src",), "mpm": ("solvers/mpm/src",), "scene": (SCENE, "solvers/solver/src"),
           "files": ("reference/src/read",)}
CHOOSER = '''//! Choice of the active defect by an environment variable.

use std::sync::OnceLock;

/// Returns true if the defect with this number is active.
pub fn on(number: u32) -> bool {
    static CHOSEN: OnceLock<u32> = OnceLock::new();
    *CHOSEN.get_or_init(|| std::env::var("PLANTED").ok().and_then(|text| text.parse().ok()).unwrap_or(0)) == number
}
'''
# Memory limit of a run (bytes), because a defect may request any amount.
MEMORY = 12 << 30


def command(words, where, **more):
    """Runs a program and returns its output. If the program fails, this script ends."""
    done = subprocess.run(words, cwd=where, text=True, **more)
    if done.returncode != 0:
        sys.exit(f"{' '.join(map(str, words))}: {done.returncode}\n{(done.stderr or '')[-3000:]}")
    return done.stdout


def bounded(seconds):
    """Returns a function that limits processor time and memory. A busy machine must not count as a defect."""
    def limit():
        resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))
        resource.setrlimit(resource.RLIMIT_CPU, (seconds, seconds))
        resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
    return limit


def attempt(words, where, number, seconds, more=None):
    """Runs a program with an active defect.

    Returns its exit code (None if it was stopped), output and processor time (s).
    """
    environment = {**os.environ, "PLANTED": str(number), "INSTA_UPDATE": "no", "CI": "true", **(more or {})}
    begun, seconds = spent(), int(seconds) + 1
    with subprocess.Popen(words, cwd=where, env=environment, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                          stdin=subprocess.DEVNULL, preexec_fn=bounded(seconds), start_new_session=True) as child:
        try:
            said, code = child.communicate(timeout=20 * seconds + 600)[0], child.returncode
        except subprocess.TimeoutExpired:
            # Its child processes belong to the same process group and end too.
            os.killpg(child.pid, 9)
            said, code = child.communicate()[0], None
    took = spent() - begun
    return None if took >= seconds else code, said.decode(errors="replace"), took


def spent():
    """Returns the processor time of all ended child processes (s)."""
    usage = resource.getrusage(resource.RUSAGE_CHILDREN)
    return usage.ru_utime + usage.ru_stime


class Planting:
    """Copy of the source tree with defects."""

    def __init__(self, work, seed, each):
        self.work, self.seed, self.each = work / f"seed-{seed}", seed, each
        self.tree, self.target = self.work / "tree", work / "target"
        self.work.mkdir(parents=True, exist_ok=True)
        self.environment = {**os.environ, "CARGO_TARGET_DIR": str(self.target)}

    def texts(self):
        """Returns the texts of the files of each class without defects. Files of tests are left out."""
        texts = {name: {str(path.relative_to(self.tree)): command(["git", "show", f"HEAD:{path.relative_to(self.tree)}"],
                                                                  self.tree, capture_output=True)
                        for folder in folders for path in sorted((self.tree / folder).rglob("*.rs"))
                        if path.name not in ("planted.rs", "tests.rs")}
                 for name, folders in CLASSES.items()}
        tests = {str(Path(file).parent / f"{module}.rs") for files in texts.values() for file, text in files.items()
                 for module in re.findall(r"#\[cfg\(test\)\]\s*mod (\w+);", text)}
        return {name: {file: text for file, text in files.items() if file not in tests} for name, files in texts.items()}

    def draw(self):
        """Selects random defects, removes those that do not compile, and numbers the others."""
        known = self.work / "drawn.json"
        if known.exists():
            return json.loads(known.read_text())
        if not self.tree.exists():
            command(["git", "clone", "--quiet", str(ROOT), str(self.tree)], ROOT, capture_output=True)
        texts = self.texts()
        lot, drawn = random.Random(self.seed), {}
        for name, files in texts.items():
            candidates = [defect for file, text in files.items() for defect in defects.of_file(file, text)]
            drawn[name] = defects.draw(lot, candidates, 2 * self.each)
            print(f"{name}: {len(drawn[name])} of {len(candidates)} places drawn")
        while True:
            dropped = self.broken(self.plant(texts, drawn))
            if not dropped:
                break
            print(f"{len(dropped)} do not compile")
            drawn = {name: [defect for defect in some if defect.key not in dropped] for name, some in drawn.items()}
        drawn = {name: some[:self.each] for name, some in drawn.items()}
        self.plant(texts, drawn)
        rows = [{"number": number, "class": name, "file": defect.file, "line": defect.line, "kind": defect.kind,
                 "shown": defect.shown} for number, (name, defect) in enumerate(flat(drawn), 1)]
        known.write_text(json.dumps(rows, indent=1))
        return rows

    def plant(self, texts, drawn):
        """Writes all files. Returns file and lines of each defect."""
        by_file, stands = {}, {}
        for number, (_, defect) in enumerate(flat(drawn), 1):
            by_file.setdefault(defect.file, []).append((number, defect))
        for file, text in (item for files in texts.values() for item in files.items()):
            crate = "crate" if file.startswith(SCENE) else "grainbench_scene"
            new, lines = defects.planted(text, by_file.get(file, []), f"{crate}::planted::on")
            if file == f"{SCENE}/lib.rs":
                new = new.replace("\npub mod ", "\npub mod planted;\npub mod ", 1)
            write(self.tree / file, new)
            for number, defect in by_file.get(file, []):
                stands[defect.key] = (file, *lines[number])
        write(self.tree / SCENE / "planted.rs", CHOOSER)
        return stands

    def broken(self, stands):
        """Returns the defects with compiler errors in their lines, or in the lines of their function."""
        packages = [word for name in ("scene", "solver", "dem", "mpm", "reference") for word in ("-p", f"grainbench-{name}")]
        said = subprocess.run(["cargo", "check", "--release", "--keep-going", "--message-format=json", *packages],
                              cwd=self.tree, env=self.environment, text=True, capture_output=True)
        dropped, errors = set(), 0
        for message in (json.loads(line) for line in said.stdout.splitlines() if line.startswith("{")):
            message = message.get("message") or {}
            if not isinstance(message, dict) or message.get("level") != "error":
                continue
            errors += 1
            for span in message["spans"]:
                # Modules that the build lists have absolute paths.
                named = os.path.relpath(self.tree / span["file_name"], self.tree)
                at = [(key, alone, whole) for key, (file, alone, whole) in stands.items()
                      if file == named and whole[0] <= span["line_start"] <= whole[1]]
                exact = {key for key, alone, _ in at if alone[0] <= span["line_start"] <= alone[1]}
                dropped |= exact or {key for key, _, _ in at}
        if said.returncode != 0 and not dropped:
            sys.exit(f"{errors} errors at no defect:\n{said.stderr[-3000:]}")
        return dropped

    def build(self):
        """Builds and returns the program, and the tests as (name, executable, working directory)."""
        command(["cargo", "build", "--release"], self.tree, env=self.environment)
        said = command(["cargo", "test", "--release", "--no-run", "--message-format=json"], self.tree,
                       env=self.environment, stdout=subprocess.PIPE)
        found = []
        for message in (json.loads(line) for line in said.splitlines() if line.startswith("{")):
            if message.get("executable") and message["profile"]["test"]:
                folder = Path(message["manifest_path"]).parent
                name = f"{folder.relative_to(self.tree)}/{message['target']['name']}".removeprefix("./")
                found.append((name, message["executable"], folder))
        return self.target / "release" / "grainbench", found


def flat(drawn):
    return [(name, defect) for name, some in drawn.items() for defect in some]


def write(path, text):
    """Writes a file only if it changes, so that unchanged files are not compiled again."""
    if not path.exists() or path.read_text() != text:
        path.write_text(text)


def results(folder):
    """Returns the results and controls of a run without times; None if it wrote none."""
    try:
        written = json.loads((folder / "results.json").read_text())
    except (OSError, ValueError):
        return None
    return [written["verdicts"], [{**control, "seconds": 0} for control in written["controls"]]]


def values(rows_and_controls):
    """Returns results and controls without the keys that tell whether a stored run is outdated."""
    rows, controls = rows_and_controls
    return [{key: row[key] for key in row if key not in ("verdict", "severity", "detail")} for row in rows], controls


def none_chosen(program, work):
    """Returns the results and controls without an active defect, and the time of the main job.

    Their values must equal the values of a build without defects.
    """
    kept, out, judged = work / "plain.json", work / "out", {}
    if kept.exists():
        return json.loads(kept.read_text())
    command(["cargo", "build", "--release"], ROOT)
    for name, which in (("plain", ROOT / "target" / "release" / "grainbench"), ("none chosen", program)):
        code, said, took = attempt([str(which), "run", "--out", str(out)], work, 0, 1800)
        judged[name] = results(out)
        subprocess.run(["rm", "-rf", str(out)], check=False)
        if code != 0 or judged[name] is None:
            sys.exit(f"{name}: ended with {code}\n{said[-2000:]}")
        print(f"{name}: {len(judged[name][0])} rows in {took:.0f} s", flush=True)
    if values(judged["plain"]) != values(judged["none chosen"]):
        sys.exit("without an active defect the results differ from the results of the plain build")
    print("without an active defect all values and controls equal those of the plain build, in every bit", flush=True)
    kept.write_text(json.dumps([judged["none chosen"], took]))
    return judged["none chosen"], took


def row_name(row):
    return " · ".join(row[key] for key in ("case", "variant", "solver", "quantity"))


def judge(program, work, number, seconds, plain):
    """Returns the first red result of the main job with a defect, if any, and the number of changed results."""
    out = work / "out"
    code, said, took = attempt([str(program), "run", "--out", str(out)], work, number, seconds)
    left = results(out) if code in (0, 1) else None
    subprocess.run(["rm", "-rf", str(out)], check=False)
    answer = {"seconds": round(took, 1), "caught": None, "red": 0, "moved": None}
    if code is None:
        answer["caught"] = f"run: not ended after {seconds:.0f} s of processor time"
    elif left is None:
        last = [line for line in said.splitlines() if line.strip() and not line.startswith("note:")][-3:]
        answer["caught"] = f"run: ended with {code}: {' | '.join(last)[:150]}"
    else:
        rows, controls = left
        answer["moved"] = sum(row != was for row, was in zip(rows, plain[0])) + abs(len(rows) - len(plain[0]))
        red = [f"run: {row['verdict']}: {row_name(row)}" for row in rows if row["severity"] == "red"]
        red += [f"run: control stayed green: {row_name(row)}" for row in controls if not row["turned_red"]]
        answer["red"] = len(red)
        if red or code != 0:
            answer["caught"] = red[0] if red else f"run: ended with {code}"
    return answer


def try_tests(tests, number):
    """Returns the first failed test; None if all pass."""
    for name, executable, folder, usual in tests:
        more = {"CARGO_MANIFEST_DIR": str(folder)}
        code, said, _ = attempt([executable], folder, number, 4 * usual + 60, more)
        if code != 0:
            failed = re.search(r"^test (.*?) \.\.\. .*FAILED", said, re.MULTILINE) or \
                re.search(r"^    (\S+)$", said, re.MULTILINE)
            word = failed.group(1) if failed else ("not ended" if code is None else f"ended with {code}")
            return f"{name}: {word}"
    return None


def measured(tests, kept, longest):
    """Returns the tests that pass without a defect within `longest` seconds, in order of duration.

    Tests that read the source text fail here, and are left out with the slow ones.
    """
    if kept.exists():
        times = json.loads(kept.read_text())
    else:
        times = {}
        for name, executable, folder in tests:
            code, _, took = attempt([executable], folder, 0, longest, {"CARGO_MANIFEST_DIR": str(folder)})
            times[name] = took if code == 0 else None
            why = "takes too long" if code is None else "red without a defect"
            print(f"{name}: {f'{took:.1f} s' if code == 0 else f'left out, {why}'}", flush=True)
        kept.write_text(json.dumps(times, indent=1))
    return sorted(((*test, times[test[0]]) for test in tests if times.get(test[0]) is not None), key=lambda test: test[3])


def table(rows, known):
    print("\n| place | kind | defect | changed rows | caught by |\n|---|---|---|---|---|")
    for row in rows:
        answer = known.get(row["number"], {})
        shown, caught = row["shown"].replace("|", "¦"), (answer.get("caught") or "**nothing**").replace("|", "¦")
        print(f"| {row['file']}:{row['line']} | {row['kind']} | `{shown}` | {answer.get('moved', '')} | {caught} |")
    found = Counter(row["class"] for row in rows if known.get(row["number"], {}).get("caught"))
    by_run = Counter(row["class"] for row in rows if (known.get(row["number"], {}).get("caught") or "").startswith("run:"))
    print("\n| class | planted | caught by the main job | caught by it or the tests |\n|---|---|---|---|")
    for name in CLASSES:
        count = sum(row["class"] == name for row in rows)
        print(f"| {name} | {count} | {by_run[name]} | {found[name]} |")
    print(f"| all | {len(rows)} | {by_run.total()} | {found.total()} |")


def main():
    options = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    options.add_argument("--seed", type=int, help="random seed; if it is missing, a seed is drawn and printed")
    options.add_argument("--each", type=int, default=15, help="defects of each class")
    options.add_argument("--only-run", action="store_true", help="run the main job and no tests")
    options.add_argument("--longest", type=float, default=1800, help="seconds that one test program may take")
    options.add_argument("--work", type=Path, default=ROOT / "target" / "planted")
    asked = options.parse_args()
    seed = asked.seed if asked.seed is not None else random.SystemRandom().randrange(10**6)
    print(f"seed {seed}", flush=True)
    planting = Planting(asked.work.resolve(), seed, asked.each)
    rows = planting.draw()
    program, tests = planting.build()

    plain, took = none_chosen(program, planting.work)
    kept = planting.work / "results.jsonl"
    known = {}
    if kept.exists():
        known = {row["number"]: row for row in map(json.loads, kept.read_text().splitlines())}

    def note(row, answer, tested):
        known[row["number"]] = {"number": row["number"], "tested": tested, **answer}
        with kept.open("a") as file:
            file.write(json.dumps(known[row["number"]]) + "\n")
        caught = answer["caught"] or ("nothing" if tested else "nothing so far")
        print(f"{row['number']:3} {row['file']}:{row['line']} {row['kind']}: {caught}", flush=True)

    for row in rows:
        if row["number"] not in known:
            note(row, judge(program, planting.work, row["number"], 5 * took + 60, plain), False)
    if not asked.only_run:
        tests = measured(tests, planting.work / "tests.json", asked.longest)
        for row in rows:
            answer = known[row["number"]]
            if not answer["caught"] and not answer["tested"]:
                note(row, {**answer, "caught": try_tests(tests, row["number"])}, True)
    table(rows, known)


if __name__ == "__main__":
    main()
