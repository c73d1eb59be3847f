#!/usr/bin/env python3
"""Derives the numbers and tables of this folder from a copy of the data of Dosta et al. 2024.

    python3 derive.py DATA [--out DIR] [--plot]   write the derived files
    python3 derive.py DATA --check                compare the derived files with the stored ones

DATA is a directory of tables, `.csv` or `.csv.gz`. Other files are skipped. A table is identified by its columns:
    t,CODE_ICn,…                  height of the ball (m), by code and bed
    t,z                           height of the ball (m), one run
    t,z1_m1,z1_m2,z2_m1,z2_m2     grains in the zones of the drum; zone 2 is x < 0, z < 0
    t,count                       grains left in the silo
An `.xyz` file is the initial state of the drum. Needs Python 3.9; `--plot` needs matplotlib. The data itself is not
copied. `derive_test.py` tests this program on synthetic tables.
"""

import argparse
import gzip
import math
import re
import sys
from dataclasses import dataclass, field
from decimal import Decimal
from pathlib import Path

HERE = Path(__file__).resolve().parent
GRAVITY, HEIGHT, RELEASE = 9.81, 0.06, -5.0  # m/s², and height (m) and velocity (m/s) of the ball at its release
CODES = ("liggghts", "musen")  # codes that reran silo, drum and deep beds, by the ending of their table names
# Codes and beds that are not comparable with the others. Yade is an outlier, which the authors exclude too, and no
# other code has bed 1 of MUSEN. In bed 10 of LIGGGHTS, the ball was released at rest.
EXCLUDED = (("Yade", None), ("MUSEN", 1), ("LIGGGHTS", 10))
ZONES = ("z1_m1", "z1_m2", "z2_m1", "z2_m2")

OTHER_RELEASE = 0.1  # tolerance of the initial velocity (m/s); a larger difference is a different release
OUTLIER = 4.0  # standard deviations from which on a bed or code is an outlier; eighty beds do not reach it by chance
CONTACT = 0.022  # time when the ball has just reached the bed (s), before chaos has grown
SAME_BED = 1.2e-5  # tolerance of the height above free flight between codes on the same bed (m)
SAME_DRUM = 0.1  # tolerance of the grains M1 in zone 2 between two runs; LIGGGHTS and MUSEN differ by 6.6 % at 2 s


class InputError(Exception):
    """Error in the data, with its place."""


def error(place, expected, found):
    return InputError(f"{place}: expected {expected}, found {found}")


def shown(number):
    """Returns the shortest decimal number that is equal, without an exponent."""
    return format(Decimal(repr(float(number))), "f").removesuffix(".0")


def scientific(number, digits):
    mantissa, exponent = f"{number:.{digits}e}".split("e")
    return f"{mantissa}e{int(exponent)}"


def total(values):
    """Returns the sum from left to right; `sum` of Python 3.12 compensates rounding errors."""
    result = 0.0
    for value in values:
        result += value
    return result


def mean(values):
    return total(values) / len(values)


def deviation(values):
    centre = mean(values)
    return math.sqrt(total([(value - centre) ** 2 for value in values]) / (len(values) - 1))


def interpolated(times, values, time):
    """Returns the value at a time, linear between samples, or None outside."""
    after = next((row for row, sampled in enumerate(times) if sampled >= time - 1e-9), None)
    if after is None:
        return None
    if abs(times[after] - time) < 1e-9:
        return values[after]
    if after == 0:
        return None
    part = (time - times[after - 1]) / (times[after] - times[after - 1])
    return values[after - 1] + part * (values[after] - values[after - 1])


# ---------------------------------------------------------------------------------------------------------- tables


@dataclass
class Course:
    """Heights of the ball (m) of one code in one bed."""

    code: str
    bed: int
    times: list
    heights: list

    def height(self, time):
        return interpolated(self.times, self.heights, time)

    def velocity(self, start, end):
        low, high = self.height(start), self.height(end)
        return None if low is None or high is None else (high - low) / (end - start)

    def lift(self, time):
        """Returns the height above free flight (m)."""
        height = self.height(time)
        return None if height is None else height - (HEIGHT + RELEASE * time - 0.5 * GRAVITY * time * time)

    def clock_error(self):
        """Returns the clock error of the first sample (s), positive if the ball has already fallen."""
        return self.lift(self.times[0]) / RELEASE


