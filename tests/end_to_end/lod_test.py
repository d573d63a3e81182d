"""dbview --lod report: the picture is drawn by range, and its statistics tell of objects."""
from harness import RAINIER, build, case, main, require, run

VIEW = ["--eye", "46.2,-121.5,2000agl", "--look", "0,-5", "--fov", "32", "--size", "320x240"]


@case
def objects_by_range_add_up_to_the_triangles(folder):
    area = build(folder, RAINIER)
    by_range = run("dbview", area, *VIEW, "--lod", "report", "-o", folder / "range.png", "--json").json()
    by_error = run("dbview", area, *VIEW, "-o", folder / "error.png", "--json").json()
    full = run("dbview", area, *VIEW, "--tolerance", "0", "-o", folder / "full.png", "--json").json()["frames"][0]
    require((by_range["lod"], by_error["lod"]) == ("report", "error"), by_range)
    frame = by_range["frames"][0]
    objects, triangles = frame["objects"], frame["triangles"]
    require("objects" not in by_error["frames"][0], by_error)
    require(len(objects["faces"]) == 5 and objects["faces"][0] > 0 and objects["faces"][4] > 0, objects)
    require(sum(objects["faces"]) + objects["faces_twice"] == triangles["in"], frame)
    require(triangles["in"] == sum(triangles[fate] for fate in ("back_facing", "clipped", "no_sample", "drawn")), triangles)
    require(0 < objects["drawn_twice"] < objects["drawn"], objects)
    require(frame["projected_error"] is None, frame)
    # Downsampling is done in the frame: all that full resolution reads is read.
    require(frame["posts_decoded"] == full["posts_decoded"] and triangles["in"] * 4 < full["triangles"]["in"], (frame, full))


if __name__ == "__main__":
    main()
