"""Several sources as one area, and the options that say how sources become grids."""
import json
import math
import pathlib
import subprocess
import zipfile

from harness import RAINIER, TEST_DATA, case, gdal, main, require, run, small_dem
from raster_judge import raw_posts, same_raster, values


def info(area):
    return run("dbbuild", "info", area, "--json").json()


@case
def neighbouring_tiles_become_one_grid_exactly(folder):
    if not TEST_DATA:
        print("DELTAZ_TEST_DATA is not set: nothing to do")
        return
    south, north = (pathlib.Path(TEST_DATA) / "dem" / f"{name}.hgt.zip" for name in ("N41E001", "N42E001"))
    area, exported = folder / "both.dz", folder / "both.tif"
    run("dbbuild", "terrain", south, north, "-o", area)
    grids = info(area)["grids"]
    require(len(grids) == 1 and grids[0]["latitude"]["count"] == 2401 and len(grids[0]["sources"]) == 2, grids)
    run("dbcheck", area, "--level", "all", "--against", south, north)
    run("dbbuild", "export", area, "-o", exported)
    row = 2 * 1201
    below, above, both = raw_posts(south, folder), raw_posts(north, folder), raw_posts(exported, folder)
    # The border row is in both; the southern tile is named first, and a void never wins.
    require(both[:1200 * row] == above[:1200 * row], "the northern tile is not as it was")
    require(both[1201 * row:] == below[row:], "the southern tile is not as it was")
    border = zip(values(exported, folder)[1200 * 1201:1201 * 1201], values(south, folder)[:1201], values(north, folder)[-1201:], strict=True)
    require(all(found == (first if first != -32768 else second) for found, first, second in border), "the border row")
    # A tile alone is not all the area was built from: what comes from the other is not vouched for.
    report = run("dbcheck", area, "--against", south, "--json", expect=4).json()
    require(not report["complete"] and not report["issues"] and report["checked"]["posts_compared"] == 1200 * 1201, report)
    require(len(report["skipped"]) == 1 and "N42E001.hgt" in report["skipped"][0] and str(1201 * 1201) in report["skipped"][0], report)


@case
def the_halves_of_a_source_become_the_whole_exactly(folder):
    south, north, area, exported = folder / "south.tif", folder / "north.tif", folder / "both.dz", folder / "both.tif"
    gdal("gdal_translate", "-q", "-srcwin", "0", "0", "1201", "701", RAINIER, north)
    gdal("gdal_translate", "-q", "-srcwin", "0", "600", "1201", "601", RAINIER, south)
    run("dbbuild", "terrain", south, north, "-o", area)
    require(len(info(area)["grids"]) == 1, "two halves of one lattice are one grid")
    run("dbbuild", "export", area, "-o", exported)
    require(raw_posts(exported, folder) == raw_posts(RAINIER, folder), "the whole is not as it was")


@case
def an_inset_of_finer_posts_is_a_grid_of_its_own(folder):
    coarse, large, fine = RAINIER, folder / "large.tif", folder / "fine.tif"
    if TEST_DATA:
        # The system's Python, which has GDAL's module (scripts/setup.sh test).
        data = pathlib.Path(TEST_DATA)
        subprocess.run(["/usr/bin/python3", data / "make_large_dem.py", data / "dem" / "rainier_filled.tif", "3", large], check=True)
    else:
        # Posts of 1 arc-second between and on those of the sample.
        half = 0.5 / 3600
        gdal("gdalwarp", "-q", "-r", "bilinear", "-tr", 1 / 3600, 1 / 3600, "-te", -122 - half, 46 - half, -121 + half, 47 + half, coarse, large)
    gdal("gdal_translate", "-q", "-srcwin", "700", "1500", "901", "601", large, fine)
    area = folder / "inset.dz"
    run("dbbuild", "terrain", coarse, fine, "-o", area)
    grids = info(area)["grids"]
    require([grid["sources"][0]["name"] for grid in grids] == ["fine.tif", coarse.name], "the finer grid comes first")
    for number, source in ((0, fine), (1, coarse)):
        exported = folder / f"grid{number}.tif"
        run("dbbuild", "export", area, "-o", exported, "--grid", number)
        same_raster(source, exported, folder)
    run("dbcheck", area, "--level", "all", "--against", coarse, fine)
    run("dbbuild", "export", area, "-o", folder / "none.tif", "--grid", "2", expect=2, words=["--grid"])