@dataclass
class Table:
    """Published table: an impact with courses, or a drum or silo with columns over time."""

    name: str
    kind: str
    times: list
    columns: dict = field(default_factory=dict)
    courses: list = field(default_factory=list)
    repeated: int = 0

    def left(self, time):
        """Returns the grains left in the silo. Before the first sample, all grains are left."""
        return interpolated(self.times, self.columns["count"], max(time, self.times[0]))

    def rate(self, start, end):
        """Returns the thousands of grains that leave the silo per second."""
        before, after = self.left(start), self.left(end)
        return None if before is None or after is None else (before - after) / (end - start) / 1e3

    def in_zone_2(self, time):
        rows = (row for row, at in enumerate(self.times) if abs(at - time) < 1e-6)
        return next((self.columns["z2_m1"][row] for row in rows), None)


def lines_of(path):
    with (gzip.open if path.suffix == ".gz" else open)(path, "rt", encoding="utf-8") as file:
        yield from enumerate(file, 1)


def numbers_of(path):
    """Returns the names of the columns, and each row with the number of its line."""
    names, rows = [], []
    for number, line in lines_of(path):
        fields = [text.strip().strip('"') for text in line.split(",")]
        if fields == [""] or line.startswith("#"):
            continue
        if not names:
            names = fields
            continue
        try:
            values = [float(text) for text in fields]
        except ValueError:
            values = []
        if len(values) != len(names) or not all(map(math.isfinite, values)):
            raise error(f"{path}:{number}", f"{len(names)} finite numbers", f"`{line.strip()}`")
        rows.append((number, values))
    return names, rows


def read_table(path):
    """Reads a table, or returns None if it is another table."""
    name = path.name.removesuffix(".gz").removesuffix(".csv")
    names, rows = numbers_of(path)
    if len(names) < 2 or names[0] != "t":
        return None
    is_ball = names == ["t", "z"] or "_IC" in names[1]
    if not is_ball and names != ["t", "count"] and names[1] not in ZONES:
        return None
    if not rows:
        raise error(path, "at least one row below the names", "none")
    if is_ball:
        return impact(path, [f"{name}_IC1"] if names[1] == "z" else names[1:], rows, name)
    for (_, before), (number, values) in zip(rows, rows[1:]):
        if values[0] <= before[0]:
            raise error(f"{path}:{number}", "times that rise", shown(values[0]))
    times = [values[0] for _, values in rows]
    columns = {column: [values[place] for _, values in rows] for place, column in enumerate(names)}
    if names == ["t", "count"]:
        return Table(name, "silo", times, columns)
    if not set(ZONES) <= set(names):
        raise error(path, f"columns {', '.join(ZONES)} of grains in zones", ",".join(names))
    return Table(name, "drum", times, columns)


def impact(path, names, rows, name):
    table = Table(name, "impact", [])
    kept = []
    for number, values in rows:
        if table.times and values[0] < table.times[-1]:
            raise error(f"{path}:{number}", "times that do not fall", shown(values[0]))
        if not table.times or values[0] > table.times[-1]:
            table.times.append(values[0])
            kept.append(values)
    table.repeated = len(rows) - len(kept)
    for place, column in enumerate(names, 1):
        code, _, bed = column.rpartition("_IC")
        if not code or not bed.isdigit() or not 1 <= int(bed) < 1000:
            raise error(path, "columns CODE_ICn of a code and the number of its bed", f"`{column}`")
        table.courses.append(Course(code, int(bed), table.times, [values[place] for values in kept]))
    return table


def read_tables(folder):
    paths = sorted(path for path in folder.iterdir() if path.is_file() and path.name.endswith((".csv", ".csv.gz")))
    tables = [table for table in map(read_table, paths) if table]
    if not tables:
        raise error(folder, "tables of the round robin", "none")
    return tables


# --------------------------------------------------------------------------------------------- numbers and courses


def spread(table, value):
    """Returns the mean between codes, and the standard deviations between codes and between beds.

    The deviation between beds is pooled over codes.
    """
    codes = {}
    for course in table.courses:
        if not any(course.code == code and bed in (None, course.bed) for code, bed in EXCLUDED):
            codes.setdefault(course.code, []).append(value(course))
    groups = [codes[code] for code in sorted(codes)]
    freedom = sum(len(group) - 1 for group in groups)
    if len(groups) < 2 or freedom == 0 or any(number is None for group in groups for number in group):
        return None
    squares = [total([(number - mean(group)) ** 2 for number in group]) for group in groups]
    means = [mean(group) for group in groups]
    return mean(means), deviation(means), math.sqrt(total(squares) / freedom)


