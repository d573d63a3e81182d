"""Meshes become models and stand where they are put: real files of every format, sizes, broken inputs, placements."""
import math
import pathlib
import struct

from harness import SAMPLES, TEST_DATA, build, case, folder_bytes, main, require, run

# The files whose vertices this script reads itself, to know their size.
COORDINATES_CAN_BE_READ_HERE = ["Spider_ascii.stl", "Spider_binary.stl", "Wuson.ply", "WusonOBJ.obj"]

BOX_FACES = [(1, 4, 3, 2), (5, 6, 7, 8), (1, 2, 6, 5), (2, 3, 7, 6), (3, 4, 8, 7), (4, 1, 5, 8)]


def write_box(path, width=10, depth=6, height=4):
    """An OBJ of a box whose south-west lower corner is the origin."""
    corners = [(x, y, z) for z in (0, height) for x, y in ((0, 0), (width, 0), (width, depth), (0, depth))]
    lines = ["v %g %g %g" % corner for corner in corners] + ["f %d %d %d %d" % face for face in BOX_FACES]
    path.write_text("\n".join(lines) + "\n")
    return path


def extent(points):
    return [max(p[k] for p in points) - min(p[k] for p in points) for k in range(3)]


def points_of(path):
    """The vertices of a PLY of text, an STL of either kind or an OBJ."""
    content = path.read_bytes()
    if path.suffix == ".obj":
        return [tuple(map(float, line.split()[1:4])) for line in content.decode().splitlines() if line.startswith("v ")]
    if path.suffix == ".ply":
        head, _, body = content.decode().partition("end_header\n")
        count = next(int(line.split()[2]) for line in head.splitlines() if line.startswith("element vertex"))
        return [tuple(map(float, line.split()[:3])) for line in body.splitlines()[:count]]
    if content.startswith(b"solid") and b"endsolid" in content[-200:]:
        return [tuple(map(float, line.split()[1:4])) for line in content.decode().splitlines() if line.split()[:1] == ["vertex"]]
    count = struct.unpack_from("<I", content, 80)[0]
    return [struct.unpack_from("<3f", content, 84 + 50 * t + 12 * k) for t in range(count) for k in (1, 2, 3)]


@case
def real_meshes_come_in_at_their_size(folder):
    area = build(folder)
    buildings = sorted((SAMPLES / "models").glob("*.glb"))
    require(len(buildings) >= 4, "few GLB files in the samples")
    if TEST_DATA:
        buildings += sorted(path for path in (pathlib.Path(TEST_DATA) / "mesh").glob("*.glb") if path.stat().st_size < 1000000)
    for path in buildings:
        report = run("dbbuild", "model", area, path, "--name", path.stem, "--overwrite", "--json").json()
        # Houses and trees with y up: a few metres each way, as high as their names' storeys or treetops say.
        require(2 < report["size_metres"][2] < 12 and max(report["size_metres"]) < 15, f"{path.name}: {report['size_metres']}")
        check_levels(report)
    if not TEST_DATA:
        return
    meshes = pathlib.Path(TEST_DATA) / "mesh"
    for name in COORDINATES_CAN_BE_READ_HERE:
        report = run("dbbuild", "model", area, meshes / name, "--name", "mesh", "--overwrite", "--json").json()
        for got, wanted in zip(report["size_metres"], extent(points_of(meshes / name))):
            require(abs(got - wanted) < 1e-5 * max(1, wanted), f"{name}: {report['size_metres']}")
        check_levels(report)
    report = run("dbbuild", "model", area, meshes / "2CylinderEngine.glb", "--name", "engine", "--units", "mm", "--json").json()
    require(0.5 < max(report["size_metres"]) < 1, f"{report['size_metres']}")
    require(len(report["parts"]) > 80, f"{len(report['parts'])} parts")
    check_levels(report)
    names = {model["name"] for model in run("dbbuild", "info", area, "--json").json()["models"]}
    require("engine" in names and len(names) == len({path.stem for path in buildings}) + 2, f"{names}")