@case
def projected_sources_come_back_as_they_were(folder):
    small = small_dem(folder)
    for system in ("EPSG:32632", "EPSG:3857", "EPSG:2056", "EPSG:5514"):
        source = folder / f"{system[5:]}.tif"
        gdal("gdalwarp", "-q", "-t_srs", system, "-tr", "500", "500", small, source)
        area, exported = folder / f"{system[5:]}.dz", folder / f"{system[5:]}.out.tif"
        run("dbbuild", "terrain", source, "-o", area)
        require(info(area)["grids"][0]["kind"] == "projected", "not on its own grid")
        run("dbcheck", area, "--level", "decode", "--against", source)
        run("dbbuild", "export", area, "-o", exported)
        same_raster(source, exported, folder)
    # Another projection with the same numbers is another place.
    gdal("gdal_translate", "-q", "-a_srs", "EPSG:32633", folder / "32632.tif", folder / "moved.tif")
    ended = run("dbcheck", folder / "32632.dz", "--against", folder / "moved.tif", "--json", expect=1)
    require("SRC_GEOREFERENCE" in {issue["code"] for issue in ended.json()["issues"]}, ended)


@case
def every_type_scale_and_unit_comes_back(folder):
    small = small_dem(folder)
    for name, options in {"byte": ["-ot", "Byte", "-scale", "0", "900", "1", "255", "-a_nodata", "0"], "uint16": ["-ot", "UInt16", "-a_nodata", "65535"],
                          "int32": ["-ot", "Int32"], "uint32": ["-ot", "UInt32", "-a_nodata", "4294967295"], "float32": ["-ot", "Float32"],
                          "float64": ["-ot", "Float64"], "tenths": ["-ot", "Float32", "-scale", "0", "1000", "0", "100"],
                          "scaled": ["-a_scale", "0.1", "-a_offset", "-100.5"], "feet": ["-ot", "Float32", "-a_nodata", "-9999"]}.items():
        source, area, exported = folder / f"{name}.tif", folder / f"{name}.dz", folder / f"{name}.out.tif"
        gdal("gdal_translate", "-q", *options, small, source)
        if name == "feet":
            gdal("gdal_translate", "-q", "-of", "VRT", source, folder / "feet.vrt")
            text = (folder / "feet.vrt").read_text().replace("<ColorInterp>", "<UnitType>ft</UnitType><ColorInterp>")
            (folder / "feet.vrt").write_text(text)
            source = folder / "feet.vrt"
        run("dbbuild", "terrain", source, "-o", area)
        run("dbcheck", area, "--level", "all", "--against", source)
        run("dbbuild", "export", area, "-o", exported)
        same_raster(source, exported, folder)
        for told in ("scale", "offset"):
            wanted, found = (json.loads(gdal("gdalinfo", "-json", file))["bands"][0].get(told) for file in (source, exported))
            require(wanted == found, f"{name}: {told} was {wanted} and came back as {found}")


@case
def an_archive_of_several_rasters_is_several_sources(folder):
    whole = small_dem(folder, void=False)
    gdal("gdal_translate", "-q", "-srcwin", "0", "0", "25", "30", whole, folder / "west.tif")
    gdal("gdal_translate", "-q", "-srcwin", "20", "0", "20", "30", whole, folder / "east.tif")
    with zipfile.ZipFile(folder / "both.zip", "w") as archive:
        archive.write(folder / "west.tif", "tiles/west.tif")
        archive.write(folder / "east.tif", "tiles/more/east.tif")
        archive.writestr("tiles/readme.txt", "Two tiles")
    area, exported = folder / "both.dz", folder / "both.tif"
    run("dbbuild", "terrain", folder / "both.zip", "-o", area)
    run("dbcheck", area, "--against", folder / "both.zip")
    run("dbbuild", "export", area, "-o", exported)
    same_raster(whole, exported, folder)
    run("dbbuild", "terrain", f"/vsizip/{folder}/both.zip/tiles/west.tif", "-o", folder / "one.dz")


