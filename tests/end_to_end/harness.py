"""What the end-to-end tests share: running the tools, judging how they end, real files, and independent eyes (GDAL's own programs).

A test script defines functions marked @case; each gets an empty folder of its own. `script.py --list` prints their names (CMake makes one
ctest case of each), `script.py NAME` runs one. A case fails by an exception.
"""
import contextlib
import json
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile

SAMPLES = pathlib.Path(os.environ.get("DELTAZ_SAMPLES", pathlib.Path(__file__).resolve().parents[2] / "samples"))
RAINIER = SAMPLES / "mt_rainier.tif"
TEST_DATA = os.environ.get("DELTAZ_TEST_DATA", "")
# The geodetic integer DEMs that must come back post for post.
ROUND_TRIP_FILES = ["mt_rainier_90m.tif", "mt_everest_90m.tif", "N48W125.hgt.zip", "N00E010.hgt", "N42E001.hgt.zip", "n43.dt0",
                    "n00_e006_3arc_v2.dt1"]
LIMIT_SECONDS = 240

_cases = {}


def case(function):
    _cases[function.__name__] = function
    return function


def main():
    if sys.argv[1:] == ["--list"]:
        print("\n".join(_cases))
        return
    for name in sys.argv[1:] or _cases:
        with tempfile.TemporaryDirectory(prefix="deltaz-") as folder:
            _cases[name](pathlib.Path(folder))
        print(f"passed: {name}")


def require(condition, message):
    """As assert, but also under python -O."""
    if not condition:
        raise AssertionError(message)


def program(tool):
    return os.environ["DELTAZ_" + tool.upper()]


class Ended:
    def __init__(self, command, process):
        self.command = " ".join(str(word) for word in command)
        self.code, self.out, self.err = process.returncode, process.stdout, process.stderr

    def __str__(self):
        return f"{self.command}\nexit code {self.code}\n{self.out}{self.err}"

    def json(self):
        return strict_json(self.out, self)


def run(tool, *arguments, expect=0, words=(), **options):
    """Runs a tool and requires its exit code, the words in its message, and that an error line and the code agree."""
    command = [program(tool), *map(str, arguments)]
    process = subprocess.run(command, capture_output=True, text=True, timeout=LIMIT_SECONDS, check=False, **options)
    ended = Ended(command, process)
    require(ended.code == expect, f"exit code {expect} was expected:\n{ended}")
    for word in words:
        require(word in ended.err, f"'{word}' is missing in the message:\n{ended}")
    says_error = any("error:" in line.lower().split("'")[0] or line.startswith("ERROR") for line in ended.err.splitlines())
    require(says_error <= (ended.code != 0), f"an error line, and exit code 0:\n{ended}")
    if ended.code not in (0, 1):
        require(f"{tool}: error: " in ended.err, f"no error line:\n{ended}")
    return ended


def strict_json(text, origin=""):
    """RFC 8259 and nothing more: Python's parser takes NaN and repeated members, this one does not."""
    def no_constant(word):
        raise AssertionError(f"{word} is not JSON: {origin}")

    def no_repetition(pairs):
        require(len({name for name, _ in pairs}) == len(pairs), f"a member stands twice: {origin}")
        return dict(pairs)

    return json.loads(text, parse_constant=no_constant, object_pairs_hook=no_repetition)


def gdal(*command):
    """Runs one of GDAL's programs: the independent judge."""
    return subprocess.run([str(word) for word in command], capture_output=True, text=True, timeout=LIMIT_SECONDS, check=True).stdout


def real_files():
    """The real DEMs there are: the sample, and those of DELTAZ_TEST_DATA. Says so in the log."""
    files = [RAINIER]
    if TEST_DATA:
        folder = pathlib.Path(TEST_DATA) / "dem"
        files += [folder / name for name in ROUND_TRIP_FILES if (folder / name).exists()]
        require(len(files) > 1, f"DELTAZ_TEST_DATA is set, and there is none of the real files in {folder}")
    for file in files:
        print(f"real file: {file.name}")
    print(f"real files: {len(files)}")
    return files


def small_dem(folder, name="small.asc", columns=40, rows=30, void=True, system="EPSG:4326"):
    """A DEM of a few posts, quick to build; returns a GeoTIFF, without CRS where `system` is empty."""
    lines = [f"ncols {columns}", f"nrows {rows}", "xllcorner 7.0", "yllcorner 46.0", "cellsize 0.01", "NODATA_value -9999"]
    for row in range(rows):
        heights = [-9999 if void and row == 3 and 5 <= column < 9 else (row * 37 + column * column) % 900 for column in range(columns)]
        lines.append(" ".join(map(str, heights)))
    text = folder / name
    text.write_text("\n".join(lines) + "\n")
    target = text.with_suffix(".tif")
    gdal("gdal_translate", "-q", "-ot", "Int16", *(["-a_srs", system] if system else []), text, target)
    return target


def build(folder, dem=None, name="area.dz", *options):
    """Builds a database, from the small DEM unless told otherwise."""
    target = folder / name
    run("dbbuild", "terrain", dem or small_dem(folder), "-o", target, *options)
    return target


def folder_bytes(folder):
    """Everything in a folder, name -> bytes, without the writers' lock."""
    return {file.name: file.read_bytes() for file in folder.iterdir() if file.name != "lock"}


def no_leftovers(folder, message=""):
    left = [entry.name for entry in folder.rglob("*") if ".tmp-" in entry.name]
    require(not left, f"left over: {left} {message}")


def reseal(area, old, new):
    """Replaces text in area.json and makes its hash right again: a database that only a rule about meaning can refuse."""
    subprocess.run([os.environ["DELTAZ_RESEAL_AREA"], str(area / "area.json"), old, new], check=True)


def newer_database(folder):
    area = build(folder, None, "newer.dz")
    reseal(area, '"version": 1', '"version": 2')
    return area


def damaged_database(folder):
    """A database with one bit of its terrain changed."""
    area = build(folder, None, "damaged.dz")
    flip_bit(next(file for file in area.iterdir() if file.name.startswith("terrain")))
    return area


def flip_bit(file, position=None):
    content = bytearray(file.read_bytes())
    content[len(content) // 2 if position is None else position] ^= 1
    file.write_bytes(content)


@contextlib.contextmanager
def kept(source, target):
    """A copy of a database to be changed."""
    shutil.copytree(source, target)
    try:
        yield target
    finally:
        shutil.rmtree(target)