def check_levels(report):
    names = [part["name"] for part in report["parts"]]
    require(len(set(names)) == len(names), f"names twice: {names}")
    require(any(part["lods"] for part in report["parts"]), "nothing to draw")
    for part in report["parts"]:
        lods = part["lods"]
        require(not lods or lods[0]["error_metres"] == 0, f"{part}")
        for finer, coarser in zip(lods, lods[1:]):
            require(coarser["triangles"] < finer["triangles"] and coarser["error_metres"] > finer["error_metres"], f"{part}")


@case
def units_and_axis_up_are_followed(folder):
    area, box = build(folder), write_box(folder / "box.obj")
    for options, wanted in [((), (10, 6, 4)), (("--units", "ft"), (3.048, 1.8288, 1.2192)), (("--up", "y"), (10, 4, 6)),
                            (("--units", "km", "--up", "y"), (10000, 4000, 6000))]:
        size = run("dbbuild", "model", area, box, "--name", "box", "--overwrite", "--json", *options).json()["size_metres"]
        require(all(abs(a - b) < 1e-6 * b for a, b in zip(size, wanted)), f"{options}: {size}")
    run("dbbuild", "model", area, box, "--name", "box", "--overwrite", "--units", "furlong", expect=2, words=["--units", "furlong", "km"])
    run("dbbuild", "model", area, box, "--name", "box", "--overwrite", "--up", "x", expect=2, words=["--up"])
    run("dbbuild", "model", area, box, "--name", "none", expect=2, words=["--name"])


@case
def broken_meshes_are_refused_and_lose_nothing(folder):
    area, box = build(folder), write_box(folder / "box.obj")
    run("dbbuild", "model", area, box, "--name", "box")
    run("dbbuild", "place", area, "box", "--at", "46.2,7.2")
    before = folder_bytes(area)
    text = box.read_text()
    broken = {"empty.obj": "", "nan.obj": text.replace("v 10 6 4", "v nan 6 4"), "far.obj": text.replace("v 10 6 4", "v 1e20 6 4"),
              "index.obj": text.replace("f 1 4 3 2", "f 1 4 3 99"), "flat.obj": "v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n",
              "points.obj": "v 0 0 0\nv 1 0 0\nv 2 0 0\n", "notes.txt": "hello", "cut.ply": "ply\nformat ascii 1.0\nelement vertex 9\n",
              "huge.ply": "ply\nformat ascii 1.0\nelement vertex 4000000000\nproperty float x\nend_header\n0\n", "cut.stl": "solid x\nfacet normal 0 0 1\n", "cut.off": "OFF\n3 1 0\n0 0 0\n", "cut.gltf": '{"asset":', "cut.glb": "glTF\x02"}
    for name, content in broken.items():
        path = folder / name
        path.write_text(content)
        run("dbbuild", "model", area, path, "--name", "box", "--overwrite", expect=1, words=["error"])
        require(folder_bytes(area) == before, f"{name} changed the database")
    run("dbbuild", "model", area, folder / "absent.obj", "--name", "new", expect=3, words=["absent.obj"])
    run("dbbuild", "model", area, box, "--name", "box", expect=2, words=["--overwrite"])
    run("dbbuild", "model", folder, box, "--name", "box", expect=1)
    require(folder_bytes(area) == before, "a refusal changed the database")


@case
def what_is_repaired_is_said(folder):
    area, box = build(folder), write_box(folder / "box.obj")
    lines = box.read_text()
    # A wall wound the wrong way, a triangle without an area, and one that stands there twice.
    lines = lines.replace("f 1 2 6 5", "f 5 6 2 1") + "v 0 0 0\nf 1 9 2\nf 1 4 3\n"
    (folder / "odd.obj").write_text(lines)
    repairs = run("dbbuild", "model", area, folder / "odd.obj", "--name", "odd", "--json").json()["repairs"]
    require(repairs["turned_triangles"] == 2, f"{repairs}")
    require(repairs["degenerate_triangles"] == 1 and repairs["duplicate_triangles"] == 1, f"{repairs}")
    require(repairs["open_edges"] == 0 and repairs["inside_out_shells"] == 0, f"{repairs}")
    sound = run("dbbuild", "model", area, box, "--name", "sound", "--json").json()["repairs"]
    require(not any(count for kind, count in sound.items() if kind != "welded_vertices"), f"{sound}")


