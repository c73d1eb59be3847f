#!/usr/bin/env python3
"""Tests derive.py on synthetic tables: derived numbers, defects that it must report, and tables that it must refuse."""

import math
import tempfile
from pathlib import Path

from derive import GRAVITY, HEIGHT, RELEASE, InputError, derive, entries_of


def ball(time, speed=RELEASE, lift=0.0, end=0.015):
    """Returns the height of a ball in free flight that decelerates from 21 ms on.

    It is `lift` (m) above free flight at 22 ms, and `end` (m) from 30 ms on.
    """
    flight = HEIGHT + speed * time - 0.5 * GRAVITY * time * time
    contact = min(max((time - 0.021) / 0.001, 0.0), 1.0)
    return flight + lift * contact + (end - lift) * min(max((time - 0.022) / 0.008, 0.0), 1.0)


def synthetic_impact(defects):
    """Returns a table of four codes on four beds, with or without defects.

    The defects: the beds of the last code have numbers one higher, its first bed is deeper, and one ball of the third
    code is released at rest.
    """
    lifts = (1.5e-4, 1.8e-4, 2.1e-4, 2.4e-4)
    lines = ["t," + ",".join(f"{code}_IC{bed}" for code in "ABCD" for bed in range(1, 5))]
    for step in range(41):
        heights = []
        for code, offset in zip("ABCD", (0.0, 1e-5, 2e-5, 1e-5)):
            for bed in range(4):
                lift = lifts[bed] if code != "D" or not defects else (4.0e-4, *lifts)[bed]
                deep = -1.5e-3 if defects and (code, bed) == ("D", 0) else 0.0
                speed = 0.0 if defects and (code, bed) == ("C", 3) else RELEASE
                heights.append(f"{ball(step * 1e-3, speed, lift, 0.015 + offset + 0.5 * lift + deep):.7f}")
        lines.append(f"{step * 1e-3:.3f}," + ",".join(heights))
    return "\n".join(lines)


def synthetic(changes=()):
    """Returns the derived files of a small copy of the data, with changed tables."""
    heights = [(step * 1e-3, ball(step * 1e-3, end=0.0)) for step in range(41)]
    zones = "t,z1_m1,z1_m2,z2_m1,z2_m2\n"
    texts = {
        "case1_large_liggghts.csv": "t,count\n0,100000\n2,50000\n4,0\n",
        "case1_large_musen.csv": "t,count\n0,100000\n2,52000\n4,4000\n",
        "case1_large_other.csv": "t,count\n0,100000\n2,0\n4,0\n",
        "case1_small_musen.csv": "t,count\n0,100000\n2,84000\n4,68000\n",
        "case2_liggghts.csv": f"{zones}0,1,2,30,41\n.5,1,3,1000,41\n1,4,7,1000,81\n",
        "case2_musen.csv": f"{zones}0,1,2,30,41\n.5,1,3,1050,41\n1,4,7,1080,81\n",
        # The clock is ahead by 0.05 ms.
        "case3_50k_liggghts.csv": "t,z\n" + "".join(f"{time},{ball(time + 5e-5, end=0.0):.9f}\n" for time, _ in heights),
        "case3_50k_musen.csv": "t,z\n" + "".join(f"{time},{height:.9f}\n" for time, height in heights),
        "codes.csv": synthetic_impact(defects=False),
        "other.csv": "x,y\n1,2\n",
        "drum.xyz": "2\nbox\n0 0.102 0.032 0.002\n1 0.202 0.032 0.102\n",
    } | dict(changes)
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        for file, text in texts.items():
            (folder / file).write_text(text, encoding="utf-8")
        return derive(folder)[0]


