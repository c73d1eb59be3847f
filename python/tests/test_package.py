"""Tests of the installed package with its program."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

import grainbench as gb
from grainbench._binary import binary

EXAMPLE = Path(__file__).parents[2] / "examples" / "python" / "sphere.py"
GRAINS = EXAMPLE.with_name("grains.py")
# Case with 2001 discs, whose claims read a velocity, the force of a pair and the force on a wall.
PAIRS = Path(__file__).with_name("pairs")
CASES = ["incline-disc/30deg-mu.5", "incline-sphere/45deg-mu.495", "backspin/sphere", "oblique-impact"]

# Lines of the example's physics, each with a defective version.
SPOILED = [
    ("force, torque = mass * scene.gravity", "force, torque = 0.99 * mass * scene.gravity"),
    ("overlap, arm = radius - ", "overlap, arm = 0.99 * radius - "),
    ('@ n, -radius * n', '@ n, -0.99 * radius * n'),
    ("k, kt = law.normal_stiffness", "k, kt = 0.95 * law.normal_stiffness"),
    (", law.tangential_stiffness", ", 0.95 * law.tangential_stiffness"),
    ("c, ct = law.normal_damping", "c, ct = 0.9 * law.normal_damping"),
    (", law.tangential_damping", ", 0.9 * law.tangential_damping"),
    ("(c + law.stiffness_damping", "(c + 0.9 * law.stiffness_damping"),
    ("slip = v + cross(spin, arm)", "slip = 0.99 * v + cross(spin, arm)"),
    ("slip - (slip @ n) * n", "slip - 0.9 * (slip @ n) * n"),
    ("(ct + law.stiffness_damping", "(ct + 0.9 * law.stiffness_damping"),
    ("friction = -spring - drag", "friction = -spring + drag"),
    ("law.friction * max", "0.99 * law.friction * max"),
    ("min(1.0, law", "min(2.0, law"),
    ("force + push * n + friction", "force + push * n + 0.99 * friction"),
    ("torque + cross(arm, friction)", "torque + 0.99 * cross(arm, friction)"),
    ("0.5 * dt / mass", "0.495 * dt / mass"),
    ("0.5 * dt / inertia", "0.495 * dt / inertia"),
    ("x + dt * (v + kick)", "x + 0.999 * dt * (v + kick)"),
]

# Mistakes in the example with many grains, the case that finds each one, and the hint of the result.
IMPACT, SLOPE = "unequal-impact", "incline-disc/30deg-mu.5"
MISTAKES = [
    ("a, arms[0] * moment), np.add.at(torques, b, arms[1]", "a, arms.mean(0) * moment), np.add.at(torques, b, arms.mean(0)", IMPACT, "(R₁ + R₂)/2"),
    ("np.add.at(torques, b, arms[1] * moment)", "np.add.at(torques, b, -arms[1] * moment)", IMPACT, None),
    ("np.minimum(1, mu", "np.minimum(1, 0.5 * mu", IMPACT, "half the friction"),
    ("torques[:count] / inertia", "torques[:count] / (0.8 * inertia)", IMPACT, None),
    ("torques[:count] / inertia", "0 * torques[:count]", IMPACT, "grains that do not rotate"),
    ("push = k[:, None] * overlap -", "push = 0.5 * k[:, None] * overlap -", SLOPE, None),
    ("overlap - (c + beta * k)", "overlap - 0.5 * (c + beta * k)", SLOPE, "half the normal damping"),
    ("overlap - (c + beta * k)", "overlap - 2 * (c + beta * k)", SLOPE, "twice the normal damping"),
    ("(ct + beta * kt)", "0 * (ct + beta * kt)", SLOPE, "no tangential damping"),
    ("kt[:, None] * step * slip", "0.5 * kt[:, None] * step * slip", SLOPE, "half the tangential stiffness"),
]

REFUSES = """
import grainbench as gb

@gb.solver(dimension=[2, 3], laws=["linear"], effects=["friction", "contact-damping"])
def sphere(scene, steps):
    raise gb.Cannot("no")
