"""What the tools print and write: strict JSON, the published schema, progress that only grows, pictures and depth."""
import json
import math
import pathlib
import struct

from harness import RAINIER, build, case, damaged_database, gdal, main, newer_database, program, require, run, small_dem, strict_json

import jsonschema

SCHEMA = pathlib.Path(__file__).resolve().parents[2] / "tools" / "dbcheck" / "report.schema.json"
MILLIMETRE = 0.001


@case
def every_json_output_is_strict_json(folder):
    area, dem = build(folder), small_dem(folder)
    for command in (["dbbuild", "terrain", dem, "-o", folder / "x.dz"], ["dbbuild", "info", area], ["dbbuild", "info", area, "--digest"],
                    ["dbbuild", "export", area, "-o", folder / "x.tif"], ["dbview", area, "-o", folder / "x.png", "--size", "64x48"],
                    ["dbcheck", area], ["dbcheck", area, "--against", dem], ["dbcheck", "--list-codes"],
                    ["dbcheck", "--explain", "SUM_BLOCK"]):
        data = run(*command, "--json").json()
        require(data["schema_version"] == 1 and data["tool"] == command[0], data)
        require(data["tool_version"] == run(command[0], "--version").out.split()[1], data)


@case
def json_reports_keep_to_the_published_schema(folder):
    schema = strict_json(SCHEMA.read_text())
    jsonschema.Draft202012Validator.check_schema(schema)
    good, dem = build(folder), small_dem(folder)
    other = small_dem(folder, "other.asc", void=False)
    (folder / "plain").mkdir()
    for code, arguments in ((0, [good]), (0, [good, "--against", dem, "--level", "structure"]), (1, [damaged_database(folder)]),
                            (1, [good, "--against", other, "--fail-on", "warning"]), (4, [newer_database(folder)]),
                            (1, [folder / "plain"]), (3, [folder / "absent.dz"])):
        file = folder / "report.json"
        ended = run("dbcheck", *arguments, "--json", "--report", f"json={file}", "--overwrite", expect=code)
        require(file.read_text() == ended.out, "--report and --json differ")
        report = ended.json()
        jsonschema.validate(report, schema, jsonschema.Draft202012Validator)
        require(report["exit_code"] == code and (report["verdict"] == "valid") == (code == 0), report)
        require(str(folder) not in json.dumps({**report, "error": None, "issues": []}), "an absolute path in a report")
    # The schema itself can say no.
    try:
        jsonschema.validate({**report, "verdict": "perhaps"}, schema, jsonschema.Draft202012Validator)
    except jsonschema.ValidationError:
        return
    raise AssertionError("the schema takes anything")


@case
def damage_is_reported_with_its_place(folder):
    area = damaged_database(folder)
    issues = {issue["code"]: issue for issue in run("dbcheck", area, "--json", expect=1).json()["issues"]}
    require("SUM_BLOCK" in issues, issues)
    where = issues["SUM_BLOCK"]["first"][0]["where"]
    require(where["file"].startswith("terrain") and where["block"] >= 0, where)
    lines = run("dbcheck", area, expect=1).out.splitlines()
    require(lines[0].startswith(f"{area}: invalid: ") and "error" in lines[0], lines)
    require(any("SUM_BLOCK" in line for line in lines) and any("block" in line for line in lines), lines)


@case
def every_code_is_listed_and_explained(folder):
    del folder
    codes = run("dbcheck", "--list-codes", "--json").json()["codes"]
    require(len(codes) > 30 and len({code["code"] for code in codes}) == len(codes), codes)
    text = run("dbcheck", "--list-codes").out
    for code in codes:
        require(code["code"] in text, code)
        explained = run("dbcheck", "--explain", code["code"]).out
        require(code["explanation"] in explained and code["remedy"] in explained, explained)


