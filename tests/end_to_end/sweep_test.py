"""dbview sweep: the table, its JSON and its picture agree, errors are measured and within what was promised."""
import json
import re
import xml.etree.ElementTree

from harness import RAINIER, build, case, main, no_leftovers, require, run, strict_json

SMALL = ["--size", "160x100", "--repeat", "2"]


def near_ground(folder):
    views = folder / "near.json"
    views.write_text(json.dumps({"views": [{"name": "near", "eye": "46.85,-121.76,200agl", "look": "180,-30"}]}))
    return views


def names_of(report):
    return [view["name"] for view in report["views"]]


@case
def every_measured_displacement_is_within_its_tolerance(folder):
    area = build(folder, RAINIER)
    report = run("dbview", "sweep", area, *SMALL, "--tolerances", "4,0.5,16", "--json").json()
    require(names_of(report) == ["whole area", "eye level", "oblique", "zenith"], names_of(report))
    seen = 0
    for view in report["views"]:
        require([row["setting"]["tolerance"] for row in view["rows"]] == [0.5, 4, 16], view)
        for row in view["rows"]:
            error = row["displacement_pixels"]
            # What is left at full resolution is the depth's rounding, largest where ground is seen edge-on.
            require(error["p99_9"] <= error["largest"] <= row["setting"]["tolerance"] + 0.1, row)
            require(error["bound"] <= row["setting"]["tolerance"], row)
            require(row["measured_pixels"] > 50 * row["unmeasured_pixels"], row)
            seen = max(seen, error["largest"])
            time = row["frame_ms"]
            require(0 < time["min"] <= time["median"] <= time["max"], row)
        coarse, fine = view["rows"][-1], view["rows"][0]
        require(coarse["triangles_drawn"] <= fine["triangles_drawn"], view)
    require(seen > 1, f"nothing was ever displaced: {seen}")
    worst = [max(view["rows"][k]["displacement_pixels"]["largest"] for view in report["views"]) for k in range(3)]
    require(worst == [row["displacement_pixels"]["largest"] for row in report["all_views"]], "the worst of all views is another")


@case
def the_front_is_what_nothing_beats(folder):
    report = run("dbview", "sweep", build(folder, RAINIER), *SMALL, "--json").json()
    for rows in [view["rows"] for view in report["views"]] + [report["all_views"]]:
        for measure, error in (("displacement", lambda row: row["displacement_pixels"]["largest"]), ("colors", lambda row: row["colors"]["rms"])):
            points = [(row["frame_ms"]["median"], error(row)) for row in rows]
            for point, row in zip(points, rows):
                beaten = any(other[0] <= point[0] and other[1] <= point[1] and other != point for other in points)
                require(row["on_front"][measure] != beaten, (measure, point, points))
    sentence = report["sentences"]["displacement"]
    front = sorted((row["frame_ms"]["median"], row) for row in report["all_views"] if row["on_front"]["displacement"])
    require(sentence.count(" ms (") == len(front) and f"({front[0][1]['setting']['tolerance']:g} px)" in sentence.split(",")[0], sentence)


@case
def table_json_and_picture_are_of_one_run(folder):
    area = build(folder)
    out, svg = folder / "sweep.json", folder / "sweep.svg"
    ended = run("dbview", "sweep", area, *SMALL, "--tolerances", "1,8", "--report", f"json={out},svg={svg}")
    report = strict_json(out.read_text())
    for view in report["views"]:
        require(f"{view['name']}, 160 x 100" in ended.out, ended)
        for row in view["rows"]:
            require(f"{row['frame_ms']['median']:8.2f}" in ended.out, ended)
    for sentence in report["sentences"].values():
        require(sentence + "." in ended.out, ended)
    tree = xml.etree.ElementTree.parse(svg)
    require(tree.getroot().tag.endswith("svg"), "no SVG")
    texts = [element.text for element in tree.iter() if element.tag.endswith("text")]
    require(any("area.dz" in text for text in texts) and any("milliseconds" in text for text in texts), texts)
    marks = sum(element.tag.endswith("circle") for element in tree.iter())
    require(marks == 2 * 2, f"{marks} points")
    no_leftovers(folder)


@case
def coarser_quanta_are_built_measured_and_thrown_away(folder):
    import os
    area, scratch = build(folder, RAINIER), folder / "scratch"
    scratch.mkdir()
    report = run("dbview", "sweep", area, *SMALL, "--tolerances", "0", "--quanta", "1,10,100", "--eye", "46.85,-121.76,6000", "--look", "0,-60",
                 "--json", env={**os.environ, "TMPDIR": str(scratch)}).json()
    rows = report["all_views"]
    # The area's own quantum is 1 m.
    require([row["setting"]["quantum"] for row in rows] == ["1", "10", "100"], rows)
    errors = [row["displacement_pixels"]["largest"] for row in rows]
    require(errors[0] < 0.1 < errors[1] < errors[2], errors)
    # Nobody is displaced by more than half a quantum seen from the nearest ground, 1.6 km below.
    pixels = 80 / 0.57735
    require(errors[2] < 50 / 1500 * pixels * 2, errors)
    require(not list(scratch.iterdir()), "left over in TMPDIR")