def check():
    def values(changes=()):
        return {key: float(value) for key, (_, value) in entries_of(synthetic(changes)["values.toml"]).items()}

    def expect(condition, *context):
        if not condition:
            raise AssertionError(context)

    flight = HEIGHT + RELEASE * 0.03 - 0.5 * GRAVITY * 0.03**2
    found = values()
    expected = {
        # Mean of four codes, their deviation, and the pooled deviation of the beds.
        "height_30": (1e3 * (flight + 0.015 + 1e-5 + 0.5 * 1.95e-4), 1e-4),
        "height_30_code": (1e-2 * math.sqrt(2.0 / 3.0), 1e-4),
        "height_30_bed": (1e3 * 0.5 * 3e-5 * math.sqrt(5.0 / 3.0), 1e-4),
        "silo_large_rate": (24.5, 0.0),
        "silo_large_rate_half": (0.5, 0.0),
        "silo_small_rate": (8.0, 0.0),
        "silo_large_out_2": (49.0, 0.0),
        "height_30_50k": (1e3 * flight, 0.01),
        "height_30_50k_half": (0.0, 0.01),
    }
    for key, (value, tolerance) in expected.items():
        expect(abs(found[key] - value) <= tolerance, key, found[key], value)
    # Negative controls: changed tables change these values and no others.
    for changes, keys in (
        ({"case1_large_musen.csv": "t,count\n0,100000\n2,53000\n4,4000\n"}, {"silo_large_out_2"}),
        ({"case3_50k_musen.csv": f"t,z\n0,{HEIGHT}\n0.03,{flight + 1e-3}\n"}, {"height_30_50k", "height_30_50k_half"}),
        ({"codes.csv": synthetic_impact(defects=True)}, {"height_30", "height_30_code", "height_30_bed"}),
    ):
        other = values(changes)
        moved = {key for key, (value, tolerance) in expected.items() if abs(other[key] - value) > tolerance}
        expect(moved >= keys and moved - keys <= {"silo_large_rate", "silo_large_rate_half"}, moved, keys)

    # Yade is excluded. The other codes differ by 0.01 mm.
    found = values({"codes.csv": synthetic_impact(defects=False).replace("D_IC", "Yade_IC")})
    expect(found["height_30_code"] == 0.01, found)

    report = synthetic()["consistency.md"]
    expect(report.count("\n| ") == 2 and "case3_50k_liggghts |  | clock ahead" in report, report)
    drum = "t,z1_m1,z1_m2,z2_m1,z2_m2\n0,1,2,30,41\n.5,1,3,1000,41\n1,4,6,800,82\n2,8,12,1600,164\n"
    report = synthetic({"codes.csv": synthetic_impact(defects=True), "case2_musen.csv": drum})["consistency.md"]
    for words in (
        "| C, bed 4 | velocity at the start | 0.00 m/s | -5 m/s |",
        "numbers one higher; its bed 1 (held up by 400 µm)",
        # The bed is 1.5 mm deeper. Half the difference of its fingerprint reduces this to 1.4 mm.
        "1.4 mm below",
        "| t = 1 s | M1 in zone 2 | 800, -20.0 % of case2_liggghts's 1000 | within 10 % |",
        "| t = 2 s | grains in both zones | 2.00 times",
    ):
        expect(words in report, words, report)
    expect("| A" not in report and "| B" not in report, report)
    expect("\n1 1 0.002 2500 0.1 0 0\n" in synthetic()["drum-m1.data"])

    for text, words in (
        ("t,A_IC1,B\n0,1,2\n", "expected columns CODE_ICn"),
        ("t,A_IC0\n0,1\n", "expected columns CODE_ICn"),
        ("t,A_IC1\n0,1\n-1,1\n", "a.csv:3: expected times that do not fall"),
        ("t,A_IC1\n0,x\n", "a.csv:2: expected 2 finite numbers"),
        ("t,count\n0,5\n0,4\n", "a.csv:3: expected times that rise"),
        ("t,z1_m1,z2_m1\n0,1,2\n", "expected columns z1_m1"),
        ("t,count\n", "expected at least one row"),
    ):
        try:
            synthetic({"a.csv": text})
        except InputError as problem:
            expect(words in str(problem), problem, words)
        else:
            raise AssertionError(text)


if __name__ == "__main__":
    check()
    print("all checks passed")
