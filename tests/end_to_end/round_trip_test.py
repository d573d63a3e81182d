"""What goes in comes out: every post, every void and the georeferencing, judged by GDAL's own programs."""
import json
import struct

from harness import RAINIER, build, case, gdal, main, real_files, require, run, small_dem
from raster_judge import raw_posts, same_raster


def round_trip(source, folder):
    area, exported = folder / f"{source.name}.dz", folder / "exported.tif"
    run("dbbuild", "terrain", source, "-o", area)
    ended = run("dbcheck", area, "--level", "decode", "--against", source)
    require(ended.out.splitlines()[0] == f"{area}: valid", ended)
    run("dbbuild", "export", area, "-o", exported, "--overwrite")
    same_raster(source, exported, folder)
    # What came out is as good a source as what went in.
    run("dbcheck", area, "--level", "structure", "--against", exported)
    return area


def with_one_post_changed(source, folder):
    """A copy of `source` in which one valid post is 1 m higher: (file, longitude, latitude)."""
    info = json.loads(gdal("gdalinfo", "-json", source))
    columns, rows = info["size"]
    changed = folder / "changed.tif"
    gdal("gdal_translate", "-q", "-co", f"BLOCKYSIZE={rows}", source, changed)
    content, posts = bytearray(changed.read_bytes()), raw_posts(source, folder)
    start = bytes(content).find(posts)
    require(start >= 0, f"{source.name}: the posts do not stand together in the copy")
    nodata = info["bands"][0].get("noDataValue")
    # A post away from the middle, so that swapped axes would be noticed; the next valid one from there.
    index = (rows // 3) * columns + 2 * columns // 3
    while struct.unpack_from("<h", posts, 2 * index)[0] in (nodata, -32768, -32767):
        index += 1
    height = struct.unpack_from("<h", posts, 2 * index)[0]
    struct.pack_into("<h", content, start + 2 * index, height + 1)
    changed.write_bytes(content)
    west, dx, _, north, _, dy = info["geoTransform"]
    return changed, west + (index % columns + 0.5) * dx, north + (index // columns + 0.5) * dy


@case
def every_real_file_comes_back_post_for_post(folder):
    for number, source in enumerate(real_files()):
        area = round_trip(source, folder)
        changed, longitude, latitude = with_one_post_changed(source, folder)
        ended = run("dbcheck", area, "--against", changed, "--json", expect=1)
        report = ended.json()
        issues = {issue["code"]: issue for issue in report["issues"]}
        require("SRC_HEIGHT" in issues and issues["SRC_HEIGHT"]["count"] == 1, f"{source.name}: not exactly one height differs\n{ended}")
        where = issues["SRC_HEIGHT"]["worst"]["where"]
        require(abs(where["longitude"] - longitude) < 1e-9 and abs(where["latitude"] - latitude) < 1e-9,
                f"{source.name}: {where} is not {longitude}, {latitude}")
        require(abs(issues["SRC_HEIGHT"]["worst"]["magnitude"]) == 1, f"{source.name}: not 1 m\n{ended}")
        if number > 0:
            continue
        text = run("dbcheck", area, "--against", changed, expect=1).out
        require(f"lon {longitude:.7f}, lat {latitude:.7f}" in text and "invalid" in text.splitlines()[0], text)


@case
def small_grids_come_back_whatever_the_leaf_size(folder):
    small = small_dem(folder)
    for leaf in ("8", "16", "64", "1024"):
        area, exported = folder / f"leaf{leaf}.dz", folder / f"leaf{leaf}.tif"
        run("dbbuild", "terrain", small, "-o", area, "--leaf", leaf)
        run("dbcheck", area, "--level", "all", "--against", small)
        run("dbbuild", "export", area, "-o", exported)
        same_raster(small, exported, folder)


@case
def both_registrations_keep_their_posts_in_place(folder):
    small = small_dem(folder)
    for registration in ("Area", "Point"):
        source, exported = folder / f"{registration}.tif", folder / f"{registration}.out.tif"
        gdal("gdal_translate", "-q", "-mo", f"AREA_OR_POINT={registration}", small, source)
        area = build(folder, source, f"{registration}.dz")
        run("dbbuild", "export", area, "-o", exported)
        same_raster(source, exported, folder)
        bounds = run("dbbuild", "info", area, "--json").json()["bounds"]
        # The outermost posts are centres of GDAL's pixels, half a spacing inside its corners.
        require(abs(bounds["west"] - 7.005) < 1e-9 and abs(bounds["north"] - 46.295) < 1e-9, f"{registration}: {bounds}")


@case
def a_coarser_level_is_a_subset_of_the_posts(folder):
    area = build(folder, RAINIER)
    step, level = 8, 3
    run("dbbuild", "export", area, "-o", folder / "coarse.tif", "--level", level)
    info = json.loads(gdal("gdalinfo", "-json", folder / "coarse.tif"))
    source = json.loads(gdal("gdalinfo", "-json", RAINIER))
    columns, rows = info["size"]
    source_columns = source["size"][0]
    fine, coarse = raw_posts(RAINIER, folder), raw_posts(folder / "coarse.tif", folder)
    west, dx, _, north, _, dy = info["geoTransform"]
    fine_west, fine_dx, _, fine_north, _, fine_dy = source["geoTransform"]
    require(abs(dx / fine_dx - step) < 1e-9, f"spacing {dx}")
    compared = 0
    for row in range(0, rows, 7):
        for column in range(0, columns, 7):
            x = ((west + (column + 0.5) * dx) - fine_west) / fine_dx - 0.5
            y = ((north + (row + 0.5) * dy) - fine_north) / fine_dy - 0.5
            require(abs(x - round(x)) < 1e-3 and abs(y - round(y)) < 1e-3, f"post {column},{row} is not one of the source")
            at = round(y) * source_columns + round(x)
            require(coarse[2 * (row * columns + column):][:2] == fine[2 * at:][:2], f"post {column},{row} has another height")
            compared += 1
    require(compared > 100, "hardly a post was compared")


@case
def a_wrong_source_is_told_from_the_right_one(folder):
    area = build(folder)
    other = small_dem(folder, "other.asc", void=False)
    ended = run("dbcheck", area, "--against", other, "--json", expect=1)
    require({issue["code"] for issue in ended.json()["issues"]} & {"SRC_VOID", "SRC_HEIGHT"}, ended)
    ended = run("dbcheck", area, "--against", small_dem(folder, "narrow.asc", columns=39), "--json", expect=1)
    require("SRC_EXTENT" in {issue["code"] for issue in ended.json()["issues"]}, ended)


if __name__ == "__main__":
    main()