@case
def a_cut_area_holds_the_sources_own_posts(folder):
    area, exported, window = folder / "cut.dz", folder / "cut.tif", folder / "window.tif"
    west, dx, _, north, _, dy = json.loads(gdal("gdalinfo", "-json", RAINIER))["geoTransform"]
    # Posts 20 to 100 eastwards and 30 to 90 southwards, named a little inside.
    bounds = [west + 20.9 * dx, north + 90.1 * dy, west + 100.1 * dx, north + 30.9 * dy]
    run("dbbuild", "terrain", RAINIER, "-o", area, "--bounds", ",".join(map(repr, bounds)))
    run("dbcheck", area, "--level", "all", "--against", RAINIER)
    run("dbbuild", "export", area, "-o", exported)
    gdal("gdal_translate", "-q", "-srcwin", "20", "30", "81", "61", RAINIER, window)
    same_raster(window, exported, folder)


def globe(folder, name, west, columns, registration):
    """A height for each meridian, at whole degrees or between them."""
    shift = 0.5 if registration == "area" else 0
    lines = [f"ncols {columns}", "nrows 20", f"xllcorner {west - 0.5 + shift}", "yllcorner 20", "cellsize 1"]
    for row in range(20):
        lines.append(" ".join(str((west + column) % 360 + 7 * row) for column in range(columns)))
    text = folder / f"{name}.asc"
    text.write_text("\n".join(lines) + "\n")
    gdal("gdal_translate", "-q", "-ot", "Int16", "-a_srs", "EPSG:4326", text, folder / f"{name}.tif")
    return folder / f"{name}.tif"


@case
def a_cut_across_the_seam_of_a_globe_has_both_sides(folder):
    east, west = globe(folder, "east", 0, 181, "post"), globe(folder, "west", -180, 181, "post")
    for sources, bounds in (([globe(folder, "shared", -180, 361, "post")], "170,25,-170,30"), ([globe(folder, "cells", -180, 360, "area")], "170,25,-170,30"),
                            ([globe(folder, "from_0", 0, 360, "post")], "-10,25,10,30"), ([east, west], "170,25,-170,30"), ([west, east], "170,25,-170,30")):
        area, exported = folder / "cut.dz", folder / "cut.tif"
        run("dbbuild", "terrain", *sources, "-o", area, "--bounds", bounds, "--overwrite")
        run("dbcheck", area, "--level", "all", "--against", *sources)
        run("dbbuild", "export", area, "-o", exported, "--overwrite")
        there = json.loads(gdal("gdalinfo", "-json", exported))
        columns, rows = there["size"]
        first = math.floor(there["geoTransform"][0] + 0.75)
        require(-180 <= first < 180 and columns in (21, 22) and rows == 7, there["size"])
        above = 40 - round(there["geoTransform"][3])
        wanted = [(first + column) % 360 + 7 * (above + row) for row in range(rows) for column in range(columns)]
        require(list(values(exported, folder)) == wanted, f"{sources[0].name}: {list(values(exported, folder))[:30]} instead of {wanted[:30]}")


@case
def bounds_over_ground_that_is_not_there_leave_two_grids(folder):
    source, area = globe(folder, "most", -180, 350, "area"), folder / "two.dz"
    ended = run("dbbuild", "terrain", source, "-o", area, "--bounds", "160,25,-170,30")
    require("two grids" in ended.err, ended)
    grids = info(area)["grids"]
    require([grid["longitude"]["count"] for grid in grids] == [11, 11], grids)
    compared = run("dbcheck", area, "--level", "all", "--against", source, "--json").json()["checked"]["posts_compared"]
    require(compared == 2 * 11 * 7, compared)