@case
def progress_only_grows_and_stays_on_stderr(folder):
    area = folder / "area.dz"
    for command in (["dbbuild", "terrain", RAINIER, "-o", area], ["dbview", area, "-o", folder / "x.png", "--repeat", "3", "--size", "64x48"],
                    ["dbcheck", area]):
        ended = run(*command, "--progress", "json", "--json")
        ended.json()
        lines = [strict_json(line) for line in ended.err.splitlines()]
        fractions = [line["fraction"] for line in lines]
        require(fractions == sorted(fractions) and fractions[0] >= 0 and fractions[-1] == 1, fractions)
        require(all(line["phase"] for line in lines), lines)
    for mode in ("none", "auto"):
        require(run("dbcheck", area, "--progress", mode).err == "", "progress nobody asked for")


@case
def quiet_tools_are_quiet(folder):
    area, dem = folder / "area.dz", small_dem(folder)
    for command in (["dbbuild", "terrain", dem, "-o", area], ["dbbuild", "info", area], ["dbbuild", "export", area, "-o", folder / "x.tif"],
                    ["dbview", area, "-o", folder / "x.png", "--size", "64x48"], ["dbcheck", area]):
        ended = run(*command, "-q")
        require(ended.out == "" and ended.err == "", ended)


@case
def the_digest_tells_content_from_layout(folder):
    dem = small_dem(folder)
    first, again = build(folder, dem, "first.dz"), build(folder, dem, "again.dz")
    other = build(folder, small_dem(folder, "other.asc", void=False), "other.dz")
    digests = [run("dbbuild", "info", area, "--digest").out for area in (first, again, other)]
    require(digests[0] == digests[1] != digests[2], digests)
    require(len(digests[0].strip()) == 32 and int(digests[0], 16) > 0, digests)
    # The same posts under another name: provenance does not enter.
    renamed = dem.rename(folder / "renamed.tif")
    require(run("dbbuild", "info", build(folder, renamed, "renamed.dz"), "--digest").out == digests[0], "the source's name matters")


@case
def statistics_have_every_member(folder):
    area = build(folder, RAINIER)
    for engine in ("fast", "reference"):
        file = folder / f"{engine}.json"
        run("dbview", area, "-o", folder / f"{engine}.png", "--size", "160x90", "--engine", engine, "--repeat", "2", "--stats", file)
        data = strict_json(file.read_text())
        require(data["engine"] == engine and data["camera"]["width"] == 160 and data["repeat"] == 2, data)
        (frame,) = data["frames"]
        require(set(frame["models"]) == {"visited", "out_of_view", "occluded", "drawn"}, frame)
        nodes = frame["nodes"]
        require(set(nodes) == {"visited", "out_of_view", "beyond_horizon", "facing_away", "occluded", "drawn", "opened", "empty"}, frame)
        require(nodes["visited"] == sum(count for fate, count in nodes.items() if fate != "visited") > 0, nodes)
        triangles = frame["triangles"]
        require(set(triangles) == {"in", "back_facing", "clipped", "no_sample", "drawn"}, frame)
        require(triangles["in"] == sum(count for fate, count in triangles.items() if fate != "in") > 0, triangles)
        require(set(frame["samples"]) == {"tested", "written", "shaded"}, frame)
        require(set(frame["stages_ms"]) == {"schedule", "read", "objects", "raster", "resolve"}, frame)
        require(0 < frame["frame_ms"]["min"] <= frame["frame_ms"]["median"] <= frame["frame_ms"]["max"], frame)
        for member in ("bytes_read", "posts_decoded", "depth_complexity", "level", "coarsest_level", "projected_error"):
            require(member in frame, frame)
        require(frame["bytes_read"] > 0 and frame["posts_decoded"] > 0 and frame["nodes"]["drawn"] > 0, frame)