def millimetres(height):
    return None if height is None else height * 1e3


def value_entry(key, what, number):
    return f'\n[[value]]\nkey = "{key}"\nwhat = "{what}"\nvalue = {number:.4f}\n'


def entries_of(text):
    """Returns the entries of provenance.toml by key. Numbers with an uncertainty are quoted and not derived."""
    entries = re.findall(r'key = "(.*)"\nwhat = "(.*)"\nvalue = (.*)\n(uncertainty = )?', text)
    return {key: (what, value) for key, what, value, uncertainty in entries if not uncertainty}


def impact_values(table):
    """Returns the derived numbers of the impact in the format of provenance.toml."""
    quantities = []
    for time in (25, 28, 30, 32, 35, 40, 50):
        what = f"height of the ball at {time} ms, 25 thousand grains"
        value = spread(table, lambda course: millimetres(course.height(time * 1e-3)))
        quantities.append((f"height_{time}", what, "mm", value))
    what = "deepest point of the ball, 25 thousand grains"
    quantities.append(("deepest", what, "mm", spread(table, lambda course: min(course.heights) * 1e3)))
    what = "mean velocity of the ball from 38 to 50 ms, 25 thousand grains"
    quantities.append(("rebound", what, "m/s", spread(table, lambda course: course.velocity(0.038, 0.050))))
    statistics = (
        ("", "mean between codes"),
        ("_code", "standard deviation between codes"),
        ("_bed", "standard deviation between beds, pooled over codes"),
    )
    return "".join(
        value_entry(key + suffix, f"{what}: {statistic} ({unit})", number)
        for key, what, unit, values in quantities
        if values
        for (suffix, statistic), number in zip(statistics, values)
    )


def impact_course(table):
    lines = ["t,mean,code,bed\n"]
    for time in table.times:
        values = spread(table, lambda course: millimetres(course.height(time)))
        if values:
            lines.append(f"{shown(time)},{values[0]:.4f},{values[1]:.4f},{values[2]:.4f}\n")
    return "".join(lines)


def height_alone(table, time):
    """Returns the height of the only ball (mm) at a time since its release. The clock error is corrected."""
    if len(table.courses) != 1:
        return None
    course = table.courses[0]
    return millimetres(course.height(time - course.clock_error()))


def run_values(table):
    """Returns the heights of a single run after the first impact, and at rest in a deep bed."""
    heights = [(time, height_alone(table, time * 1e-3)) for time in (30, 60)]
    key = table.name.replace("-", "_")
    return "".join(
        value_entry(f"{key}_height_{time}", f"height of the ball at {time} ms, {table.name} (mm)", height)
        for time, height in heights
        if height is not None
    )


def pair(tables, words, value):
    """Returns the mean of two codes and half their difference, which is None for a single code."""
    found = [
        next((table for table in tables if words in table.name and table.name.endswith(f"_{code}")), None)
        for code in CODES
    ]
    values = [value(table) for table in found if table]
    if not values or None in values:
        return None
    return (values[0], None) if len(values) == 1 else (0.5 * (values[0] + values[1]), 0.5 * abs(values[0] - values[1]))


def pair_values(tables):
    """Returns the derived numbers of silo, drum and deep beds in the format of provenance.toml."""
    quantities = []
    for key, orifice, start, end in (
        ("silo_large_rate", "large", 0.5, 3.5),
        ("silo_large_early", "large", 0.2, 0.8),
        ("silo_small_rate", "small", 0.5, 2.0),
    ):
        period = f"between {shown(start)} and {shown(end)} s of flow (thousands a second)"
        value = pair(tables, orifice, lambda table: table.rate(start, end))
        quantities.append((key, f"grains out of the {orifice} orifice {period}", value))
    value = pair(tables, "large", lambda table: 1e-3 * (table.left(0.0) - table.left(2.0)))
    quantities.append(("silo_large_out_2", "grains out of the large orifice in 2 s (thousands)", value))
    for thousands, time in ((50, 30), (100, 30), (100, 60)):
        what = f"height of the ball at {time} ms, {thousands} thousand grains, one bed (mm)"
        value = pair(tables, f"case3_{thousands}k", lambda table: height_alone(table, time * 1e-3))
        quantities.append((f"height_{time}_{thousands}k", what, value))
    entries = []
    for key, what, value in quantities:
        if value is None:
            continue
        basis = "MUSEN alone" if value[1] is None else "mean of LIGGGHTS and MUSEN"
        entries.append(value_entry(key, f"{what}: {basis}", value[0]))
        if value[1] is not None:
            entries.append(value_entry(f"{key}_half", f"{what}: half the difference of LIGGGHTS and MUSEN", value[1]))
    return "".join(entries)


