"""Every row of the table of exit codes, for every tool."""
import fcntl

from harness import (build, case, damaged_database, flip_bit, folder_bytes, main, newer_database, require, run, small_dem)

TOOLS = ["dbbuild", "dbview", "dbcheck"]


def reading_command(tool, area, folder):
    """A command of each tool that reads a database."""
    return {"dbbuild": ["info", area, "--digest"], "dbview": [area, "-o", folder / "view.png", "--size", "40x30", "--overwrite"],
            "dbcheck": [area]}[tool]


@case
def every_tool_ends_with_0_when_done(folder):
    area = build(folder)
    for tool in TOOLS:
        run(tool, *reading_command(tool, area, folder), expect=0)


@case
def help_and_version_end_with_0_and_speak_on_stdout(folder):
    for words in (["dbbuild"], ["dbbuild", "terrain"], ["dbbuild", "info"], ["dbbuild", "export"], ["dbview"], ["dbcheck"]):
        for flag in ("-h", "--help"):
            ended = run(*words, flag)
            require("--json" in ended.out or words == ["dbbuild"], ended)
            require(not ended.err, ended)
    for tool in TOOLS:
        require(run(tool, "--version").out.startswith(f"{tool} "), "no version")


@case
def damaged_content_ends_with_1(folder):
    area = damaged_database(folder)
    for tool in TOOLS:
        ended = run(tool, *reading_command(tool, area, folder), expect=1)
        require(tool == "dbcheck" or "error:" in ended.err, ended)
    require(not (folder / "view.png").exists(), "a picture of a damaged database")


@case
def what_is_no_database_ends_with_1(folder):
    (folder / "plain").mkdir()
    (folder / "file.dz").write_text("not a folder")
    for area in (folder / "plain", folder / "file.dz"):
        for tool in TOOLS:
            run(tool, *reading_command(tool, area, folder), expect=1, words=["not a deltaz database"])