@case
def a_picture_shows_terrain_and_sky(folder):
    area = build(folder, RAINIER)
    run("dbview", area, "-o", folder / "eye.png", "--eye", "46.70,-121.74,300agl", "--look", "0,0", "--fov", "50", "--size", "160x90")
    info = json.loads(gdal("gdalinfo", "-json", "-stats", folder / "eye.png"))
    require(info["size"] == [160, 90] and len(info["bands"]) == 3, info)
    require(all(float(band["stdDev"]) > 5 for band in info["bands"]), "a picture of one colour")


def geodetic(point, axis, flattening):
    """Latitude, longitude (degrees) and height of an Earth-centred point: Bowring's iteration, not the code under test."""
    x, y, z = point
    squared = flattening * (2 - flattening)
    distance = math.hypot(x, y)
    latitude = math.atan2(z, distance * (1 - squared))
    for _ in range(10):
        radius = axis / math.sqrt(1 - squared * math.sin(latitude)**2)
        height = distance / math.cos(latitude) - radius
        latitude = math.atan2(z, distance * (1 - squared * radius / (radius + height)))
    return math.degrees(latitude), math.degrees(math.atan2(y, x)), height


@case
def depth_leads_back_to_the_ground(folder):
    area, depth = build(folder, RAINIER), folder / "depth.tif"
    run("dbview", area, "-o", folder / "x.png", "--depth", depth, "--eye", "46.80,-121.76,9000", "--look", "30,-60", "--size", "80x60", "--tolerance", "0")
    info = json.loads(gdal("gdalinfo", "-json", depth))
    require(info["bands"][0]["type"] == "Float32" and len(info["bands"]) == 1, info)
    view = strict_json(info["metadata"][""]["TIFFTAG_IMAGEDESCRIPTION"])
    gdal("gdal_translate", "-q", "-of", "EHdr", depth, folder / "depth.bil")
    values = struct.unpack("<4800f", (folder / "depth.bil").read_bytes())
    lowest = run("dbbuild", "info", area, "--json").json()["lowest_height"]
    compared = 0
    for i in range(5, 60, 13):
        for j in range(5, 80, 13):
            u = values[80 * i + j]
            if not math.isfinite(u):
                continue
            ray = [view["forward"][k] + view["right"][k] * (j - view["centre_j"]) / view["pixels"] +
                   view["down"][k] * (i - view["centre_i"]) / view["pixels"] for k in range(3)]
            point = [view["eye"][k] + u * ray[k] for k in range(3)]
            latitude, longitude, height = geodetic(point, view["semi_major_axis"], 1 / view["inverse_flattening"])
            if height < lowest - 0.01:
                continue  # the sea, seen through a void
            # The ground there, asked of the database another way: an eye exactly on it.
            run("dbview", area, "-o", folder / "y.png", "--eye", f"{latitude!r},{longitude!r},0agl", "--look", "0,0", "--size", "2x2",
                "--stats", folder / "y.json", "--overwrite")
            ground = strict_json((folder / "y.json").read_text())["camera"]["eye"]["height"]
            # A float of 10 km of depth is good to half a millimetre; slopes make more of it.
            require(abs(ground - height) < 5 * MILLIMETRE + 2e-6 * u, f"pixel {i},{j}: {height} m, and the ground is at {ground} m")
            compared += 1
    require(compared > 10, "hardly a pixel saw the ground")


@case
def sky_has_infinite_depth(folder):
    area, depth = build(folder), folder / "depth.tif"
    run("dbview", area, "-o", folder / "x.png", "--depth", depth, "--eye", "46.1,7.2,5000", "--look", "0,80", "--size", "16x12")
    gdal("gdal_translate", "-q", "-of", "EHdr", depth, folder / "depth.bil")
    values = struct.unpack("<192f", (folder / "depth.bil").read_bytes())
    require(all(value == math.inf for value in values), "the sky is near")


@case
def negative_coordinates_are_no_options(folder):
    area = build(folder)
    run("dbview", area, "-o", folder / "x.png", "--eye", "-10,-20.5,5000", "--look", "-90,-10,-5", "--sun", "-45,10", "--size", "16x12")


if __name__ == "__main__":
    main()