def pair_course(tables, words, times, value):
    lines = []
    for time in times:
        found = pair(tables, words, lambda table: value(table, time))
        if found and found[1] is not None:
            lines.append(f"{time:.1f},{shown(found[0])},{shown(found[1])}\n")
    return "t,mean,half\n" + "".join(lines) if lines else None


# ------------------------------------------------------------------------------------------ consistency of the data


def findings(tables):
    """Returns rows of table, object, quantity, found and expected value."""
    rows, first = [], None
    for table in tables:
        found = []
        if table.kind == "impact":
            found = impact_findings(table)
        elif table.kind == "drum":
            found = repeated_counts(table) + (drum_differences(table, first) if first else [])
            first = first or table
        # A course that is alone in its file has the same name as the file.
        rows += [(table.name, "" if about == table.name else about, *rest) for about, *rest in found]
    return rows


def impact_findings(table):
    rows = []
    if table.repeated:
        rows.append(("clock", "rows with the time of the row before", str(table.repeated), "0"))
    flown = []
    for course in table.courses:
        # The velocity between 1 ms and 2 ms. The first sample is not used, because a clock error in this sample alone
        # is not a different release.
        speed = course.velocity(0.001, 0.002)
        speed = None if speed is None else speed + GRAVITY * 0.5 * (0.001 + 0.002)
        if speed is None or abs(speed - RELEASE) <= OTHER_RELEASE:
            flown.append(course)
        else:
            name = f"{course.code}, bed {course.bed}"
            rows.append((name, "velocity at the start", f"{speed:.2f} m/s", f"{shown(RELEASE)} m/s"))
    codes = {}
    for course in flown:
        codes.setdefault(course.code, []).append(course)
    rows += clock_errors(table, codes)
    if len(table.courses) > 1:
        rows += shifted_numbers(codes) + outliers(codes)
    return rows


def clock_errors(table, codes):
    rows = []
    for code, courses in codes.items() if len(table.times) > 1 else ():
        ahead, later = (mean([course.lift(time) for course in courses]) / RELEASE for time in table.times[:2])
        if max(abs(ahead), abs(later)) > 1e-5:
            found = f"{scientific(ahead, 2)} s, and {scientific(later, 1)} s at the next"
            rows.append((code, "clock ahead at its first sample", found, "0 s"))
    return rows