@case
def wrong_options_end_with_2_and_are_named(folder):
    area, dem = build(folder), small_dem(folder)
    out = folder / "x"
    png = ["-o", folder / "x.png"]
    for words, command in [
            (["--spacing"], ["dbbuild", "terrain", dem, "-o", out, "--spacing", "30m"]),
            (["--bounds"], ["dbbuild", "terrain", dem, "-o", out, "--bounds", "7,46,8"]),
            (["--normals"], ["dbbuild", "terrain", dem, "-o", out, "--normals", "derived"]),
            (["--resume"], ["dbbuild", "terrain", dem, "-o", out, "--resume"]),
            (["-o"], ["dbbuild", "terrain", dem]),
            (["option, not a name"], ["dbbuild", "terrain", dem, "-o", "--overwrite"]),
            (["DEM"], ["dbbuild", "terrain", "-o", out]),
            (["--quantum"], ["dbbuild", "terrain", dem, "-o", out, "--quantum", "fine"]),
            (["Name the database first"], ["dbcheck", "--against", dem, area]),
            (["--leaf", "power of two"], ["dbbuild", "terrain", dem, "-o", out, "--leaf", "65"]),
            (["--leaf"], ["dbbuild", "terrain", dem, "-o", out, "--leaf", "4"]),
            (["--leaf"], ["dbbuild", "terrain", dem, "-o", out, "--leaf", "64x"]),
            (["-j"], ["dbbuild", "terrain", dem, "-o", out, "-j", "0"]),
            (["-j"], ["dbbuild", "terrain", dem, "-o", out, "-j", "two"]),
            (["--progress"], ["dbbuild", "terrain", dem, "-o", out, "--progress", "loud"]),
            (["tin"], ["dbbuild", "tin", area]),
            (["subcommand"], ["dbbuild"]),
            (["--level"], ["dbbuild", "export", area, "-o", folder / "x.tif", "--level", "40"]),
            (["--grid"], ["dbbuild", "export", area, "-o", folder / "x.tif", "--grid", "7"]),
            (["--frobnicate"], ["dbbuild", "info", area, "--frobnicate"]),
            (["-o"], ["dbview", area]),
            (["png"], ["dbview", area, "-o", folder / "x.bmp"]),
            (["--look"], ["dbview", area, *png, "--eye", "46,7,1000"]),
            (["--eye"], ["dbview", area, *png, "--look", "0,0"]),
            (["--eye"], ["dbview", area, *png, "--eye", "46,7", "--look", "0,0"]),
            (["--eye"], ["dbview", area, *png, "--eye", "91,7,1000", "--look", "0,0"]),
            (["--eye"], ["dbview", area, *png, "--eye", "46,7,1e3m", "--look", "0,0"]),
            (["--eye"], ["dbview", area, *png, "--eye", "46,7,nan", "--look", "0,0"]),
            (["no ground"], ["dbview", area, *png, "--eye", "10,10,100agl", "--look", "0,0"]),
            (["--look"], ["dbview", area, *png, "--eye", "46,7,1000", "--look", "0,91"]),
            (["--fov"], ["dbview", area, *png, "--fov", "180"]),
            (["--fov"], ["dbview", area, *png, "--fov", "0"]),
            (["--size"], ["dbview", area, *png, "--size", "0x10"]),
            (["--size"], ["dbview", area, *png, "--size", "640"]),
            (["--sun"], ["dbview", area, *png, "--sun", "1,2,3"]),
            (["--tolerance"], ["dbview", area, *png, "--tolerance", "-1"]),
            (["--tolerance"], ["dbview", area, *png, "--tolerance", "1,5"]),
            (["--lod"], ["dbview", area, *png, "--lod", "range"]),
            (["--lod", "reference"], ["dbview", area, *png, "--lod", "report", "--engine", "reference"]),
            (["--transform"], ["dbview", area, *png, "--transform", "float"]),
            (["--transform", "reference"], ["dbview", area, *png, "--transform", "delta", "--engine", "reference"]),
            (["--simd"], ["dbview", area, *png, "--simd", "mmx"]),
            (["--engine"], ["dbview", area, *png, "--engine", "lathe"]),
            (["--repeat"], ["dbview", area, *png, "--repeat", "0"]),
            (["--color"], ["dbview", area, *png, "--color", "summer"]),
            (["AREA.dz"], ["dbcheck"]),
            (["--level", "depth"], ["dbcheck", area, "--level", "depth"]),
            (["--report", "sarif"], ["dbcheck", area, "--report", "sarif=x"]),
            (["--report"], ["dbcheck", area, "--report", "json="]),
            (["--fail-on"], ["dbcheck", area, "--fail-on", "information"]),
            (["--crs"], ["dbcheck", area, "--crs", "EPSG:4326"]),
            (["--explain", "NO_SUCH"], ["dbcheck", "--explain", "NO_SUCH"]),
            (["--sample"], ["dbcheck", area, "--sample", "10"]),
    ]:
        run(*command, expect=2, words=words)
    require(not out.exists() and not (folder / "x.png").exists() and not (folder / "x.tif").exists(), "something was made all the same")


@case
def existing_targets_end_with_2_and_stay_as_they_are(folder):
    area, dem = build(folder), small_dem(folder)
    before = (area / "area.json").read_bytes()
    for name in ("x.png", "x.tif", "x.json"):
        (folder / name).write_text("mine")
    fresh = folder / "fresh.png"
    for command in (["dbbuild", "terrain", dem, "-o", area], ["dbbuild", "export", area, "-o", folder / "x.tif"],
                    ["dbview", area, "-o", folder / "x.png"], ["dbview", area, "-o", fresh, "--depth", folder / "x.tif"],
                    ["dbview", area, "-o", fresh, "--stats", folder / "x.json"],
                    ["dbcheck", area, "--report", f"json={folder / 'x.json'}"]):
        run(*command, expect=2, words=["the target exists", "--overwrite"])
    require((area / "area.json").read_bytes() == before and not fresh.exists(), "a target was touched")
    require(all((folder / name).read_text() == "mine" for name in ("x.png", "x.tif", "x.json")), "a target was touched")


@case
def unreadable_and_unwritable_places_end_with_3(folder):
    area, dem = build(folder), small_dem(folder)
    absent = folder / "absent.dz"
    for tool in TOOLS:
        run(tool, *reading_command(tool, absent, folder), expect=3, words=["absent.dz"])
    run("dbbuild", "terrain", folder / "absent.tif", "-o", folder / "x.dz", expect=3, words=["absent.tif"])
    run("dbcheck", area, "--against", folder / "absent.tif", expect=3, words=["absent.tif"])
    # Under a file and under /proc nobody can write, not even root.
    for place in (dem, "/proc"):
        run("dbbuild", "terrain", dem, "-o", f"{place}/x.dz", expect=3)
        run("dbbuild", "export", area, "-o", f"{place}/x.tif", expect=3)
        run("dbview", area, "-o", f"{place}/x.png", "--size", "40x30", expect=3)
        run("dbcheck", area, "--report", f"json={place}/x.json", expect=3)


