"""Every DEM and raster of the test data, and what must become of it. A file without a row fails the test."""
import pathlib
import time

from harness import ROUND_TRIP_FILES, TEST_DATA, case, gdal, main, require, run
from raster_judge import largest_difference, same_raster

IDENTICAL, ROUNDED, REFUSED = "identical", "within half a quantum", "refused"

# (file, options, what becomes of it, exit code and words of a refusal)
TABLE = [
    # Two columns of a larger DEM, and whole as such.
    ("dem/39109h1_truncated.dem", [], ROUNDED),
    ("dem/N00E010.hgt", [], IDENTICAL),
    ("dem/N41E001.hgt.zip", [], IDENTICAL),
    ("dem/N42E001.hgt.zip", [], IDENTICAL),
    ("dem/N48W125.hgt.zip", [], IDENTICAL),
    ("dem/SainteHelens.dem", [], IDENTICAL),
    ("dem/mt_everest_90m.tif", [], IDENTICAL),
    ("dem/mt_rainier_90m.tif", [], IDENTICAL),
    ("dem/n00_e006_3arc_v2.dt1", [], IDENTICAL),
    ("dem/n43.dt0", [], IDENTICAL),
    ("dem/n43_bad_crc.dt0", [], REFUSED, 1, ["checksum"]),
    ("dem/n43_partial_cols.dt0", [], IDENTICAL),
    ("dem/rainier_filled.tif", [], IDENTICAL),
    ("dem/rio_rgbify_elev.tif", [], ROUNDED),
    ("dem/ta.tif", [], REFUSED, 2, ["5 bands", "--band"]),
    ("dem/ta.tif", ["--band", "1"], ROUNDED),
    ("dem/ta.tif", ["--band", "4"], IDENTICAL),
    ("dem/w118n033_trunc.dt1", [], REFUSED, 1, ["read to its end"]),
    ("pair/craterlake-elev-16bit-30m.tif", [], IDENTICAL),
    ("pair/craterlake-imagery-30m.tif", [], REFUSED, 2, ["4 bands", "--band"]),
    ("pair/lf_elev_220_mt_hood_utm.tif", [], IDENTICAL),
    # Classes, but nothing in the file says so: whole numbers in one band, as elevations are.
    ("pair/lf_fbfm40_220_mt_hood_utm.tif", [], IDENTICAL),
    ("pair/sba_elev32_wgs84_512x512.tif", [], REFUSED, 2, ["--crs"]),
    ("pair/sba_elev32_wgs84_512x512.tif", ["--crs", "EPSG:4326"], ROUNDED),
    ("pair/sba_rgb_wgs84_512x512.tif", [], REFUSED, 2, ["3 bands", "--band"]),
    ("pair/zion_nlcd.tif", [], REFUSED, 1, ["colour table"]),
    ("pair/zion_srtm.tif", [], IDENTICAL),
]


def refused(source, options, code, words, folder):
    before = sorted(folder.iterdir())
    ended = run("dbbuild", "terrain", source, "-o", folder / "refused.dz", *options, expect=code, words=words)
    require(sorted(folder.iterdir()) == before, f"something was left: {ended}")
    return f"exit {code}: {ended.err.strip().splitlines()[-1]}"


def number(fraction):
    above, _, below = fraction.partition("/")
    return float(above) / float(below or 1)


def built(source, options, outcome, folder):
    area, exported = folder / "area.dz", folder / "exported.tif"
    ended = run("dbbuild", "terrain", source, "-o", area, *options, "--overwrite", "--json")
    for warning in ended.json()["warnings"]:
        require(f"dbbuild: warning: {warning}" in ended.err, ended)
    grid = run("dbbuild", "info", area, "--json").json()["grids"][0]
    verdict = run("dbcheck", area, "--level", "decode", "--against", source)
    require(verdict.out.splitlines()[0] == f"{area}: valid", verdict)
    run("dbbuild", "export", area, "-o", exported, "--overwrite")
    described = f"{grid['kind']}, quantum {grid['quantum']} m"
    if grid["patches"]:
        described += f", patches within {grid['patches']['error']:.1e} m"
    if ended.json()["warnings"]:
        described += f"; {len(ended.json()['warnings'])} warning"
    if grid["sources"][0]["band"] > 1 or "--band" in options:
        gdal("gdal_translate", "-q", "-b", grid["sources"][0]["band"], source, folder / "band.tif")
        source = folder / "band.tif"
    if outcome == IDENTICAL:
        require(grid["height_error"] == 0, f"{source.name}: heights are rounded by {grid['height_error']} m")
        same_raster(source, exported, folder)
        return described
    largest = largest_difference(source, exported, folder)
    # A float that stands for half a quantum may itself be rounded.
    require(0 < largest <= number(grid["quantum"]) / 2 + 1e-4 and largest <= grid["height_error"] + 1e-4,
            f"{source.name}: {largest} m apart, {grid['height_error']} m were stated")
    return f"{described}; largest {largest:.6f} m, stated {grid['height_error']:.6f} m"


@case
def every_file_of_the_test_data_has_its_row(folder):
    if not TEST_DATA:
        print("DELTAZ_TEST_DATA is not set: nothing to do")
        return
    data = pathlib.Path(TEST_DATA)
    there = {f"{kind}/{file.name}" for kind in ("dem", "pair") for file in (data / kind).iterdir()}
    listed = {row[0] for row in TABLE}
    require(there == listed, f"without a row: {sorted(there - listed)}; without a file: {sorted(listed - there)}")
    faults = []
    for name, options, outcome, *refusal in TABLE:
        begin = time.monotonic()
        if pathlib.Path(name).name in ROUND_TRIP_FILES:
            require(outcome == IDENTICAL, f"{name} comes back post for post")
            print(f"       {name}: round_trip_test.py")
            continue
        try:
            if outcome == REFUSED:
                told = refused(data / name, options, *refusal, folder)
            else:
                told = built(data / name, options, outcome, folder)
            mark = "ok"
        except Exception as fault:  # noqa: BLE001: the whole table is wanted, whatever fails
            told, mark = str(fault), "FAILED"
            faults.append(name)
        print(f"{mark:6} {' '.join([name, *options]):48} {outcome:22} {time.monotonic() - begin:5.1f} s  {told}", flush=True)
    require(not faults, f"not as the table says: {faults}")


if __name__ == "__main__":
    main()