def shifted_numbers(codes):
    """Returns the beds that have other numbers in other codes.

    The height above free flight at the first contact identifies a bed, because all codes agree on it.
    """
    prints = {
        code: [(course.bed, lift) for course in courses if (lift := course.lift(CONTACT)) is not None]
        for code, courses in codes.items()
    }
    every = [entry for lifts in prints.values() for entry in lifts]

    def usual(bed):
        lifts = sorted(lift for number, lift in every if number == bed)
        return lifts[len(lifts) // 2] if lifts else None

    def size(lifts, shift):
        off = [lift - usual(bed - shift) for bed, lift in lifts if usual(bed - shift) is not None]
        return math.sqrt(total([value * value for value in off]) / len(off)) if off else math.nan

    rows = []
    for code, lifts in prints.items():
        same, shifted = size(lifts, 0), size(lifts, 1)
        if len(lifts) < 3 or same < SAME_BED or shifted > SAME_BED:
            continue
        others = "".join(
            f"; its bed {bed} (held up by {lift * 1e6:.0f} µm) is none of the others'"
            for bed, lift in lifts
            if sum(abs(lift - other) < SAME_BED for _, other in every) < 2
        )
        found = (
            f"within {same * 1e6:.0f} µm, and within {shifted * 1e6:.1f} µm of those one number lower: "
            f"its beds are the others' under numbers one higher{others}"
        )
        quantity = "how far its beds hold the ball up at 22 ms, beside beds of the same number"
        rows.append((code, quantity, found, f"within {SAME_BED * 1e6:.0f} µm"))
    return rows


def outliers(codes):
    """Returns beds and codes that are outliers at 30 ms."""
    depths = {
        code: {course.bed: depth for course in courses if (depth := millimetres(course.height(0.030))) is not None}
        for code, courses in codes.items()
    }
    rows, excluded = [], set()
    for code, beds in depths.items():
        for bed, depth in beds.items():
            rest = [other for number, other in beds.items() if number != bed]
            off = depth - mean(rest) if rest else 0.0
            if len(rest) > 2 and abs(off) > 2.0 * OUTLIER * deviation(rest):
                found = (
                    f"{depth:.2f} mm, {abs(off):.1f} mm {'below' if off < 0 else 'above'} the mean of its code's other "
                    f"beds, {abs(off) / deviation(rest):.0f} of their deviations"
                )
                rows.append((f"{code}, bed {bed}", "height at 30 ms", found, f"within {2 * OUTLIER:.0f} deviations"))
                excluded.add((code, bed))
    known = {
        code: [depth for bed, depth in beds.items() if (code, bed) not in excluded] for code, beds in depths.items()
    }
    means = {code: mean(values) for code, values in known.items() if values}
    for code, depth in means.items():
        rest = [other for name, other in means.items() if name != code]
        off = depth - mean(rest) if rest else 0.0
        if len(rest) > 2 and abs(off) > OUTLIER * deviation(rest):
            found = (
                f"{depth:.2f} mm, {abs(off) / deviation(rest):.1f} deviations between the other codes "
                f"{'below' if off < 0 else 'above'} their mean"
            )
            rows.append((code, "height at 30 ms, mean of its beds", found, f"within {OUTLIER:.0f} deviations"))
    return rows


def repeated_counts(drum):
    """Returns the frames of a drum that were counted twice."""
    rows = []
    frames = list(zip(*(drum.columns[zone] for zone in ZONES)))
    for row in range(2, len(frames)):
        before, now = total(frames[row - 1]), total(frames[row])
        if now > 1.6 * before and all(count % 2.0 == 0.0 for count in frames[row]):
            times = now / before if before else math.inf
            found = f"{times:.2f} times those of a sample before, and all four numbers even: counted twice"
            rows.append((f"t = {shown(drum.times[row])} s", "grains in both zones", found, "about as many"))
    return rows


def drum_differences(drum, first):
    rows = []
    for time in (0.5, 1.0, 2.0):
        count, other = drum.in_zone_2(time), first.in_zone_2(time)
        if count is not None and other and abs(count / other - 1.0) > SAME_DRUM:
            found = f"{shown(count)}, {100.0 * (count / other - 1.0):+.1f} % of {first.name}'s {shown(other)}"
            rows.append((f"t = {shown(time)} s", "M1 in zone 2", found, f"within {100 * SAME_DRUM:.0f} %"))
    return rows


# -------------------------------------------------------------------------------------------------- initial state


def drum_files(path):
    """Returns LAMMPS data files of the grains M1 and M2, with the origin at the centre of the drum."""
    kinds = {"0": [], "1": []}
    lines = [text.split() for _, text in lines_of(path)]
    if not lines or len(lines[0]) != 1 or not lines[0][0].isdigit() or len(lines) < int(lines[0][0]) + 2:
        raise error(path, "a number of grains, a line with the box and the grains", "another file")
    for number, (kind, *position) in enumerate(lines[2 : int(lines[0][0]) + 2], 3):
        if kind not in kinds or len(position) != 3:
            raise error(f"{path}:{number}", "a type, 0 or 1, and three coordinates", " ".join([kind, *position]))
        centre = [float(text) - origin for text, origin in zip(position, (0.102, 0.032, 0.102))]
        # 1e-9 m is finer than the file. This removes the rounding error of the subtraction.
        kinds[kind].append([math.copysign(math.floor(abs(at * 1e9) + 0.5), at) / 1e9 for at in centre])

    def text(centres, diameter, density):
        head = f"grains\n\n{len(centres)} atoms\n1 atom types\n\n-2 2 xlo xhi\n-2 2 ylo yhi\n-2 2 zlo zhi\n"
        rows = (
            f"{number} 1 {diameter} {density} {' '.join(map(shown, centre))}\n"
            for number, centre in enumerate(centres, 1)
        )
        return f"{head}\nAtoms # sphere\n\n{''.join(rows)}"

    return {
        "drum-m2.data": text(kinds["0"], 0.004, 2000),
        "drum-m1.data": text(kinds["1"], 0.002, 2500),
        "drum.toml": (HERE / "drum.toml").read_text(encoding="utf-8"),
    }


# ---------------------------------------------------------------------------------------------------------- output


def derive(folder):
    """Returns the derived files by name, and the tables."""
    tables = read_tables(folder)
    impacts = [table for table in tables if table.kind == "impact"]
    files = {}
    values = ["# Derived by derive.py from a copy of the published data.\n"]
    for table in impacts:
        if len(table.courses) == 1:
            values.append(run_values(table))
        elif "impact-25k.csv" in files:
            raise error(folder, "one table with the ball of several codes", "several")
        else:
            values.append(impact_values(table))
            files["impact-25k.csv"] = impact_course(table)
    silos = [table for table in tables if table.kind == "silo"]
    drums = [table for table in tables if table.kind == "drum"]
    values.append(pair_values(silos + impacts))
    left = (0.5, 1.0, 1.5, 2.0, 2.5, 3.0, 3.5, 4.0, 4.3)
    files["silo-large.csv"] = pair_course(silos, "large", left, lambda table, time: table.left(time))
    tenths = [step * 0.1 for step in range(1, 11)]
    files["drum-zone-2.csv"] = pair_course(drums, "case2", tenths, lambda table, time: table.in_zone_2(time))
    files["values.toml"] = "".join(values)
    rows = "".join(f"| {' | '.join(row)} |\n" for row in findings(tables))
    files["consistency.md"] = (
        "## Consistency of the published data\n\nComputed by `python3 reference/literature/dosta-2024/derive.py DATA` "
        "from the tables in DATA. Where these are copies: to be confirmed against the source.\n\n"
        f"| table | of | quantity | found | expected |\n|---|---|---|---|---|\n{rows}"
    )
    starts = sorted(folder.glob("*.xyz"))
    files |= drum_files(starts[0]) if starts else {}
    return {name: text for name, text in files.items() if text}, tables


def plot(tables, out):
    """Plots the published curves, the mean over the beds for each code."""
    from matplotlib import pyplot

    for table in tables:
        figure, axes = pyplot.subplots()
        codes = {}
        for course in table.courses:
            codes.setdefault(course.code, []).append(course.heights)
        for code, heights in codes.items():
            axes.plot([time * 1e3 for time in table.times], [mean(row) * 1e3 for row in zip(*heights)], label=code)
        for column in {"drum": ZONES, "silo": ("count",)}.get(table.kind, ()):
            axes.plot(table.times, table.columns[column], label=column)
        is_impact = table.kind == "impact"
        axes.set_xlabel("time (ms)" if is_impact else "time (s)")
        axes.set_ylabel("height of the ball (mm)" if is_impact else "grains")
        axes.legend()
        figure.savefig(out / f"{table.name}.svg")
        pyplot.close(figure)


def compare(files):
    """Returns the differences between derived files and the stored ones."""
    differences = []
    for name in ("impact-25k.csv", "silo-large.csv", "drum-zone-2.csv", "consistency.md"):
        if files.get(name) != (HERE / name).read_text(encoding="utf-8"):
            differences.append(f"{name}: differs from the stored file")
    derived = entries_of(files["values.toml"])
    for key, stored in entries_of((HERE / "provenance.toml").read_text(encoding="utf-8")).items():
        if derived.get(key) != stored:
            differences.append(f"{key}: derived {derived.get(key)}, stored {stored}")
    return differences


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("data", metavar="DATA", type=Path)
    parser.add_argument("--out", metavar="DIR", type=Path, default=Path("dosta-2024-derived"))
    parser.add_argument("--plot", action="store_true", help="plot the curves of each code (needs matplotlib)")
    parser.add_argument("--check", action="store_true", help="compare with the stored files")
    arguments = parser.parse_args()
    files, tables = derive(arguments.data)
    if arguments.check:
        differences = compare(files)
        print("\n".join(differences) or "equal to the stored files")
        sys.exit(1 if differences else 0)
    arguments.out.mkdir(parents=True, exist_ok=True)
    for name, text in files.items():
        (arguments.out / name).write_text(text, encoding="utf-8")
    if arguments.plot:
        plot(tables, arguments.out)
    for table in tables:
        if table.kind == "silo" and (rate := table.rate(0.5, 3.5)) is not None:
            print(f"{table.name}: {rate:.2f} thousand grains leave per second from 0.5 to 3.5 s")
    for row in findings(tables):
        print(f"{': '.join(filter(None, row[:3]))}: {row[3]}; expected {row[4]}")
    print(arguments.out)


if __name__ == "__main__":
    try:
        main()
    except (InputError, OSError) as problem:
        print(problem, file=sys.stderr)
        sys.exit(2)
