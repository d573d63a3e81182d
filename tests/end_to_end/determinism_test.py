"""The same bytes whatever the number of threads, the locale, the time zone, the folder and the hour."""
import os
import shutil
import time

from harness import RAINIER, case, folder_bytes, main, require, run, small_dem

VIEW = ["--size", "320x200"]


@case
def thread_counts_do_not_matter(folder):
    databases, pictures, reports = [], [], []
    for threads in ("1", "2", "7"):
        area, picture, depth = folder / threads / "area.dz", folder / f"{threads}.png", folder / f"{threads}.tif"
        area.parent.mkdir()
        run("dbbuild", "terrain", RAINIER, "-o", area, "-j", threads)
        databases.append(folder_bytes(area))
        run("dbview", area, "-o", picture, "--depth", depth, "-j", threads, *VIEW)
        pictures.append((picture.read_bytes(), depth.read_bytes()))
        reports.append(run("dbcheck", area, "--level", "all", "--json", "-j", threads).out)
    require(databases[0] == databases[1] == databases[2], "the database depends on -j")
    require(pictures[0] == pictures[1] == pictures[2], "the picture depends on -j")
    require(reports[0] == reports[1] == reports[2], "the report depends on -j")


@case
def surroundings_do_not_matter(folder):
    source = small_dem(folder)
    results = []
    for number, surroundings in enumerate(({"LC_ALL": "C", "TZ": "UTC"}, {"LC_ALL": "de_DE.UTF-8", "TZ": "Asia/Kathmandu"},
                                           {"LC_ALL": "tr_TR.UTF-8", "LANG": "tr_TR.UTF-8", "LC_NUMERIC": "de_DE.UTF-8"})):
        # Another folder, a relative name, another mask and another second.
        place = folder / f"place{number}" / ("deeper" * number or "flat")
        place.mkdir(parents=True)
        shutil.copy(source, place / "dem.tif")
        options = {"env": os.environ | surroundings, "cwd": place, "umask": (0o022, 0o077, 0o002)[number]}
        run("dbbuild", "terrain", "dem.tif", "-o", "area.dz", **options)
        run("dbview", "area.dz", "-o", "view.png", "--depth", "view.tif", "--eye", "46.1,7.2,5000.5", "--look", "10.5,-30.25", *VIEW, **options)
        results.append((folder_bytes(place / "area.dz"), (place / "view.png").read_bytes(), (place / "view.tif").read_bytes(),
                        run("dbcheck", "area.dz", "--json", **options).out, run("dbbuild", "info", "area.dz", **options).out))
        time.sleep(1.1)
    for result in results[1:]:
        for first, other, what in zip(results[0], result, ("database", "picture", "depth", "report", "info")):
            require(first == other, f"the {what} depends on its surroundings")


@case
def a_repeated_frame_is_the_same_frame(folder):
    area = folder / "area.dz"
    run("dbbuild", "terrain", small_dem(folder), "-o", area)
    run("dbview", area, "-o", folder / "once.png", *VIEW)
    # dbview itself ends with 70 if a repeat differs.
    run("dbview", area, "-o", folder / "often.png", "--repeat", "3", *VIEW)
    require((folder / "once.png").read_bytes() == (folder / "often.png").read_bytes(), "the picture depends on --repeat")


if __name__ == "__main__":
    main()