@case
def placements_stand_where_they_are_put(folder):
    area = build(folder)
    run("dbbuild", "model", area, write_box(folder / "box.obj"), "--name", "box")
    run("dbbuild", "place", area, "box", "--at", "46.25,7.25", "--heading", "450", expect=2, words=["--heading"])
    ground = run("dbbuild", "place", area, "box", "--at", "46.25,7.25", "--heading", "90", "--json").json()["placements"][0]
    above = run("dbbuild", "place", area, "box", "--at", "46.25,7.25,12.5agl", "--json").json()["placements"][0]
    fixed = run("dbbuild", "place", area, "box", "--at", "46.25,7.25,500", "--json").json()["placements"][0]
    require([p["instance"] for p in (ground, above, fixed)] == [1, 2, 3], "numbers")
    require(ground["on_ground"] and ground["heading"] == 90, f"{ground}")
    require(math.isclose(above["height"], ground["height"] + 12.5) and above["above_ground"] == 12.5, f"{above}")
    require(fixed["height"] == 500 and not fixed["on_ground"], f"{fixed}")
    run("dbbuild", "place", area, "box", "--remove", "2")
    run("dbbuild", "place", area, "box", "--remove", "2", expect=2, words=["instance 2"])
    run("dbbuild", "place", area, "mill", "--at", "46.25,7.25", expect=2, words=["mill", "box"])
    run("dbbuild", "place", area, "box", "--at", "10,10", expect=2, words=["no ground"])
    run("dbbuild", "place", area, "box", expect=2, words=["--at"])
    run("dbbuild", "model", area, "--name", "box", "--remove", expect=2, words=["2 places"])
    for instance in (1, 3):
        run("dbbuild", "place", area, "box", "--remove", instance)
    run("dbbuild", "model", area, "--name", "box", "--remove")
    require(run("dbbuild", "info", area, "--json").json().get("models", []) == [], "the model is still there")


@case
def lists_of_places_are_taken_whole_or_not_at_all(folder):
    area = build(folder)
    run("dbbuild", "model", area, write_box(folder / "box.obj"), "--name", "box")
    places = folder / "places.csv"
    places.write_text("lat,lon,alt,heading\n# two houses\n46.2,7.2\n\n46.21,7.21,,45\n46.22,7.22,3agl\n")
    placed = run("dbbuild", "place", area, "box", "--from", places, "--heading", "10", "--json").json()["placements"]
    require([p["heading"] for p in placed] == [10, 45, 10] and placed[2]["above_ground"] == 3, f"{placed}")
    before = folder_bytes(area)
    for text, words in [("46.2,7.2\n46.2,east\n", ["line 2", "east"]), ("46.2,7.2\n46.2\n", ["line 2"]), ("# none\n", ["no places"]),
                        ('{"type":"FeatureCollection","features":[{"type":"Feature","geometry":{"type":"LineString"}}]}', ["feature 1"]),
                        ('{"type":', ["JSON"])]:
        places.write_text(text)
        run("dbbuild", "place", area, "box", "--from", places, expect=1, words=words)
        require(folder_bytes(area) == before, f"{text!r} changed the database")
    places.write_text("46.2,7.2\n10,10\n")
    run("dbbuild", "place", area, "box", "--from", places, expect=2, words=["line 2", "no ground"])
    require(folder_bytes(area) == before, "a place without ground changed the database")
    places.write_text('{"type":"FeatureCollection","features":[{"type":"Feature","properties":{"heading":33},"geometry":'
                      '{"type":"Point","coordinates":[7.2,46.2]}}]}')
    placed = run("dbbuild", "place", area, "box", "--from", places, "--json").json()["placements"]
    require(len(placed) == 1 and placed[0]["heading"] == 33 and placed[0]["latitude"] == 46.2, f"{placed}")


if __name__ == "__main__":
    main()