@case
def a_full_standard_output_ends_with_3(folder):
    area = build(folder)
    import subprocess
    from harness import program
    for command in ([program("dbbuild"), "info", area], [program("dbcheck"), area], [program("dbbuild"), "--help"],
                    [program("dbcheck"), "--list-codes"]):
        with open("/dev/full", "w", encoding="utf-8") as full:
            process = subprocess.run(list(map(str, command)), stdout=full, stderr=subprocess.PIPE, check=False)
        require(process.returncode == 3, f"{command}: {process}")


@case
def a_target_that_cannot_be_made_ends_with_3_and_is_named(folder):
    area, dem = build(folder), small_dem(folder)
    for command in (["dbbuild", "terrain", dem, "-o", "/proc/target"], ["dbbuild", "export", area, "-o", "/proc/target"],
                    ["dbview", area, "--size", "40x30", "-o", "/proc/target.png"]):
        ended = run(*command, expect=3, words=["/proc/target"])
        require("tmp-" not in ended.err, ended)


@case
def a_second_writer_ends_with_3(folder):
    area, dem = build(folder), small_dem(folder)
    with open(area / "lock", "a", encoding="utf-8") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        run("dbbuild", "terrain", dem, "-o", area, "--overwrite", expect=3, words=["another process is writing"])
        before = folder_bytes(area)
        for edit in (["color", area, "--name", "summer", "--synthetic", "natural"], ["gc", area]):
            run("dbbuild", *edit, expect=3, words=["another process is writing"])
        require(folder_bytes(area) == before, "a writer that was turned away changed the database")
    run("dbbuild", "terrain", dem, "-o", area, "--overwrite")


@case
def a_newer_format_ends_with_4(folder):
    area = newer_database(folder)
    for tool in TOOLS:
        run(tool, *reading_command(tool, area, folder), expect=4, words=["newer"])
    ended = run("dbcheck", area, "--json", expect=4)
    require(ended.json()["verdict"] == "unknown", ended)


@case
def a_failing_warning_needs_fail_on_warning(folder):
    area = build(folder)
    (area / "stray").write_text("x")
    run("dbcheck", area, expect=0)
    require("IO_UNREFERENCED_FILE" in run("dbcheck", area).out, "an unreferenced file is not mentioned")
    # Information is not a warning.
    run("dbcheck", area, "--fail-on", "warning", expect=0)


@case
def what_is_displayed_does_not_change_the_verdict(folder):
    good, bad = build(folder), damaged_database(folder)
    for area, code in ((good, 0), (bad, 1)):
        for shown in ([], ["-q"], ["-v"], ["--json"], ["-q", "--json"], ["--progress", "json"], ["--progress", "none"]):
            run("dbcheck", area, *shown, expect=code)


@case
def a_broken_area_json_is_invalid(folder):
    area = build(folder)
    flip_bit(area / "area.json")
    ended = run("dbcheck", area, expect=1)
    require("invalid" in ended.out.splitlines()[0], ended)


@case
def a_file_of_poses_that_is_none_is_refused(folder):
    area, poses = build(folder), folder / "poses.json"
    command = ["dbview", area, "-o", folder / "x.png", "--size", "40x30", "--pose", poses]
    run(*command, expect=3, words=["poses.json"])
    for text, code, words in [
            ("{", 1, ["no JSON", "byte"]), ("[]", 1, ["no object"]), ('{"pose": []}', 1, ["near it", '"poses"']),
            ('{"poses": [{"model": "tower", "part": "head", "rotat": 1}]}', 1, ["poses[0]", '"rotate"']),
            ('{"poses": [{"model": "tower", "part": "head", "scale": NaN}]}', 1, ["no JSON"]),
            ('{"poses": [{"model": "tower", "part": "head"}]}', 2, ["poses.json", '"tower"', "there are none"])]:
        poses.write_text(text)
        run(*command, expect=code, words=words)
        require(not (folder / "x.png").exists(), text)
    poses.write_text('{"poses": []}')
    run(*command)


if __name__ == "__main__":
    main()