"""


def example(folder: Path, spoiled: tuple[str, str] | None = None) -> Path:
    text = EXAMPLE.read_text(encoding="utf-8")
    if spoiled is not None:
        assert text.count(spoiled[0]) == 1, spoiled[0]
        text = text.replace(*spoiled)
    (folder / "sphere.py").write_text(text, encoding="utf-8")
    return folder / "sphere.py"


def by_pytest(folder: Path, *words: str, cases: list[str] = CASES) -> subprocess.CompletedProcess[str]:
    command = [sys.executable, "-m", "pytest", "-p", "no:cacheprovider", "--grainbench", "sphere.py:sphere"]
    command += ["--grainbench-cases", ",".join(cases), *words]
    return subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False)


def test_pytest_has_an_item_a_row_and_one_a_control(tmp_path: Path) -> None:
    example(tmp_path)
    done = by_pytest(tmp_path, "-v", cases=["incline-sphere/45deg-mu.495", "backspin/sphere", "oblique-impact"])
    assert done.returncode == 0, done.stdout
    lines = [line for line in done.stdout.splitlines() if "PASSED" in line]
    controls = [line for line in lines if "[control: " in line]
    assert len(lines) == 2 * len(controls) >= 20, done.stdout
    assert f"grainbench: {len(lines)} rows and controls" in done.stdout


@pytest.mark.parametrize("spoiled", SPOILED, ids=[wrong for _, wrong in SPOILED])
def test_each_line_of_the_physics_is_felt(tmp_path: Path, spoiled: tuple[str, str]) -> None:
    path = example(tmp_path, spoiled)
    solver = load(path)
    for case in CASES:
        if not gb.judge(solver, [case], controls=False).passed:
            return
    raise AssertionError(f"{spoiled[1]}: every row passes")


def load(path: Path, name: str = "sphere") -> gb.Solver:
    from grainbench.worker import load

    return load(f"{path}:{name}")


def test_pytest_says_which_row_is_red_and_why(tmp_path: Path) -> None:
    example(tmp_path, ("mass * scene.gravity", "0.9 * mass * scene.gravity"))
    done = by_pytest(tmp_path, cases=CASES[1:2])
    assert done.returncode == 1
    assert "fail         incline-sphere · 45deg-mu.495 · " in done.stdout, done.stdout
    assert "allowed" in done.stdout


def test_pytest_names_the_mistake(tmp_path: Path) -> None:
    example(tmp_path, ("0.5 * dt / inertia", "0.4 * dt / inertia"))
    done = by_pytest(tmp_path, cases=CASES[1:2])
    assert done.returncode == 1 and "as if: the inertia of a disc in a sphere" in done.stdout, done.stdout


def test_many_grains_are_judged() -> None:
    judgement = gb.judge(load(GRAINS, "grains"), [IMPACT, "collision", SLOPE])
    assert judgement.passed and judgement.page is None, judgement.table(only_red=True)
    assert sum(row["verdict"] == "pass" for row in judgement.verdicts) >= 19


def test_contacts_of_thousands_of_grains_are_judged(tmp_path: Path) -> None:
    judgement = gb.judge(load(GRAINS, "grains"), [str(PAIRS)], out=tmp_path / "out")
    assert judgement.passed and len(judgement.verdicts) == 3, judgement
    assert [control["turned_red"] for control in judgement.of_controls] == [True] * 3
    assert judgement.page == tmp_path / "out" / "index.html" and judgement.page.is_file()
    kept = gb.read(tmp_path / "out")
    assert isinstance(kept, gb.Results) and kept.verdicts == judgement.verdicts


@pytest.mark.parametrize(
    ("right", "wrong", "red"),
    [
        ("force[is_pair])", "0.98 * force[is_pair])", "largest force of the pair in the middle"),
        ("(pairs[is_pair] + 1,", "(pairs[is_pair][:, ::-1] + 1,", "largest force of the pair in the middle"),
        ("= force[~is_pair]", "= 0.999 * force[~is_pair]", "force on the floor"),
    ],
)
def test_wrong_contacts_are_red(tmp_path: Path, right: str, wrong: str, red: str) -> None:
    text = GRAINS.read_text(encoding="utf-8")
    assert text.count(right) == 1, right
    (tmp_path / "grains.py").write_text(text.replace(right, wrong), encoding="utf-8")
    judgement = gb.judge(load(tmp_path / "grains.py", "grains"), [str(PAIRS)], controls=False)
    assert [row["quantity"] for row in judgement.verdicts if row["verdict"] == "fail"] == [red], judgement


def test_contacts_at_some_samples_are_an_error() -> None:
    recorder = gb.Recorder(gb.scene("backspin/disc"))
    recorder.take(0, np.zeros((1, 3)), np.zeros((1, 3)), np.zeros((1, 3)), contacts=(np.zeros((0, 2)), np.zeros((0, 3))))
    recorder.take(recorder._steps.count, np.zeros((1, 3)), np.zeros((1, 3)), np.zeros((1, 3)))
    with pytest.raises(ValueError, match="contacts: expected them at all 2 samples, found 1"):
        recorder.record()


def test_pytest_judges_many_grains(tmp_path: Path) -> None:
    (tmp_path / "sphere.py").write_text(GRAINS.read_text(encoding="utf-8").replace("def grains(", "def sphere("), encoding="utf-8")
    done = by_pytest(tmp_path, "-v", cases=[str(PAIRS)])
    assert done.returncode == 0 and done.stdout.count("PASSED") == 6, done.stdout


def test_a_record_is_checked() -> None:
    scene = gb.scene(PAIRS / "scene.toml", time_step=1e-4)
    record = load(GRAINS, "grains")(scene, scene.steps)
    assert record.contacts is not None and len(record.contacts.step) > 1000
    judgement = gb.check(PAIRS / "scene.toml", record, time_step=1e-4)
    assert judgement.passed, judgement
    softer = gb.check(PAIRS / "scene.toml", record, set={"contacts.all.normal_stiffness": 5e3}, time_step=1e-4)
    assert not softer.passed
    with pytest.raises(ValueError, match="time"):
        gb.check(PAIRS / "scene.toml", record)


def test_scenes_are_changed() -> None:
    scene = gb.scene("backspin/disc", set={"contacts.plane.friction": 0.3, "grains.grain.position": [0.0, 0.6]})
    assert scene.law("rock", "rock").friction == 0.3 and scene.position.tolist() == [[0.0, 0.6, 0.0]]
    with pytest.raises(ValueError, match="did you mean"):
        gb.scene("backspinn")


def test_conformance_and_cost_have_results(tmp_path: Path) -> None:
    assert gb.conform("rigid").passed
    costs = gb.cost(load(GRAINS, "grains"), ["backspin/disc"], out=tmp_path / "cost")
    points = costs.points
    assert len(points) >= 5 and set(points["solver"]) == {"grains"} and (points["wall_seconds"] > 0).any()
    assert (tmp_path / "cost" / "index.html").is_file() and "grains" in repr(costs)
    with pytest.raises(ValueError, match="backspinn"):
        gb.cost("dem", ["backspinn"])


def test_progress_is_shown(capsys: pytest.CaptureFixture[str]) -> None:
    assert gb.judge("dem:lammps", ["oblique-impact"], progress=True).verdicts
    assert "\x1b[" in capsys.readouterr().err
    assert gb.judge("dem:lammps", ["oblique-impact"]).verdicts and not capsys.readouterr().err
    with pytest.raises(ValueError, match="did you mean `backspin`"):
        gb.judge("dem", ["backspinn"], progress=True)


def test_details_are_columns() -> None:
    details = ["first outside at t = 0.210000 s; as if: half the friction", "as if: no damping", "not installed", None]
    rows = gb.Results({"verdicts": [{"detail": detail} for detail in details], "controls": []}).rows
    assert rows["first_outside"].tolist()[0] == 0.21 and rows["first_outside"].isna().tolist() == [False, True, True, True]
    assert rows["as_if"].tolist()[:2] == ["half the friction", "no damping"]
    assert rows["reason"].tolist()[2] == "not installed" and rows["reason"].isna().tolist() == [True, True, False, True]


@pytest.mark.parametrize(("line", "wrong", "case", "hint"), MISTAKES, ids=[wrong for _, wrong, _, _ in MISTAKES])
def test_mistakes_with_many_grains_are_red(tmp_path: Path, line: str, wrong: str, case: str, hint: str | None) -> None:
    text = GRAINS.read_text(encoding="utf-8")
    assert text.count(line) == 1, line
    (tmp_path / "grains.py").write_text(text.replace(line, wrong), encoding="utf-8")
    judgement = gb.judge(load(tmp_path / "grains.py", "grains"), [case], controls=False)
    assert not judgement.passed
    said = judgement.table(only_red=True)
    assert hint is None or any("as if: " in row and hint in row for row in said.splitlines()), said


def test_pytest_fails_where_nothing_is_judged(tmp_path: Path) -> None:
    (tmp_path / "sphere.py").write_text(REFUSES, encoding="utf-8")
    done = by_pytest(tmp_path, cases=["incline-disc", "backspin"])
    assert done.returncode == 1 and "no row was judged" in done.stdout and " passed" not in done.stdout, done.stdout
    done = by_pytest(tmp_path, "--collect-only", cases=["backspin"])
    assert done.returncode == 0, done.stdout


def test_pytest_selects_rows_by_keyword(tmp_path: Path) -> None:
    example(tmp_path)
    done = by_pytest(tmp_path, "-k", "zzz", cases=["backspin/sphere"])
    assert done.returncode != 0 and " passed" not in done.stdout, done.stdout
    done = by_pytest(tmp_path, "-k", "spin and not control", cases=["backspin/sphere"])
    assert done.returncode == 0 and "deselected" in done.stdout, done.stdout


def test_pytest_counts_results_and_no_controls(tmp_path: Path) -> None:
    example(tmp_path, ("law.friction * max", "0.8 * law.friction * max"))
    done = by_pytest(tmp_path, "-k", "control", cases=["backspin/sphere"])
    assert done.returncode == 1 and "no row was judged" in done.stdout, done.stdout


def test_pytest_counts_what_its_workers_judge(tmp_path: Path) -> None:
    pytest.importorskip("xdist")
    example(tmp_path)
    done = by_pytest(tmp_path, "-n", "2", cases=["backspin/sphere"])
    assert done.returncode == 0 and "no row was judged" not in done.stdout, done.stdout
    (tmp_path / "sphere.py").write_text(REFUSES, encoding="utf-8")
    done = by_pytest(tmp_path, "-n", "2", cases=["backspin/sphere"])
    assert done.returncode == 1 and "no row was judged" in done.stdout, done.stdout


def test_pytest_skips_cases_without_a_claim_for_any_solver(tmp_path: Path) -> None:
    example(tmp_path)
    done = by_pytest(tmp_path, "-rs", cases=["backspin/sphere", "bar-impact"])
    assert done.returncode == 0 and "solver-independent claim" in done.stdout, done.stdout
    done = by_pytest(tmp_path, cases=["bar-impact"])
    assert done.returncode == 1 and "no row was judged" in done.stdout, done.stdout


def test_what_is_wrong_is_said_in_a_line(tmp_path: Path) -> None:
    example(tmp_path)
    for words, said in [
        (["--grainbench", "sphere.py"], "expected MODULE:NAME or FILE.py:NAME"),
        (["--grainbench", "nothing.py:sphere"], "expected a file of Python"),
        (["--grainbench", "sphere.py:np"], "expected a function under @grainbench.solver"),
        (["--grainbench", "sphere.py:sphere", "--grainbench-cases", "backspinn"], "did you mean `backspin`?"),
    ]:
        command = [sys.executable, "-m", "pytest", "-q", "-p", "no:cacheprovider", *words]
        done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, check=False)
        assert done.returncode == 4 and said in done.stderr + done.stdout, done.stdout + done.stderr


def test_a_closure_is_judged_where_it_is() -> None:
    slower = 0.5

    @gb.solver(dimension=[2, 3], laws=["linear"], effects=["friction", "contact-damping"])
    def free(scene: gb.Scene, steps: gb.Steps) -> gb.Record:
        """Lets the grains fall at half their weight through everything."""
        time = steps.samples * steps.time_step
        fall = slower * scene.gravity * time[:, None]
        velocity = scene.velocity + fall[:, None, :]
        position = scene.position + scene.velocity * time[:, None, None] + 0.5 * (fall * time[:, None])[:, None, :]
        return gb.Record(steps.samples, position, velocity, np.repeat(scene.spin[None], len(time), axis=0))

    judgement = gb.judge(free, ["backspin"])
    assert not judgement.passed
    rows = judgement.rows
    assert set(rows["verdict"]) == {"fail"} and "fail" in repr(judgement) and "#cf222e" in judgement._repr_html_()
    with pytest.raises(AssertionError, match="backspin"):
        judgement.require()


@pytest.mark.parametrize(
    ("body", "verdict", "said"),
    [
        ("raise gb.Cannot('no springs here')", "unsupported", "no springs here"),
        ("raise gb.Broken('it flew away', when=0.5)", "broken", "it flew away"),
        ("return 1 / 0", "broken", "ZeroDivisionError"),
        ("return None", "broken", "expected a Record"),
        ("import time; time.sleep(30)", "broken", "not done after 1 s"),
        ("import os; os._exit(3)", "broken", "the worker ended"),
        ("return gb.Record(steps.samples[:1], scene.position[None])", "broken", "expected samples to step"),
        ("return gb.Record(steps.samples, np.full((len(steps.samples), 1, 3), np.nan))", "broken", "finite numbers"),
    ],
)
def test_what_goes_wrong_stands_in_the_row(body: str, verdict: str, said: str) -> None:
    names = {"gb": gb, "np": np}
    exec(f"def function(scene, steps):\n    {body}", names)
    words = {"dimension": [2, 3], "laws": ["linear"], "effects": ["friction", "contact-damping"], "seconds": 1}
    judgement = gb.judge(gb.solver(name="odd", **words)(names["function"]), ["backspin/sphere"], controls=False)
    assert [row["verdict"] for row in judgement.verdicts] == [verdict] * len(judgement.verdicts), judgement
    assert all(said in row["detail"] for row in judgement.verdicts), judgement


def test_what_is_not_declared_is_not_asked_for() -> None:
    @gb.solver(dimension=[3], laws=["linear"])
    def nothing(scene: gb.Scene, steps: gb.Steps) -> gb.Record:
        raise AssertionError("it was asked")

    rows = gb.judge(nothing, ["backspin/disc"]).verdicts
    assert {row["verdict"] for row in rows} == {"unsupported"}
    assert "scenes in 2 dimensions" in rows[0]["detail"]


def test_arrays_have_the_shapes_that_they_say() -> None:
    with pytest.raises(ValueError, match=r"position: expected the shape \(2, grains, 3\), found \(2, 3\)"):
        gb.Record(np.array([0, 1]), np.zeros((2, 3)))
    with pytest.raises(ValueError, match=r"force of contacts: expected the shape \(2, 3\)"):
        gb.Contacts(np.array([0, 0]), np.ones((2, 2), dtype=int), np.zeros((3, 2)))
    with pytest.raises(ValueError, match=r"force of the wall floor: expected the shape \(2, 1, 3\)"):
        gb.Record(np.array([0, 1]), np.zeros((2, 1, 3)), wall_force={"floor": np.zeros((1, 3))})
    with pytest.raises(ValueError, match=r"spin: expected the shape \(2, 1, 3\)"):
        gb.Record(np.array([0, 1]), np.zeros((2, 1, 3)), spin=np.zeros((2, 1)))
    with pytest.raises(TypeError, match="expected a function under @grainbench.solver"):
        gb.judge(len)  # type: ignore[arg-type]


def test_what_grainbench_left_is_read(tmp_path: Path) -> None:
    out = tmp_path / "gates"
    subprocess.run([binary(), "run", "backspin", "--out", str(out)], check=True, capture_output=True)
    results = gb.read(out)
    assert isinstance(results, gb.Results)
    assert set(results.rows["verdict"]) == {"pass", "known"} and len(results.controls) == len(results.rows)
    scene = Path(__file__).parents[2] / "cases" / "backspin" / "scene.toml"
    run = tmp_path / "run"
    words = ["simulate", str(scene), "--solver", "dem", "--variant", "sphere", "--out", str(run)]
    subprocess.run([binary(), *words], check=True, capture_output=True)
    record = gb.read(run)
    assert isinstance(record, gb.Run)
    # A sphere that is set down with ten revolutions per second ends rolling at two sevenths of its rim speed.
    radius = record.snapshots[0]["position"][0, 2]
    rim = abs(record.snapshots[0]["spin"][0]).max() * radius
    assert record.snapshots[-1]["velocity"][0, 0] == pytest.approx(2 / 7 * rim, rel=2e-3)
    assert record.series["grain.vx"][-1] == record.snapshots[-1]["velocity"][0, 0]
    assert record.units["grain.vx"] == "m/s" and record.series["time"].shape == record.series["grain.vx"].shape
    with pytest.raises(ValueError, match="expected `results.json`"):
        gb.read(tmp_path)


def test_a_sweep_is_read_with_the_colour_of_each_result(tmp_path: Path) -> None:
    sweep = Path(__file__).parents[2] / "examples" / "sweep" / "ball.toml"
    scene = sweep.parent.parent / "case" / "scene.toml"
    text = sweep.read_text(encoding="utf-8").replace("../case/scene.toml", str(scene))
    text = text.replace("count = 10", "count = 2").replace("count = 12", "count = 2").replace("5/7", "4/7")
    text += '\n[[record]]\nquantity = "speed"\nunit = "m/s"\nvalue = "ball.vx"\n'
    (tmp_path / "sweep.toml").write_text(text, encoding="utf-8")
    words = ["simulate", str(tmp_path / "sweep.toml"), "--out", str(tmp_path / "out")]
    assert subprocess.run([binary(), *words], check=False, capture_output=True).returncode == 1
    results = gb.read(tmp_path / "out" / "report")
    assert isinstance(results, gb.Results)
    red = results.table(only_red=True).splitlines()
    assert len(red) > 1 and all(line.startswith("fail") for line in red[:-1]), red
    assert "12 not judged" in red[-1], red
    assert "color:#cf222e" in results._repr_html_()


def test_a_scene_is_read_as_it_is_printed(tmp_path: Path) -> None:
    path = tmp_path / "scene.json"
    path.write_text(subprocess.run([binary(), "scene", "nine-discs/kappa-0"], check=True, capture_output=True, text=True).stdout)
    scene = gb.Scene.read(path)
    assert scene.position.shape == (9, 3) and scene.mass.shape == (9,) and scene.dimension == 2
    assert scene.steps.samples[0] == 0 and scene.steps.samples[-1] == scene.steps.count
    wall = scene.walls[0]
    assert scene.law(scene.material[0], wall.material).normal_stiffness > 0


@pytest.mark.parametrize(("chapter", "blocks"), [("judge.md", 1), ("python.md", 2)])
def test_the_guide_shows_what_runs(tmp_path: Path, chapter: str, blocks: int) -> None:
    """Runs the Python blocks of the guide that show no file.

    They run in a new process, because `sphere` may be a module that another test has changed.
    """
    text = (Path(__file__).parents[2] / "guide" / "src" / chapter).read_text(encoding="utf-8")
    parts = text.split("```python\n")
    shows_file = [part.rstrip().endswith(".py -->") for part in parts[:-1]]
    typed = [part.split("```")[0] for part, is_file in zip(parts[1:], shows_file, strict=True) if not is_file]
    assert len(typed) == blocks
    example(tmp_path)
    (tmp_path / "grains.py").write_text(GRAINS.read_text(encoding="utf-8"), encoding="utf-8")
    for block in typed:
        shown = subprocess.run([sys.executable, "-c", block], cwd=tmp_path, capture_output=True, text=True, check=False)
        assert shown.returncode == 0, shown.stdout + shown.stderr
    (command,) = [line for line in text.splitlines() if line.startswith("pytest --grainbench ")]
    done = subprocess.run([sys.executable, "-m", *command.split()], cwd=tmp_path, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout


def test_the_command_line_judges_a_function(tmp_path: Path) -> None:
    """`grainbench judge FILE.py:NAME` starts the function with the `python3` of the environment. Another name is refused."""
    path = f"{Path(sys.executable).parent}{os.pathsep}{os.environ['PATH']}"
    for name, code, text in [("sphere", 0, "4 pass, 0 fail"), ("nothing", 2, "expected a function under `@grainbench.solver`")]:
        words = [binary(), "judge", f"{EXAMPLE}:{name}", "backspin/sphere", "--no-controls"]
        done = subprocess.run(words, cwd=tmp_path, env={**os.environ, "PATH": path}, capture_output=True, text=True)
        assert done.returncode == code and text in done.stdout + done.stderr, done.stdout + done.stderr