@case
def ranges_of_the_report_are_one_row_without_a_bound(folder):
    rows = run("dbview", "sweep", build(folder, RAINIER), *SMALL, "--lods", "error,report", "--tolerances", "1,4", "--json").json()["all_views"]
    require([(row["setting"]["tolerance"], row["setting"]["lod"]) for row in rows] == [(1, "error"), (4, "error"), (None, "report")], rows)
    require([row["displacement_pixels"]["bound"] is None for row in rows] == [False, False, True], rows)
    require(rows[2]["displacement_pixels"]["largest"] > rows[0]["displacement_pixels"]["largest"], rows)


@case
def a_flat_tile_displaces_what_the_curved_one_does_not(folder):
    report = run("dbview", "sweep", build(folder, RAINIER), *SMALL, "--transforms", "exact,local,delta,matrix", "--tolerances", "0", "--views",
                 near_ground(folder), "--json").json()
    errors = {row["setting"]["transform"]: row["displacement_pixels"]["largest"] for row in report["all_views"]}
    require(list(errors) == ["exact", "local", "delta", "matrix"], errors)
    require(errors["local"] < errors["exact"] + 0.05 and errors["delta"] > errors["exact"] + 0.05, errors)


@case
def views_of_a_file_are_drawn(folder):
    area, views = build(folder), folder / "views.json"
    views.write_text(json.dumps({"views": [{"name": "south", "eye": "46.0,7.2,3000", "look": "0,-20", "fov": 40},
                                           {"name": "down", "eye": "46.15,7.2,500agl", "look": "0,-90", "size": "64x48"}]}))
    report = run("dbview", "sweep", area, *SMALL, "--views", views, "--tolerances", "1", "--json").json()
    require(names_of(report) == ["south", "down"], report)
    first, second = (view["camera"] for view in report["views"])
    require((first["width"], second["width"]) == (160, 64) and first["field_of_view"] == 40, report)
    views.write_text('{"views": [{"name": "x", "eye": "46,7,3000"}]}')
    run("dbview", "sweep", area, "--views", views, expect=1, words=["views[0]", "--look"])
    run("dbview", "sweep", area, "--views", folder / "absent.json", expect=3, words=["absent.json"])


@case
def colours_and_models_stay_in_copies_of_another_quantum(folder):
    area = build(folder)
    run("dbbuild", "color", area, "--name", "nat", "--synthetic", "natural")
    mesh = folder / "box.obj"
    mesh.write_text("v 0 0 0\nv 900 0 0\nv 0 900 0\nv 0 0 900\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n")
    run("dbbuild", "model", area, mesh, "--name", "box")
    run("dbbuild", "place", area, "box", "--at", "46.15,7.2")
    # A copy with the heights' own exact steps shows the same picture, models and colours included.
    report = run("dbview", "sweep", area, *SMALL, "--tolerances", "0", "--quanta", "0.5", "--json").json()
    rows = report["all_views"]
    require(rows[1]["setting"]["quantum"] == "0.5", rows)
    require(all(row["colors"]["differing_share"] == 0 for row in rows), rows)


@case
def wrong_options_are_named(folder):
    area = build(folder)
    mine = folder / "mine.json"
    mine.write_text("mine")
    for words, options in [(["--tolerances"], ["--tolerances", "1,x"]), (["--tolerances", "twice"], ["--tolerances", "1,1.0"]),
                           (["--tolerances"], ["--tolerances", "-1"]), (["--quanta"], ["--quanta", "0"]), (["--lods"], ["--lods", "range"]),
                           (["--transforms", "euler"], ["--transforms", "exact,euler"]),
                           (["--repeat"], ["--repeat", "0"]), (["--reference"], ["--reference", "high"]),
                           (["--report", "png"], ["--report", "png=x"]), (["--report"], ["--report", "svg="]),
                           (["one file"], ["--report", f"json={folder}/x,svg={folder}/x"]),
                           (["exclude"], ["--eye", "46,7,1000", "--look", "0,0", "--views", mine]),
                           (["--look"], ["--eye", "46,7,1000"]), (["--color"], ["--color", "summer"]),
                           (["the target exists", "--overwrite"], ["--report", f"json={mine}"])]:
        run("dbview", "sweep", area, *options, expect=2, words=words)
    require(mine.read_text() == "mine", "a file was touched")
    run("dbview", "sweep", expect=2, words=["AREA.dz"])
    run("dbview", "sweep", folder / "absent.dz", expect=3, words=["absent.dz"])
    require("--tolerances" in run("dbview", "sweep", "--help").out, "no help")
    require(re.search("dbview sweep", run("dbview", "--help").out), "the tool's help does not name its subcommand")


if __name__ == "__main__":
    main()