@case
def a_globe_without_a_shared_meridian_is_closed_and_comes_back_as_it_was(folder):
    cells = globe(folder, "cells", -180, 360, "area")
    east, west = globe(folder, "east", 0, 180, "area"), globe(folder, "west", -180, 180, "area")
    for sources in ([cells], [east, west]):
        area, exported = folder / "globe.dz", folder / "globe.tif"
        run("dbbuild", "terrain", *sources, "-o", area, "--overwrite")
        require(info(area)["grids"][0]["longitude"]["count"] == 361, "a slit is left at the antimeridian")
        run("dbcheck", area, "--level", "all", "--against", *sources)
        run("dbbuild", "export", area, "-o", exported, "--overwrite")
        same_raster(cells, exported, folder)


@case
def a_void_is_filled_only_when_asked(folder):
    small = small_dem(folder)
    ended = run("dbbuild", "terrain", small, "-o", folder / "filled.dz", "--void", "fill", "--json").json()
    require(ended["filled"] == 4 and ended["voids"] == 0, ended)
    options = info(folder / "filled.dz")["options"]
    require(options["void"] == "fill" and options["void_filled_posts"] == "4", options)
    run("dbcheck", folder / "filled.dz", "--level", "all", "--against", small)


@case
def a_fill_leaves_what_another_source_covers_to_it(folder):
    whole = small_dem(folder, void=False)
    pieces = {"sw": (0, 15, "Int16"), "nw": (0, 0, "Float32"), "ne": (20, 0, "Int16")}
    for name, (column, row, kind) in pieces.items():
        gdal("gdal_translate", "-q", "-ot", kind, "-srcwin", column, row, 21 if column == 0 else 20, 16 if row == 0 else 15, whole, folder / f"{name}.tif")
    sources = [folder / f"{name}.tif" for name in pieces]
    ended = run("dbbuild", "terrain", *sources, "-o", folder / "filled.dz", "--void", "fill", "--json").json()
    # The rectangle of the two Int16 quarters; the south-east of it is nobody's, the north-west the third source's.
    require(ended["grids"] == 2 and ended["filled"] == 19 * 14, ended)
    require(ended["voids"] == 20 * 15, ended)
    run("dbcheck", folder / "filled.dz", "--level", "all", "--against", *sources)


@case
def a_resampled_fill_tells_its_error_honestly(folder):
    small = small_dem(folder)
    run("dbbuild", "terrain", small, "-o", folder / "filled.dz", "--grid", "EPSG:32632", "--void", "fill")
    run("dbcheck", folder / "filled.dz", "--level", "all", "--against", small)


@case
def a_resampled_area_says_what_it_costs(folder):
    small = small_dem(folder, void=False)
    for options in (["--grid", "EPSG:32632", "--spacing", "500m"], ["--spacing", "30as"], ["--grid", "geodetic", "--spacing", "20as"]):
        area, exported = folder / "resampled.dz", folder / "resampled.tif"
        run("dbbuild", "terrain", small, "-o", area, *options, "--overwrite")
        grid = info(area)["grids"][0]
        require(grid["resampling"]["method"] == "bilinear" and grid["resampling"]["largest_error"] >= grid["resampling"]["rms_error"] >= 0, grid)
        ended = run("dbcheck", area, "--level", "decode", "--against", small, "--json").json()
        require(ended["checked"]["posts_compared"] > 1000, ended)
        run("dbbuild", "export", area, "-o", exported, "--overwrite")
        # Independent: GDAL's own bilinear resampling to the same posts, away from the edges.
        there = json.loads(gdal("gdalinfo", "-json", exported))
        west, south, east, north = there["cornerCoordinates"]["lowerLeft"] + there["cornerCoordinates"]["upperRight"]
        gdal("gdalwarp", "-q", "-overwrite", "-r", "bilinear", "-et", "0", "-ot", "Float32", "-dstnodata", "-32768", "-t_srs", exported_system(folder, exported),
             "-te", repr(west), repr(south), repr(east), repr(north), "-ts", *there["size"], small, folder / "judge.tif")
        differences = sorted(abs(a - b) for a, b in zip(values(exported, folder), values(folder / "judge.tif", folder), strict=True)
                             if -32768 not in (a, b))
        require(len(differences) > 100 and differences[int(0.9 * len(differences))] < 0.02, f"{options}: {differences[-10:]}")


def exported_system(folder, file):
    path = folder / "system.wkt"
    path.write_text(gdal("gdalsrsinfo", "-o", "wkt2", file))
    return path


@case
def quiet_is_without_warnings_which_stay_in_json(folder):
    first, second = small_dem(folder, void=False), folder / "other.tif"
    gdal("gdal_translate", "-q", "-scale", "0", "1000", "7", "1007", first, second)
    loud = run("dbbuild", "terrain", first, second, "-o", folder / "loud.dz")
    require("warning" in loud.err, loud)
    quiet = run("dbbuild", "terrain", first, second, "-o", folder / "quiet.dz", "-q", "--json")
    require(quiet.err == "" and len(quiet.json()["warnings"]) == 1, quiet)


@case
def a_resampled_globe_and_a_resampled_pole_are_whole(folder):
    sources = [globe(folder, "shared", -180, 361, "post"), globe(folder, "cells", -180, 360, "area"), globe(folder, "from_0", 0, 360, "post")]
    cap = folder / "cap.tif"
    gdal("gdal_create", "-q", "-of", "GTiff", "-ot", "Int16", "-outsize", 300, 300, "-a_srs", "EPSG:3031", "-a_ullr", -150000, 150000, 150000, -150000,
         "-burn", 700, cap)
    for source, columns in [(source, 361) for source in sources] + [(cap, 1441)]:
        area = folder / "whole.dz"
        run("dbbuild", "terrain", source, "-o", area, "--grid", "geodetic", "--overwrite")
        grid = info(area)["grids"][0]
        require(grid["longitude"]["count"] == columns and grid["longitude"]["first"] == 0, grid["longitude"])
        run("dbcheck", area, "--level", "all", "--against", source)
    require(grid["latitude"]["first"] == 0, "the pole is not in it")
    ended = run("dbbuild", "terrain", cap, "-o", folder / "x.dz", "--grid", "geodetic", "--spacing", "0.1as", expect=2, words=["--spacing", "--bounds", "GB"])
    require("error" in ended.err, ended)


@case
def a_usgs_dem_cut_short_is_refused(folder):
    if not TEST_DATA:
        print("DELTAZ_TEST_DATA is not set: nothing to do")
        return
    content = (pathlib.Path(TEST_DATA) / "dem" / "SainteHelens.dem").read_bytes()
    for share in (0.9, 0.5, 0.05):
        (folder / "short.dem").write_bytes(content[:int(share * len(content))])
        run("dbbuild", "terrain", folder / "short.dem", "-o", folder / "x.dz", expect=1, words=["short.dem"])
        require(not (folder / "x.dz").exists(), "half a DEM was built from")


@case
def a_guess_at_a_datum_is_refused_unless_allowed(folder):
    first = small_dem(folder)
    nowhere = folder / "nowhere.tif"
    gdal("gdal_translate", "-q", "-a_srs", 'GEOGCS["Nowhere",DATUM["Nowhere_1900",SPHEROID["Clarke 1866",6378206.4,294.9786982138982]],'
         'PRIMEM["Greenwich",0],UNIT["degree",0.0174532925199433]]', first, nowhere)
    run("dbbuild", "terrain", first, nowhere, "-o", folder / "x.dz", expect=1, words=["nowhere.tif", "--allow-ballpark"])
    ended = run("dbbuild", "terrain", first, nowhere, "-o", folder / "x.dz", "--allow-ballpark")
    require("warning" in ended.err and "guess" in ended.err, ended)
    run("dbcheck", folder / "x.dz", "--level", "decode", "--against", first, nowhere)


if __name__ == "__main__":
    main()
